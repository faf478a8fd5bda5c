//! Sums over all pairs of shielded magnets: a moving magnet with several fixed ones at once.

use nalgebra::{Rotation2, Vector2, Vector3};

use super::Front;
use crate::configuration::Configuration;
use crate::potential::batch::lanes::{Lanes, Task};
use crate::potential::cuboid::block::PairEnergy;
use crate::units::MU0;

/// Magnets closer than this (m) count as coinciding.
const COINCIDING: f64 = 1e-12;

/// A magnet with its shield.
#[derive(Clone, Copy, Debug)]
pub(super) struct Magnet {
    pub position: Vector2<f64>,
    pub moment: Vector2<f64>,
    pub front: Front,
    pub face: usize,
}

impl Magnet {
    /// Placed at a configuration of that rotation.
    fn moved(&self, q: &Configuration, rotation: &Rotation2<f64>) -> Self {
        Self {
            position: q.position() + rotation * self.position,
            moment: rotation * self.moment,
            front: (self.front.0, rotation * self.front.1),
            ..*self
        }
    }

    /// As the kernel wants it: place, moment and normal, then the shield's A, 1 / l, 1 / delta and
    /// G, of which those of no shield give the factor 1.
    fn entries(&self) -> [f64; COLUMNS] {
        let (shield, normal) = self.front;
        let [a, l, delta, gain] = shield.map_or([0.0, 1.0, 1.0, 1.0], |s| {
            [s.attenuation, 1.0 / s.length, 1.0 / s.width, s.front_gain]
        });
        let (p, m, n) = (self.position, self.moment, normal);
        [p.x, p.y, m.x, m.y, n.x, n.y, a, l, delta, gain]
    }
}

const COLUMNS: usize = 10;

/// Magnets as a structure of arrays, filled up to whole vectors with magnets of no moment far away.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    entries: [Vec<f64>; COLUMNS],
    faces: Vec<usize>,
}

impl Columns {
    pub fn new(magnets: &[Magnet], width: usize) -> Self {
        let rows: Vec<_> = magnets.iter().map(Magnet::entries).collect();
        let far = [1e6, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let length = rows.len().next_multiple_of(width);
        Self {
            entries: std::array::from_fn(|k| {
                let column = rows.iter().chain(std::iter::repeat(&far));
                column.map(|row| row[k]).take(length).collect()
            }),
            faces: magnets.iter().map(|magnet| magnet.face).collect(),
        }
    }

    /// Length of the arrays.
    pub fn len(&self) -> usize {
        self.entries[0].len()
    }
}

/// Vectors of magnets.
#[derive(Clone, Copy)]
struct Vectors<F> {
    place: [F; 2],
    moment: [F; 2],
    normal: [F; 2],
    shield: [F; 4],
}

impl<F: Copy> Vectors<F> {
    #[inline(always)]
    fn load<L: Lanes<F = F>>(l: L, columns: &Columns, from: usize) -> Self {
        let [px, py, mx, my, nx, ny, a, length, width, gain] = &columns.entries;
        Self {
            place: [l.load(&px[from..]), l.load(&py[from..])],
            moment: [l.load(&mx[from..]), l.load(&my[from..])],
            normal: [l.load(&nx[from..]), l.load(&ny[from..])],
            shield: [
                l.load(&a[from..]),
                l.load(&length[from..]),
                l.load(&width[from..]),
                l.load(&gain[from..]),
            ],
        }
    }

