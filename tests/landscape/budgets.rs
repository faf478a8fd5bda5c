//! Proofs end within what they are allowed, whatever the design: random pairs of quadrilaterals with
//! blocks, whose faces meet at all angles.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::fmt::Write;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::budget::Allowance;
use tilebind::landscape::barrier_bounds::{CertificationSettings, certify};
use tilebind::landscape::missing_states::StateSearch;
use tilebind::landscape::{Catalogue, Claims, CompletenessSettings};
use tilebind::observer::Silent;
use tilebind::{Design, Problem};

use crate::missing_states;

/// Core-seconds of each proof.
const WORK: f64 = 0.05;

/// Corners (m) of a quadrilateral about the origin.
fn corners(rng: &mut ChaCha8Rng) -> [[f64; 2]; 4] {
    let size = rng.random_range(0.025..0.06);
    [0, 1, 2, 3].map(|k| {
        let turn = FRAC_PI_2 * f64::from(k) - 3.0 * FRAC_PI_4 + rng.random_range(-0.3..0.3);
        let radius = size * rng.random_range(0.8..1.2);
        [radius * libm::cos(turn), radius * libm::sin(turn)]
    })
}

/// A random design; `None` if its magnets do not fit.
fn design(seed: u64) -> Option<Design> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let inset = [0.0, 0.0005, 0.001, 0.003][rng.random_range(0..4)];
    let mut text = format!(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.004, 0.006, 0.006]\nremanence = 1.3\n\
         pitch = 0.012\ninset = {inset}\n"
    );
    let [fixed, mut moving] = [(); 2].map(|()| corners(&mut rng));
    let length = |[a, b, ..]: &[[f64; 2]; 4]| libm::hypot(b[0] - a[0], b[1] - a[1]);
    let stretch = length(&fixed) / length(&moving);
    moving.iter_mut().flatten().for_each(|x| *x *= stretch);
    for (name, corners) in [("fixed", fixed), ("moving", moving)] {
        writeln!(
            text,
            "[{name}]\nvertices = {corners:?}\nthickness = 0.01\nmass = 0.04\n[{name}.faces]"
        )
        .unwrap();
        for face in 0..4 {
            let letters = rng.random_range(usize::from(face == 0)..4);
            let code: String = (0..letters)
                .map(|_| if rng.random_bool(0.5) { 'N' } else { 'S' })
                .collect();
            if !code.is_empty() {
                writeln!(text, "{face} = {{ code = \"{code}\" }}").unwrap();
            }
        }
    }
    text += "[target]\nfixed = \"0\"\nmoving = \"0\"\n";
    Design::parse(&text, "quadrilaterals.toml").ok()
}

/// Core-seconds of the proof that no state is missing, and of the bounds of barriers.
fn work(problem: &Problem) -> [f64; 2] {
    let mut survey = missing_states::survey(problem, 300);
    let allowed = Allowance::of(WORK);
    let looked_for = CompletenessSettings {
        allowed,
        ..missing_states::USUAL
    };
    let search = StateSearch::run(problem, &survey, &looked_for, &Silent).unwrap();
    survey.add(&search.missed());
    let mut catalogue = Catalogue::of_survey(&survey, 1e-4, &Silent);
    let complete = search.conclude(&survey, &catalogue).work;
    let asked = CertificationSettings {
        tolerance: None,
        allowed,
        cells: 1_000_000,
        claims: Claims::All,
    };
    let certified = certify(problem, &mut catalogue, &asked, &Silent);
    [complete, certified.map_or(WORK, |certified| certified.work)]
}

/// Checks this number of designs, and that the limit ended most proofs.
fn check(count: usize) {
    let designs = (0..2 * count as u64).filter_map(|seed| Some((seed, design(seed)?)));
    let (mut tried, mut ended) = (0, 0);
    for (seed, design) in designs.take(count) {
        let work = work(&design.problem());
        assert!(
            work.iter().all(|work| *work <= 2.0 * WORK),
            "{seed}: {work:?}"
        );
        tried += 1;
        ended += work.iter().filter(|work| **work >= WORK).count();
    }
    assert_eq!(tried, count);
    assert!(ended > count / 2, "{ended}");
}

#[test]
fn no_proof_takes_twice_what_it_is_allowed() {
    check(6);
}

#[test]
#[ignore = "slow"]
fn no_proof_of_two_hundred_designs_takes_twice_what_it_is_allowed() {
    check(200);
}
