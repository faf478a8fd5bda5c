//! Rigid motions that bring two outlines into long contact; magnets are ignored.
//!
//! The longest contacts occur where an edge of one outline is flush with an edge of the other and a
//! corner of one meets a corner of the other: sliding along the common line changes the contact
//! only at such positions. So for every two edges, all motions are tried that place one on the
//! other with a corner of the moving outline, on or beside the common line, at a corner of the
//! fixed one; motions with overlap are discarded. Rotations at which too few edges are parallel for
//! a relevant contact are skipped.

mod gap;
#[cfg(test)]
mod tests;

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::Contact;
use crate::configuration::{Configuration, wrap_angle};
use crate::order::Order;
use crate::parallel;
use crate::tile::Outline;

/// A motion and its contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The pose of the moving tile.
    pub pose: Configuration,
    /// Length along which the outlines touch (m).
    pub contact: f64,
    /// Area between the tiles (m^2): enclosed, or in the hull of the stretch of contact.
    pub gap: f64,
}

/// Edges closer than this (m) and this parallel (rad) touch.
const TOUCHING: f64 = 1e-7;
const PARALLEL: f64 = 1e-9;
/// Motions closer than this (m, rad) are the same.
const SAME: f64 = 1e-6;
/// Least contact of a match, as a share of the shorter outline.
pub const LEAST_SHARE: f64 = 0.01;

/// The motions of longest contact, longest first, at most the given number. Contacts shorter than
/// [`LEAST_SHARE`] of the shorter outline are omitted.
pub fn matches(contact: &Contact, most: usize) -> Vec<Match> {
    let (fixed, moving) = (contact.fixed(), contact.moving());
    let same = contact.scaled(SAME);
    let least = LEAST_SHARE * perimeter(fixed).min(perimeter(moving));
    let turns: Vec<Turn> = turns([fixed, moving], least, contact.scaled(TOUCHING));
    let laid: Vec<(&Turn, [usize; 2])> = turns
        .iter()
        .flat_map(|turn| turn.laid.iter().map(move |pair| (turn, *pair)))
        .collect();
    let mut found: Vec<(&Turn, Match)> = parallel::flat_map(&laid, |&(turn, laid)| {
        let motions = flush_motions(contact, turn, laid).into_iter();
        let held = |found: &Match| found.contact >= least && contact.is_free(&found.pose);
        motions.filter(held).map(move |one| (turn, one))
    });
    found.order_by_key(|(_, it)| {
        let q = it.pose;
        // Lengths that differ only by rounding are equal.
        let length = (it.contact / same).round();
        (
            OrderedFloat(-length),
            [q.x / same, q.y / same, q.theta / SAME].map(|x| OrderedFloat(x.round())),
        )
    });
    let mut distinct: Vec<(&Turn, Match)> = Vec::new();
    for one in found {
        let is_same = |other: &(&Turn, Match)| {
            let step = one.1.pose.step_to(&other.1.pose);
            step.xy().amax() < 10.0 * same && step.z.abs() < 10.0 * SAME
        };
        if distinct.len() < most && !distinct.iter().rev().any(is_same) {
            distinct.push(one);
        }
    }
    parallel::map(&distinct, |(turn, one)| Match {
        gap: gap::gap_area([fixed, moving], &turn.facing, &one.pose, contact.scale()),
        ..*one
    })
}

fn edge(outline: &Outline, i: usize) -> [Vector2<f64>; 2] {
    outline.edge(i).into()
}

fn perimeter(outline: &Outline) -> f64 {
    let edges = 0..outline.vertices().len();
    edges.map(|i| length(outline, i)).sum()
}

fn length(outline: &Outline, i: usize) -> f64 {
    let [start, end] = edge(outline, i);
    (end - start).norm()
}

/// A rotation of the moving outline that makes edges of both outlines face each other.
struct Turn {
    /// Edges of the fixed and of the moving outline that it makes parallel.
    laid: Vec<[usize; 2]>,
    /// These, and edges so nearly parallel that they touch along their whole overlap.
    facing: Vec<Facing>,
}

/// All rotations that make an edge flush with an edge and may give a contact of at least the given
/// length (m). For most of them, especially with curved outlines, few short edges meet, which
/// bounds the contact before any motion is tried.
fn turns([fixed, moving]: [&Outline; 2], least: f64, touching: f64) -> Vec<Turn> {
    let mut pairs: Vec<(f64, [usize; 2])> = (0..fixed.vertices().len())
        .flat_map(|a| (0..moving.vertices().len()).map(move |b| [a, b]))
        .map(|[a, b]| (turn_of(edge(fixed, a), edge(moving, b)), [a, b]))
        .collect();
    pairs.order_by_key(|(theta, pair)| (OrderedFloat(*theta), *pair));
    let may_touch = |pairs: &[[usize; 2]]| {
        let of = |tile: usize, outline: &Outline| {
            let mut edges: Vec<usize> = pairs.iter().map(|pair| pair[tile]).collect();
            edges.sort_unstable();
            edges.dedup();
            edges.into_iter().map(|i| length(outline, i)).sum::<f64>()
        };
        of(0, fixed).min(of(1, moving))
    };
    let shortest = (0..fixed.vertices().len()).map(|a| length(fixed, a));
    let widest = 2.0 * parallel_within(shortest.fold(f64::INFINITY, f64::min), touching);
    let around = |theta: f64| {
        let from = pairs.partition_point(|it| it.0 < theta - widest);
        let to = pairs.partition_point(|it| it.0 <= theta + widest);
        &pairs[from..to]
    };
    let of = |laid: &[(f64, [usize; 2])]| {
        let theta = laid[0].0;
        let all = [-TAU, 0.0, TAU].map(|whole| around(theta + whole));
        let near = all.into_iter().flatten().filter(|(other, [a, _])| {
            wrap_angle(other - theta).abs() < 2.0 * parallel_within(length(fixed, *a), touching)
        });
        let near: Vec<[usize; 2]> = near.map(|it| it.1).collect();
        (may_touch(&near) >= least).then(|| Turn {
            laid: laid.iter().map(|it| it.1).collect(),
            facing: near
                .iter()
                .map(|[a, b]| Facing::new(edge(fixed, *a), edge(moving, *b), theta))
                .collect(),
        })
    };
    let same = |a: &(f64, [usize; 2]), b: &(f64, [usize; 2])| b.0 - a.0 < PARALLEL;
    let groups: Vec<&[(f64, [usize; 2])]> = pairs.chunk_by(same).collect();
    parallel::flat_map(&groups, |group| of(group))
}

