//! The dipole kernel, where most time is spent: the interaction energy of two sets of point
//! dipoles, for one configuration or many at once, with the best instruction set of the CPU.
//!
//! For a single configuration the lanes hold its moving dipoles; for many configurations each lane
//! holds one of them. In both cases a configuration's numbers are computed by the same operations
//! in the same order. So energies and gradients are the same bits whichever function computes them,
//! and independent of the rest of a batch and of the position in it. They are also the same on
//! every machine, as all instruction sets have eight lanes and operations rounded by IEEE 754. They
//! differ by at most about 1e-13 of the sum of the pairs' magnitudes from the scalar formula of
//! [`super::dipole`].
//!
//! Special cases: if dipoles coincide (or are within 1e-19 m), the energy is plus infinity and the
//! gradient zero. Poses beyond 1e18 m are not supported.

mod bundle;
mod derivative;
mod field;
mod patched;
mod tasks;

use std::sync::Arc;

use nalgebra::{Vector2, Vector3};

use super::Potential;
use super::dipole::{Dipole, dipoles, fill};
use super::groups::are_many;
use super::groups::tree::{DipoleGroup, Grain, Tree};
use super::groups::walk::Sight;
use super::lever::Lever;
use super::motion;
use super::patches::dipoles::Patches;
use super::simd::Level;
use super::simd::lanes::WIDTH;
use crate::configuration::Configuration;
use crate::tile::Magnet;
use crate::units::MU0_OVER_4PI;
use derivative::{DerivativeBound, TabulatedBound};
use field::{BATCH, FieldDipole};
use patched::Patched;
use tasks::{InLanes, One};

/// The interaction energy of two sets of point dipoles, one in each tile, laid out for the
/// instruction set it is computed with.
#[derive(Clone, Debug)]
pub struct DipolePotential {
    level: Level,
    /// The fixed tile's dipoles, in groups of [`BATCH`].
    sources: Vec<FieldDipole>,
    /// The moving tile's dipoles, in groups of the number of lanes.
    moving: Moving,
    lever: Lever,
    /// Trees of both tiles, if there are enough dipoles to benefit; `sources` and `moving` are then
    /// those of the trees.
    many: Option<Many>,
}

/// Data for very many dipoles.
#[derive(Clone, Debug)]
struct Many {
    groups: [Vec<DipoleGroup>; 2],
    /// The field of the fixed tile's dipoles.
    patches: Arc<Patches>,
}

impl Many {
    /// Whether all moving dipoles, and all that represent groups, are within reach of the table.
    fn is_tabulated(&self, q: &Configuration) -> bool {
        q.position().norm() + self.groups[1][0].lever <= self.patches.reach()
    }

    fn sight(&self, q: &Configuration) -> Sight<'_> {
        Sight::new(self.groups.each_ref().map(Vec::as_slice), q)
    }
}

/// The moving tile's dipoles, as a structure of arrays: places (m) and scaled moments
/// (sqrt(J m^3)).
#[derive(Clone, Debug)]
struct Moving {
    /// Their number without the padding.
    count: usize,
    x: Vec<f64>,
    y: Vec<f64>,
    moment_x: Vec<f64>,
    moment_y: Vec<f64>,
    magnitude: Vec<f64>,
}

impl DipolePotential {
    /// The potential of two tiles' magnets, for the fastest instruction set of this machine.
    pub fn new(fixed: &[Magnet], moving: &[Magnet]) -> Self {
        Self::with_level(&dipoles(fixed), &dipoles(moving), Level::best())
    }

    /// The potential of two sets of dipoles, for the given instruction set.
    pub fn with_level(fixed: &[Dipole], moving: &[Dipole], level: Level) -> Self {
        if are_many(fixed.len(), moving.len()) {
            let trees = [(fixed, BATCH), (moving, WIDTH)]
                .map(|(dipoles, fill)| Tree::new(dipoles, Grain::of_dipoles(fill)));
            if trees.iter().any(Tree::has_stands) {
                let patches = Patches::new(&scaled_and_filled(fixed, 1), level);
                return Self::of_trees(trees, patches, level);
            }
        }
        Self::one_by_one(fixed, moving, level)
    }

    fn of_trees([fixed, moving]: [Tree; 2], patches: Patches, level: Level) -> Self {
        Self {
            lever: Lever::of([Vector2::new(moving.lever, 0.0)].into_iter()),
            many: Some(Many {
                groups: [fixed.groups, moving.groups],
                patches: Arc::new(patches),
            }),
            ..Self::one_by_one(&fixed.dipoles, &moving.dipoles, level)
        }
    }