    #[inline(always)]
    fn splat<L: Lanes<F = F>>(l: L, magnet: &Magnet) -> Self {
        let [px, py, mx, my, nx, ny, a, length, width, gain] = magnet.entries();
        Self {
            place: [l.splat(px), l.splat(py)],
            moment: [l.splat(mx), l.splat(my)],
            normal: [l.splat(nx), l.splat(ny)],
            shield: [l.splat(a), l.splat(length), l.splat(width), l.splat(gain)],
        }
    }
}

/// Energies of pairs: that of the fixed magnet i and the moving magnet j is number
/// `j * stride + i`, with the stride of the fixed magnets' columns.
#[derive(Clone, Debug)]
pub(super) struct PairColumns {
    /// Energy (J), its gradient by the second magnet's place (J/m), its derivative by that
    /// magnet's angle (J/rad).
    entries: [Vec<f64>; 4],
}

impl PairColumns {
    /// Of pairs in the same order with `fixed` of them to each moving magnet.
    pub fn new(pairs: &[PairEnergy], fixed: usize, stride: usize) -> Self {
        let moving = pairs.len().checked_div(fixed).unwrap_or(0);
        let mut entries = [(); 4].map(|()| vec![0.0; moving * stride]);
        for (k, pair) in pairs.iter().enumerate() {
            let at = k / fixed * stride + k % fixed;
            let row = [pair.energy, pair.gradient.x, pair.gradient.y, pair.slope];
            for (column, entry) in entries.iter_mut().zip(row) {
                column[at] = entry;
            }
        }
        Self { entries }
    }
}

/// The energy (J) of all pairs, each times its factor, and its gradient where asked for (else it
/// is zero). Not finite where dipoles coincide.
pub(super) struct Sum<'a, const SLOPE: bool> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub q: &'a Configuration,
    /// Energies of pairs of blocks; point dipoles without.
    pub pairs: Option<&'a PairColumns>,
    /// The only faces whose magnets act, if not all do.
    pub faces: Option<(usize, usize)>,
}

impl<const SLOPE: bool> Task for Sum<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mask: Vec<f64> = (0..self.fixed.len())
            .map(|i| {
                let face = self.fixed.faces.get(i);
                f64::from(self.faces.is_none_or(|(first, _)| face == Some(&first)))
            })
            .collect();
        let rotation = self.q.rotation();
        let mut sums = [l.splat(0.0); 4];
        let mut closest = f64::INFINITY;
        for (j, magnet) in self.moving.iter().enumerate() {
            if self.faces.is_some_and(|(_, second)| magnet.face != second) {
                continue;
            }
            let moved = magnet.moved(self.q, &rotation);
            let second = Vectors::splat(l, &moved);
            let arm = moved.position - self.q.position();
            for from in (0..self.fixed.len()).step_by(L::WIDTH) {
                let first = Vectors::load(l, self.fixed, from);
                let way = Way::new(l, &first, &second);
                closest = closest.min(l.least(way.square));
                let w = pair_factor::<L, SLOPE>(l, &first, &second, &way);
                let u = match self.pairs {
                    None => dipoles::<L, SLOPE>(l, &first, &second, &way),
                    Some(pairs) => {
                        let [energy, gx, gy, slope] = &pairs.entries;
                        let at = j * self.fixed.len() + from;
                        [
                            l.load(&energy[at..]),
                            l.load(&gx[at..]),
                            l.load(&gy[at..]),
                            l.load(&slope[at..]),
                        ]
                    }
                };
                let mask = l.load(&mask[from..]);
                let (w0, u0) = (l.mul(mask, w[0]), l.mul(mask, u[0]));
                sums[0] = l.mul_add(w0, u[0], sums[0]);
                if SLOPE {
                    let gx = l.mul_add(w0, u[1], l.mul(u0, w[1]));
                    let gy = l.mul_add(w0, u[2], l.mul(u0, w[2]));
                    let turn = l.mul_add(w0, u[3], l.mul(u0, w[3]));
                    let turn = l.mul_add(l.splat(arm.x), gy, turn);
                    let turn = l.neg_mul_add(l.splat(arm.y), gx, turn);
                    sums[1] = l.add(sums[1], gx);
                    sums[2] = l.add(sums[2], gy);
                    sums[3] = l.add(sums[3], turn);
                }
            }
        }
        if self.pairs.is_none() && closest <= COINCIDING * COINCIDING {
            return (f64::INFINITY, Vector3::zeros());
        }
        let gradient = Vector3::new(l.sum(sums[1]), l.sum(sums[2]), l.sum(sums[3]));
        (l.sum(sums[0]), gradient)
    }
}

