//! Cells: closed boxes of configurations, and quadratic forms bounded over them.

use nalgebra::Vector3;

use crate::configuration::Configuration;

/// A closed box of configurations: every (x, y, theta) that differs from `centre` by at most
/// `half` in each coordinate (theta modulo a full turn).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The middle of the box.
    pub centre: Configuration,
    /// Half the size along x and y (m) and theta (rad).
    pub half: [f64; 3],
}

impl Cell {
    /// The cell of one configuration alone.
    #[inline]
    pub fn at(q: &Configuration) -> Self {
        Self {
            centre: *q,
            half: [0.0; 3],
        }
    }

    /// The cell spanned by two configurations, the shorter way round in theta.
    #[inline]
    pub fn spanned_by(a: &Configuration, b: &Configuration) -> Self {
        let step = a.step_to(b);
        let half = |d: f64| (d.abs() / 2.0).next_up() + 1e-15;
        Self {
            centre: a.interpolate(b, 0.5),
            half: [half(step.x), half(step.y), half(step.z)],
        }
    }

    /// Volume (m^2 rad).
    #[inline]
    pub fn volume(&self) -> f64 {
        self.half.iter().map(|half| 2.0 * half).product()
    }

    /// Largest distance (m) of the reference point from its position at the centre.
    #[inline]
    pub fn travel(&self) -> f64 {
        let [x, y, _] = self.half;
        (x * x + y * y).sqrt()
    }

    /// Largest distance (m) of a point of the moving tile, at the distance `lever` (m) from its
    /// reference point, from its position at the centre.
    #[inline]
    pub fn reach(&self, lever: f64) -> f64 {
        self.travel() + lever * self.half[2]
    }

    /// The two parts along a coordinate, with the given half size there: slightly more than half
    /// that of the whole, so that rounding leaves no gap between them.
    #[inline]
    pub fn parts(&self, axis: usize, half: f64) -> [Self; 2] {
        [-0.5, 0.5].map(|side| {
            let mut step = Vector3::zeros();
            step[axis] = side * self.half[axis];
            let mut part = Self {
                centre: self.centre.moved(step),
                ..*self
            };
            part.half[axis] = half;
            part
        })
    }

    /// Whether a configuration lies in the cell.
    #[inline]
    pub fn contains(&self, q: &Configuration) -> bool {
        let step = self.centre.step_to(q);
        (0..3).all(|i| step[i].abs() <= self.half[i])
    }
}

/// Relative rounding error allowed for in sums of a few dozen terms (about 100 roundings).
const ROUNDING: f64 = 1.2e-14;

/// A quadratic form of the offset d = (dx, dy, dtheta) from a cell's centre:
/// `value + gradient . d + d^T H d / 2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quadratic {
    /// At the centre.
    pub value: f64,
    /// By x, y and theta, at the centre.
    pub gradient: [f64; 3],
    /// H as (xx, yy, theta theta, xy, x theta, y theta).
    pub hessian: [f64; 6],
}

/// Rows and columns of the off-diagonal entries 3, 4 and 5 of a stored Hessian.
const OFF_DIAGONAL: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

impl Quadratic {
    /// The value at an offset.
    #[inline]
    pub fn at(&self, d: [f64; 3]) -> f64 {
        let [xx, yy, tt, xy, xt, yt] = self.hessian;
        let slopes: f64 = (0..3).map(|i| self.gradient[i] * d[i]).sum();
        let squares = xx * d[0] * d[0] + yy * d[1] * d[1] + tt * d[2] * d[2];
        let products = xy * d[0] * d[1] + xt * d[0] * d[2] + yt * d[1] * d[2];
        self.value + slopes + 0.5 * squares + products
    }

    /// `self - factor * other`.
    #[inline]
    pub fn minus(&self, factor: f64, other: &Self) -> Self {
        let mut out = *self;
        out.value -= factor * other.value;
        for (a, b) in out.gradient.iter_mut().zip(&other.gradient) {
            *a -= factor * b;
        }
        for (a, b) in out.hessian.iter_mut().zip(&other.hessian) {
            *a -= factor * b;
        }
        out
    }

