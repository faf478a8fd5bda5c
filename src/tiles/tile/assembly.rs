//! Builds a tile's outline from its faces and their profiles.
//!
//! The profiles are strung together corner by corner. If a profile runs back along its neighbour
//! from their corner (square teeth that cut in at the very end of a square's face), the strip
//! without area is removed. Then every face is drawn back by its `fit`: each edge of the face moves
//! inwards along its normal, and neighbouring edges are lengthened or shortened until they meet
//! again (mitre joins), also across the corners to faces that stay where they are. So each
//! drawn-back edge is `fit` away from where it was, and a mate drawn back by `fit` leaves a gap of
//! exactly that width.

use nalgebra::Vector2;

use super::Face;
use super::outline::cross;
use super::profile::{Arcs, Polyline};

/// Points closer to each other than this fraction of the tile's size are one point.
const SAME_POINT: f64 = 1e-12;

/// Edges whose directions differ by no more than this (rad) have no corner to mitre.
const PARALLEL: f64 = 1e-9;

/// How the outline of one face is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceLine {
    /// The profile, as points (s, h) of the face's frame (m); empty for the base line.
    pub polyline: Polyline,
    /// Which of its points lie on arcs.
    pub arcs: Arcs,
    /// How far the line is drawn back along its normal (m).
    pub fit: f64,
}

/// A closed polygon, each edge of which belongs to a face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ring {
    /// Corners (m), counter-clockwise.
    pub points: Vec<Vector2<f64>>,
    /// The face of the edge from point i to point i + 1.
    pub faces: Vec<usize>,
    /// The index of the arc that this edge is a chord of; `None` for a straight line.
    pub arcs: Vec<Option<usize>>,
}

/// The drawn-back line of a face vanishes or reverses somewhere: the face's index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("face {0} cannot be drawn back so far")]
pub struct FitTooLarge(pub usize);

/// The closed polygon of a tile's faces, each with its line.
///
/// # Errors
/// If an edge would vanish or reverse when its face is drawn back.
pub fn assemble(faces: &[Face], lines: &[FaceLine]) -> Result<Ring, FitTooLarge> {
    let scale = faces
        .iter()
        .map(|face| face.start.norm())
        .fold(0.0, f64::max);
    let mut ring = Ring::default();
    let mut arcs_before = 0;
    for (number, (face, line)) in faces.iter().zip(lines).enumerate() {
        ring.push(face.start, number, None);
        for (point, &[s, h]) in line.polyline.iter().enumerate() {
            let begins_in = |arc: &[usize; 2]| (arc[0]..arc[1]).contains(&point);
            let arc = line.arcs.iter().position(begins_in);
            ring.push(face.point(s, h), number, arc.map(|arc| arcs_before + arc));
        }
        arcs_before += line.arcs.len();
    }
    ring.clean(scale * SAME_POINT);
    if lines.iter().all(|line| line.fit == 0.0) {
        return Ok(ring);
    }
    let mut drawn = ring.drawn_back(|face| lines[face].fit)?;
    drawn.clean(scale * SAME_POINT);
    Ok(drawn)
}

impl Ring {
    fn push(&mut self, point: Vector2<f64>, face: usize, arc: Option<usize>) {
        self.points.push(point);
        self.faces.push(face);
        self.arcs.push(arc);
    }

    fn len(&self) -> usize {
        self.points.len()
    }

    /// The edge from point i to point i + 1.
    fn edge(&self, i: usize) -> Vector2<f64> {
        self.points[(i + 1) % self.len()] - self.points[i]
    }

    /// Merges repeated points and removes strips without area between two faces.
    fn clean(&mut self, tolerance: f64) {
        let mut i = 0;
        while i < self.len() && self.len() > 2 {
            let n = self.len();
            let before = (i + n - 1) % n;
            if self.edge(i).norm() <= tolerance {
                // Keep the first point of the pair, and the edge that leaves the second.
                self.faces[i] = self.faces[(i + 1) % n];
                self.arcs[i] = self.arcs[(i + 1) % n];
                self.remove((i + 1) % n);
            } else if self.faces[before] != self.faces[i] && self.folds_back(before, i) {
                // The far part of the longer edge remains.
                if self.edge(before).norm() <= self.edge(i).norm() {
                    self.faces[before] = self.faces[i];
                    self.arcs[before] = self.arcs[i];
                }
                self.remove(i);
            } else {
                i += 1;
                continue;
            }
            i = i.saturating_sub(2);
        }
    }

