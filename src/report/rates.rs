//! Exits and rates of overdamped motion, for people and for programs.

use std::fmt::Write;

use nalgebra::DMatrix;
use serde_json::{Value, json};

use super::terminal::write_table;
use super::values;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::dynamics::exits::ExitRuns;
use crate::kinetics::chain::Chain;
use crate::kinetics::exit::{Exit, ExitSettings};
use crate::kinetics::rates::{RateSettings, Rates};
use crate::units::si;

/// Overdamped motion on an air table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Drag rate c / mass (1/s).
    pub drag: f64,
    /// D = kT / c (m^2/s).
    pub diffusion: f64,
}

impl Motion {
    /// Of a design's moving tile at kT (J) with this drag rate (1/s).
    pub fn new(design: &Design, kt: f64, drag: f64) -> Self {
        Self {
            drag,
            diffusion: kt / (drag * design.pair.moving.mass),
        }
    }
}

/// An exit as an object.
pub fn exit_entry(asked: &ExitSettings, motion: &Motion, exit: &Exit) -> Value {
    let finest = exit.finest();
    let [time, bound] = exit.spread();
    json!({
        "diffusion_m2_s": motion.diffusion,
        "mean_exit_s": finest.time / motion.diffusion,
        // Nothing is proved of it.
        "mean_exit_bounds_s": null,
        "exits": {"bound": finest.bound, "free": 1.0 - finest.bound},
        "kt_J": asked.kt,
        "drag_per_s": motion.drag,
        "start": values::pose(&asked.start),
        "basin_energy_J": asked.basin_energy,
        "free_at_m": asked.free_at,
        "mesh": {
            "unknowns": finest.unknowns,
            "mean_exit_spread": time,
            "exits_spread": bound,
        },
    })
}

/// An exit in a few lines.
pub fn exit_summary(design: &Design, asked: &ExitSettings, motion: &Motion, exit: &Exit) -> String {
    let finest = exit.finest();
    let [time, bound] = exit.spread().map(|spread| 100.0 * spread);
    let mean = finest.time / motion.diffusion;
    let share = 100.0 * finest.bound;
    let [x, y, theta] = asked.start.to_array();
    let mut text = format!(
        "{}: a tile let go at {x},{y},{theta} is bound or free after {} on average: bound first in \
         {share:.1} % of all cases, free first in {:.1} %\n",
        design.name,
        si(mean, "s", 3),
        100.0 - share,
    );
    let _ = writeln!(
        text,
        "  kT = {}, drag {} /s: D = {}; the mean exit time times D is {}",
        si(asked.kt, "J", 4),
        motion.drag,
        si(motion.diffusion, "m²/s", 4),
        area(finest.time),
    );
    let _ = writeln!(
        text,
        "  bound: U < {} in the basin of the bond or of one of its copies; free: centres {} apart",
        si(asked.basin_energy, "J", 4),
        si(asked.free_at, "m", 4),
    );
    let _ = writeln!(
        text,
        "  the two finest meshes ({} unknowns) differ by {time:.1} % in the time and by {bound:.2} \
         points in the shares; no bound is proved",
        finest.unknowns,
    );
    text.push_str(SCOPE);
    text
}

/// What moving tiles say of an exit, as an object; ratios are theirs over the overdamped motion's.
pub fn check_entry(motion: &Motion, exit: &Exit, runs: &ExitRuns) -> Value {
    let mean = exit.finest().time / motion.diffusion;
    let [bound, free] = runs.ends;
    json!({
        "runs": {"bound": bound, "free": free, "given_up": runs.given_up},
        "mean_exit_s": finite(runs.time[0]),
        "standard_error_s": finite(runs.time[1]),
        "ratio": finite(runs.time[0] / mean),
        "bound": finite(bound as f64 / (bound + free) as f64),
        "kinetic_over_kt": finite(runs.warmth),
    })
}

/// The kinetic energy of moving tiles may differ from that of kT by this share.
const WARM: f64 = 0.1;

