//! The yield of a shaken table as JSON, tables and a summary.

use std::fmt::Write;

use serde_json::{Value, json};

use super::csv::{number, table};
use super::files::{Files, PICTURES};
use super::page::yield_charts;
use super::terminal::write_table;
use jobs::design::Design;
use jobs::yields::attachment::Source;
use jobs::yields::{Outcome, Question, StateRates, Yields};
use physics::kinetics::mixture::Mixture;
use physics::units::{duration, plain, si};

/// The answer as `report.json` has it.
pub fn json(design: &Design, question: &Question, found: &Yields) -> Value {
    let best = found.best();
    let motion = &question.effort.motion;
    json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": { "name": design.name, "sha256": design.sha256 },
        "model": design.interaction.model.name(),
        "seed": question.seed,
        "tiles": question.tiles,
        "time_s": question.time,
        "coverage": question.coverage,
        "tile_area_m2": found.tile_area,
        "table_area_m2": found.crowd.area,
        // Share of all possible pairs that are in the bond at the end, at the best of the kT.
        "yield": finite(best.bound),
        "yield_interval": best.interval.map(finite),
        "best_kT_J": best.kt,
        // By kT, in the order asked for; null where there is no answer, and why.
        "settings": question.kts.iter().map(|kt| setting(found, *kt)).collect::<Value>(),
        // One kT after another, blind to the tiles, in equal slots; no schedule yields more than
        // the upper bound, not even one that sees the tiles.
        "mixture": found.mixture.as_ref().map(|(tiles, mixture)| json!({
            "tiles": tiles,
            "schedule_kT_J": mixture.schedule.iter().map(|k| found.outcomes[*k].kt)
                .collect::<Vec<_>>(),
            "yield": mixture.value,
            "upper_bound": mixture.bound,
        })),
        "rates": format!("{}; detachment by detailed balance", question.effort.told()),
        "docking": {
            "runs": question.effort.runs, "duration_s": question.effort.duration,
            "drag_per_s": motion.drag, "restitution": motion.restitution,
            "friction": motion.friction,
        },
    })
}

fn setting(found: &Yields, kt: f64) -> Value {
    match found.at(kt) {
        Ok(found) => outcome(found),
        Err(why) => json!({"kT_J": kt, "yield": null, "why_not": why.map(ToString::to_string)}),
    }
}

fn outcome(outcome: &Outcome) -> Value {
    json!({
        "kT_J": outcome.kt,
        "why_not": null,
        "yield": finite(outcome.bound),
        "yield_interval": outcome.interval.map(finite),
        "trapped": finite(outcome.trapped),
        "yield_difference_equations": outcome.smooth,
        "yield_equilibrium": outcome.equilibrium,
        "yield_simulated": outcome.simulated.map(|[mean, error]| json!({
            "mean": mean, "standard_error": error,
        })),
        "mean_time_to_bond_s": finite(outcome.mean_times[0]),
        "mean_time_out_of_bond_s": finite(outcome.mean_times[1]),
        "states": outcome.states.iter().map(state).collect::<Value>(),
        "attachments_elsewhere": outcome.attached.elsewhere,
        "docked_s": outcome.attached.time,
        "over_time": outcome.course.iter().map(|[time, bound, trapped]| json!({
            "time_s": time, "bound": finite(*bound), "trapped": finite(*trapped),
        })).collect::<Value>(),
        "table": outcome.table.iter().map(|(tiles, coverage, bound)| json!({
            "tiles": tiles, "coverage": coverage, "yield": finite(*bound),
        })).collect::<Value>(),
    })
}

