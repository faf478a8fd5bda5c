//! Calibrations as documents: shields fitted to measurements, and kT fitted to observed pairs.

use serde_json::{Value, json};

use crate::document::{Document, Drawing, Entries, Entry, Table, Unit, describe, entries, rows};
use crate::files::{PAGE, REPORT};
use crate::plots::chart::{Chart, Dimension, Look};
use jobs::calibration::bonds::{Times, TimesFit};
use jobs::calibration::distances::{DistanceFit, critical};
use jobs::calibration::strength::{Compared, StrengthFit};
use jobs::calibration::{Calibration, Fitted, QUANTITIES, Residuals};
use jobs::design::Design;
use jobs::output::Command;
use physics::dynamics::docking::OnRate;
use physics::potential::MagnetModel;
use physics::units::{plain, share_with, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "calibrate",
    files: &[REPORT, PAGE, "readings.csv"],
    pictures: &["force", "misfit"],
};

/// The constants of a shield: key in reports, name in a design file, unit.
const CONSTANTS: [(&str, &str, &str); 4] = [
    ("attenuation", "attenuation", ""),
    ("length_m", "length", " m"),
    ("width", "width", ""),
    ("front_gain", "front_gain", ""),
];
/// Keys of the measured quantities.
const KEYS: [&str; 4] = ["energy_J", "force_x_N", "force_y_N", "torque_Nm"];

/// The document of a calibration.
pub fn document(design: &Design, found: &Fitted) -> Document<'static> {
    match found {
        Fitted::Shields(found) => shields(design, found),
        Fitted::Strength(found) => strength_of_magnets(design, found),
        Fitted::Distances(found) => distances(design, found),
        Fitted::Times(found) => intervals(design, found),
    }
}

/// The document of fitted shields, with the lines for a design file.
fn shields(design: &Design, found: &Calibration) -> Document<'static> {
    let (fitted, held_out) = (&found.fitted, &found.held_out);
    let constants = |values: [f64; 4]| -> Value {
        let named = CONSTANTS.iter().zip(values);
        named
            .map(|((key, ..), value)| ((*key).to_owned(), json!(value)))
            .collect()
    };
    let shield = found.shield;
    let values = [
        shield.attenuation,
        shield.length,
        shield.width,
        shield.front_gain,
    ];
    let unsettled = (!found.settled).then(|| {
        let steps = found.steps;
        format!("the fit did not converge in {steps} steps: do not trust its constants")
    });
    Document {
        title: format!("{}: shields fitted to measurements", design.name),
        answer: format!(
            "{}, magnets as {}: fitted to {}; held out: {}",
            design.name,
            design.interaction.model.plural(&design.pair),
            counted(fitted),
            counted(held_out),
        ),
        remarks: vec![lines(values, found.standard_errors)],
        entries: entries(design)
            .data("shield", constants(values))
            .data("standard_errors", constants(found.standard_errors))
            .fact("strength", "", found.strength)
            .data("fitted", residuals(fitted))
            .data("held_out", residuals(held_out))
            .fact("steps", "", found.steps)
            .fact("settled", "", found.settled)
            .table(errors(fitted, held_out)),
        notes: [strength(found)].into_iter().chain(unsettled).collect(),
        origin: "shields of soft iron".to_owned(),
        ..Document::default()
    }
}

/// The document of the magnets' strength.
// One line an entry.
#[rustfmt::skip]
fn strength_of_magnets(design: &Design, found: &StrengthFit) -> Document<'static> {
    let readings = readings(found);
    Document {
        title: format!("{}: the magnets' strength from measured forces", design.name),
        answer: strength_answer(design, found),
        remarks: strength_lines(design, found),
        entries: entries(design)
            .fact("remanence_T", "remanence", found.remanence).digits(4)
            .data("interval_T", found.interval)
            .fact("interval_shown_T", "95 % interval", found.interval.map(|it| it.map(Some))).in_view()
            .fact("nominal_T", "remanence in the design", found.nominal).digits(4)
            .fact("gap_offset_m", "offset of the gap", found.offset).noted("how much further apart the poles are than the design and the gaps say")
            .data("gap_offset_interval_m", found.offset_interval)
            .fact("misfit_rms", "misfit", found.misfit).share().noted("root mean square, of the readings")
            .fact("fits", "", found.fits)
            .more((!found.readings.is_empty()).then_some(Entry::Table(readings))),
        pictures: match found.readings.is_empty() {
            true => Vec::new(),
            false => vec![Drawing::from(forces(found)), Drawing::from(misfits(found))],
        },
        notes: strength_notes(design, found),
        origin: format!("uniformly magnetised {}", design.interaction.model.plural(&design.pair)),
        ..Document::default()
    }
}

