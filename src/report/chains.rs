//! Chains and rings of equal tiles in a yield.

use serde_json::{Value, json};

use crate::document::{Entries, Table, rows};
use crate::figures::within;
use crate::plots::chart::{Chart, Dimension, Look};
use jobs::yields::{Chains, Count, Mean, Request, Yield};
use physics::units::{duration, plain, share_to, si};

/// The bonds and the shares of tiles, in a sentence.
pub(crate) fn answer(name: &str, request: &Request, best: &Yield, built: &Chains) -> String {
    let [single, chains, rings] = built.shares.map(|share| percent(share.mean));
    format!(
        "{name}: {} bonds of {} equal tiles after {} at kT = {}; {single} of the tiles are single, {chains} in chains \
         and {rings} in rings",
        number(&built.bonds),
        request.tiles,
        duration(request.time, 3),
        si(best.kt, "J", 3),
    )
}

/// What was built at the best kT.
pub(crate) fn entries(built: &Chains) -> Entries {
    let [single, chains, rings] = built.shares;
    let share = |part: &Mean| within(part.mean, [part.low, part.high], percent);
    Entries::default()
        .data("bonds", built.bonds)
        .fact("", "bonds", number(&built.bonds))
        .in_view()
        .noted(format!(
            "at the end, mean over {} simulations with its interval",
            built.runs
        ))
        .data(
            "tiles_in",
            json!({"single": single, "chains": chains, "rings": rings}),
        )
        .fact("", "single tiles", share(&single))
        .in_view()
        .fact("", "in chains", share(&chains))
        .in_view()
        .fact("", "in rings", share(&rings))
        .in_view()
        .data("longest_chain", built.longest)
        .data("closures", &built.closings)
        .table(structures(built))
        .table(course(built))
}

/// The same of one kT, as JSON.
pub(crate) fn of_setting(built: &Chains) -> Value {
    json!({
        "bonds": built.bonds,
        "tiles_in": {
            "single": built.shares[0],
            "chains": built.shares[1],
            "rings": built.shares[2],
        },
        "longest_chain": built.longest,
        "closures": built.closings,
        "structures": structures(built).json(),
    })
}

/// How chains were counted, and what closes.
pub(crate) fn notes(built: &Chains) -> Vec<String> {
    let longest = match built.longest {
        Some(longest) => format!("the longest chain that has room has {longest} tiles; "),
        None => String::new(),
    };
    let closing: Vec<String> = built
        .closings
        .iter()
        .map(|it| {
            // Without counted attachments the rate is not known.
            let rate = match it.rate > 0.0 {
                true => format!("{} /s", plain(it.rate, 2)),
                false => "an unknown rate".to_owned(),
            };
            format!(
                "a chain of {} closes to a ring at {rate}, as its ends are as near as in {}",
                it.size,
                area(it.area)
            )
        })
        .collect();
    let closing = match closing.is_empty() {
        true => "no chain that always turns the same way meets its own end".to_owned(),
        false => closing.join("; "),
    };
    vec![
        format!("{longest}{closing}"),
        "chains join, open and close with the rates of a pair for each two free ends; longer ones move more \
         slowly; the table of kT has the pairs that would form if a tile bound one other at most"
            .to_owned(),
    ]
}

/// An area (m^2) in the unit that suits it.
fn area(area: f64) -> String {
    format!("{} mm2", plain(1e6 * area, 2))
}

/// The share of tiles that are single, in chains and in rings over time.
pub(crate) fn chart(built: &Chains) -> Chart {
    let line = |k: usize| built.course.iter().map(move |point| [point[0], point[k]]);
    Chart::new(
        "structures",
        "Single tiles, chains and rings over time",
        Dimension::new("time_s", "time").logarithmic(),
        Dimension::share("share", "fraction of all tiles"),
    )
    .with("single", Look::Line, line(2))
    .with("in chains", Look::Line, line(3))
    .with("in rings", Look::Line, line(4))
}

fn kind(count: &Count) -> &'static str {
    match count.is_ring {
        true => "ring",
        false => "chain",
    }
}

// One line a column.
#[rustfmt::skip]
fn structures(built: &Chains) -> Table {
    let listed = built.counts.iter().filter(|it| it.size > 1).cloned();
    rows(listed)
        .column("kind", "structure", "", |it: &Count| kind(it))
        .column("size", "tiles", "", |it| it.size)
        .column("mean", "number", "at the end, mean over the simulations", |it| it.number.mean).digits(3)
        .column("low", "from", "95 % over the simulations and of the attachment rate", |it| it.number.low).digits(3)
        .column("high", "to", "95 % over the simulations and of the attachment rate", |it| it.number.high).digits(3)
        .table("structures")
        .titled("Chains and rings at the end", "rings are closed, chains open")
        .in_file("structures")
}

fn course(built: &Chains) -> Table {
    rows(&built.course)
        .column("time_s", "time", "since the start", |it| it[0])
        .column("bonds", "bonds", "mean number", |it| it[1])
        .column("single", "single", "fraction of all tiles", |it| it[2])
        .column("in_chains", "in chains", "fraction of all tiles", |it| {
            it[3]
        })
        .column("in_rings", "in rings", "fraction of all tiles", |it| it[4])
        .table("structures_over_time")
        .in_data()
        .in_file("growth")
}

/// `5.2 (4.9 to 5.4)`.
fn number(mean: &Mean) -> String {
    within(mean.mean, [mean.low, mean.high], |x| plain(x, 3))
}

/// A share, of which intervals may exceed one.
fn percent(share: f64) -> String {
    share_to(share.min(1.0), 2)
}