/// The way from a first magnet to a second one.
#[derive(Clone, Copy)]
struct Way<F> {
    square: F,
    /// One over the distance (1/m), and the distance (m).
    inverse: F,
    distance: F,
    /// Unit vector.
    direction: [F; 2],
}

impl<F: Copy> Way<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L, first: &Vectors<F>, second: &Vectors<F>) -> Self {
        let x = l.sub(second.place[0], first.place[0]);
        let y = l.sub(second.place[1], first.place[1]);
        let square = l.mul_add(x, x, l.mul(y, y));
        let least = l.splat(COINCIDING * COINCIDING);
        let square = l.select(l.sub(square, least), square, least);
        let inverse = l.reciprocal_sqrt(square);
        Self {
            square,
            inverse,
            distance: l.mul(square, inverse),
            direction: [l.mul(x, inverse), l.mul(y, inverse)],
        }
    }
}

#[inline(always)]
fn dot<L: Lanes>(l: L, a: [L::F; 2], b: [L::F; 2]) -> L::F {
    l.mul_add(a[0], b[0], l.mul(a[1], b[1]))
}

/// Energy of two dipoles (J), its gradient by the second one's place and its derivative by the
/// second one's angle: see `dipole::pair`.
#[inline(always)]
fn dipoles<L: Lanes, const SLOPE: bool>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
) -> [L::F; 4] {
    let (m1, m2, d) = (first.moment, second.moment, way.direction);
    let (along1, along2) = (dot(l, m1, d), dot(l, m2, d));
    let both = l.mul(along1, along2);
    let together = dot(l, m1, m2);
    let cube = l.mul(way.inverse, l.mul(way.inverse, way.inverse));
    let scale = l.mul(l.splat(MU0 / (4.0 * std::f64::consts::PI)), cube);
    let energy = l.mul(scale, l.neg_mul_add(l.splat(3.0), both, together));
    let zero = l.splat(0.0);
    if !SLOPE {
        return [energy, zero, zero, zero];
    }
    let radial = l.neg_mul_add(l.splat(5.0), both, together);
    let steep = l.mul(l.mul(l.splat(-3.0), scale), way.inverse);
    let x = l.mul_add(along1, m2[0], l.mul_add(along2, m1[0], l.mul(radial, d[0])));
    let y = l.mul_add(along1, m2[1], l.mul_add(along2, m1[1], l.mul(radial, d[1])));
    let turned = [l.sub(zero, m2[1]), m2[0]];
    let slope = l.neg_mul_add(
        l.mul(l.splat(3.0), along1),
        dot(l, turned, d),
        dot(l, m1, turned),
    );
    [
        energy,
        l.mul(steep, x),
        l.mul(steep, y),
        l.mul(scale, slope),
    ]
}

/// A factor g and its derivatives by the distance (1/m) and by cos(alpha): see
/// [`super::Shield::factor`].
#[inline(always)]
fn factor<L: Lanes, const SLOPE: bool>(
    l: L,
    shield: [L::F; 4],
    distance: L::F,
    cosine: L::F,
) -> [L::F; 3] {
    let [attenuation, length, width, gain] = shield;
    let (zero, one) = (l.splat(0.0), l.splat(1.0));
    let ratio = l.mul(distance, length);
    let share = l.div(one, l.mul_add(ratio, ratio, one));
    let loss = l.mul(attenuation, share);
    let eta = l.sub(one, loss);
    let gap = l.sub(gain, eta);
    let [front, slope] = logistic(l, l.mul(cosine, width));
    let value = l.mul_add(gap, front, eta);
    if !SLOPE {
        return [value, zero, zero];
    }
    let eta_slope = l.mul(
        l.mul(l.splat(2.0), loss),
        l.mul(l.mul(ratio, length), share),
    );
    [
        value,
        l.mul(eta_slope, l.sub(one, front)),
        l.mul(l.mul(gap, slope), width),
    ]
}

