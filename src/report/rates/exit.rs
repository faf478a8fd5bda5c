//! Exits from a start.

use std::fmt::Write;

use serde_json::{Value, json};

use super::{
    Motion, NO_BOUNDS, NOT_BOUNDED, NOT_PROVED, ON_THE_MESH, ONE_SIDED, PROVED, SCOPE, apart, area,
    digits, finite, leaving_set, mean_exit_words, proved_entry, proved_words,
};
use crate::values;
use jobs::design::Design;
use physics::dynamics::exits::ExitRuns;
use physics::kinetics::exit::{Exit, ExitSettings};
use physics::kinetics::{OVERDAMPED, Way};
use physics::units::{duration, duration_to, si};

/// Bounds of the mean exit time (s), those that are numbers.
fn bounds(motion: &Motion, exit: &Exit) -> Option<[Option<f64>; 2]> {
    let bounds = exit.bracket()?.map(|end| finite(end / motion.diffusion));
    bounds[0].map(|_| bounds)
}

/// An exit as an object.
pub fn exit_entry(asked: &ExitSettings, motion: &Motion, exit: &Exit) -> Value {
    let finest = exit.finest();
    let [time, bound] = exit.spread();
    json!({
        "diffusion_m2_s": motion.diffusion,
        "mean_exit_s": exit.time() / motion.diffusion,
        // Midway between the bounds, as the mesh is too coarse for it, or what the mesh has.
        "mean_exit_midway": exit.midway.is_some(),
        "mean_exit_bounds_s": bounds(motion, exit),
        // Proved are the inequalities, not the integrals over cells.
        "bounds_hold": exit.bracket().map(|_| "on the mesh"),
        "bounds_leave_out": exit.bracket().map(|_| NOT_BOUNDED),
        // Of the well about the start, apart from any mesh.
        "proved": proved_entry(motion, exit.proved.as_ref()),
        "exits": {"bound": finest.bound, "free": 1.0 - finest.bound},
        "kt_J": asked.kt,
        "drag_per_s": motion.drag,
        "start": values::pose(&asked.start),
        "basin_energy_J": asked.basin_energy,
        "free_at_m": asked.free_at,
        "way_out": exit.way.name(),
        "mesh": {
            "unknowns": finest.unknowns,
            "mean_exit_spread": time,
            "exits_spread": bound,
            "of_basins": finite(finest.of_rims),
            "error": finite(finest.error),
        },
    })
}

/// By how much the mean exit time may be off, relative, as far as meshes tell.
fn error(exit: &Exit) -> f64 {
    match (exit.midway, exit.bracket()) {
        (Some(midway), Some([_, upper])) => upper / midway - 1.0,
        _ => exit.spread()[0].max(exit.finest().error),
    }
}

/// An exit in a few lines.
pub fn exit_summary(design: &Design, asked: &ExitSettings, motion: &Motion, exit: &Exit) -> String {
    let finest = exit.finest();
    let [time, bound] = exit.spread().map(|spread| 100.0 * spread);
    let mean = exit.time() / motion.diffusion;
    let share = 100.0 * finest.bound;
    let [x, y, theta] = asked.start.to_array();
    let mut text = format!(
        "{}: a tile let go at {x},{y},{theta} is bound or free after {} on average: bound first in \
         {share:.1} % of all cases, free first in {:.1} %\n",
        design.name,
        duration(mean, digits(error(exit))),
        100.0 - share,
    );
    let _ = writeln!(
        text,
        "  kT = {}, drag {} /s: D = {}; the mean exit time times D is {}",
        si(asked.kt, "J", 4),
        motion.drag,
        si(motion.diffusion, "m²/s", 4),
        area(exit.time()),
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
         points in the shares;\n  the basin, made of whole cells, is off by an estimated {:.1} % of its capacity;\n  \
         estimated error of flows {:.1} %",
        finest.unknowns,
        100.0 * finest.of_rims,
        100.0 * finest.error,
    );
    if exit.midway.is_some() {
        let _ = writeln!(
            text,
            "  this mesh has {}, which is not between the bounds below: what is told lies midway \
             between them",
            duration(finest.time / motion.diffusion, 2),
        );
    }
    if exit.way != Way::Open {
        let _ = writeln!(text, "  {}", exit.way.told());
    }
    let _ = match bounds(motion, exit) {
        Some([Some(lower), None]) => writeln!(
            text,
            "  from the well about the start the mean exit time is {} at least; {ONE_SIDED};\n  \
             {ON_THE_MESH}",
            duration_to(lower, 3, f64::floor),
        ),
        Some([Some(lower), Some(upper)]) => writeln!(
            text,
            "  from the well about the start the mean exit time is between {} and {} ({} apart);\n  \
             {ON_THE_MESH}",
            duration_to(lower, 3, f64::floor),
            duration_to(upper, 3, f64::ceil),
            apart([lower, upper]),
        ),
        _ => writeln!(text, "  {NO_BOUNDS}"),
    };
    let is_asked = asked.certify.is_some_and(|certify| certify.pieces > 0);
    let _ = match &exit.proved {
        Some(proved) => writeln!(
            text,
            "  {PROVED}:\n  while it is in the well about the start, U < {}, a tile sets out for an end, not \
             to\n  come back before, {};\n  from where it last \
             leaves the well the mean exit time is {}",
            si(proved.below, "J", 4),
            proved_words(leaving_set(motion, proved)),
            mean_exit_words(motion, proved),
        ),
        None if is_asked => writeln!(text, "  {NOT_PROVED}"),
        None => Ok(()),
    };
    text.push_str(SCOPE);
    text
}

