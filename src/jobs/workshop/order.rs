//! The order in which magnets go into their pockets.
//!
//! A magnet is inserted from above. At a height z above the plane of the magnets already in place
//! it feels their field: a magnet that points the same way pushes it out, one that points the other
//! way draws it in. (This also holds for magnets magnetised across the table.) The chosen order has
//! the smallest largest push, taken over all heights and magnets. The magnets are modelled as point
//! dipoles.

use physics::tile::Magnet;
use physics::units::MU0_OVER_4PI;

/// Up to this number of magnets every order is tried; with more, the next one is always the one
/// that is pushed least.
const ALL_ORDERS: usize = 10;
/// Number of heights at which the push is computed, and the largest height in lengths of a magnet.
const HEIGHTS: usize = 60;
const HIGHEST: f64 = 3.0;

/// The insertion of one magnet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The index of the magnet.
    pub magnet: usize,
    /// The largest force (N) that pushes it out during insertion; 0 if it is drawn in.
    pub push: f64,
}

/// The order of insertion with the smallest largest push.
pub fn order(magnets: &[&Magnet]) -> Vec<Step> {
    let n = magnets.len();
    let push = |next: usize, placed: &dyn Fn(usize) -> bool| {
        let placed: Vec<&Magnet> = (0..n).filter(|&k| placed(k)).map(|k| magnets[k]).collect();
        push(magnets[next], &placed)
    };
    let mut steps = Vec::with_capacity(n);
    if n > ALL_ORDERS {
        let mut is_in = vec![false; n];
        for _ in 0..n {
            let left = (0..n).filter(|&k| !is_in[k]);
            let pushes = left.map(|k| Step {
                magnet: k,
                push: push(k, &|j| is_in[j]),
            });
            if let Some(step) = pushes.min_by(|a, b| a.push.total_cmp(&b.push)) {
                is_in[step.magnet] = true;
                steps.push(step);
            }
        }
        return steps;
    }
    // The smallest largest push over all orders that fill a set of pockets, and the last one
    // filled.
    let mut best: Vec<(f64, usize)> = vec![(f64::INFINITY, 0); 1 << n];
    best[0] = (0.0, 0);
    for set in 0..1_usize << n {
        for next in (0..n).filter(|k| set >> k & 1 == 0) {
            let worst = best[set].0.max(push(next, &|j| set >> j & 1 == 1));
            let filled = set | 1 << next;
            if worst < best[filled].0 {
                best[filled] = (worst, next);
            }
        }
    }
    let mut set = (1 << n) - 1;
    while set > 0 {
        let magnet = best[set].1;
        set &= !(1 << magnet);
        steps.push(Step {
            magnet,
            push: push(magnet, &|j| set >> j & 1 == 1),
        });
    }
    steps.reverse();
    steps
}

/// The largest force (N) out of the plane on a magnet inserted beside others.
fn push(magnet: &Magnet, placed: &[&Magnet]) -> f64 {
    let heights =
        (1..=HEIGHTS).map(|k| HIGHEST * magnet.axis_first()[0] * k as f64 / HEIGHTS as f64);
    let force = |z: f64| {
        placed
            .iter()
            .map(|other| vertical_force(magnet, other, z))
            .sum()
    };
    heights.map(force).fold(0.0, f64::max)
}

/// The force (N) along z on a dipole at height z above the plane of another one: minus the derivative of
/// `mu0 / 4 pi (m1 m2 / R^3 - 3 (m1 R) (m2 R) / R^5)`.
fn vertical_force(one: &Magnet, other: &Magnet, z: f64) -> f64 {
    let moment = |magnet: &Magnet| {
        let up = magnet.form.stands.map_or(0.0, |up| up.sign()) * magnet.moment;
        magnet.moment_vector().push(up)
    };
    let (a, b) = (moment(one), moment(other));
    let d = (one.position - other.position).push(z);
    let square = d.norm_squared();
    let (along, beside) = (a.dot(&d), b.dot(&d));
    let bracket = z * (a.dot(&b) - 5.0 * along * beside / square) + along * b.z + beside * a.z;
    MU0_OVER_4PI * 3.0 * bracket / libm::pow(square, 2.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn row(code: &str) -> Vec<Magnet> {
        let magnets = code.chars().enumerate().map(|(k, pole)| Magnet {
            position: Vector2::new(0.02 * k as f64, 0.0),
            angle: if pole == 'N' {
                FRAC_PI_2
            } else {
                FRAC_PI_2 - PI
            },
            moment: 0.3,
            size: [0.01, 0.01, 0.003],
            form: Default::default(),
            face: 0,
        });
        magnets.collect()
    }

    #[test]
    fn neighbours_that_point_apart_draw_each_other_in() {
        let magnets = row("NSNS");
        let steps = order(&magnets.iter().collect::<Vec<_>>());
        assert_eq!(steps.len(), 4);
        assert!(steps.iter().all(|step| step.push == 0.0), "{steps:?}");
        // Magnets of one kind push each other out, one between two others most.
        let magnets = row("NNN");
        let steps = order(&magnets.iter().collect::<Vec<_>>());
        assert!(steps[0].push == 0.0 && steps[2].push > 0.0, "{steps:?}");
        assert!(steps[2].magnet != 1, "{steps:?}");
    }

    #[test]
    fn the_force_is_minus_the_derivative_of_the_energy() {
        let magnets = row("NN");
        let energy = |z: f64| {
            let square: f64 = 0.02 * 0.02 + z * z;
            MU0_OVER_4PI * 0.09 / libm::pow(square, 1.5)
        };
        let z = 0.007;
        let expected = -(energy(z + 1e-6) - energy(z - 1e-6)) / 2e-6;
        let force = vertical_force(&magnets[0], &magnets[1], z);
        assert!((force / expected - 1.0).abs() < 1e-6, "{force} {expected}");
    }
}
