//! A landscape whose only low way crosses the seam of theta, from just below pi to just above -pi,
//! in the survey, the certificate, the flow and the map.

use std::collections::HashSet;
use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};
use tilebind::cell::{Cell, Quadratic};
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::landscape::capture::{FarStarts, ends};
use tilebind::landscape::map::{EnergyMap, Window};
use tilebind::landscape::minimax::{Certifier, Effort, End};
use tilebind::landscape::minimum::{Known, Outcome};
use tilebind::potential::Potential;
use tilebind::potential::bounds::{CellBounds, Enclosure};
use tilebind::problem::Problem;

use crate::analytic::{SETTLED, survey};
use crate::designs;
use crate::minimum::drift;
use crate::surfaces::{ROUNDING, check_bounds};

const SPACE: ConfigurationSpace = ConfigurationSpace {
    half_size: [1.0, 1.0],
    rho: LEVER,
    free_distance: 0.5,
};
/// Lever (m) of turns.
const LEVER: f64 = 0.5;

/// Energy (J) of the saddle.
const HEIGHT: f64 = 2e-3;
/// How far (rad) the wells lie from the seam.
const ASIDE: f64 = 0.3;
/// Stiffness (J/m^2) across the valley.
const STIFFNESS: f64 = 0.2;
/// How far (m) the valley swings to either side.
const SWING: f64 = 0.2;

/// Two wells to either side of the seam, joined by a valley that leads over it:
///
/// ```text
/// U = A (cos theta + cos ASIDE)^2 + STIFFNESS/2 [(x + SWING sin theta)^2 + y^2]
/// ```
///
/// with x and y from `centre` and A such that U is HEIGHT on the seam, at the centre. The lowest U
/// at each theta is the first term, so the wells are the only minima (0 J), and the ways between
/// them lead over the saddle on the seam, or over one of 3.8 J at theta = 0.
#[derive(Clone, Copy)]
struct Seam {
    centre: [f64; 2],
}

const AT_ORIGIN: Seam = Seam { centre: [0.0, 0.0] };

fn amplitude() -> f64 {
    HEIGHT / (1.0 - ASIDE.cos()).powi(2)
}

impl Seam {
    /// The wells, the one below pi first.
    fn wells(&self) -> [Configuration; 2] {
        [PI - ASIDE, ASIDE - PI].map(|theta| {
            let x = self.centre[0] - SWING * theta.sin();
            Configuration::new(x, self.centre[1], theta)
        })
    }

    /// Which of the wells is here, if any; its theta must be the one in (-pi, pi].
    fn well_at(&self, q: &Configuration) -> Option<usize> {
        let here = |well: &Configuration| {
            (q.position() - well.position()).norm() < 1e-5 && (q.theta - well.theta).abs() < 1e-5
        };
        self.wells().iter().position(here)
    }

    fn form(&self, q: &Configuration) -> Quadratic {
        let (x, y) = (q.x - self.centre[0], q.y - self.centre[1]);
        let (sin, cos) = q.theta.sin_cos();
        let (a, k) = (amplitude(), STIFFNESS);
        let off = cos + ASIDE.cos();
        let aside = x + SWING * sin;
        Quadratic {
            value: a * off * off + 0.5 * k * (aside * aside + y * y),
            gradient: [
                k * aside,
                k * y,
                -2.0 * a * off * sin + k * aside * SWING * cos,
            ],
            hessian: [
                k,
                k,
                2.0 * a * (sin * sin - off * cos) + k * SWING * (SWING * cos * cos - aside * sin),
                0.0,
                k * SWING * cos,
                0.0,
            ],
        }
    }

    /// Bounds of the third derivatives by theta (J/rad^3), and by x and twice by theta, where the
    /// valley's middle is at most `x` (m) away.
    fn third_derivatives(&self, x: f64) -> [f64; 2] {
        let along = amplitude() * (4.0 + 2.0 * ASIDE.cos());
        let across = STIFFNESS * SWING;
        [along + across * (x + 2.0 * SWING), across]
    }
}

