//! Bounds of the interaction energy of point dipoles over a cell.
//!
//! **Far pairs** are bounded together by Taylor's theorem about the cell's centre. With the sum
//! over the fixed dipoles `psi(z) = mu0 / (4 pi) sum_j m_j . d_j / |d_j|^3` (A m^2 and m, so that
//! the field is `-grad psi`) a moving dipole `mu` at z has the energy `U = (mu . grad) psi`.
//! Vectors are written as complex numbers; with `d = r e^{i phi}` one fixed dipole m gives
//!
//! ```text
//! d/dz psi          = -1/4  r^-3 [ m* + 3 m e^{-2 i phi} ]
//! d2/dz2 psi        =  3/8  r^-4 [ m* e^{-i phi} + 5 m e^{-3 i phi} ]
//! d2/dz dz* psi     =  3/4  r^-4 Re[ m e^{-i phi} ]
//! d3/dz3 psi        = -15/16 r^-5 [ m* e^{-2 i phi} + 7 m e^{-4 i phi} ]
//! d3/dz2 dz* psi    = -3/16 r^-5 [ 3 m* + 5 m e^{-2 i phi} ]
//! ```
//!
//! which give value, gradient and Hessian of U with respect to (x, y, theta). The remainder: U of
//! a pair is `-K` times a second directional derivative of `1 / r`, K = mu0 m1 m2 / (4 pi), and
//! the n-th directional derivative of `1 / r` is at most `n! / r^(n+1)` (a harmonic function of
//! degree -(n+1), see [`dipole`](crate::potential::dipole)). On the straight way from the centre
//! to a configuration of the cell the magnet has speed at most v = its reach, turns at w = half
//! the cell's angle, and its second and third time derivatives are at most `a w^2` and `a w^3`
//! with its lever arm a. With `G_n = (n + 2)! / rho^(n+3)`, rho = r - reach,
//!
//! ```text
//! |U'''| / K <= w^3 G0 + 3 w^2 G1 v + 3 w (G2 v^2 + G1 a w^2) + G3 v^3 + 3 G2 v a w^2 + G1 a w^3
//! ```
//!
//! and the remainder is a sixth of that.
//!
//! **Near pairs**, closer than a few times the reach, are bounded one by one from
//! `U = K / r^3 [-1/2 cos(a - b) - 3/2 cos(a + b - 2 phi)]` (a, b directions of the moments, phi of
//! the separation) over the distances and angles within reach. As the tiles do not overlap, r is at
//! least the sum of the two magnets' distances to their own outlines.
//!
//! **Rounding.** Every term is a product of at most 40 correctly rounded operations whose partial
//! results are of the size of `K G_n times (reach)^n` at most; the separation itself is rounded by
//! a few units in the last place of the largest coordinate S (m), which changes a term by
//! `K G_(n+1)` times as much. Sums add one rounding a pair. Both are covered by adding
//! `E = (1000 + 8 N) eps` to the coefficient of `rho^-3` and `E S` to that of `rho^-4` in the
//! remainder, N the number of pairs. Assumed, not proved: sine, cosine and arc functions of the
//! platform are right to 8 units in the last place.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::{CellBounds, Enclosure};
use crate::cell::{Cell, Quadratic};
use crate::potential::dipole::Dipole;
use crate::tile::Tile;

/// mu0 / (4 pi) (T m / A).
const SCALE: f64 = crate::units::MU0 / (4.0 * PI);

/// Pairs closer than this many times the magnet's reach are bounded one by one.
const NEAR: f64 = 4.0;

/// How much closer (m) than the sum of their depths two magnets may come: the overlap that counts
/// as touching, with room to spare.
const SLACK: f64 = 1e-8;

/// Dipoles computed side by side.
const LANES: usize = 4;

/// Cell bounds of the interaction energy of two tiles' dipoles.
#[derive(Clone, Debug)]
pub struct DipoleBounds {
    /// Fixed dipoles, [`LANES`] at a time, filled up with dipoles without moment.
    fixed: Vec<FixedLanes>,
    moving: Vec<Moving>,
    rounding: f64,
    /// Largest distance of a fixed dipole from the origin (m).
    extent: f64,
}

#[derive(Clone, Copy, Debug)]
struct FixedLanes {
    x: [f64; LANES],
    y: [f64; LANES],
    /// Moment times mu0 / (4 pi).
    mx: [f64; LANES],
    my: [f64; LANES],
    magnitude: [f64; LANES],
    /// Direction of the moment (rad).
    angle: [f64; LANES],
    /// Distance to the own outline (m).
    depth: [f64; LANES],
}

