//! The energy of two upright discs, or upright dipoles, which depends on their distance alone, with
//! proved bounds.
//!
//! `V(r)` is the energy (J) of two upright magnets of 1 A m^2 at the distance r (m); it is positive
//! and falls. For point dipoles `V = mu0 / (4 pi r^3)`. For discs it is known at nodes, with its slope,
//! and between them from cubic Hermite polynomials. Bounds of derivatives hold from a distance on, up
//! to infinity: each follows from divided differences of the slopes at nodes, which are values of a
//! derivative somewhere between the nodes, and from the bound of the next derivative, which says how
//! much it may change there. The fifth derivative, the last one, is bounded by the least of two:
//!
//! * The energy is an average of those of dipoles in both volumes, no closer than
//!   `g = r - R1 - R2`, so that (see [motion](crate::potential::motion)) its n-th derivative is at most
//!   `mu0 / (4 pi) (n + 2)! / g^(n + 3)`.
//! * It is `2 mu0 / (4 pi V1 V2) [F(z1) - F(z2)]`, F the integral of `1 / r` over two faces of areas A1
//!   and A2 whose planes are z apart. The n-th derivative of F is at most `n! A1 A2 / D^(n + 1)`, `D^2 =
//!   g^2 + z^2`. For faces in one plane it is more: averaging `1 / |r + w|` over the directions of
//!   w in the plane gives `sum_k P_2k(0)^2 w^2k / r^(2k + 1)`, so that F is a series with positive
//!   coefficients in odd powers of `1 / r` (completely monotonic): each derivative's magnitude falls
//!   with r, and divided differences over nodes to the left bound it.
//!
//! Discs closer than the first nodes, at a thousandth of a radius, have no bounds beyond their energy
//! and force.

use nalgebra::Vector2;

use super::face::{ChargedFace, Shape as Charged};
use super::near::alone;
use super::{Body, BodyPotential, HAND_OVER};
use crate::configuration::Configuration;
use crate::potential::classes::class_of;
use crate::potential::{MagnetModel, Potential};
use crate::tile::Magnet;
use crate::tile::magnet::{Form, Standing};
use crate::units::MU0_OVER_4PI;

/// The gap (m) at the first node, and of discs that count as touching, in units of the lesser radius.
const FIRST: f64 = 1e-3;
const TOUCHING: f64 = 1e-9;
/// Nodes that have no bounds yet, because these need nodes before them.
const UNBOUNDED: usize = 4;
/// The distance of neighbouring nodes over that from contact, and at most over that of the centres.
const OF_GAP: f64 = 0.02;
const OF_DISTANCE: f64 = 0.005;
/// The last node, in units of the sum of radii and heights; farther magnets are dipoles.
const LAST: f64 = 300.0;
/// The relative error of terms left out of values at nodes, and a bound of all errors there.
const LEFT_OUT: f64 = 1e-12;
const AT_NODES: f64 = 1e-11;
/// The relative error of energies that the potential computes, and the relative size of what dipoles
/// leave out beyond the last node.
const ROUNDING: f64 = 4.0 * HAND_OVER;
const BEYOND: f64 = 1e-4;

/// V(r) of two upright magnets.
#[derive(Clone, Debug)]
pub enum Radial {
    /// Of point dipoles.
    Dipoles,
    /// Of discs.
    Discs(RadialTable),
}

/// V, V' and V'' (J, J/m, J/m^2) at a distance, and how far they may be off.
#[derive(Clone, Copy, Debug)]
pub struct RadialValue {
    pub value: [f64; 3],
    pub error: [f64; 3],
}

/// From a distance on: the largest V (J), and bounds of the first three derivatives of V as a function
/// of the place in the plane, in any directions (J/m^n).
#[derive(Clone, Copy, Debug)]
pub struct RadialLimits {
    pub value: f64,
    pub derivatives: [f64; 3],
}

impl Radial {
    /// Of two magnets that stand upright, and are discs or point dipoles.
    pub fn new(model: MagnetModel, first: &Magnet, second: &Magnet) -> Self {
        match model {
            MagnetModel::Dipole => Self::Dipoles,
            MagnetModel::Cuboid => Self::Discs(RadialTable::new(first, second)),
        }
    }