/// The factor of pairs, its gradient by the second magnets' places (1/m) and its derivative by
/// their angles: see [`super::pair_factor`].
#[inline(always)]
fn pair_factor<L: Lanes, const SLOPE: bool>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
) -> [L::F; 4] {
    let zero = l.splat(0.0);
    let d = way.direction;
    let (n1, n2) = (
        first.normal,
        [l.sub(zero, second.normal[0]), l.sub(zero, second.normal[1])],
    );
    let (c1, c2) = (dot(l, n1, d), dot(l, n2, d));
    let [a, a_distance, a_cosine] = factor::<L, SLOPE>(l, first.shield, way.distance, c1);
    let [b, b_distance, b_cosine] = factor::<L, SLOPE>(l, second.shield, way.distance, c2);
    let value = l.mul(a, b);
    if !SLOPE {
        return [value, zero, zero, zero];
    }
    // By the distance, and by the two cosines, whose gradients are (n - d c) / r.
    let by_distance = l.mul_add(a_distance, b, l.mul(b_distance, a));
    let by_first = l.mul(l.mul(a_cosine, b), way.inverse);
    let by_second = l.mul(l.mul(b_cosine, a), way.inverse);
    let along = l.mul_add(by_first, c1, l.mul(by_second, c2));
    let along = l.sub(by_distance, along);
    let x = l.mul_add(by_first, n1[0], l.mul(by_second, n2[0]));
    let y = l.mul_add(by_first, n1[1], l.mul(by_second, n2[1]));
    // A turn of the second magnet turns -n2 to its left.
    let turned = [l.sub(zero, n2[1]), n2[0]];
    [
        value,
        l.mul_add(along, d[0], x),
        l.mul_add(along, d[1], y),
        l.mul(l.mul(a, b_cosine), dot(l, turned, d)),
    ]
}

/// Halvings of the exponential's argument.
const HALVINGS: usize = 7;

/// Arguments of the logistic function are as good as infinite from here on.
const LARGEST: f64 = 60.0;

/// `S(t) = 1 / (1 + exp(-t))` and its derivative, to 3e-14.
///
/// `exp(-|t|)` is the 128th power of `exp(-|t| / 128)`, whose Taylor series of degree 12 is right
/// to 1e-14 and better where the power is not as good as 0.
#[inline(always)]
fn logistic<L: Lanes>(l: L, t: L::F) -> [L::F; 2] {
    let (zero, one) = (l.splat(0.0), l.splat(1.0));
    let size = l.select(t, t, l.sub(zero, t));
    let size = l.min(size, l.splat(LARGEST));
    let x = l.mul(size, l.splat(-1.0 / (1 << HALVINGS) as f64));
    let mut e = one;
    for k in (1..=12).rev() {
        e = l.mul_add(l.mul(e, x), l.splat(1.0 / f64::from(k)), one);
    }
    for _ in 0..HALVINGS {
        e = l.mul(e, e);
    }
    let share = l.div(one, l.add(one, e));
    let tail = l.mul(e, share);
    [l.select(t, share, tail), l.mul(share, tail)]
}

/// The sum over all pairs of `|w| |u''| + 2 |w'| |u'| + |w''| |u|` (J/m^2) along motions in which
/// no magnet is faster than 1 and none turns at more than the rate `turn` (1/m), with bounds of the
/// derivatives of energies u and factors w within `reach` (m). Infinite where magnets may meet.
pub(super) struct Curvature<'a> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub q: &'a Configuration,
    pub turn: f64,
    pub reach: f64,
    /// Bounds of |u|, |u'| and |u''| of blocks, numbered as the pairs' energies; point dipoles
    /// without.
    pub pairs: Option<&'a [Vec<f64>; 3]>,
}

