//! Exits and rates of overdamped motion, for people and for programs.

use std::fmt::Write;

use serde_json::{Value, json};

use super::values;
use crate::design::Design;
use crate::kinetics::exit::{Exit, ExitSettings};
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
    text.push_str(
        "  overdamped motion, knocks without loss: drag of 50 /s and more; at less drag, or where \
         knocks\n  take energy that shaking does not give back, there is no such kT\n",
    );
    text
}

/// An area with four digits; small and large ones with a power of ten, for m² takes no prefix well.
fn area(value: f64) -> String {
    if (1e-4..1e4).contains(&value) {
        format!("{value:.4} m²")
    } else {
        format!("{value:.3e} m²")
    }
}