fn state(state: &StateRates) -> Value {
    json!({
        "state": state.name,
        "attachments": state.attachments,
        "on_m2_per_s": state.on,
        "on_interval_m2_per_s": state.on_interval,
        "off_per_s": state.off,
        "depth_kT": state.depth,
        "ln_K": finite(state.ln_k),
    })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Tables and pictures, by their names.
pub fn files(question: &Question, found: &Yields) -> Files {
    let rows = found.outcomes.iter().flat_map(|outcome| {
        let kt = number(outcome.kt);
        outcome.table.iter().map(move |(tiles, coverage, bound)| {
            vec![
                kt.clone(),
                tiles.to_string(),
                number(*coverage),
                number(*bound),
            ]
        })
    });
    let yields = table(&["kT_J", "tiles", "coverage", "yield"], rows);
    let rows = found.outcomes.iter().flat_map(|outcome| {
        let kt = outcome.kt;
        let row = move |[time, bound, trapped]: &[f64; 3]| {
            [kt, *time, *bound, *trapped].map(number).to_vec()
        };
        outcome.course.iter().map(row)
    });
    let course = table(&["kT_J", "time_s", "bound", "trapped"], rows);
    let rows = found.outcomes.iter().flat_map(|outcome| {
        let kt = number(outcome.kt);
        outcome.states.iter().map(move |state| {
            let [low, high] = state.on_interval;
            let numbers = [state.on, low, high, state.off, state.depth, state.ln_k];
            let numbers = numbers.map(number);
            [
                &[
                    kt.clone(),
                    state.name.clone(),
                    state.attachments.to_string(),
                ][..],
                &numbers[..],
            ]
            .concat()
        })
    });
    let head = [
        "kT_J",
        "state",
        "attachments",
        "on_m2_per_s",
        "on_low_m2_per_s",
        "on_high_m2_per_s",
        "off_per_s",
        "depth_kT",
        "ln_K",
    ];
    let rates = table(&head, rows);
    let pictures = yield_charts::all(question, found).into_iter();
    let tables = [
        ("yield.csv", yields),
        ("course.csv", course),
        ("rates.csv", rates),
    ];
    tables
        .into_iter()
        .map(|(name, text)| (name.to_owned(), text.into_bytes()))
        .chain(pictures.map(|(stem, _, svg)| (format!("{PICTURES}/{stem}.svg"), svg.into_bytes())))
        .collect()
}

/// The sentence that answers.
pub fn headline(design: &Design, question: &Question, found: &Yields) -> String {
    let best = found.best();
    let among = match (found.outcomes.len(), found.without.len()) {
        (1, _) => String::new(),
        (n, 0) => format!(", the best of {n} shakings"),
        (n, _) => format!(", the best of {n} shakings that have an answer"),
    };
    format!(
        "{}: {} of all pairs are bound after {} at kT = {}{among}",
        design.name,
        percent(best.bound, Some(best.interval)),
        duration(question.time, 3),
        si(best.kt, "J", 3),
    )
}

/// A few lines for the terminal.
pub fn summary(design: &Design, question: &Question, found: &Yields) -> String {
    let mut text = format!("{}\n", headline(design, question, found));
    let _ = writeln!(
        text,
        "({} and {} tiles that cover {:.0} % of {:.2} m2; intervals: {})\n",
        found.crowd.tiles[0],
        found.crowd.tiles[1],
        100.0 * question.coverage,
        found.crowd.area,
        match question.effort.source {
            Source::Docking => "of the attachment rate, 95 %",
            Source::Overdamped => "what the two finest meshes differ by",
        }
    );
    let head = [
        "kT",
        "bound",
        "in traps",
        "in the end",
        "simulated",
        "to bond",
        "out of bond",
    ];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(question.kts.iter().map(|kt| row(found, *kt)));
    write_table(&mut text, &rows);
    for (_, why) in &found.without {
        let _ = writeln!(text, "{why}");
    }
    if let Some((tiles, mixture)) = &found.mixture {
        let _ = writeln!(
            text,
            "\n{tiles} tiles, one shaking after another: {} ({}); no schedule yields more than {}",
            percent(mixture.value, None),
            phases(question, found, mixture),
            mixture
                .bound
                .map_or("?".to_owned(), |bound| percent(bound, None)),
        );
    }
    let best = found.best();
    let _ = writeln!(text, "\nstates at kT = {}:", si(best.kt, "J", 3));
    let head = ["state", "depth", "ln K", "attached", "on", "off"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(best.states.iter().map(|state| {
        [
            state.name.clone(),
            format!("{:.1} kT", state.depth),
            format!("{:.1}", state.ln_k),
            match best.attached.solved {
                Some(_) => "-".to_owned(),
                None => format!("{} of {}", state.attachments, best.attached.runs),
            },
            format!("{} m2/s", scientific(state.on)),
            format!("{} /s", plain(state.off, 2)),
        ]
    }));
    write_table(&mut text, &rows);
    let _ = writeln!(
        text,
        "(on: {}; off: by detailed balance, with kT as if the table had one)",
        question.effort.told()
    );
    text
}

/// Which shaking when: `30 min at 2 mJ, then 30 min at 1 mJ`.
pub(super) fn phases(question: &Question, found: &Yields, mixture: &Mixture) -> String {
    let kts = mixture.schedule.chunk_by(|a, b| a == b);
    let phases = kts.map(|part| {
        let time = question.time * part.len() as f64 / mixture.schedule.len() as f64;
        let kt = found.outcomes[part[0]].kt;
        format!("{} at {}", duration(time, 2), si(kt, "J", 2))
    });
    phases.collect::<Vec<_>>().join(", then ")
}

fn row(found: &Yields, kt: f64) -> [String; 7] {
    let Ok(outcome) = found.at(kt) else {
        let mut row = std::array::from_fn(|_| "-".to_owned());
        row[0] = si(kt, "J", 3);
        return row;
    };
    let time = |time: f64| match time.is_finite() {
        true => duration(time, 2),
        false => "never".to_owned(),
    };
    [
        si(outcome.kt, "J", 3),
        percent(outcome.bound, Some(outcome.interval)),
        percent(outcome.trapped, None),
        outcome
            .equilibrium
            .map_or("-".to_owned(), |share| percent(share, None)),
        outcome.simulated.map_or("-".to_owned(), |[mean, error]| {
            format!("{:.1} +- {:.1} %", 100.0 * mean, 200.0 * error)
        }),
        time(outcome.mean_times[0]),
        time(outcome.mean_times[1]),
    ]
}

/// `42 % (38-45)`.
fn percent(share: f64, interval: Option<[f64; 2]>) -> String {
    let one = |share: f64| match 100.0 * share {
        percent if percent > 0.0 && percent < 1.0 => format!("{percent:.2}"),
        percent => format!("{percent:.0}"),
    };
    match interval {
        Some([low, high]) => format!("{} % ({}-{})", one(share), one(low), one(high)),
        None => format!("{} %", one(share)),
    }
}

fn scientific(value: f64) -> String {
    format!("{value:.1e}")
}
