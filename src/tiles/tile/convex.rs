//! Splitting a simple polygon into few compact convex parts.
//!
//! The split is exact: it runs along diagonals from vertex to vertex, so that no vertex is moved
//! and no notch is filled in. The diagonals are those of the triangulation of least total length
//! (dynamic programming over the polygon's chains: G. T. Klincsek, *Minimal triangulations of
//! polygonal domains*, 1980), without those that separate only convex neighbours (Hertel and
//! Mehlhorn's rule), dropped longest first. A tooth is then cut off at its foot; ear clipping would
//! leave long slivers across the whole tile, and every test for overlap would have to check most of
//! them.
//!
//! The time is proportional to the cube of the number of vertices, so polygons with very many are
//! halved first: every triangulation has a diagonal with at least a third of the vertices on either
//! side (B. Chazelle, *A theorem on polygon cutting with applications*, 1982).

use crate::order::Order;
use std::cmp::Reverse;
use std::f64::consts::PI;

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::plane::{cross, segments_meet};

/// Sines of angles below this count as zero.
const STRAIGHT: f64 = 1e-12;

/// Polygons with more vertices than this are halved first.
const LARGE: usize = 600;

/// Lists of vertex indices, each a convex polygon in the orientation of the whole
/// (counter-clockwise); empty if the vertices do not form a simple polygon. For very many vertices
/// that are not convex, the time is proportional to the square of their number.
pub(super) fn convex_parts(vertices: &[Vector2<f64>]) -> Option<Vec<Vec<usize>>> {
    if is_convex(vertices) {
        return Some(vec![(0..vertices.len()).collect()]);
    }
    let mut parts = Vec::new();
    let mut diagonals = Vec::new();
    let mut open = vec![(0..vertices.len()).collect::<Vec<_>>()];
    while let Some(chain) = open.pop() {
        let corners: Vec<_> = chain.iter().map(|&k| vertices[k]).collect();
        if chain.len() > LARGE {
            let (i, j) = halving_diagonal(&corners)?;
            diagonals.push((chain[i], chain[j]));
            open.push(chain[i..=j].to_vec());
            open.push([&chain[..=i], &chain[j..]].concat());
            continue;
        }
        let triangulation = Triangulation::shortest(&corners)?;
        let (mut triangles, mut cuts) = (Vec::new(), Vec::new());
        triangulation.collect(0, corners.len() - 1, &mut triangles, &mut cuts);
        let numbers = |part: Vec<usize>| part.iter().map(|&k| chain[k]).collect::<Vec<_>>();
        parts.extend(triangles.into_iter().map(numbers));
        diagonals.extend(cuts.into_iter().map(|(i, j)| (chain[i], chain[j])));
    }
    let length = |&(i, j): &(usize, usize)| (vertices[i] - vertices[j]).norm();
    diagonals.order_by_key(|d| (Reverse(OrderedFloat(length(d))), *d));
    for (i, j) in diagonals {
        merge(&mut parts, vertices, i, j);
    }
    Some(parts)
}

/// Whether the closed path over the vertices never reverses, turns left or not at all at each, and
/// goes around once.
fn is_convex(vertices: &[Vector2<f64>]) -> bool {
    let n = vertices.len();
    let angle = |k: usize| {
        let at = |k: usize| vertices[k % n];
        let (u, v) = (at(k + 1) - at(k), at(k + 2) - at(k + 1));
        libm::atan2(cross(u, v), u.dot(&v))
    };
    let angles = (0..n).map(angle);
    n > 2
        && angles
            .clone()
            .all(|angle| (-STRAIGHT..PI - STRAIGHT).contains(&angle))
        && angles.sum::<f64>() < 3.0 * PI
}

/// A diagonal with about as many vertices on either side, the shortest among equally balanced ones.
fn halving_diagonal(vertices: &[Vector2<f64>]) -> Option<(usize, usize)> {
    let n = vertices.len();
    let length = |&(i, j): &(usize, usize)| OrderedFloat((vertices[i] - vertices[j]).norm());
    (n / 4..=n / 2).rev().find_map(|span| {
        let pairs = (0..n).map(|i| (i.min((i + span) % n), i.max((i + span) % n)));
        let inside = pairs.filter(|&(i, j)| is_diagonal(vertices, i, j));
        inside.min_by_key(|pair| (length(pair), *pair))
    })
}

