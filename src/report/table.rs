//! Simulations of many tiles on a table, as documents.

use serde_json::{Value, json};

use crate::assembly::grown_with_errors;
use crate::chains;
use crate::document::{Document, Drawing, Entries, PagePart, Table, rows};
use crate::figures::within;
use crate::gsd::{self, Particle};
use crate::page::Crowd;
use crate::plots::chart::{Chart, ChartPoint, Dimension, Look};
use crate::plots::crowd::{ends, film};
use jobs::assembly::kinetic::Growth;
use jobs::output::Files;
use jobs::request::Shard;
use jobs::table::{
    About, EndOfTable, Lifetime, MeanInterval, Moment, PART, Prediction, Request, Statistics,
    TableResult,
};
use jobs::yields::{self, Chains, KindRates, YieldError, Yields};
use physics::table::TableSettings;
use physics::table::contacts::Tie;
use physics::table::run::{ACCOUNTED, Run};
use physics::table::{Mover, Sample};
use physics::units::{counted, duration, plain, share_to, si};

/// The document of a table.
pub fn document<'a>(
    about: &About,
    found: &'a TableResult,
    request: &Request,
    beside: Option<&Beside>,
) -> Document<'a> {
    let statistics = &found.statistics;
    let seed = request.seed;
    let tiles = found.ensemble.kinds().len();
    Document {
        title: format!("{tiles} tiles of {} on the table", about.name),
        answer: format!(
            "{}: {tiles} tiles have {} bonds and {} traps after {} ({}; {}, seed {seed})",
            about.name,
            describe(&statistics.bonds),
            describe(&statistics.traps),
            duration(found.ensemble.settings.duration, 3),
            verdict(statistics),
            counted(found.runs.len(), "run"),
        ),
        remarks: vec![meaning(about, found)],
        entries: entries(about, found, seed).and(compared(beside)),
        part: Some(PagePart::Crowd(Crowd::new(found))),
        pictures: pictures(found),
        beside: files(found, request),
        notes: notes(found, request)
            .into_iter()
            .chain(beside.map(|beside| against(about, found, beside)))
            .collect(),
        origin: format!("seed {seed}, {} magnets", about.model.name()),
        ..Document::default()
    }
}

/// The recording of the first run, and the file of a part.
fn files(found: &TableResult, request: &Request) -> Files {
    let mut files = Files::from([("trajectory.gsd".to_owned(), trajectory(found))]);
    if request.keeps_frames()
        && let Ok(Some(film)) = film(found)
    {
        files.insert("trajectory.png".to_owned(), film);
    }
    if request.shard.is_some() {
        files.insert(PART.to_owned(), found.ensemble.part(&found.runs));
    }
    files
}

/// The verdict for people.
fn verdict(statistics: &Statistics) -> &'static str {
    match statistics.is_undecided() {
        true => "possibly thermal",
        false => statistics.verdict.name(),
    }
}

fn describe(interval: &MeanInterval) -> String {
    match (interval.low, interval.high) {
        (Some(low), Some(high)) => within(interval.mean, [low, high], |x| plain(x, 3)),
        _ => plain(interval.mean, 3),
    }
}

fn meaning(about: &About, found: &TableResult) -> String {
    let kt = found.statistics.kinetic_kt;
    let has = kt.map(|share| {
        format!(
            "mean kinetic energy {} kT per degree of freedom, in equilibrium 0.5 kT",
            plain(share, 3)
        )
    });
    match (found.statistics.verdict, has) {
        (EndOfTable::Thermal, Some(has)) if found.statistics.is_undecided() => format!(
            "(possibly thermal: {has}, with a statistical error of {}; simulate for longer to decide)",
            share_to(found.statistics.kinetic_error, 2)
        ),
        (EndOfTable::Thermal, Some(has)) => format!("(thermal: {has})"),
        (EndOfTable::Frozen, Some(has)) => format!(
            "(frozen: {has}; contact dissipates more than shaking supplies, so the table has no temperature \
             and the results of {} do not apply)",
            match about.pattern {
                Some(_) => "`assemble`",
                None => "`bond`, `rates` and `yield`",
            }
        ),
        (EndOfTable::Driven, Some(has)) => format!("(driven: {has})"),
        (EndOfTable::Frozen, None) => "(frozen: nothing drives the tiles)".to_owned(),
        (_, None) => format!(
            "({} the tiles; kT does not apply)",
            drivers(&found.ensemble.settings)
        ),
    }
}

