//! The pairs of a cell that are bounded by Taylor's theorem.

use nalgebra::{Rotation2, Vector2};

use super::curvature::{Around, DerivativeLimits, dipole_limits, pair_limits, product};
use super::jet::{Jet, PlaneJet, dipoles};
use super::{Columns, Magnet, Vectors, Way};
use crate::cell::{Cell, Quadratic};
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Pairs closer than this many times the magnet's reach have no form.
const NEAR: f64 = 2.0;

/// The smallest such distance (m).
const TINY: f64 = 1e-9;

/// Relative error of the energy and the factor of a pair, and of the effect of a gradient over a
/// cell: about a hundred operations accurate to 1e-13 or better.
const ROUNDING: f64 = 2e-11;

/// Rounding of a place, as a fraction of the largest coordinate.
const PLACING: f64 = 1e-14;

/// This (m) is added to a magnet's distance from its tile's reference point, because a magnet at
/// that point turns although it does not move.
const LEAST_LEVER: f64 = 1e-3;

impl Magnet {
    /// The displacement (m) that a turn of one radian counts as.
    pub fn lever(&self) -> f64 {
        self.position.norm() + LEAST_LEVER
    }
}

/// Sums up the energies of the pairs of shielded dipoles as forms of second order about the cell's
/// centre, and bounds the forms' remainders.
///
/// On the straight motion from the centre to a configuration of the cell a magnet's speed is at
/// most its reach V, and it turns at most at the rate W, half the cell's angle. Scaled to a speed
/// of at most 1 it turns at the rate W / V, so that [`dipole_limits`] and [`pair_limits`], taken at
/// the distance `r - V`, bound the third derivative of the energy u times the factor w along the
/// motion, and the form's error is at most
///
/// ```text
/// V^3 / 6 [|w| |u'''| + 3 |w'| |u''| + 3 |w''| |u'| + |w'''| |u|]
/// ```
///
/// Pairs for which this exceeds the energy's own range, `2 |w| |u|`, get no form: their indices
/// (fixed, moving) are appended to `rest`.
pub(in crate::potential) struct Forms<'a> {
    pub pairs: Pairs<'a>,
    pub rest: &'a mut Vec<(usize, usize)>,
}

/// The pairs of magnets over a cell.
pub(in crate::potential) struct Pairs<'a> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub cell: &'a Cell,
    /// Number of fixed magnets, and the farthest one's distance from the origin (m).
    pub count: usize,
    pub extent: f64,
}

/// A moving magnet over a cell.
struct Moved<F> {
    /// At the cell's centre, and from the tile's reference point (m).
    vectors: Vectors<F>,
    arm: Vector2<f64>,
    /// The largest distance (m) that it moves and angle (rad) that it turns.
    speed: f64,
    turn: f64,
    /// The rounding of its place (m).
    placing: f64,
}

impl Pairs<'_> {
    #[inline(always)]
    fn moved<L: Lanes>(&self, l: L, magnet: &Magnet, rotation: &Rotation2<f64>) -> Moved<L::F> {
        let q = &self.cell.centre;
        let lever = magnet.lever();
        let moved = magnet.moved(q, rotation);
        Moved {
            vectors: Vectors::splat(l, &moved),
            arm: moved.position - q.position(),
            speed: self.cell.reach(lever).max(f64::MIN_POSITIVE.sqrt()),
            turn: self.cell.half[2],
            placing: PLACING * (self.extent + q.x.abs() + q.y.abs() + lever + 1.0),
        }
    }
}

/// The form, and the bound of its remainder (J).
pub(in crate::potential) type BoundedForm = (Quadratic, f64);

impl Task for Forms<'_> {
    type Output = BoundedForm;

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> BoundedForm {
        let rotation = self.pairs.cell.centre.rotation();
        let pairs = (self.pairs.count * self.pairs.moving.len()) as f64;
        let rounding = ROUNDING + 16.0 * pairs * f64::EPSILON;
        let (zero, one) = (l.splat(0.0), l.splat(1.0));
        let mut form = Quadratic::default();
        let mut all_left_out = zero;
        for (j, magnet) in self.pairs.moving.iter().enumerate() {
            let moved = self.pairs.moved(l, magnet, &rotation);
            let second = &moved.vectors;
            let v = l.splat(moved.speed);
            let mut sums = [zero; 10];
            for from in (0..self.pairs.fixed.len()).step_by(WIDTH) {
                let first = Vectors::load(l, self.pairs.fixed, from);
                let way = Way::new(l, &first, second);
                let near = Near::new(l, &first, &moved, &way);
                let u = dipoles(l, &first, second, &way);
                let Around { turn, inverse, .. } = near.around;
                let mut of_u = dipole_limits(l, &first, second, turn, inverse);
                of_u[0] = l.min(of_u[0], l.mul_add(of_u[1], v, l.abs(u.0[0])));
                let [whole, slope, bend, twist] = product(l, near.limits, of_u);
                let left_out = l.mul(
                    l.splat(moved.speed * moved.speed * moved.speed / 6.0),
                    twist,
                );
                // Negative if there is no form.
                let worth = l.sub(l.mul(l.splat(2.0), whole), left_out);
                let mask = l.select(l.min(near.room, worth), one, zero);
                self.note_rest(l, mask, j, from);

                let pair = near.factor.times(l, &u).by_place(l, &way);
                for (sum, entry) in sums.iter_mut().zip(pair) {
                    *sum = l.mul_add(mask, entry, *sum);
                }
                let first_order = l.mul_add(slope, v, whole);
                let relative = l.mul_add(l.mul(bend, v), v, first_order);
                let placed = l.mul_add(l.mul(twist, v), v, l.mul_add(bend, v, slope));
                let error = l.mul(l.splat(rounding), relative);
                let error = l.mul_add(l.splat(moved.placing), placed, error);
                all_left_out = l.mul_add(mask, l.add(left_out, error), all_left_out);
            }
            let mut place = [0.0; 10];
            for (entry, sum) in place.iter_mut().zip(sums) {
                *entry = l.sum(sum);
            }
            form = form.minus(-1.0, &turned(place, moved.arm));
        }
        (form, l.sum(all_left_out))
    }
}