fn strength_answer(design: &Design, found: &StrengthFit) -> String {
    let (name, misfit) = (&design.name, describe(found.misfit, Unit::Share, 2));
    if !found.fits {
        let needed = found
            .readings
            .iter()
            .map(|it| (it.reading.gap, it.remanence));
        let needed: Vec<_> = needed.collect();
        let ends = needed.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        let ends = ends.zip(needed.iter().max_by(|a, b| a.1.total_cmp(&b.1)));
        let ends = ends.map_or(String::new(), |(low, high)| {
            let at_gap = |(gap, remanence): &(f64, f64)| {
                let place = match *gap > 0.0 {
                    true => format!("at {}", si(*gap, "m", 2)),
                    false => "at contact".to_owned(),
                };
                format!("{remanence:.2} T {place}")
            };
            format!(": the readings need {} and {}", at_gap(low), at_gap(high))
        });
        let best = format!(
            "{:.2} T with the poles {} further apart than the design says, misfit {misfit}",
            found.remanence,
            si(found.offset, "m", 2)
        );
        return format!("{name}: no remanence fits these forces{ends} (closest: {best})");
    }
    let interval = found
        .interval
        .map_or("one reading, so no interval".to_owned(), |[low, high]| {
            format!("95 % interval: {low:.3} to {high:.3} T")
        });
    format!(
        "{name}: the magnets have a remanence of {:.3} T ({interval}); the design says {:.3} T",
        found.remanence, found.nominal
    )
}

/// The lines for a design file.
fn strength_lines(design: &Design, found: &StrengthFit) -> Vec<String> {
    if !found.fits {
        return Vec::new();
    }
    if !found.is_common {
        return vec![format!(
            "the design's magnets differ: multiply the remanence of each by {:.4}",
            found.remanence / found.nominal
        )];
    }
    let interval = found.interval.map_or(String::new(), |[low, high]| {
        format!("  # {low:.3} to {high:.3} T")
    });
    let line = format!("remanence = {:.4}", found.remanence);
    let mut lines = vec![format!("\n[magnet]\n{line:<20}{interval}")];
    let is_certain = found
        .offset_interval
        .is_some_and(|[low, high]| low > 0.0 || high < 0.0);
    if is_certain && found.offset.abs() > LEAST_OFFSET {
        lines.push(format!(
            "the poles are {} {} apart than the design and the gaps say: change `inset` by {} on both \
             tiles, unless it is the zero of the gaps",
            si(found.offset.abs(), "m", 2),
            if found.offset > 0.0 { "further" } else { "less far" },
            si(0.5 * found.offset, "m", 2),
        ));
    }
    if design.interaction.model == MagnetModel::Dipole {
        lines.push(
            "point dipoles are wrong near contact: --model cuboid fits magnets as they are"
                .to_owned(),
        );
    }
    lines
}

fn strength_notes(design: &Design, found: &StrengthFit) -> Vec<String> {
    let mut notes = Vec::new();
    if found.is_reversed {
        notes.push(
            "the measured values have the opposite sign of the design's and were reversed: an \
             attracted moving tile is pulled towards the fixed one"
                .to_owned(),
        );
    }
    if found.offset_interval.is_none() {
        notes.push(
            "the zero of the gaps is taken as exact: measure at four gaps or more to fit it"
                .to_owned(),
        );
    }
    if !found.fits {
        notes.push(format!(
            "check the size and number of the magnets and their inset in {}, whether the tiles stayed \
             parallel, the zero of the gaps and what lay between the faces, and steel nearby",
            design.name
        ));
    }
    notes
}

/// Smaller offsets (m) are below what a gauge of paper or card resolves.
const LEAST_OFFSET: f64 = 2e-5;

// One line per column: key, name, meaning, value.
#[rustfmt::skip]
fn readings(found: &StrengthFit) -> Table {
    let off = |it: &Compared| (it.fitted > 0.0).then(|| it.reading.force / it.fitted - 1.0);
    rows(found.readings.clone())
        .column("gap_m", "gap", "between the target faces", |it| it.reading.gap)
        .column("force_N", "measured", "force straight apart or together", |it| it.reading.force)
        .column("fitted_N", "fitted", "by the fitted remanence and offset", |it| it.fitted)
        .column("misfit", "misfit", "measured over fitted, less 1", move |it| off(it)).share()
        .column("nominal_N", "nominal", "by the design's remanence, without an offset", |it| it.nominal)
        .column("remanence_T", "remanence", "that gives the reading without an offset", |it| it.remanence).digits(4)
        .table("readings")
        .titled("forces over the gap", "")
        .in_file("readings")
}

