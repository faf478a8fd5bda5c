//! Certified lower bounds of the energy of two faces over all poses, by subdivision into cells.
//!
//! A cell of configurations is evaluated once for all couples: contact gives its free part, and
//! each pair of magnets has an enclosure. A couple's enclosure is the sum of these with its signs.
//! If its lower bound over the free part of the cell is above the target, the couple is finished in
//! this cell; otherwise the cell is halved. A couple's target is its sampled minimum minus the
//! tolerance.

use ordered_float::OrderedFloat;

use super::{Couple, Stage};
use tiles::assessment::{Assessment, assess};
use tiles::cell::Cell;
use tiles::configuration::Configuration;
use tiles::contact::cells::ContactCells;
use tiles::potential::bounds::Enclosure;
use tiles::subdivision::Waiting;
use tiles::tile::Magnet;
use tiles::units::MU0_OVER_4PI;

/// Lower bounds of couples.
pub(super) struct Bounds {
    /// J, by couple.
    pub lower: Vec<f64>,
    /// Whether all are within the tolerance.
    pub settled: bool,
    /// Number of cells evaluated.
    pub cells: usize,
}

/// How far a proof has come.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    /// Cells evaluated.
    pub cells: usize,
    /// No faces attract more strongly than found by more than this (J); infinite at first.
    pub within: f64,
}

/// Number of cells evaluated in parallel.
const BATCH: usize = 64;

/// Largest ratio of a cell's length to its width.
const SLENDER: f64 = 8.0;

/// A cell and the couples that may have low energies in it.
struct Open {
    cell: Cell,
    /// Indices of couples, with the best bound (J) so far.
    couples: Vec<(usize, f64)>,
    /// The lowest of these bounds minus the target (J): the largest deficit goes first.
    lack: OrderedFloat<f64>,
}

impl Stage {
    /// Bounds within the tolerance (J) of the sampled minima, as far as this many cells achieve it.
    pub(super) fn certified(
        &self,
        couples: &[Couple],
        found: &[(f64, Configuration)],
        (tolerance, most_cells): (f64, usize),
        proving: &dyn Fn(Proof),
    ) -> Bounds {
        // Far apart no energy lies below zero by more than the tolerance.
        let wanted: Vec<f64> = found
            .iter()
            .map(|(energy, _)| energy.min(0.0) - tolerance)
            .collect();
        let contact = ContactCells::new(&self.contact);
        let mut waiting = Waiting::none();
        for cell in self.first_cells(tolerance) {
            let open = Open {
                cell,
                couples: (0..couples.len())
                    .map(|number| (number, f64::NEG_INFINITY))
                    .collect(),
                lack: OrderedFloat(f64::NEG_INFINITY),
            };
            waiting.push(open.lack, open);
        }
        let mut cells = 0;
        while cells < most_cells && !waiting.is_empty() {
            let look = |open: &Open| self.look_at(open, couples, &wanted, &contact);
            let found = waiting.look(BATCH, look);
            cells += found.len();
            for half in found.into_iter().flat_map(|(_, halves)| halves) {
                waiting.push(half.lack, half);
            }
            let lack = waiting.first().map_or(0.0, |lack| lack.into_inner());
            proving(Proof {
                cells,
                within: tolerance - lack,
            });
        }
        let settled = waiting.is_empty();
        let mut lower = wanted;
        for open in waiting.into_cells() {
            for (couple, bound) in open.couples {
                lower[couple] = lower[couple].min(bound);
            }
        }
        Bounds {
            lower,
            settled,
            cells,
        }
    }