/// Edges of such a length (m) are parallel to others within this angle (rad); edges closer than
/// `touching` (m) touch.
fn parallel_within(length: f64, touching: f64) -> f64 {
    PARALLEL.max(touching / length)
}

/// The rotation (rad) that places a moving edge on a fixed one, face to face.
fn turn_of([start, end]: [Vector2<f64>; 2], [from, to]: [Vector2<f64>; 2]) -> f64 {
    let (u, v) = (end - start, from - to);
    let theta = wrap_angle(libm::atan2(u.y, u.x) - libm::atan2(v.y, v.x));
    // Half a turn has one canonical value, independent of rounding.
    if theta < PARALLEL - PI { PI } else { theta }
}

/// Motions that place edge b of the moving outline on edge a of the fixed one, face to face, with a
/// corner of one at a corner of the other along their common direction; with the length in contact.
/// The gap is not yet computed.
fn flush_motions(contact: &Contact, turn: &Turn, [a, b]: [usize; 2]) -> Vec<Match> {
    let (fixed, moving) = (contact.fixed(), contact.moving());
    let [same, touching] = [SAME, TOUCHING].map(|length| contact.scaled(length));
    let [start, end] = edge(fixed, a);
    let [from, to] = edge(moving, b);
    let along = (end - start).normalize();
    let theta = turn_of([start, end], [from, to]);
    let turned = |p: Vector2<f64>| Configuration::new(0.0, 0.0, theta).transform(p);
    // Positions of corners along the common line, relative to those of the edges.
    let place = |p: Vector2<f64>| p.dot(&along);
    let across = start - along * place(start) - (turned(to) - along * place(turned(to)));
    let corners: Vec<f64> = moving
        .vertices()
        .iter()
        .map(|p| place(turned(*p)))
        .collect();
    // The two edges overlap only at slides between these.
    let own = place(start) - place(turned(to));
    let (least, most) = (
        own - (to - from).norm(),
        own + (end - start).norm() + (to - from).norm(),
    );
    let mut slides: Vec<f64> = Vec::new();
    for corner in fixed.vertices().iter().map(|p| place(*p)) {
        let meeting = corners.iter().map(|other| corner - other);
        slides.extend(meeting.filter(|slide| *slide > least && *slide < most));
    }
    slides.order_by(f64::total_cmp);
    slides.dedup_by(|a, b| (*a - *b).abs() < same);
    let pose = |slide: &f64| {
        let shift = across + along * *slide;
        Configuration::new(shift.x, shift.y, theta)
    };
    let mut motions: Vec<Match> = slides
        .iter()
        .map(|slide| Match {
            pose: pose(slide),
            contact: 0.0,
            gap: 0.0,
        })
        .collect();
    // Edges on the common line touch along their overlap, others where they pass each other.
    for facing in &turn.facing {
        let height = (across + facing.from - facing.start).dot(&facing.normal);
        let slope = along.dot(&facing.normal);
        let passing = if slope.abs() * (most - least) < touching {
            0..slides.len()
        } else {
            let (at, reach) = (-height / slope, 2.0 * touching / slope.abs());
            slides.partition_point(|s| *s < at - reach)
                ..slides.partition_point(|s| *s <= at + reach)
        };
        for motion in &mut motions[passing] {
            if let Some([a, b]) = facing.stretch(motion.pose.position(), touching) {
                motion.contact += (b - a).norm();
            }
        }
    }
    motions
}

/// An edge of the fixed outline and one of the moving outline, turned but not moved, that faces it.
struct Facing {
    /// The start of the fixed edge, its direction, its outward normal and its length (m).
    start: Vector2<f64>,
    along: Vector2<f64>,
    normal: Vector2<f64>,
    length: f64,
    /// The ends of the moving edge.
    from: Vector2<f64>,
    to: Vector2<f64>,
}

impl Facing {
    fn new([start, end]: [Vector2<f64>; 2], moving: [Vector2<f64>; 2], theta: f64) -> Self {
        let length = (end - start).norm();
        let along = (end - start) / length;
        let [from, to] = moving.map(|p| Configuration::new(0.0, 0.0, theta).transform(p));
        Self {
            start,
            along,
            normal: Vector2::new(along.y, -along.x),
            length,
            from,
            to,
        }
    }

    /// The stretch along which the edges are closer than `touching` (m), after the moving one is
    /// shifted.
    fn stretch(&self, shift: Vector2<f64>, touching: f64) -> Option<[Vector2<f64>; 2]> {
        let [from, to] = [self.from, self.to].map(|p| p + shift - self.start);
        let near = |p: Vector2<f64>| p.dot(&self.normal).abs() < touching;
        let low = to.dot(&self.along).max(0.0);
        let high = from.dot(&self.along).min(self.length);
        (near(from) && near(to) && high - low > touching)
            .then(|| [low, high].map(|place| self.start + self.along * place))
    }
}