fn forces(found: &StrengthFit) -> Chart {
    let measured = found.readings.iter().filter(|it| it.reading.force > 0.0);
    let curve = |k: usize| found.curve.iter().map(move |point| [point[0], point[k]]);
    Chart::new(
        "force",
        "measured and fitted force over the gap",
        Dimension::new("gap_m", "gap between the faces"),
        Dimension::new("force_N", "force").logarithmic(),
    )
    .with("fitted", Look::Steps, curve(1))
    .with("the design's remanence", Look::Dashed, curve(2))
    .with(
        "measured",
        Look::Dots,
        measured.map(|it| [it.reading.gap, it.reading.force]),
    )
}

fn misfits(found: &StrengthFit) -> Chart {
    let point = |it: &Compared| [it.reading.gap, it.reading.force / it.fitted - 1.0];
    let largest = found.readings.iter().map(|it| point(it)[1].abs());
    let largest = 1.1 * largest.fold(0.01, f64::max);
    Chart::new(
        "misfit",
        "measured over fitted force, less 1",
        Dimension::new("gap_m", "gap between the faces"),
        Dimension::share("misfit", "misfit").within([-largest, largest]),
    )
    .with("measured", Look::Dots, found.readings.iter().map(point))
}

fn counted(part: &Residuals) -> String {
    let bare = part.rows - part.with_iron;
    format!("{} rows with iron and {bare} without", part.with_iron)
}

/// The lines for a design file.
fn lines(values: [f64; 4], errors: [f64; 4]) -> String {
    let mut text = "\n[shield]".to_owned();
    for ((value, error), (_, name, unit)) in values.into_iter().zip(errors).zip(CONSTANTS) {
        // On the logarithmic scale of the fit, a constant is known only if its error is smaller
        // than its value.
        let error = match error < value {
            true => format!("+- {error:.1e}{unit}"),
            false => "not determined by these rows".to_owned(),
        };
        let line = format!("{name} = {value:.4}");
        text += &format!("\n{line:<28}# {error}");
    }
    text
}

fn strength(found: &Calibration) -> String {
    if found.fitted.rows == found.fitted.with_iron {
        return "no rows without iron: the magnets' strength is taken from the design".to_owned();
    }
    let strength = found.strength;
    format!(
        "without iron the measured values are {strength:.4} times the model's: multiply the \
         magnets' remanence or moment by {:.4}",
        strength.sqrt()
    )
}

/// The error of the model for each measured quantity.
fn errors(fitted: &Residuals, held_out: &Residuals) -> Table {
    let describe = |part: &Residuals, k: usize| match part.rms[k].zip(part.relative[k]) {
        Some((rms, off)) => format!("{} ({})", si(rms, QUANTITIES[k].1, 3), share_with(off, 2)),
        None => "none".to_owned(),
    };
    let known = |k: &usize| fitted.rms[*k].is_some() || held_out.rms[*k].is_some();
    rows((0..QUANTITIES.len()).filter(known))
        .shown("measured", "", |k| QUANTITIES[*k].0)
        .shown("fitted", "root mean square", move |k| describe(fitted, *k))
        .shown("held out", "root mean square", move |k| {
            describe(held_out, *k)
        })
        .table("")
        .in_view()
        .titled(
            "root mean square of measured minus modelled values, and relative to the measured \
             values",
            "",
        )
}

fn residuals(part: &Residuals) -> Value {
    let by_quantity = |values: &[Option<f64>; 4]| -> Value {
        let entries = KEYS.iter().zip(values);
        entries.map(|(key, value)| (*key, json!(value))).collect()
    };
    json!({
        "rows": part.rows,
        "rows_with_iron": part.with_iron,
        "rms": by_quantity(&part.rms),
        "relative": by_quantity(&part.relative),
    })
}

/// kT (J) with its 95 % interval, for reports.
fn of_kt(design: &Design, kt: Option<f64>, interval: [Option<f64>; 2]) -> Entries {
    entries(design)
        .fact("kT_J", "kT", kt)
        .noted("effective energy of shaking")
        // The ends are separate entries, since one may be unknown.
        .data("kT_interval_J", interval)
        .fact("interval_J", "95 % interval", interval)
        .in_view()
}

