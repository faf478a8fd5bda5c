//! The sum over all pairs of magnets at one configuration: far ones in vectors, near ones by their faces.

use nalgebra::{Complex, Vector3};

use super::{Alike, Body, BodyPotential, Pairs};
use crate::configuration::Configuration;
use crate::potential::far::group::Group;
use crate::potential::far::rows::{Facing, Known};
use crate::potential::far::terms::Sums;
use crate::potential::simd::lanes::{Lanes, Task};
use crate::units::MU0_OVER_4PI;

/// No pair is measured by a stronger one: far apart, the energies of magnets of both signs cancel to a small
/// share of each, and errors of all pairs that change at once would look like minima.
const ALONE: f64 = 0.0;

/// The energy at a configuration, and its gradient if requested.
pub struct BodySum<'a, const SLOPE: bool> {
    pub potential: &'a BodyPotential,
    pub q: &'a Configuration,
}

impl<const SLOPE: bool> Task for BodySum<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let (sin, cos) = libm::sincos(self.q.theta);
        let rotation = Complex::new(cos, sin);
        let (mut sums, mut known, mut near) = (Sums::zero(l), Known::none(), Vec::new());
        let mut total = (0.0, Vector3::zeros());
        for (groups, pairs) in self.potential.of_groups() {
            let facing = Facing::new(&pairs.far, members(groups), self.q, rotation);
            let all = 0..groups[1].members.count;
            facing.add_far::<L, SLOPE>(l, all, ALONE, &mut known, &mut sums, &mut near);
            for places in near.drain(..) {
                self.add_near(groups, places, pairs, &mut total);
            }
        }
        let [x, y, turn] = sums.gradient;
        let far = Vector3::new(l.sum(x), l.sum(y), l.sum(turn));
        (
            total.0 - MU0_OVER_4PI * l.sum(sums.energy),
            total.1 - far * MU0_OVER_4PI,
        )
    }
}

fn members([first, second]: [&Alike; 2]) -> [&Group; 2] {
    [&first.members, &second.members]
}

impl<const SLOPE: bool> BodySum<'_, SLOPE> {
    /// Adds the pair of two members of groups.
    fn add_near(
        &self,
        [first, second]: [&Alike; 2],
        [i, j]: [usize; 2],
        pairs: &Pairs,
        (energy, gradient): &mut (f64, Vector3<f64>),
    ) {
        let BodyPotential { fixed, moving, .. } = self.potential;
        let rotation = self.q.rotation();
        let arm = rotation * moving.bodies[second.members.members[j]].position;
        let way = arm + self.q.position() - fixed.bodies[first.members.members[i]].position;
        let direction = rotation * second.like.direction;
        let other = Body {
            position: way,
            direction,
            ..second.like
        };
        let found = pairs.near(&first.like, &other);
        let moments = first.members.moment[i] * second.members.moment[j];
        let force = found.gradient * moments;
        *energy += moments * found.energy;
        let turn = moments * found.slope + arm.perp(&force);
        *gradient += Vector3::new(force.x, force.y, turn);
    }
}
