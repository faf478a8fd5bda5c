//! What making does to a design, as a document.

use serde_json::{Value, json};

use super::document::{Document, Drawing, Entries, Table, entries, rows};
use super::files::{PAGE, REPORT};
use super::plots::chart::{Chart, Dimension, Look};
use jobs::design::Design;
use jobs::output::Command;
use jobs::tolerance::{Drawn, Tolerance};
use physics::landscape::Proportion;
use physics::units::{plain, share_to, share_with, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "tolerance",
    files: &[
        REPORT,
        PAGE,
        "draws.csv",
        "matters.csv",
        "flipped.csv",
        "safer.csv",
    ],
    pictures: &["bond", "selectivity", "matters"],
};

/// Sources of variance listed for people.
const LISTED: usize = 12;
/// Beyond this relative error of followed energies, shares are said to be uncertain.
const MOST_FOLLOWED: f64 = 0.5;
/// Number of bars of a histogram.
const BARS: usize = 30;

/// The document of a tolerance.
pub fn document<'a>(design: &Design, found: &Tolerance) -> Document<'a> {
    Document {
        title: format!("Tolerance of {}", design.name),
        answer: answer(design, found),
        remarks: [errors(found)]
            .into_iter()
            .chain(too_large(found))
            .collect(),
        entries: found_entries(design, found),
        pictures: pictures(found).into_iter().map(Drawing::from).collect(),
        notes: notes(design, found),
        origin: format!(
            "{} magnets; states followed from those without errors; intervals 95 %",
            design.interaction.model.name()
        ),
        ..Document::default()
    }
}

fn answer(design: &Design, found: &Tolerance) -> String {
    let least = found.making.least_selectivity();
    let of_nominal = match found.nominal.works(least) {
        true => "without errors it works",
        false => "without errors it does not work either",
    };
    let selectivity = match found.nominal.selectivity() {
        ratio if ratio.is_finite() => format!(" (selectivity {ratio:.3})"),
        _ => String::new(),
    };
    format!(
        "{}: {} of the pairs made with these errors work, with a bond at least {least} times as deep as \
         any trap; {of_nominal}{selectivity}",
        design.name,
        within(&found.works),
    )
}

/// That the share is hardly known, as states cannot be followed so far.
fn too_large(found: &Tolerance) -> Option<String> {
    let exact = &found.exact;
    let of_trap = exact.trap.map_or(0.0, |[rms, _]| rms);
    let worst = exact.bond[0].max(of_trap);
    let anew = found.anew.as_ref().map_or(String::new(), |anew| {
        format!(": of those analysed anew {} work", within(&anew.works))
    });
    (worst > MOST_FOLLOWED).then(|| {
        format!(
            "these errors are too large to follow states: followed energies are off by {}, so that the shares              may be far off{anew}; more --checks tell more",
            share_to(worst, 2)
        )
    })
}

