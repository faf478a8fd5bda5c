//! Rigid motions that bring two outlines, magnets aside, into long contact.
//!
//! Longest contacts are met where an edge of one outline lies flush on an edge of the other and a
//! corner of one stops at a corner of the other: sliding along the common line changes the contact
//! only at such places. So of every two edges the motions are tried that lay one on the other with
//! any corner of the moving outline that lies on the common line, or beside it, at any of the fixed
//! one; those that overlap are dropped. Turns at which too little of the edges is parallel for a
//! contact worth the name are not tried.

use std::f64::consts::PI;

use nalgebra::Vector2;
use ordered_float::OrderedFloat;
use rayon::prelude::*;

use crate::configuration::{Configuration, wrap_angle};
use crate::contact::Contact;
use crate::tile::Outline;

/// A motion and what it brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// Of the moving tile.
    pub pose: Configuration,
    /// Length along which the outlines touch (m).
    pub contact: f64,
    /// Area that is neither tile's but between them: enclosed, or in the hull of the stretch of
    /// contact (m^2).
    pub gap: f64,
}

/// Edges closer than this (m) and this parallel (rad) touch.
const TOUCHING: f64 = 1e-7;
const PARALLEL: f64 = 1e-9;
/// Motions closer than this (m, rad) are the same.
const SAME: f64 = 1e-6;
/// Contacts shorter than this share of the shorter outline are no matches.
pub const LEAST_SHARE: f64 = 0.01;

/// The motions of longest contact, longest first, at most so many. Contacts shorter than
/// [`LEAST_SHARE`] of the shorter outline are left out.
pub fn matches(contact: &Contact, most: usize) -> Vec<Match> {
    let (fixed, moving) = (contact.fixed(), contact.moving());
    let least = LEAST_SHARE * perimeter(fixed).min(perimeter(moving));
    let pairs: Vec<[usize; 2]> = turns(fixed, moving)
        .into_iter()
        .filter(|turn| turn.most >= least)
        .flat_map(|turn| turn.pairs)
        .collect();
    let mut found: Vec<Match> = pairs
        .par_iter()
        .flat_map_iter(|[a, b]| flush_motions(fixed, moving, *a, *b))
        .map(|pose| Match {
            contact: contact_length(fixed, moving, &pose),
            gap: 0.0,
            pose,
        })
        .filter(|found| found.contact >= least && contact.is_free(&found.pose))
        .collect();
    found.sort_by_key(|it| {
        let q = it.pose;
        // Lengths that differ by rounding are the same.
        let length = (it.contact / SAME).round();
        (
            OrderedFloat(-length),
            [q.x, q.y, q.theta].map(|x| OrderedFloat((x / SAME).round())),
        )
    });
    let mut distinct: Vec<Match> = Vec::new();
    for one in found {
        let same = |other: &Match| {
            let step = one.pose.step_to(&other.pose);
            step.iter().all(|x| x.abs() < 10.0 * SAME)
        };
        if distinct.len() < most && !distinct.iter().rev().any(same) {
            distinct.push(one);
        }
    }
    distinct
        .par_iter()
        .map(|one| Match {
            gap: gap_area(fixed, moving, &one.pose),
            ..*one
        })
        .collect()
}

/// The poses alone, as guesses for minima.
pub fn guesses(contact: &Contact, most: usize) -> Vec<Configuration> {
    matches(contact, most).iter().map(|it| it.pose).collect()
}

fn edge(outline: &Outline, i: usize) -> [Vector2<f64>; 2] {
    let vertices = outline.vertices();
    [vertices[i], vertices[(i + 1) % vertices.len()]]
}

fn perimeter(outline: &Outline) -> f64 {
    let edges = 0..outline.vertices().len();
    edges.map(|i| length(outline, i)).sum()
}

fn length(outline: &Outline, i: usize) -> f64 {
    let [start, end] = edge(outline, i);
    (end - start).norm()
}

