//! The arithmetic of the dipole kernel, written once for all instruction sets.
//!
//! The energy of the moving tile's dipoles in the field of the fixed tile's. For a moving dipole of
//! moment `m` at the place `p`, `U = m . A(p)` with `A(p) = sum_j r^-3 [m_j - 3 (m_j.d) d / r^2]`,
//! `d = p - p_j`, `r = |d|` (minus the flux density, the moments being scaled by `sqrt(mu0 / 4
//! pi)`). A is summed over the fixed dipoles in sequence; the lanes hold the places, either one
//! dipole of several configurations or several dipoles of one. In both cases a place's field is
//! computed by the same operations in the same order, so it has the same bits.

use super::bundle::Bundle;
use crate::potential::dipole::Dipole;
use crate::potential::simd::lanes::Arithmetic;

/// A dipole of the fixed tile: place (m), scaled moment (sqrt(J m^3)) and three times that.
#[derive(Clone, Copy, Debug)]
pub struct FieldDipole {
    pub position: [f64; 2],
    pub moment: [f64; 2],
    pub thrice: [f64; 2],
    /// Magnitude of the scaled moment.
    pub magnitude: f64,
}

impl From<&Dipole> for FieldDipole {
    fn from(dipole: &Dipole) -> Self {
        Self {
            position: dipole.position.into(),
            moment: dipole.moment.into(),
            thrice: (dipole.moment * 3.0).into(),
            magnitude: dipole.moment.norm(),
        }
    }
}

/// The field A at some places, with its derivatives if requested.
#[derive(Clone, Copy)]
pub struct Field<F> {
    pub x: F,
    pub y: F,
    /// dA_x/dx, dA_x/dy = dA_y/dx and dA_y/dy.
    pub slope: [F; 3],
}

impl<F: Copy> Field<F> {
    /// The sum with another part of the same field.
    #[inline(always)]
    pub fn add<L: Arithmetic<F = F>, const SLOPE: bool>(&self, l: L, other: &Self) -> Self {
        let mut sum = Self {
            x: l.add(self.x, other.x),
            y: l.add(self.y, other.y),
            slope: self.slope,
        };
        if SLOPE {
            for (a, b) in sum.slope.iter_mut().zip(other.slope) {
                *a = l.add(*a, b);
            }
        }
        sum
    }
}

/// Number of sources processed together; the number of all sources must be a multiple of it.
pub const BATCH: usize = 2;

/// The field of the sources at `N` vectors of places.
///
/// With `s = m.d`, `u = 3 s / r^2` and `v = m - u d`, a source gives `A = r^-3 v` and, with
/// `z = v + u d / 6` and `f = r^-5 d`, `dA_a/db = -3 (z_a f_b + z_b f_a) - 3 r^-5 s delta_ab`,
/// whose trace is `3 r^-5 s`.
#[inline(always)]
pub fn field<L: Arithmetic, const N: usize, const SLOPE: bool>(
    l: L,
    sources: &[FieldDipole],
    places: &[[L::F; 2]; N],
) -> [Field<L::F>; N] {
    let b = Bundle::<L, N, BATCH>(l);
    let (mut x, mut y) = ([l.splat(0.0); N], [l.splat(0.0); N]);
    for ((x, y), place) in x.iter_mut().zip(&mut y).zip(places) {
        [*x, *y] = *place;
    }
    let (x, y) = ([x; BATCH], [y; BATCH]);
    let mut sums = [Sums::zero(l); N];
    for pair in sources.as_chunks::<BATCH>().0 {
        let position = [
            b.rows([pair[0].position[0], pair[1].position[0]]),
            b.rows([pair[0].position[1], pair[1].position[1]]),
        ];
        let moment = [
            b.rows([pair[0].moment[0], pair[1].moment[0]]),
            b.rows([pair[0].moment[1], pair[1].moment[1]]),
        ];
        let thrice = [
            b.rows([pair[0].thrice[0], pair[1].thrice[0]]),
            b.rows([pair[0].thrice[1], pair[1].thrice[1]]),
        ];

        let d = [b.sub(x, position[0]), b.sub(y, position[1])];
        let share = Share::new(b, d, moment, thrice);
        for j in 0..BATCH {
            for (k, sum) in sums.iter_mut().enumerate() {
                let v = [share.v[0][j][k], share.v[1][j][k]];
                sum.add(l, share.w3[j][k], v);
            }
        }
        if SLOPE {
            let (z, f, w5) = share.bend(b, d);
            for j in 0..BATCH {
                for k in 0..N {
                    let (z, f) = ([z[0][j][k], z[1][j][k]], [f[0][j][k], f[1][j][k]]);
                    sums[k].add_slope(l, z, f, w5[j][k], share.s3[j][k]);
                }
            }
        }
    }
    let mut fields = [Field {
        x: l.splat(0.0),
        y: l.splat(0.0),
        slope: [l.splat(0.0); 3],
    }; N];
    for (field, sum) in fields.iter_mut().zip(&sums) {
        *field = sum.field(l);
    }
    fields
}