/// What drives the tiles, with its verb.
fn drivers(settings: &TableSettings) -> String {
    let fans = match settings.fans.len() {
        0 => None,
        1 => Some("the fan"),
        _ => Some("the fans"),
    };
    let all = [
        settings.orbital.map(|_| "the orbit"),
        settings.linear.map(|_| "the linear motion"),
        fans,
    ];
    let all: Vec<&str> = all.into_iter().flatten().collect();
    let verb = match &all[..] {
        [one] if !one.ends_with('s') => "drives",
        _ => "drive",
    };
    format!("{} {verb}", all.join(" and "))
}

/// The prediction of another command.
type Beside = Result<Prediction, YieldError>;

fn compared(beside: Option<&Beside>) -> Entries {
    match beside {
        Some(Ok(Prediction::Yield(question, yields))) => of_yield(question, yields),
        Some(Ok(Prediction::Growth(growth))) => of_growth(growth),
        _ => Entries::default(),
    }
}

/// Growth from a seed as rgrow and xgrow simulate it.
fn of_growth(growth: &Growth) -> Entries {
    Entries::default().group(
        "assemble",
        Entries::default()
            .data("runs", growth.runs)
            .data("right", growth.right)
            .data("wrong", growth.wrong)
            .and(grown_with_errors(growth)),
    )
}

/// The prediction for the same number of pairs by detailed balance, with one partner per tile.
fn of_yield(question: &yields::Request, yields: &Yields) -> Entries {
    let best = yields.best();
    let (bond, traps) = (
        best.states.first(),
        best.states.get(1..).unwrap_or_default(),
    );
    let ln_k = bond.map(|bond| bond.ln_k);
    Entries::default().group(
        "yield",
        Entries::default()
            .fact("pairs", "", question.tiles / 2)
            .fact("ln_K", "ln K", ln_k)
            .digits(3)
            .noted("of the bond, as `tilebind bond` computes it")
            .fact("bound", "bound (yield)", best.bound)
            .share()
            .noted(in_pairs(question, best.interval))
            .fact("bound_interval", "", best.interval)
            .fact("equilibrium", "in equilibrium", best.equilibrium)
            .share()
            .fact("trapped", "", best.trapped)
            .fact(
                "bond_lifetime_s",
                "bond lifetime (yield)",
                bond.filter(|bond| bond.off > 0.0)
                    .map(|bond| 1.0 / bond.off),
            )
            .noted("by detailed balance")
            .fact(
                "trap_lifetime_s",
                "trap lifetime (yield)",
                mean_lifetime(traps),
            )
            .noted("by detailed balance; the mean of all attachments")
            .data("rows", best.rows.as_ref().map(chains::of_setting)),
    )
}

/// How long (s) attachments to traps last on average; `None` if there was none.
fn mean_lifetime(traps: &[KindRates]) -> Option<f64> {
    let attachments: usize = traps.iter().map(|trap| trap.attachments).sum();
    let time: f64 = traps
        .iter()
        .map(|trap| trap.attachments as f64 / trap.off)
        .sum();
    (attachments > 0).then(|| time / attachments as f64)
}

fn in_pairs(question: &yields::Request, [low, high]: [f64; 2]) -> String {
    format!(
        "of {} pairs; between {} and {}",
        question.tiles / 2,
        share_to(low, 2),
        share_to(high, 2)
    )
}