/// A turn of the moving outline that makes edges of the two face each other.
struct Turn {
    /// Edges of the fixed and of the moving outline.
    pairs: Vec<[usize; 2]>,
    /// No contact at this turn is longer (m).
    most: f64,
}

/// All turns that lay an edge on an edge. Of most of them, of curved outlines above all, few short
/// edges meet, which bounds the contact before any motion is tried.
fn turns(fixed: &Outline, moving: &Outline) -> Vec<Turn> {
    let mut pairs: Vec<(f64, [usize; 2])> = (0..fixed.vertices().len())
        .flat_map(|a| (0..moving.vertices().len()).map(move |b| [a, b]))
        .map(|[a, b]| (turn_of(edge(fixed, a), edge(moving, b)), [a, b]))
        .collect();
    pairs.sort_by_key(|(theta, pair)| (OrderedFloat(*theta), *pair));
    let same = |a: &(f64, [usize; 2]), b: &(f64, [usize; 2])| b.0 - a.0 < PARALLEL;
    let turns = pairs.chunk_by(same).map(|pairs| {
        let pairs: Vec<[usize; 2]> = pairs.iter().map(|it| it.1).collect();
        let of = |tile: usize, outline: &Outline| {
            let mut edges: Vec<usize> = pairs.iter().map(|pair| pair[tile]).collect();
            edges.sort_unstable();
            edges.dedup();
            edges.into_iter().map(|i| length(outline, i)).sum::<f64>()
        };
        Turn {
            most: of(0, fixed).min(of(1, moving)),
            pairs,
        }
    });
    turns.collect()
}

/// The turn (rad) that lays a moving edge on a fixed one, face to face.
fn turn_of([start, end]: [Vector2<f64>; 2], [from, to]: [Vector2<f64>; 2]) -> f64 {
    let (u, v) = (end - start, from - to);
    let theta = wrap_angle(u.y.atan2(u.x) - v.y.atan2(v.x));
    // Half a turn is told one way, whatever rounding makes of it.
    if theta < PARALLEL - PI { PI } else { theta }
}

/// Motions that lay edge b of the moving outline on edge a of the fixed one, face to face, with a
/// corner of the one at a corner of the other along their common direction.
fn flush_motions(fixed: &Outline, moving: &Outline, a: usize, b: usize) -> Vec<Configuration> {
    let [start, end] = edge(fixed, a);
    let [from, to] = edge(moving, b);
    let along = (end - start).normalize();
    let theta = turn_of([start, end], [from, to]);
    let turned = |p: Vector2<f64>| Configuration::new(0.0, 0.0, theta).transform(p);
    // Places along the common line: of corners, from the edges' own.
    let place = |p: Vector2<f64>| p.dot(&along);
    let across = start - along * place(start) - (turned(to) - along * place(turned(to)));
    let length = (end - start).norm() + (to - from).norm();
    let mut slides: Vec<f64> = Vec::new();
    let own = place(start) - place(turned(to));
    for corner in fixed.vertices() {
        for other in moving.vertices() {
            let slide = place(*corner) - place(turned(*other));
            // The two edges overlap at these slides only.
            if slide > own - (to - from).norm() && slide < own + length {
                slides.push(slide);
            }
        }
    }
    slides.sort_by(f64::total_cmp);
    slides.dedup_by(|a, b| (*a - *b).abs() < SAME);
    let pose = |slide: f64| {
        let shift = across + along * slide;
        Configuration::new(shift.x, shift.y, theta)
    };
    slides.into_iter().map(pose).collect()
}

/// The length (m) along which edges of the two outlines lie on each other, face to face.
pub fn contact_length(fixed: &Outline, moving: &Outline, q: &Configuration) -> f64 {
    stretches(fixed, moving, q)
        .iter()
        .map(|[a, b]| (b - a).norm())
        .sum()
}

