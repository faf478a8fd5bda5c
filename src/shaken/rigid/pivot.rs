//! The law of contact solved by pivots, for the few clusters on which sweeps go round in circles.
//!
//! With friction f = a - b, a and b not below 0, and s not below the size of the sliding, the law is a linear
//! complementarity problem: of each of
//!
//! `n.v - l` and `p`, `t.v + s` and `a`, `s - t.v` and `b`, `mu p - a - b` and `s`
//!
//! both are at least 0 and one of them is 0 (Stewart and Trinkle 1996; in the plane two directions of friction
//! are all there are). Lemke's method (Cottle, Pang and Stone 1992, The Linear Complementarity Problem,
//! section 4.4) ends in a solution wherever contact without impulse is possible (Anitescu and Potra 1997),
//! whatever the friction. Sweeps are not sure to: above some friction, a point's rub lifts its
//! neighbour more than the neighbour's lifts it.

use super::point::{SolverPoint, along};
use super::rest::Four;

/// Pivots per row at most.
const PIVOTS: usize = 50;
/// Elements below this share of the largest, which is of the order of 1, are rounding.
const ROUNDING: f64 = 1e-11;
/// Pivots below this share of the largest element are not made: rows that differ by less are of points that are
/// nearly the same, and to tell them apart would magnify rounding.
const ALIKE: f64 = 1e-7;
/// Solutions are put right this often.
const REFINED: usize = 3;

/// The impulses of a cluster's points by pivots, from the velocities without them.
pub fn by_pivots(points: &[SolverPoint], free: &[Four]) -> Option<Vec<[f64; 2]>> {
    // Impulses in units in which each has a response of 1 to its own push, and velocities in those of the fastest.
    let units: Vec<f64> = points.iter().map(|it| it.response.nn.sqrt()).collect();
    let n = 4 * points.len();
    let mut offset = vec![0.0; n];
    for ((offset, point), unit) in offset.chunks_mut(4).zip(points).zip(&units) {
        let [normal, slip] = [0, 1].map(|row| {
            let both = point.tiles.map(|tile| &free[tile]);
            along(&point.rows[row], both) / unit
        });
        offset.copy_from_slice(&[normal - point.least / unit, slip, -slip, 0.0]);
    }
    let size = offset.iter().map(|it| it.abs()).fold(0.0, f64::max);
    if size == 0.0 {
        return None;
    }
    offset.iter_mut().for_each(|it| *it /= size);
    let mut matrix = vec![0.0; n * n];
    for (k, (one, unit)) in points.iter().zip(&units).enumerate() {
        for (l, (other, by)) in points.iter().zip(&units).enumerate() {
            // The response of a row of one point to an impulse along a row of the other.
            let answer = |row: usize, column: usize| {
                let sides = one.tiles.iter().zip(&one.rows[row]);
                let each = sides.map(|(tile, own)| {
                    let theirs = other.tiles.iter().zip(&other.rows[column]);
                    let same = theirs.filter(|(of, _)| *of == tile);
                    same.map(|(_, theirs)| own.iter().zip(theirs).map(|(a, b)| a * b).sum::<f64>())
                        .sum::<f64>()
                });
                each.sum::<f64>() / (unit * by)
            };
            for row in 0..3 {
                let of = [0, 1, 1][row];
                let sign = if row == 2 { -1.0 } else { 1.0 };
                let at = (4 * k + row) * n + 4 * l;
                let [push, rub] = [0, 1].map(|column| sign * answer(of, column));
                matrix[at..at + 3].copy_from_slice(&[push, rub, -rub]);
            }
        }
        let own = |row: usize| (4 * k + row) * n + 4 * k;
        matrix[own(1) + 3] = 1.0;
        matrix[own(2) + 3] = 1.0;
        matrix[own(3)..own(3) + 3].copy_from_slice(&[one.response.friction, -1.0, -1.0]);
    }
    let found = complementary(&matrix, &offset)?;
    let each = found.chunks(4).zip(&units).zip(points);
    let impulses = each.map(|((it, unit), point)| {
        // But for rounding it is within the cone.
        let most = point.response.friction * it[0];
        [it[0], (it[1] - it[2]).clamp(-most, most)].map(|it| it * size / unit)
    });
    Some(impulses.collect())
}