    fn remove(&mut self, i: usize) {
        self.points.remove(i);
        self.faces.remove(i);
        self.arcs.remove(i);
    }

    /// Whether edge `next` runs straight back over edge `before`.
    fn folds_back(&self, before: usize, next: usize) -> bool {
        let (u, v) = (self.edge(before), self.edge(next));
        cross(u, v).abs() <= SAME_POINT * u.norm() * v.norm() && u.dot(&v) < 0.0
    }

    /// Each edge moved inwards by the distance that belongs to its face (m).
    fn drawn_back(&self, fit: impl Fn(usize) -> f64) -> Result<Self, FitTooLarge> {
        let n = self.len();
        let corners: Vec<_> = (0..n)
            .map(|i| {
                let before = (i + n - 1) % n;
                let shifts = [before, i].map(|k| (self.inward_normal(k), fit(self.faces[k])));
                mitre(shifts).map(|shift| self.points[i] + shift)
            })
            .collect();
        let mut ring = Self::default();
        for i in 0..n {
            let (start, end) = (corners[i][1], corners[(i + 1) % n][0]);
            if (end - start).dot(&self.edge(i)) <= 0.0 {
                let drawn = if fit(self.faces[i]) > 0.0 {
                    i
                } else if fit(self.faces[(i + n - 1) % n]) > 0.0 {
                    (i + n - 1) % n
                } else {
                    (i + 1) % n
                };
                return Err(FitTooLarge(self.faces[drawn]));
            }
            ring.push(start, self.faces[i], self.arcs[i]);
            ring.push(end, self.faces[i], self.arcs[i]);
        }
        Ok(ring)
    }

    fn inward_normal(&self, i: usize) -> Vector2<f64> {
        let t = self.edge(i).normalize();
        Vector2::new(-t.y, t.x)
    }
}

/// How a corner moves when its two edges move along their normals by the given distances: as the
/// end of the first edge and as the start of the second. The two differ only where edges on one
/// line move by different distances.
fn mitre([(n1, d1), (n2, d2)]: [(Vector2<f64>, f64); 2]) -> [Vector2<f64>; 2] {
    let sine = cross(n1, n2);
    if sine.abs() <= PARALLEL {
        return [n1 * d1, n2 * d2];
    }
    // The point x with n1.x = d1 and n2.x = d2.
    let x = Vector2::new(d1 * n2.y - d2 * n1.y, d2 * n1.x - d1 * n2.x) / sine;
    [x, x]
}

/// The edges of one face in a tile's outline, each from point to point (s, h) of the face's frame.
pub fn face_edges(ring: &Ring, face: &Face, number: usize) -> Vec<[[f64; 2]; 2]> {
    let local = |p: Vector2<f64>| {
        let d = p - face.middle();
        [d.dot(&face.tangent()), d.dot(&face.normal())]
    };
    (0..ring.len())
        .filter(|&i| ring.faces[i] == number)
        .map(|i| {
            [
                local(ring.points[i]),
                local(ring.points[(i + 1) % ring.len()]),
            ]
        })
        .collect()
}

/// The height (m) of a face's outermost surface at s, over its edges as [`face_edges`] gives them;
/// at a step, the height of the lower side. `None` if the face has no surface.
pub fn surface_height(edges: &[[[f64; 2]; 2]], s: f64) -> Option<f64> {
    let one_sided = |inside: &dyn Fn(f64, f64) -> bool| {
        edges
            .iter()
            .filter(|[a, b]| inside(a[0].min(b[0]), a[0].max(b[0])))
            .map(|[a, b]| a[1] + (b[1] - a[1]) * (s - a[0]) / (b[0] - a[0]))
            .fold(None, |top: Option<f64>, h| {
                Some(top.map_or(h, |top| top.max(h)))
            })
    };
    let from_left = one_sided(&|low, high| low < s && s <= high);
    let from_right = one_sided(&|low, high| low <= s && s < high);
    match (from_left, from_right) {
        (Some(left), Some(right)) => Some(left.min(right)),
        (left, right) => left.or(right),
    }
}