#[derive(Clone, Copy, Debug)]
struct Moving {
    position: Complex<f64>,
    moment: Complex<f64>,
    magnitude: f64,
    angle: f64,
    lever: f64,
    depth: f64,
}

impl DipoleBounds {
    pub fn new(fixed: &Tile, moving: &Tile) -> Self {
        let fixed = dipoles_and_depths(fixed);
        let moving = dipoles_and_depths(moving);
        let pairs = (fixed.len() * moving.len()) as f64;
        let extent = fixed
            .iter()
            .map(|(dipole, _)| dipole.position.norm())
            .fold(0.0, f64::max);
        Self {
            fixed: fixed.chunks(LANES).map(FixedLanes::new).collect(),
            moving: moving
                .iter()
                .map(|&(dipole, depth)| Moving::new(&dipole, depth))
                .collect(),
            rounding: (1000.0 + 8.0 * pairs) * f64::EPSILON,
            extent,
        }
    }
}

fn dipoles_and_depths(tile: &Tile) -> Vec<(Dipole, f64)> {
    tile.magnets
        .iter()
        .map(|magnet| {
            let depth = -tile.outline.signed_distance(magnet.position);
            (Dipole::from(magnet), depth.max(0.0))
        })
        .collect()
}

impl FixedLanes {
    fn new(dipoles: &[(Dipole, f64)]) -> Self {
        let entry = |of: &dyn Fn(&(Dipole, f64)) -> f64, filler: f64| {
            std::array::from_fn(|k| dipoles.get(k).map_or(filler, of))
        };
        Self {
            x: entry(&|(dipole, _)| dipole.position.x, 1e3),
            y: entry(&|(dipole, _)| dipole.position.y, 1e3),
            mx: entry(&|(dipole, _)| SCALE * dipole.moment.x, 0.0),
            my: entry(&|(dipole, _)| SCALE * dipole.moment.y, 0.0),
            magnitude: entry(&|(dipole, _)| SCALE * dipole.moment.norm(), 0.0),
            angle: entry(&|(dipole, _)| dipole.moment.y.atan2(dipole.moment.x), 0.0),
            depth: entry(&|(_, depth)| *depth, 0.0),
        }
    }
}

impl Moving {
    fn new(dipole: &Dipole, depth: f64) -> Self {
        Self {
            position: Complex::new(dipole.position.x, dipole.position.y),
            moment: Complex::new(dipole.moment.x, dipole.moment.y),
            magnitude: dipole.moment.norm(),
            angle: dipole.moment.y.atan2(dipole.moment.x),
            lever: dipole.position.norm(),
            depth,
        }
    }
}

impl CellBounds for DipoleBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let q = &cell.centre;
        let (sin, cos) = q.theta.sin_cos();
        let turn = Complex::new(cos, sin);
        let turning = cell.half[2];
        let travel = cell.travel();
        let size = self.extent + q.x.abs() + q.y.abs() + 1.0;
        let mut out = Enclosure::default();
        for magnet in &self.moving {
            let arm = turn * magnet.position;
            let moment = turn * magnet.moment;
            let at = Complex::new(q.x, q.y) + arm;
            let reach = travel + magnet.lever * turning;
            let derivatives = self.far_field(
                at,
                reach,
                &remainder(
                    turning,
                    reach,
                    magnet.lever,
                    self.rounding,
                    size + magnet.lever,
                ),
            );
            add_energy(&mut out.form, &derivatives, arm, moment);
            let remainder = derivatives.remainder * magnet.magnitude;
            out.low -= remainder;
            out.high += remainder;
            if derivatives.near > 0 {
                self.add_near(&mut out, magnet, at, reach, q.theta, turning);
            }
        }
        out
    }
}

/// Coefficients of rho^-3 to rho^-6 in the remainder.
fn remainder(w: f64, v: f64, lever: f64, rounding: f64, size: f64) -> [f64; 4] {
    let (second, third) = (lever * w * w, lever * w * w * w);
    [
        w * w * w / 3.0 + rounding,
        3.0 * w * w * v + 3.0 * w * second + third + rounding * size,
        12.0 * (w * v * v + v * second),
        20.0 * v * v * v,
    ]
}

