//! What errors of making do to a design, by principle and beside full analyses.

use tilebind::comparison::quantity::QUANTITIES;
use tilebind::comparison::{self, assess_all};
use tilebind::design::Design;
use tilebind::observer::Silent;
use tilebind::request::of_keywords;
use tilebind::tolerance::{MakingErrors, Request, Tolerance, ToleranceError};

/// A square of 60 mm with four magnets on one face, and its mate.
fn design(magnet: &str, more: &str) -> Design {
    let tile = "side = 0.06\nthickness = 0.011\nmass = 0.02\n";
    let text = format!(
        "[table]\nsize = [1, 1]\n[magnet]\n{magnet}\npitch = 0.013\n\
         [fixed]\n{tile}[fixed.faces.east]\ncode = \"NNSN\"\n\
         [moving]\n{tile}[moving.faces.west]\nmates = \"east\"\n\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n{more}"
    );
    Design::parse(&text, "four.toml").unwrap()
}

const BLOCKS: &str = "size = [0.004, 0.006, 0.003]\nremanence = 1.2\ninset = 0.001";
const DIPOLES: &str = "[potential]\nmodel = \"dipole\"\n";

fn request(making: MakingErrors, checks: usize) -> Request {
    Request {
        making,
        beats: None,
        checks,
        seed: 1,
    }
}

fn of(design: &Design, making: MakingErrors) -> Tolerance {
    request(making, 0).run(design, &Silent).unwrap()
}

fn stated() -> MakingErrors {
    MakingErrors {
        strength: Some(0.05),
        place: Some(2e-4),
        turn: Some(0.04),
        ..MakingErrors::default()
    }
}

#[test]
fn without_errors_nothing_spreads() {
    let zero = MakingErrors {
        strength: Some(0.0),
        place: Some(0.0),
        turn: Some(0.0),
        gap: Some(0.0),
        flip: Some(0.0),
        draws: Some(50),
        ..MakingErrors::default()
    };
    let found = of(&design(BLOCKS, ""), zero);
    assert_eq!(found.bond.sd, 0.0);
    assert_eq!(found.bond.mean, found.nominal.bond);
    assert!(found.matters.is_empty() && found.explained.is_none());
    assert!([0, 50].contains(&found.works.count));
    let design = design(BLOCKS, "");
    let exact = design.problem().energy(&design.pair.bound);
    assert!((found.nominal.bond / exact - 1.0).abs() < 1e-3, "{found:?}");
    let none = request(MakingErrors::default(), 0).run(&design, &Silent);
    assert_eq!(none.unwrap_err(), ToleranceError::NoErrors);
}

/// U is linear in each moment: its variance to first order is that of the sum over magnets of the
/// energy that vanishes with the magnet.
#[test]
fn the_spread_by_strength_is_the_sum_over_pairs() {
    let design = design(BLOCKS, "");
    let strength = 0.01;
    let making = MakingErrors {
        strength: Some(strength),
        draws: Some(4000),
        ..MakingErrors::default()
    };
    let found = of(&design, making);
    let q = design.pair.bound;
    let whole = design.problem().energy(&q);
    let mut variance = 0.0;
    for moving in [false, true] {
        for k in 0..4 {
            let mut pair = (*design.pair).clone();
            let tile = if moving {
                &mut pair.moving
            } else {
                &mut pair.fixed
            };
            tile.magnets.remove(k);
            let without = Design {
                pair: pair.into(),
                ..design.clone()
            };
            let part = whole - without.problem().energy(&q);
            variance += (strength * part).powi(2);
        }
    }
    // The standard deviation of 4,000 draws is known to 1.1 %.
    assert!(
        (found.bond.sd / variance.sqrt() - 1.0).abs() < 0.04,
        "{:?}",
        found.bond
    );
    let sum: f64 = found.matters.iter().map(|it| it.of_bond).sum();
    assert!((sum - 1.0).abs() < 1e-9);
    assert_eq!(found.matters.len(), 8);
    let explained = found.explained.unwrap();
    assert!((explained - 1.0).abs() < 0.05, "{explained}");
}

#[test]
fn a_batch_of_equal_magnets_changes_all_energies_alike() {
    let design = design(BLOCKS, "");
    let making = MakingErrors {
        strength: Some(0.1),
        batch: Some(1.0),
        draws: Some(500),
        ..MakingErrors::default()
    };
    let found = of(&design, making);
    let nominal = found.nominal.selectivity();
    for outcome in &found.outcomes {
        assert!((outcome.selectivity() / nominal - 1.0).abs() < 1e-3);
    }
    // The square of a factor 1 + 0.1 z.
    let relative = found.bond.sd / -found.nominal.bond;
    assert!((relative - 0.2).abs() < 0.02, "{relative}");
    assert_eq!(found.matters.len(), 1);
    assert_eq!(
        (&found.matters[0].magnet[..], found.matters[0].error),
        ("all", "strength")
    );
}

#[test]
fn small_errors_spread_in_proportion() {
    let design = design(BLOCKS, "");
    let sd = |place: f64, turn: f64| {
        let making = MakingErrors {
            place: Some(place),
            turn: Some(turn),
            draws: Some(300),
            ..MakingErrors::default()
        };
        of(&design, making).bond.sd
    };
    let ratio = sd(4e-5, 0.0) / sd(2e-5, 0.0);
    assert!((ratio - 2.0).abs() < 0.05, "{ratio}");
}

