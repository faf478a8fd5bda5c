//! Two-sided bounds of capacities and of what follows from them: Dirichlet's principle from above,
//! Thomson's from below, on one mesh.
//!
//! A function f_h on the mesh differs from the exact one by e, and a flux J from the exact one by d,
//! which is free of sources and so is orthogonal to every such e. Hence `J / w + grad f_h = d - e`
//! is known cell by cell, its square is what the bounds are apart, and of two such problems
//! `<e, e'> = <d - e, d' - e'> / 2` within half of `|d - e| |d' - e'|` (Prager and Synge 1947,
//! doi:10.1090/qam/25902). By Galerkin's orthogonality `<e, e'>` is what is missing in a flow
//! between two places, and in an integral of a committor, whose other problem is the mean time to
//! any place.

use rayon::prelude::*;

use super::field::Field;
use super::mesh::{Gap, Nodes, System, Unsolved, loads};
use super::rim::Rims;

/// Places on a mesh, and what is known of them.
pub(super) struct Asked<'a> {
    pub field: &'a Field<'a>,
    pub nodes: &'a Nodes,
    /// For each corner the place that it belongs to.
    pub pins: &'a [Option<usize>],
    /// The place that the mesh's rim belongs to.
    pub rim: usize,
    /// Those of the places.
    pub rims: &'a Rims,
    /// Cells that carry no load.
    pub left_out: &'a [bool],
}

/// Bounds of the capacities of the first of some places, each against all others, and of what
/// follows from them.
///
/// What the integrals over cells are off by is not in them: they hold on the mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bracket {
    /// From below and from above, by places (rad).
    capacities: Vec<[f64; 2]>,
    /// What flows between every two places (rad).
    flows: Vec<Vec<Bounded>>,
    /// The integrals of each committor times the load.
    occupations: Vec<Bounded>,
    /// The same of the functions on the mesh.
    held: Vec<f64>,
    /// For each place `<d - e, d' - e'>` and the square of `d' - e'` for the mean time.
    times: Vec<[f64; 2]>,
    /// What refining the cells may bring.
    pub shares: Vec<f64>,
    /// By how much capacities are off, relative, because basins are made of cells: an estimate.
    pub of_rims: f64,
}

/// A figure and its bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounded {
    /// Midway between the bounds.
    pub value: f64,
    /// From below and above.
    pub ends: [f64; 2],
}