/// The errors, for people.
fn errors(found: &Tolerance) -> String {
    let making = &found.making;
    let percent = |share: f64| share_to(share, 3);
    let parts = [
        making
            .strength
            .map(|it| format!("strength {}", percent(it))),
        making
            .batch
            .map(|it| format!("{} of its variance in common", percent(it))),
        making.place.map(|it| format!("place {}", si(it, "m", 3))),
        making
            .turn
            .map(|it| format!("turn {}\u{b0}", plain(it.to_degrees(), 3))),
        making.gap.map(|it| format!("gap {}", si(it, "m", 3))),
        making.flip.map(|it| format!("flipped {}", percent(it))),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    format!(
        "(errors: {}; {} draws)",
        parts.join(", "),
        found.outcomes.len()
    )
}

/// A share with its interval.
fn within(share: &Proportion) -> String {
    format!(
        "{:.1} % ({:.1} to {:.1} %)",
        100.0 * share.share(),
        100.0 * share.low,
        100.0 * share.high
    )
}

fn interval(share: &Proportion) -> [f64; 2] {
    [share.low, share.high]
}

fn share_json(share: &Proportion) -> Value {
    json!({"share": share.share(), "interval": interval(share)})
}

// One line an entry.
#[rustfmt::skip]
fn found_entries(design: &Design, found: &Tolerance) -> Entries {
    let bond = &found.bond;
    let spread = format!(
        "{} +- {}", si(bond.mean, "J", 4), si(bond.sd, "J", 2)
    );
    let from_to = format!("90 % from {} to {}; without errors {}", si(bond.p05, "J", 4), si(bond.p95, "J", 4), si(bond.nominal, "J", 4));
    let (beats, beaten) = &found.beats;
    let anew = found.anew.as_ref();
    entries(design)
        .data("seed", found.seed)
        .data("errors", found.making)
        .data("draws", found.outcomes.len())
        .fact("works_share", "work", found.works.share()).viewed(within(&found.works)).in_view()
        .data("works", share_json(&found.works))
        .fact("bond_energy", "bond", bond.mean).viewed(spread).noted(from_to).in_view()
        .data("bond_J", bond)
        .data("selectivity", found.selectivity)
        .table(reasons(found))
        .fact("trap_beats", "trap beats", beaten.share()).viewed(within(beaten))
            .noted(format!("deepest trap deeper than {} of the bond without errors", plain(*beats, 3))).in_view()
        .data("trap_beats", json!({"of_bond": beats, "share": beaten.share(), "interval": interval(beaten)}))
        .table(matters(found))
        .data("explained", found.explained)
        .table(flipped(found))
        .table(safer(found))
        .data("followed", json!({"states": found.followed[0], "of": found.followed[1]}))
        .data("held_back", share_json(&found.held_back))
        .data("exact", json!({
            "draws": found.exact.draws,
            "bond_error_rms": found.exact.bond[0], "bond_error_max": found.exact.bond[1],
            "trap_error_rms": found.exact.trap.map(|it| it[0]), "trap_error_max": found.exact.trap.map(|it| it[1]),
        }))
        .data("anew", json!(anew.map(|it| json!({
            "draws": it.works.of, "works": share_json(&it.works), "followed": share_json(&it.followed),
            "agree": it.agree, "bond_difference_max": it.differences[0], "trap_difference_max": it.differences[1],
        }))))
        .table(draws(found))
}

#[rustfmt::skip]
fn reasons(found: &Tolerance) -> Table {
    rows(found.reasons.clone())
        .data("reason", |it| it.name)
        .column("label", "reason", "why draws do not work; a draw can have several", |it| it.label.clone()).in_view()
        .column("share", "share", "of the draws", |it| it.share.share()).viewed(|it| within(&it.share))
        .data("interval", |it| interval(&it.share))
        .table("reasons").titled("Why draws do not work", "")
}

#[rustfmt::skip]
fn matters(found: &Tolerance) -> Table {
    rows(found.matters.clone())
        .column("magnet", "magnet", "a magnet, or a face for gaps; counted along the face", |it| it.magnet.clone())
        .column("error", "error", "kind of error", |it| it.error)
        .column("share_of_variance", "of the bond", "share of the variance of the bond's energy, to first order", |it| it.of_bond)
            .viewed(move |it| share_with(it.of_bond, 1))
        .column("share_of_selectivity_variance", "of selectivity", "share of the variance of ln(selectivity), to first order", |it| it.of_selectivity)
            .viewed(move |it| it.of_selectivity.map_or("-".to_owned(), |it| share_with(it, 1)))
        .column("sd_J", "spread", "standard deviation of the bond's energy by it alone", |it| it.sd)
        .table("matters").titled("What matters most", "").in_file("matters").listing(LISTED)
}

#[rustfmt::skip]
fn flipped(found: &Tolerance) -> Table {
    rows(found.flipped.clone())
        .column("magnet", "flipped magnet", "the magnet whose poles are exchanged", |it| it.magnet.clone())
        .column("bond_J", "bond", "energy of the bond with it, without other errors", |it| it.bond).digits(4)
        .column("noticed", "noticed", "share of draws in which the bond with it is weaker than 95 % of those without flips", |it| it.noticed.share())
            .viewed(|it| within(&it.noticed))
        .data("interval", |it| interval(&it.noticed))
        .table("flipped").titled("One magnet glued in the wrong way round", "").in_file("flipped")
}

#[rustfmt::skip]
fn safer(found: &Tolerance) -> Table {
    rows(found.safer.clone())
        .column("key", "change", "the changed key of [magnet]", |it| it.key)
        .column("by_m", "by", "added to it", |it| it.by)
        .column("bond_J", "bond", "energy of the bond without errors", |it| it.nominal.bond).digits(4)
        .column("selectivity", "selectivity", "without errors", |it| Some(it.nominal.selectivity()).filter(|it| it.is_finite()))
        .column("sd_J", "spread", "standard deviation of the bond's energy", |it| it.bond.sd)
        .column("works", "work", "share of the draws that work", |it| it.works.share()).viewed(|it| within(&it.works))
        .data("interval", |it| interval(&it.works))
        .column("works_unchanged", "unchanged", "share of the same draws of the design itself", |it| it.unchanged.share())
            .viewed(|it| within(&it.unchanged))
        .table("safer").titled("Other insets and pitches, with the same errors", "").in_file("safer")
}

#[rustfmt::skip]
fn draws(found: &Tolerance) -> Table {
    let least = found.making.least_selectivity();
    rows(found.outcomes.iter().copied().enumerate())
        .data("draw", |(k, _)| *k) // number of the draw
        .data("bond_J", |(_, it)| it.bond) // energy of the bond
        .data("trap_J", |(_, it)| it.trap) // energy of the deepest trap
        .data("selectivity", |(_, it)| it.selectivity()) // the bond's depth over the trap's
        .data("flipped", |(_, it)| it.is_flipped) // whether a magnet is flipped
        .data("works", move |(_, it)| it.works(least)) // whether the pair works
        .table("draws").in_csv("draws")
}

fn notes(design: &Design, found: &Tolerance) -> Vec<String> {
    let percent = |share: f64| share_to(share, 2);
    let [followed, of] = found.followed;
    let exact = &found.exact;
    let traps = exact.trap.map_or(String::new(), |[rms, most]| {
        format!(
            ", of the deepest trap {} (at most {})",
            percent(rms),
            percent(most)
        )
    });
    let mut notes = vec![format!(
        "{followed} of {of} states are followed; error of following, from {} draws minimised with exact \
         energies: of the bond {} (at most {}){traps}",
        exact.draws,
        percent(exact.bond[0]),
        percent(exact.bond[1]),
    )];
    if let Some(anew) = &found.anew {
        notes.push(format!(
            "{} draws analysed anew: {} work, {} of the same draws work by followed states; the verdict agrees \
             in {}",
            anew.works.of, anew.works.count, anew.followed.count, anew.agree
        ));
    }
    if let Some(explained) = found.explained {
        notes.push(format!(
            "what matters is computed to first order, which gives {} of the variance of the draws",
            percent(explained)
        ));
    }
    if found.held_back.count > 0 {
        notes.push(format!(
            "in {} of the draws a turned or shifted magnet would stick out of its face and stops at the surface: \
             with a deeper `inset` it would not",
            percent(found.held_back.share())
        ));
    }
    if !found.safer.is_empty() {
        notes.push(format!(
            "other insets and pitches are re-runs with the same random numbers ({} draws); their states are \
             followed from those of the design, not searched",
            found.safer[0].works.of
        ));
    }
    if design.pitch.is_none() {
        notes.push("the design has no `pitch`, so none is varied".to_owned());
    }
    notes
}

/// Histograms, and bars of what matters.
fn pictures(found: &Tolerance) -> Vec<Chart> {
    let bonds = found.outcomes.iter().map(|it| -it.bond).collect::<Vec<_>>();
    let ratios = found.outcomes.iter().map(Drawn::selectivity);
    let ratios: Vec<f64> = ratios.filter(|it| it.is_finite()).collect();
    let count = || Dimension::new("draws", "draws");
    let mut charts = vec![
        Chart::new(
            "bond",
            "Depth of the bond",
            Dimension::new("depth_J", "depth of the bond"),
            count(),
        )
        .remarked(format!(
            "without errors {}",
            si(-found.bond.nominal, "J", 4)
        ))
        .with("draws", Look::Bars, histogram(&bonds)),
    ];
    if !ratios.is_empty() {
        charts.push(
            Chart::new(
                "selectivity",
                "Depth of the bond over that of the deepest trap",
                Dimension::new("selectivity", "selectivity"),
                count(),
            )
            .remarked(format!(
                "a pair works from {} on",
                found.making.least_selectivity()
            ))
            .with("draws", Look::Bars, histogram(&ratios)),
        );
    }
    if !found.matters.is_empty() {
        let bars = found.matters.iter().take(LISTED).enumerate();
        let name = |(k, it): (usize, &jobs::tolerance::Matter)| {
            format!("{} {} {}", k + 1, it.magnet, it.error)
        };
        let names: Vec<String> = bars.clone().map(name).collect();
        let bars = bars.map(|(k, it)| [(k + 1) as f64, it.of_bond]);
        charts.push(
            Chart::new(
                "matters",
                "Shares of the variance of the bond",
                Dimension::new("rank", "rank").marked((1..=names.len()).map(|k| k as f64)),
                Dimension::share("share_of_variance", "share of the variance"),
            )
            .remarked(names.join(", "))
            .with("share", Look::Bars, bars),
        );
    }
    charts
}

/// The numbers of values in equal intervals, at their middles.
fn histogram(values: &[f64]) -> Vec<[f64; 2]> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Equal up to rounding: one bar.
    let width = (high - low).max(1e-9 * high.abs()).max(f64::MIN_POSITIVE) / BARS as f64;
    let mut counts = vec![0.0; BARS];
    for value in values {
        counts[(((value - low) / width) as usize).min(BARS - 1)] += 1.0;
    }
    let middle = |k: usize| low + (k as f64 + 0.5) * width;
    counts
        .iter()
        .enumerate()
        .map(|(k, n)| [middle(k), *n])
        .collect()
}
