//! The checks of one results folder.

use std::collections::BTreeMap;

use super::checks::{Book, Subject};
use super::distance::{self, Rim, clearance};
use super::energy::{Magnets, Model, StraightMotion, TOUCH};
use super::given::{Barrier, BarrierEnd, Given, GivenPoint, Pose, Report, Share, Tiles};
use super::interval::Interval;
use physics::parallel;

/// Overlap that pathways may have, as a share of the smaller tile's circumradius: they are proved free to
/// half a micrometre of the paper's tile.
const OVERLAP: f64 = 1.65e-6;
/// Largest number of parts of a segment, and of all of a pathway beside one each: what takes more is
/// undecided.
const MOST_PARTS: [usize; 2] = [400, 4000];

/// How far numbers may be off.
struct Allowed {
    /// The largest depth of a state (J).
    depth: f64,
    /// Energies at poses with all digits (J).
    energy: f64,
    /// Energies on straight motions between points of a file (J).
    upper: f64,
    /// Places (m, and rad).
    place: f64,
    /// Overlaps (m).
    overlap: f64,
}

impl Allowed {
    fn of(report: &Report, tiles: &Tiles, model: Option<Model>) -> Self {
        let states = report.states.iter().map(|it| it.energy.abs());
        let depth = states.fold(report.bound.energy.abs(), f64::max);
        let radii = [&tiles.fixed, &tiles.moving].map(|tile| radius(&tile.outline_m));
        let size = radii[0] + radii[1];
        // Far groups of very many dipoles are replaced by fewer, with an error of their own.
        let many = tiles.fixed.magnets.len() * tiles.moving.magnets.len() >= 16_384;
        let share = match model {
            Some(Model::Dipoles) if !many => 1e-9,
            Some(Model::Dipoles) => 1e-7,
            _ => 1e-5,
        };
        let energy = share * depth;
        Self {
            depth,
            energy,
            // Points that are left out of files lie within 1e-8 of the pathway's extent.
            upper: energy.max(1e-7 * depth),
            place: 1e-6 * size,
            overlap: OVERLAP * radii[0].min(radii[1]),
        }
    }
}

fn radius(outline: &[[f64; 2]]) -> f64 {
    outline
        .iter()
        .map(|p| libm::hypot(p[0], p[1]))
        .fold(0.0, f64::max)
}

/// What the checks of a folder found, and what could not be checked.
pub(super) struct Checked {
    pub book: Book,
    pub unchecked: Vec<String>,
}

/// Checks one folder.
pub(super) fn check(given: &Given) -> Checked {
    let report = &given.report;
    let mut book = Book::default();
    let mut unchecked = Vec::new();
    lists(report, &mut book);
    let Some(tiles) = &report.tiles else {
        unchecked.push(
            "energies and clearances: report.json has no `tiles`; analyse the design again"
                .to_owned(),
        );
        return Checked { book, unchecked };
    };
    for (tile, name) in [(&tiles.fixed, "fixed"), (&tiles.moving, "moving")] {
        let holds = tile.magnets.iter().all(|it| it.face < tile.faces.len());
        book.note(Subject::Lists, holds, || {
            format!("the {name} tile has a magnet on a face that it does not have")
        });
    }
    let shields = report.settings.shields.as_deref();
    let magnets = Magnets::new(tiles, &report.settings.model, shields);
    if let Err(why) = &magnets {
        unchecked.push(format!("energies: {why}"));
    }
    if let Some(why) = &report.uncertified {
        unchecked.push(format!("bounds of barriers: none are stated ({why})"));
    }
    let magnets = magnets.ok();
    let allowed = Allowed::of(report, tiles, magnets.as_ref().map(Magnets::model));
    Folder {
        given,
        tiles,
        magnets: magnets.as_ref(),
        allowed,
        gyration: distance::gyration(&tiles.moving.outline_m),
        rims: [&tiles.fixed, &tiles.moving].map(|it| Rim::new(it.outline_m.clone())),
    }
    .check(&mut book);
    Checked { book, unchecked }
}

