//! The energy of groups of dipoles, pair of groups by pair of groups.

use nalgebra::Vector3;

use super::DipolePotential;
use crate::configuration::Configuration;
use crate::potential::groups::tree::Group;
use crate::potential::groups::walk::Sight;
use crate::potential::motion;
use crate::potential::parts::{Part, Parts, Sifted};
use crate::units::MU0_OVER_4PI;

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

    fn energy_and_gradient_of(&self, parts: &[Part], q: &Configuration) -> (f64, Vector3<f64>) {
        self.one::<true>(q, Some(parts))
    }

    fn fourth_derivative_bound_of(&self, parts: &[Part], q: &Configuration, reach: f64) -> f64 {
        let terms = motion::fourth_derivative(self.lever.turn());
        self.derivative_bound(terms, q, reach, Some(parts))
    }

    /// Of `limit` each pair of groups may have the share that the product of their moments'
    /// magnitudes has in that of the whole tiles; these shares add up to 1 of whatever pieces the
    /// whole consists.
    fn sift(&self, parts: &[Part], q: &Configuration, reach: f64, limit: f64) -> Sifted {
        let sight = Sight::new(self.trees(), q);
        let [fixed, moving] = sight.groups;
        let terms = motion::fourth_derivative(self.lever.turn());
        let allowed = limit / (fixed[0].magnitude * moving[0].magnitude);
        let mut sifted = Sifted::default();
        let mut open = parts.to_vec();
        while let Some([f, m]) = open.pop() {
            let (first, second) = (&fixed[f], &moving[m]);
            let clear = sight.distance(first, second) - reach;
            if motion::bound(&terms, MU0_OVER_4PI, clear) <= allowed {
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
