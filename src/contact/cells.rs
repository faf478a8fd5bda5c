//! Contact over a cell of configurations: proved overlapping throughout, or left with conditions
//! that every free configuration of the cell satisfies.
//!
//! A point of one tile that stays, throughout the cell, inside the other tile by more than the
//! tolerance proves the cell *blocked*. A vertex whose reachable disc meets the other outline in
//! one edge only (or in the two edges of a notch) must, where the tiles are free, lie on the outer
//! side of the edge's line: a *cut*. Only necessary conditions of freedom are used, so a bound
//! over the cuts' side of a cell holds for all its free configurations.
//!
//! All claims hold for configurations in which no point of a tile lies deeper than [`RELAXED`]
//! inside the other, which includes every configuration that counts as free.

use nalgebra::Vector2;

use super::{Contact, TOUCH};
use crate::cell::{Cell, Quadratic};
use crate::configuration::Configuration;
use crate::tile::Outline;
use crate::tile::outline::distance_to_segment;

/// Depth (m) up to which an overlap is not used as a proof: touching, and rounding (coordinates
/// of metres carry errors of 1e-15 m).
pub const RELAXED: f64 = 2.0 * TOUCH;

/// A necessary condition of freedom over a cell: `form(d) + slack >= 0` at every free
/// configuration of the cell, d its offset from the centre. `form` approximates the signed
/// distance (m) of a vertex from the line of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    pub form: Quadratic,
    pub slack: f64,
}

/// What contact says about a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum CellContact {
    /// No configuration of the cell is free.
    Blocked,
    /// The free configurations satisfy every one of `cuts` and at least one cut of each pair in
    /// `corners`.
    Open {
        cuts: Vec<Cut>,
        corners: Vec<[Cut; 2]>,
        /// How deep (m) a probed point lies inside the other tile at the centre, where no cut
        /// tells; 0 if none does.
        depth: f64,
    },
}

impl CellContact {
    /// A cell that contact says nothing of.
    pub fn open() -> Self {
        Self::Open {
            cuts: Vec::new(),
            corners: Vec::new(),
            depth: 0.0,
        }
    }
}

/// Points of an outline that are tried as witnesses of overlap, with the outline's vertices.
#[derive(Clone, Debug)]
struct Probes {
    /// Vertices, in the outline's order, then inner points and middles of edges.
    points: Vec<Vector2<f64>>,
    vertices: usize,
}

impl Probes {
    fn new(outline: &Outline) -> Self {
        let mut points = outline.vertices().to_vec();
        let vertices = points.len();
        points.push(outline.centroid());
        points.extend((0..vertices).map(|i| {
            let (a, b) = outline.edge(i);
            (a + b) / 2.0
        }));
        for part in outline.parts() {
            points.push(part.points.iter().sum::<Vector2<f64>>() / part.points.len() as f64);
        }
        Self { points, vertices }
    }
}

/// Contact of two outlines, cell by cell.
#[derive(Clone, Debug)]
pub struct ContactCells {
    fixed: Outline,
    moving: Outline,
    fixed_probes: Probes,
    moving_probes: Probes,
}

/// What one point of one tile says about a cell.
enum Verdict {
    Nothing,
    Blocked,
    Inside(f64),
    Edges(Vec<usize>),
    Corner([usize; 2]),
}

impl ContactCells {
    pub fn new(contact: &Contact) -> Self {
        Self {
            fixed: contact.fixed().clone(),
            moving: contact.moving().clone(),
            fixed_probes: Probes::new(contact.fixed()),
            moving_probes: Probes::new(contact.moving()),
        }
    }

    /// What contact says about a cell.
    pub fn classify(&self, cell: &Cell) -> CellContact {
        let mut cuts = Vec::new();
        let mut corners = Vec::new();
        let mut depth: f64 = 0.0;
        let q = &cell.centre;
        let apart = q.x.hypot(q.y) - self.fixed.circumradius() - self.moving.circumradius();
        if apart > cell.travel() + RELAXED {
            return CellContact::open();
        }
        let turn = q.rotation();
        for (i, v) in self.moving_probes.points.iter().enumerate() {
            let at = q.position() + turn * v;
            let reach = cell.reach(v.norm()) + RELAXED;
            let cut = |edge| fixed_edge_cut(&self.fixed, edge, turn * v, q, cell);
            match probe(&self.fixed, at, reach, i < self.moving_probes.vertices) {
                Verdict::Blocked => return CellContact::Blocked,
                Verdict::Inside(d) => depth = depth.max(d),
                Verdict::Edges(edges) => cuts.extend(edges.into_iter().map(cut)),
                Verdict::Corner(edges) => corners.push(edges.map(cut)),
                Verdict::Nothing => {}
            }
        }
        for (i, w) in self.fixed_probes.points.iter().enumerate() {
            let from = w - q.position();
            let at = turn.inverse() * from;
            let reach = cell.travel() + (from.norm() + cell.travel()) * cell.half[2] + RELAXED;
            let cut = |edge| moving_edge_cut(&self.moving, edge, from, q, cell);
            match probe(&self.moving, at, reach, i < self.fixed_probes.vertices) {
                Verdict::Blocked => return CellContact::Blocked,
                Verdict::Inside(d) => depth = depth.max(d),
                Verdict::Edges(edges) => cuts.extend(edges.into_iter().map(cut)),
                Verdict::Corner(edges) => corners.push(edges.map(cut)),
                Verdict::Nothing => {}
            }
        }
        let violated = |cut: &Cut| cut.form.greatest(&cell.half) + cut.slack < 0.0;
        if cuts.iter().any(violated) || corners.iter().any(|pair| pair.iter().all(violated)) {
            return CellContact::Blocked;
        }
        CellContact::Open {
            cuts,
            corners,
            depth,
        }
    }
}