impl Task for Curvature<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let rotation = self.q.rotation();
        let mut sum = l.splat(0.0);
        let turn = l.splat(self.turn);
        for (j, magnet) in self.moving.iter().enumerate() {
            let second = Vectors::splat(l, &magnet.moved(self.q, &rotation));
            for from in (0..self.fixed.len()).step_by(L::WIDTH) {
                let first = Vectors::load(l, self.fixed, from);
                let way = Way::new(l, &first, &second);
                let r = l.sub(way.distance, l.splat(self.reach));
                if l.least(r) <= COINCIDING {
                    return f64::INFINITY;
                }
                let inverse = l.reciprocal(r);
                let u = match self.pairs {
                    None => dipole_limits(l, &first, &second, turn, inverse),
                    Some([energy, slope, bend]) => {
                        let at = j * self.fixed.len() + from;
                        [
                            l.load(&energy[at..]),
                            l.load(&slope[at..]),
                            l.load(&bend[at..]),
                        ]
                    }
                };
                let a = factor_limits(l, first.shield, turn, r, inverse);
                let b = factor_limits(l, second.shield, turn, r, inverse);
                let two = l.splat(2.0);
                let w0 = l.mul(a[0], b[0]);
                let w1 = l.mul_add(a[1], b[0], l.mul(a[0], b[1]));
                let w2 = l.mul_add(a[2], b[0], l.mul(a[0], b[2]));
                let w2 = l.mul_add(l.mul(two, a[1]), b[1], w2);
                sum = l.mul_add(w0, u[2], sum);
                sum = l.mul_add(l.mul(two, w1), u[1], sum);
                sum = l.mul_add(w2, u[0], sum);
            }
        }
        l.sum(sum)
    }
}

/// Bounds of the energy of dipoles and its first and second derivatives: see
/// `Limits::derivative`.
#[inline(always)]
fn dipole_limits<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    turn: L::F,
    inverse: L::F,
) -> [L::F; 3] {
    let squares = l.mul(
        dot(l, first.moment, first.moment),
        dot(l, second.moment, second.moment),
    );
    let k = l.mul(l.splat(MU0 / (4.0 * std::f64::consts::PI)), l.sqrt(squares));
    let cube = l.mul(k, l.mul(inverse, l.mul(inverse, inverse)));
    let energy = l.mul(l.splat(2.0), cube);
    let slope = l.mul_add(l.splat(6.0), inverse, l.mul(l.splat(2.0), turn));
    let bend = l.mul_add(l.splat(24.0), inverse, l.mul(l.splat(18.0), turn));
    let bend = l.mul_add(bend, inverse, l.mul(l.mul(l.splat(2.0), turn), turn));
    [energy, l.mul(cube, slope), l.mul(cube, bend)]
}

