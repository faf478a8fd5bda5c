//! Contact over a cell of configurations: proves that the tiles overlap throughout the cell, or
//! returns conditions that every free configuration of the cell satisfies.
//!
//! A point of one tile that stays, throughout the cell, inside the other tile by more than the
//! tolerance proves the cell *blocked*. So do convex parts of both tiles that overlap throughout,
//! such as corners that cross each other with no vertex inside. If the reachable disc of a vertex
//! meets the other outline in only one edge (or in the two edges of a notch), the vertex must be on
//! the outer side of the edge's line wherever the tiles are free: a *cut*. Cuts are only necessary
//! conditions of freedom, so a bound over the admissible part of a cell holds for all its free
//! configurations.
//!
//! All claims hold for configurations in which no point or convex part of a tile is deeper than
//! `relaxed` inside the other tile, which includes every configuration that counts as free.

mod possible;
mod side;

use nalgebra::Vector2;

use super::Contact;
use super::tree::{Below, Branch};
use crate::cell::{Cell, Quadratic};
use crate::configuration::Configuration;
use crate::tile::Outline;
pub use possible::PossibleContact;
use side::{Side, Verdict};

/// A necessary condition of freedom over a cell: `form(d) + slack >= 0` at every free
/// configuration of the cell, d its offset from the centre. `form` approximates the signed
/// distance (m) of a vertex from the line of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The signed distance (m), to second order.
    pub form: Quadratic,
    /// Upper bound of how much (m) `form` is too low anywhere in the cell, at least 0.
    pub slack: f64,
}

impl Cut {
    /// The weaker one of a pair, judged at the cell's centre.
    fn easier([a, b]: &[Self; 2]) -> &Self {
        if a.form.value > b.form.value { a } else { b }
    }
}

/// The conditions of a cell that is not proved blocked: the free configurations satisfy all of the
/// cuts, and at least one of each pair at a corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cuts {
    /// Conditions that all hold.
    pub all: Vec<Cut>,
    /// Pairs of conditions of which at least one holds.
    pub corners: Vec<[Cut; 2]>,
    /// Depth (m) of a probed point inside the other tile at the centre, if no cut covers it; 0 if
    /// there is none.
    pub depth: f64,
}

impl Cuts {
    /// The conditions that all hold, and the weaker one of each pair.
    pub fn easiest(&self) -> impl Iterator<Item = &Cut> {
        self.all.iter().chain(self.corners.iter().map(Cut::easier))
    }

    /// Whether there are no conditions.
    pub fn is_none(&self) -> bool {
        self.all.is_empty() && self.corners.is_empty() && self.depth == 0.0
    }

    /// Whether one of the conditions holds nowhere in the cell.
    fn is_violated(&self, cell: &Cell) -> bool {
        let violated = |cut: &Cut| cut.form.greatest(&cell.half) + cut.slack < 0.0;
        self.all.iter().any(violated) || self.corners.iter().any(|pair| pair.iter().all(violated))
    }
}

/// Only one of the points within a circle of this radius, as a fraction of their travel within the
/// cell, is tested: the others would add little.
const DENSE: f64 = 0.5;

/// Contact of two outlines over cells.
#[derive(Clone)]
pub struct ContactCells {
    contact: Contact,
    fixed: Side,
    moving: Side,
}

impl ContactCells {
    /// For the outlines of the two tiles.
    pub fn new(contact: &Contact) -> Self {
        Self {
            contact: contact.clone(),
            fixed: Side::new(contact.fixed()),
            moving: Side::new(contact.moving()),
        }
    }

    /// Depth (m) up to which an overlap is not used as a proof: touching, and rounding (coordinates
    /// of metres carry errors of 1e-15 m).
    pub fn relaxed(&self) -> f64 {
        2.0 * self.contact.touch()
    }

    /// The number of edges of both outlines.
    pub fn edges(&self) -> usize {
        let of = |side: &Side| side.outline.vertices().len();
        of(&self.fixed) + of(&self.moving)
    }