/// Everything that needs no geometry.
fn lists(report: &Report, book: &mut Book) {
    let states = &report.states;
    let share = |it: &Share, what: &str, book: &mut Book| {
        let ratio = it.count as f64 / (it.of as f64).max(1.0);
        book.compare(
            Subject::Captures,
            &format!("{what}: share"),
            [it.share, ratio],
            1e-15,
        );
        let is_inside = it.low <= it.share && it.share <= it.high;
        book.note(Subject::Captures, is_inside, || {
            format!(
                "{what}: {} is not between {} and {}",
                it.share, it.low, it.high
            )
        });
    };
    let free = &report.free;
    for (it, what) in [
        (&free.capture, "free"),
        (&free.at_rest, "at_rest"),
        (&free.gone, "gone"),
    ] {
        share(it, what, book);
    }
    let mut sum = free.capture.count;
    for state in states {
        if let Some(it) = &state.capture {
            share(it, &format!("state {}", state.id), book);
            sum += it.count;
            book.note(Subject::Captures, it.of == free.capture.of, || {
                format!(
                    "state {}: of {} starts, and free of {}",
                    state.id, it.of, free.capture.of
                )
            });
        }
    }
    if states.iter().all(|it| it.capture.is_some()) {
        book.note(Subject::Captures, sum == free.capture.of, || {
            format!("{sum} far starts are counted of {}", free.capture.of)
        });
    }
    let parts = free.at_rest.count + free.gone.count;
    book.note(Subject::Captures, parts == free.capture.count, || {
        format!(
            "at_rest and gone are {parts} of {} free starts",
            free.capture.count
        )
    });
    for (number, state) in states.iter().enumerate() {
        let same = states.iter().filter(|it| it.class == state.class).count();
        let first = states.get(state.class);
        let is_known = first.is_some_and(|it| it.class == it.id && it.kind == state.kind);
        let holds = state.id == number && is_known && same == state.copies;
        book.note(Subject::Lists, holds, || {
            format!(
                "state {}: id, class {} and {} copies do not agree with the list",
                state.id, state.class, state.copies
            )
        });
    }
    let known = &report.inventory;
    let is_whole = known.open.is_empty() && known.unproved.is_none();
    book.note(Subject::Lists, !known.complete || is_whole, || {
        "the inventory is `complete`, and has open regions or no proof".to_owned()
    });
    let ratio = report.settings.complete_escape / report.settings.complete_below;
    if let (Some(below), Some(escape)) = (known.below, known.escape) {
        let off = (escape + ratio * below).abs();
        book.note(Subject::Lists, off <= 1e-9 * escape.abs(), || {
            format!("escape_J of the inventory is not {ratio} of below_J")
        });
    }
}

struct Folder<'a> {
    given: &'a Given,
    tiles: &'a Tiles,
    magnets: Option<&'a Magnets>,
    allowed: Allowed,
    /// Of the moving tile (m).
    gyration: f64,
    /// Of both tiles.
    rims: [Rim; 2],
}

