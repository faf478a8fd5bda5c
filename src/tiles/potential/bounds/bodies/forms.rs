//! Forms of a pair's energy about the cell's centre: from its series, from derivatives of exact energies, or from
//! these and their slopes there and beside it.

use nalgebra::{Complex, Vector2};

use super::{A_TERM, AN_ENERGY, Pair, Sum};
use crate::cell::Quadratic;
use crate::potential::far::PairEnergy;
use crate::potential::far::derivatives::Derivatives;

/// By x, y and turn of the second magnet.
fn slopes(energy: &PairEnergy) -> [f64; 3] {
    [energy.gradient.x, energy.gradient.y, energy.slope]
}

impl Pair<'_> {
    /// Adds the form of this order, with value and gradient of this energy and derivatives of so many terms of the
    /// series.
    pub(super) fn add_series(
        &self,
        energy: &PairEnergy,
        order: usize,
        terms: usize,
        out: &mut Sum,
    ) {
        out.work += A_TERM * terms as u64;
        match order {
            1 => self.add_linear(energy, out),
            2 => self.add_quadratic(energy, &self.single.derivatives::<false>(terms), out),
            _ => self.add_form(energy, &self.single.derivatives::<true>(terms), out),
        }
    }

    /// Adds the form of first order.
    pub(super) fn add_linear(&self, energy: &PairEnergy, out: &mut Sum) {
        let hessian = [0.0; 6];
        let linear = self.in_cell(energy, hessian);
        out.form = out.form.minus(-1.0, &Quadratic { hessian, ..linear });
    }

    /// Adds the form of second order, with differences over a step (m).
    pub(super) fn add_second_order(&self, h: f64, out: &mut Sum) {
        out.work += 4 * AN_ENERGY;
        let still = &self.single.still();
        let turn = h / self.magnets[1].radius;
        let change = |there: &PairEnergy, step: f64| {
            let (there, here) = (slopes(there), slopes(still));
            [0, 1, 2].map(|k| (there[k] - here[k]) / step)
        };
        let [x, y] = self.single.moved([Vector2::x() * h, Vector2::y() * h], 0.0);
        let [t] = self.single.moved([Vector2::zeros()], turn);
        let second = [change(&x, h), change(&y, h), change(&t, turn)];
        out.form = out
            .form
            .minus(-1.0, &self.in_cell(still, symmetric(second)));
    }

    /// Adds the form of third order, with differences over a step (m) to both sides.
    pub(super) fn add_third_order(&self, h: f64, out: &mut Sum) {
        out.work += 8 * AN_ENERGY;
        let still = &self.single.still();
        let [x, y] = [Vector2::x() * h, Vector2::y() * h];
        let turn = h / self.magnets[1].radius;
        let [right, left, up, down, both] = self.single.moved([x, -x, y, -y, x + y], 0.0);
        let [on] = self.single.moved([Vector2::zeros()], turn);
        let [back] = self.single.moved([Vector2::zeros()], -turn);
        let here = slopes(still);
        let sides = [(&right, &left, h), (&up, &down, h), (&on, &back, turn)];
        let first = sides.map(|(more, less, step)| {
            let [more, less] = [slopes(more), slopes(less)];
            [0, 1, 2].map(|k| (more[k] - less[k]) / (2.0 * step))
        });
        let [xx, yy, tt] = sides.map(|(more, less, step)| {
            let [more, less] = [slopes(more), slopes(less)];
            [0, 1, 2].map(|k| (more[k] + less[k] - 2.0 * here[k]) / (step * step))
        });
        let xyt = (both.slope - right.slope - up.slope + still.slope) / (h * h);
        let [hxx, hyy, htt, hxy, hxt, hyt] = symmetric(first);
        self.add_form(
            still,
            &Derivatives {
                ww: Complex::new(hxx - hyy, -2.0 * hxy) / 4.0,
                wc: (hxx + hyy) / 4.0,
                wt: Complex::new(hxt, -hyt) / 2.0,
                tt: htt,
                www: Complex::new(xx[0] - 3.0 * yy[0], yy[1] - 3.0 * xx[1]) / 8.0,
                wwc: Complex::new(xx[0] + yy[0], -xx[1] - yy[1]) / 8.0,
                wwt: Complex::new(xx[2] - yy[2], -2.0 * xyt) / 4.0,
                wct: (xx[2] + yy[2]) / 4.0,
                wtt: Complex::new(tt[0], -tt[1]) / 2.0,
                ttt: tt[2],
            },
            out,
        );
    }

    /// Adds the form of third order of two discs that lie.
    pub(super) fn add_derived(&self, out: &mut Sum) {
        out.work += 2 * AN_ENERGY;
        let (energy, derivatives) = self.single.derived();
        self.add_form(&energy, &derivatives, out);
    }

    /// Adds the form of third order with these derivatives.
    fn add_form(&self, energy: &PairEnergy, of: &Derivatives, out: &mut Sum) {
        self.add_quadratic(energy, of, out);
        out.cubic.add(self.arm, energy.gradient, of);
    }

    /// Adds that of second order.
    fn add_quadratic(&self, energy: &PairEnergy, of: &Derivatives, out: &mut Sum) {
        let Derivatives { ww, wc, wt, tt, .. } = *of;
        let second = [
            2.0 * (wc + ww.re),
            2.0 * (wc - ww.re),
            tt,
            -2.0 * ww.im,
            2.0 * wt.re,
            -2.0 * wt.im,
        ];
        out.form = out.form.minus(-1.0, &self.in_cell(energy, second));
    }

    /// The form in the cell's coordinates, from the gradient and the Hessian in the second magnet's own
    /// place and turn.
    pub(super) fn in_cell(
        &self,
        here: &PairEnergy,
        [xx, yy, tt, xy, xt, yt]: [f64; 6],
    ) -> Quadratic {
        let (arm, force) = (self.arm, here.gradient);
        let across = Vector2::new(-arm.y, arm.x);
        let bent = Vector2::new(xx * across.x + xy * across.y, xy * across.x + yy * across.y);
        let turned = Vector2::new(xt, yt);
        let turning = bent + turned;
        Quadratic {
            value: here.energy,
            gradient: [force.x, force.y, force.dot(&across) + here.slope],
            hessian: [
                xx,
                yy,
                bent.dot(&across) + 2.0 * turned.dot(&across) + tt - force.dot(&arm),
                xy,
                turning.x,
                turning.y,
            ],
        }
    }
}

/// The entries of a Hessian, from its rows.
fn symmetric([x, y, t]: [[f64; 3]; 3]) -> [f64; 6] {
    let mean = |a: f64, b: f64| (a + b) / 2.0;
    [
        x[0],
        y[1],
        t[2],
        mean(x[1], y[0]),
        mean(x[2], t[0]),
        mean(y[2], t[1]),
    ]
}