/// What moving tiles say of an exit, in a few lines.
pub fn check_summary(motion: &Motion, exit: &Exit, runs: &ExitRuns) -> String {
    let mean = exit.finest().time / motion.diffusion;
    let [bound, free] = runs.ends;
    let [time, error] = runs.time;
    let mut text = format!(
        "check: {} rigid bodies with inertia take {} +- {} on average, {:.2} +- {:.2} times as \
         long; bound first in {:.0} % ({bound} of {})\n",
        bound + free + runs.given_up,
        si(time, "s", 3),
        si(error, "s", 2),
        time / mean,
        error / mean,
        100.0 * bound as f64 / (bound + free) as f64,
        bound + free,
    );
    if runs.given_up > 0 {
        let _ = writeln!(
            text,
            "  {} were given up under way: the mean is too short",
            runs.given_up
        );
    }
    let _ = writeln!(
        text,
        "  their kinetic energy is {:.2} times that of kT{}",
        runs.warmth,
        if (runs.warmth - 1.0).abs() > WARM {
            ": knocks take energy that the shaking does not give back, so no temperature exists"
        } else {
            ""
        },
    );
    text
}

/// Where kT means something.
const SCOPE: &str = "  overdamped motion, knocks without loss: drag of 50 /s and more; at less \
                     drag, or where knocks\n  take energy that shaking does not give back, there \
                     is no such kT\n";

/// A state with rates.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// What people call it.
    pub name: String,
    /// The minimum.
    pub at: Configuration,
    /// Its energy (J).
    pub energy: f64,
    /// Its basin is where U is lower (J).
    pub below: f64,
    /// How many states the pair's symmetries make of it.
    pub copies: usize,
}

/// Rates between states and `free`.
pub struct Table<'a> {
    /// The design.
    pub design: &'a Design,
    /// What was asked.
    pub asked: &'a RateSettings,
    /// The motion.
    pub motion: &'a Motion,
    /// The states, in the order of the basins asked for.
    pub places: &'a [Place],
    /// What was found.
    pub found: &'a Rates,
}