impl Folder<'_> {
    fn check(&self, book: &mut Book) {
        self.states(book);
        let limits = self.limits();
        let ways = Vec::from_iter(&self.given.pathways);
        let found = parallel::map(&ways, |(name, points)| {
            let mut book = Book::default();
            let points = points.as_ref().map_err(String::clone)?;
            let limit = limits.get(name.as_str()).copied();
            let peak = self.pathway(name, points, limit, &mut book);
            Ok((book, peak))
        });
        let mut peaks = BTreeMap::new();
        for ((name, _), one) in ways.iter().zip(found) {
            match one {
                Ok((more, peak)) => {
                    book.add(more, "");
                    peaks.extend(peak.map(|peak| (name.as_str(), peak)));
                }
                Err(why) => {
                    let why: String = why;
                    book.note(Subject::Ends, false, || format!("no pathway: {why}"));
                }
            }
        }
        let report = &self.given.report;
        let escapes = report.states.iter().filter_map(|it| it.escape.as_ref());
        for barrier in report.barriers.iter().chain(escapes) {
            self.barrier(barrier, &peaks, book);
        }
        self.alternatives(&peaks, book);
    }

    /// The least upper bound that each pathway is said to prove.
    fn limits(&self) -> BTreeMap<&str, f64> {
        let report = &self.given.report;
        let escapes = report.states.iter().filter_map(|it| it.escape.as_ref());
        let mut limits = BTreeMap::new();
        for it in report.barriers.iter().chain(escapes) {
            if let (Some(name), Some(upper)) = (&it.pathway, it.upper) {
                let limit = limits.entry(name.as_str()).or_insert(upper);
                *limit = upper.min(*limit);
            }
        }
        limits
    }

    fn clearance(&self, pose: Pose) -> f64 {
        clearance(&self.rims[0], &self.rims[1], pose)
    }

    /// The magnets, if there is a formula for them where they are.
    fn known_at(&self, pose: Option<Pose>) -> Option<&Magnets> {
        self.magnets
            .filter(|it| pose.is_none_or(|pose| !it.overlap(pose, TOUCH)))
    }

    fn free(&self, what: &str, pose: Pose, book: &mut Book) {
        let clearance = self.clearance(pose);
        let holds = clearance >= -self.allowed.overlap && clearance.is_finite();
        book.note(Subject::Clearances, holds, || {
            format!("{what}: the tiles overlap by {:e} m", -clearance)
        });
    }

    fn states(&self, book: &mut Book) {
        let report = &self.given.report;
        let energy = self.allowed.energy;
        let tiles = self.tiles;
        let shields = report.settings.shields.as_deref();
        let is_asked = report.states.iter().any(|it| it.block_energy.is_some());
        let blocks = is_asked.then(|| Magnets::new(tiles, "cuboid", shields).ok());
        let blocks = blocks.flatten();
        let bound = &report.bound;
        if let Some(magnets) = self.magnets {
            let stated = [
                bound.energy,
                magnets.energy_beside(bound.energy, bound.pose),
            ];
            book.compare(Subject::States, "bound: energy_J", stated, energy);
        }
        let off = apart(bound.pose, tiles.target_pose);
        book.note(Subject::Ends, off <= self.allowed.place, || {
            "bound: the pose is not that of the target faces".to_owned()
        });
        let found = parallel::map(&report.states, |state| {
            let of = |magnets: Option<&Magnets>, stated: f64| {
                let known = magnets.filter(|it| !it.overlap(state.pose, TOUCH));
                known.map(|it| it.energy_beside(stated, state.pose))
            };
            let asked = state.block_energy;
            (
                of(self.magnets, state.energy),
                asked.and_then(|stated| of(blocks.as_ref(), stated)),
            )
        });
        let deepest = found
            .iter()
            .filter_map(|it| it.1)
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        for (state, (own, as_blocks)) in report.states.iter().zip(found) {
            let what = format!("state {}", state.id);
            self.free(&what, state.pose, book);
            match own {
                Some(own) => {
                    let what = format!("{what}: energy_J");
                    book.compare(Subject::States, &what, [state.energy, own], energy);
                }
                None => book.leave(Subject::States, 1),
            }
            match (state.block_energy, as_blocks) {
                (Some(stated), Some(own)) => {
                    let what = format!("{what}: block_energy_J");
                    book.compare(Subject::Blocks, &what, [stated, own], 1e-5 * deepest);
                }
                (Some(_), None) => book.leave(Subject::Blocks, 1),
                _ => {}
            }
        }
    }

    /// Checks a pathway's points and its segments against a limit (J); returns the highest energy of its
    /// points found here.
    fn pathway(
        &self,
        name: &str,
        points: &[GivenPoint],
        limit: Option<f64>,
        book: &mut Book,
    ) -> Option<f64> {
        for (number, point) in points.iter().enumerate() {
            let what = || format!("{name}, point {number}");
            let own = self.clearance(point.pose());
            let least = own.min(point.clearance);
            let off = (own - point.clearance).abs();
            let overlap = self.allowed.overlap;
            let holds = least >= -overlap && off <= overlap.max(1e-9 * own.abs());
            let holds = holds && own.is_finite() && (own < overlap || off <= 1e-8 + 1e-9 * own);
            book.note(Subject::Clearances, holds, || {
                format!(
                    "{}: clearance_m {:e} is {own:e} here",
                    what(),
                    point.clearance
                )
            });
        }
        let last = points.last().map_or(0.0, |last| last.s);
        for pair in points.windows(2) {
            let half = StraightMotion::new(pair[0].pose(), pair[1].pose()).at(0.5);
            let clearance = self.clearance(half);
            // Points of the file are rounded, and those left out lie within 1e-8 of the extent.
            let overlap = self.allowed.overlap + 0.02 * self.allowed.place;
            book.note(Subject::Clearances, clearance >= -overlap, || {
                format!(
                    "{name}, after s = {}: the tiles overlap by {:e} m",
                    pair[0].s, -clearance
                )
            });
            let [from, to] = [pair[0].pose(), pair[1].pose()];
            let turn = self.gyration * turned(from, to);
            let length = libm::hypot(libm::hypot(to[0] - from[0], to[1] - from[1]), turn);
            let what = format!("{name}: s, after {}", pair[0].s);
            let allowed = 1e-6 * last + 1e-3 * length;
            book.compare(
                Subject::Lengths,
                &what,
                [pair[1].s - pair[0].s, length],
                allowed,
            );
        }
        let Some(magnets) = self.magnets else {
            book.leave(Subject::Points, points.len());
            book.leave(Subject::Upper, usize::from(limit.is_some()));
            return None;
        };
        let own: Vec<f64> = points
            .iter()
            .map(|it| magnets.energy_beside(it.energy, it.pose()))
            .collect();
        for (number, (point, own)) in points.iter().zip(&own).enumerate() {
            let mut allowed = self.allowed.energy + 1e-9 * own.abs();
            let mut overlap = TOUCH;
            if (point.energy - own).abs() > allowed {
                allowed += rounding(magnets, point.pose(), *own);
                // Where discs touch, rounding decides whether they overlap.
                overlap = -TOUCH;
            }
            if magnets.overlap(point.pose(), overlap) {
                book.leave(Subject::Points, 1);
                continue;
            }
            let what = format!("{name}, point {number}: energy_J");
            book.compare(Subject::Points, &what, [point.energy, *own], allowed);
        }
        let peak = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if let Some(limit) = limit {
            self.upper(name, points, &own, limit, book);
        }
        Some(peak)
    }

    /// Whether a pathway stays below a limit (J) over whole segments.
    fn upper(&self, name: &str, points: &[GivenPoint], own: &[f64], limit: f64, book: &mut Book) {
        let limit = limit + self.allowed.upper + 1e-6 * limit.abs();
        let mut is_open = false;
        let mut left = MOST_PARTS[1];
        for (pair, ends) in points.windows(2).zip(own.windows(2)) {
            let motion = StraightMotion::new(pair[0].pose(), pair[1].pose());
            match self.segment(&motion, [ends[0], ends[1]], limit, &mut left) {
                Segment::Below => {}
                Segment::Open => is_open = true,
                Segment::Above(energy) => {
                    book.note(Subject::Upper, false, || {
                        format!(
                            "{name}, after s = {}: the energy reaches {energy:e} J, above the upper bound \
                             of {limit:e} J",
                            pair[0].s
                        )
                    });
                    return;
                }
            }
        }
        match is_open {
            true => book.leave(Subject::Upper, 1),
            false => book.note(Subject::Upper, true, String::new),
        }
    }

    /// Whether the energy stays below a limit on a straight motion, given that at its ends. Between two
    /// points `h` apart a function exceeds the higher by no more than `h^2 / 8` times its largest bend
    /// downwards.
    fn segment(
        &self,
        motion: &StraightMotion,
        ends: [f64; 2],
        limit: f64,
        left: &mut usize,
    ) -> Segment {
        let Some(magnets) = self.magnets else {
            return Segment::Open;
        };
        let mut open = vec![([0.0, 1.0], ends)];
        let mut parts = 0;
        while let Some(([from, to], [first, last])) = open.pop() {
            let highest = first.max(last);
            if highest > limit {
                return Segment::Above(highest);
            }
            let (part, width) = (Interval::new(from, to), to - from);
            // The coarse bound is enough for most.
            let most = magnets.most_bend(motion, part);
            if most.is_some_and(|most| highest + most * width * width / 8.0 <= limit) {
                continue;
            }
            let bend = magnets.least_bend(motion, part).min(0.0);
            if highest - bend * width * width / 8.0 <= limit {
                continue;
            }
            parts += 1;
            // Magnets that touch have no largest bend, and discs that overlap no energy.
            if parts > MOST_PARTS[0] || *left == 0 || bend == f64::NEG_INFINITY && width < 0.5 {
                return Segment::Open;
            }
            *left -= 1;
            let middle = 0.5 * (from + to);
            let energy = magnets.energy(motion.at(middle));
            open.push(([from, middle], [first, energy]));
            open.push(([middle, to], [energy, last]));
        }
        Segment::Below
    }

    fn barrier(&self, it: &Barrier, peaks: &BTreeMap<&str, f64>, book: &mut Book) {
        let allowed = &self.allowed;
        let what = format!("barrier {} to {}", named(it.from), named(it.to));
        if let (Some(lower), Some(upper)) = (it.lower, it.upper) {
            book.note(Subject::Lower, lower <= upper + allowed.energy, || {
                format!("{what}: lower_J {lower:e} is above upper_J {upper:e}")
            });
        }
        if it.caged {
            book.note(
                Subject::Upper,
                it.upper.is_none() && it.pathway.is_none(),
                || format!("{what}: caged, and has a pathway"),
            );
        }
        self.heights(it, &what, book);
        let name = it.pathway.as_deref();
        let points = name.and_then(|name| self.given.pathways.get(name));
        let Some(Ok(points)) = points else {
            return;
        };
        self.ends(&what, [it.from, it.to], points, book);
        let stated = points.iter().map(|it| it.energy);
        let highest = stated.clone().fold(f64::NEG_INFINITY, f64::max);
        let range = highest - stated.fold(f64::INFINITY, f64::min);
        let rounded = 1e-9 * highest.abs() + 1e-12 * allowed.depth;
        if let Some(saddle) = it.saddle_energy {
            let stated = [saddle, highest];
            book.compare(
                Subject::Saddles,
                &format!("{what}: saddle_energy_J"),
                stated,
                rounded,
            );
            if let (Some(pose), Some(magnets)) = (it.saddle_pose, self.known_at(it.saddle_pose)) {
                let own = magnets.energy_beside(saddle, pose);
                let what = format!("{what}: energy at saddle_pose");
                book.compare(Subject::Saddles, &what, [saddle, own], allowed.energy);
            }
            if let Some(upper) = it.upper {
                let bound = allowed.upper + 1e-6 * upper.abs();
                book.note(Subject::Upper, saddle <= upper + bound, || {
                    format!("{what}: the saddle at {saddle:e} J is above upper_J {upper:e}")
                });
            }
        }
        if let Some(pose) = it.saddle_pose {
            self.free(&format!("{what}: saddle"), pose, book);
        }
        if let (Some(lower), Some(peak)) = (it.lower, name.and_then(|name| peaks.get(name))) {
            book.note(Subject::Lower, lower <= peak + allowed.upper, || {
                format!("{what}: its pathway stays below {peak:e} J, and lower_J is {lower:e}")
            });
        }
        let climbs = |sign: f64| -> f64 {
            let steps = points
                .windows(2)
                .map(|pair| sign * (pair[1].energy - pair[0].energy));
            steps.filter(|step| *step > 0.0).sum()
        };
        let stated = [
            ("work_J", it.work, climbs(1.0), 5e-4 * range),
            (
                "reverse_work_J",
                it.reverse_work,
                climbs(-1.0),
                5e-4 * range,
            ),
        ];
        let length = points.last().map_or(0.0, |last| last.s);
        for (key, stated, found, allowed) in
            stated
                .into_iter()
                .chain([("length_m", it.length, length, 1e-9 * length)])
        {
            if let Some(stated) = stated {
                book.compare(
                    Subject::Lengths,
                    &format!("{what}: {key}"),
                    [stated, found],
                    allowed,
                );
            }
        }
    }

    fn heights(&self, it: &Barrier, what: &str, book: &mut Book) {
        let states = &self.given.report.states;
        let energy = |place: BarrierEnd| match place {
            BarrierEnd::State(id) => states.get(id).map(|it| it.energy),
            BarrierEnd::Free(_) => Some(0.0),
        };
        let ends = [
            (it.from, it.forward, "forward_J"),
            (it.to, it.reverse, "reverse_J"),
        ];
        for (place, stated, key) in ends {
            let Some(end) = energy(place) else {
                book.note(Subject::Heights, false, || {
                    format!("{what}: there is no such state")
                });
                continue;
            };
            if let (Some(saddle), Some(stated)) = (it.saddle_energy, stated) {
                let found = (saddle - end).max(0.0);
                let allowed = 1e-12 * self.allowed.depth;
                book.compare(
                    Subject::Heights,
                    &format!("{what}: {key}"),
                    [stated, found],
                    allowed,
                );
            }
        }
    }

    fn ends(&self, what: &str, ends: [BarrierEnd; 2], points: &[GivenPoint], book: &mut Book) {
        let states = &self.given.report.states;
        let far = radius(&self.tiles.fixed.outline_m) + radius(&self.tiles.moving.outline_m);
        for (place, point) in ends.into_iter().zip([points.first(), points.last()]) {
            let Some(point) = point else { continue };
            let holds = match place {
                BarrierEnd::State(id) => states
                    .get(id)
                    .is_some_and(|it| apart(it.pose, point.pose()) <= self.allowed.place),
                BarrierEnd::Free(_) => libm::hypot(point.x, point.y) >= far * (1.0 - 1e-6),
            };
            book.note(Subject::Ends, holds, || {
                format!("{what}: the pathway does not reach {}", named(place))
            });
        }
    }

    /// Pathways by other costs lead as high as every lower bound between their ends.
    fn alternatives(&self, peaks: &BTreeMap<&str, f64>, book: &mut Book) {
        let report = &self.given.report;
        for way in &report.alternatives {
            let Some(name) = way.pathway.as_deref() else {
                continue;
            };
            if let Some(Ok(points)) = self.given.pathways.get(name) {
                self.ends(name, [way.from, way.to], points, book);
            }
            let ends = [[way.from, way.to], [way.to, way.from]];
            let barriers = report
                .barriers
                .iter()
                .filter(|it| ends.contains(&[it.from, it.to]));
            for (lower, peak) in barriers.filter_map(|it| it.lower.zip(peaks.get(name))) {
                book.note(Subject::Lower, lower <= peak + self.allowed.upper, || {
                    format!(
                        "{name} stays below {peak:e} J, and lower_J between its ends is {lower:e}"
                    )
                });
            }
        }
    }
}

/// How much the energy (J) at a pose changes with the last of its ten digits.
fn rounding(magnets: &Magnets, pose: Pose, energy: f64) -> f64 {
    let changes = (0..3).map(|k| {
        let mut moved = pose;
        moved[k] += 1e-9 * pose[k];
        (magnets.energy(moved) - energy).abs()
    });
    changes.sum()
}

enum Segment {
    Below,
    /// The energy (J) that is above.
    Above(f64),
    Open,
}

/// How far two poses are apart (m and rad, whichever is more).
pub(super) fn apart(a: Pose, b: Pose) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1]).max(turned(a, b))
}

/// The turn (rad) from one pose to another, the shorter way round.
fn turned(a: Pose, b: Pose) -> f64 {
    let turn = a[2] - b[2];
    (turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round()).abs()
}

pub(super) fn named(place: BarrierEnd) -> String {
    match place {
        BarrierEnd::State(id) => id.to_string(),
        BarrierEnd::Free(_) => "free".to_owned(),
    }
}