/// Bounds of the magnitudes of g and of its first and second derivatives along a motion with a
/// speed of the magnets of at most 1, at a rate of turn of at most `turn` (1/m), while they are at
/// least `r` (m) apart.
///
/// With `x = r / l`: `|d eta / d r|` is at most the smaller of `0.65 A / l` and `2 A / (l x^3)` (the
/// largest of `2 x / (1 + x^2)^2` is 3 sqrt(3) / 8). The Hessian of eta over the plane has the
/// eigenvalues `d2 eta / d r2` and `(d eta / d r) / r`, both at most the smaller of `2 A / l^2` and
/// `6 A / (l^2 x^4)`; the magnets' acceleration, at most `turn`, adds that times the slope.
/// `|S'| <= 1/4`, `|S''| <= 1 / (6 sqrt(3))`, and with `w = 1 / r + turn` the cosine of an angle that
/// turns at most at the rate w has a second derivative of at most
/// `w^2 + 2 / r^2 + turn / r + turn^2`.
#[inline(always)]
fn factor_limits<L: Lanes>(
    l: L,
    shield: [L::F; 4],
    turn: L::F,
    r: L::F,
    inverse: L::F,
) -> [L::F; 3] {
    let [attenuation, length, width, gain] = shield;
    let (zero, one) = (l.splat(0.0), l.splat(1.0));
    let x = l.mul(r, length);
    let x2 = l.mul(x, x);
    let share = l.div(one, l.add(one, x2));
    let excess = l.sub(gain, one);
    let excess = l.select(excess, excess, l.sub(zero, excess));
    let gap = l.mul_add(attenuation, share, excess);
    let over = l.reciprocal(x);
    let cube = l.mul(over, l.mul(over, over));
    let steep = l.min(l.mul(l.splat(2.0), cube), l.splat(0.65));
    let bent = l.min(l.mul(l.mul(l.splat(6.0), cube), over), l.splat(2.0));
    let scale = l.mul(attenuation, length);
    let slope = l.mul(scale, steep);
    let hessian = l.mul_add(l.mul(scale, length), bent, l.mul(turn, slope));
    let rate = l.add(inverse, turn);
    let rate2 = l.mul(rate, rate);
    let bend = l.mul_add(l.splat(2.0), l.mul(inverse, inverse), rate2);
    let bend = l.mul_add(turn, rate, bend);
    let quarter = l.mul(width, l.splat(0.25));
    let front1 = l.mul(rate, quarter);
    let front2 = l.mul(l.mul(rate2, l.splat(1.0 / 10.3)), l.mul(width, width));
    let front2 = l.mul_add(bend, quarter, front2);
    // The larger of 1, |G| and |1 - A|.
    let most = l.min(l.min(l.splat(-1.0), l.sub(zero, gain)), gain);
    let back = l.sub(one, attenuation);
    let most = l.min(l.min(most, l.sub(zero, back)), back);
    [
        l.sub(zero, most),
        l.mul_add(gap, front1, slope),
        l.mul_add(
            gap,
            front2,
            l.mul_add(l.mul(l.splat(2.0), slope), front1, hessian),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::{Shield, logistic as scalar_logistic, pair_factor as scalar_factor};
    use super::*;
    use crate::potential::batch::Level;
    use crate::potential::batch::lanes::MAX_WIDTH;
    use crate::potential::dipole;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn turned(angle: f64) -> Vector2<f64> {
        Vector2::new(angle.cos(), angle.sin())
    }

    fn random_magnets(rng: &mut ChaCha8Rng, count: usize) -> Vec<Magnet> {
        let mut magnet = |k: usize| Magnet {
            position: turned(rng.random_range(-3.1..3.1)) * rng.random_range(0.01..0.06),
            moment: turned(rng.random_range(-3.1..3.1)) * 0.3,
            front: (
                (!k.is_multiple_of(3)).then(|| Shield {
                    attenuation: rng.random_range(0.0..1.0),
                    length: rng.random_range(0.01..0.1),
                    width: 10f64.powf(rng.random_range(-3.0..0.0)),
                    front_gain: rng.random_range(0.8..1.3),
                }),
                turned(rng.random_range(-3.1..3.1)),
            ),
            face: k,
        };
        (0..count).map(&mut magnet).collect()
    }

    #[test]
    fn the_sum_is_that_of_the_plain_formulas() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for level in Level::available() {
            for _ in 0..50 {
                let (fixed, moving) = (random_magnets(&mut rng, 5), random_magnets(&mut rng, 3));
                let place = turned(rng.random_range(-3.1..3.1)) * rng.random_range(0.15..0.3);
                let q = Configuration::new(place.x, place.y, rng.random_range(-3.1..3.1));
                let (mut energy, mut gradient) = (0.0, Vector3::zeros());
                let mut size = 0.0;
                for second in moving.iter().map(|magnet| magnet.moved(&q, &q.rotation())) {
                    for first in &fixed {
                        let r = second.position - first.position;
                        let (u, force, slope) = dipole::pair(first.moment, second.moment, r);
                        let w = scalar_factor(first.front, second.front, r);
                        let place = w.gradient * u - force * w.value;
                        let arm = second.position - q.position();
                        let turn = w.slope * u + slope * w.value + arm.perp(&place);
                        energy += w.value * u;
                        gradient += Vector3::new(place.x, place.y, turn);
                        size += u.abs() + place.norm() + turn.abs();
                    }
                }
                let columns = Columns::new(&fixed, level.width());
                let (got, slope) = level.run(Sum::<true> {
                    fixed: &columns,
                    moving: &moving,
                    q: &q,
                    pairs: None,
                    faces: None,
                });
                assert!(
                    (got - energy).abs() < 1e-12 * size,
                    "{level}: {got} {energy}"
                );
                assert!((slope - gradient).norm() < 1e-11 * size, "{level}");
                let only = level.run(Sum::<false> {
                    fixed: &columns,
                    moving: &moving,
                    q: &q,
                    pairs: None,
                    faces: None,
                });
                assert!((only.0 - got).abs() < 1e-13 * size, "{level}");
            }
        }
    }

    /// S and its derivative at several arguments.
    struct Logistics([f64; MAX_WIDTH]);

    impl Task for Logistics {
        type Output = [[f64; MAX_WIDTH]; 2];

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let mut out = [[0.0; MAX_WIDTH]; 2];
            for from in (0..MAX_WIDTH).step_by(L::WIDTH) {
                let [value, slope] = logistic(l, l.load(&self.0[from..]));
                l.store(value, &mut out[0][from..]);
                l.store(slope, &mut out[1][from..]);
            }
            out
        }
    }

    #[test]
    fn the_logistic_function_is_that_of_the_standard_library() {
        for level in Level::available() {
            for k in 0..4000 {
                let t = std::array::from_fn(|i| 0.004 * f64::from(8 * k + i as i32) - 64.0);
                let [values, slopes] = level.run(Logistics(t));
                for i in 0..MAX_WIDTH {
                    let exact = scalar_logistic(t[i]);
                    assert!((values[i] - exact).abs() < 3e-14, "{level} {}", t[i]);
                    assert!((slopes[i] - exact * (1.0 - exact)).abs() < 3e-14, "{level}");
                }
            }
        }
    }

    /// Bounds of a factor and of its derivatives.
    struct Bounds(Magnet, f64, f64);

    impl Task for Bounds {
        type Output = [f64; 3];

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> [f64; 3] {
            let Self(magnet, turn, r) = self;
            let shield = Vectors::splat(l, &magnet).shield;
            let (turn, r, inverse) = (l.splat(turn), l.splat(r), l.splat(1.0 / r));
            let [value, slope, bend] = factor_limits(l, shield, turn, r, inverse);
            [l.first(value), l.first(slope), l.first(bend)]
        }
    }

    #[test]
    fn factors_stay_within_their_bounds() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        for magnet in random_magnets(&mut rng, 400) {
            let Some(shield) = magnet.front.0.filter(|shield| shield.width > 0.03) else {
                continue;
            };
            let (r, turn, step) = (turned(rng.random_range(-3.1..3.1)) * 0.05, 5.0, 1e-4);
            // The other magnet moves one way and this one's face turns.
            let way = turned(rng.random_range(-3.1..3.1));
            let angle = rng.random_range(-3.1..3.1);
            let at = |s: f64| {
                let place = r + way * s;
                let cosine = turned(angle + turn * s).dot(&place) / place.norm();
                shield.factor(place.norm(), cosine).value
            };
            let first = (at(step) - at(-step)) / (2.0 * step);
            let second = (at(step) - 2.0 * at(0.0) + at(-step)) / (step * step);
            let [g0, g1, g2] = Level::best().run(Bounds(magnet, turn, 0.05 - 2.0 * step));
            assert!(at(0.0) <= g0 && first.abs() <= g1, "{shield:?}");
            assert!(
                second.abs() <= g2 * (1.0 + 1e-3),
                "{shield:?} {second} {g2}"
            );
        }
    }
}
