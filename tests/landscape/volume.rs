//! Energies over boxes of configurations, as the page shows them.

use std::f64::consts::TAU;

use tilebind::landscape::approach::Approach;
use tilebind::landscape::volume::{InFront, around};
use tilebind::{Configuration, Problem};

use crate::designs;

fn problem(file: &str) -> Problem {
    designs::load(file).problem()
}

#[test]
fn around_holds_the_energy_of_each_free_configuration_and_of_no_other() {
    let problem = problem("shapes/tab-10mm.toml");
    let volume = around(&problem, [0.7, 0.5], 8, 21);
    let [thetas, y, x] = &volume.axes;
    assert_eq!((thetas.len(), y.len(), x.len()), (8, 15, 21));
    assert!(thetas.is_sorted() && thetas[0] == -std::f64::consts::PI);
    let mut blocked = 0;
    for (i, energy) in volume.energies.iter().enumerate() {
        let theta = thetas[i / (15 * 21)];
        let q = Configuration::from([x[i % 21], y[i / 21 % 15], theta]);
        assert_eq!(energy.is_some(), problem.is_clear(&q), "{q:?}");
        if let Some(energy) = energy {
            assert!((energy - problem.energy(&q)).abs() <= 1e-12 * energy.abs());
        }
        blocked += usize::from(energy.is_none());
    }
    assert!(blocked > 100 && blocked < volume.energies.len() - 100);
}

#[test]
fn around_covers_what_repeats_once() {
    let problem = problem("shapes/paper-tile.toml");
    let [thetas, ..] = around(&problem, [0.7, 0.7], 16, 5).axes;
    let expected = [-2.0, -1.0, 0.0, 1.0].map(|k| k * TAU / 16.0);
    assert_eq!(thetas, expected);
}

#[test]
fn in_front_the_gap_is_drawn_back_from_touching() {
    let problem = problem("shapes/triangle-teeth-10mm.toml");
    let pair = problem.pair.clone().unwrap();
    let approach = Approach::new(&pair);
    let (tilts, slides) = (vec![-0.2, 0.0, 0.3], vec![-0.05, 0.0, 0.05]);
    let gaps = vec![0.0, 0.02];
    let found = InFront::new(
        &problem,
        &approach,
        gaps.clone(),
        tilts.clone(),
        slides.clone(),
    );
    assert_eq!(found.volume.energies.len(), 18);
    for (i, energy) in found.volume.energies.iter().enumerate() {
        let (gap, tilt, slide) = (gaps[i / 9], tilts[i / 3 % 3], slides[i % 3]);
        let landing = found.landing[i % 9].unwrap();
        let q = approach.configuration(tilt, slide, landing + gap);
        assert!((energy.unwrap() - problem.energy(&q)).abs() <= 1e-12);
        let clearance = problem.clearance(&q);
        if gap == 0.0 {
            assert!(clearance.abs() < 1e-6, "{clearance}");
        } else {
            assert!(clearance > 1e-3 && clearance <= gap + 1e-9, "{clearance}");
        }
    }
    // Flush in the bound configuration.
    assert!(found.landing[4].unwrap().abs() < 1e-9);
}
