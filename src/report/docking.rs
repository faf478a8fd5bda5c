//! Docking experiments as documents: how tiles launched towards each other end.

use serde_json::{Value, json};

use crate::document::{Document, Drawing, Entries, PagePart, Table, entries, rows};
use crate::files::{PAGE, REPORT};
use crate::page::{Landscape, Played};
use crate::plots::{Figure, PictureError, Scene, Sheet, dock, paths};
use jobs::design::Design;
use jobs::docking::Paths;
use jobs::output::Command;
use physics::configuration::Configuration;
use physics::dynamics::Snapshot;
use physics::dynamics::docking::{Docking, DockingMap, DockingRun, End, MatchRule, OnRate};
use physics::landscape::{Catalogue, State, StateKind};
use physics::order::Order;
use physics::problem::Problem;
use physics::units::{plain, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "dock",
    files: &[REPORT, PAGE, "runs.csv", "map.csv", "trajectory.csv"],
    pictures: &["chances", "trajectories", "bound"],
};

/// Cells of the map of chances along the orientation and the speed.
pub const CELLS: [usize; 2] = [12, 13];
/// Number of traps shown to people.
const LISTED: usize = 12;

/// The document of an experiment; if paths are given, with pictures and animations.
pub fn document<'a>(
    (design, problem): (&'a Design, &'a Problem),
    docking: &'a Docking,
    paths: Option<&'a Paths>,
) -> Document<'a> {
    let bound = docking.runs.iter().filter(|run| run.is_bound()).count();
    Document {
        title: format!("{}: docking", design.name),
        answer: format!(
            "{}: {bound} of {} trajectories of {} each end in the bond (seed {})",
            design.name,
            docking.runs.len(),
            si(docking.settings.duration, "s", 2),
            docking.settings.seed
        ),
        entries: found(design, problem, docking, paths),
        part: paths.map(|paths| scene(design, problem, docking, paths)),
        pictures: paths.map_or_else(Vec::new, |paths| pictures(design, docking, paths)),
        notes: notes(docking),
        origin: format!(
            "seed {}, {} magnets",
            docking.settings.seed,
            design.interaction.model.name()
        ),
        ..Document::default()
    }
}

// One line an entry.
#[rustfmt::skip]
fn found(design: &Design, problem: &Problem, docking: &Docking, paths: Option<&Paths>) -> Entries {
    let map = DockingMap::new(docking, CELLS);
    let all = entries(design)
        .data("seed", docking.settings.seed)
        .data("settings", settings(docking))
        .fact("bound", "bond", docking.bound).noted("of all runs end in it")
        .fact("misbound", "traps", docking.trapped).noted("caught without a match")
        .fact("free", "free", docking.free).noted("neither")
        .data("unsolved", docking.unsolved)
        .table(ends(docking))
        .table(traps(problem, docking))
        .data("time_to_bind_s", times(docking))
        .data("on_rate", rate("attachments", &OnRate::new(docking)))
        .fact("", "on-rate", describe_rate(&OnRate::new(docking))).in_view()
        .data("timing", timing(docking))
        .table(runs(docking))
        .table(chances(&map));
    match paths.and_then(|paths| paths.played.first()) {
        Some((_, snapshots)) => all.table(trajectory(snapshots)),
        None => all,
    }
}

fn settings(docking: &Docking) -> Value {
    let settings = &docking.settings;
    json!({
        "runs": settings.runs, "duration_s": settings.duration,
        "match_threshold_m": docking.threshold,
        "starts": settings.starts, "motion": settings.motion,
    })
}

/// A rate, with the number of counted events under their name.
pub(crate) fn rate(events: &str, rate: &OnRate) -> Value {
    json!({
        events: rate.attachments, "time_s": rate.time, "rate_per_s": rate.rate,
        "interval_per_s": rate.interval, "statistic": rate.statistic,
        "critical": OnRate::CRITICAL, "exponential": rate.is_exponential(),
    })
}

/// Smallest, median and largest time to bind (s).
fn times(docking: &Docking) -> Option<[f64; 3]> {
    let since = |run: &DockingRun| match run.end {
        End::Bound { since } => Some(since),
        _ => None,
    };
    let mut times: Vec<f64> = docking.runs.iter().filter_map(since).collect();
    times.order_by(f64::total_cmp);
    Some([*times.first()?, times[times.len() / 2], *times.last()?])
}