    /// The product with another form, without its terms of third and fourth order.
    pub fn times(&self, other: &Self) -> Self {
        let (f, g) = (self, other);
        let second = |k: usize, (i, j): (usize, usize)| {
            f.value * g.hessian[k]
                + g.value * f.hessian[k]
                + f.gradient[i] * g.gradient[j]
                + f.gradient[j] * g.gradient[i]
        };
        let [xy, xt, yt] = OFF_DIAGONAL;
        let entries = [(0, 0), (1, 1), (2, 2), xy, xt, yt];
        Self {
            value: f.value * g.value,
            gradient: std::array::from_fn(|i| f.value * g.gradient[i] + g.value * f.gradient[i]),
            hessian: std::array::from_fn(|k| second(k, entries[k])),
        }
    }

    /// The largest values of the terms of first and second order over the box.
    #[inline]
    pub fn orders(&self, half: &[f64; 3]) -> [f64; 2] {
        let [slopes, squares, products] = self.magnitudes(half);
        [slopes, 0.5 * squares + products]
    }

    /// Sums of the magnitudes of slopes, of squares and of products over the box.
    fn magnitudes(&self, half: &[f64; 3]) -> [f64; 3] {
        let slopes = (0..3).map(|i| (self.gradient[i] * half[i]).abs()).sum();
        let squares = (0..3)
            .map(|i| (self.hessian[i] * half[i] * half[i]).abs())
            .sum();
        let products = OFF_DIAGONAL
            .into_iter()
            .zip(&self.hessian[3..])
            .map(|((i, j), h)| (h * half[i] * half[j]).abs())
            .sum();
        [slopes, squares, products]
    }

    /// A guaranteed lower bound of the form over the box `|d_i| <= half_i`.
    ///
    /// Each product is bounded by squares, `2 |d_i d_j| <= d_i^2 half_j / half_i + d_j^2 half_i /
    /// half_j`, after which the coordinates separate; the bound is exact at the corners of the box.
    #[inline]
    pub fn least(&self, half: &[f64; 3]) -> f64 {
        let losses = self.losses(half);
        self.value - losses[0] - losses[1] - losses[2] - self.rounding(half)
    }

    /// A guaranteed upper bound of the form over the box.
    #[inline]
    pub fn greatest(&self, half: &[f64; 3]) -> f64 {
        -Self::default().minus(1.0, self).least(half)
    }

    /// By how much each coordinate lowers the bound of [`least`](Self::least).
    pub fn losses(&self, half: &[f64; 3]) -> [f64; 3] {
        let mut curvature = [
            self.hessian[0] * half[0] * half[0],
            self.hessian[1] * half[1] * half[1],
            self.hessian[2] * half[2] * half[2],
        ];
        for (k, (i, j)) in OFF_DIAGONAL.into_iter().enumerate() {
            let product = (self.hessian[3 + k] * half[i] * half[j]).abs();
            curvature[i] -= product;
            curvature[j] -= product;
        }
        // In units of half_i: the least of slope t + curvature t^2 / 2 over |t| <= 1.
        std::array::from_fn(|i| {
            let slope = (self.gradient[i] * half[i]).abs();
            if curvature[i] > slope {
                slope * slope / (2.0 * curvature[i])
            } else {
                slope - curvature[i] / 2.0
            }
        })
    }

    /// Bound of the rounding errors of `least` and of the sums that made the form.
    #[inline]
    pub fn rounding(&self, half: &[f64; 3]) -> f64 {
        let [slopes, squares, products] = self.magnitudes(half);
        ROUNDING * (self.value.abs() + slopes + squares + products)
    }

    /// The largest value on the straight line from one corner of the box to the opposite one,
    /// `d = t step / 2` with `t` from -1 to 1.
    pub fn greatest_along(&self, step: &[f64; 3]) -> f64 {
        let d = step.map(|s| s / 2.0);
        let slope: f64 = (0..3).map(|i| self.gradient[i] * d[i]).sum();
        let mut curvature: f64 = (0..3).map(|i| self.hessian[i] * d[i] * d[i]).sum();
        for ((i, j), h) in OFF_DIAGONAL.into_iter().zip(&self.hessian[3..]) {
            curvature += 2.0 * h * d[i] * d[j];
        }
        let rise = if -curvature > slope.abs() {
            slope * slope / (-2.0 * curvature)
        } else {
            slope.abs() + curvature / 2.0
        };
        self.value + rise + self.rounding(&d.map(f64::abs))
    }
}
