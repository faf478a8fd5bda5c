//! Results that symmetries determine: of two tiles exchanged, of their mirror image, of more
//! threads.

use tilebind::Analysis;
use tilebind::configuration::Configuration;
use tilebind::design::Design;
use tilebind::observer::Silent;
use tilebind::pipeline::{self, Certify, MILESTONES, Request};

/// Squares with one code on all faces of each.
fn design(fixed: &str, moving: &str, target: [&str; 2]) -> Design {
    let text = format!(
        "name = 'pair'\n[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.01, 0.01, 0.003]\n\
         remanence = 1.2\npitch = 0.04\n[fixed]\nside = 0.43\nthickness = 0.013\nmass = 0.1\n\
         [fixed.faces]\nall = {{ code = '{fixed}' }}\n[moving]\nside = 0.43\nthickness = 0.013\n\
         mass = 0.1\n[moving.faces]\nall = {{ code = '{moving}' }}\n[target]\nfixed = '{}'\n\
         moving = '{}'\n[potential]\nmodel = 'dipole'\n",
        target[0], target[1]
    );
    Design::parse(&text, "pair.toml").unwrap()
}

fn analyse(design: &Design, seed: u64) -> Analysis {
    let settings = Request {
        seed,
        certify: Certify::of(0.0),
        ..Request::default().surveyed(3000, 20)
    };
    pipeline::analyse(design, &settings, &Silent)
}

/// Every state of `one` has its image among those of `other`, of the same depth and with an escape
/// as high.
fn assert_images(
    one: &Analysis,
    other: &Analysis,
    image: &dyn Fn(&Configuration) -> Configuration,
) {
    let [states, twins] = [one, other].map(|analysis| &analysis.catalogue.states);
    assert_eq!(states.len(), twins.len());
    assert!(states.len() >= 100, "{}", states.len());
    for state in states {
        let expected = image(&state.configuration);
        let step = |q: &Configuration| {
            let step = q.step_to(&expected);
            step.xy().norm() + 0.2 * step.z.abs()
        };
        let twin = twins
            .iter()
            .find(|twin| step(&twin.configuration) < 1e-5)
            .unwrap_or_else(|| panic!("no image of {state:?}"));
        assert_eq!(state.kind, twin.kind);
        assert!((state.energy - twin.energy).abs() < 1e-9 * state.energy.abs());
        let heights =
            [(one, state), (other, twin)].map(|(of, s)| of.escape(s.id).unwrap().forward());
        assert!(
            (heights[0] - heights[1]).abs() < 5e-3 * heights[0],
            "{heights:?} of {:?}",
            state.configuration
        );
    }
}

#[test]
fn exchanging_the_tiles_exchanges_the_answers() {
    let one = analyse(&design("NNNS", "NSSS", ["east", "west"]), 1);
    let other = analyse(&design("NSSS", "NNNS", ["west", "east"]), 2);
    assert_images(&one, &other, &Configuration::inverse);
}

#[test]
fn the_mirror_image_has_mirrored_answers() {
    let one = analyse(&design("NNNS", "NSSS", ["east", "west"]), 1);
    let other = analyse(&design("SNNN", "SSSN", ["east", "west"]), 3);
    let mirrored = |q: &Configuration| Configuration::new(q.x, -q.y, -q.theta);
    assert_images(&one, &other, &mirrored);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let design = design("NNNS", "NSSS", ["east", "west"]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| analyse(&design, 5))
    };
    let (one, many) = (on(1), on(3));
    assert_eq!(one.catalogue, many.catalogue);
    assert_eq!(one.counts, many.counts);
}

/// Two polygons with one magnet on each face have as many copies of each state as pairs of faces. What
/// grows with them is the time of an energy, far less the number of energies: 2.9 times as many with all
/// copies searched, 1.9 with few.
#[test]
fn states_with_hundreds_of_copies_are_searched_once() {
    let evaluations = |sides: usize| {
        let faces = |letter: &str| -> String {
            (0..sides)
                .map(|k| format!("{k} = {{ code = \"{letter}\" }}\n"))
                .collect()
        };
        let tile = |name: &str, letter: &str| {
            format!(
                "[{name}]\nside = 0.05\nsides = {sides}\nthickness = 0.013\nmass = 0.1\n[{name}.faces]\n{}",
                faces(letter)
            )
        };
        let text = format!(
            "name = \"many\"\n[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.005, 0.005, 0.003]\n\
             remanence = 1.2\n{}{}[target]\nfixed = 0\nmoving = {}\n[potential]\nmodel = \"dipole\"\n",
            tile("fixed", "N"),
            tile("moving", "S"),
            sides / 2
        );
        let design = Design::parse(&text, "many.toml").unwrap();
        let settings = Request::without_proofs(1).surveyed(MILESTONES, 1000);
        let analysis = pipeline::analyse(&design, &settings, &Silent);
        let bonds = analysis.catalogue.kinds().next().unwrap().copies();
        assert_eq!(bonds, sides * sides);
        analysis.problem.evaluations()
    };
    let [few, many] = [12, 24].map(evaluations);
    assert!(
        5 * many < 11 * few,
        "{many} energies with 24 sides, {few} with 12"
    );
}
