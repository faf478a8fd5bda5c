//! A pair of discs with their axes in the tiles' plane: uniformly magnetised cylinders, lying.
//!
//! Each cylinder is two charged discs, upright in the plane, so that a pair is four integrals
//! `I = int int 1 / r` over two discs. Outside, a charged disc of radius R is a line of charge along
//! its axis at imaginary heights: the integral of `1 / r` over it is, with c its centre and n its
//! normal,
//!
//! ```text
//! V(x) = 2 int_-R^R sqrt(R^2 - t^2) / |x - c - i t n| dt,      |z| = sqrt(z.z), its real part positive
//! ```
//!
//! (on the axis both sides are `2 pi (sqrt(R^2 + h^2) - h)`, and a harmonic function that is symmetric
//! about an axis is known from its values there). Thus `I = 2 int sqrt(R1^2 - t^2) V2(c1 + i t n1) dt`:
//! of four integrals three are done, V2 by elliptic integrals ([`super::face`]).
//!
//! The square root has no branch point on the way: `d + i v`, `d = c2 - c1` and `v = t2 n2 - t1 n1`, has
//! `z.z` real and not positive only if v is normal to d and no shorter; v turned by a right angle,
//! `t2 tau2 - t1 tau1`, is then d or longer, and the discs, whose traces in the plane run along tau1
//! and tau2, meet.
//!
//! V2 is singular where `c1 + i t n1` meets the rim of the second disc, at `t = x + i y` and `x - i y`, x
//! the place of the rim's point along the first disc and y its height over it. In `t = R1 cos phi` the
//! integrand is smooth and periodic, and equal steps of phi find the integral with an error that
//! falls like `rho^(-2 n)`, rho the sum of the half axes of the ellipse about [-1, 1] through the
//! singular place. Where rho is near 1 phi is cut into panels that shrink towards that place.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::{Complex, Vector2};

use super::face::potential;
use crate::potential::cuboid::quadrature::gauss_legendre;

type C = Complex<f64>;

/// An upright disc in the plane.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Centre (m).
    pub centre: Vector2<f64>,
    /// Unit vector of its axis.
    pub normal: Vector2<f64>,
    /// Radius (m).
    pub radius: f64,
}

/// The integral of `1 / r` over two faces (m^3), its gradient by the second one's centre (m^2) and its
/// derivative by the second one's angle about its own centre (m^3).
#[derive(Clone, Copy, Debug, Default)]
pub struct Integral {
    pub value: f64,
    pub gradient: Vector2<f64>,
    pub slope: f64,
}

/// What is lost of an integral, at most about this share.
const LOST: f64 = 1e-13;
/// With more equal steps than this panels take fewer nodes.
const STEPS: usize = 32;
/// Nodes of a panel.
const NODES: usize = 12;
/// A panel is no more than so many times as long as its distance from the nearest singular place.
const LONGEST: f64 = 1.5;
/// Panels are not divided below this angle (rad): the integrand's singularity is weak, and what is
/// left there is less than 1e-10 of the integral.
const SHORTEST: f64 = 1e-5;

static RULE: LazyLock<[[f64; NODES]; 2]> = LazyLock::new(gauss_legendre::<NODES>);

fn across(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

impl Integral {
    /// Of two faces that do not meet.
    pub fn new(first: &Face, second: &Face) -> Self {
        let mut sum = Self::default();
        for (phi, weight) in angles(first, second) {
            let (sin, cos) = libm::sincos(phi);
            let t = first.radius * cos;
            let weight = 2.0 * weight * first.radius * first.radius * sin * sin;
            sum.add(weight, first.centre, first.normal * t, second);
        }
        sum
    }

    /// Adds the second face's potential at `place + i way`.
    fn add(&mut self, weight: f64, place: Vector2<f64>, way: Vector2<f64>, face: &Face) {
        let along = across(face.normal);
        let from = place - face.centre;
        let s = C::new(from.dot(&along), way.dot(&along));
        let h = C::new(from.dot(&face.normal), way.dot(&face.normal));
        let at = potential(face.radius, s, h);
        let gradient = along * at.outwards.re + face.normal * at.upwards.re;
        self.value += weight * at.value.re;
        self.gradient -= gradient * weight;
        self.slope += weight * (s * at.upwards - h * at.outwards).re;
    }
}

/// Angles phi (rad) in [0, pi / 2] and their weights: what is at `pi - phi` is the same, conjugate.
fn angles(first: &Face, second: &Face) -> Vec<(f64, f64)> {
    let along = across(first.normal);
    let rim = [-1.0, 1.0].map(|side| {
        let point = second.centre + across(second.normal) * (side * second.radius) - first.centre;
        let place = C::new(point.dot(&along), point.dot(&first.normal)) / first.radius;
        arccosine(C::new(place.re.abs(), place.im.abs()))
    });
    // ln rho is the imaginary part of the angle of the singular place.
    let ln_rho = rim[0].im.min(rim[1].im);
    let steps = (-libm::log(LOST) / (2.0 * ln_rho)).ceil();
    if steps <= STEPS as f64 {
        // Equal steps over the whole circle, halves at the end that is its own image.
        let n = (steps as usize).max(3);
        let step = PI / n as f64;
        return (1..=n / 2)
            .map(|k| {
                let own = 2 * k == n;
                (k as f64 * step, if own { step } else { 2.0 * step })
            })
            .collect();
    }
    let mut found = Vec::new();
    panels(0.0, PI / 2.0, &rim, &mut found);
    found
}

/// The nodes of panels from `low` to `high`, divided where they come close to a singular place.
fn panels(low: f64, high: f64, rim: &[C; 2], found: &mut Vec<(f64, f64)>) {
    let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let distance = rim.iter().map(|place| {
        let aside = ((place.re - middle).abs() - half).max(0.0);
        aside.hypot(place.im)
    });
    let nearest = distance.fold(f64::INFINITY, f64::min);
    if 2.0 * half > LONGEST * nearest && half > SHORTEST {
        // At the singular place itself, or in the middle.
        let inside = rim.iter().map(|place| place.re);
        let cut = inside
            .filter(|place| (place - middle).abs() < 0.8 * half)
            .fold(middle, |best, place| if best == middle { place } else { best });
        panels(low, cut, rim, found);
        panels(cut, high, rim, found);
        return;
    }
    let [nodes, weights] = &*RULE;
    let both = nodes.iter().zip(weights);
    found.extend(both.map(|(node, weight)| (middle + half * node, 2.0 * half * weight)));
}

/// The angle of a place in the first quadrant, with its imaginary part positive.
fn arccosine(z: C) -> C {
    // cos(a + i b) = cos a cosh b - i sin a sinh b.
    let (near, far) = ((z - 1.0).norm_sqr().sqrt(), (z + 1.0).norm_sqr().sqrt());
    let cosh = ((near + far) / 2.0).max(1.0);
    let sinh = ((cosh - 1.0) * (cosh + 1.0)).sqrt();
    C::new(libm::acos((z.re / cosh).min(1.0)), libm::log(cosh + sinh))
}
pub fn count(a: &Face, b: &Face) -> usize { angles(a, b).len() }