/// Derivatives of psi at a point, and the remainder's sum.
struct FieldDerivatives {
    /// d/dz.
    first: Complex<f64>,
    /// d2/dz2 and d2/dz dz*.
    second: Complex<f64>,
    second_mixed: f64,
    /// d3/dz3 and d3/dz2 dz*.
    third: Complex<f64>,
    third_mixed: Complex<f64>,
    remainder: f64,
    /// How many dipoles were too near to be included.
    near: usize,
}

impl DipoleBounds {
    // Several arrays are walked at once.
    #[allow(clippy::needless_range_loop)]
    fn far_field(&self, at: Complex<f64>, reach: f64, coefficients: &[f64; 4]) -> FieldDerivatives {
        let mut sums = [[0.0; LANES]; 11];
        let nearest = NEAR * reach;
        let [c3, c4, c5, c6] = *coefficients;
        for lanes in &self.fixed {
            for k in 0..LANES {
                let dx = at.re - lanes.x[k];
                let dy = at.im - lanes.y[k];
                let r2 = dx * dx + dy * dy;
                let r = r2.sqrt();
                let far = r >= nearest && r > 0.0;
                let inverse = if far { 1.0 / r } else { 0.0 };
                let rho = if far { 1.0 / (r - reach) } else { 0.0 };
                let i2 = inverse * inverse;
                let i3 = inverse * i2;
                let i4 = i2 * i2;
                let i5 = i2 * i3;
                let (c, s) = (dx * inverse, -dy * inverse);
                // e^{-2 i phi}, m e^{-i phi}, m e^{-2 i phi}, m e^{-3 i phi}, m e^{-4 i phi}
                let (c2, s2) = (c * c - s * s, 2.0 * c * s);
                let (mx, my) = (lanes.mx[k], lanes.my[k]);
                let (m1x, m1y) = (mx * c - my * s, mx * s + my * c);
                let (m2x, m2y) = (mx * c2 - my * s2, mx * s2 + my * c2);
                let (m3x, m3y) = (m1x * c2 - m1y * s2, m1x * s2 + m1y * c2);
                let (m4x, m4y) = (m2x * c2 - m2y * s2, m2x * s2 + m2y * c2);
                // m* e^{-i phi}, m* e^{-2 i phi}
                let (n1x, n1y) = (mx * c + my * s, mx * s - my * c);
                let (n2x, n2y) = (mx * c2 + my * s2, mx * s2 - my * c2);
                sums[0][k] += i3 * (mx + 3.0 * m2x);
                sums[1][k] += i3 * (3.0 * m2y - my);
                sums[2][k] += i4 * (n1x + 5.0 * m3x);
                sums[3][k] += i4 * (n1y + 5.0 * m3y);
                sums[4][k] += i4 * m1x;
                sums[5][k] += i5 * (n2x + 7.0 * m4x);
                sums[6][k] += i5 * (n2y + 7.0 * m4y);
                sums[7][k] += i5 * (3.0 * mx + 5.0 * m2x);
                sums[8][k] += i5 * (5.0 * m2y - 3.0 * my);
                let series = c3 + rho * (c4 + rho * (c5 + rho * c6));
                sums[9][k] += lanes.magnitude[k] * (rho * rho * rho * series);
                sums[10][k] += if far { 0.0 } else { 1.0 };
            }
        }
        let total = sums.map(|lanes| lanes.iter().sum::<f64>());
        FieldDerivatives {
            first: Complex::new(total[0], total[1]) * -0.25,
            second: Complex::new(total[2], total[3]) * 0.375,
            second_mixed: total[4] * 0.75,
            third: Complex::new(total[5], total[6]) * -0.9375,
            third_mixed: Complex::new(total[7], total[8]) * -0.1875,
            remainder: total[9],
            near: total[10] as usize,
        }
    }

