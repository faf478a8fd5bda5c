//! Local contact constraints: which vertices press against which edges, and the motion closest to a
//! wanted one that does not push the tiles into each other.

use nalgebra::{Vector2, Vector3};
use ordered_float::OrderedFloat;

use super::{Contact, Placement, TOUCH};
use crate::configuration::Configuration;
use crate::scale::Scale;
use crate::tile::Outline;
use crate::tile::outline::distance_to_segment;

/// Vertices closer than this (m) count as coinciding.
const COINCIDENT: f64 = 1e-7;

/// A vertex of one tile in front of an edge of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Touch {
    /// The tile of the edge; the vertex belongs to the other one.
    pub edge_of: EdgeOf,
    /// The edge's number: it runs from the vertex of that number to the next.
    pub edge: usize,
    /// The vertex' number in the other tile's outline.
    pub vertex: usize,
}

/// Which tile an edge belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EdgeOf {
    /// The edge is the fixed tile's.
    Fixed,
    /// The edge is the moving tile's.
    Moving,
}

/// One contact: `gap` (m) must not become negative; `gradient` is its derivative with respect to
/// (x, y, theta).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// The vertex and the edge.
    pub touch: Touch,
    /// Distance (m) of the vertex from the edge's line; below 0 behind it.
    pub gap: f64,
    /// Gradient of the gap, by x and y (1) and by theta (m/rad).
    pub gradient: Vector3<f64>,
}

/// Two outlines in the frame of the second: the vertices of `a` against the edges of `b`.
struct OutlinePair<'a> {
    a: &'a Outline,
    b: &'a Outline,
    /// The placement of `a` in `b`'s frame.
    pose: Placement,
    scale: Scale,
}

