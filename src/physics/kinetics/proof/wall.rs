//! Enclosures, over boxes of directions and angles, of the distance at which contact ends along
//! rays from the centre, and of its slopes.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;

use super::expansion::Expansion;
use crate::contact::Contact;
use crate::tile::Outline;

/// Arms that differ by less than this share of the longest within a box count as one: the slivers
/// between them are at most about 1e-11 rad wide, far below the stated margin.
const TIE: f64 = 4e-12;
/// Edges times vertices at most.
const MOST: usize = 4096;
/// Rays whose angle to an edge's normal has a smaller cosine count as parallel to the edge.
const ALONG: f64 = 0.05;

/// The centre-to-centre distance g(phi, theta) of two convex tiles in contact: where the ray at phi
/// leaves the set of positions at which they overlap, the Minkowski sum of one tile and the
/// reflected other. Each of its edges is an edge of one tile, offset by the vertex of the other
/// that extends farthest beyond it. There `g = (height + max arm cos(theta + shift)) / cos(u)` with
/// u the ray's angle to the edge's normal (de Berg et al., *Computational Geometry*, section 13.3).
pub(super) enum Wall {
    /// The same everywhere (m).
    Circle(f64),
    Edges(Vec<Edge>),
}

/// An edge of one tile against the vertices of the other.
pub(super) struct Edge {
    /// Distance of its line from the own centre (m).
    height: f64,
    /// The other tile's vertices: distance from the centre (m), shift (rad).
    arms: Vec<[f64; 2]>,
    /// Direction of the normal out of the overlapping positions, at theta = 0 (rad).
    normal: f64,
    /// Whether it turns with theta.
    turns: bool,
    /// Its ends as seen from its tile's centre (m, rad), the one with the smaller angle of the ray
    /// first.
    ends: [[f64; 2]; 2],
}

/// g, and its slopes by phi and theta (m/rad).
#[derive(Clone, Copy)]
pub(super) struct Surface {
    pub at: Expansion,
    pub slopes: [Expansion; 2],
}

/// An edge over a box.
struct Over<'a> {
    edge: &'a Edge,
    surface: Surface,
    /// g at least, by the ranges of what it is made of (m).
    least: f64,
    /// The farthest arm at the box's middle, and whether it is the farthest over the whole box.
    arm: [f64; 2],
    alone: bool,
}

fn polar(v: &Vector2<f64>) -> [f64; 2] {
    [v.norm(), libm::atan2(v.y, v.x)]
}

/// The greatest cosine of the angles between two.
fn greatest_cos([from, to]: [f64; 2]) -> f64 {
    let turn = (from / TAU).ceil() * TAU;
    if turn <= to {
        1.0
    } else {
        libm::cos(from).max(libm::cos(to))
    }
}

impl Wall {
    /// The wall of two tiles; a circle (m) without contact. `None` if the outlines are not convex
    /// around their centres or have too many corners.
    pub fn new(contact: Option<&Contact>, circle: f64) -> Option<Self> {
        let Some(contact) = contact else {
            return Some(Self::Circle(circle));
        };
        let (fixed, moving) = (contact.fixed(), contact.moving());
        let is_round = |it: &Outline| it.parts().len() == 1 && it.contains(Vector2::zeros());
        let many = fixed.vertices().len() * moving.vertices().len();
        if !is_round(fixed) || !is_round(moving) || many > MOST {
            return None;
        }
        let of = |own: &Outline, other: &Outline, turns: bool| -> Vec<Edge> {
            let edge = |i: usize| {
                let n = own.normals()[i];
                let (start, end) = own.edge(i);
                let outwards = polar(&n)[1];
                let arm = |v: &Vector2<f64>| {
                    let [length, angle] = polar(v);
                    let shift = match turns {
                        true => outwards + PI - angle,
                        false => angle - outwards + PI,
                    };
                    [length, shift]
                };
                // In the fixed tile's frame the moving tile's edges are rotated by half a turn.
                let about = if turns { PI } else { 0.0 };
                Edge {
                    height: n.dot(&start).max(n.dot(&end)),
                    arms: other.vertices().iter().map(arm).collect(),
                    normal: outwards + about,
                    turns,
                    ends: [start, end].map(|v| polar(&v)),
                }
            };
            (0..own.vertices().len()).map(edge).collect()
        };
        let mut edges = of(fixed, moving, false);
        edges.extend(of(moving, fixed, true));
        Some(Self::Edges(edges))
    }