    /// Boxes that cover all configurations in which the tiles are near enough to matter: outside
    /// them all magnets of the one are `far` from all of the other, where two of them attract by at
    /// most `2 mu0 m1 m2 / (4 pi far^3)`, and blocks much smaller than that by less than twice as
    /// much; together by less than the tolerance.
    fn first_cells(&self, tolerance: f64) -> Vec<Cell> {
        const ACROSS: i32 = 8;
        const TURNS: i32 = 16;
        let moments = |magnets: &[Magnet]| magnets.iter().map(|magnet| magnet.moment).sum::<f64>();
        let product = moments(&self.pair.fixed.magnets) * moments(&self.pair.moving.magnets);
        let size = self
            .pair
            .fixed
            .magnets
            .iter()
            .flat_map(|magnet| magnet.size);
        let far = libm::cbrt(4.0 * MU0_OVER_4PI * product / tolerance);
        let far = far.max(10.0 * size.fold(0.0, f64::max));
        let half = self.pair.free_distance() + far;
        let (width, turn) = (
            2.0 * half / f64::from(ACROSS),
            std::f64::consts::TAU / f64::from(TURNS),
        );
        let middle =
            |k: i32, step: f64, count: i32| step * (f64::from(k) + 0.5 - f64::from(count) / 2.0);
        let mut cells = Vec::new();
        for i in 0..ACROSS {
            for j in 0..ACROSS {
                for k in 0..TURNS {
                    cells.push(Cell {
                        centre: Configuration::new(
                            middle(i, width, ACROSS),
                            middle(j, width, ACROSS),
                            middle(k, turn, TURNS),
                        ),
                        // Neighbours overlap by more than rounding.
                        half: [width, width, turn].map(|size| size / 2.0 * (1.0 + 1e-12)),
                    });
                }
            }
        }
        cells
    }

    /// The halves of a cell, with the couples that are not finished there.
    fn look_at(
        &self,
        open: &Open,
        couples: &[Couple],
        wanted: &[f64],
        contact: &ContactCells,
    ) -> Vec<Open> {
        let cell = &open.cell;
        let lever = self.pair.moving.radius_of_gyration();
        let Some(cuts) = contact.classify(cell) else {
            return Vec::new();
        };
        let by_magnets: Vec<Enclosure> = self
            .magnets()
            .iter()
            .map(|energy| match &energy.bounds {
                Ok(bounds) => bounds.enclose(cell),
                Err(_) => Enclosure::unknown(),
            })
            .collect();
        let mut left = Vec::new();
        let mut worst: Option<(f64, Assessment)> = None;
        for (number, before) in &open.couples {
            let known = self.sum(&by_magnets, &couples[*number]);
            // The cheap bound over the whole cell first.
            let box_bound = known.form.least(&cell.half) + known.low;
            if box_bound >= wanted[*number] {
                continue;
            }
            let found = assess(&known, &cuts, lever, cell);
            let bound = found.lower.max(*before);
            if bound >= wanted[*number] {
                continue;
            }
            left.push((*number, bound));
            let lack = bound - wanted[*number];
            if worst.is_none_or(|(least, _)| lack < least) {
                worst = Some((lack, found));
            }
        }
        let Some((lack, found)) = worst else {
            return Vec::new();
        };
        // A cell must not become thin in one direction: contact is only decisive for cells small in
        // all directions.
        let sizes = [cell.half[0], cell.half[1], lever * cell.half[2]];
        let longest = (0..3).max_by_key(|i| OrderedFloat(sizes[*i])).unwrap_or(0);
        let thin = SLENDER * sizes[found.axis] < sizes[longest];
        let axis = if thin { longest } else { found.axis };
        let half = cell.half[axis] / 2.0 * (1.0 + 1e-12);
        let parts = cell.parts(axis, half).map(|cell| Open {
            cell,
            couples: left.clone(),
            lack: OrderedFloat(lack),
        });
        parts.into()
    }

    /// The enclosure of a couple.
    fn sum(&self, by_magnets: &[Enclosure], couple: &Couple) -> Enclosure {
        let mut out = Enclosure::default();
        for (number, one) in by_magnets.iter().enumerate() {
            let sign = couple.sign(number / self.places, number % self.places);
            if sign == 0.0 {
                continue;
            }
            out.form = out.form.minus(-sign, &one.form);
            let [low, high] = if sign > 0.0 {
                [one.low, one.high]
            } else {
                [-one.high, -one.low]
            };
            out.low += low;
            out.high += high;
            out.slope += one.slope;
            out.jump += one.jump;
        }
        // A generous bound of the rounding of the sums.
        let size: f64 = by_magnets.iter().map(|one| one.form.value.abs()).sum();
        out.low -= SUMMED * size;
        out.high += SUMMED * size;
        out
    }
}

/// Relative rounding of a sum of up to a few thousand terms.
const SUMMED: f64 = 1e-12;