/// The field at a place of the source in each lane, its place (m) and moment (sqrt(J m^3)) given.
#[inline(always)]
pub fn field_of_each<L: Arithmetic, const SLOPE: bool>(
    l: L,
    position: [L::F; 2],
    moment: [L::F; 2],
    place: [L::F; 2],
) -> Field<L::F> {
    let three = l.splat(3.0);
    let thrice = [l.mul(moment[0], three), l.mul(moment[1], three)];
    let d = [l.sub(place[0], position[0]), l.sub(place[1], position[1])];
    let share = Share::new(l, d, moment, thrice);
    let mut sums = Sums::zero(l);
    sums.add(l, share.w3, share.v);
    if SLOPE {
        let (z, f, w5) = share.bend(l, d);
        sums.add_slope(l, z, f, w5, share.s3);
    }
    sums.field(l)
}

/// The contribution of a source, in the notation of [`field`]; `w3` is `r^-3`, `s3` is `3 s`.
struct Share<F> {
    w2: F,
    w3: F,
    s3: F,
    u: F,
    v: [F; 2],
}

impl<F: Copy> Share<F> {
    #[inline(always)]
    fn new<A: Arithmetic<F = F>>(a: A, d: [F; 2], moment: [F; 2], thrice: [F; 2]) -> Self {
        let r2 = a.mul_add(d[0], d[0], a.mul(d[1], d[1]));
        let s3 = a.mul_add(thrice[0], d[0], a.mul(thrice[1], d[1]));
        let w1 = a.reciprocal_sqrt(r2);
        let w2 = a.mul(w1, w1);
        let w3 = a.mul(w1, w2);
        let u = a.mul(s3, w2);
        let v = [
            a.neg_mul_add(u, d[0], moment[0]),
            a.neg_mul_add(u, d[1], moment[1]),
        ];
        Self { w2, w3, s3, u, v }
    }

    /// `z`, `f` and `r^-5`.
    #[inline(always)]
    fn bend<A: Arithmetic<F = F>>(&self, a: A, d: [F; 2]) -> ([F; 2], [F; 2], F) {
        let w5 = a.mul(self.w3, self.w2);
        let f = [a.mul(w5, d[0]), a.mul(w5, d[1])];
        let u6 = a.mul(self.u, a.splat(1.0 / 6.0));
        let z = [
            a.mul_add(u6, d[0], self.v[0]),
            a.mul_add(u6, d[1], self.v[1]),
        ];
        (z, f, w5)
    }
}

/// The same pair of numbers in all lanes.
#[inline(always)]
pub fn pair_of<L: Arithmetic>(l: L, [x, y]: [f64; 2]) -> [L::F; 2] {
    [l.splat(x), l.splat(y)]
}

/// Running sums over the sources.
#[derive(Clone, Copy)]
struct Sums<F> {
    a: [F; 2],
    /// The xx and the xy element of the symmetric product of `z` and `f`, the former halved.
    outer: [F; 2],
    /// `3 r^-5 s`, the trace of the slope.
    trace: F,
}

impl<F: Copy> Sums<F> {
    #[inline(always)]
    fn zero<L: Arithmetic<F = F>>(l: L) -> Self {
        let zero = l.splat(0.0);
        Self {
            a: [zero; 2],
            outer: [zero; 2],
            trace: zero,
        }
    }

    #[inline(always)]
    fn add<L: Arithmetic<F = F>>(&mut self, l: L, w3: F, v: [F; 2]) {
        self.a[0] = l.mul_add(w3, v[0], self.a[0]);
        self.a[1] = l.mul_add(w3, v[1], self.a[1]);
    }

    #[inline(always)]
    fn add_slope<L: Arithmetic<F = F>>(&mut self, l: L, z: [F; 2], f: [F; 2], w5: F, s3: F) {
        self.outer[0] = l.mul_add(z[0], f[0], self.outer[0]);
        self.outer[1] = l.mul_add(z[0], f[1], self.outer[1]);
        self.outer[1] = l.mul_add(z[1], f[0], self.outer[1]);
        self.trace = l.mul_add(w5, s3, self.trace);
    }

