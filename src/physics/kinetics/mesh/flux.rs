//! Fluxes through the sides of cells, and the flux of least cost that Thomson's principle needs.
//!
//! In each cell the flux is linear between opposite sides (Raviart and Thomas 1977,
//! doi:10.1007/BFb0064470, of the lowest order), through no side that contact closes. The flux of
//! least cost with a given current is found from potentials on the sides, which is a positive
//! system (Arnold and Brezzi 1985, doi:10.1051/m2an/1985190100071).
//!
//! A flux J that leaves the place where h = 1 with the current I, and of which the amount d is lost
//! or added on the way, satisfies `I - d <= -int J . grad h <= sqrt(C int J . M J / w)` for every
//! committor 0 <= h <= 1 with the capacity C: a lower bound of C that is valid despite rounding
//! errors.

use crate::parallel;
use nalgebra::{Matrix6, Vector6};

use super::element::value;
use super::equations::{Equations, Sought, Unsolved};
use super::nodes::Nodes;
use super::octree::Octree;
use super::profile::{Resistance, Spread};
use super::sides::{Side, sides};

/// A cell as a conductor, with the outflow `out = share * source - matrix * potentials` by sides.
struct Conductor {
    cell: usize,
    sides: [Side; 6],
    matrix: Matrix6<f64>,
    share: Vector6<f64>,
    /// The cost of outflows (1/rad).
    cost: Matrix6<f64>,
    /// The additional cost of a unit source in the cell, combined with the flow through each side
    /// and by itself (1/rad).
    placing: (Vector6<f64>, f64),
    /// The mean positions at which fluxes cross the sides, and of the source, as shares of its
    /// size.
    means: [[f64; 3]; 7],
}

/// The cells of a mesh whose chart begins at contact as conductors between places with given
/// potential.
pub(in crate::kinetics) struct Network {
    conductors: Vec<Conductor>,
    /// For each face the place that it belongs to.
    ends: Vec<Option<usize>>,
    equations: Equations,
}

impl Network {
    /// A network between places given by their cells, and the rim, which is the place `rim`;
    /// `None` if the chart contains blocked configurations.
    ///
    /// `costs` gives the distribution of fluxes in a cell, and their cost.
    pub fn new(
        mesh: &Octree,
        place: &dyn Fn(usize) -> Option<usize>,
        rim: usize,
        costs: &[Option<(Spread, Box<Resistance>)>],
    ) -> Option<Self> {
        if !mesh.chart.is_fitted() {
            return None;
        }
        let (sides, mut ends) = sides(mesh, rim, costs);
        let mut cells = Vec::new();
        for (id, ..) in mesh.live() {
            let Some(place) = place(id) else {
                cells.push(id);
                continue;
            };
            for (face, _) in sides[id].iter().flat_map(Side::faces) {
                ends[face] = Some(place);
            }
        }
        let conductor = |&id: &usize| {
            let (spread, resistance) = costs[id].as_ref()?;
            let means = spread.means(mesh.leaves[id].along(&mesh.chart));
            Conductor::new(id, sides[id], resistance, means)
        };
        let conductors = parallel::map(&cells, conductor);
        let conductors = conductors.into_iter().collect::<Option<Vec<_>>>()?;
        let is_asked = |face: usize| ends[face].is_none();
        let equations = Equations::new(ends.len(), &is_asked, &entries(&conductors));
        Some(Self {
            conductors,
            ends,
            equations,
        })
    }

    /// For each face 1 if it belongs to a place, and 0 otherwise.
    pub fn given(&self, place: usize) -> Vec<f64> {
        let one = |end: &Option<usize>| if *end == Some(place) { 1.0 } else { 0.0 };
        self.ends.iter().map(one).collect()
    }

