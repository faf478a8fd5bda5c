//! The contacts that are possible within a cell of configurations, and bounds of how fast motions
//! open them.
//!
//! When two free tiles begin to overlap, a convex vertex of one of them passes through an edge of
//! the other: first contact is a convex vertex on an edge or on a vertex, and two corners that meet
//! are separated by the line of one of their edges. So a motion that closes none of the gaps
//! between vertices and edges that may touch leads only from free configurations to free ones.

use nalgebra::{Vector2, Vector3};

use super::side::Side;
use super::{Cell, ContactCells};

/// Allowance for rounding errors, relative to the distances and, for the paper's tile, to a metre.
const ROUNDING: f64 = 1e-12;

/// A convex vertex of one tile and an edge of the other that may touch somewhere in a cell. The
/// gap (m) is the vertex' distance from the edge's line, negative behind it.
#[derive(Clone, Copy, Debug)]
pub struct PossibleContact {
    /// At the cell's centre (m).
    pub gap: f64,
    /// Gradient of the gap at the centre, by x and y (1) and by theta (m/rad).
    pub gradient: Vector3<f64>,
    /// The edge's outward normal at the centre.
    normal: Vector2<f64>,
    /// The vertex as seen from the moving tile's reference point, at the centre (m).
    arm: Vector2<f64>,
    /// Whether the edge is the moving tile's.
    edge_moves: bool,
    /// A length (m) that places of the tiles are of.
    unit: f64,
}

impl PossibleContact {
    fn new(normal: Vector2<f64>, arm: Vector2<f64>, gap: f64, edge_moves: bool, unit: f64) -> Self {
        let along = Vector3::new(normal.x, normal.y, cross(arm, normal));
        Self {
            gap,
            gradient: if edge_moves { -along } else { along },
            normal,
            arm,
            edge_moves,
            unit,
        }
    }

    /// Largest difference (m) of the gap from that at the centre, over the box with these half
    /// sizes.
    fn spread(&self, half: &[f64; 3]) -> f64 {
        let (sin, versine) = turn(half[2]);
        let turning =
            cross(self.arm, self.normal).abs() * sin + self.normal.dot(&self.arm).abs() * versine;
        let n = self.normal;
        let shift = if self.edge_moves {
            (n.x.abs() + sin * n.y.abs()) * half[0] + (n.y.abs() + sin * n.x.abs()) * half[1]
        } else {
            n.x.abs() * half[0] + n.y.abs() * half[1]
        };
        shift + turning + ROUNDING * (self.unit + self.arm.norm())
    }

    /// The least gap (m) over the box with these half sizes about the centre.
    pub fn least(&self, half: &[f64; 3]) -> f64 {
        self.gap - self.spread(half)
    }

    /// Least opening (m) of the gap by the motion `step`, with the lowest rate over the box with
    /// these half sizes around the centre.
    pub fn opening(&self, half: &[f64; 3], step: &Vector3<f64>) -> f64 {
        let (sin, versine) = turn(half[2]);
        let (way, turned) = (step.xy(), step.z.abs());
        let (n, arm) = (self.normal, self.arm);
        let lever = cross(arm, n).abs() * versine + n.dot(&arm).abs() * sin;
        let lost = if self.edge_moves {
            let across = cross(n, way).abs() * sin + n.dot(&way).abs() * versine;
            across + turned * (lever + libm::hypot(half[0], half[1]))
        } else {
            turned * lever
        };
        let size = way.norm() + turned * (self.unit + arm.norm());
        self.gradient.dot(step) - lost - ROUNDING * size
    }
}

/// Largest sine of angles up to `angle`, and of 1 minus the cosine.
fn turn(angle: f64) -> (f64, f64) {
    let sin = if angle < std::f64::consts::FRAC_PI_2 {
        libm::sin(angle)
    } else {
        1.0
    };
    let half = libm::sin((angle / 2.0).min(std::f64::consts::FRAC_PI_2));
    (sin, 2.0 * half * half)
}