/// Numbers w and z, none below 0, with `w = matrix z + offset` and one of each two equal to 0; returns z.
/// `None` if there are none, or they are not found. The offset should be of the order of 1, like the matrix,
/// of which this is the row-major list of rows.
fn complementary(matrix: &[f64], offset: &[f64]) -> Option<Vec<f64>> {
    let n = offset.len();
    let worst = (0..n).min_by(|a, b| offset[*a].total_cmp(&offset[*b]))?;
    if offset[worst] >= 0.0 {
        return Some(vec![0.0; n]);
    }
    // `w - matrix z - z0 = offset`: columns of w, of z, of z0 and of the right-hand side.
    let (auxiliary, right) = (2 * n, 2 * n + 1);
    let width = right + 1;
    let mut rows = vec![0.0; n * width];
    for (k, row) in rows.chunks_mut(width).enumerate() {
        row[k] = 1.0;
        for (to, from) in row[n..].iter_mut().zip(&matrix[k * n..(k + 1) * n]) {
            *to = -from;
        }
        row[auxiliary] = -1.0;
        row[right] = offset[k];
    }
    let mut basic: Vec<usize> = (0..n).collect();
    let (mut row, mut entering) = (worst, auxiliary);
    for _ in 0..PIVOTS * n {
        pivot(&mut rows, width, row, entering);
        let leaving = std::mem::replace(&mut basic[row], entering);
        if leaving == auxiliary {
            return Some(refined(&rows, &basic, matrix, offset));
        }
        entering = (leaving + n) % (2 * n);
        row = blocking(&rows, width, entering, &basic, auxiliary)?;
    }
    None
}

/// The numbers z of a tableau, which many pivots have left inexact: its columns of w are the inverse of those of
/// the basic numbers, by which what is missing from the equations is put right.
fn refined(rows: &[f64], basic: &[usize], matrix: &[f64], offset: &[f64]) -> Vec<f64> {
    let n = offset.len();
    let width = rows.len() / n;
    let mut all = vec![0.0; 2 * n];
    for (row, of) in rows.chunks(width).zip(basic) {
        all[*of] = row[width - 1];
    }
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for _ in 0..REFINED {
        let (w, z) = all.split_at(n);
        let each = matrix.chunks(n).zip(offset).zip(w);
        let missing = each.map(|((row, offset), w)| offset + product(row, z) - w);
        let missing: Vec<f64> = missing.collect();
        for (row, of) in rows.chunks(width).zip(basic) {
            all[*of] += product(&row[..n], &missing);
        }
    }
    all[n..].iter().map(|it| it.max(0.0)).collect()
}

/// The row whose number is the first to become 0 as that of a column grows; of equal ones the auxiliary
/// number's, else that with the largest element.
fn blocking(
    rows: &[f64],
    width: usize,
    column: usize,
    basic: &[usize],
    auxiliary: usize,
) -> Option<usize> {
    let mut best: Option<(usize, f64, f64)> = None;
    for (k, row) in rows.chunks(width).enumerate() {
        let by = row[column];
        if by <= ALIKE {
            continue;
        }
        let ratio = row[width - 1].max(0.0) / by;
        let is_better = best.is_none_or(|(of, least, size)| {
            let equal = (ratio - least).abs() <= ROUNDING * (1.0 + least);
            match equal {
                true => basic[k] == auxiliary || (basic[of] != auxiliary && by > size),
                false => ratio < least,
            }
        });
        if is_better {
            best = Some((k, ratio, by));
        }
    }
    best.map(|it| it.0)
}

fn pivot(rows: &mut [f64], width: usize, row: usize, column: usize) {
    let (before, rest) = rows.split_at_mut(row * width);
    let (own, after) = rest.split_at_mut(width);
    let by = 1.0 / own[column];
    own.iter_mut().for_each(|it| *it *= by);
    for other in before.chunks_mut(width).chain(after.chunks_mut(width)) {
        let share = other[column];
        if share != 0.0 {
            for (to, from) in other.iter_mut().zip(&*own) {
                *to -= share * from;
            }
            other[column] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_at_least_zero_and_one_of_them_is() {
        // Of Cottle, Pang and Stone's kind: positive definite, positive semidefinite, and copositive only.
        let cases: [(&[f64], &[f64]); 3] = [
            (&[2.0, 1.0, 1.0, 2.0], &[-5.0, -6.0]),
            (&[1.0, -1.0, -1.0, 1.0], &[-1.0, 2.0]),
            (&[1.0, 3.0, -1.0, 0.0], &[-2.0, 1.0]),
        ];
        for (matrix, offset) in cases {
            let z = complementary(matrix, offset).unwrap();
            for k in 0..2 {
                let w = matrix[2 * k] * z[0] + matrix[2 * k + 1] * z[1] + offset[k];
                assert!(w > -1e-12 && z[k] >= 0.0, "{w} {z:?}");
                assert!((w * z[k]).abs() < 1e-12, "{w} {z:?}");
            }
        }
        // `w = -z - 1` is never at least 0.
        assert_eq!(complementary(&[-1.0], &[-1.0]), None);
    }
}