impl Bracket {
    /// Of so many places.
    ///
    /// # Errors
    /// Where a linear system is not solved.
    pub fn new(asked: &Asked, count: usize) -> Result<Self, Unsolved> {
        let Asked {
            field, nodes, pins, ..
        } = *asked;
        let mesh = &field.mesh;
        let pinned: Vec<bool> = pins.iter().map(Option::is_some).collect();
        let system = System::new(mesh, nodes, &pinned);
        let none = vec![0.0; nodes.len()];
        let loads = loads(mesh, nodes, asked.left_out);
        // The last is the mean time.
        let values = (0..=count).into_par_iter().map(|place| {
            let one = |pin: &Option<usize>| if *pin == Some(place) { 1.0 } else { 0.0 };
            let given: Vec<f64> = pins.iter().map(one).collect();
            match place == count {
                true => system.solve(&none, &loads, &none),
                false => system.solve(&given, &none, &none),
            }
        });
        let values: Vec<Vec<f64>> = values.collect::<Result<_, _>>()?;
        let network = field
            .network(nodes, pins, asked.rim, &values[0])
            .ok_or(Unsolved)?;
        let fluxes = network.fluxes();
        let source = |cell: usize| match (asked.left_out[cell], &mesh.leaves[cell].element) {
            (false, Some(element)) => element.load.iter().sum(),
            _ => 0.0,
        };
        let found = (0..=count).into_par_iter().map(|place| {
            let like = fluxes.potentials(nodes, &values[place]);
            match place == count {
                true => fluxes.of(&source, &like),
                false => fluxes.from(place, &like),
            }
        });
        let found = found.collect::<Result<Vec<_>, _>>()?;
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
        let mut squares: Vec<f64> = capacities
            .iter()
            .map(|[lower, upper]| upper - lower)
            .collect();
        squares.push(found[count].cost - held(&values[count]));
        let size = |place: usize| squares[place].max(0.0).sqrt();
        // What is missing in a product of two problems.
        let products = |i: usize, j: usize| fluxes.products(mesh, nodes, &gap(i), &gap(j));
        let product = |i: usize, j: usize| products(i, j).iter().sum::<f64>();
        let with_time: Vec<Vec<f64>> = (0..count).map(|place| products(place, count)).collect();
        let times: Vec<[f64; 2]> = with_time
            .iter()
            .map(|products| [products.iter().sum(), squares[count].max(0.0)])
            .collect();
        let missing = |i: usize, j: usize| {
            let known = if j == count {
                times[i][0]
            } else {
                product(i, j)
            };
            (0.5 * known, 0.5 * size(i) * size(j))
        };
        let around = |value: f64, (middle, off): (f64, f64)| Bounded {
            value: (value + middle).max(0.0),
            ends: [-off, off].map(|off| (value + middle + off).max(0.0)),
        };
        let occupations: Vec<Bounded> = (0..count)
            .map(|place| around(held(&values[place]), missing(place, count)))
            .collect();
        let flow = |i: usize, j: usize| {
            let out = system.fluxes(&values[i]);
            let into = pins.iter().zip(out).filter(|(pin, _)| **pin == Some(j));
            around(-into.map(|(_, flux)| flux).sum::<f64>(), missing(i, j))
        };
        let between = |i: usize, j: usize| match i == j {
            true => Bounded::default(),
            false => flow(i.max(j), i.min(j)),
        };
        let flows = (0..count)
            .map(|i| (0..count).map(|j| between(i, j)).collect())
            .collect();
        // How far the bounds of occupation over capacity are apart, by cells.
        let mut shares = vec![0.0; mesh.leaves.len()];
        let relaxing = products(count, count);
        for (place, with_time) in with_time.iter().enumerate() {
            let held = held(&values[place]);
            let time = held / energy(place);
            let own = products(place, place);
            let both = |cell: usize| {
                relaxing[cell] + 2.0 * time * with_time[cell] + time * time * own[cell]
            };
            let whole: f64 = (0..own.len()).map(both).sum();
            let ratio = (whole / squares[place].max(f64::MIN_POSITIVE))
                .max(0.0)
                .sqrt();
            for (cell, share) in shares.iter_mut().enumerate() {
                let other = if ratio > 0.0 { both(cell) / ratio } else { 0.0 };
                *share += 0.5 * (own[cell].max(0.0) * ratio + other.max(0.0)) / held;
            }
        }
        let mut of_rims: f64 = 0.0;
        for values in &values[..count] {
            let (errors, sum) = asked.rims.errors(field, nodes, values);
            of_rims = of_rims.max(sum);
            for (cell, error) in errors {
                shares[cell] += error;
            }
        }
        Ok(Self {
            capacities,
            flows,
            occupations,
            held: (0..count).map(|place| held(&values[place])).collect(),
            times,
            shares,
            of_rims,
        })
    }

    /// Bounds of the occupation and a known `rest` of it over the capacity: what is missing in
    /// `occupation - T capacity` is `<e, e' + T e>`, and where nothing can make up for the
    /// difference, T is none. Nearer each other than the quotients of the ends.
    pub fn ratio(&self, place: usize, rest: f64) -> [f64; 2] {
        let [lower, upper] = self.capacities[place];
        let [product, square] = self.times[place];
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

    /// Bounds of what flows between two places (rad).
    pub fn flow(&self, i: usize, j: usize) -> Bounded {
        self.flows[i][j]
    }

    /// Bounds of the integral of a place's committor times the load.
    pub fn occupation(&self, place: usize) -> Bounded {
        self.occupations[place]
    }
}