impl Potential for Seam {
    fn energy(&self, q: &Configuration) -> f64 {
        self.form(q).value
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let form = self.form(q);
        (form.value, form.gradient.into())
    }

    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let [along, across] = self.third_derivatives((q.x - self.centre[0]).abs() + reach);
        let turn = self.form(q).hessian[2].abs() + along * reach / LEVER + across * reach;
        STIFFNESS * (1.0 + SWING / LEVER) + turn / LEVER.powi(2)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        SPACE.length(step)
    }
}

impl CellBounds for Seam {
    /// The third-order terms of the Taylor series.
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let [dx, dy, turn] = cell.half;
        let x = (cell.centre.x - self.centre[0]).abs() + dx;
        let y = (cell.centre.y - self.centre[1]).abs() + dy;
        let [along, across] = self.third_derivatives(x);
        let third = (along * turn + 3.0 * across * dx) * turn * turn / 6.0;
        let size = 4.0 * amplitude() + STIFFNESS * ((x + SWING).powi(2) + y * y);
        let remainder = third + ROUNDING * size * (1.0 + turn).powi(2);
        Enclosure {
            form: self.form(&cell.centre),
            low: -remainder,
            high: remainder,
            ..Enclosure::unknown()
        }
    }
}

#[test]
fn enclosures_hold_the_energy() {
    check_bounds(&AT_ORIGIN, 0.5);
}

#[test]
fn the_survey_finds_both_wells_and_the_saddle_on_the_seam() {
    let problem = Problem::without_contact(SPACE, Box::new(AT_ORIGIN));
    let mut exact = 0;
    for seed in 1..=5 {
        let survey = survey(&problem, 3.0 * HEIGHT, 3.0 * HEIGHT, seed);
        assert_eq!(survey.states.len(), 2);
        let nodes = AT_ORIGIN.wells().map(|well| {
            let state = survey.state_at(&well, 1e-5).expect("a minimum");
            assert!(survey.states[state].minimum.point.energy < 1e-12);
            survey.states[state].node
        });
        for [from, to] in [nodes, [nodes[1], nodes[0]]] {
            let barrier = survey.network.minimax(from, &HashSet::from([to]));
            let above = barrier.expect("a way") / HEIGHT - 1.0;
            assert!((-1e-9..SETTLED).contains(&above), "{above}");
        }
        for (saddle, _) in &survey.transition_states {
            let expected = Configuration::new(0.0, 0.0, PI);
            assert!(SPACE.distance(&saddle.point.q, &expected) < 1e-6);
            assert!((saddle.point.energy - HEIGHT).abs() < 1e-9);
        }
        exact += survey.transition_states.len();
    }
    // Where roadmaps cross the saddle at a slant, Newton's method may follow the valley's side.
    assert!(exact >= 4, "{exact} of five");
}

#[test]
fn the_certificate_brackets_the_saddle_from_both_sides() {
    let mut certifier = Certifier::new(&AT_ORIGIN, None, &SPACE);
    let [below, above] = AT_ORIGIN.wells();
    for (from, to) in [(below, above), (above, below)] {
        let effort = Effort {
            tolerance: 1e-5,
            cells: 300_000,
        };
        let bracket = certifier
            .bracket(&from, &End::At(to), &[], &effort)
            .unwrap();
        let upper = bracket.bounds.upper.expect("a way");
        assert!(
            bracket.bounds.least() <= HEIGHT && HEIGHT <= upper,
            "{bracket:?}"
        );
        assert!(bracket.bounds.width() <= effort.tolerance, "{bracket:?}");
        let crosses = |pair: &[Configuration]| pair[0].theta * pair[1].theta < 0.0;
        assert!(bracket.pathway.windows(2).any(crosses));
        let far = |q: &Configuration| q.theta.abs() > PI - 2.0 * ASIDE;
        assert!(bracket.pathway.iter().all(far));
    }
}