    /// The conditions of a cell; `None` if no configuration of it is free.
    pub fn classify(&self, cell: &Cell) -> Option<Cuts> {
        let q = &cell.centre;
        let relaxed = self.relaxed();
        let (fixed, moving) = (&self.fixed.outline, &self.moving.outline);
        let apart = q.position().norm() - fixed.circumradius() - moving.circumradius();
        if apart > cell.travel() + relaxed {
            return Some(Cuts::default());
        }
        // A support of a part changes by no more than its points move, and so does the overlap's
        // depth.
        let farthest = cell.reach(moving.circumradius());
        if self.contact.is_clear_by(q, farthest + relaxed) {
            return Some(Cuts::default());
        }
        if !self.contact.overlaps_at_most(q, farthest + relaxed) {
            return None;
        }
        let turn = q.rotation();
        let position = q.position();
        let mut cuts = Cuts::default();
        let moving_reach =
            |p: Vector2<f64>, radius: f64| cell.reach(p.norm() + radius) + radius + relaxed;
        let moving_in_fixed = Sweeping {
            probes: &self.moving,
            other: &self.fixed,
            place: &|p| position + turn * p,
            reach: &moving_reach,
            cut: &|v, edge| fixed_edge_cut((fixed, edge), turn * v, q, (cell, relaxed)),
        };
        let fixed_reach = |p: Vector2<f64>, radius: f64| {
            let lever = (p - position).norm() + radius + cell.travel();
            cell.reach(lever) + radius + relaxed
        };
        let fixed_in_moving = Sweeping {
            probes: &self.fixed,
            other: &self.moving,
            place: &|p| turn.inverse() * (p - position),
            reach: &fixed_reach,
            cut: &|w, edge| moving_edge_cut((moving, edge), w - position, q, (cell, relaxed)),
        };
        let is_open = moving_in_fixed.look(&mut cuts) && fixed_in_moving.look(&mut cuts);
        (is_open && !cuts.is_violated(cell)).then_some(cuts)
    }
}

/// Tests the points of one tile against the other.
struct Sweeping<'a> {
    probes: &'a Side,
    other: &'a Side,
    /// The position of a point at the cell's centre, in the frame of the other tile.
    place: &'a dyn Fn(Vector2<f64>) -> Vector2<f64>,
    /// Largest distance (m) of any point of a circle from the circle's placed centre.
    reach: &'a dyn Fn(Vector2<f64>, f64) -> f64,
    cut: &'a dyn Fn(Vector2<f64>, usize) -> Cut,
}

impl Sweeping<'_> {
    /// Collects the conditions; false if the cell is blocked.
    fn look(&self, cuts: &mut Cuts) -> bool {
        let blocks = |p: &Vector2<f64>| {
            self.other
                .holds_disc((self.place)(*p), (self.reach)(*p, 0.0))
        };
        !self.probes.inner.iter().any(blocks)
            && self.look_below(&self.probes.probe_tree.root(), cuts)
    }

    fn look_below(&self, branch: &Branch, cuts: &mut Cuts) -> bool {
        let at = (self.place)(branch.centre);
        let reach = (self.reach)(branch.centre, branch.radius);
        if at.norm() > self.other.outline.circumradius() + reach {
            return true;
        }
        if self.other.boundary_is_beyond(at, reach) {
            return !self.other.outline.contains(at);
        }
        let tree = &self.probes.probe_tree;
        if branch.radius < DENSE * (self.reach)(branch.centre, 0.0) {
            return self.look_at(tree.first(branch), cuts);
        }
        match tree.below(branch) {
            Below::Branches(branches) => {
                branches.iter().all(|branch| self.look_below(branch, cuts))
            }
            Below::Pieces(pieces) => pieces.iter().all(|&k| self.look_at(k, cuts)),
        }
    }

    fn look_at(&self, k: usize, cuts: &mut Cuts) -> bool {
        let p = self.probes.probes[k];
        let reach = (self.reach)(p, 0.0);
        match self
            .other
            .verdict((self.place)(p), reach, k.is_multiple_of(2))
        {
            Verdict::Blocked => return false,
            Verdict::Inside(depth) => cuts.depth = cuts.depth.max(depth),
            Verdict::Edges([i, j]) => {
                cuts.all.push((self.cut)(p, i));
                if i != j {
                    cuts.all.push((self.cut)(p, j));
                }
            }
            Verdict::Corner(edges) => cuts.corners.push(edges.map(|edge| (self.cut)(p, edge))),
            Verdict::Nothing => {}
        }
        true
    }
}

/// The cut of a vertex of the moving tile, `arm` from its reference point, against an edge of the
/// fixed one: `n . (p + R v - e) >= 0` with the edge's normal n and start e.
fn fixed_edge_cut(
    (fixed, edge): (&Outline, usize),
    arm: Vector2<f64>,
    q: &Configuration,
    (cell, relaxed): (&Cell, f64),
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
        slack: arm.norm() * w * w * w / 6.0 + relaxed,
    }
}

/// The cut of a vertex of the fixed tile, `from` the moving tile's reference point, against an
/// edge of the moving tile: `R n . (w - p) - n . e >= 0`.
///
/// Along a straight motion with the steps s and t of position and angle, the third derivative of
/// `R n . (w - p)` is at most `|w - p| t^3 + 3 s t^2`.
fn moving_edge_cut(
    (moving, edge): (&Outline, usize),
    from: Vector2<f64>,
    q: &Configuration,
    (cell, relaxed): (&Cell, f64),
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
        slack: ((from.norm() + s) * t * t * t + 3.0 * s * t * t) / 6.0 + relaxed,
    }
}