/// What moving tiles say of an exit, as an object; ratios are theirs over the overdamped motion's.
pub fn check_entry(motion: &Motion, exit: &Exit, runs: &ExitRuns) -> Value {
    let mean = exit.time() / motion.diffusion;
    let [bound, free] = runs.ends;
    let [warmth, of_warmth] = runs.warmth;
    json!({
        "runs": {"bound": bound, "free": free, "given_up": runs.given_up},
        // Where some were given up the mean is longer than this.
        "mean_exit_s": finite(runs.time[0]),
        "standard_error_s": finite(runs.time[1]),
        "ratio": finite(runs.time[0] / mean),
        "ratio_error": finite(runs.time[1] / mean),
        "bound": finite(bound as f64 / (bound + free) as f64),
        "kinetic_over_kt": finite(warmth),
        "kinetic_over_kt_error": finite(of_warmth),
        "has_temperature": !is_cold(runs),
    })
}

/// Moving tiles have no temperature where their kinetic energy is below that of kT by more than this
/// share, ...
const WARM: f64 = 0.1;
/// ... and by more than so many standard errors.
const SURE: f64 = 3.0;

/// Whether knocks take energy that shaking does not give back.
fn is_cold(runs: &ExitRuns) -> bool {
    let [warmth, error] = runs.warmth;
    warmth < 1.0 - WARM && warmth < 1.0 - SURE * error
}

/// What moving tiles say of an exit, in a few lines.
pub fn check_summary(motion: &Motion, exit: &Exit, runs: &ExitRuns) -> String {
    let mean = exit.time() / motion.diffusion;
    let [bound, free] = runs.ends;
    let [time, error] = runs.time;
    let ended = bound + free;
    let is_least = runs.given_up > 0;
    let mut text = format!(
        "check: {} rigid bodies with inertia take {}{} +- {} on average, {}{:.2} +- {:.2} times as \
         long",
        ended + runs.given_up,
        if is_least { "more than " } else { "" },
        duration(time, 3),
        duration(error, 2),
        if is_least { "more than " } else { "" },
        time / mean,
        error / mean,
    );
    let _ = match ended {
        0 => writeln!(text),
        _ => writeln!(
            text,
            "; bound first in {:.0} % ({bound} of {ended})",
            100.0 * bound as f64 / ended as f64,
        ),
    };
    if is_least {
        let _ = writeln!(
            text,
            "  {} were given up under way, and count with the time until then",
            runs.given_up
        );
    }
    let [warmth, error] = runs.warmth;
    let _ = writeln!(
        text,
        "  their kinetic energy is {warmth:.2} +- {error:.2} times that of kT{}",
        match is_cold(runs) {
            true =>
                ": knocks take energy that the shaking does not give back, so no temperature exists",
            false => "",
        },
    );
    if motion.drag < OVERDAMPED {
        let _ = writeln!(
            text,
            "  a drag of {} /s lets tiles glide: overdamped rates are not theirs, and the ratio says \
             by how much",
            motion.drag
        );
    }
    text
}
