//! The yield of a shaken table, as a document.

use serde_json::{Value, json};

use crate::chains;
use crate::columns::{Unit, describe};
use crate::docking::unsolved;
use crate::document::{Document, Drawing, Entries, Table, entries, rows};
use crate::figures::share as percent;
use crate::files::{PAGE, REPORT};
use crate::plots::chart::{Chart, ChartPoint, Dimension, Look};
use jobs::design::Design;
use jobs::output::Command;
use jobs::yields::attachment::RateSource;
use jobs::yields::{KindRates, Request, Yield, YieldError, Yields};
use physics::dynamics::MotionSettings;
use physics::kinetics::OVERDAMPED;
use physics::kinetics::population::mixture::Mixture;
use physics::kinetics::population::{Crowd, MOST_STATES};
use physics::order::Order;
use physics::units::{duration, plain, share_with, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "yield",
    files: &[
        REPORT,
        PAGE,
        "settings.csv",
        "yield.csv",
        "course.csv",
        "rates.csv",
        "structures.csv",
        "growth.csv",
    ],
    pictures: &["course", "yield", "shaking", "structures"],
};

/// The document of a yield.
pub fn document<'a>(design: &'a Design, request: &'a Request, found: &'a Yields) -> Document<'a> {
    let told = request.method.describe();
    let interval = match request.method.source {
        RateSource::Docking => "95 %, from the attachment rate",
        RateSource::Overdamped => "difference between the two finest meshes",
    };
    let built = found.best().rows.as_ref();
    let mixture = found.mixture.as_ref();
    let schedule = mixture.map(|(tiles, mixture)| schedule(request, found, *tiles, mixture));
    let without = found.without.iter().map(|(_, why)| why.to_string());
    let means = found.outcomes.iter().filter(|it| !it.exact).map(of_means);
    let uncounted = found.outcomes.iter().filter_map(uncounted);
    let unsolved = found.outcomes.iter().filter_map(|it| {
        let told = unsolved(it.attached.unsolved, it.attached.runs)?;
        Some(format!("at kT = {} {told}", si(it.kt, "J", 3)))
    });
    Document {
        title: format!("Yield of {}", design.name),
        answer: answer(design, request, found),
        remarks: vec![format!(
            "({} covering {} of {:.2} m2, in which they meet as points would in {}; intervals: \
             {interval})",
            tiles(&found.crowd),
            share_with(request.coverage, 0),
            found.crowd.table,
            format!("{} m2", plain(found.crowd.area, 3)),
        )],
        entries: found_entries(design, request, found),
        pictures: pictures(request, found),
        notes: without
            .chain(uncounted)
            .chain(unsolved)
            .chain(means)
            .chain(schedule)
            .chain([
                format!("on: {told}; off: {}", detachment(request)),
                lifetimes(request),
            ])
            .chain(dissipation(request))
            .chain(built.map(chains::notes).unwrap_or_default())
            .chain([left_out(found, built.is_some())])
            .collect(),
        origin: format!(
            "{} magnets; {told}, detachment {}; a tile binds at most {}",
            design.interaction.model.name(),
            detachment(request),
            if built.is_some() {
                "two partners"
            } else {
                "one partner"
            },
        ),
        ..Document::default()
    }
}

/// The tiles, for people.
fn tiles(crowd: &Crowd) -> String {
    let [fixed, moving] = crowd.tiles;
    match crowd.one_kind {
        true => format!("{} equal tiles", fixed + moving),
        false => format!("{fixed} and {moving} tiles"),
    }
}

/// Which contacts are left out.
fn left_out(found: &Yields, has_rows: bool) -> String {
    let contacts = match found.crowd.one_kind {
        true if has_rows => {
            "contacts of tiles that are not neighbours in a chain are left out, and traps on rings"
        }
        true => {
            "here a tile binds one other tile at most: bonds of its other faces, which build chains and sheets of \
             tiles that do not bind with exactly two faces, are left out, so a table has more bonds"
        }
        false => {
            "here a tile binds one tile of the other kind at most: bonds and traps of tiles of the same kind, \
             and of a third tile, are left out"
        }
    };
    format!("{contacts}; `tilebind table --count N` simulates all of them")
}