impl Table<'_> {
    fn count(&self) -> usize {
        self.places.len() + 1
    }

    fn name(&self, place: usize) -> &str {
        self.places.get(place).map_or("free", |place| &place.name)
    }

    /// Rate (1/s) from one place to another.
    fn rate(&self, from: usize, to: usize) -> f64 {
        self.found.finest().rates[from][to] * self.motion.diffusion
    }

    fn rate_out(&self, from: usize) -> f64 {
        (0..self.count()).map(|to| self.rate(from, to)).sum()
    }

    /// The mean time (s) from one place to another, by whatever way; a tile that is anywhere else
    /// does not count.
    fn mean_first_passage(&self, from: usize, to: usize) -> f64 {
        let rate = |i: usize, j: usize| self.rate(i, j);
        let chain = Chain::new(DMatrix::from_fn(self.count(), self.count(), rate));
        chain.mean_times(&[to])[from]
    }

    /// Every two places, from and to.
    fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let count = self.count();
        (0..count).flat_map(move |i| (0..count).filter(move |j| *j != i).map(move |j| (i, j)))
    }

    /// All of it as an object.
    pub fn entry(&self) -> Value {
        let finest = self.found.finest();
        let place = |number: usize| {
            let own = self.places.get(number);
            json!({
                "name": self.name(number),
                "pose": own.map(|place| values::pose(&place.at)),
                "energy_J": own.map(|place| place.energy),
                "basin_energy_J": own.map(|place| place.below),
                "free_at_m": own.is_none().then_some(self.asked.free_at),
                "copies": own.map(|place| place.copies),
                "occupation": finest.occupation[number],
                "mean_exit_s": finite(1.0 / self.rate_out(number)),
            })
        };
        let rate = |(from, to): (usize, usize)| {
            json!({
                "from": self.name(from),
                "to": self.name(to),
                // Nothing is proved of it.
                "lower_per_s": null,
                "value_per_s": self.rate(from, to),
                "upper_per_s": null,
                "mean_first_passage_s": finite(self.mean_first_passage(from, to)),
                "first": finite(self.rate(from, to) / self.rate_out(from)),
                "spread": finite(self.found.spread(from, to)),
            })
        };
        json!({
            "diffusion_m2_s": self.motion.diffusion,
            "kt_J": self.asked.kt,
            "drag_per_s": self.motion.drag,
            "places": (0..self.count()).map(place).collect::<Vec<_>>(),
            "rates": self.pairs().map(rate).collect::<Vec<_>>(),
            "mesh": {"unknowns": finest.unknowns},
        })
    }

    /// rates.csv: bounds are empty where nothing is proved.
    pub fn rates_csv(&self) -> String {
        let mut text = "from,to,lower_per_s,value_per_s,upper_per_s,spread,first,mean_first_passage_s,from_basin_J,\
                        to_basin_J,free_at_m\n"
            .to_owned();
        let limit = |place: usize| {
            let below = self.places.get(place).map(|place| place.below);
            below.map_or(String::new(), |below| format!("{below:.9e}"))
        };
        for (from, to) in self.pairs() {
            let _ = writeln!(
                text,
                "{},{},,{:.6e},,{:.1e},{:.6e},{:.6e},{},{},{}",
                self.name(from),
                self.name(to),
                self.rate(from, to),
                self.found.spread(from, to),
                self.rate(from, to) / self.rate_out(from),
                self.mean_first_passage(from, to),
                limit(from),
                limit(to),
                self.asked.free_at,
            );
        }
        text
    }

    /// occupation.csv: shares of all time on the design's table.
    pub fn occupation_csv(&self) -> String {
        let mut text = "place,copies,occupation,energy_J,basin_J,free_at_m\n".to_owned();
        for (number, share) in self.found.finest().occupation.iter().enumerate() {
            let name = self.name(number);
            let _ = match self.places.get(number) {
                Some(Place {
                    copies,
                    energy,
                    below,
                    ..
                }) => writeln!(
                    text,
                    "{name},{copies},{share:.6e},{energy:.9e},{below:.9e},"
                ),
                None => writeln!(text, "{name},,{share:.6e},,,{}", self.asked.free_at),
            };
        }
        text
    }

    /// The rates in a few lines.
    pub fn summary(&self) -> String {
        let free = self.places.len();
        let mut text = format!(
            "{}: free tiles bind at {} and the bond comes off at {}, on a table of {} by {} m\n",
            self.design.name,
            per_second(self.rate(free, 0)),
            per_second(self.rate_out(0)),
            2.0 * self.design.space().half_size[0],
            2.0 * self.design.space().half_size[1],
        );
        let _ = writeln!(
            text,
            "  kT = {}, drag {} /s: D = {}",
            si(self.asked.kt, "J", 4),
            self.motion.drag,
            si(self.motion.diffusion, "m²/s", 4),
        );
        let mut rows = vec![vec!["from".to_owned()]];
        rows[0].extend((0..self.count()).map(|to| format!("to {}", self.name(to))));
        rows[0].extend(["occupation", "basin"].map(str::to_owned));
        for from in 0..self.count() {
            let mut row = vec![self.name(from).to_owned()];
            row.extend((0..self.count()).map(|to| match from == to {
                true => "-".to_owned(),
                false => per_second(self.rate(from, to)),
            }));
            row.push(format!("{:.3e}", self.found.finest().occupation[from]));
            row.push(match self.places.get(from) {
                Some(place) => format!("U < {}", si(place.below, "J", 4)),
                None => format!("{} apart", si(self.asked.free_at, "m", 4)),
            });
            rows.push(row);
        }
        write_table(&mut text, &rows);
        let spreads = self.pairs().map(|(i, j)| self.found.spread(i, j));
        let worst = spreads
            .filter(|spread| spread.is_finite())
            .fold(0.0, f64::max);
        let _ = writeln!(
            text,
            "  the two finest meshes ({} unknowns) differ by {:.1} % at most; no bound is proved",
            self.found.finest().unknowns,
            100.0 * worst,
        );
        text.push_str(SCOPE);
        text
    }
}

/// A rate with three digits.
fn per_second(rate: f64) -> String {
    format!("{rate:.2e} /s")
}

/// A number that JSON has.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// An area with four digits; small and large ones with a power of ten, for m² takes no prefix well.
fn area(value: f64) -> String {
    if (1e-4..1e4).contains(&value) {
        format!("{value:.4} m²")
    } else {
        format!("{value:.3e} m²")
    }
}