/// What a point at `at` that gets no farther than `reach` (m) says, `at` in the outline's frame.
fn probe(outline: &Outline, at: Vector2<f64>, reach: f64, vertex: bool) -> Verdict {
    if at.norm() > outline.circumradius() + reach {
        return Verdict::Nothing;
    }
    let n = outline.vertices().len();
    let near: Vec<usize> = (0..n)
        .filter(|&i| {
            let (a, b) = outline.edge(i);
            distance_to_segment(at, a, b) <= reach
        })
        .collect();
    let inside = || outline.contains(at);
    match near[..] {
        [] if inside() => Verdict::Blocked,
        [] => Verdict::Nothing,
        [edge] if vertex => Verdict::Edges(vec![edge]),
        [i, j] if vertex && (i + 1 == j || (i == 0 && j + 1 == n)) => {
            let corner = if i + 1 == j { j } else { 0 };
            if outline.convex_vertices()[corner] {
                Verdict::Corner([i, j])
            } else {
                Verdict::Edges(vec![i, j])
            }
        }
        _ if inside() => Verdict::Inside(-outline.signed_distance(at)),
        _ => Verdict::Nothing,
    }
}

/// The cut of a vertex of the moving tile, `arm` from its reference point, against an edge of the
/// fixed one: `n . (p + R v - e) >= 0` with the edge's normal n and start e.
fn fixed_edge_cut(
    fixed: &Outline,
    edge: usize,
    arm: Vector2<f64>,
    q: &Configuration,
    cell: &Cell,
) -> Cut {
    let n = fixed.normals()[edge];
    let start = fixed.vertices()[edge];
    let turning = Vector2::new(-arm.y, arm.x);
    let w = cell.half[2];
    Cut {
        form: Quadratic {
            value: n.dot(&(q.position() + arm - start)),
            gradient: [n.x, n.y, n.dot(&turning)],
            hessian: [0.0, 0.0, -n.dot(&arm), 0.0, 0.0, 0.0],
        },
        slack: arm.norm() * w * w * w / 6.0 + RELAXED,
    }
}

/// The cut of a vertex of the fixed tile, `from` the moving tile's reference point, against an
/// edge of the moving tile: `R n . (w - p) - n . e >= 0`.
///
/// Along a straight motion with the steps s and t of position and angle, the third derivative of
/// `R n . (w - p)` is at most `|w - p| t^3 + 3 s t^2`.
fn moving_edge_cut(
    moving: &Outline,
    edge: usize,
    from: Vector2<f64>,
    q: &Configuration,
    cell: &Cell,
) -> Cut {
    let local = moving.normals()[edge];
    let start = moving.vertices()[edge];
    let n = q.rotation() * local;
    let turned = Vector2::new(-n.y, n.x);
    let (s, t) = (cell.travel(), cell.half[2]);
    Cut {
        form: Quadratic {
            value: n.dot(&from) - local.dot(&start),
            gradient: [-n.x, -n.y, turned.dot(&from)],
            hessian: [0.0, 0.0, -n.dot(&from), 0.0, -turned.x, -turned.y],
        },
        slack: ((from.norm() + s) * t * t * t + 3.0 * s * t * t) / 6.0 + RELAXED,
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{saw, square};
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn value(form: &Quadratic, d: [f64; 3]) -> f64 {
        let [xx, yy, tt, xy, xt, yt] = form.hessian;
        form.value
            + (0..3).map(|i| form.gradient[i] * d[i]).sum::<f64>()
            + 0.5 * (xx * d[0] * d[0] + yy * d[1] * d[1] + tt * d[2] * d[2])
            + xy * d[0] * d[1]
            + xt * d[0] * d[2]
            + yt * d[1] * d[2]
    }

    #[test]
    fn no_free_configuration_is_blocked_or_cut_off() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for (a, b) in [
            (square(0.43), square(0.43)),
            (saw(false), saw(true)),
            (saw(true), saw(false)),
        ] {
            let contact = Contact::new(&a, &b);
            let cells = ContactCells::new(&contact);
            let (mut blocked, mut cut, mut cut_off, mut cornered) = (0, 0, 0, 0);
            for _ in 0..2000 {
                let size = 10f64.powf(rng.random_range(-3.5..-0.7));
                let cell = Cell {
                    centre: Configuration::new(
                        rng.random_range(-0.6..0.6),
                        rng.random_range(-0.6..0.6),
                        rng.random_range(-3.1..3.1),
                    ),
                    half: std::array::from_fn(|_| size * rng.random_range(0.05..1.0)),
                };
                let verdict = cells.classify(&cell);
                for _ in 0..20 {
                    let d: [f64; 3] =
                        std::array::from_fn(|i| cell.half[i] * rng.random_range(-1.0..=1.0));
                    let free = contact.is_free(&cell.centre.moved(d.into()));
                    match &verdict {
                        CellContact::Blocked => {
                            blocked += 1;
                            assert!(!free, "{cell:?} {d:?}");
                        }
                        CellContact::Open { cuts, corners, .. } => {
                            let holds = |c: &Cut| value(&c.form, d) + c.slack >= 0.0;
                            let allowed = cuts.iter().all(holds)
                                && corners.iter().all(|pair| pair.iter().any(holds));
                            assert!(allowed || !free, "{cell:?} {d:?}");
                            cut += usize::from(!cuts.is_empty());
                            cornered += usize::from(!corners.is_empty());
                            cut_off += usize::from(!allowed);
                        }
                    }
                }
            }
            assert!(
                blocked > 3000 && cut > 200 && cut_off > 100 && cornered > 5,
                "{blocked} {cut} {cut_off} {cornered}"
            );
        }
    }
}