    /// The fluxes from each of the first places to all others, and last that from a source in each
    /// cell to all places, starting from guesses of the potentials.
    ///
    /// The capacity (rad) of a place's flux is a lower bound, up to the quadrature. The cost of the
    /// source's is an upper bound of the integral of the source times its function, up to the
    /// quadrature and the approximation of the source within cells.
    ///
    /// # Errors
    /// If the linear system cannot be solved.
    pub fn fluxes(
        &self,
        source: &(dyn Fn(usize) -> f64 + Sync),
        guesses: &[Vec<f64>],
    ) -> Result<Vec<Flux>, Unsolved> {
        let places = guesses.len() - 1;
        let right = self.right(source);
        let sought = guesses.iter().enumerate().map(|(place, guess)| Sought {
            given: match place < places {
                true => self.given(place),
                false => vec![0.0; self.ends.len()],
            },
            right: (place == places).then_some(&right[..]),
            guess: Some(guess),
        });
        let sought: Vec<Sought> = sought.collect();
        let found = self.equations.solve(&entries(&self.conductors), &sought)?;
        Ok(parallel::map(0..guesses.len(), |place| {
            match place < places {
                true => self.flux(&found[place], &|_| 0.0, &sought[place].given),
                false => self.flux(&found[place], source, &sought[place].given),
            }
        }))
    }

    /// What a source in each cell adds to the equations of faces.
    fn right(&self, source: &(dyn Fn(usize) -> f64 + Sync)) -> Vec<f64> {
        let mut right = vec![0.0; self.ends.len()];
        for conductor in &self.conductors {
            let shares = conductor.share * source(conductor.cell);
            for (side, own) in conductor.sides.iter().zip(&shares) {
                for (face, share) in side.faces() {
                    right[face] += share * own;
                }
            }
        }
        right
    }

    fn flux(&self, potentials: &[f64], source: &dyn Fn(usize) -> f64, given: &[f64]) -> Flux {
        let all = self
            .conductors
            .iter()
            .map(|conductor| conductor.out(potentials, source(conductor.cell)));
        self.weighed(all.collect(), source, given)
    }

    /// The flux given by the outflows of the conductors.
    pub fn weighed(
        &self,
        all: Vec<Vector6<f64>>,
        source: &dyn Fn(usize) -> f64,
        given: &[f64],
    ) -> Flux {
        let mut into = vec![0.0; given.len()];
        let (mut cost, mut lost) = (0.0, 0.0);
        for (conductor, out) in self.conductors.iter().zip(&all) {
            let own = source(conductor.cell);
            cost += conductor.together((out, own), (out, own));
            lost += (out.sum() - own).abs() + ROUNDING * out.abs().sum();
            for (side, flux) in conductor.sides.iter().zip(out) {
                for (face, share) in side.faces() {
                    into[face] += share * flux;
                }
            }
        }
        let mut current = 0.0;
        for ((flux, end), one) in into.iter().zip(&self.ends).zip(given) {
            match end {
                None => lost += flux.abs(),
                Some(_) => current -= one * flux,
            }
        }
        let carried = (current - lost).max(0.0);
        Flux {
            out: all,
            cost,
            capacity: if carried > 0.0 {
                carried * carried / cost
            } else {
                0.0
            },
        }
    }

    /// The potentials on faces of a function on the mesh: its means there, a guess.
    pub fn potentials(&self, nodes: &Nodes, values: &[f64]) -> Vec<f64> {
        let mut potentials = vec![0.0; self.ends.len()];
        for conductor in &self.conductors {
            for (side, faces) in conductor.sides.iter().enumerate() {
                if let Side::Whole([(face, _)]) = faces {
                    potentials[*face as usize] = nodes.mean(conductor.cell, side, values);
                }
            }
        }
        potentials
    }

    /// For each cell the integral of the product of two gaps, `(J / w + grad f) w (J' / w + grad f')`.
    pub fn products(&self, mesh: &Octree, nodes: &Nodes, first: &Gap, second: &Gap) -> Vec<f64> {
        let mut products = vec![0.0; mesh.leaves.len()];
        for (number, conductor) in self.conductors.iter().enumerate() {
            let id = conductor.cell;
            let Some(element) = &mesh.leaves[id].element else {
                continue;
            };
            let means = &conductor.means;
            let of = |gap: &Gap| (gap.flux.out[number], nodes.of(id, gap.values));
            let ((out, own), (others_out, others)) = (of(first), of(second));
            let sources = [first, second].map(|gap| (gap.source)(id));
            let flows = conductor.together((&out, sources[0]), (&others_out, sources[1]));
            let slopes: f64 = element
                .times(&own)
                .iter()
                .zip(others)
                .map(|(a, b)| a * b)
                .sum();
            let mixed = carried(&out, sources[0], &others, means)
                + carried(&others_out, sources[1], &own, means);
            products[id] = flows + slopes + mixed;
        }
        products
    }
}

