//! The energy of many dipoles in a tabulated field, and the field where it is tabulated.
//!
//! For each moving dipole the lanes hold the powers of its place in a patch, and the fixed dipoles
//! near the patch; its field is a sum over lanes, which is taken at the end.

use arrayvec::ArrayVec;
use nalgebra::{Vector2, Vector3};

use super::field::{Field, Shares, field_of_each};
use super::tasks::{frame_of_one, summed};
use super::{DipolePotential, Many};
use crate::configuration::Configuration;
use crate::potential::patches::dipoles::{Near, ORDER, Patch};
use crate::potential::patches::polynomial::Polynomial;
use crate::potential::patches::square::NEAR;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Number of vectors in a row of coefficients.
const VECTORS: usize = ORDER / WIDTH;

/// Number of dipoles evaluated together.
const BATCH: usize = 16;

/// One configuration, whose moving dipoles all lie within reach of the table of the fixed ones.
pub struct Patched<'a, const SLOPE: bool> {
    pub potential: &'a DipolePotential,
    pub many: &'a Many,
    pub q: &'a Configuration,
}

impl<const SLOPE: bool> Task for Patched<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let frame = frame_of_one(l, self.q);
        let moving = &self.potential.moving;
        let sight = self.many.sight(self.q);
        let [fixed, groups] = sight.groups;
        let mut shares = Shares::zero(l);
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            let group = &groups[number];
            let distance = sight.distance(&fixed[0], group);
            let Some(some) = group.at(distance) else {
                open.extend(group.parts.iter().flatten());
                continue;
            };
            // Patches are looked up first, so that their memory accesses overlap.
            let is_filling = |i: &usize| moving.magnitude[*i] == 0.0;
            let mut rest = some.clone().filter(|i| !is_filling(i)).peekable();
            while rest.peek().is_some() {
                let some = rest.by_ref().take(BATCH).map(|i| {
                    let place = sight.place(Vector2::new(moving.x[i], moving.y[i])).into();
                    (i, place, self.many.patches.at(place))
                });
                let some: ArrayVec<_, BATCH> = some.collect();
                for (i, place, patch) in &some {
                    let moment = [moving.moment_x[*i], moving.moment_y[*i]];
                    let field = field_in::<L, SLOPE>(l, patch, *place);
                    let place = [l.splat(place[0]), l.splat(place[1])];
                    let moment = [l.splat(moment[0]), l.splat(moment[1])];
                    shares.gather::<L, SLOPE>(l, &frame, moment, place, &field);
                }
            }
        }
        summed(l, &frame, shares)
    }
}

/// The field at a place in a patch, as partial sums in the lanes.
#[inline(always)]
fn field_in<L: Lanes, const SLOPE: bool>(l: L, patch: &Patch, place: [f64; 2]) -> Field<L::F> {
    let mut field = far::<L, SLOPE>(l, &patch.far, place);
    let place = [l.splat(place[0]), l.splat(place[1])];
    for near in &patch.near {
        field = of_near::<L, SLOPE>(l, near, place, field);
    }
    field
}

/// Adds the near dipoles to the partial sums of a field.
#[inline(always)]
fn of_near<L: Lanes, const SLOPE: bool>(
    l: L,
    near: &Near,
    place: [L::F; 2],
    mut field: Field<L::F>,
) -> Field<L::F> {
    let [x, y] = &near.position;
    let [along, across] = &near.moment;
    for first in (0..NEAR).step_by(WIDTH) {
        let position = [l.load(&x[first..]), l.load(&y[first..])];
        let moment = [l.load(&along[first..]), l.load(&across[first..])];
        let more = field_of_each::<L, SLOPE>(l, position, moment, place);
        field = field.add::<L, SLOPE>(l, &more);
    }
    field
}

/// The first and second derivatives of a polynomial at a place, as partial sums in the lanes, each
/// of which has the terms of some powers of x.
///
/// Each column of coefficients is a polynomial in y, of which Horner's rule gives value, slope and
/// half the bend.
#[inline(always)]
fn far<L: Lanes, const SLOPE: bool>(
    l: L,
    polynomial: &Polynomial<ORDER>,
    place: [f64; 2],
) -> Field<L::F> {
    let scale = polynomial.scale;
    let powers = powers((place[0] - polynomial.centre[0]) * scale);
    let v = l.splat((place[1] - polynomial.centre[1]) * scale);
    let zero = l.splat(0.0);
    let (mut value, mut slope, mut bend) = ([zero; VECTORS], [zero; VECTORS], [zero; VECTORS]);
    for row in polynomial.rows.iter().rev() {
        for k in 0..VECTORS {
            if SLOPE {
                bend[k] = l.mul_add(bend[k], v, slope[k]);
            }
            slope[k] = l.mul_add(slope[k], v, value[k]);
            value[k] = l.mul_add(value[k], v, l.load(&row[k * WIDTH..]));
        }
    }
    let once = l.splat(scale);
    let mut field = Field {
        x: l.mul(along::<L, 1>(l, &value, &powers), once),
        y: l.mul(along::<L, 0>(l, &slope, &powers), once),
        slope: [zero; 3],
    };
    if SLOPE {
        let twice = l.splat(scale * scale);
        field.slope = [
            l.mul(along::<L, 2>(l, &value, &powers), twice),
            l.mul(along::<L, 1>(l, &slope, &powers), twice),
            l.mul(
                along::<L, 0>(l, &bend, &powers),
                l.splat(2.0 * scale * scale),
            ),
        ];
    }
    field
}

/// The powers of u from the -2nd on, those of negative order as 0.
#[inline(always)]
fn powers(u: f64) -> [f64; ORDER + 2] {
    let mut powers = [0.0; ORDER + 2];
    powers[2] = 1.0;
    powers[3] = u;
    for k in 2..ORDER {
        powers[2 + k] = powers[2 + k / 2] * powers[2 + k - k / 2];
    }
    powers
}

/// The factors `i (i - 1) ...` of the `TIMES`-th derivative of each power.
static WEIGHTS: [[f64; ORDER]; 3] = {
    let mut weights = [[1.0; ORDER]; 3];
    let mut i = 0;
    while i < ORDER {
        weights[1][i] = i as f64;
        weights[2][i] = (i * i) as f64 - i as f64;
        i += 1;
    }
    weights
};

/// The `TIMES`-th derivative by x of columns of coefficients, as partial sums in the lanes.
#[inline(always)]
fn along<L: Lanes, const TIMES: usize>(
    l: L,
    columns: &[L::F; VECTORS],
    powers: &[f64; ORDER + 2],
) -> L::F {
    let mut sum = l.splat(0.0);
    for (k, column) in columns.iter().enumerate() {
        let i = k * WIDTH;
        let mut power = l.load(&powers[i + 2 - TIMES..]);
        if TIMES > 0 {
            power = l.mul(power, l.load(&WEIGHTS[TIMES][i..]));
        }
        sum = l.mul_add(*column, power, sum);
    }
    sum
}