fn timing(docking: &Docking) -> Value {
    let contact: usize = docking.runs.iter().map(|run| run.contact_steps).sum();
    let free: usize = docking.runs.iter().map(|run| run.free_steps).sum();
    let simulated = docking.settings.duration * docking.runs.len() as f64;
    let core_seconds = docking.wall_s * docking.threads as f64;
    json!({
        "wall_s": docking.wall_s, "threads": docking.threads,
        "free_steps": free, "contact_steps": contact, "simulated_s": simulated,
        "core_s_per_step": core_seconds / (free + contact).max(1) as f64,
        "core_s_per_simulated_s": core_seconds / simulated.max(f64::MIN_POSITIVE),
    })
}

fn describe_rate(rate: &OnRate) -> String {
    let [low, high] = rate.interval.map(|end| plain(end, 3));
    format!("{} /s ({low} to {high})", plain(rate.rate, 3))
}

fn ends(docking: &Docking) -> Table {
    let all = [
        ("bond", docking.bound),
        ("traps", docking.trapped),
        ("free", docking.free),
    ];
    rows(all)
        .column("end", "end", "where runs end", |(name, _)| *name)
        .column("share", "share", "of all runs, 95 %", |(_, share)| *share)
        .column("runs", "runs", "how many", |(_, share)| share.count)
        .table("ends")
        .in_view()
}

fn traps(problem: &Problem, docking: &Docking) -> Table {
    let rule = MatchRule::new(problem, docking.settings.threshold).ok();
    let is_bond = move |q: &Configuration| rule.as_ref().is_some_and(|rule| rule.holds(q));
    let bond = "bound, but not yet at the minimum or held short of it by friction";
    rows(&docking.traps)
        .column("pose", "x, y (mm), \u{3b8}", "the minimum", |it| {
            it.configuration
        })
        .column("energy_J", "energy", "at the minimum", |it| it.energy)
        .digits(4)
        .column("caught", "caught", "share of all runs, 95 %", |it| {
            it.caught
        })
        .shown("", "", move |it| match is_bond(&it.configuration) {
            true => bond,
            false => "",
        })
        .table("traps")
        .titled(
            "Minima that catch tiles without a match",
            "the minimum below the end of each run; symmetric copies are counted together",
        )
        .listing(LISTED)
}

/// `runs.csv`: one trajectory per row.
// One line a column.
#[rustfmt::skip]
pub fn runs(docking: &Docking) -> Table {
    let velocity = |axis: usize| move |run: &&DockingRun| run.start.motion.velocity[axis];
    rows(&docking.runs)
        .data("run", |run| run.index)
        .data("pose", |run| run.start.motion.configuration) // at the start
        .data("vx_m_per_s", velocity(0))
        .data("vy_m_per_s", velocity(1))
        .data("spin_rad_per_s", velocity(2))
        .data("orientation_rad", |run| run.start.orientation) // relative to the bond, at the start
        .data("speed_m_per_s", |run| run.start.speed) // at the start
        .data("end", |run| paths::ending(&run.end))
        .data("trap", |run| match run.end {
            End::Trapped { trap } => trap,
            _ => None,
        }) // number of the trap
        .data("time_to_bind_s", |run| match run.end {
            End::Bound { since } => Some(since),
            _ => None,
        })
        .data("end_pose", |run| run.last.motion.configuration) // at the end
        .table("runs")
        .in_csv("runs")
}

/// `map.csv`: one cell of the map per row.
pub fn chances(map: &DockingMap) -> Table {
    rows(&map.cells)
        .data("orientation_bounds_rad", |it| it.orientation)
        .data("speed_bounds_m_per_s", |it| it.speed)
        .data("matched", |it| it.matched.count)
        .data("runs", |it| it.matched.of)
        .data("share", |it| it.matched.share())
        .data("share_interval", |it| [it.matched.low, it.matched.high]) // 95 %
        .table("map")
        .in_csv("map")
}

