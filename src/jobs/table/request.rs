//! The request of a table.

use super::Wanted;
use crate::design::quantity::short;
use crate::design::{angle, frequency, length};
use crate::request::{self, MotionOptions, Shard, options};
use physics::table::{Linear, Orbital, TableSettings};

/// Largest radius of the table's circle (m).
const WIDEST_CIRCLE: f64 = 1.0;
/// Longest step (s).
const LONGEST_STEP: f64 = 0.01;
/// Time between two random kicks (s) ...
const KICKS: f64 = 5e-3;
/// ... during which drag takes at most this share of the velocity.
const DRAG_A_KICK: f64 = 0.25;
/// Highest frequency (Hz) of the table's motion.
const FASTEST_CIRCLE: f64 = 1e3;
/// Number of samples if no frames are requested.
const MOMENTS: f64 = 200.0;

options! {
    /// The options of a table.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// Tiles of each kind: fixed and moving kind of a design, or each tile of a set
        ///
        /// One number for a design of one kind. For several designs, give the numbers of one for all of
        /// them, or those of each.
        pub count: Vec<usize> = value("N,M", request::count_or_none).list(),

        /// Duration of each run (s)
        pub time: f64 = value("S", request::time),

        /// Number of runs, each from its own start
        pub runs: usize = value("R", request::runs).or(1),

        /// Compute only every nth run from the ith on, i/n; join all parts with --merge
        pub shard: Option<Shard> = value("i/n", request::shard),

        /// Effective energy kT of shaking (J)
        pub shaking: Option<f64> = value("E_J", request::shaking),

        /// Time between random kicks of the shaking (s) [default: 0.005; less for drag above 50]
        ///
        /// It does not depend on the step.
        pub correlation: Option<f64> = value("S", request::time),

        /// Move the table in a circle of radius A (m) at F revolutions per second, or with units: "10 mm,300 rpm"
        ///
        /// Places, velocities and drag are relative to the moving table.
        pub orbital: Option<Orbital> = value("A,F", orbital),

        /// Shake the table along a line: amplitude A (m), F periods per second, at ANGLE (rad) from the x axis, or
        /// with units: "5 mm,10,90 deg"
        pub linear: Option<Linear> = value("A,F,ANGLE", linear).signed(),

        /// Dry friction of tiles on the table they lie on: Coulomb's coefficient, 0 for an air table
        ///
        /// A tile's weight presses evenly over its area. --orbital and --linear move the table beneath it.
        pub table_friction: f64 = value("MU", request::up_to(request::MOST_FRICTION)).or(0.0),

        /// How tiles move.
        pub motion: MotionOptions = group(),

        /// Longest step (s) [default: 0.0025 for tiles of 43 cm, less in proportion to smaller ones, or for fast drives]
        ///
        /// Steps in contact are shorter in proportion.
        pub step: Option<f64> = value("S", step),

        /// Record the tiles' poses at this interval (s)
        pub frames: Option<f64> = value("DT", request::time),

        /// What is to be built: ring:8, chain:5, sheet:3x3, or the tiles of a start file
        ///
        /// Its yield is the share of all tiles that are in such structures, of the largest possible share.
        pub target: Option<Wanted> = value("ring:N|chain:N|sheet:RxC|FILE.csv", Wanted::parse),

        /// Compare with the predictions of `tilebind bond` and `tilebind yield`, or of `tilebind assemble`
        pub compare: bool = flag(),

        /// Random seed; a run depends only on it and on its own number
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

impl Request {
    /// The settings of the runs, for tiles with this usual step (s).
    pub fn settings(&self, usual: f64) -> TableSettings {
        let kicks = self
            .correlation
            .unwrap_or_else(|| KICKS.min(DRAG_A_KICK / self.motion.drag));
        let mut settings = TableSettings {
            duration: self.time,
            drag: self.motion.drag,
            friction: self.motion.contact.friction,
            table_friction: self.table_friction,
            restitution: self.motion.contact.restitution,
            shaking: self.shaking,
            kicks,
            orbital: self.orbital,
            linear: self.linear,
            fans: self.motion.fan.clone(),
            step: usual,
            sampling: self.frames.unwrap_or(self.time / MOMENTS),
            walls: true,
        };
        let fastest = settings.frequencies().fold(0.0, |a: f64, b| a.max(b.abs()));
        settings.step = self
            .step
            .unwrap_or(usual.min(0.02 / fastest))
            .min(self.time);
        if self.shaking.is_some() {
            // A whole number of steps between kicks.
            settings.step = kicks / (kicks / settings.step - 1e-9).ceil().max(1.0);
        }
        settings
    }

    /// The indices of the runs to compute, from 0.
    pub fn made(&self) -> Vec<usize> {
        let shard = self.shard.unwrap_or(Shard::WHOLE);
        (0..self.runs).filter(|run| shard.contains(*run)).collect()
    }

    /// Whether poses are recorded.
    pub fn keeps_frames(&self) -> bool {
        self.frames.is_some()
    }
}

fn orbital(text: &str) -> Result<Orbital, String> {
    const FORM: &str =
        "a circle is A,F in m and Hz or with units, such as 0.005,2 or \"10 mm,300 rpm\"";
    let (radius, turns) = text.split_once(',').ok_or(FORM)?;
    let [amplitude, frequency] = swing(["a circle", "a radius"], [radius, turns], turns, FORM)?;
    Ok(Orbital {
        amplitude,
        frequency,
    })
}

fn linear(text: &str) -> Result<Linear, String> {
    const FORM: &str = "linear shaking is A,F,ANGLE in m, Hz and rad or with units, such as 0.005,10,0 or \
                        \"5 mm,10,90 deg\"";
    let parts: Vec<&str> = text.split(',').collect();
    let [distance, periods, way] = parts[..] else {
        return Err(FORM.to_owned());
    };
    let after = format!("{},{}", periods.trim(), way.trim());
    let what = ["linear shaking", "an amplitude"];
    let [amplitude, frequency] = swing(what, [distance, periods], &after, FORM)?;
    Ok(Linear {
        amplitude,
        frequency,
        angle: angle(way)
            .filter(|it| it.abs() <= request::MOST_TURNED)
            .ok_or(FORM)?,
    })
}

/// A length (m) and a frequency (Hz) of the table's motion; `after` is the text after the length.
fn swing(
    [what, has]: [&str; 2],
    [distance, turns]: [&str; 2],
    after: &str,
    form: &str,
) -> Result<[f64; 2], String> {
    let amplitude = length(distance).filter(|it| *it >= 0.0).ok_or(form)?;
    let frequency = frequency(turns).filter(|it| *it > 0.0).ok_or(form)?;
    if amplitude > WIDEST_CIRCLE {
        let meant = match distance.trim().parse::<f64>() {
            Ok(number) if number * 1e-3 <= WIDEST_CIRCLE => {
                format!(": did you mean \"{number} mm,{}\"?", after.trim())
            }
            _ => String::new(),
        };
        return Err(format!(
            "{what} has {has} of at most {WIDEST_CIRCLE} m, not {} m{meant}",
            short(amplitude)
        ));
    }
    if frequency > FASTEST_CIRCLE {
        return Err(format!("{what} has at most {FASTEST_CIRCLE} Hz"));
    }
    Ok([amplitude, frequency])
}

fn step(text: &str) -> Result<f64, String> {
    let found = request::time(text).ok().filter(|it| *it <= LONGEST_STEP);
    found.ok_or_else(|| {
        format!(
            "a step of at least {:e} and at most {LONGEST_STEP} s is needed, such as \"1 ms\"",
            request::TIMES[0]
        )
    })
}