/// One sentence that compares a prediction with the share of the target, or says why there is none.
fn against(about: &About, found: &TableResult, beside: &Beside) -> String {
    match beside {
        Ok(Prediction::Yield(question, yields)) => against_yield(found, question, yields),
        Ok(Prediction::Growth(growth)) => format!(
            "`tilebind assemble` predicts that {} of {} growths end with every tile in its place; it grows one \
             cluster from a seed among tiles whose supply does not change, as rgrow and xgrow do, while on \
             this table all clusters share the tiles and the most complete one has {}",
            growth.right,
            growth.runs,
            reached(about, found)
        ),
        Err(why) => format!("there is no result of `tilebind yield` to compare with: {why}"),
    }
}

fn against_yield(found: &TableResult, question: &yields::Request, yields: &Yields) -> String {
    let best = yields.best();
    if let Some(built) = &best.rows {
        return against_rows(found, built);
    }
    let here = &found.target.share;
    let there = best.trapped * (question.tiles / 2) as f64;
    let traps = &found.statistics.traps;
    let trapped = match agree(traps, [there; 2]) {
        Some(false) => format!(
            "; of traps it predicts {}, and here are {}: `yield` has no contacts of {}",
            plain(there, 2),
            describe(traps),
            match yields.crowd.one_kind {
                true => "three tiles",
                false => "equal tiles or of three",
            }
        ),
        _ => String::new(),
    };
    let bonds = describe_agreement(agree(here, best.interval));
    format!(
        "`tilebind yield` predicts that {} are bound ({}), and here are {}{bonds}{trapped}",
        share_to(best.bound, 2),
        in_pairs(question, best.interval),
        match (here.low, here.high) {
            (Some(low), Some(high)) => within(here.mean, [low, high], |x| share_to(x, 2)),
            _ => share_to(here.mean, 2),
        }
    )
}

/// The bonds of chains and rings beside those on the table.
fn against_rows(found: &TableResult, built: &Chains) -> String {
    let (here, there) = (&found.statistics.bonds, &built.bonds);
    format!(
        "`tilebind yield` predicts {} bonds ({} to {}) in chains and rings, and here are {}{}",
        plain(there.mean, 3),
        plain(there.low, 3),
        plain(there.high, 3),
        describe(here),
        describe_agreement(agree(here, [there.low, there.high]))
    )
}

/// Whether the intervals of a simulated number and of a prediction have common values; `None` for a
/// single run.
fn agree(here: &MeanInterval, there: [f64; 2]) -> Option<bool> {
    Some(here.high? >= there[0] && here.low? <= there[1])
}

fn describe_agreement(agree: Option<bool>) -> &'static str {
    match agree {
        Some(true) => "; their intervals overlap",
        Some(false) => "; the two results differ by more than both intervals",
        None => "; one run has no interval to compare",
    }
}

fn notes(found: &TableResult, request: &Request) -> Vec<String> {
    let statistics = &found.statistics;
    let mut notes = vec![format!(
        "energy balance: {} of the largest term is missing; steps of {} or shorter",
        share_to(statistics.energy_error, 2),
        si(statistics.step, "s", 3)
    )];
    if let Some(Shard { number, of }) = request.shard {
        notes.push(format!(
            "part {number} of {of} of {} runs: to join all parts, run the same command with --merge and their folders \
             in place of --shard",
            request.runs
        ));
    }
    if statistics.halved > 0 {
        notes.push(format!(
            "{} of {} runs were repeated with shorter steps, because more than {} of the energy was missing or a \
             tile moved too far in one step",
            statistics.halved,
            found.runs.len(),
            share_to(ACCOUNTED, 2)
        ));
    }
    if statistics.energy_error > ACCOUNTED {
        notes.push(format!(
            "warning: {} of the energy is missing, more than {}: do not trust these results; choose a \
             shorter --step",
            share_to(statistics.energy_error, 2),
            share_to(ACCOUNTED, 2)
        ));
    }
    notes
}