fn energy(kt: Option<f64>) -> String {
    kt.map_or("?".to_owned(), |kt| si(kt, "J", 3))
}

/// The document of kT from intervals of pairs.
fn intervals(design: &Design, found: &TimesFit) -> Document<'static> {
    let TimesFit {
        times, area, kt, ..
    } = found;
    let (kt, [least, most]) = (*kt, found.interval);
    let (bound, apart) = (&times.bound, &times.apart);
    let kind = |times: &Times| {
        json!({
            "count": times.whole.len(),
            "cut_off": times.cut.len(),
            "mean_s": times.mean(),
            "statistic": times.statistic(),
        })
    };
    let doubts = [("bound", bound), ("apart", apart)];
    let doubts = doubts.iter().filter_map(|(name, times)| doubt(name, times));
    Document {
        title: format!("{}: kT from bound and separate intervals", design.name),
        answer: match kt {
            Some(_) => format!(
                "{}: bound and separate intervals fit kT = {} (95 % interval: {} to {})",
                design.name,
                energy(kt),
                energy(least),
                energy(most)
            ),
            None => format!(
                "{}: no kT explains these intervals (bond of 2 to 120 kT)",
                design.name
            ),
        },
        remarks: vec![
            format!(
                "measured: bound for {} on average over {} intervals, apart for {} on average \
                 over {}; area per pair {} m²",
                si(bound.mean(), "s", 3),
                bound.whole.len(),
                si(apart.mean(), "s", 3),
                apart.whole.len(),
                plain(*area, 4),
            ),
            "the interval includes the scatter of these times but no error of the energies"
                .to_owned(),
        ],
        entries: of_kt(design, kt, [least, most])
            .fact("area_m2", "", *area)
            .data("bound", kind(bound))
            .data("apart", kind(apart))
            .data("critical", OnRate::CRITICAL),
        notes: doubts.collect(),
        origin: "intervals of pairs".to_owned(),
        ..Document::default()
    }
}

/// A note if intervals are not known to be exponential.
fn doubt(name: &str, times: &Times) -> Option<String> {
    match times.statistic() {
        None => Some(format!(
            "unfinished times {name}: {}; only their observed part is used, and it is not tested \
             whether these times are exponential",
            times.cut.len()
        )),
        Some(statistic) if statistic > OnRate::CRITICAL => Some(format!(
            "the times {name} are not exponential (statistic {statistic:.2} above {}): one kT \
             does not describe them",
            OnRate::CRITICAL
        )),
        Some(_) => None,
    }
}

/// The document of kT from distances of pairs, with a test of whether a single kT explains them.
fn distances(design: &Design, found: &DistanceFit) -> Document<'static> {
    let [low, high] = found.interval.map(energy);
    let (statistic, freedom) = found.pearson.unzip();
    let refuted = found
        .pearson
        .filter(|(statistic, freedom)| *statistic > critical(*freedom));
    let refuted = refuted.map(|(statistic, freedom)| {
        format!(
            "these are not equilibrium distances at one kT: Pearson's statistic of {statistic:.1} \
             is above {:.1}",
            critical(freedom)
        )
    });
    Document {
        title: format!("{}: kT from the distances of pairs", design.name),
        answer: match found.kt {
            Some(_) => format!(
                "{}: the distances fit kT = {} (95 % interval: {low} to {high})",
                design.name,
                energy(found.kt),
            ),
            None => format!(
                "{}: no kT within the range fits (bond of 0.5 to 60 kT); one end fits best ({low} \
                 to {high}, 95 %)",
                design.name
            ),
        },
        remarks: vec![format!(
            "{} distances up to {}; {} larger ones are left out; the distribution is known to \
             {:.1} points",
            found.count,
            si(found.within, "m", 3),
            found.beyond,
            100.0 * found.error,
        )],
        entries: of_kt(design, found.kt, found.interval).data(
            "distances",
            json!({
                "count": found.count,
                "beyond": found.beyond,
                "within_m": found.within,
                "distribution_error": found.error,
                "statistic": statistic,
                "degrees_of_freedom": freedom,
                "critical": freedom.map(critical),
            }),
        ),
        notes: refuted.into_iter().collect(),
        origin: "distances of pairs".to_owned(),
        ..Document::default()
    }
}