/// Merges the two parts on either side of a diagonal if their union is convex.
fn merge(parts: &mut Vec<Vec<usize>>, vertices: &[Vector2<f64>], i: usize, j: usize) {
    let Some((a, left)) = part_starting_with(parts, j, i) else {
        return;
    };
    let Some((b, right)) = part_starting_with(parts, i, j) else {
        return;
    };
    // `left` starts j, i, ..., and `right` i, j, ...: together, i, ..., j, ....
    let union: Vec<usize> = left[1..].iter().chain(&right[1..]).copied().collect();
    let n = union.len();
    let convex_at = |k: usize| {
        let at = |k: usize| vertices[union[k % n]];
        turn(at(k + n - 1), at(k), at(k + 1)) >= -STRAIGHT
    };
    if convex_at(0) && convex_at(left.len() - 1) {
        parts[a.min(b)] = union;
        parts.swap_remove(a.max(b));
    }
}

/// The part with an edge from vertex `i` to vertex `j`, listed from `i` on.
fn part_starting_with(parts: &[Vec<usize>], i: usize, j: usize) -> Option<(usize, Vec<usize>)> {
    parts.iter().enumerate().find_map(|(index, part)| {
        let n = part.len();
        let start = (0..n).find(|&k| part[k] == i && part[(k + 1) % n] == j)?;
        let listed = (0..n).map(|k| part[(start + k) % n]).collect();
        Some((index, listed))
    })
}

/// For every chain of vertices from i to j, the best third corner of the triangle on its closing
/// diagonal.
struct Triangulation {
    corner: Vec<Option<usize>>,
    vertices: usize,
}

impl Triangulation {
    fn shortest(vertices: &[Vector2<f64>]) -> Option<Self> {
        let n = vertices.len();
        let mut cost = vec![f64::INFINITY; n * n];
        let mut corner = vec![None; n * n];
        for i in 0..n - 1 {
            cost[i * n + i + 1] = 0.0;
            cost[(i + 1) * n + i] = 0.0;
        }
        for span in 2..n {
            for i in 0..n - span {
                let j = i + span;
                if span < n - 1 && !is_diagonal(vertices, i, j) {
                    continue;
                }
                let closing = (vertices[j] - vertices[i]).norm();
                let mut least = f64::INFINITY;
                for k in i + 1..j {
                    // For the chain from k to j, stored in both orders so that it is read along a
                    // row.
                    let total = cost[i * n + k] + cost[j * n + k] + closing;
                    if total < least && turn(vertices[i], vertices[k], vertices[j]) > STRAIGHT {
                        least = total;
                        corner[i * n + j] = Some(k);
                    }
                }
                cost[i * n + j] = least;
                cost[j * n + i] = least;
            }
        }
        corner[n - 1].is_some().then_some(Self {
            corner,
            vertices: n,
        })
    }

    fn collect(
        &self,
        i: usize,
        j: usize,
        triangles: &mut Vec<Vec<usize>>,
        diagonals: &mut Vec<(usize, usize)>,
    ) {
        let Some(k) = self.corner[i * self.vertices + j] else {
            return;
        };
        triangles.push(vec![i, k, j]);
        for (a, b) in [(i, k), (k, j)] {
            if b > a + 1 {
                diagonals.push((a, b));
                self.collect(a, b, triangles, diagonals);
            }
        }
    }
}

/// Sine of the angle by which the path from a over b to c turns left at b.
fn turn(a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>) -> f64 {
    let (u, v) = (b - a, c - b);
    cross(u, v) / (u.norm() * v.norm())
}

/// Whether the segment between two vertices that are not neighbours runs inside the polygon and
/// touches its boundary at its ends only.
fn is_diagonal(vertices: &[Vector2<f64>], i: usize, j: usize) -> bool {
    let n = vertices.len();
    starts_inside(vertices, i, j)
        && starts_inside(vertices, j, i)
        && (0..n).all(|k| {
            let next = (k + 1) % n;
            [k, next].iter().any(|end| *end == i || *end == j)
                || !segments_meet(
                    [vertices[i], vertices[j]],
                    [vertices[k], vertices[next]],
                    STRAIGHT,
                )
        })
}

