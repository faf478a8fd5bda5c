//! Integrals over the boundaries of two flat rectangles.
//!
//! With `Phi(rho) = r - z ln(z + r)`, `r^2 = rho^2 + z^2`, z the distance of the two planes, the
//! plane Laplacian of Phi is `1 / r`, so that by the divergence theorem, applied once to either
//! rectangle,
//!
//! ```text
//! int int 1 / r dA1 dA2 = - sum over edges e of one, f of the other of (n_e . n_f) int int Phi dl1 dl2
//! ```
//!
//! with n the outward normals. The inner integral has a closed form ([`inner`]). A shift or a turn
//! of one rectangle changes the integral by the other one's potential at its edges, V: with p
//! relative to the second one's centre, the derivatives by that centre and by its angle are `-sum
//! n_e int V dl` and `-sum int n_e . (z x p) V dl` over the edges of the first.

use nalgebra::{Vector2, Vector3};

use super::complex::C;
use super::face::{Face, Integral};
use super::panels::panels;

/// An edge: its midpoint, its direction, half its length (m), and the outward normal.
struct Edge {
    middle: Vector2<f64>,
    along: Vector2<f64>,
    half: f64,
    normal: Vector2<f64>,
}

fn edges(face: &Face, [a, b]: [f64; 2]) -> [Edge; 4] {
    let centre = face.centre.xy();
    let [x, y] = [face.frame[0].xy(), face.frame[1].xy()];
    let edge = |normal: Vector2<f64>, reach: f64, along: Vector2<f64>, half: f64| Edge {
        middle: centre + normal * reach,
        along,
        half,
        normal,
    };
    [
        edge(x, a, y, b),
        edge(-x, a, y, b),
        edge(y, b, x, a),
        edge(-y, b, x, a),
    ]
}

/// The integral of two flat rectangles with these half sides (m).
pub fn integral([first, second]: [&Face; 2], halves: [[f64; 2]; 2]) -> Integral {
    let height = (second.centre.z - first.centre.z).abs();
    let [own, others] = [edges(first, halves[0]), edges(second, halves[1])];
    let mut sum = Integral::default();
    for edge in &own {
        // Near the other one's corners, and near the intersection of the edges' lines.
        let mut singular = Vec::new();
        for other in &others {
            for end in [-other.half, other.half] {
                let way = other.middle + other.along * end - edge.middle;
                let aside = libm::hypot(way.dot(&edge.normal), height);
                singular.push(C::new(way.dot(&edge.along), aside));
            }
            let sin = edge.along.perp(&other.along);
            let way = other.middle - edge.middle;
            let (place, on_other) = (way.perp(&other.along) / sin, way.perp(&edge.along) / sin);
            if place.is_finite() && on_other.abs() < 1.5 * other.half {
                singular.push(C::new(place, height / sin.abs()));
            }
        }
        let shortest = 1e-6 * edge.half;
        panels(
            [-edge.half, edge.half],
            &singular,
            shortest,
            &mut |place, weight| {
                let point = edge.middle + edge.along * place;
                for other in &others {
                    let way = point - other.middle;
                    let (along, aside) = (way.dot(&other.along), way.dot(&other.normal));
                    let inner = inner(other.half - along, aside, height)
                        - inner(-other.half - along, aside, height);
                    sum.value -= weight * edge.normal.dot(&other.normal) * inner;
                }
                let from = Vector3::new(point.x, point.y, first.centre.z) - second.centre;
                let (potential, _) = second.potential([from.x, from.y, from.z].map(C::from));
                let share = weight * potential.re;
                sum.gradient -= edge.normal * share;
                sum.slope -= share * edge.normal.dot(&Vector2::new(-from.y, from.x));
            },
        );
    }
    sum
}

/// The integral of Phi over u from 0 (m^2), at the distance w from the line and the height z (m):
///
/// ```text
/// (u r + m^2 s) / 2 - z [u ln(z + r) - u + z s + w atan(u / w) - w atan(z u / (w r))]
/// m^2 = w^2 + z^2,   r^2 = u^2 + m^2,   s = asinh(u / m)
/// ```
fn inner(u: f64, w: f64, z: f64) -> f64 {
    let (w, m) = (w.abs(), libm::hypot(w, z));
    let r = libm::hypot(u, m);
    let s = if m > 0.0 { libm::asinh(u / m) } else { 0.0 };
    let plane = (u * r + m * m * s) / 2.0;
    if z == 0.0 {
        return plane;
    }
    let angles = libm::atan2(u, w) - libm::atan2(z * u, w * r);
    plane - z * (u * libm::log(z + r) - u + z * s + w * angles)
}