    #[inline(always)]
    fn field<L: Arithmetic<F = F>>(&self, l: L) -> Field<F> {
        let xx = l.neg_mul_add(l.splat(6.0), self.outer[0], l.sub(l.splat(0.0), self.trace));
        let xy = l.mul(l.splat(-3.0), self.outer[1]);
        let yy = l.sub(self.trace, xx);
        Field {
            x: self.a[0],
            y: self.a[1],
            slope: [xx, xy, yy],
        }
    }
}

/// Configurations in lanes: cosine and sine of theta, and the reference point.
#[derive(Clone, Copy)]
pub struct Frame<F> {
    pub cos: F,
    pub sin: F,
    pub x: F,
    pub y: F,
}

impl<F: Copy> Frame<F> {
    /// The place of a point given in the moving tile's frame.
    #[inline(always)]
    pub fn place<L: Arithmetic<F = F>>(&self, l: L, point: [F; 2]) -> [F; 2] {
        [
            l.mul_add(
                self.cos,
                point[0],
                l.neg_mul_add(self.sin, point[1], self.x),
            ),
            l.mul_add(self.sin, point[0], l.mul_add(self.cos, point[1], self.y)),
        ]
    }

    #[inline(always)]
    fn rotate<L: Arithmetic<F = F>>(&self, l: L, v: [F; 2]) -> [F; 2] {
        [
            l.neg_mul_add(self.sin, v[1], l.mul(self.cos, v[0])),
            l.mul_add(self.sin, v[0], l.mul(self.cos, v[1])),
        ]
    }
}

/// Sums of the moving dipoles' contributions. With complex numbers for vectors, and `m` a moment in
/// the moving tile's frame, `along + i across = sum m conj(A)`; the energy is then the real part of
/// `exp(i theta)` times it, and its derivative by the moments' direction minus the imaginary part.
#[derive(Clone, Copy)]
pub struct Shares<F> {
    along: F,
    across: F,
    /// dU/dx, dU/dy, and the part of dU/dtheta due to the dipoles' motion.
    slope: [F; 3],
}

impl<F: Copy> Shares<F> {
    #[inline(always)]
    pub fn zero<L: Arithmetic<F = F>>(l: L) -> Self {
        Self::from_array([l.splat(0.0); 5])
    }

    #[inline(always)]
    pub fn to_array(self) -> [F; 5] {
        let [x, y, turn] = self.slope;
        [self.along, self.across, x, y, turn]
    }

    #[inline(always)]
    pub fn from_array([along, across, x, y, turn]: [F; 5]) -> Self {
        Self {
            along,
            across,
            slope: [x, y, turn],
        }
    }

    #[inline(always)]
    pub fn add<L: Arithmetic<F = F>>(self, l: L, other: Self) -> Self {
        let (mut sum, other) = (self.to_array(), other.to_array());
        for (a, b) in sum.iter_mut().zip(other) {
            *a = l.add(*a, b);
        }
        Self::from_array(sum)
    }

    /// Adds the contribution of the dipole of the given moment (in the moving tile's frame) at
    /// `place`, where the field is `field`.
    #[inline(always)]
    pub fn gather<L: Arithmetic<F = F>, const SLOPE: bool>(
        &mut self,
        l: L,
        frame: &Frame<F>,
        moment: [F; 2],
        place: [F; 2],
        field: &Field<F>,
    ) {
        self.along = l.mul_add(moment[0], field.x, self.along);
        self.along = l.mul_add(moment[1], field.y, self.along);
        self.across = l.mul_add(moment[1], field.x, self.across);
        self.across = l.neg_mul_add(moment[0], field.y, self.across);
        if SLOPE {
            let [mx, my] = frame.rotate(l, moment);
            let [xx, xy, yy] = field.slope;
            let gx = l.mul_add(xx, mx, l.mul(xy, my));
            let gy = l.mul_add(xy, mx, l.mul(yy, my));
            let arm = [l.sub(place[0], frame.x), l.sub(place[1], frame.y)];
            self.slope[0] = l.add(self.slope[0], gx);
            self.slope[1] = l.add(self.slope[1], gy);
            self.slope[2] = l.mul_add(arm[0], gy, self.slope[2]);
            self.slope[2] = l.neg_mul_add(arm[1], gx, self.slope[2]);
        }
    }

    /// The energy, and its gradient.
    #[inline(always)]
    pub fn finish<L: Arithmetic<F = F>>(&self, l: L, frame: &Frame<F>) -> (F, [F; 3]) {
        let energy = l.neg_mul_add(frame.sin, self.across, l.mul(frame.cos, self.along));
        let turn = l.neg_mul_add(frame.sin, self.along, self.slope[2]);
        let turn = l.neg_mul_add(frame.cos, self.across, turn);
        (energy, [self.slope[0], self.slope[1], turn])
    }
}
