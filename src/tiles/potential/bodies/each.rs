//! The pairs of two tiles' magnets one by one, for what acts on each of them, such as shields.

use super::BodyPotential;
use super::limits::BodyLimits;
use crate::configuration::Configuration;
use crate::potential::far::PairEnergy;
use crate::potential::motion;
use crate::units::MU0_OVER_4PI;

/// Two magnets that both lie or both stand, apart.
pub(super) struct Apart<'a> {
    /// Their numbers in the two tiles.
    numbers: [usize; 2],
    /// The sum of their radii (m).
    pub radii: f64,
    /// The distance (m) of the circles about them.
    pub distance: f64,
    /// `mu0 m1 m2 / (4 pi)` (J m^3), positive.
    pub strength: f64,
    limits: &'a Option<BodyLimits>,
}

impl Apart<'_> {
    /// A bound (J/m^2) of the second derivative within a reach (m), which the distance is short of, see
    /// [`Potential::curvature_bound`](crate::potential::Potential::curvature_bound).
    pub fn curvature(&self, turn: f64, reach: f64) -> f64 {
        let far = self.far(&motion::second_derivative(turn));
        match self.limits {
            Some(limits) if self.distance <= 2.0 * self.radii => {
                let distance = self.distance.max(reach / 16.0);
                far.min(self.strength * limits.curvature(turn, distance))
            }
            _ => far,
        }
    }

    /// A bound of the energy (J), and of its derivative (J/m) along a motion in which no point is faster than 1 and
    /// the magnet turns at most at the rate `turn` (1/m).
    fn energy_and_slope(&self, turn: f64) -> [f64; 2] {
        let far = [self.far(&[2.0]), self.far(&[6.0, 2.0 * turn])];
        self.limits.as_ref().map_or(far, |limits| {
            let near = [limits.energy(), limits.slope()];
            [0, 1].map(|k| far[k].min(self.strength * near[k]))
        })
    }

    fn far(&self, terms: &[f64]) -> f64 {
        motion::bound(terms, self.strength, self.distance)
    }
}

impl BodyPotential {
    /// All pairs but those of a magnet that lies and one that stands, with distances less a reach (m).
    pub(super) fn each_apart(
        &self,
        q: &Configuration,
        reach: f64,
    ) -> impl Iterator<Item = Apart<'_>> {
        let rotation = q.rotation();
        let position = q.position();
        self.of_groups().flat_map(move |([first, second], pairs)| {
            let radii = match pairs.limits {
                Some(_) => first.like.radius() + second.like.radius(),
                None => 0.0,
            };
            let moving = self.moving.places(second);
            moving.flat_map(move |(j, place, m2)| {
                let place = rotation * place + position;
                self.fixed.places(first).map(move |(i, from, m1)| Apart {
                    numbers: [i, j],
                    radii,
                    distance: (place - from).norm() - radii - reach,
                    strength: MU0_OVER_4PI * (m1 * m2).abs(),
                    limits: &pairs.limits,
                })
            })
        })
    }

    /// The energies of all pairs; the pair of the fixed magnet i and the moving magnet j has the index
    /// `j * fixed magnets + i`. A magnet that lies and one that stands have none.
    pub(in crate::potential) fn pairs(&self, q: &Configuration) -> Vec<PairEnergy> {
        let count = self.fixed.bodies.len();
        let mut out = vec![PairEnergy::default(); count * self.moving.bodies.len()];
        self.for_each_single(
            q,
            |_, _| false,
            |single| {
                let [i, j] = single.numbers;
                out[j * count + i] = single.still();
            },
        );
        out
    }

    /// Bounds within a reach (m) of |u| (J), |u'| (J/m) and |u''| (J/m^2) of pairs, along motions in which no point
    /// is faster than 1 and magnets turn at most at the rate `turn` (1/m), with the pairs' numbers.
    pub(in crate::potential) fn pair_limits(
        &self,
        q: &Configuration,
        turn: f64,
        reach: f64,
    ) -> impl Iterator<Item = ([usize; 2], [f64; 3])> {
        self.each_apart(q, reach).map(move |pair| {
            let [energy, slope] = pair.energy_and_slope(turn);
            (pair.numbers, [energy, slope, pair.curvature(turn, reach)])
        })
    }
}