    /// Adds the pairs that [`far_field`](Self::far_field) left out.
    fn add_near(
        &self,
        out: &mut Enclosure,
        magnet: &Moving,
        at: Complex<f64>,
        reach: f64,
        theta: f64,
        turning: f64,
    ) {
        let nearest = NEAR * reach;
        for lanes in &self.fixed {
            for k in 0..LANES {
                let (dx, dy) = (at.re - lanes.x[k], at.im - lanes.y[k]);
                let r = (dx * dx + dy * dy).sqrt();
                if r >= nearest && r > 0.0 {
                    continue;
                }
                let strength = lanes.magnitude[k] * magnet.magnitude;
                let b = magnet.angle + theta;
                let a = lanes.angle[k];
                let phi = dy.atan2(dx);
                let swing = if reach < r { (reach / r).asin() } else { PI };
                let along = cosine_range(a - b, turning);
                let across = cosine_range(a + b - 2.0 * phi, turning + 2.0 * swing);
                let factor = (
                    -0.5 * along.1 - 1.5 * across.1,
                    -0.5 * along.0 - 1.5 * across.0,
                );
                let least = (r - reach)
                    .max(lanes.depth[k] + magnet.depth - SLACK)
                    .max(0.0);
                let most = r + reach;
                let cubed = |r: f64| strength / (r * r * r);
                let low = factor.0 * cubed(if factor.0 < 0.0 { least } else { most });
                let high = factor.1 * cubed(if factor.1 > 0.0 { least } else { most });
                let margin = self.rounding * 2.0 * cubed(least);
                let (low, high) = (low - margin, high + margin);
                if !(low.is_finite() && high.is_finite()) {
                    // No moment, no energy; otherwise the magnets may coincide.
                    if strength > 0.0 {
                        out.low = f64::NEG_INFINITY;
                        out.high = f64::INFINITY;
                    }
                    continue;
                }
                let here = (-0.5 * (a - b).cos() - 1.5 * (a + b - 2.0 * phi).cos()) * cubed(r);
                let middle = if here >= low && here <= high {
                    here
                } else {
                    (low + high) / 2.0
                };
                out.form.value += middle;
                out.low += low - middle - margin;
                out.high += high - middle + margin;
            }
        }
    }
}

/// Least and largest cosine over angles within `half` of `middle` (rad).
fn cosine_range(middle: f64, half: f64) -> (f64, f64) {
    const MARGIN: f64 = 1e-14;
    if half >= PI {
        return (-1.0, 1.0);
    }
    let middle = crate::configuration::wrap_angle(middle).abs();
    // cos falls from 0 to pi; the angles run from middle - half to middle + half.
    let high = if middle <= half {
        1.0
    } else {
        (middle - half).cos() + MARGIN
    };
    let low = if middle + half >= PI {
        -1.0
    } else {
        (middle + half).cos() - MARGIN
    };
    (low.max(-1.0), high.min(1.0))
}

