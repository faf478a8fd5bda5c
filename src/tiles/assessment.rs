//! A lower bound of the energy over the free part of a cell.

use ordered_float::OrderedFloat;

use crate::cell::{Cell, Quadratic};
use crate::contact::cells::{Cut, Cuts};
use crate::potential::bounds::Enclosure;

/// Bounds and estimates of a cell that is not proved blocked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assessment {
    /// No free configuration of the cell has a lower energy (J).
    pub lower: f64,
    /// A guess of the energy (J) at the free configuration nearest to the centre; it steers the
    /// search and proves nothing.
    pub estimate: f64,
    /// Overlap of the tiles at the centre, as a fraction of how far the cell moves them (0 without
    /// overlap), plus the cell's size as a fraction of the tile's. Also a guess that only steers:
    /// the rank in a flood that searches for any free path.
    pub overlap: f64,
    /// The coordinate along which to halve the cell.
    pub axis: usize,
}

impl Assessment {
    /// Whether the estimate is the placeholder of a cell whose midpoint overlaps deeply.
    pub fn is_overlapping(&self) -> bool {
        self.estimate >= OVERLAPPING
    }

    /// This assessment of a part, improved by that of the `whole` cell.
    pub fn within(self, whole: &Self) -> Self {
        Self {
            lower: self.lower.max(whole.lower),
            ..self
        }
    }
}

/// Estimate of a cell whose centre overlaps deeply: above all energies, and higher for deeper
/// overlap.
const OVERLAPPING: f64 = 1e30;

/// Assesses a cell with this enclosure of the energy and these contacts. `lever` (m) is how far a
/// turn of one radian moves the tile.
pub fn assess(enclosure: &Enclosure, cuts: &Cuts, lever: f64, cell: &Cell) -> Assessment {
    let tight = Lagrangian::tightest(enclosure, &cell.half, cuts);
    let gaps = cuts.easiest().map(|cut| cut.form.value);
    let deepest = gaps.fold(cuts.depth, |deepest, gap| deepest.max(-gap));
    let estimate = if cuts.depth > 0.0 {
        OVERLAPPING * (1.0 + cuts.depth / cell.reach(lever))
    } else {
        enclosure.form.value + pushed_out(&enclosure.form, cuts, lever)
    };
    Assessment {
        lower: tight.lower,
        estimate,
        overlap: deepest / cell.reach(lever) + cell.reach(lever) / lever,
        axis: widest(&tight.form, enclosure, cell, lever),
    }
}

/// Change of the energy (J), to first order, on the shortest path from the centre to where the most
/// violated cut is satisfied.
fn pushed_out(energy: &Quadratic, cuts: &Cuts, lever: f64) -> f64 {
    let worst = cuts
        .easiest()
        .min_by_key(|cut| OrderedFloat(cut.form.value));
    let Some(cut) = worst.filter(|cut| cut.form.value < 0.0) else {
        return 0.0;
    };
    let weights = [1.0, 1.0, 1.0 / (lever * lever)];
    let product =
        |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i] * weights[i]).sum::<f64>();
    let out = cut.form.gradient;
    -cut.form.value * product(&energy.gradient, &out) / product(&out, &out)
}

/// By how much more than the form's losses a cell's shape decides where it is halved: halved by losses alone, cells
/// about a valley become slivers, whose centres no pathway can follow. (Of the barriers of eight sectors with point
/// dipoles 39 of 62 are bounded as narrowly as asked without this, 46 of 65 with 1, and 52 of 65 with 3, in fewer
/// cells.)
const EVEN: f64 = 3.0;

/// The coordinate that loosens the bound most.
fn widest(form: &Quadratic, enclosure: &Enclosure, cell: &Cell, lever: f64) -> usize {
    let sizes = [cell.half[0], cell.half[1], lever * cell.half[2]];
    let total: f64 = sizes.iter().sum();
    let losses = form.losses(&cell.half);
    let known = enclosure.low.is_finite();
    let of_shape = (-enclosure.low).max(EVEN * losses.iter().sum::<f64>());
    let share = |i: usize| {
        if known {
            losses[i] + of_shape * sizes[i] / total
        } else {
            sizes[i]
        }
    };
    (0..3).max_by_key(|&i| OrderedFloat(share(i))).unwrap_or(0)
}

/// A lower bound by weak duality: where `cut + slack >= 0`, the energy is at least
/// `energy - multiplier (cut + slack)` for any multiplier >= 0, which is bounded over the whole
/// box. Any choice of multipliers gives a bound; good ones make the reduced slope vanish.
///
/// Rounding: the energy's own is subtracted with the sizes its terms have before the cuts are
/// taken off. The cuts' slack has a spare 1e-9 m, a million times the rounding of their terms.
pub struct Lagrangian {
    /// Lower bound of the energy (J) where the cuts hold.
    pub lower: f64,
    form: Quadratic,
}

impl Lagrangian {
    /// The greatest of the bounds that all cuts give together with one of each pair at a corner.
    pub fn tightest(enclosure: &Enclosure, half: &[f64; 3], cuts: &Cuts) -> Self {
        let all = &cuts.all[..];
        let mut tight = Self::new(enclosure, half, all);
        for pair in &cuts.corners {
            let [a, b] = pair.map(|cut| Self::new(enclosure, half, &[all, &[cut]].concat()));
            let weaker = if a.lower < b.lower { a } else { b };
            if weaker.lower > tight.lower {
                tight = weaker;
            }
        }
        tight
    }

    fn new(enclosure: &Enclosure, half: &[f64; 3], cuts: &[Cut]) -> Self {
        let rounding = enclosure.form.rounding(half);
        let bound = |form: &Quadratic, penalty: f64| {
            form.value - form.losses(half).iter().sum::<f64>() - penalty
        };
        let mut form = enclosure.form;
        let mut best = bound(&form, 0.0);
        let mut penalty = 0.0;
        let mut multipliers = vec![0.0; cuts.len()];
        let passes = if cuts.len() > 1 { 2 } else { 1 };
        for _ in 0..passes {
            for (cut, multiplier) in cuts.iter().zip(&mut multipliers) {
                let mut change = 0.0;
                for i in 0..3 {
                    let candidate = form.gradient[i] / cut.form.gradient[i];
                    if !candidate.is_finite() || *multiplier + candidate < 0.0 {
                        continue;
                    }
                    let value = bound(
                        &form.minus(candidate, &cut.form),
                        penalty + candidate * cut.slack,
                    );
                    if value > best {
                        (best, change) = (value, candidate);
                    }
                }
                if change != 0.0 {
                    form = form.minus(change, &cut.form);
                    penalty += change * cut.slack;
                    *multiplier += change;
                }
            }
        }
        Self {
            lower: best - rounding + enclosure.low,
            form,
        }
    }
}
