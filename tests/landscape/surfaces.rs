//! Landscapes with known minima and saddles in x and y, independent of theta.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use tilebind::Configuration;
use tilebind::cell::{Cell, Quadratic};
use tilebind::potential::Potential;
use tilebind::potential::bounds::{CellBounds, Enclosure};

/// Relative rounding errors allowed for in the enclosures: far more than the dozens of roundings
/// (and the exponential's few units in the last place) that there are.
pub const ROUNDING: f64 = 1e-13;

/// Two wells in a valley along x:
///
/// ```text
/// U = height ((x / half_distance)^2 - 1)^2 + stiffness y^2 / 2
/// ```
///
/// Minima of 0 at (+-half_distance, 0), a saddle of `height` (J) at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleWell {
    /// Energy of the saddle (J).
    pub height: f64,
    /// Half the distance of the minima (m).
    pub half_distance: f64,
    /// Curvature across the valley (J/m^2).
    pub stiffness: f64,
}

impl DoubleWell {
    fn form(&self, q: &Configuration) -> Quadratic {
        let (h, a2) = (self.height, self.half_distance.powi(2));
        let well = q.x * q.x / a2 - 1.0;
        Quadratic {
            value: h * well * well + 0.5 * self.stiffness * q.y * q.y,
            gradient: [4.0 * h * q.x / a2 * well, self.stiffness * q.y, 0.0],
            hessian: [
                h * (12.0 * q.x * q.x / a2 - 4.0) / a2,
                self.stiffness,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
        }
    }
}

impl Potential for DoubleWell {
    fn energy(&self, q: &Configuration) -> f64 {
        self.form(q).value
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let form = self.form(q);
        (form.value, form.gradient.into())
    }

    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let a2 = self.half_distance.powi(2);
        let farthest = q.x.abs() + reach;
        let along = self.height * (12.0 * farthest * farthest / a2).max(4.0) / a2;
        along.max(self.stiffness)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm()
    }
}

impl CellBounds for DoubleWell {
    /// The polynomial's own third- and fourth-order terms.
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let form = self.form(&cell.centre);
        let (x, d) = (cell.centre.x.abs(), cell.half[0]);
        let fourth = self.height / self.half_distance.powi(4) * d.powi(4);
        let third = 4.0 * self.height * x / self.half_distance.powi(4) * d.powi(3);
        let size = self.height * ((x + d) / self.half_distance).powi(2).max(1.0).powi(2);
        let rounding = ROUNDING * (size + form.value);
        Enclosure {
            form,
            low: -third - rounding,
            high: third + fourth + rounding,
            ..Enclosure::unknown()
        }
    }
}

/// The surface of Mueller and Brown (Theor. Chim. Acta 53, 75 (1979), doi:10.1007/BF00547608), a
/// standard test of methods that search for saddles:
///
/// ```text
/// U = scale sum_k A_k exp[a_k (X - X_k)^2 + b_k (X - X_k) (Y - Y_k) + c_k (Y - Y_k)^2]
/// ```
///
/// with X = (x - origin_x) / length and so on. In units of `scale`: minima of -146.69952 at
/// (-0.55822, 1.44173), -108.16672 at (0.62350, 0.02804) and -80.76782 at (-0.05001, 0.46669);
/// saddles of -40.66484 at (-0.82200, 0.62431) and -72.24894 at (0.21249, 0.29299).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MuellerBrown {
    /// Energy (J) of one unit.
    pub scale: f64,
    /// Length (m) of one unit.
    pub length: f64,
    /// Where the surface's origin lies (m).
    pub origin: [f64; 2],
}

/// A_k, a_k, b_k, c_k, X_k, Y_k.
const TERMS: [[f64; 6]; 4] = [
    [-200.0, -1.0, 0.0, -10.0, 1.0, 0.0],
    [-100.0, -1.0, 0.0, -10.0, 0.0, 0.5],
    [-170.0, -6.5, 11.0, -6.5, -0.5, 1.5],
    [15.0, 0.7, 0.6, 0.7, -1.0, 1.0],
];

impl MuellerBrown {
    /// A configuration from the surface's own coordinates.
    pub fn configuration(&self, x: f64, y: f64) -> Configuration {
        Configuration::new(
            self.origin[0] + self.length * x,
            self.origin[1] + self.length * y,
            0.0,
        )
    }

    /// The exponents and factors of the terms at a configuration, as forms in the surface's
    /// units.
    fn exponents(&self, q: &Configuration) -> [(f64, Quadratic); 4] {
        let at = [
            (q.x - self.origin[0]) / self.length,
            (q.y - self.origin[1]) / self.length,
        ];
        TERMS.map(|[factor, a, b, c, x, y]| {
            let (x, y) = (at[0] - x, at[1] - y);
            let exponent = Quadratic {
                value: a * x * x + b * x * y + c * y * y,
                gradient: [2.0 * a * x + b * y, b * x + 2.0 * c * y, 0.0],
                hessian: [2.0 * a, 2.0 * c, 0.0, b, 0.0, 0.0],
            };
            (factor * self.scale, exponent)
        })
    }