    /// V at a distance (m).
    pub fn at(&self, r: f64) -> RadialValue {
        match self {
            Self::Dipoles => RadialValue {
                value: dipoles(r),
                error: dipoles(r).map(|it| ROUNDING * it.abs()),
            },
            Self::Discs(table) => table.at(r),
        }
    }

    /// What holds from a distance (m) on.
    pub fn from(&self, r: f64) -> RadialLimits {
        let of = match self {
            Self::Dipoles => of_dipoles(r),
            Self::Discs(table) => table.from(r),
        };
        let [value, first, second, third] = of;
        RadialLimits {
            value,
            derivatives: [
                first,
                second.max(first / r),
                steepest(third, 3.0 * (second + first / r) / r),
            ],
        }
    }
}

/// V, V' and V'' of dipoles (J, J/m, J/m^2).
fn dipoles(r: f64) -> [f64; 3] {
    let v = MU0_OVER_4PI / (r * r * r);
    [v, -3.0 * v / r, 12.0 * v / (r * r)]
}

/// The largest V and magnitudes of V', V'' and V''' of dipoles from a distance (m) on.
fn of_dipoles(r: f64) -> [f64; 4] {
    let [v, first, second] = dipoles(r);
    [v, -first, second, 60.0 * v / (r * r * r)]
}

/// The largest `a c^3 + b c (1 - c^2)`, c from 0 to 1: c is the cosine of the angle of a direction with
/// the way, along which the third derivative is `V''' c^3 + 3 (V'' / r - V' / r^2) c s^2`.
fn steepest(a: f64, b: f64) -> f64 {
    if b <= 1.5 * a {
        return a;
    }
    let c = (b / (3.0 * (b - a))).sqrt();
    a * c * c * c + b * c * (1.0 - c * c)
}

/// V of two discs at nodes.
#[derive(Clone, Debug)]
pub struct RadialTable {
    /// The sum of the radii (m).
    radii: f64,
    nodes: Vec<Node>,
    /// For each [class](class_of) of gaps from that of the first node on, the number of nodes before it.
    starts: Vec<u32>,
    /// Bounds of V and V' (J, J/m) of discs in contact.
    contact: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
struct Node {
    r: f64,
    value: f64,
    slope: f64,
    /// Bound of the fourth derivative up to the next node.
    fourth: f64,
    /// Bounds of the first three derivatives from here to infinity.
    beyond: [f64; 3],
}

/// What bounds the fifth derivative of V before its values are known.
struct Discs {
    radii: [f64; 2],
    areas: f64,
    /// Distances (m) of the planes of faces of like and of unlike poles.
    heights: [f64; 2],
    /// Twice `mu0 / (4 pi)` over the volumes (J/m^3 for moments of 1 A m^2).
    strength: f64,
}

impl Discs {
    fn new(first: &Body, second: &Body) -> Self {
        let [one, other] = [first, second].map(|body| body.size[2] / 2.0);
        let volumes = first.volume() * second.volume();
        let heights = [(one - other).abs(), one + other];
        Self {
            radii: [first, second].map(|body| body.size[0] / 2.0),
            areas: volumes / (first.size[2] * second.size[2]),
            heights,
            strength: 2.0 * MU0_OVER_4PI / volumes,
        }
    }

    /// The slope (m^2) of the integral over two faces in one plane.
    fn slope_in_plane(&self, r: f64) -> f64 {
        let face = |at: f64, radius: f64| {
            let place = Vector2::new(at, 0.0);
            ChargedFace::flat(place, Vector2::x(), 0.0, Charged::Disc(radius))
        };
        let [one, other] = self.radii;
        alone(&face(0.0, one), &face(r, other)).gradient.x
    }

