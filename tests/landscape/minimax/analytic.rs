//! Landscapes whose saddles are known.

use crate::surfaces::{DoubleWell, MuellerBrown};
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::landscape::minimax::{Certifier, End, Ordering};

use super::scene::effort;

const SPACE: ConfigurationSpace = ConfigurationSpace {
    half_size: [1.0, 1.0],
    rho: 0.1,
    free_distance: 10.0,
};

#[test]
fn the_saddle_of_the_double_well_lies_in_ever_narrower_brackets() {
    let well = DoubleWell {
        height: 2e-3,
        half_distance: 0.4,
        stiffness: 0.03,
    };
    let mut certifier = Certifier::new(&well, None, &SPACE);
    let from = Configuration::new(-0.4, 0.0, 0.3);
    let to = End::At(Configuration::new(0.4, 0.0, -2.0));
    let mut known = Vec::new();
    let mut last = f64::INFINITY;
    let mut lower = f64::NEG_INFINITY;
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let effort = effort(tolerance, 300_000);
        let bracket = certifier.bracket(&from, &to, &known, &effort).unwrap();
        let upper = bracket.bounds.upper.unwrap();
        assert!(
            bracket.bounds.least() <= 2e-3 && 2e-3 <= upper,
            "{bracket:?}"
        );
        assert!(bracket.bounds.width() <= tolerance && bracket.bounds.width() <= last);
        assert!(bracket.bounds.least() >= lower);
        last = bracket.bounds.width();
        lower = bracket.bounds.least();
        known = bracket.pathway;
    }
}

#[test]
fn both_saddles_of_mueller_and_brown_are_bracketed_and_told_apart() {
    let surface = MuellerBrown {
        scale: 1e-3,
        length: 0.4,
        origin: [0.05, -0.35],
    };
    let at = |x: f64, y: f64| surface.configuration(x, y);
    let deep = at(-0.55822, 1.44173);
    let middle = at(-0.05001, 0.46669);
    let right = at(0.62350, 0.02804);
    let mut certifier = Certifier::new(&surface, None, &SPACE);
    let mut bracket = |from: &Configuration, to: Configuration| {
        certifier
            .bracket(from, &End::At(to), &[], &effort(1e-5, 1_000_000))
            .unwrap()
    };
    let high = bracket(&deep, middle);
    let low = bracket(&middle, right);
    let over_both = bracket(&deep, right);
    for (found, saddle) in [
        (&high, -40.66484e-3),
        (&low, -72.24894e-3),
        (&over_both, -40.66484e-3),
    ] {
        let upper = found.bounds.upper.unwrap();
        assert!(found.bounds.width() <= 1e-5, "{found:?}");
        assert!(
            found.bounds.least() <= saddle + 1e-8 && saddle - 1e-8 <= upper,
            "{saddle} {found:?}"
        );
    }
    assert_eq!(high.bounds.compare(&low.bounds), Ordering::Higher);
    assert_eq!(low.bounds.compare(&high.bounds), Ordering::Lower);
    assert_eq!(high.bounds.compare(&over_both.bounds), Ordering::Undecided);
    let saddle = high.saddle.unwrap();
    let expected = at(-0.82200, 0.62431);
    assert!((saddle.position() - expected.position()).norm() < 0.02);
}