    fn form(&self, q: &Configuration) -> Quadratic {
        let mut sum = Quadratic::default();
        for (factor, exponent) in self.exponents(q) {
            let u = factor * exponent.value.exp();
            let [gx, gy, _] = exponent.gradient;
            let [xx, yy, _, xy, _, _] = exponent.hessian;
            let l = self.length;
            let term = Quadratic {
                value: u,
                gradient: [u * gx / l, u * gy / l, 0.0],
                hessian: [
                    u * (gx * gx + xx) / (l * l),
                    u * (gy * gy + yy) / (l * l),
                    0.0,
                    u * (gx * gy + xy) / (l * l),
                    0.0,
                    0.0,
                ],
            };
            sum = sum.minus(-1.0, &term);
        }
        sum
    }

    /// Sums over the terms, with the largest magnitude of each in the box, of the term, and of
    /// the term times `P^2 + S` and `P^3 + 3 P S`: P and S bound the first and second derivative
    /// of the exponent on straight ways of duration 1 from the centre to a point of the box.
    fn sizes(&self, q: &Configuration, half: [f64; 2]) -> [f64; 3] {
        let half = [half[0] / self.length, half[1] / self.length, 0.0];
        let mut sums = [0.0; 3];
        for (factor, exponent) in self.exponents(q) {
            let [xx, yy, _, xy, _, _] = exponent.hessian.map(f64::abs);
            let most = factor.abs() * exponent.greatest(&half).exp();
            let s = xx * half[0] * half[0] + 2.0 * xy * half[0] * half[1] + yy * half[1] * half[1];
            let p = exponent.gradient[0].abs() * half[0] + exponent.gradient[1].abs() * half[1] + s;
            sums[0] += most;
            sums[1] += most * (p * p + s);
            sums[2] += most * (p * p * p + 3.0 * p * s);
        }
        sums
    }
}

impl Potential for MuellerBrown {
    fn energy(&self, q: &Configuration) -> f64 {
        self.form(q).value
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let form = self.form(q);
        (form.value, form.gradient.into())
    }

    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        // The largest second derivative on the way to a box of half size `reach`, a length of at
        // least `reach`.
        self.sizes(q, [reach, reach])[1] / (reach * reach)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm()
    }
}

impl CellBounds for MuellerBrown {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let sizes = self.sizes(&cell.centre, [cell.half[0], cell.half[1]]);
        let remainder = sizes[2] / 6.0 + ROUNDING * sizes.iter().sum::<f64>();
        if !remainder.is_finite() {
            return Enclosure::unknown();
        }
        Enclosure {
            form: self.form(&cell.centre),
            low: -remainder,
            high: remainder,
            ..Enclosure::unknown()
        }
    }
}

const SURFACE: MuellerBrown = MuellerBrown {
    scale: 1.0,
    length: 0.3,
    origin: [0.05, -0.2],
};

#[test]
fn stationary_points_have_the_published_energies() {
    for (x, y, energy) in [
        (-0.55822, 1.44173, -146.69952),
        (0.62350, 0.02804, -108.16672),
        (-0.05001, 0.46669, -80.76782),
        (-0.82200, 0.62431, -40.66484),
        (0.21249, 0.29299, -72.24894),
    ] {
        let (u, gradient) = SURFACE.energy_and_gradient(&SURFACE.configuration(x, y));
        assert!((u - energy).abs() < 1e-4, "{u} {energy}");
        assert!(gradient.norm() * SURFACE.length < 2e-2, "{gradient}");
    }
}

/// Checks enclosures and curvature bounds against sampled energies, `extent` (m) around the origin.
pub fn check_bounds<P: Potential + CellBounds>(potential: &P, extent: f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for _ in 0..2000 {
        let mut random = |most: f64| rng.random_range(-most..most);
        let size = 10f64.powf(random(2.0) - 2.0) * extent;
        let cell = Cell {
            centre: Configuration::new(random(extent), random(extent), random(3.0)),
            half: [
                random(size).abs(),
                random(size).abs(),
                random(size / extent).abs(),
            ],
        };
        let enclosure = potential.enclose(&cell);
        let reach = potential.displacement(cell.half.into());
        let steepest = potential.curvature_bound(&cell.centre, reach);
        for _ in 0..20 {
            let d = cell.half.map(|half| random(1.0) * half);
            let energy =
                |t: f64| Potential::energy(potential, &cell.centre.moved(Vector3::from(d) * t));
            let u = energy(1.0);
            let rest = u - enclosure.form.at(d);
            assert!(rest >= enclosure.low && rest <= enclosure.high, "{cell:?}");
            let bend = (u - 2.0 * enclosure.form.value + energy(-1.0)).abs();
            let travelled = potential.displacement(d.into()).powi(2);
            assert!(bend <= steepest * travelled * (1.0 + 1e-9) + 1e-9 * u.abs());
        }
    }
}

#[test]
fn enclosures_hold_the_energy() {
    check_bounds(&SURFACE, 0.5);
    check_bounds(
        &DoubleWell {
            height: 2.0,
            half_distance: 0.3,
            stiffness: 5.0,
        },
        0.5,
    );
}