/// Adds the energy of a dipole in the field to a form: value, gradient and Hessian with respect
/// to (x, y, theta). A turn moves the dipole along `i arm`, accelerates it along `-arm`, and
/// turns its moment likewise.
fn add_energy(
    form: &mut Quadratic,
    field: &FieldDerivatives,
    arm: Complex<f64>,
    moment: Complex<f64>,
) {
    let first = |u: Complex<f64>| 2.0 * (u * field.first).re;
    let second = |u: Complex<f64>, v: Complex<f64>| {
        2.0 * (u * v * field.second).re + 2.0 * (u * v.conj()).re * field.second_mixed
    };
    let third = |u: Complex<f64>, v: Complex<f64>, w: Complex<f64>| {
        let mixed = u * v * w.conj() + u * v.conj() * w + u.conj() * v * w;
        2.0 * (u * v * w * field.third).re + 2.0 * (mixed * field.third_mixed).re
    };
    let (x, y) = (Complex::new(1.0, 0.0), Complex::new(0.0, 1.0));
    let turn = y * arm;
    let turned = y * moment;
    form.value += first(moment);
    form.gradient[0] += second(x, moment);
    form.gradient[1] += second(y, moment);
    form.gradient[2] += second(turn, moment) + first(turned);
    form.hessian[0] += third(x, x, moment);
    form.hessian[1] += third(y, y, moment);
    form.hessian[2] += third(turn, turn, moment)
        + second(-arm, moment)
        + 2.0 * second(turn, turned)
        + first(-moment);
    form.hessian[3] += third(x, y, moment);
    form.hessian[4] += third(x, turn, moment) + second(x, turned);
    form.hessian[5] += third(y, turn, moment) + second(y, turned);
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::configuration::Configuration;
    use crate::contact::Contact;
    use crate::potential::{DipolePotential, Potential};
    use crate::tile::{Magnet, Outline};
    use nalgebra::Vector2;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A square of side 0.43 m with four magnets on each face, +1 for north pole out.
    pub fn square_tile(code: [f64; 4]) -> Tile {
        let half = 0.215;
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        let mut magnets = Vec::new();
        for face in 0..4 {
            let angle = face as f64 * PI / 2.0;
            let normal = Vector2::new(angle.cos(), angle.sin());
            let tangent = Vector2::new(-angle.sin(), angle.cos());
            for (k, sign) in code.iter().enumerate() {
                magnets.push(Magnet {
                    position: normal * (half - 0.005) + tangent * ((k as f64 - 1.5) * 0.04),
                    angle: if *sign > 0.0 { angle } else { angle + PI },
                    moment: 1.2 * 3e-7 / crate::units::MU0,
                    size: [0.01, 0.01, 0.003],
                    face,
                });
            }
        }
        Tile {
            outline: Outline::new(corners.map(|c| Vector2::new(c[0], c[1])).to_vec()).unwrap(),
            faces: Vec::new(),
            magnets,
            mass: 0.1,
            thickness: 0.013,
        }
    }

    pub fn paper_tiles() -> (Tile, Tile) {
        (
            square_tile([1.0, 1.0, 1.0, -1.0]),
            square_tile([1.0, -1.0, -1.0, -1.0]),
        )
    }

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
    fn no_free_configuration_of_a_cell_lies_outside_its_enclosure() {
        let (a, b) = paper_tiles();
        let bounds = DipoleBounds::new(&a, &b);
        let potential = DipolePotential::new(&a.magnets, &b.magnets);
        let contact = Contact::new(&a.outline, &b.outline);
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let (mut tested, mut near) = (0, 0);
        for _ in 0..3000 {
            let size = 10f64.powf(rng.random_range(-4.0..-0.5));
            let cell = Cell {
                centre: Configuration::new(
                    rng.random_range(0.35..0.6),
                    rng.random_range(-0.3..0.3),
                    rng.random_range(-0.4..0.4),
                ),
                half: std::array::from_fn(|_| size * rng.random_range(0.05..1.0)),
            };
            let enclosure = bounds.enclose(&cell);
            assert!(enclosure.low <= 0.0 && enclosure.high >= 0.0);
            for _ in 0..20 {
                let d: [f64; 3] =
                    std::array::from_fn(|i| cell.half[i] * rng.random_range(-1.0..=1.0));
                let q = cell.centre.moved(d.into());
                if !contact.is_free(&q) {
                    continue;
                }
                let rest = potential.energy(&q) - value(&enclosure.form, d);
                tested += 1;
                near += usize::from(size > 0.01);
                assert!(
                    rest >= enclosure.low && rest <= enclosure.high,
                    "{cell:?} {d:?}: {rest} not in [{}, {}]",
                    enclosure.low,
                    enclosure.high
                );
            }
        }
        assert!(tested > 10_000 && near > 3_000, "{tested} {near}");
    }

    #[test]
    fn the_remainder_is_of_third_order() {
        let (a, b) = paper_tiles();
        let bounds = DipoleBounds::new(&a, &b);
        let width = |h: f64| {
            let enclosure = bounds.enclose(&Cell {
                centre: Configuration::new(0.46, 0.03, 0.1),
                half: [h, h, 4.0 * h],
            });
            enclosure.high - enclosure.low
        };
        let ratio = width(1e-3) / width(1e-4);
        assert!((ratio - 1000.0).abs() < 400.0, "{ratio}");
    }

    #[test]
    fn a_cell_of_no_size_gives_the_energy_and_its_gradient() {
        let (a, b) = paper_tiles();
        let bounds = DipoleBounds::new(&a, &b);
        let potential = DipolePotential::new(&a.magnets, &b.magnets);
        let q = Configuration::new(0.44, -0.07, 0.08);
        let enclosure = bounds.enclose(&Cell {
            centre: q,
            half: [0.0; 3],
        });
        let (energy, gradient) = potential.energy_and_gradient(&q);
        assert!((enclosure.form.value - energy).abs() < 1e-14);
        for i in 0..3 {
            assert!((enclosure.form.gradient[i] - gradient[i]).abs() < 1e-12);
            let h = 1e-5;
            let mut step = nalgebra::Vector3::zeros();
            step[i] = h;
            let there = potential.energy_and_gradient(&q.moved(step)).1;
            let back = potential.energy_and_gradient(&q.moved(-step)).1;
            let slope = (there - back) / (2.0 * h);
            let [xx, yy, tt, xy, xt, yt] = enclosure.form.hessian;
            let row = [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]][i];
            for j in 0..3 {
                assert!(
                    (slope[j] - row[j]).abs() < 1e-5 * (1.0 + row[j].abs()),
                    "{i} {j}"
                );
            }
        }
        assert!(enclosure.high < 1e-12, "{}", enclosure.high);
    }
}
