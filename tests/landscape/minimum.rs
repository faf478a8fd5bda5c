//! Descents to minima of real tiles.

use std::f64::consts::FRAC_PI_2;

use tilebind::design::{Design, MagnetModel};
use tilebind::landscape::capture::{self, FarStarts, start};
use tilebind::landscape::constrained::{downhill, step_along};
use tilebind::landscape::minimum::{Known, Outcome, approach, descend};
use tilebind::landscape::stationary;
use tilebind::roadmap::Point;
use tilebind::{Configuration, Problem};

use crate::designs;

/// Where overdamped motion leads, without known ends: into a minimum or over the table's rim.
pub fn drift(problem: &Problem, start: &Configuration) -> Outcome {
    approach(problem, start, &Known::default()).outcome
}

fn far_starts(problem: &Problem, count: usize) -> impl Iterator<Item = Configuration> {
    let starts = FarStarts { count, seed: 1 };
    (0..count).map(move |number| start(problem, &starts, number))
}

#[test]
fn a_shallow_minimum_is_not_jumped_out_of() {
    // 2 mm beside this one a ridge of 16 µJ hides a slope that falls by 16 mJ.
    let design = designs::load("shapes/arrowhead.toml");
    let problem = design.problem();
    let minimum = Configuration::new(0.347_926_5, -0.052_362_2, 0.0);
    for [x, y, theta] in [
        [0.347_843_4, -0.052_206_4, -1.298e-6],
        [0.347_833_9, -0.052_187_7, 1.312e-6],
        [0.348_1, -0.052_3, 0.0],
    ] {
        let start = Configuration::new(x, y, theta);
        assert!(problem.is_free(&start), "{start:?}");
        let Outcome::Minimum(end) = descend(&problem, &start).outcome else {
            panic!("no minimum from {start:?}");
        };
        let distance = problem.space.distance(&end.point.q, &minimum);
        assert!(distance < 1e-6, "from {start:?}: {:?}", end.point.q);
    }
}

#[test]
fn blocks_come_to_rest_beside_the_bond_as_dipoles_do() {
    // Slid by one magnet, blocks of both tiles touch edge to edge, where the second derivative
    // of their energy has no bound and the energy itself is least certain.
    let mut design = designs::load("shapes/one-face.toml");
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        design.interaction.model = model;
        let problem = design.problem();
        for y in [0.041, 0.039, -0.039, -0.041] {
            let start = Configuration::new(0.43, y, 0.0);
            let Outcome::Minimum(end) = drift(&problem, &start) else {
                panic!("{model:?} from {y}: no minimum");
            };
            let aside = end.point.q.y.abs() - 0.04;
            assert!(aside.abs() < 5e-5, "{model:?} from {y}: {:?}", end.point.q);
        }
    }
}

/// Two tiles of twelve sides, a face of each with magnets.
const TWELVE_SIDED: &str = r#"
[table]
size = [2.0, 2.0]
[fixed]
side = 0.1
sides = 12
thickness = 0.013
mass = 0.06
[fixed.faces]
0 = { code = "NNNS" }
[moving]
side = 0.1
sides = 12
thickness = 0.013
mass = 0.06
[moving.faces]
6 = { mates = "0" }
[magnet]
size = [0.003, 0.003, 0.002]
pitch = 0.0093
remanence = 1.2
inset = 0.0
[target]
fixed = "0"
moving = "6"
[potential]
model = "dipole"
"#;