/// The factor of pairs of magnets over a cell.
struct Near<F> {
    /// The factor at the cell's centre, and the bounds of it within the cell.
    factor: Jet<F>,
    limits: DerivativeLimits<F>,
    around: Around<F>,
    /// Negative if the magnets are too close to each other for these to hold.
    room: F,
}

impl<F: Copy> Near<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L, first: &Vectors<F>, second: &Moved<F>, way: &Way<F>) -> Self {
        let speed = second.speed;
        let room = l.sub(way.distance, l.splat(NEAR * speed + TINY));
        let r = l.select(room, l.sub(way.distance, l.splat(speed)), l.splat(1.0));
        let around = Around {
            reach: l.splat(speed),
            turn: l.splat(second.turn / speed),
            r,
            inverse: l.reciprocal(r),
        };
        let second = &second.vectors;
        let (factor, limits) = pair_limits(l, first, second, way, &around);
        Self {
            factor,
            limits,
            around,
            room,
        }
    }
}

/// The factors of all pairs over a cell, those of the first moving magnet first, as forms of second
/// order.
pub(in crate::potential) struct Factors<'a>(pub Pairs<'a>);

/// A factor over a cell.
pub(in crate::potential) struct FactorForm {
    pub form: Quadratic,
    /// Bound of the form's remainder, rounding included; infinite if the magnets are too close to
    /// each other.
    pub left_out: f64,
    /// The largest magnitude, and the largest change on a motion over half the cell.
    pub size: f64,
    pub change: f64,
}

impl Task for Factors<'_> {
    type Output = Vec<FactorForm>;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Vec<FactorForm> {
        let Self(pairs) = self;
        let rotation = pairs.cell.centre.rotation();
        let mut out = Vec::with_capacity(pairs.count * pairs.moving.len());
        for magnet in pairs.moving {
            let moved = pairs.moved(l, magnet, &rotation);
            let Moved { speed, placing, .. } = moved;
            for from in (0..pairs.count).step_by(WIDTH) {
                let first = Vectors::load(l, pairs.fixed, from);
                let way = Way::new(l, &first, &moved.vectors);
                let near = Near::new(l, &first, &moved, &way);
                let place = near.factor.by_place(l, &way).map(|entry| stored(l, entry));
                let limits = near.limits.map(|limit| stored(l, limit));
                let room = stored(l, near.room);
                for k in 0..WIDTH.min(pairs.count - from) {
                    let [size, slope, bend, twist] = limits.map(|limit| limit[k]);
                    let change = slope * speed;
                    let bend = bend * speed * speed;
                    let twist = twist * speed * speed * speed;
                    let rounding = ROUNDING * (size + change + bend)
                        + placing / speed * (change + bend + twist);
                    let known = if room[k] > 0.0 { 0.0 } else { f64::INFINITY };
                    out.push(FactorForm {
                        form: turned(place.map(|entry| entry[k]), moved.arm),
                        left_out: known + twist / 6.0 + rounding,
                        size,
                        change,
                    });
                }
            }
        }
        out
    }
}

#[inline(always)]
fn stored<L: Lanes>(l: L, lanes: L::F) -> [f64; WIDTH] {
    let mut out = [0.0; WIDTH];
    l.store(lanes, &mut out);
    out
}

/// The form by the tile's x, y and theta of a magnet at the end of `arm` whose energy has these
/// derivatives by its place and its turn.
fn turned(place: PlaneJet<f64>, arm: Vector2<f64>) -> Quadratic {
    let [value, x, y, t, xx, yy, tt, xy, xt, yt] = place;
    // A turn moves the magnet along this direction, and accelerates it along minus the arm.
    let (dx, dy) = (-arm.y, arm.x);
    let bend = xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy;
    Quadratic {
        value,
        gradient: [x, y, t + x * dx + y * dy],
        hessian: [
            xx,
            yy,
            tt + 2.0 * (xt * dx + yt * dy) + bend - x * arm.x - y * arm.y,
            xy,
            xt + xx * dx + xy * dy,
            yt + xy * dx + yy * dy,
        ],
    }
}

impl Forms<'_> {
    #[inline(always)]
    fn note_rest<L: Lanes>(&mut self, l: L, mask: L::F, j: usize, from: usize) {
        if l.least(mask) > 0.0 {
            return;
        }
        let mut lanes = [0.0; WIDTH];
        l.store(mask, &mut lanes);
        let end = self.pairs.count.min(from + WIDTH);
        let near = (from..end).filter(|i| lanes[i - from] == 0.0);
        self.rest.extend(near.map(|i| (i, j)));
    }
}