    /// Bounds of the fifth derivative (J/m^5) from each of some distances on.
    fn fifth(&self, places: &[f64]) -> Vec<f64> {
        let gap = |r: f64| r - self.radii[0] - self.radii[1];
        let face = |r: f64, height: f64| {
            let d2 = gap(r) * gap(r) + height * height;
            120.0 * self.areas / (d2 * d2 * d2)
        };
        let in_plane = (self.heights[0] == 0.0).then(|| {
            let slopes: Vec<f64> = places.iter().map(|r| self.slope_in_plane(*r)).collect();
            let known = differences(places, &slopes, UNBOUNDED);
            let known = known.into_iter().map(|difference| 24.0 * difference);
            // Each is a bound from its last node on.
            let none = [f64::INFINITY; UNBOUNDED];
            none.into_iter().chain(known).collect::<Vec<f64>>()
        });
        let of = |(k, &r): (usize, &f64)| {
            let like = face(r, self.heights[0]);
            let like = in_plane.as_ref().map_or(like, |known| like.min(known[k]));
            let faces = self.strength * (like + face(r, self.heights[1]));
            faces.min(MU0_OVER_4PI * 5040.0 / gap(r).powi(8))
        };
        places.iter().enumerate().map(of).collect()
    }
}

/// Bounds of the magnitudes of the divided differences of an order of slopes at places, one for each run
/// of neighbours.
fn differences(places: &[f64], slopes: &[f64], order: usize) -> Vec<f64> {
    let divided = |mut all: Vec<f64>| {
        for step in 1..=order {
            for k in 0..all.len() - 1 {
                all[k] = (all[k + 1] - all[k]) / (places[k + step] - places[k]);
            }
            all.pop();
        }
        all
    };
    // Errors of alternating signs add up.
    let worst = |(k, slope): (usize, &f64)| match k % 2 {
        0 => AT_NODES * slope.abs(),
        _ => -AT_NODES * slope.abs(),
    };
    let errors = divided(slopes.iter().enumerate().map(worst).collect());
    let found = divided(slopes.to_vec());
    let both = found.iter().zip(&errors);
    both.map(|(it, error)| it.abs() + error.abs()).collect()
}

impl RadialTable {
    fn new(first: &Magnet, second: &Magnet) -> Self {
        let [first, second] = [first, second].map(|magnet| Magnet {
            position: Vector2::zeros(),
            moment: 1.0,
            form: Form {
                stands: Some(Standing::Up),
                ..magnet.form
            },
            ..magnet.clone()
        });
        let discs = Discs::new(&Body::from(&first), &Body::from(&second));
        let [one, other] = discs.radii;
        let (radii, small) = (one + other, one.min(other));
        let last = LAST * (radii + discs.heights[1]);
        let mut places = Vec::new();
        let mut gap = FIRST * small;
        while radii + gap < last {
            places.push(radii + gap);
            gap += (OF_GAP * gap).min(OF_DISTANCE * (radii + gap));
        }
        let potential = BodyPotential::within(LEFT_OUT, MagnetModel::Cuboid, &[first], &[second]);
        let energy = |r: f64| {
            let (energy, gradient) =
                potential.energy_and_gradient(&Configuration::new(r, 0.0, 0.0));
            [energy, gradient.x]
        };
        let known: Vec<[f64; 2]> = places.iter().map(|r| energy(*r)).collect();
        let slopes: Vec<f64> = known.iter().map(|[_, slope]| *slope).collect();
        let fifth = discs.fifth(&places);
        // Over a run of nodes: what a derivative is somewhere, and how much it may change.
        let bound = |order: usize, factor: f64, next: &[f64]| -> Vec<f64> {
            let found = differences(&places, &slopes, order);
            let of = |(k, (difference, next)): (usize, (&f64, &f64))| {
                factor * difference + (places[k + order] - places[k]) * next
            };
            found.iter().zip(next).enumerate().map(of).collect()
        };
        let fourth = bound(3, 6.0, &fifth);
        let third = bound(2, 2.0, &fourth);
        let second_order = bound(1, 1.0, &third);
        let steepest = slopes.windows(2).zip(&second_order).enumerate();
        let first_order: Vec<f64> = steepest
            .map(|(k, (ends, next))| {
                ends[0].abs().max(ends[1].abs()) + (places[k + 1] - places[k]) * next
            })
            .collect();
        // The runs of the last nodes are not whole: they are left out. Farther out, dipoles.
        let count = fourth.len();
        let [_, mut beyond @ ..] = of_dipoles(places[count]).map(|it| (1.0 + BEYOND) * it);
        let mut nodes: Vec<Node> = (UNBOUNDED..count)
            .rev()
            .map(|k| {
                let here = [first_order[k], second_order[k], third[k]];
                beyond = [0, 1, 2].map(|n| here[n].max(beyond[n]));
                let [value, slope] = known[k];
                Node {
                    r: places[k],
                    value,
                    slope,
                    fourth: fourth[k],
                    beyond,
                }
            })
            .collect();
        nodes.reverse();
        let [value, slope] = energy(radii + TOUCHING * small);
        let closest = nodes[0].slope.abs().max(slope.abs());
        let class = |node: &Node| class_of(node.r - radii);
        let starts = (class(&nodes[0])..=class(&nodes[nodes.len() - 1]))
            .map(|it| nodes.partition_point(|node| class(node) < it) as u32)
            .collect();
        Self {
            radii,
            nodes,
            starts,
            contact: [1.001 * value, 1.01 * closest],
        }
    }