#[test]
fn a_gap_weakens_the_bond_by_its_slope() {
    let design = design(BLOCKS, "");
    let gap = 2e-5;
    let making = MakingErrors {
        gap: Some(gap),
        draws: Some(2000),
        ..MakingErrors::default()
    };
    let found = of(&design, making);
    let problem = design.problem();
    let slope = problem.energy_and_gradient(&design.pair.bound).1.x;
    // Two layers of gap |z| / 2 on average: sqrt(2 / pi) times the gap.
    let expected = slope * gap * (2.0 / std::f64::consts::PI).sqrt();
    let rise = found.bond.mean - found.nominal.bond;
    assert!((rise / expected - 1.0).abs() < 0.05, "{rise} {expected}");
}

/// Followed energies of all kinds of magnets are those of exact minimisations of the same draws.
#[test]
fn states_are_followed_for_every_kind_of_magnet() {
    let shield = "[shield]\nattenuation = 0.6\nlength = 0.01\nwidth = 0.3\n";
    let disc = "shape = \"disc\"\ndiameter = 0.005\nheight = 0.003\nremanence = 1.2\ninset = 0.001";
    let upright = format!("{disc}\naxis = \"up\"");
    let cases = [
        ("blocks", design(BLOCKS, "")),
        ("dipoles", design(BLOCKS, DIPOLES)),
        ("shields", design(BLOCKS, shield)),
        ("discs", design(disc, "")),
    ];
    let mut cases: Vec<(&str, Design)> = cases.into();
    let standing = {
        let tile = "side = 0.06\nthickness = 0.011\nmass = 0.02\n";
        format!(
            "[table]\nsize = [1, 1]\n[magnet]\n{upright}\npitch = 0.013\n\
             [fixed]\n{tile}[fixed.faces.east]\ncode = \"UUDU\"\n\
             [moving]\n{tile}[moving.faces.west]\nmates = \"east\"\n\
             [target]\nfixed = \"east\"\nmoving = \"west\"\n"
        )
    };
    cases.push((
        "standing",
        Design::parse(&standing, "standing.toml").unwrap(),
    ));
    for (kind, design) in cases {
        let making = MakingErrors {
            draws: Some(20),
            ..stated()
        };
        let found = of(&design, making);
        let exact = found.exact;
        assert!(
            exact.bond[0] < 0.01 && exact.bond[1] < 0.03,
            "{kind}: {exact:?}"
        );
        let trap = exact.trap.unwrap_or_default();
        assert!(trap[0] < 0.04, "{kind}: {exact:?}");
        assert!(
            found.bond.sd > 0.0 && found.bond.sd < 0.2 * -found.bond.mean,
            "{kind}"
        );
    }
}

/// Beside draws with a search of states of their own: the share that works, and energies.
#[test]
fn shares_agree_with_full_analyses() {
    let design = design(BLOCKS, DIPOLES);
    let nominal = of(
        &design,
        MakingErrors {
            draws: Some(2),
            ..stated()
        },
    )
    .nominal
    .selectivity();
    let making = MakingErrors {
        // So that about half of the draws work.
        selectivity: Some(nominal),
        ..stated()
    };
    let found = request(making, 8).run(&design, &Silent).unwrap();
    assert!(
        found.works.share() > 0.1 && found.works.share() < 0.9,
        "{:?}",
        found.works
    );
    let anew = found.anew.unwrap();
    assert!(anew.agree >= 7, "{anew:?}");
    assert!(anew.differences[0] < 0.02, "{anew:?}");
    assert!(
        anew.works.low < found.works.high && found.works.low < anew.works.high,
        "{anew:?}"
    );
}

#[test]
fn a_flipped_magnet_weakens_the_bond_and_is_noticed() {
    let design = design(BLOCKS, "");
    let making = MakingErrors {
        flip: Some(0.02),
        ..stated()
    };
    let found = of(&design, making);
    assert_eq!(found.flipped.len(), 8);
    for flipped in &found.flipped {
        assert!(flipped.bond > 0.8 * found.nominal.bond, "{flipped:?}");
        assert!(flipped.noticed.share() > 0.9, "{flipped:?}");
    }
    let share = found.outcomes.iter().filter(|it| it.is_flipped).count() as f64 / 1000.0;
    // 1 - 0.98^8 = 0.149.
    assert!((share - 0.149).abs() < 0.04, "{share}");
}

#[test]
fn any_number_of_threads_gives_the_same_draws() {
    let design = design(BLOCKS, DIPOLES);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            of(
                &design,
                MakingErrors {
                    draws: Some(60),
                    flip: Some(0.05),
                    ..stated()
                },
            )
        })
    };
    let [one, two] = [on(1), on(2)];
    assert_eq!(one.outcomes, two.outcomes);
    assert_eq!((one.matters, one.safer), (two.matters, two.safer));
}

#[test]
fn designs_are_compared_by_the_share_that_works() {
    let robust = QUANTITIES.iter().find(|it| it.key == "robust").unwrap();
    let given = [
        ("strength", "5%"),
        ("draws", "200"),
        ("milestones", "500"),
        ("far_starts", "1"),
    ];
    let given = given.map(|(key, value)| (key.to_owned(), vec![value.to_owned()]));
    let asked: comparison::Request = of_keywords(given).unwrap();
    let designs = [design(BLOCKS, DIPOLES)];
    let found = &assess_all(&designs, &asked, &Silent)[0];
    let share = robust.of(found).unwrap();
    assert_eq!(found.robust.unwrap().of, 200);
    assert!(share.low.unwrap() <= share.value && share.value <= share.high.unwrap());
    assert!(asked.thoroughness.check_ranking(robust).is_ok());
    asked.thoroughness.check().unwrap();
    let unasked: comparison::Request = of_keywords([]).unwrap();
    let refused = unasked
        .thoroughness
        .check_ranking(robust)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("--strength 5%"), "{refused}");
}