fn cross(a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

impl ContactCells {
    /// The contacts that free configurations of a cell may make: every convex vertex and every edge
    /// of the other tile that may touch without overlap somewhere in it. `None` if there are more
    /// than `most` of them.
    pub fn possible(&self, cell: &Cell, most: usize) -> Option<Vec<PossibleContact>> {
        let q = &cell.centre;
        let mut found = Vec::new();
        let apart = q.position().norm()
            - self.fixed.outline.circumradius()
            - self.moving.outline.circumradius();
        if apart > cell.travel() {
            return Some(found);
        }
        let (turn, position) = (q.rotation(), q.position());
        let unit = self.contact.scaled(1.0);
        let on_fixed = VerticesOnEdges {
            vertices: &self.moving,
            edges: &self.fixed,
            place: &|p| position + turn * p,
            direction: &|d| turn * d,
            reach: &|p: Vector2<f64>| cell.reach(p.norm()),
            contact: &|vertex, normal, start| {
                let arm = turn * vertex;
                PossibleContact::new(
                    normal,
                    arm,
                    normal.dot(&(position + arm - start)),
                    false,
                    unit,
                )
            },
        };
        let back = turn.inverse();
        let on_moving = VerticesOnEdges {
            vertices: &self.fixed,
            edges: &self.moving,
            place: &|p| back * (p - position),
            direction: &|d| back * d,
            reach: &|p: Vector2<f64>| cell.reach((p - position).norm() + cell.travel()),
            contact: &|vertex, normal, start| {
                let (world, arm) = (turn * normal, vertex - position);
                PossibleContact::new(world, arm, world.dot(&arm) - normal.dot(&start), true, unit)
            },
        };
        let is_listed = on_fixed.list(&cell.half, most, &mut found)
            && on_moving.list(&cell.half, most, &mut found);
        is_listed.then_some(found)
    }
}

/// The vertices of one tile against the edges of the other, in the other's frame.
struct VerticesOnEdges<'a> {
    vertices: &'a Side,
    edges: &'a Side,
    place: &'a dyn Fn(Vector2<f64>) -> Vector2<f64>,
    direction: &'a dyn Fn(Vector2<f64>) -> Vector2<f64>,
    /// Largest distance (m) of a vertex from its position at the cell's centre.
    reach: &'a dyn Fn(Vector2<f64>) -> f64,
    /// The contact of a vertex with an edge of this normal and start.
    contact: &'a dyn Fn(Vector2<f64>, Vector2<f64>, Vector2<f64>) -> PossibleContact,
}