impl OutlinePair<'_> {
    fn vertex(&self, i: usize) -> Vector2<f64> {
        self.pose.position + self.pose.rotation * self.a.vertices()[i]
    }

    /// Calls `found(vertex, edge)` for every convex vertex of `a` within `margin` of an edge of
    /// `b` that it faces, except where it coincides with a convex corner of `b`; those pairs
    /// (vertex, corner) go to `corners`.
    fn find(
        &self,
        margin: f64,
        mut found: impl FnMut(usize, usize),
        mut corners: impl FnMut(usize, usize),
    ) {
        let mut near = Vec::new();
        let n = self.b.vertices().len();
        // Of two polygons with many sides, most vertices are outside the other's circle. (In a notch, edges
        // face vertices that are farther away.)
        let is_convex = self.b.convex_vertices().iter().all(|convex| *convex);
        let reach = match is_convex {
            true => self.b.circumradius() + margin + self.scale.length(COINCIDENT),
            false => f64::INFINITY,
        };
        for i in 0..self.a.vertices().len() {
            if !self.a.convex_vertices()[i] {
                continue;
            }
            let p = self.vertex(i);
            if p.norm_squared() > reach * reach * (1.0 + 1e-9) {
                continue;
            }
            self.b.grid().near(p, margin, &mut near);
            for &edge in &near {
                let edge = edge as usize;
                match self.facing(i, p, edge, margin) {
                    Front::Edge => found(i, edge),
                    // Each corner is found from both of its edges; it counts once, for its own
                    // edge.
                    Front::Start => corners(i, edge),
                    Front::End if !near.contains(&(((edge + 1) % n) as u32)) => {
                        corners(i, (edge + 1) % n);
                    }
                    Front::End | Front::Nothing => {}
                }
            }
        }
    }

    fn facing(&self, i: usize, p: Vector2<f64>, edge: usize, margin: f64) -> Front {
        let b = self.b;
        let coincident = self.scale.length(COINCIDENT);
        let (start, end) = b.edge(edge);
        let normal = b.normals()[edge];
        let gap = normal.dot(&(p - start));
        if gap.abs() > margin {
            return Front::Nothing;
        }
        let n = b.vertices().len();
        if b.convex_vertices()[edge] && (p - start).norm() <= coincident {
            return Front::Start;
        }
        if b.convex_vertices()[(edge + 1) % n] && (p - end).norm() <= coincident {
            return Front::End;
        }
        let length = (end - start).norm();
        let t = (p - start).dot(&(end - start)) / length;
        // The distance to the edge's end, whether there is a convex corner, and the other edge
        // there. In a notch both edges block a vertex between them, even if it is in front of only
        // one of them.
        let next = (edge + 1) % n;
        let ends = [
            (t, b.convex_vertices()[edge], (edge + n - 1) % n),
            (length - t, b.convex_vertices()[next], next),
        ];
        let is_beyond = |&(rest, convex, other): &(f64, bool, usize)| {
            rest < -coincident && (convex || !self.is_in_front(p, other))
        };
        if ends.iter().any(is_beyond) {
            return Front::Nothing;
        }
        // In front of an edge's end the vertex can pass around the corner, unless its tile lies
        // flat against the edge.
        let at_corner = ends
            .iter()
            .any(|(rest, convex, _)| *rest < coincident && *convex);
        if at_corner && !self.wedge_is_beyond(i, normal) {
            return Front::Nothing;
        }
        // Behind the edge's line, but not inside: in front of another edge, past a corner.
        if gap < -self.scale.length(TOUCH) && !self.is_inside(i, p) {
            return Front::Nothing;
        }
        Front::Edge
    }

    /// Whether `a` is inside `b` near its vertex i, which is at `p`. On the rim of `b`, where rounding would
    /// decide about the vertex, `a` is outside if it lies beyond that edge.
    fn is_inside(&self, i: usize, p: Vector2<f64>) -> bool {
        let touch = self.scale.length(TOUCH);
        let mut near = Vec::new();
        self.b.grid().near(p, touch, &mut near);
        near.retain(|&edge| {
            let (start, end) = self.b.edge(edge as usize);
            distance_to_segment(p, start, end) <= touch
        });
        match near.is_empty() {
            true => self.b.contains(p),
            false => near
                .iter()
                .all(|&edge| !self.wedge_is_beyond(i, self.b.normals()[edge as usize])),
        }
    }

    /// Whether a point's foot on an edge's line lies on the edge.
    fn is_in_front(&self, p: Vector2<f64>, edge: usize) -> bool {
        let (start, end) = self.b.edge(edge);
        let t = (p - start).dot(&(end - start));
        (0.0..=(end - start).norm_squared()).contains(&t)
    }

    /// Whether `a` near its vertex i lies on the positive side of a line with this normal through
    /// the vertex.
    fn wedge_is_beyond(&self, i: usize, normal: Vector2<f64>) -> bool {
        let n = self.a.vertices().len();
        let rotation = self.pose.rotation;
        [(i + 1) % n, (i + n - 1) % n].iter().all(|&k| {
            let along = rotation * (self.a.vertices()[k] - self.a.vertices()[i]);
            normal.dot(&along) >= -1e-6 * along.norm()
        })
    }

    /// The edges of `b` at its corner j that could separate it from `a`'s vertex i.
    fn separating_edges(&self, i: usize, j: usize) -> impl Iterator<Item = usize> + '_ {
        let n = self.b.vertices().len();
        [(j + n - 1) % n, j]
            .into_iter()
            .filter(move |&edge| self.wedge_is_beyond(i, self.b.normals()[edge]))
    }
}

/// The part of an edge that a vertex is in front of.
enum Front {
    Nothing,
    Edge,
    /// The convex corner at the edge's start, or at its end.
    Start,
    End,
}

impl Contact {
    /// The constraint of one vertex and one edge, wherever they are.
    pub fn constraint(&self, touch: Touch, q: &Configuration) -> Constraint {
        self.constraint_at(touch, &Placement::of(q))
    }

    /// The constraints of several.
    pub fn constraints_of(&self, touches: &[Touch], q: &Configuration) -> Vec<Constraint> {
        let pose = Placement::of(q);
        let constraints = touches
            .iter()
            .map(|touch| self.constraint_at(*touch, &pose));
        constraints.collect()
    }