/// Whether the segment from vertex i towards vertex j starts into the polygon, not along an edge at
/// i.
fn starts_inside(vertices: &[Vector2<f64>], i: usize, j: usize) -> bool {
    let n = vertices.len();
    let (before, at, after) = (
        vertices[(i + n - 1) % n],
        vertices[i],
        vertices[(i + 1) % n],
    );
    let sine = |u: Vector2<f64>, v: Vector2<f64>| cross(u, v) / (u.norm() * v.norm());
    let (to_after, to_before, way) = (after - at, before - at, vertices[j] - at);
    let left_of_after = sine(to_after, way) > STRAIGHT;
    let right_of_before = sine(way, to_before) > STRAIGHT;
    if turn(before, at, after) > 0.0 {
        left_of_after && right_of_before
    } else {
        // Inside is all that is not in the wedge between the edges, both of them excluded.
        let in_wedge = sine(to_before, way) >= -STRAIGHT && sine(way, to_after) >= -STRAIGHT;
        !in_wedge
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::outline::signed_area;

    fn points(list: &[[f64; 2]]) -> Vec<Vector2<f64>> {
        list.iter().map(|p| Vector2::new(p[0], p[1])).collect()
    }

    /// A unit square with teeth of the given number of steps on its right side.
    fn toothed(teeth: usize, steps: usize) -> Vec<Vector2<f64>> {
        let mut vertices = points(&[[0.0, 1.0], [0.0, 0.0]]);
        let n = teeth * steps;
        for k in 0..=n {
            let s = k as f64 / n as f64;
            let height = 0.05 * (1.0 - libm::cos(std::f64::consts::TAU * teeth as f64 * s)) / 2.0;
            vertices.push(Vector2::new(1.0 + height, s));
        }
        vertices
    }

    fn check(vertices: &[Vector2<f64>]) -> Vec<Vec<usize>> {
        let parts = convex_parts(vertices).expect("a simple polygon");
        let mut filled = 0.0;
        for part in &parts {
            let corners: Vec<_> = part.iter().map(|&k| vertices[k]).collect();
            let n = corners.len();
            for k in 0..n {
                assert!(
                    turn(corners[k], corners[(k + 1) % n], corners[(k + 2) % n]) >= -STRAIGHT,
                    "{part:?}"
                );
            }
            filled += signed_area(&corners);
        }
        assert!((filled - signed_area(vertices)).abs() < 1e-12);
        parts
    }

    #[test]
    fn a_convex_polygon_stays_whole() {
        let square = points(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(check(&square).len(), 1);
    }

    #[test]
    fn notches_and_steps_are_split() {
        // An L; a notch wider inside than at its mouth; steps with corners on one line.
        let l = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        assert_eq!(check(&points(&l)).len(), 2);
        check(&points(&[
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [2.5, 3.0],
            [3.0, 2.0],
            [1.0, 2.0],
            [1.5, 3.0],
            [0.0, 3.0],
        ]));
        let battlements = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 2.0],
            [4.0, 2.0],
            [4.0, 1.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        assert_eq!(check(&points(&battlements)).len(), 4);
    }

    #[test]
    fn polygons_of_very_many_vertices_are_halved() {
        // Slots that no straight line enters far, and teeth; 48 times as slow without halving.
        let slots: Vec<_> = (0..1000)
            .map(|k| f64::from(k) / 1000.0)
            .flat_map(|s| {
                [
                    [s + 2e-4, 0.0],
                    [s + 2e-4, 0.9],
                    [s + 8e-4, 0.9],
                    [s + 8e-4, 0.0],
                ]
            })
            .chain([[1.0, 1.0], [0.0, 1.0]])
            .collect();
        assert!(check(&points(&slots)).len() >= 1000);
        let parts = check(&toothed(200, 20));
        assert!(parts.iter().all(|part| part.len() < 300), "{}", parts.len());
    }

    #[test]
    fn teeth_are_cut_off_at_their_feet() {
        let vertices = toothed(5, 16);
        let parts = check(&vertices);
        let long = parts.iter().filter(|part| {
            let corners = || part.iter().map(|&k| vertices[k].x);
            corners().fold(f64::INFINITY, f64::min) < 0.5
        });
        assert!(long.count() <= 2, "{parts:?}");
    }

    #[test]
    fn a_convex_outline_is_its_own_part_and_one_that_goes_round_twice_is_not() {
        let ring = |turns: f64, n: usize| -> Vec<_> {
            let angle = |k: usize| 2.0 * PI * turns * k as f64 / n as f64;
            let point = |k| Vector2::new(libm::cos(angle(k)), libm::sin(angle(k)));
            (0..n).map(point).collect()
        };
        let many = 5_000;
        let whole = (0..many).collect::<Vec<_>>();
        assert_eq!(convex_parts(&ring(1.0, many)), Some(vec![whole]));
        assert!(is_convex(&points(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [0.0, 1.0]
        ])));
        assert!(!is_convex(&ring(2.0, 5)), "a star");
        assert!(
            !is_convex(&points(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]])),
            "a line"
        );
    }
}