    /// The potential that evaluates every pair, however many there are.
    fn one_by_one(fixed: &[Dipole], moving: &[Dipole], level: Level) -> Self {
        let sources = scaled_and_filled(fixed, BATCH);
        let lanes = scaled_and_filled(moving, WIDTH);
        let column = |value: fn(&Dipole) -> f64| lanes.iter().map(value).collect();
        Self {
            level,
            sources: sources.iter().map(FieldDipole::from).collect(),
            moving: Moving {
                count: moving.len(),
                x: column(|d| d.position.x),
                y: column(|d| d.position.y),
                moment_x: column(|d| d.moment.x),
                moment_y: column(|d| d.moment.y),
                magnitude: column(|d| d.moment.norm()),
            },
            lever: Lever::of(moving.iter().map(|d| d.position)),
            many: None,
        }
    }

    /// The instruction set it is computed with.
    pub fn level(&self) -> Level {
        self.level
    }

    fn one<const SLOPE: bool>(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        match &self.many {
            Some(many) if many.is_tabulated(q) => self.level.run(Patched::<SLOPE> {
                potential: self,
                many,
                q,
            }),
            _ => self.level.run(One::<SLOPE> { potential: self, q }),
        }
    }

    /// The sum over all pairs of `K / r^3` times a polynomial in `1 / r` ([`motion`]; its coefficients,
    /// highest power first), with r the pair's distance minus `reach` (m), or more; infinite if an r is
    /// not more than `least` (m).
    pub(super) fn derivative_bound<const TERMS: usize>(
        &self,
        terms: [f64; TERMS],
        q: &Configuration,
        [reach, least]: [f64; 2],
    ) -> f64 {
        let bound = DerivativeBound {
            potential: self,
            q,
            reach,
            least,
            terms,
        };
        let Some(many) = &self.many else {
            return self.level.run(bound);
        };
        if many.is_tabulated(q) {
            return self.level.run(TabulatedBound { bound, many });
        }
        let [fixed, moving] = many.groups.each_ref().map(|groups| &groups[0]);
        let distance = many.sight(q).distance(fixed, moving);
        let k = MU0_OVER_4PI * fixed.magnitude * moving.magnitude;
        motion::bound(&terms, k, distance - reach)
    }
}

/// Dipoles with their moments scaled by `sqrt(mu0 / 4 pi)`, so that products of two are in J m^3,
/// padded to a multiple of `group`.
fn scaled_and_filled(dipoles: &[Dipole], group: usize) -> Vec<Dipole> {
    let scale = MU0_OVER_4PI.sqrt();
    let scaled = |dipole: &Dipole| Dipole {
        position: dipole.position,
        moment: dipole.moment * scale,
    };
    let mut filled: Vec<_> = dipoles.iter().map(scaled).collect();
    fill(&mut filled, group);
    filled
}

impl Potential for DipolePotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.one::<false>(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.one::<true>(q)
    }

    fn energies(&self, qs: &[Configuration], out: &mut [f64]) {
        assert_eq!(qs.len(), out.len(), "one energy for each configuration");
        if self.many.is_some() {
            for (q, u) in qs.iter().zip(out) {
                *u = self.energy(q);
            }
            return;
        }
        self.level.run(InLanes::<_, false> {
            potential: self,
            qs,
            put: |i: usize, energy, _| out[i] = energy,
        });
    }

    fn energies_and_gradients(&self, qs: &[Configuration], out: &mut [(f64, Vector3<f64>)]) {
        assert_eq!(qs.len(), out.len(), "one result for each configuration");
        if self.many.is_some() {
            for (q, result) in qs.iter().zip(out) {
                *result = self.energy_and_gradient(q);
            }
            return;
        }
        self.level.run(InLanes::<_, true> {
            potential: self,
            qs,
            put: |i: usize, energy, gradient| out[i] = (energy, gradient),
        });
    }

    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let terms = motion::second_derivative(self.lever.turn());
        self.derivative_bound(terms, q, [reach, 0.0])
    }

    fn fourth_derivative_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let terms = motion::fourth_derivative(self.lever.turn());
        self.derivative_bound(terms, q, [reach, 0.0])
    }

    fn is_expensive(&self) -> bool {
        self.many.is_some()
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.lever.displacement(step)
    }
}

#[cfg(test)]
mod tests;
