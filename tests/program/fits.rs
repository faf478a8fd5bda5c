//! `show` names the forces that end each fit of the target faces.

use nalgebra::Vector2;
use tilebind::design::Design;
use tilebind::inspection::{Fit, Inspection, NEGLIGIBLE};
use tilebind::{Configuration, Problem, report};

use crate::designs::load;

/// Squares with these codes on the target faces, magnets as dipoles.
fn squares(fixed: &str, moving: &str) -> Design {
    let text = format!(
        "name = \"squares\"\n[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.006, 0.006, 0.003]\nremanence = 1.2\npitch = 0.02\n\
         [fixed]\nside = 0.1\nthickness = 0.006\nmass = 0.05\n[fixed.faces]\neast = {{ code = \
         \"{fixed}\" }}\n[moving]\nside = 0.1\nthickness = 0.006\nmass = 0.05\n[moving.faces]\nwest \
         = {{ code = \"{moving}\" }}\n[target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\n\
         model = \"dipole\"\n"
    );
    Design::parse(&text, "squares.toml").unwrap()
}

fn turned(q: &Configuration, about: Vector2<f64>, angle: f64) -> Configuration {
    let arm = q.position() - about;
    let (sin, cos) = angle.sin_cos();
    let at = about + Vector2::new(cos * arm.x - sin * arm.y, sin * arm.x + cos * arm.y);
    Configuration::new(at.x, at.y, q.theta + angle)
}

/// The torque is the slope of the energy as the contact opens about a corner, the forces that of
/// straight motions.
fn are_slopes(problem: &Problem, fit: &Fit, corners: [f64; 2], half: f64) {
    let step = 1e-6;
    let slope = |of: &dyn Fn(f64) -> Configuration| {
        (problem.energy(&of(step)) - problem.energy(&of(-step))) / (2.0 * step)
    };
    let opens =
        |y: f64, sign: f64| slope(&|angle| turned(&fit.pose, Vector2::new(half, y), sign * angle));
    // A tile to the east opens counter-clockwise about the upper corner.
    let expected = f64::min(opens(corners[1], 1.0), opens(corners[0], -1.0));
    assert!(
        (fit.tilt - expected).abs() < 1e-6 * expected.abs(),
        "{fit:?} {expected}"
    );
    let pull = |gap: f64| {
        slope(&|more| Configuration::new(fit.pose.x + gap + more, fit.pose.y, fit.pose.theta))
    };
    let most = (0..200)
        .map(|k| pull(2e-4 * f64::from(k)))
        .fold(0.0, f64::max);
    assert!((fit.pull_off / most - 1.0).abs() < 1e-3, "{fit:?} {most}");
    let resists = |sign: f64| {
        let along = |s: f64| {
            slope(&|more| Configuration::new(fit.pose.x, fit.pose.y + sign * (s + more), 0.0))
        };
        let slopes: Vec<f64> = (0..2000).map(|k| along(2e-5 * f64::from(k))).collect();
        let ends = slopes.iter().skip(2).position(|slope| *slope < 0.0);
        slopes[..2 + ends.unwrap_or(slopes.len() - 2)]
            .iter()
            .copied()
            .fold(0.0, f64::max)
    };
    let least = f64::min(resists(1.0), resists(-1.0));
    assert!(
        (fit.slide.unwrap() / least - 1.0).abs() < 0.02,
        "{fit:?} {least}"
    );
}

#[test]
fn the_forces_of_bond_and_traps_are_slopes_of_the_energy() {
    let design = squares("NNNS", "NSSS");
    let found = Inspection::new(&design);
    let problem = design.problem();
    let [bond, wrong, ..] = &found.fits[..] else {
        panic!("{:?}", found.fits);
    };
    assert_eq!(bond.pull_off, found.models[0].pull_off);
    assert_eq!(bond.energy, found.models[0].energy);
    are_slopes(&problem, bond, [-0.05, 0.05], 0.05);
    // Slid by one pitch, two pairs of magnets attract more than one repels.
    assert!(
        wrong.is_mirrored && (wrong.slid - 0.02).abs() < 1e-3,
        "{wrong:?}"
    );
    let down = wrong.pose.y < 0.0;
    let corners = if down {
        [-0.05, 0.05 + wrong.pose.y]
    } else {
        [wrong.pose.y - 0.05, 0.05]
    };
    are_slopes(&problem, wrong, corners, 0.05);
    let energies: Vec<f64> = found.fits.iter().map(|fit| fit.energy).collect();
    assert!(energies[1..].is_sorted(), "{energies:?}");
    for fit in &found.fits[1..] {
        let beside = |s: f64| problem.energy(&Configuration::new(fit.pose.x, fit.pose.y + s, 0.0));
        assert!(
            fit.energy < beside(1e-4) && fit.energy < beside(-1e-4),
            "{fit:?}"
        );
    }
}

#[test]
fn shapes_that_interlock_block_the_slide() {
    let found = Inspection::new(&load("shapes/tab-20mm.toml"));
    assert_eq!(found.fits[0].slide, None);
    assert!(found.fits[0].pull_off > 0.0 && found.fits[0].tilt > 0.0);
}

#[test]
fn magnets_that_cancel_are_none_and_not_a_tiny_number() {
    let design = squares("NS", "NN");
    let found = Inspection::new(&design);
    assert!(found.is_negligible() && found.strongest > 1e-4, "{found:?}");
    assert!(found.fits[0].energy.abs() < NEGLIGIBLE * found.strongest);
    let text = report::inspection::document(&design, &found).text(None);
    assert!(
        text.contains("do not bind") && text.contains("none"),
        "{text}"
    );
    assert!(
        !text.contains(" pJ") && !text.contains("e-") && !text.contains("(0"),
        "{text}"
    );
    // Without magnets there is nothing to name.
    let bare = squares("", "");
    let found = Inspection::new(&bare);
    assert_eq!(found.fits.len(), 1);
    let text = report::inspection::document(&bare, &found).text(None);
    assert!(text.contains("do not bind"), "{text}");
}