// One line an entry.
#[rustfmt::skip]
fn entries(about: &About, found: &TableResult, seed: u64) -> Entries {
    let statistics = &found.statistics;
    let checksum = match &about.designs[..] {
        [(_, sha256)] => Some(sha256),
        _ => None,
    };
    let identity = json!({"name": about.name, "sha256": checksum});
    let designs = about.designs.iter().map(|(name, sha256)| json!({"name": name, "sha256": sha256}));
    let entries = Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("design", identity)
        .data("designs", designs.collect::<Value>())
        .data("model", about.model.name())
        .data("seed", seed)
        .data("settings", settings(&found.ensemble.settings))
        .fact("tiles", "tiles", found.ensemble.kinds().len())
        .fact("runs", "runs", found.runs.len())
        .fact("time_s", "time", found.ensemble.settings.duration)
        .fact("step_s", "step", statistics.step)
        .data("bonds", statistics.bonds)
        .data("traps", statistics.traps)
        .fact("", "bonds", describe(&statistics.bonds)).in_view().noted("at the end, mean over the runs with its 95 % interval")
        .data("contacts", statistics.contacts)
        .data("trapped_tiles", statistics.trapped)
        .fact("", "traps", describe(&statistics.traps)).in_view().noted("other stable contacts at the end")
        .fact("", "contacts", describe(&statistics.contacts)).in_view().noted("stable contacts that follow from bonds to a common neighbour, or have less than 0.5 % of a bond's energy")
        .data("target", json!({"share": found.target.share, "defects": found.target.defects, "outside": found.target.outside}))
        .fact("", "target", reached(about, found)).in_view().noted(aim(about, found))
        .data("clusters", &statistics.clusters)
        .fact("kinetic_kT", "kinetic energy", statistics.kinetic_kt).digits(3).noted("per degree of freedom, over kT; 0.5 in equilibrium")
        .data("kinetic_error", statistics.kinetic_error)
        .data("verdict", statistics.verdict.name())
        .fact("", "verdict", verdict(statistics)).in_view()
        .fact("energy_error", "energy error", statistics.energy_error).noted("missing energy, over the largest term of the balance")
        .data("lifetimes", json!({"bonds": statistics.lifetimes[0], "traps": statistics.lifetimes[1]}))
        .fact("", "bond lifetime", lasting(&statistics.lifetimes[0], found)).in_view().noted(lasting_is(found))
        .fact("", "trap lifetime", lasting(&statistics.lifetimes[1], found)).in_view().noted(lasting_is(found))
        .data("cut_off", cut_off(found))
        .fact("wall_s", "", found.wall_s)
        .data("threads", found.threads)
        .table(structures(found))
        .table(sizes(found))
        .table(course(found))
        .table(energy(found))
        .table(bonds(found))
        .table(clusters(found));
    match found.ensemble.frames {
        true => entries.table(places(found)),
        false => entries,
    }
}

/// What lifetimes are, for people.
fn lasting_is(found: &TableResult) -> String {
    format!(
        "total time held / number that ended, with its 95 % interval; contacts are recorded every {}, \
         so shorter ones are missed",
        duration(found.ensemble.settings.sampling, 2)
    )
}

/// A lifetime for people; one that a run is too short to see is an extrapolation.
fn lasting(lifetime: &Lifetime, found: &TableResult) -> String {
    let Lifetime { begun, ended, .. } = *lifetime;
    let [low, high] = lifetime.interval.map(|end| match end {
        Some(end) => duration(end, 2),
        None => "any time".to_owned(),
    });
    let watched = found.ensemble.settings.duration;
    match lifetime.mean {
        Some(mean) if mean > watched => format!(
            "longer than the {} of a run ({low} to {high}; {ended} of {begun} ended)",
            duration(watched, 2)
        ),
        Some(mean) => format!(
            "{} ({low} to {high}; {ended} of {begun} ended)",
            duration(mean, 2)
        ),
        None if begun == 0 => "none was seen".to_owned(),
        None => format!("{low} or longer (none of {begun} ended)"),
    }
}