    /// g over a box of rays; `None` if the box is too large to tell.
    pub fn over(&self, phi: Expansion, theta: Expansion) -> Option<Surface> {
        let edges = match self {
            Self::Circle(radius) => {
                return Some(Surface {
                    at: Expansion::constant(*radius),
                    slopes: [Expansion::default(); 2],
                });
            }
            Self::Edges(edges) => edges,
        };
        let mut all: Vec<Over> = Vec::new();
        // The lower bound from edges that may be parallel to rays.
        let mut steep = f64::INFINITY;
        for edge in edges {
            match edge.over(phi, theta) {
                Ok(Some(over)) => all.push(over),
                Ok(None) => {}
                Err(least) => steep = steep.min(least),
            }
        }
        let by_value = |a: &&Over, b: &&Over| a.surface.at.value.total_cmp(&b.surface.at.value);
        let nearest = all.iter().min_by(by_value)?;
        let mut found = nearest.surface;
        if nearest.alone && nearest.edge.holds(nearest.arm, phi, theta) {
            return Some(found);
        }
        if steep < found.at.range()[1] {
            return None;
        }
        let mut lower: f64 = 0.0;
        let mut off: [f64; 2] = [0.0; 2];
        for other in all.iter().filter(|it| !std::ptr::eq(*it, nearest)) {
            let beyond = (found.at - other.surface.at).range()[1];
            let beyond = beyond.min(found.at.range()[1] - other.least);
            if beyond > 0.0 {
                lower = lower.max(beyond);
                for (off, i) in off.iter_mut().zip(0..2) {
                    let [low, high] = (found.slopes[i] - other.surface.slopes[i]).range();
                    *off = off.max(-low).max(high);
                }
            }
        }
        found.at = found.at.widened(lower);
        for (slope, off) in found.slopes.iter_mut().zip(off) {
            *slope = slope.widened(off);
        }
        Some(found)
    }
}

impl Edge {
    /// g for this edge alone: `Ok(None)` if no ray of the box crosses its line, and only a lower
    /// bound if some may be parallel to it.
    fn over(&self, phi: Expansion, theta: Expansion) -> Result<Option<Over<'_>>, f64> {
        let turned = if self.turns { phi - theta } else { phi };
        let angle = turned - Expansion::constant(self.normal);
        let (cos, sin) = (angle.cos(), angle.sin());
        let [least, most] = cos.range();
        if most <= 0.0 {
            return Ok(None);
        }
        let reach = |[length, shift]: &[f64; 2]| length * libm::cos(theta.value + shift);
        let by_reach = |a: &&[f64; 2], b: &&[f64; 2]| reach(a).total_cmp(&reach(b));
        let farthest = *self.arms.iter().max_by(by_reach).ok_or(0.0)?;
        let part = |[length, shift]: [f64; 2]| {
            let at = theta + Expansion::constant(shift);
            (at.cos().times(length), at.sin().times(-length))
        };
        let (mut arm, mut turning) = part(farthest);
        let mut alone = true;
        let [from, to] = theta.range();
        for other in &self.arms {
            // A cosine again, of the two ends' difference.
            let (x, y) = (
                other[0] * libm::cos(other[1]) - farthest[0] * libm::cos(farthest[1]),
                other[0] * libm::sin(other[1]) - farthest[0] * libm::sin(farthest[1]),
            );
            let shift = libm::atan2(y, x);
            let beyond = libm::hypot(x, y) * greatest_cos([from + shift, to + shift]);
            if beyond > TIE * farthest[0] {
                alone = false;
                arm = arm.widened(beyond);
                let at = theta + Expansion::constant(shift);
                let [low, high] = at.sin().times(libm::hypot(x, y)).range();
                turning = turning.widened(high.max(-low));
            }
        }
        let height = Expansion::constant(self.height) + arm;
        let Some(over) = cos.inverse().filter(|_| least > ALONG) else {
            return Err(height.range()[0] / most);
        };
        let at = height * over;
        // By u, of which phi is a part and theta, if the edge turns, a part of the other sign.
        let by_angle = at * sin * over;
        let by_theta = turning * over;
        let by_theta = if self.turns {
            by_theta - by_angle
        } else {
            by_theta
        };
        Ok(Some(Over {
            edge: self,
            least: height.range()[0] / most,
            surface: Surface {
                at,
                slopes: [by_angle, by_theta],
            },
            arm: farthest,
            alone,
        }))
    }

    /// Whether all rays of a box leave through this edge, offset by this arm.
    fn holds(&self, [length, shift]: [f64; 2], phi: Expansion, theta: Expansion) -> bool {
        // Angles of the ray and of the arm from the normal, on which the edge's ends lie fixed.
        let turned = if self.turns { phi - theta } else { phi };
        let angle = turned - Expansion::constant(self.normal);
        let arm = theta + Expansion::constant(shift);
        let arm = if self.turns { arm.times(-1.0) } else { arm };
        let own = if self.turns {
            self.normal - PI
        } else {
            self.normal
        };
        // Each end e + a of the moved edge, a the arm: the ray's direction crossed with it.
        let beside = |[far, at]: [f64; 2]| {
            let to_end = (angle - Expansion::constant(at - own)).sin().times(far);
            let to_arm = (angle - arm).sin().times(length);
            (to_end + to_arm).range()
        };
        let [first, second] = self.ends.map(beside);
        first[0] >= 0.0 && second[1] <= 0.0
    }
}