/// The stretches along which edges lie on each other.
fn stretches(fixed: &Outline, moving: &Outline, q: &Configuration) -> Vec<[Vector2<f64>; 2]> {
    let mut all = Vec::new();
    let placed: Vec<_> = (0..moving.vertices().len())
        .map(|b| edge(moving, b).map(|p| q.transform(p)))
        .collect();
    for a in 0..fixed.vertices().len() {
        let [start, end] = edge(fixed, a);
        let length = (end - start).norm();
        let along = (end - start) / length;
        let normal = Vector2::new(along.y, -along.x);
        for [from, to] in &placed {
            let direction = (to - from).normalize();
            let opposite = direction.dot(&along) < 0.0
                && direction.perp(&along).abs() < PARALLEL.max(TOUCHING / length);
            let near = [from, to]
                .iter()
                .all(|p| (*p - start).dot(&normal).abs() < TOUCHING);
            if opposite && near {
                let low = (to - start).dot(&along).max(0.0);
                let high = (from - start).dot(&along).min(length);
                if high - low > TOUCHING {
                    all.push([start + along * low, start + along * high]);
                }
            }
        }
    }
    all
}

/// The area (m^2) between the tiles along their contact: of the convex hull of all stretches in
/// contact, what neither tile fills.
fn gap_area(fixed: &Outline, moving: &Outline, q: &Configuration) -> f64 {
    let points: Vec<Vector2<f64>> = stretches(fixed, moving, q).into_iter().flatten().collect();
    let hull = hull(points);
    let placed = moving.vertices().iter().map(|p| q.transform(*p)).collect();
    let filled = area_within(fixed.vertices().to_vec(), &hull) + area_within(placed, &hull);
    let gap = area(&hull) - filled;
    // What rounding leaves of outlines that fit.
    if gap < TOUCHING * TOUCHING.sqrt() {
        0.0
    } else {
        gap
    }
}

/// The area (m^2) of a polygon, counter-clockwise.
fn area(polygon: &[Vector2<f64>]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp(b))
        .sum::<f64>()
        / 2.0
}

/// The area (m^2) of what a polygon has in a convex one, both counter-clockwise: clipped by side
/// after side (Sutherland and Hodgman 1974). Edges that the clipping doubles enclose nothing.
fn area_within(polygon: Vec<Vector2<f64>>, hull: &[Vector2<f64>]) -> f64 {
    let sides = (0..hull.len()).map(|i| [hull[i], hull[(i + 1) % hull.len()]]);
    area(&sides.fold(polygon, |left, side| clipped(&left, side)))
}

/// What of a polygon lies left of the line from a to b.
fn clipped(polygon: &[Vector2<f64>], [a, b]: [Vector2<f64>; 2]) -> Vec<Vector2<f64>> {
    let height = |p: &Vector2<f64>| (b - a).perp(&(p - a));
    let next = polygon.iter().cycle().skip(1);
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (p, q) in polygon.iter().zip(next) {
        let (from, to) = (height(p), height(q));
        if from >= 0.0 {
            left.push(*p);
        }
        if (from < 0.0) != (to < 0.0) {
            left.push(p + (q - p) * (from / (from - to)));
        }
    }
    left
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    points.sort_by_key(|p| (OrderedFloat(p.x), OrderedFloat(p.y)));
    points.dedup();
    let mut lower = half_hull(points.iter());
    lower.extend(half_hull(points.iter().rev()));
    lower
}

/// The half of a hull to the right of the way along points in order, its last point left out.
fn half_hull<'a>(points: impl Iterator<Item = &'a Vector2<f64>>) -> Vec<Vector2<f64>> {
    let mut chain: Vec<Vector2<f64>> = Vec::new();
    for p in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp(&(p - a)) > 1e-15 {
                break;
            }
            chain.pop();
        }
        chain.push(*p);
    }
    chain.pop();
    chain
}