    fn last(&self) -> &Node {
        &self.nodes[self.nodes.len() - 1]
    }

    /// The number of the last node that is no farther than r, if there are any.
    fn before(&self, r: f64) -> Option<usize> {
        let first = class_of(self.nodes[0].r - self.radii);
        let class = class_of((r - self.radii).max(0.0)).checked_sub(first)?;
        let start = self.starts[class.min(self.starts.len() - 1)] as usize;
        let passed = self.nodes[start..].iter().take_while(|node| node.r <= r);
        (start + passed.count()).checked_sub(1)
    }

    fn at(&self, r: f64) -> RadialValue {
        if r >= self.last().r {
            let value = dipoles(r);
            let error = value.map(|it| BEYOND * it.abs());
            return RadialValue { value, error };
        }
        let Some(k) = self.before(r) else {
            // Between contact and the first node V falls by at most this slope times the way.
            let (first, [_, steepest]) = (&self.nodes[0], self.contact);
            let slack = steepest * (first.r - r).max(0.0) + ROUNDING * first.value;
            return RadialValue {
                value: [first.value, 0.0, 0.0],
                error: [slack, steepest, f64::INFINITY],
            };
        };
        let (from, to) = (&self.nodes[k], &self.nodes[k + 1]);
        let step = to.r - from.r;
        let t = (r - from.r) / step;
        let rise = to.value - from.value;
        let (a, b) = (from.slope * step - rise, rise - to.slope * step);
        // from + t rise + t (1 - t) [a (1 - t) + b t].
        let middle = a + (b - a) * t;
        let value = from.value + t * rise + t * (1.0 - t) * middle;
        let slope = rise + (1.0 - 2.0 * t) * middle + t * (1.0 - t) * (b - a);
        let bend = -2.0 * middle + 2.0 * (1.0 - 2.0 * t) * (b - a);
        let (second, fourth) = (step * step, from.fourth);
        // What the nodes' own errors become in the polynomial's derivatives.
        let lost = AT_NODES * (from.value + from.slope.abs() * step);
        RadialValue {
            value: [value, slope / step, bend / second],
            error: [
                second * second * fourth / 384.0 + ROUNDING * value,
                second * step * fourth / 124.0 + 3.0 * lost / step + ROUNDING * from.slope.abs(),
                second * fourth / 12.0 + 12.0 * lost / second,
            ],
        }
    }