/// The share of the target, for people.
fn reached(about: &About, found: &TableResult) -> String {
    let percent = |x: f64| plain(100.0 * x.clamp(0.0, 1.0), 3);
    let MeanInterval {
        mean,
        sd,
        low,
        high,
    } = found.target.share;
    let within = low
        .zip(high)
        .map(|(low, high)| format!(" ({} to {})", percent(low), percent(high)));
    let spread = sd.map(|sd| {
        let runs = found.runs.len();
        format!("; {} % standard deviation over {runs} runs", percent(sd))
    });
    let wrong = found
        .target
        .defects
        .as_ref()
        .map(|it| format!(", {} defects", describe(it)));
    let what = match (&found.target.possible, &about.pattern) {
        (Some(possible), _) => format!(" of {possible} tiles"),
        (None, Some(_)) => " of the pattern".to_owned(),
        (None, None) => " of the pairs".to_owned(),
    };
    let outside = found.target.outside.as_ref();
    let outside = outside.map(|it| format!(", {} tiles outside", describe(it)));
    format!(
        "{} %{}{what}{}{}{}",
        percent(mean),
        within.unwrap_or_default(),
        wrong.unwrap_or_default(),
        outside.unwrap_or_default(),
        spread.unwrap_or_default()
    )
}

fn aim(about: &About, found: &TableResult) -> &'static str {
    match about.pattern {
        _ if found.target.possible.is_some() => {
            "tiles in structures that are the target, of the largest number that could be"
        }
        Some(_) => {
            "tiles of the most complete cluster in their places, of all places; defects: its other tiles"
        }
        None => "bound as intended at the end, each tile with one partner, of all possible pairs",
    }
}

/// The time between kicks is null without them.
fn settings(settings: &TableSettings) -> Value {
    let mut all = json!(settings);
    if settings.shaking.is_none() {
        all["correlation_s"] = Value::Null;
    }
    all
}

fn cut_off(found: &TableResult) -> Value {
    let couples = found.crowd.couples().iter().map(|couple| {
        let cutoff = &couple.cutoff;
        json!({"from_m": cutoff.from, "to_m": cutoff.to, "left_out_J": cutoff.left_out})
    });
    couples.collect()
}

/// Rings, chains and sheets.
fn structures(found: &TableResult) -> Table {
    let structures = &found.statistics.structures;
    rows(structures.clone())
        .column("kind", "structure", "", |it| it.shape.name())
        .column("size", "tiles", "", |it| it.size)
        .column("mean", "number", "per run at the end, mean", |it| {
            it.count.mean
        })
        .digits(3)
        .column("low", "from", "95 % interval", |it| it.count.low)
        .digits(3)
        .column("high", "to", "95 % interval", |it| it.count.high)
        .digits(3)
        .column("closed", "bonds closed", "of all its tiles could have", |it| {
            it.closed
        })
        .share()
        .column("holes", "holes", "in each, mean", |it| it.holes)
        .digits(3)
        .table("structures")
        .titled(
            "Structures at the end",
            "tiles joined by bonds: rings are closed, chains open; a target is listed again under its \
             own kind",
        )
}

fn sizes(found: &TableResult) -> Table {
    rows(found.statistics.clusters.clone())
        .column("size", "tiles", "in a cluster", |it| it.0)
        .column("count", "clusters", "per run at the end, mean", |it| it.1)
        .table("sizes")
        .titled(
            "Clusters at the end",
            "connected tiles; single tiles count as clusters",
        )
        .in_view()
}

// One line a column.
#[rustfmt::skip]
fn course(found: &TableResult) -> Table {
    let ends = |of: fn(&Moment) -> MeanInterval| move |it: &Moment| { let at = of(it); at.low.zip(at.high).map(|(low, high)| [low.max(0.0), high]) };
    rows(found.statistics.moments.clone())
        .data("time_s", |it| it.time) // since the start
        .data("bonds", |it| it.bonds.mean) // mean over the runs
        .data("bonds_interval", ends(|it| it.bonds)) // 95 %
        .data("traps", |it| it.traps.mean) // mean over the runs
        .data("traps_interval", ends(|it| it.traps)) // 95 %
        .data("in_target", |it| it.in_target.mean) // tiles in structures that are the target, mean over the runs
        .data("in_target_interval", ends(|it| it.in_target)) // 95 %
        .data("largest", |it| it.largest.mean) // tiles of the largest cluster, mean over the runs
        .data("largest_interval", ends(|it| it.largest)) // 95 %
        .table("over_time")
        .in_file("course")
}

