//! The form of third order of an energy over a cell.

use nalgebra::{Complex, Vector2};

use super::Left;
use crate::cell::Quadratic;
use crate::potential::far::derivatives::Derivatives;

/// The coefficients of x^3, x^2 y, x y^2, y^3, x^2 t, x y t, y^2 t, x t^2, y t^2 and t^3 in the offset (x, y, t) from a
/// cell's centre.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cubic([f64; 10]);

/// The powers of x, y and t of the coefficients.
const POWERS: [[usize; 3]; 10] = [
    [3, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 3, 0],
    [2, 0, 1],
    [1, 1, 1],
    [0, 2, 1],
    [1, 0, 2],
    [0, 1, 2],
    [0, 0, 3],
];

impl Cubic {
    /// Adds the terms of third order of a magnet at an arm a (m) from the point about which its tile turns, with
    /// its gradient (J/m): a motion by d and a turn by t moves it by `d + i a t - a t^2 / 2 - i a t^3 / 6` and turns it
    /// by t, so these are the terms of third order in the series of its energy with this in place of w.
    pub fn add(&mut self, arm: Vector2<f64>, gradient: Vector2<f64>, of: &Derivatives) {
        let i = Complex::<f64>::i();
        let a = Complex::new(arm.x, arm.y);
        let w = Complex::new(gradient.x, -gradient.y) / 2.0;
        let square = a.norm_sqr();
        let Derivatives {
            ww,
            wc,
            wt,
            www,
            wwc,
            wwt,
            wct,
            wtt,
            ttt,
            ..
        } = *of;
        // Re[e d^2] + h |d|^2, times t; Re[v d] t^2; and t^3.
        let e = i * a * www - i * a.conj() * wwc + wwt;
        let h = (i * a * wwc).re * 2.0 + wct;
        let v = -(www * a * a) + wwc * (2.0 * square) - (wwc * a * a).conj() + i * a * wwt * 2.0
            - i * a.conj() * (2.0 * wct)
            + wtt
            - a * ww
            - a.conj() * wc;
        let turning = (a * a * a * www).im / 3.0 - (a * wwc).im * square - (a * a * wwt).re
            + square * wct
            - (a * wtt).im
            + ttt / 6.0
            + (a * a * ww).im
            - (a * wt).re
            + (a * w).im / 3.0;
        let all = [
            www.re / 3.0 + wwc.re,
            -www.im - wwc.im,
            wwc.re - www.re,
            www.im / 3.0 - wwc.im,
            e.re + h,
            -2.0 * e.im,
            h - e.re,
            v.re,
            -v.im,
            turning,
        ];
        for (sum, own) in self.0.iter_mut().zip(all) {
            *sum += own;
        }
    }

    /// Adds the linear form nearest to it over a cell with these half sizes to a form; returns what is left.
    /// Of `x^3` that is `3/4 h^2 x`, of `x^2 y` it is `h^2 y / 2` (Chebyshev).
    pub fn fold_into(&self, form: &mut Quadratic, half: &[f64; 3]) -> Left {
        let mut left = Left::default();
        for (coefficient, powers) in self.0.iter().zip(POWERS) {
            let each = (0..3).map(|axis| half[axis].powi(powers[axis] as i32));
            let most = coefficient.abs() * each.product::<f64>();
            let axis_of = |power| powers.iter().position(|it| *it == power);
            // What is left, and its slope, as shares of the largest value.
            let (spread, slope) = if let Some(axis) = axis_of(3) {
                form.gradient[axis] += 0.75 * coefficient * half[axis] * half[axis];
                (0.25, 2.25)
            } else if let (Some(even), Some(odd)) = (axis_of(2), axis_of(1)) {
                form.gradient[odd] += 0.5 * coefficient * half[even] * half[even];
                (0.5, 2.5)
            } else {
                (1.0, 3.0)
            };
            left.spread += spread * most;
            left.slope += slope * most;
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over the cell and along motions in it, what is left is within its bounds, which are reached.
    #[test]
    fn what_is_left_of_each_term_is_within_its_bounds() {
        let half = [0.3, 0.7, 1.1];
        let steps = || (-20..=20).map(|k| f64::from(k) / 20.0);
        for (term, powers) in POWERS.iter().enumerate() {
            let mut cubic = Cubic::default();
            cubic.0[term] = -1.7;
            let mut form = Quadratic::default();
            let left = cubic.fold_into(&mut form, &half);
            let at = |d: [f64; 3]| {
                let each = (0..3).map(|axis| d[axis].powi(powers[axis] as i32));
                -1.7 * each.product::<f64>() - form.at(d)
            };
            let (mut most, mut steepest) = (0.0f64, 0.0f64);
            for x in steps() {
                for y in steps() {
                    for t in steps() {
                        let d = [x * half[0], y * half[1], t * half[2]];
                        most = most.max(at(d).abs());
                        let slopes = (0..3).map(|axis| {
                            let [mut low, mut high] = [d; 2];
                            low[axis] -= 1e-4 * half[axis];
                            high[axis] += 1e-4 * half[axis];
                            (at(high) - at(low)).abs() / 2e-4
                        });
                        steepest = steepest.max(slopes.sum());
                    }
                }
            }
            assert!((most / left.spread - 1.0).abs() < 1e-9, "{most} {left:?}");
            assert!(
                (steepest / left.slope - 1.0).abs() < 1e-6,
                "{steepest} {left:?}"
            );
        }
    }
}