    fn from(&self, r: f64) -> [f64; 4] {
        if r >= self.last().r {
            return of_dipoles(r).map(|it| (1.0 + BEYOND) * it);
        }
        match self.before(r) {
            Some(k) => {
                let node = &self.nodes[k];
                let [first, second, third] = node.beyond;
                let known = self.at(r);
                [known.value[0] + known.error[0], first, second, third]
            }
            None => {
                let [value, first] = self.contact;
                let deep = (self.radii - r).max(0.0);
                [value + first * deep, first, f64::INFINITY, f64::INFINITY]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::magnet::Shape;

    /// An upright disc of a diameter and a height (m), 1 A m^2.
    fn disc(diameter: f64, height: f64) -> Magnet {
        Magnet {
            position: Vector2::zeros(),
            angle: 0.0,
            moment: 1.0,
            size: [diameter, diameter, height],
            form: Form {
                shape: Shape::Disc,
                stands: Some(Standing::Up),
            },
            face: 0,
        }
    }

    fn pairs() -> [[Magnet; 2]; 4] {
        [
            [disc(6e-3, 3e-3), disc(6e-3, 3e-3)],
            [disc(2e-2, 1e-3), disc(5e-3, 1e-3)],
            [disc(5e-3, 2e-2), disc(8e-3, 4e-3)],
            [disc(6e-3, 3e-3), disc(6e-3, 3.1e-3)],
        ]
    }

    #[test]
    fn values_are_within_their_errors_and_derivatives_within_their_bounds() {
        for [first, second] in pairs() {
            let law = Radial::new(MagnetModel::Cuboid, &first, &second);
            let exact = BodyPotential::new(
                MagnetModel::Cuboid,
                std::slice::from_ref(&first),
                std::slice::from_ref(&second),
            );
            let at = |r: f64| {
                let (energy, gradient) =
                    exact.energy_and_gradient(&Configuration::new(r, 0.0, 0.0));
                [energy, gradient.x]
            };
            let radii = (first.size[0] + second.size[0]) / 2.0;
            let mut widest = 0.0f64;
            for k in 0..400 {
                let gap = 3e-6 * 1.04f64.powi(k);
                let r = radii + gap;
                let [energy, slope] = at(r);
                let RadialValue { value, error } = law.at(r);
                assert!(
                    (value[0] - energy).abs() <= error[0],
                    "{r}: {value:?} {energy}"
                );
                assert!(
                    (value[1] - slope).abs() <= error[1],
                    "{r}: {value:?} {slope}"
                );
                let RadialLimits {
                    value: most,
                    derivatives: [first, second, third],
                } = law.from(r);
                assert!(energy <= most && slope.abs() <= first);
                let step = 0.01 * gap.min(r / 4.0);
                let [before, after] = [r - step, r + step].map(|r| at(r)[1]);
                let bend = (after - before) / (2.0 * step);
                let turn = (after - 2.0 * slope + before) / (step * step);
                assert!(bend.abs() <= second * 1.001, "{r}: {bend} {second}");
                assert!(turn.abs() <= third * 1.01, "{r}: {turn} {third}");
                assert!(
                    (bend - value[2]).abs() <= error[2] + 1e-3 * bend.abs(),
                    "{r} {gap}: {bend} {value:?} {error:?}"
                );
                if gap > radii {
                    widest = widest.max(third / turn.abs());
                }
            }
            // The bounds are as good as bounds from one distance to infinity can be.
            assert!(widest < 3.0, "{widest}");
        }
    }

    #[test]
    fn small_discs_are_dipoles() {
        let small = disc(1e-3, 1e-3);
        let law = Radial::new(MagnetModel::Cuboid, &small, &small);
        for r in [0.1, 0.3, 2.0] {
            let (disc, dipole) = (law.at(r), Radial::Dipoles.at(r));
            for n in 0..3 {
                assert!((disc.value[n] / dipole.value[n] - 1.0).abs() < 1e-3);
            }
            let [disc, dipole] = [law.from(r), Radial::Dipoles.from(r)];
            for n in 0..3 {
                let ratio = disc.derivatives[n] / dipole.derivatives[n];
                assert!((0.999..1.2).contains(&ratio), "{r} {n}: {ratio}");
            }
        }
    }

    #[test]
    fn the_steepest_direction_is_found() {
        for (a, b) in [(1.0, 0.0), (1.0, 1.5), (1.0, 2.0), (0.1, 5.0), (60.0, 45.0)] {
            let along = |k: i32| {
                let c = f64::from(k) / 1000.0;
                a * c * c * c + b * c * (1.0 - c * c)
            };
            let dense = (0..=1000).map(along).fold(0.0, f64::max);
            let found = steepest(a, b);
            assert!(found >= dense && found < dense + 1e-5 * b.max(a), "{a} {b}");
        }
    }
}