    fn constraint_at(&self, touch: Touch, moving: &Placement) -> Constraint {
        let at = |p: Vector2<f64>| moving.position + moving.rotation * p;
        let (fixed_outline, moving_outline) = (self.fixed(), self.moving());
        let (normal, start, vertex) = match touch.edge_of {
            EdgeOf::Fixed => (
                fixed_outline.normals()[touch.edge],
                fixed_outline.vertices()[touch.edge],
                at(moving_outline.vertices()[touch.vertex]),
            ),
            EdgeOf::Moving => (
                moving.rotation * moving_outline.normals()[touch.edge],
                at(moving_outline.vertices()[touch.edge]),
                fixed_outline.vertices()[touch.vertex],
            ),
        };
        let gap = normal.dot(&(vertex - start));
        let arm = vertex - moving.position;
        let along = Vector3::new(normal.x, normal.y, normal.y * arm.x - normal.x * arm.y);
        let gradient = match touch.edge_of {
            EdgeOf::Fixed => along,
            // The edge turns with the tile and the vertex is fixed: the opposite sign.
            EdgeOf::Moving => -along,
        };
        Constraint {
            touch,
            gap,
            gradient,
        }
    }

    /// Keeps the touches whose vertex is in front of the edge, at most `margin` (m) away.
    pub fn keep_faced(&self, touches: &mut Vec<Touch>, q: &Configuration, margin: f64) {
        let [on_fixed, on_moving] = self.meetings(&Placement::of(q));
        touches.retain(|touch| {
            let meeting = match touch.edge_of {
                EdgeOf::Fixed => &on_fixed,
                EdgeOf::Moving => &on_moving,
            };
            let at = meeting.vertex(touch.vertex);
            let facing = meeting.facing(touch.vertex, at, touch.edge, margin);
            matches!(facing, Front::Edge)
        });
    }

    /// The moving tile's vertices against the fixed one's edges, and the other way round.
    fn meetings(&self, pose: &Placement) -> [OutlinePair<'_>; 2] {
        [
            OutlinePair {
                a: self.moving(),
                b: self.fixed(),
                pose: *pose,
                scale: self.scale,
            },
            OutlinePair {
                a: self.fixed(),
                b: self.moving(),
                pose: pose.inverse(),
                scale: self.scale,
            },
        ]
    }

    /// The contacts with a gap of at most `margin` (m): a convex vertex of one tile in front of an
    /// edge of the other. Two coinciding convex corners need only one separating edge; the one that
    /// separates them most is chosen.
    pub fn constraints(&self, q: &Configuration, margin: f64) -> Vec<Constraint> {
        let mut found = Vec::new();
        let clear = margin.next_up();
        let Some(pose) = self.unless_clear_by(q, clear) else {
            return found;
        };
        let [on_fixed, on_moving] = self.meetings(&pose);
        let touch = |edge_of, edge, vertex| Touch {
            edge_of,
            edge,
            vertex,
        };
        let mut corners: Vec<(usize, usize)> = Vec::new();
        on_fixed.find(
            margin,
            |vertex, edge| {
                found.push(self.constraint_at(touch(EdgeOf::Fixed, edge, vertex), &pose))
            },
            |vertex, corner| corners.push((vertex, corner)),
        );
        on_moving.find(
            margin,
            |vertex, edge| {
                found.push(self.constraint_at(touch(EdgeOf::Moving, edge, vertex), &pose))
            },
            |_, _| {},
        );
        for (vertex, corner) in corners {
            let by_fixed = on_fixed
                .separating_edges(vertex, corner)
                .map(|edge| touch(EdgeOf::Fixed, edge, vertex));
            let by_moving = on_moving
                .separating_edges(corner, vertex)
                .map(|edge| touch(EdgeOf::Moving, edge, corner));
            let clearest = by_fixed
                .chain(by_moving)
                .map(|touch| self.constraint_at(touch, &pose))
                .max_by_key(|constraint| OrderedFloat(constraint.gap));
            found.extend(clearest);
        }
        found
    }
}