#[test]
fn tiles_slide_along_each_other_however_weak_the_force() {
    let design = Design::parse(TWELVE_SIDED, "twelve-sided.toml").unwrap();
    let problem = design.problem();
    // Face to face on the far side of the magnets: 3e-9 N press them, 1e-10 N push along.
    let apothem = 0.05 / (std::f64::consts::PI / 12.0).tan();
    let flush = Configuration::new(-0.065, -2.0 * apothem, std::f64::consts::PI / 6.0);
    let point = Point::new(&problem, flush);
    assert!(point.gradient.xy().norm() < 1e-8, "{point:?}");
    let heading = downhill(&problem, &point).unwrap();
    assert!(!heading.pressed.is_empty());
    for scale in [1e-6, 1e6, 1e9] {
        let gradient = scale * point.gradient;
        let scaled = downhill(&problem, &Point { gradient, ..point });
        let same = scaled.unwrap();
        assert!(
            (same.direction - heading.direction).norm() < 1e-9,
            "{scale}"
        );
        assert_eq!(same.pressed, heading.pressed);
    }
    let next = step_along(&problem, &point, &downhill(&problem, &point).unwrap(), 1e-3).unwrap();
    assert!(next.energy < point.energy);
    assert!((next.q.x - flush.x).abs() > 9e-4, "{next:?}");
}

/// If the energy only decreases, no step of Newton's method is short enough, and it gives up soon.
#[test]
fn a_search_for_a_minimum_on_a_slope_is_given_up_soon() {
    let problem = designs::load("shapes/shielded-backs.toml").problem();
    let mut lost = 0;
    for start in far_starts(&problem, 20) {
        let way = approach(&problem, &start, &Known::default()).way;
        for point in way.iter().step_by(7) {
            let before = problem.evaluations();
            let found = stationary::minimum(&problem, &point.q);
            let asked = problem.evaluations() - before;
            assert!(asked < 400, "{:?}: {asked} energies", point.q);
            lost += usize::from(found.is_none());
        }
    }
    assert!(lost > 20, "{lost}");
}

/// A tile that slides along a face with a slot falls into it, however long the steps are: with
/// steps ten times finer, no path ends in the trap beside it.
#[test]
fn tiles_do_not_pass_by_a_slot_that_they_would_fall_into() {
    let problem = designs::load("shapes/slot-15mm.toml").problem();
    let mut bound = 0;
    for start in far_starts(&problem, 60) {
        if let Outcome::Minimum(end) = drift(&problem, &start) {
            let Point { q, energy, .. } = end.point;
            // The other sides have no magnets and hold almost nothing.
            let is_bound = energy < -0.06;
            assert!(
                is_bound || energy > -1e-4,
                "{start:?} ends in {q:?}: {energy} J"
            );
            bound += usize::from(is_bound);
        }
    }
    assert!(bound > 20, "{bound}");
}

#[test]
fn tiles_that_slide_flush_are_held_at_both_ends_of_their_faces() {
    let problem = designs::load("shapes/sine-teeth-20mm.toml").problem();
    // One end of the faces touches, the other has a gap of 2 µm: a sufficient force presses on
    // both.
    let tilted = Configuration::new(-0.266_487_007, -0.430_002_624_331, 1.570_808_533);
    let point = Point::new(&problem, tilted);
    let next = step_along(&problem, &point, &downhill(&problem, &point).unwrap(), 1e-3)
        .expect("they slide on")
        .q;
    assert!((next.theta - FRAC_PI_2).abs() < 1e-9, "{next:?}");
    assert!((next.y + 0.43).abs() < 1e-9, "{next:?}");
    assert!((next.x - tilted.x).abs() > 8e-4, "{next:?}");
}

/// Two contacts allow only one direction of motion: a motion that reaches a known one along them
/// ends where that one does, and is not followed further.
#[test]
fn far_starts_that_come_on_a_known_slide_end_where_it_does() {
    let count = 200;
    let design = || designs::load("shapes/tab-20mm.toml").problem();
    let (alone, together) = (design(), design());
    let followed = far_starts(&alone, count).map(|q| match drift(&alone, &q) {
        Outcome::Minimum(found) => Some(found.point.q),
        Outcome::Stuck(q) => Some(q),
        Outcome::Free => None,
    });
    let starts = FarStarts { count, seed: 1 };
    let ends = capture::ends(&together, &starts, Known::default(), &|_| ());
    for (number, (one, other)) in followed.zip(&ends).enumerate() {
        let apart = match (one, other) {
            (Some(one), Some(other)) => alone.space.distance(&one, other),
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        assert!(apart < 1e-6, "start {number} ends {apart} m away");
    }
    assert!(together.evaluations() < alone.evaluations() * 9 / 10);
}
