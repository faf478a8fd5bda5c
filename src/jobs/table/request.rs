//! The request of a table.

use clap::Args;

use super::Wanted;
use crate::design::{frequency, length};
use crate::request::{self, MotionOptions, Shard};
use physics::table::{Orbital, TableSettings};

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

/// The options of a table.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Request {
    /// Tiles of each kind: fixed and moving kind of a design, or each tile of a set
    ///
    /// One number for a design of one kind. For several designs, give the numbers of one for all of
    /// them, or those of each.
    #[arg(long, value_name = "N,M", value_delimiter = ',', value_parser = request::count_or_none)]
    pub count: Vec<usize>,

    /// Duration of each run (s)
    #[arg(long, value_name = "S", value_parser = request::time)]
    pub time: f64,

    /// Number of runs, each from its own start
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = request::runs)]
    pub runs: usize,

    /// Compute only every nth run from the ith on, i/n; join all parts with --merge
    #[arg(long, value_name = "i/n", value_parser = request::shard)]
    pub shard: Option<Shard>,

    /// Effective energy kT of shaking (J)
    #[arg(long, value_name = "E_J", value_parser = request::shaking)]
    pub shaking: Option<f64>,

    /// Time between random kicks of the shaking (s) [default: 0.005; less for drag above 50]
    ///
    /// It does not depend on the step.
    #[arg(long, value_name = "S", value_parser = request::time)]
    pub correlation: Option<f64>,

    /// Move the table in a circle of radius A (m) at F revolutions per second, or with units: "10 mm,300 rpm"
    #[arg(long, value_name = "A,F", value_parser = orbital)]
    pub orbital: Option<Orbital>,

    /// How tiles move.
    #[command(flatten)]
    pub motion: MotionOptions,

    /// Longest step (s) [default: 0.0025, or less for fast drives]
    ///
    /// Steps in contact are shorter in proportion.
    #[arg(long, value_name = "S", value_parser = step)]
    pub step: Option<f64>,

    /// Record the tiles' poses at this interval (s)
    #[arg(long, value_name = "DT", value_parser = request::time)]
    pub frames: Option<f64>,

    /// What is to be built: ring:8, chain:5, sheet:3x3, or the tiles of a start file
    ///
    /// Its yield is the share of all tiles that are in such structures, of the largest possible share.
    #[arg(long, value_name = "ring:N|chain:N|sheet:RxC|FILE.csv", value_parser = Wanted::parse)]
    pub target: Option<Wanted>,

    /// Compare with the predictions of `tilebind bond` and `tilebind yield`, or of `tilebind assemble`
    #[arg(long)]
    pub compare: bool,

    /// Random seed; a run depends only on it and on its own number
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// The settings of the runs.
    pub fn settings(&self) -> TableSettings {
        let usual = TableSettings::USUAL_STEP;
        let kicks = self
            .correlation
            .unwrap_or_else(|| KICKS.min(DRAG_A_KICK / self.motion.drag));
        let fastest = self.motion.fan.iter().map(|fan| fan.frequency);
        let fastest = fastest
            .chain(self.orbital.map(|it| it.frequency))
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        let mut step = self
            .step
            .unwrap_or(usual.min(0.02 / fastest))
            .min(self.time);
        if self.shaking.is_some() {
            // A whole number of steps between kicks.
            step = kicks / (kicks / step - 1e-9).ceil().max(1.0);
        }
        TableSettings {
            duration: self.time,
            drag: self.motion.drag,
            friction: self.motion.contact.friction,
            restitution: self.motion.contact.restitution,
            shaking: self.shaking,
            kicks,
            orbital: self.orbital,
            fans: self.motion.fan.clone(),
            step,
            sampling: self.frames.unwrap_or(self.time / MOMENTS),
            walls: true,
        }
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
    let amplitude = length(radius).filter(|it| *it >= 0.0).ok_or(FORM)?;
    let frequency = frequency(turns).filter(|it| *it > 0.0).ok_or(FORM)?;
    if amplitude > WIDEST_CIRCLE {
        let meant = match radius.trim().parse::<f64>() {
            Ok(number) => format!(": did you mean \"{number} mm,{}\"?", turns.trim()),
            Err(_) => String::new(),
        };
        return Err(format!(
            "a circle has a radius of at most {WIDEST_CIRCLE} m, not {amplitude} m{meant}"
        ));
    }
    if frequency > FASTEST_CIRCLE {
        return Err(format!("a circle has at most {FASTEST_CIRCLE} Hz"));
    }
    Ok(Orbital {
        amplitude,
        frequency,
    })
}

fn step(text: &str) -> Result<f64, String> {
    let found = request::time(text).ok().filter(|it| *it <= LONGEST_STEP);
    found.ok_or_else(|| {
        format!("a step is greater than 0 and at most {LONGEST_STEP} s, or with a unit: \"1 ms\"")
    })
}