/// The well that overdamped motion ends in, and how often it crosses the seam: `v = -M^-1 grad U`
/// in short steps, theta never wrapped.
fn flow(start: [f64; 3]) -> (usize, usize) {
    let mut q = Configuration::new(start[0], start[1], start[2]);
    let turns = |theta: f64| ((theta - PI) / (2.0 * PI)).floor();
    let mut crossings = 0;
    for _ in 0..20_000 {
        let [x, y, turn] = AT_ORIGIN.form(&q).gradient;
        let theta = q.theta - 1e-2 * turn / LEVER.powi(2);
        crossings += usize::from(turns(theta) != turns(q.theta));
        q = Configuration::new(q.x - 1e-2 * x, q.y - 1e-2 * y, theta);
    }
    let end = Configuration::from(q.to_array());
    (AT_ORIGIN.well_at(&end).expect("a well"), crossings)
}

#[test]
fn what_drifts_over_the_seam_ends_in_the_well_beyond() {
    let problem = Problem::without_contact(SPACE, Box::new(AT_ORIGIN));
    let mut crossed = [0, 0];
    for k in 0..8 {
        let aside = 0.04 + 0.08 * f64::from(k);
        for [x, theta] in [[0.5, PI - aside], [-0.5, aside - PI]] {
            let (well, crossings) = flow([x, 0.2, theta]);
            let Outcome::Minimum(end) = drift(&problem, &Configuration::new(x, 0.2, theta)) else {
                panic!("no minimum from {x} {theta}");
            };
            assert_eq!(AT_ORIGIN.well_at(&end.point.q), Some(well), "{x} {theta}");
            crossed[well] += crossings;
        }
    }
    // Those that start closest to the seam, from either side.
    assert!(crossed.iter().all(|&count| count >= 2), "{crossed:?}");
}

#[test]
fn far_starts_end_in_either_well_alike() {
    let problem = Problem::without_contact(SPACE, Box::new(AT_ORIGIN));
    let count = 200;
    let mut captured = [0, 0];
    for end in ends(
        &problem,
        &FarStarts { count, seed: 1 },
        Known::default(),
        &|_| (),
    ) {
        captured[AT_ORIGIN.well_at(&end.unwrap()).unwrap()] += 1;
    }
    // Five standard deviations of a fair coin's count.
    let expected = count as f64 / 2.0;
    let off = (f64::from(captured[0]) - expected).abs();
    assert!(off <= 5.0 * (expected / 2.0).sqrt(), "{captured:?}");
}

/// The map over the valley's middle, where two tiles are free in any orientation: left of it the
/// well below pi is the lower one, right of it the other.
#[test]
fn the_map_takes_the_lower_of_both_sides() {
    let design = designs::load("tests/designs/good/terse.toml");
    let potential = Seam {
        centre: [0.7, 0.05],
    };
    let problem = Problem::without_contact(design.space(), Box::new(potential));
    let problem = problem.with_tiles(design.pair);
    let window = Window {
        origin: Vector2::from(potential.centre),
        angle: 0.0,
        low: [-0.1, -0.05],
        high: [0.1, 0.05],
        samples: [12, 3],
    };
    // An orientation on the seam, and none near the wells: they are found from there.
    let map = EnergyMap::new(&problem, &window, 8);
    for sample in &map.lowest.values {
        let sample = sample.expect("free").configuration;
        let energy = |q: &Configuration| Potential::energy(&potential, q);
        let at = |theta| energy(&Configuration::new(sample.x, sample.y, theta));
        let lowest = (0..10_000)
            .map(|k| at(PI * f64::from(k) / 5000.0))
            .fold(f64::INFINITY, f64::min);
        let found = at(sample.theta);
        assert!(
            (found - lowest).abs() < 0.01 * HEIGHT,
            "{sample:?} {lowest}"
        );
        assert_eq!(sample.theta > 0.0, sample.x < 0.7, "{sample:?}");
        assert!(sample.theta.abs() < PI - 0.1, "{sample:?}");
    }
}
