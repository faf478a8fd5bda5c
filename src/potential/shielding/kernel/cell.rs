//! The pairs of a cell that Taylor's theorem bounds.

use nalgebra::Vector3;

use super::curvature::{dipole_limits, pair_limits};
use super::factor::pair_factor;
use super::{Columns, Magnet, Vectors, Way, dipoles, product_gradient};
use crate::cell::Cell;
use crate::potential::batch::lanes::{Lanes, MAX_WIDTH, Task};

/// Pairs closer than this many times the magnet's reach have no form.
const NEAR: f64 = 2.0;

/// The same in any case (m).
const TINY: f64 = 1e-9;

/// Relative error of the energy and the factor of a pair, and of what a gradient does over a cell:
/// some hundred operations right to 1e-13 or better.
const ROUNDING: f64 = 2e-11;

/// Rounding of a place, as a share of the largest coordinate.
const PLACING: f64 = 1e-14;

/// The magnets turn as if this (m) were added to the distance from their tile's reference point,
/// for a magnet there does not move but turns.
const LEAST_LEVER: f64 = 1e-3;

/// Sums up the energies, and their gradients, of the pairs of shielded dipoles that have a
/// first-order form about the cell's centre, and bounds what the forms leave out.
///
/// On the straight way from the centre to a configuration of the cell a magnet is at most as fast
/// as its reach V and turns at half the cell's angle W. In units in which it is no faster than 1 it
/// turns at the rate W / V, so that [`dipole_limits`] and [`pair_limits`], taken at the distance
/// `r - V`, bound the second derivative along the way, and the form is wrong by at most
///
/// ```text
/// V^2 / 2 [|w| |u''| + 2 |w'| |u'| + |w''| |u|]
/// ```
///
/// Pairs for which this is more than the energy itself can be, `2 |w| |u|`, get no form: their
/// numbers (fixed, moving) are appended to `rest`.
pub(in crate::potential::shielding) struct Forms<'a> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub cell: &'a Cell,
    /// How many fixed magnets there are, and the farthest one's distance from the origin (m).
    pub count: usize,
    pub extent: f64,
    pub rest: &'a mut Vec<(usize, usize)>,
}

/// Value (J), gradient, and the bound of what they leave out (J).
pub(in crate::potential::shielding) type Form = (f64, Vector3<f64>, f64);

impl Task for Forms<'_> {
    type Output = Form;

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> Form {
        let q = &self.cell.centre;
        let rotation = q.rotation();
        let pairs = (self.count * self.moving.len()) as f64;
        let rounding = ROUNDING + 16.0 * pairs * f64::EPSILON;
        let zero = l.splat(0.0);
        let mut sums = [zero; 5];
        for (j, magnet) in self.moving.iter().enumerate() {
            let lever = magnet.position.norm() + LEAST_LEVER;
            let speed = self.cell.reach(lever).max(f64::MIN_POSITIVE.sqrt());
            let turn = l.splat(self.cell.half[2] / speed);
            let placing = PLACING * (self.extent + q.x.abs() + q.y.abs() + lever + 1.0);
            let moved = magnet.moved(q, &rotation);
            let second = Vectors::splat(l, &moved);
            let arm = moved.position - q.position();
            for from in (0..self.fixed.len()).step_by(L::WIDTH) {
                let first = Vectors::load(l, self.fixed, from);
                let way = Way::new(l, &first, &second);
                let room = l.sub(way.distance, l.splat(NEAR * speed + TINY));
                let one = l.splat(1.0);
                let r = l.select(room, l.sub(way.distance, l.splat(speed)), one);
                let inverse = l.reciprocal(r);
                let [u0, u1, u2] = dipole_limits(l, &first, &second, turn, inverse);
                let [w0, w1, w2] = pair_limits(l, &first, &second, turn, r, inverse);
                let two = l.splat(2.0);
                let w = pair_factor::<L, true>(l, &first, &second, &way);
                let u = dipoles::<L, true>(l, &first, &second, &way);
                // Behind a shield the factor is smaller than anywhere: as much as at the centre,
                // and what the way adds.
                let here = l.select(w[0], w[0], l.sub(zero, w[0]));
                let v = l.splat(speed);
                let w0 = l.min(w0, l.mul_add(w1, v, here));
                let size = l.mul(w0, u0);
                let slope = l.mul_add(w0, u1, l.mul(w1, u0));
                let bend = l.mul_add(w2, u0, l.mul(l.mul(two, w1), u1));
                let bend = l.mul_add(w0, u2, bend);
                let left_out = l.mul(l.splat(speed * speed / 2.0), bend);
                // Negative where there is no form.
                let worth = l.min(room, l.sub(l.mul(two, size), left_out));
                let mask = l.select(worth, one, zero);
                self.note_rest(l, mask, j, from);

                let (w0, u0) = (l.mul(mask, w[0]), l.mul(mask, u[0]));
                let [gx, gy, by_angle] = product_gradient(l, [w0, w[1], w[2], w[3]], u0, &u, arm);
                let relative = l.mul_add(slope, v, size);
                let placed = l.mul_add(bend, v, slope);
                let error = l.mul(l.splat(rounding), relative);
                let error = l.mul_add(l.splat(placing), placed, error);
                sums[0] = l.mul_add(w0, u[0], sums[0]);
                sums[1] = l.add(sums[1], gx);
                sums[2] = l.add(sums[2], gy);
                sums[3] = l.add(sums[3], by_angle);
                sums[4] = l.mul_add(mask, l.add(left_out, error), sums[4]);
            }
        }
        let gradient = Vector3::new(l.sum(sums[1]), l.sum(sums[2]), l.sum(sums[3]));
        (l.sum(sums[0]), gradient, l.sum(sums[4]))
    }
}

impl Forms<'_> {
    #[inline(always)]
    fn note_rest<L: Lanes>(&mut self, l: L, mask: L::F, j: usize, from: usize) {
        if l.least(mask) > 0.0 {
            return;
        }
        let mut lanes = [0.0; MAX_WIDTH];
        l.store(mask, &mut lanes);
        let end = self.count.min(from + L::WIDTH);
        let near = (from..end).filter(|i| lanes[i - from] == 0.0);
        self.rest.extend(near.map(|i| (i, j)));
    }
}