/// A note if collisions dissipate energy.
fn dissipation(request: &Request) -> Option<String> {
    let motion = request.method.motion();
    let takes = motion.restitution < 1.0 || motion.friction > 0.0;
    let is_docking = request.method.source == RateSource::Docking;
    (takes && is_docking).then(|| {
        format!(
            "warning: collisions lose energy here (restitution {}, friction {}), so the table has no \
             exact temperature: tiles may freeze in traps",
            motion.restitution, motion.friction
        )
    })
}

fn answer(design: &Design, request: &Request, found: &Yields) -> String {
    let best = found.best();
    if let Some(built) = &best.rows {
        return chains::answer(&design.name, request, best, built);
    }
    let among = match (found.outcomes.len(), found.without.len()) {
        (1, _) => String::new(),
        (n, 0) => format!(", the best of {n} kT"),
        (n, _) => format!(", the best of {n} kT with a result"),
    };
    format!(
        "{}: {} of all pairs are bound after {} at kT = {}{among}",
        design.name,
        within(best.bound, best.interval),
        duration(request.time, 3),
        si(best.kt, "J", 3),
    )
}

// One line an entry.
#[rustfmt::skip]
fn found_entries(design: &Design, request: &Request, found: &Yields) -> Entries {
    let (best, effort) = (found.best(), &request.method);
    let motion = effort.motion();
    let at_best = format!("States at kT = {}", si(best.kt, "J", 3));
    let all = entries(design)
        .data("seed", request.seed)
        .fact("tiles", "", request.tiles)
        .fact("time_s", "", request.time)
        .fact("coverage", "", request.coverage)
        .fact("tile_area_m2", "", found.tile_area)
        .fact("table_area_m2", "", found.crowd.table)
        .fact("meeting_area_m2", "", found.crowd.area)
        .fact("yield", "bound", best.bound).viewed(within(best.bound, best.interval)).noted("of all pairs")
        .fact("yield_interval", "", best.interval)
        .fact("trapped", "in traps", best.trapped).share().in_view()
        .fact("best_kT_J", "kT", best.kt).noted("best of the requested values")
        .table(by_kt(request, found))
        .data("mixture", mixture(found))
        .data("rates", format!("{}; detachment {}", effort.describe(), detachment(request)))
        .data("docking", json!({
            "runs": effort.runs, "attachments": effort.attachments, "duration_s": effort.duration,
            "drag_per_s": motion.drag, "restitution": motion.restitution,
            "friction": motion.friction,
        }))
        .table(states(best).titled(at_best, "").in_view());
    match &best.rows {
        Some(built) => all.and(chains::entries(built)),
        None => all,
    }
}

/// The best schedule of kT in equal slots, without observing the tiles; no schedule yields more
/// than the upper bound, not even one that observes the tiles.
fn mixture(found: &Yields) -> Value {
    let describe = |(tiles, mixture): &(usize, Mixture)| {
        let kts = mixture.schedule.iter().map(|k| found.outcomes[*k].kt);
        json!({
            "tiles": tiles,
            "schedule_kT_J": kts.collect::<Vec<_>>(),
            "yield": mixture.value,
            "upper_bound": mixture.bound,
        })
    };
    json!(found.mixture.as_ref().map(describe))
}

/// A requested kT, and its outcome.
type AtKt<'a> = (f64, Result<&'a Yield, Option<&'a YieldError>>);