/// Calls with every entry of the potentials' matrix.
fn entries(conductors: &[Conductor]) -> impl Fn(&mut dyn FnMut(usize, usize, f64)) + Sync {
    move |call| {
        for conductor in conductors {
            for (a, first) in conductor.sides.iter().enumerate() {
                for (b, second) in conductor.sides.iter().enumerate() {
                    let entry = conductor.matrix[(a, b)];
                    for (i, by_row) in first.faces() {
                        for (j, by_column) in second.faces() {
                            call(i, j, entry * by_row * by_column);
                        }
                    }
                }
            }
        }
    }
}

impl Conductor {
    fn new(
        cell: usize,
        sides: [Side; 6],
        resistances: &Resistance,
        means: [[f64; 3]; 7],
    ) -> Option<Self> {
        // Flux is counted outwards from here on.
        let outwards = |a: usize| if a.is_multiple_of(2) { -1.0 } else { 1.0 };
        let is_closed = |a: usize| sides[a] == Side::Closed;
        let cost = Matrix6::from_fn(|a, b| match is_closed(a) || is_closed(b) {
            true if a == b => 1.0,
            true => 0.0,
            false => resistances[(a, b)] * outwards(a) * outwards(b),
        });
        let beside = Vector6::from_fn(|a, _| match is_closed(a) {
            true => 0.0,
            false => resistances[(a, 6)] * outwards(a),
        });
        let mut conductance = cost.try_inverse()?;
        for a in (0..6).filter(|a| is_closed(*a)) {
            conductance.row_mut(a).fill(0.0);
            conductance.column_mut(a).fill(0.0);
        }
        let sums = conductance.column_sum();
        let share = sums / sums.sum();
        let matrix = conductance - sums * share.transpose();
        Some(Self {
            cell,
            sides,
            matrix,
            share: share - matrix * beside,
            cost,
            placing: (beside, resistances[(6, 6)]),
            means,
        })
    }

    /// The mutual cost of two fluxes through the sides, each with its source in the cell.
    fn together(&self, (out, source): (&Vector6<f64>, f64), other: (&Vector6<f64>, f64)) -> f64 {
        let (beside, own) = &self.placing;
        out.dot(&(self.cost * other.0))
            + source * beside.dot(other.0)
            + other.1 * beside.dot(out)
            + source * other.1 * own
    }

    /// The flow out through the sides, with potentials on the faces and a source in the cell.
    fn out(&self, potentials: &[f64], source: f64) -> Vector6<f64> {
        let mean = Vector6::from_fn(|a, _| {
            let faces = self.sides[a].faces();
            faces.map(|(face, share)| share * potentials[face]).sum()
        });
        self.share * source - self.matrix * mean
    }
}

/// Rounding error of sums of fluxes, as a share of the total flow.
const ROUNDING: f64 = 1e-12;

/// A flux of least cost.
pub(in crate::kinetics) struct Flux {
    /// Out of each conductor's sides.
    pub out: Vec<Vector6<f64>>,
    /// Its cost.
    pub cost: f64,
    /// Its lower bound of the capacity; for fluxes from a place.
    pub capacity: f64,
}

/// A flux and a function that would correspond if both were exact.
pub(in crate::kinetics) struct Gap<'a> {
    pub flux: &'a Flux,
    pub values: &'a [f64],
    /// The source of each cell.
    pub source: &'a dyn Fn(usize) -> f64,
}

/// The integral of J . grad f over a cell: the flow times f at the sides, less the source times f
/// at the source. The mean positions of J on the sides and of the source are given as shares of the
/// cell's size.
fn carried(out: &Vector6<f64>, source: f64, values: &[f64; 8], means: &[[f64; 3]; 7]) -> f64 {
    let across = (0..6).map(|side| out[side] * value(means[side], values));
    across.sum::<f64>() - source * value(means[6], values)
}