fn samples(found: &TableResult) -> impl Iterator<Item = (&Run, &Sample)> {
    let runs = found.runs.iter();
    runs.flat_map(|run| run.samples.iter().map(move |sample| (run, sample)))
}

// One line a column.
#[rustfmt::skip]
fn energy(found: &TableResult) -> Table {
    rows(samples(found))
        .data("run", |(run, _)| run.index)
        .data("time_s", |(_, at)| at.time)
        .data("kinetic_J", |(_, at)| at.kinetic)
        .data("potential_J", |(_, at)| at.potential) // of magnets, and of steady fans
        .data("work_J", |(_, at)| at.account.work)
        .data("contact_loss_J", |(_, at)| at.account.contact_loss)
        .data("drag_loss_J", |(_, at)| at.account.drag_loss)
        .data("table_loss_J", |(_, at)| at.account.table_loss) // lost to friction on the table
        .table("energy")
        .in_csv("energy")
}

// One line a column.
#[rustfmt::skip]
fn bonds(found: &TableResult) -> Table {
    let (kinds, of_tiles) = (&found.crowd.kinds, found.ensemble.kinds());
    let kind = |tile: usize| kinds[of_tiles[tile]].name.clone();
    let lives = found.runs.iter().flat_map(|run| run.lives.iter().map(move |life| (run, life)));
    rows(lives)
        .data("run", |(run, _)| run.index)
        .data("first", |(_, life)| life.tiles[0]) // a tile
        .data("second", |(_, life)| life.tiles[1]) // the tile in contact with it
        .data("first_kind", |(_, life)| kind(life.tiles[0]))
        .data("second_kind", |(_, life)| kind(life.tiles[1]))
        .data("tie", |(_, life)| life.tie.name()) // bond, trap or contact
        .data("from_s", |(_, life)| life.from)
        .data("to_s", |(_, life)| life.to) // empty if it lasts to the end
        .table("held")
        .in_csv("bonds")
}

fn clusters(found: &TableResult) -> Table {
    let counted = samples(found).flat_map(|(run, at)| {
        let sizes = at.clusters.chunk_by(|a, b| a == b);
        sizes.map(move |equal| (run.index, at.time, equal[0], equal.len()))
    });
    rows(counted)
        .data("run", |it| it.0)
        .data("time_s", |it| it.1)
        .data("size", |it| it.2) // tiles in a cluster
        .data("count", |it| it.3) // clusters of this size
        .table("cluster_sizes")
        .in_csv("clusters")
}

/// `trajectory.csv`.
fn places(found: &TableResult) -> Table {
    let kinds = &found.crowd.kinds;
    let tiles = samples(found).flat_map(|(run, at)| {
        let movers = at.movers.iter().flatten().enumerate();
        movers.map(move |(tile, mover)| (run.index, at.time, tile, *mover))
    });
    let pose = |mover: &Mover| mover.motion(&found.crowd).configuration;
    let at = |axis: usize| move |it: &(usize, f64, usize, Mover)| pose(&it.3).to_array()[axis];
    let velocity = |axis: usize| {
        move |it: &(usize, f64, usize, Mover)| it.3.reference_velocity(&found.crowd)[axis]
    };
    rows(tiles)
        .data("run", |it| it.0)
        .data("time_s", |it| it.1)
        .data("tile", |it| it.2)
        .data("kind", |it| kinds[it.3.kind].name.clone())
        .data("x", at(0)) // of the reference point
        .data("y", at(1)) // of the reference point
        .data("theta", at(2))
        .data("vx", velocity(0)) // of the reference point
        .data("vy", velocity(1)) // of the reference point
        .data("omega", velocity(2))
        .table("trajectory")
        .in_csv("trajectory")
}