// One line per column: key, name, meaning, value.
#[rustfmt::skip]
fn by_kt(request: &Request, found: &Yields) -> Table {
    let of = |get: fn(&Yield) -> f64| move |(_, at): &AtKt| at.ok().map(get);
    let known = |get: fn(&Yield) -> Option<f64>| move |(_, at): &AtKt| at.ok().and_then(get);
    let inner = |get: fn(&Yield) -> Table| move |(_, at): &AtKt| at.ok().map(get);
    let simulated = |(_, at): &AtKt| at.ok().and_then(|it| it.simulated);
    let entry = |[mean, error]: [f64; 2]| json!({ "mean": mean, "standard_error": error });
    let describe = |[mean, error]: [f64; 2]| format!("{:.1} +- {:.1} %", 100.0 * mean, 200.0 * error);
    rows(request.kts.iter().map(|kt| (*kt, found.at(*kt))))
        .column("kT_J", "kT", "effective energy of shaking", |(kt, _)| *kt)
        .data("why_not", |(_, at)| at.err().flatten().map(ToString::to_string)).in_json()
        .column("yield", "bound", "fraction of all pairs in the bond at the end, with its interval", of(|it| it.bound))
            .viewed(|(_, at)| at.map_or("-".to_owned(), |it| within(it.bound, it.interval)))
        .data("yield_interval", |(_, at)| at.ok().map(|it| it.interval))
        .column("trapped", "in traps", "fraction of all pairs in traps at the end", of(|it| it.trapped)).share()
        .data("yield_method", |(_, at)| at.ok().map(method)).in_json()
        .data("mean_numbers_error", known(|it| it.off)).in_json()
        .data("yield_difference_equations", known(|it| it.smooth)) // from the equations for mean numbers, which hold for many tiles
        .column("yield_equilibrium", "in equilibrium", "fraction in the bond in equilibrium", known(|it| it.equilibrium)).share()
        .column("yield_simulated", "simulated", "by simulation, with two standard errors", move |row| json!(simulated(row).map(entry)))
            .viewed(move |row| simulated(row).map_or("-".to_owned(), describe)).without_csv()
        .column("mean_time_to_bond_s", "to bond", "mean time until a free tile binds", of(|it| it.mean_times[0])).viewed(mean_time(0))
        .data("mean_time_to_bond_at_least_s", known(|it| it.least_times.map(|it| it[0]))).in_json()
        .column("mean_time_out_of_bond_s", "out of bond", "mean time until a bond breaks", of(|it| it.mean_times[1])).viewed(mean_time(1))
        .data("mean_time_out_of_bond_at_least_s", known(|it| it.least_times.map(|it| it[1]))).in_json()
        .data("states", inner(states)).in_json()
        .data("attachments_elsewhere", |(_, at)| at.ok().map(|it| it.attached.elsewhere)).in_json()
        .data("attachments_unsolved", |(_, at)| at.ok().map(|it| it.attached.unsolved)).in_json()
        .data("docked_s", of(|it| it.attached.time)).in_json() // total duration of the docking runs
        .data("apart_s", of(|it| it.attached.apart)).in_json() // ... for which the tiles were apart
        .data("free_area_m2", of(|it| it.attached.area)).in_json() // area of a pair that is apart, by which rates are multiplied
        .data("over_time", inner(course)).in_json()
        .data("table", inner(crowds)).in_json()
        .data("rows", |(_, at)| at.ok().and_then(|it| it.rows.as_ref()).map(chains::of_setting)).in_json()
        .table("settings")
        .in_file("settings")
}

/// A mean time of an outcome: to the bond (0) or out of it (1).
fn mean_time(which: usize) -> impl Fn(&AtKt) -> String {
    move |(_, at)| match at.map(|it| (it.mean_times[which], it.least_times)) {
        Ok((_, Some(least))) => format!("longer than {}", duration(least[which], 2)),
        Ok((time, None)) => describe(time, Unit::Of("s"), 2),
        Err(_) => "-".to_owned(),
    }
}

