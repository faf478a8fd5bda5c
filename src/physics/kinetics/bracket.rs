//! Two-sided bounds of capacities and of the quantities derived from them: Dirichlet's principle
//! from above, Thomson's from below, on one mesh.
//!
//! Let e be the error of a function f_h on the mesh and d the error of a flux J, which is free of
//! sources and therefore orthogonal to every such e. Then `J / w + grad f_h = d - e` is known in
//! each cell, its square is the difference of the bounds, and for two such problems `<e, e'> = <d -
//! e, d' - e'> / 2` within half of `|d - e| |d' - e'|` (Prager and Synge 1947,
//! doi:10.1090/qam/25902). By Galerkin orthogonality `<e, e'>` is the error of a flow between two
//! places, and of an integral of a committor, for which the other problem is the mean time to any
//! place.

#[cfg(test)]
mod tests;

use super::field::Field;
use super::mesh::{Gap, Nodes, System, Unsolved, loads};
use super::rim::Rims;
use crate::parallel;

/// Places on a mesh with their data.
pub(super) struct Asked<'a> {
    pub field: &'a Field<'a>,
    pub nodes: &'a Nodes,
    /// For each corner the place it belongs to.
    pub pins: &'a [Option<usize>],
    /// The place that the mesh's rim belongs to.
    pub rim: usize,
    /// The rims of the places.
    pub rims: &'a Rims,
    /// Cells that carry no load.
    pub left_out: &'a [bool],
}

/// Bounds of the capacities of places, each against all others, and of the quantities derived from
/// them.
///
/// They exclude the errors of integrals over cells: they hold on the mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bracket {
    /// From below and from above, by places (rad).
    capacities: Vec<[f64; 2]>,
    /// The flow between every two places (rad), on the mesh.
    flows: Vec<Vec<f64>>,
    /// The integrals of the functions on the mesh times the load.
    held: Vec<f64>,
    /// `<d - e, d' - e'>` of every two problems, the last of which is the mean time.
    gaps: Vec<Vec<f64>>,
    /// The same by cells.
    by_cells: Vec<Vec<Vec<f64>>>,
    /// Estimated relative errors of capacities because basins consist of whole cells: by cell, and
    /// in total.
    of_rims: Vec<(Vec<(usize, f64)>, f64)>,
}

impl Bracket {
    /// Computes the bounds for a number of places.
    ///
    /// # Errors
    /// If a linear system cannot be solved.
    pub fn new(asked: &Asked, count: usize) -> Result<Self, Unsolved> {
        let Asked {
            field, nodes, pins, ..
        } = *asked;
        let mesh = &field.mesh;
        let system = System::new(mesh, nodes, pins);
        let loads = loads(mesh, nodes, asked.left_out);
        // The last is the mean time.
        let places = (0..count).map(|place| system.committor(place, None));
        let sought: Vec<_> = places.chain([system.loaded(&loads, None)]).collect();
        let values = system.solve_all(&sought)?;
        let network = field.network(nodes, pins, asked.rim).ok_or(Unsolved)?;
        let source = |cell: usize| match asked.left_out[cell] {
            true => 0.0,
            false => mesh.held(cell),
        };
        let guesses = parallel::map(&values[..], |values| network.potentials(nodes, values));
        let found = network.fluxes(&source, &guesses)?;
        let gap = |place: usize| Gap {
            flux: &found[place],
            values: &values[place],
            source: if place == count { &source } else { &|_| 0.0 },
        };
        let held = |values: &[f64]| values.iter().zip(&loads).map(|(a, b)| a * b).sum::<f64>();
        let energy = |place: usize| field.energy(nodes, &values[place]);
        let capacities: Vec<[f64; 2]> = (0..count)
            .map(|place| [found[place].capacity, energy(place)])
            .collect();
        let by_cells: Vec<Vec<Vec<f64>>> = parallel::map(0..count + 1, |i| {
            let with = |j| network.products(mesh, nodes, &gap(i), &gap(j));
            (0..=i).map(with).collect()
        });
        // The squares are also computed in another way, and the larger value is taken, since for
        // the mean time both neglect how the load differs from a tilted one within cells.
        let square = |place: usize| match capacities.get(place) {
            Some([lower, upper]) => upper - lower,
            None => {
                let by_cells: f64 = by_cells[count][count].iter().sum();
                by_cells.max(found[count].cost - held(&values[count]))
            }
        };
        let gaps = (0..=count).map(|i| {
            let with = |j: usize| match i == j {
                true => square(i).max(0.0),
                false => by_cells[i.max(j)][i.min(j)].iter().sum(),
            };
            (0..=count).map(with).collect()
        });
        let flows: Vec<Vec<f64>> = values[..count]
            .iter()
            .map(|values| system.flows(values, count.max(asked.rim + 1)))
            .collect();
        let between = |i: usize, j: usize| match i == j {
            true => 0.0,
            false => flows[i.max(j)][i.min(j)],
        };
        let of_rims = values[..count]
            .iter()
            .map(|values| asked.rims.errors(field, nodes, values));
        let of_rims: Vec<_> = of_rims.collect();
        Ok(Self {
            flows: (0..count)
                .map(|i| (0..count).map(|j| between(i, j)).collect())
                .collect(),
            held: (0..count).map(|place| held(&values[place])).collect(),
            gaps: gaps.collect(),
            capacities,
            by_cells,
            of_rims,
        })
    }