/// One trajectory, one snapshot per row.
pub fn trajectory(snapshots: &[Snapshot]) -> Table {
    let velocity = |axis: usize| move |at: &&Snapshot| at.motion.velocity[axis];
    rows(snapshots)
        .data("time_s", |at| at.time)
        .data("pose", |at| at.motion.configuration)
        .data("vx_m_per_s", velocity(0))
        .data("vy_m_per_s", velocity(1))
        .data("spin_rad_per_s", velocity(2))
        .data("potential_J", |at| at.potential)
        .data("kinetic_J", |at| at.kinetic)
        .table("trajectory")
        .in_csv("trajectory")
}

/// The note on trajectories whose ends are unknown.
pub(crate) fn unsolved(unsolved: usize, runs: usize) -> Option<String> {
    (unsolved > 0).then(|| {
        format!(
            "{unsolved} of {runs} trajectories are unsolved: the impulses between the tiles are not found even \
             in the shortest steps; all intervals hold however they end; use less friction or another seed"
        )
    })
}

fn notes(docking: &Docking) -> Vec<String> {
    let mut notes = Vec::new();
    notes.extend(unsolved(docking.unsolved, docking.runs.len()));
    if let Some([least, middle, most]) = times(docking) {
        notes.push(format!(
            "time to bind: {least:.2} s to {most:.2} s, median {middle:.2} s"
        ));
    }
    let rate = OnRate::new(docking);
    notes.push(format!(
        "on-rate {}; times between attachments {} an exponential distribution",
        describe_rate(&rate),
        match rate.is_exponential() {
            true => "are compatible with",
            false => "refute",
        }
    ));
    notes
}

/// The picture of the chances of a match.
///
/// # Errors
/// See [`PictureError`].
pub fn picture(design: &Design, docking: &Docking, sheet: &Sheet) -> Result<Figure, PictureError> {
    let coarse = DockingMap::new(docking, dock::cells(docking.runs.len()));
    dock::chances(design, &coarse, chances(&coarse).csv(), sheet)
}

fn pictures<'a>(design: &'a Design, docking: &'a Docking, paths: &'a Paths) -> Vec<Drawing<'a>> {
    vec![
        Drawing::new("Chance of a match", move |sheet| {
            picture(design, docking, sheet)
        }),
        Drawing::new("Paths", move |sheet| {
            paths::trajectories(design, &paths.drawn, sheet)
        }),
    ]
}

/// The animations of the page.
fn scene(design: &Design, problem: &Problem, docking: &Docking, paths: &Paths) -> PagePart {
    let catalogue = Catalogue {
        states: states(problem, docking, design.pair.bound),
        ..Catalogue::default()
    };
    let played = paths.played.iter();
    let played = played
        .map(|(run, snapshots)| Played::of_trajectory(name(docking, run), snapshots, problem));
    let scene = Scene::new(design, problem, &catalogue);
    PagePart::Landscape(Box::new(Landscape::new(design, &scene, played.collect())))
}

/// The bond and the traps, to be marked in pictures.
fn states(problem: &Problem, docking: &Docking, bound: Configuration) -> Vec<State> {
    let rule = MatchRule::new(problem, docking.settings.threshold);
    let is_bond = |q: &Configuration| rule.as_ref().is_ok_and(|rule| rule.holds(q));
    let traps = docking.traps.iter().take(LISTED);
    let traps = traps.filter(|trap| !is_bond(&trap.configuration));
    let traps = traps.map(|trap| (StateKind::Trap, trap.configuration, trap.energy));
    let all = std::iter::once((StateKind::Bond, bound, problem.energy(&bound))).chain(traps);
    all.enumerate()
        .map(|(id, (kind, configuration, energy))| State::new(id, kind, configuration, energy))
        .collect()
}

fn name(docking: &Docking, run: &DockingRun) -> String {
    let end = match run.end {
        End::Bound { since } => format!("bound after {since:.2} s"),
        End::Free => "free".to_owned(),
        End::Unsolved => "unsolved".to_owned(),
        End::Trapped { trap } => trap.and_then(|trap| docking.traps.get(trap)).map_or_else(
            || "caught".to_owned(),
            |trap| format!("caught above {}", si(trap.energy, "J", 3)),
        ),
    };
    format!("trajectory {}: {end}", run.index)
}