#[rustfmt::skip]
fn states(outcome: &Yield) -> Table {
    let attached = |it: &KindRates| match outcome.attached.solved {
        Some(_) => "-".to_owned(),
        None => format!("{} of {}", it.attachments, outcome.attached.runs),
    };
    // Of a state to which no attachment was counted only the upper ends of rates are known.
    let limited = |it: &KindRates, rate: f64, ends: [f64; 2], text: &dyn Fn(f64) -> String| {
        match outcome.attached.counts_none(it.kind) {
            true => format!("below {}", text(ends[1])),
            false => text(rate),
        }
    };
    rows(&outcome.states)
        .column("state", "state", "kind of state", |it| it.name.clone())
        .column("attachments", "attached", "docking runs that attached to it", |it| it.attachments).viewed(|it| attached(it))
        .column("on_m2_per_s", "on", "rate of capture of a pair, times its free area", |it| it.on)
            .viewed(move |it| limited(it, it.on, it.on_interval, &|rate| format!("{rate:.1e} m²/s")))
        .data("on_interval_m2_per_s", |it| it.on_interval)
        .column("off_per_s", "off", "escape rate", |it| it.off)
            .viewed(move |it| limited(it, it.off, it.off_interval, &|rate| describe(rate, Unit::Of("/s"), 2)))
        .data("off_interval_per_s", |it| it.off_interval).in_json()
        .column("depth_kT", "depth", "energy in kT", |it| it.depth)
        .column("ln_K", "ln K", "logarithm of binding constant / concentration", |it| it.ln_k)
            .viewed(|it| format!("{:.1}", it.ln_k))
        .table("states")
        .in_file("rates")
}

/// The source of detachment rates.
fn detachment(request: &Request) -> &'static str {
    match request.method.source {
        RateSource::Docking => "by detailed balance, as if the table had a temperature",
        RateSource::Overdamped => "from the mesh, including direct transitions between states",
    }
}

/// The drag that lifetimes refer to.
fn lifetimes(request: &Request) -> String {
    let drag = request.method.motion().drag;
    match request.method.source {
        RateSource::Docking => format!(
            "lifetimes depend on the drag: these are for {drag} /s, with inertia. `tilebind \
             rates` assumes overdamped motion of one tile beside a fixed one, by default at \
             {OVERDAMPED} /s, and gives longer lifetimes; --rates overdamped --drag {OVERDAMPED} solves \
             the same for two tiles that move"
        ),
        RateSource::Overdamped => format!(
            "lifetimes depend on the drag: these are for {drag} /s, overdamped, with both \
             tiles moving; `tilebind rates --drag {drag}` has one of them at rest, and they last at least \
             twice as long. Without --rates overdamped, docking runs have inertia and a \
             drag of {} /s, and lifetimes are shorter",
            MotionSettings::default().drag
        ),
    }
}

/// The method for shares over time.
fn method(outcome: &Yield) -> &'static str {
    match outcome.exact {
        true => "forward equation of all numbers of pairs",
        false => "mean numbers",
    }
}

// One line a column.
#[rustfmt::skip]
fn course(outcome: &Yield) -> Table {
    rows(&outcome.course)
        .column("time_s", "time", "since the start", |it| it[0])
        .column("bound", "bound", "fraction of all pairs in the bond", |it| it[1])
        .column("trapped", "in traps", "fraction of all pairs in traps", |it| it[2])
        .table("over_time")
        .in_file("course")
}

// One line a column.
#[rustfmt::skip]
fn crowds(outcome: &Yield) -> Table {
    rows(&outcome.table)
        .column("tiles", "tiles", "on the table", |it| it.0)
        .column("coverage", "covered", "fraction of the table", |it| it.1)
        .column("yield", "bound", "fraction of all pairs in the bond", |it| it.2)
        .data("exact", |it| it.3).in_json()
        .table("table")
        .in_file("yield")
}