impl VerticesOnEdges<'_> {
    /// Adds the possible contacts; false if there are more than `most`.
    fn list(&self, half: &[f64; 3], most: usize, found: &mut Vec<PossibleContact>) -> bool {
        let outline = &self.vertices.outline;
        let corners = outline.vertices();
        let n = corners.len();
        (0..n).filter(|&i| outline.convex_vertices()[i]).all(|i| {
            let (at, reach) = ((self.place)(corners[i]), (self.reach)(corners[i]));
            if at.norm() > self.edges.outline.circumradius() + reach {
                return true;
            }
            let sides = [(i + 1) % n, (i + n - 1) % n]
                .map(|k| (self.direction)((corners[k] - corners[i]).normalize()));
            self.edges.edges.near(at, reach, &mut |edge| {
                if self.may_touch(at, reach, &sides, edge, half[2]) {
                    let normal = self.edges.outline.normals()[edge];
                    let start = self.edges.outline.vertices()[edge];
                    let contact = (self.contact)(corners[i], normal, start);
                    if contact.gap.abs() <= contact.spread(half) {
                        found.push(contact);
                    }
                }
                found.len() <= most
            })
        })
    }

    /// Whether a vertex at `at` that moves by at most `reach` (m) can be on an edge, with its tile
    /// in front of the edge's line; the tile extends from the vertex in the directions `sides` and
    /// turns by up to `turned` (rad).
    fn may_touch(
        &self,
        at: Vector2<f64>,
        reach: f64,
        sides: &[Vector2<f64>; 2],
        edge: usize,
        turned: f64,
    ) -> bool {
        let (start, end) = self.edges.outline.edge(edge);
        let normal = self.edges.outline.normals()[edge];
        let length = (end - start).norm();
        let along = (at - start).dot(&(end - start)) / length;
        let (sin, versine) = turn(turned);
        let in_front = |side: &Vector2<f64>| {
            let (height, across) = (normal.dot(side), cross(normal, *side));
            height + height.abs() * versine + across.abs() * sin >= -ROUNDING
        };
        along >= -reach && along <= length + reach && sides.iter().all(in_front)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation2;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// The gap at an offset from the centre, by its definition.
    fn gap(contact: &PossibleContact, d: Vector3<f64>) -> f64 {
        let (n, arm, turn) = (contact.normal, contact.arm, Rotation2::new(d.z));
        if contact.edge_moves {
            contact.gap + (turn * n).dot(&(arm - d.xy())) - n.dot(&arm)
        } else {
            contact.gap + n.dot(&(turn * arm + d.xy() - arm))
        }
    }

    /// The rate at which a step opens the gap there.
    fn slope(contact: &PossibleContact, d: Vector3<f64>, step: &Vector3<f64>) -> f64 {
        let turned = |v: Vector2<f64>| {
            let v = Rotation2::new(d.z) * v;
            (v, Vector2::new(-v.y, v.x) * step.z)
        };
        if contact.edge_moves {
            let (n, rate) = turned(contact.normal);
            rate.dot(&(contact.arm - d.xy())) - n.dot(&step.xy())
        } else {
            contact.normal.dot(&(turned(contact.arm).1 + step.xy()))
        }
    }

    #[test]
    fn gaps_and_their_rates_are_bounded_closely_over_boxes() {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        for k in 0..400 {
            let mut draw = |scale: f64| scale * rng.random_range(-1.0..=1.0f64);
            let direction = draw(3.1);
            let normal = Vector2::new(libm::cos(direction), libm::sin(direction));
            let arm = Vector2::new(draw(0.3), draw(0.3));
            let contact = PossibleContact::new(normal, arm, draw(0.01), k % 2 == 0, 1.0);
            let size = libm::pow(10f64, -3.0 + draw(1.5));
            let half = [size, 0.7 * size, size].map(|h: f64| h * (0.1 + draw(1.0).abs()));
            let step = Vector3::new(draw(size), draw(size), draw(size));
            let (mut least, mut slowest) = (f64::INFINITY, f64::INFINITY);
            for corner in 0..27 {
                let at = |i: usize| f64::from(corner / 3i32.pow(i as u32) % 3 - 1) * half[i];
                let d = Vector3::new(at(0), at(1), at(2));
                least = least.min(gap(&contact, d));
                slowest = slowest.min(slope(&contact, d, &step));
            }
            // Both differ from the attained values by terms of second order.
            let room = 6.0 * (half[2] * (half[0] + half[1]) + half[2] * half[2]);
            let bound = contact.least(&half);
            assert!(
                bound <= least + 1e-15 && bound > least - room,
                "{contact:?} {half:?}"
            );
            let bound = contact.opening(&half, &step);
            let room = 6.0 * step.norm() * (half[0] + half[1] + half[2]) * half[2];
            let room = room + 2.0 * step.z.abs() * half[2] * half[2] + 1e-9 * step.norm();
            assert!(
                bound <= slowest + 1e-12 * step.norm(),
                "{contact:?} {half:?}"
            );
            assert!(
                bound > slowest - room - 2.0 * step.norm() * libm::hypot(half[0], half[1]),
                "{contact:?}"
            );
            let gradient = contact.gradient.dot(&step);
            assert!(
                (slope(&contact, Vector3::zeros(), &step) - gradient).abs() < 1e-12 * step.norm()
            );
        }
    }
}