/// The first run, one frame per sample.
fn trajectory(found: &TableResult) -> Vec<u8> {
    let crowd = &found.crowd;
    let particle = |mover: &Mover| {
        let body = &crowd.kinds[mover.kind].body;
        Particle {
            place: [mover.place.x, mover.place.y],
            theta: mover.place.z,
            velocity: mover.velocity.into(),
            kind: mover.kind,
            mass: body.mass,
            inertia: body.inertia,
        }
    };
    let samples = found.runs.iter().take(1).flat_map(|run| &run.samples);
    let frames: Vec<Vec<Particle>> = samples
        .filter_map(|sample| sample.movers.as_ref())
        .map(|movers| movers.iter().map(particle).collect())
        .collect();
    let kinds: Vec<(String, gsd::Polygon)> = crowd
        .kinds
        .iter()
        .map(|kind| {
            let corners = kind.tile.outline.vertices().iter();
            let corners = corners.map(|it| it - kind.body.centre);
            (kind.name.clone(), corners.map(|it| [it.x, it.y]).collect())
        })
        .collect();
    gsd::file(
        &kinds,
        crowd.rim.half_size().map(|half| 2.0 * half),
        &frames,
    )
}

fn pictures(found: &TableResult) -> Vec<Drawing<'_>> {
    let moments = &found.statistics.moments;
    let chart = |name, title: &str, y: Dimension| {
        Chart::new(name, title, Dimension::new("time_s", "time"), y)
    };
    let line = |of: fn(&Moment) -> MeanInterval| {
        moments.iter().map(move |it| {
            let at = of(it);
            ChartPoint {
                x: it.time,
                y: at.mean,
                ends: at.low.zip(at.high).map(|(low, high)| [low.max(0.0), high]),
            }
        })
    };
    let held = chart(
        "held",
        "Bonds and traps over time",
        Dimension::new("pairs", "pairs of tiles"),
    )
    .with("bonds", Look::Line, line(|it| it.bonds))
    .with("traps", Look::Line, line(|it| it.traps));
    let largest = chart(
        "largest",
        "The largest cluster over time",
        Dimension::new("tiles", "tiles"),
    )
    .with("largest cluster", Look::Line, line(|it| it.largest));
    let largest = match found.crowd.goal {
        Some(_) => largest.with("in the target", Look::Line, line(|it| it.in_target)),
        None => largest,
    };
    let mean = |of: fn(&Sample) -> f64| -> Vec<[f64; 2]> {
        let runs = found.runs.len() as f64;
        (0..moments.len())
            .map(|k| {
                let sum: f64 = found.runs.iter().map(|run| of(&run.samples[k])).sum();
                [moments[k].time, sum / runs]
            })
            .collect()
    };
    let energy = chart(
        "energy",
        "Energy over time, mean over the runs",
        Dimension::new("energy_J", "energy"),
    )
    .with("kinetic", Look::Line, mean(|it| it.kinetic))
    .with("magnetic", Look::Line, mean(|it| it.potential))
    .with("work by drives", Look::Line, mean(|it| it.account.work))
    .with(
        "lost in contact",
        Look::Line,
        mean(|it| it.account.contact_loss),
    )
    .with("lost to drag", Look::Line, mean(|it| it.account.drag_loss));
    let energy = match found.ensemble.settings.table_friction > 0.0 {
        true => energy.with(
            "lost to friction on the table",
            Look::Line,
            mean(|it| it.account.table_loss),
        ),
        false => energy,
    };
    let charts = [held, largest, energy].into_iter().map(Into::into);
    charts.chain(ends(found)).collect()
}

/// The number of bonds or traps of a run at its end.
pub fn at_end(run: &Run, tie: Tie) -> usize {
    run.samples.last().map_or(0, |last| last.count(tie))
}
