//! The energy of groups of dipoles, pair of groups by pair of groups.

use nalgebra::Vector3;

use super::DipolePotential;
use crate::configuration::Configuration;
use crate::potential::groups::tree::{Group, LOST_ALONG, Purpose};
use crate::potential::groups::walk::Sight;
use crate::potential::motion;
use crate::potential::parts::{Part, Parts, Sifted};
use crate::units::MU0_OVER_4PI;

/// Of fewer parts each is slow only where it takes no more than one of so many may.
const FEW: usize = 256;

/// What is lost of a pair of groups at a distance r changes with each metre of a dipole's motion by
/// no more than this over r times its bound (`n + 3`, for n = 24 nodes at most), and with each radian
/// of a turn, which moves dipoles by what is linear in their places and turns their moments, by no
/// more than this times its bound (`n + 1`).
const SLOPE_OF_LOST: f64 = 27.0;

impl DipolePotential {
    fn trees(&self) -> [&[Group]; 2] {
        match &self.groups {
            Some([fixed, moving]) => [fixed, moving],
            None => [&[], &[]],
        }
    }
}

impl Parts for DipolePotential {
    fn whole(&self) -> Part {
        [0, 0]
    }

    fn energy_and_gradient_of(
        &self,
        parts: &[Part],
        q: &Configuration,
        roughly: bool,
    ) -> (f64, Vector3<f64>) {
        let purpose = if roughly {
            Purpose::Along
        } else {
            Purpose::Energy
        };
        self.one::<true>(q, Some((parts, purpose)))
    }

    fn fourth_derivative_bound_of(&self, parts: &[Part], q: &Configuration, reach: f64) -> f64 {
        let terms = motion::fourth_derivative(self.lever.turn());
        self.derivative_bound(terms, q, reach, Some(parts))
    }

    /// Slow are pairs of groups that take a small share of what is allowed each, as long as some of
    /// it is left.
    ///
    /// The cubic of a function with the fourth derivative D is off by `(2 reach)^4 D / 384` (Davis,
    /// *Interpolation and Approximation*, theorem 3.5.1); values and slopes that are off by e and e'
    /// at the ends add `e + 2 reach e' / 4`.
    fn sift(&self, parts: &[Part], q: &Configuration, reach: f64, allowed: f64) -> Sifted {
        let sight = Sight::new(self.trees(), q);
        let [fixed, moving] = sight.groups;
        let terms = motion::fourth_derivative(self.lever.turn());
        let share = allowed / parts.len().max(FEW) as f64;
        let mut sifted = Sifted::default();
        let mut open = parts.to_vec();
        while let Some([f, m]) = open.pop() {
            let (first, second) = (&fixed[f], &moving[m]);
            let k = MU0_OVER_4PI * first.magnitude * second.magnitude;
            let clear = sight.distance(first, second) - reach;
            let slope = SLOPE_OF_LOST * (1.0 / clear + self.lever.turn());
            let lost = LOST_ALONG * k / clear.powi(3) * (1.0 + slope * reach / 2.0);
            let off = motion::bound(&terms, k, clear) * reach.powi(4) / 24.0 + lost;
            if clear > 0.0 && off <= share && sifted.off + off <= allowed {
                sifted.off += off;
                sifted.slow.push([f, m]);
                continue;
            }
            // Pieces of what is as short as the motion are no farther apart than the whole.
            let is_longer = |group: &&Group| group.half[0] > reach;
            let longer = if second.half[0] > first.half[0] {
                [second, first]
            } else {
                [first, second]
            };
            let cut = longer
                .into_iter()
                .filter(is_longer)
                .find_map(|group| Some((std::ptr::eq(group, second), group.parts?)));
            match cut {
                Some((true, parts)) => open.extend(parts.map(|part| [f, part])),
                Some((false, parts)) => open.extend(parts.map(|part| [part, m])),
                None => sifted.fast.push([f, m]),
            }
        }
        sifted
    }
}