fn pictures<'a>(request: &Request, found: &Yields) -> Vec<Drawing<'a>> {
    let best = found.best();
    let chart =
        |name, title: &str, x, y: &str| Chart::new(name, title, x, Dimension::share("share", y));
    let time = Dimension::new("time_s", "time").logarithmic();
    let line = |k: usize| best.course.iter().map(move |point| [point[0], point[k]]);
    let course = chart(
        "course",
        "Bound and trapped over time",
        time,
        "fraction of all pairs",
    )
    .with("in the bond", Look::Line, line(1))
    .with("in traps", Look::Line, line(2));
    let mut tiles: Vec<f64> = best.table.iter().map(|row| row.0 as f64).collect();
    tiles.dedup();
    let mut coverages: Vec<f64> = best.table.iter().map(|row| row.1).collect();
    coverages.order_by(f64::total_cmp);
    coverages.dedup();
    let tiles = Dimension::new(
        "tiles",
        format!("tiles (after {})", duration(request.time, 3)),
    )
    .logarithmic()
    .marked(tiles);
    let title = "Bound over number of tiles and coverage";
    let mut crowds = chart("yield", title, tiles, "fraction of all pairs in the bond");
    for coverage in coverages {
        let rows = best.table.iter().filter(|row| row.1 == coverage);
        let name = format!("{} % covered", (1e3 * coverage).round() / 10.0);
        crowds = crowds.with(name, Look::Line, rows.map(|row| [row.0 as f64, row.2]));
    }
    let mut all = vec![course, crowds];
    all.extend(best.rows.as_ref().map(chains::chart));
    if found.outcomes.len() > 1 {
        let mut by_kt: Vec<&Yield> = found.outcomes.iter().collect();
        by_kt.order_by(|a, b| a.kt.total_cmp(&b.kt));
        let kt = Dimension::new("kT_J", "kT").marked(by_kt.iter().map(|it| it.kt));
        let bound = by_kt.iter().map(|it| ChartPoint {
            x: it.kt,
            y: it.bound,
            ends: it
                .interval
                .iter()
                .all(|end| end.is_finite())
                .then_some(it.interval),
        });
        let points = |of: fn(&Yield) -> f64| by_kt.iter().map(move |it| [it.kt, of(it)]);
        let equilibrium = points(|it| it.equilibrium.unwrap_or(f64::NAN));
        all.push(
            chart("shaking", "Bound over kT", kt, "fraction of all pairs")
                .with("in the bond", Look::Line, bound)
                .with("in traps", Look::Line, points(|it| it.trapped))
                .with("in the bond in equilibrium", Look::Dashed, equilibrium),
        );
    }
    all.into_iter().map(Into::into).collect()
}

/// The note on a bond to which no attachment was counted.
fn uncounted(outcome: &Yield) -> Option<String> {
    outcome.least_times?;
    Some(format!(
        "at kT = {} none of {} docking runs attached to the bond: its rates are upper limits and its \
         times lower ones (95 %); more or longer runs (--attachments 20, --runs, --duration) can count some",
        si(outcome.kt, "J", 3),
        outcome.attached.runs
    ))
}

/// The note on a share from mean numbers.
fn of_means(outcome: &Yield) -> String {
    let kinds = outcome.states.len();
    let off = match outcome.off {
        Some(off) => format!(
            "it differs by at most {} from the simulation; the interval includes this",
            percent(off)
        ),
        None => "without --simulations the error is unknown".to_owned(),
    };
    format!(
        "at kT = {} mean numbers replace the exact distribution for {kinds} kinds of state, which \
         has more than {MOST_STATES} states: {off}",
        si(outcome.kt, "J", 3)
    )
}

/// The schedule in words: `30 min at 2 mJ, then 30 min at 1 mJ`.
fn schedule(request: &Request, found: &Yields, tiles: usize, mixture: &Mixture) -> String {
    let kts = mixture.schedule.chunk_by(|a, b| a == b);
    let phases = kts.map(|part| {
        let time = request.time * part.len() as f64 / mixture.schedule.len() as f64;
        let kt = found.outcomes[part[0]].kt;
        format!("{} at {}", duration(time, 2), si(kt, "J", 2))
    });
    format!(
        "{tiles} tiles, kT in steps: {} ({}); no schedule yields more than {}",
        percent(mixture.value),
        phases.collect::<Vec<_>>().join(", then "),
        percent(mixture.bound),
    )
}

/// `42 % (38-45)`.
fn within(share: f64, interval: [f64; 2]) -> String {
    let [low, high] = interval.map(|end| percent(end).replace(" %", ""));
    format!("{} ({low}-{high})", percent(share))
}