    /// Bounds of T = (occupation + known `rest`) / capacity: the error of `occupation - T capacity`
    /// is `<e, e' + T e>`, and a T for which the error cannot make up the difference is excluded.
    /// These bounds are narrower than the quotients of the ends.
    pub fn ratio(&self, place: usize, rest: f64) -> [f64; 2] {
        let [lower, upper] = self.capacities[place];
        let (product, square) = (self.with_time(place), self.of_time());
        let (middle, gap) = (0.5 * (lower + upper), upper - lower);
        let held = self.held[place] + 0.5 * product + rest;
        // The roots of a T^2 - 2 b T + c.
        let a = upper * lower;
        let b = held * middle + 0.25 * gap * product;
        let c = held * held - 0.25 * gap * square;
        let root = (b * b - a * c).max(0.0).sqrt();
        let least = (c / (b + root)).max(0.0);
        [
            least,
            if a > 0.0 {
                (b + root) / a
            } else {
                f64::INFINITY
            },
        ]
    }

    /// Bounds of k = flow between two places / (occupation of the first + known `rest`): the error
    /// of `flow - k occupation` is `<e, e' - k e''>`, as in [`Self::ratio`].
    pub fn rate(&self, from: usize, to: usize, rest: f64) -> [f64; 2] {
        let gap = self.gaps[from][from];
        let flow = self.flows[from][to] + 0.5 * self.gaps[from][to];
        let held = self.held[from] + 0.5 * self.with_time(from) + rest;
        // The roots of a k^2 - 2 b k + c.
        let a = held * held - 0.25 * gap * self.of_time();
        let b = flow * held - 0.25 * gap * self.with_time(to);
        let c = flow * flow - 0.25 * gap * self.gaps[to][to];
        let sum = b + (b * b - a * c).max(0.0).sqrt();
        let is_known = |part: f64, whole: f64| part > 0.0 && whole > 0.0;
        [
            if is_known(flow, c) {
                (c / sum).max(0.0)
            } else {
                0.0
            },
            if is_known(held, a) {
                (sum / a).max(0.0)
            } else {
                f64::INFINITY
            },
        ]
    }

    /// `<d - e, d' - e'>` of a place and the mean time.
    fn with_time(&self, place: usize) -> f64 {
        self.gaps[place][self.held.len()]
    }

    /// The square of `d' - e'` of the mean time.
    fn of_time(&self) -> f64 {
        self.gaps[self.held.len()][self.held.len()]
    }

    /// The flow between two places (rad), the middle of its bounds.
    pub fn flow(&self, i: usize, j: usize) -> f64 {
        (self.flows[i][j] + 0.5 * self.gaps[i][j]).max(0.0)
    }

    /// The integral of a place's committor times the load, the middle of its bounds.
    pub fn occupation(&self, place: usize) -> f64 {
        (self.held[place] + 0.5 * self.with_time(place)).max(0.0)
    }

    /// The relative contribution of each cell to the width of the bounds of mean exit times and,
    /// for these pairs, of rates.
    pub fn shares(&self, pairs: &[(usize, usize)]) -> Vec<f64> {
        let count = self.held.len();
        let cells = self.by_cells[0][0].len();
        let by_cells = |i: usize, j: usize| &self.by_cells[i.max(j)][i.min(j)];
        let mut shares = vec![0.0; cells];
        // The rounding of `|d - e| |d' - e' + factor (d'' - e'')| / 2`, relative to a value of this
        // size.
        let mut add = |place: usize, other: usize, factor: f64, third: usize, size: f64| {
            let both = |cell: usize| {
                by_cells(other, other)[cell]
                    + 2.0 * factor * by_cells(other, third)[cell]
                    + factor * factor * by_cells(third, third)[cell]
            };
            let whole: f64 = (0..cells).map(both).sum();
            let ratio = whole / self.gaps[place][place].max(f64::MIN_POSITIVE);
            let ratio = ratio.max(0.0).sqrt();
            let own = by_cells(place, place);
            for (cell, share) in shares.iter_mut().enumerate() {
                let other = if ratio > 0.0 { both(cell) / ratio } else { 0.0 };
                *share += 0.5 * (own[cell].max(0.0) * ratio + other.max(0.0)) / size;
            }
        };
        for place in 0..count {
            let held = self.held[place];
            add(place, count, held / self.capacities[place][1], place, held);
        }
        for &(from, to) in pairs {
            let (flow, held) = (self.flows[from][to], self.held[from]);
            add(from, to, -flow / held, count, flow);
        }
        for (errors, _) in &self.of_rims {
            for (cell, error) in errors {
                shares[*cell] += error;
            }
        }
        shares
    }

    /// Estimated relative error of capacities because basins consist of whole cells.
    pub fn off_by_rims(&self) -> f64 {
        let sums = self.of_rims.iter().map(|(_, sum)| *sum);
        sums.fold(0.0, f64::max)
    }
}
