//! Says before an analysis that it takes much memory or time, or, for many magnets, that it is
//! sampled less.

use std::collections::BTreeSet;

use tilebind::Design;
use tilebind::pipeline::Request;
use tilebind::potential::MagnetModel;
use tilebind::tile::Tile;
use tilebind::units::{duration, si};

use super::{Failure, tell};

/// For a design with very many magnets, prints the energy of the bond, which needs no survey, and
/// the reduced amounts of work.
pub fn tell_of(design: &Design, asked: &Request) {
    if Request::usual([design]) == Request::default() {
        return;
    }
    let pair = &design.pair;
    let pairs = pair.fixed.magnets.len() * pair.moving.magnets.len();
    let bond = si(design.problem().energy(&pair.bound), "J", 4);
    let mut less = vec![format!(
        "{} milestones (--milestones)",
        asked.survey.milestones()
    )];
    if let Some(kinds) = asked.survey.kinds {
        less.push(format!("the {kinds} deepest kinds of state (--kinds)"));
    }
    let far_starts = asked.survey.far_starts();
    if far_starts > 0 {
        less.push(format!("{far_starts} far starts (--far-starts)"));
    }
    if !asked.has_proofs() {
        less.push("no proofs (--certify-work, --complete-work)".to_owned());
    }
    tell(format!(
        "note: {pairs} pairs of magnets, {bond} where the target faces meet, take long; the \
         defaults are reduced to {}",
        less.join(", ")
    ));
}

/// Pairs of blocks or discs from which on proofs take minutes: two quadrilaterals with one or two
/// magnets on each face have about 30.
const MANY_BODIES: usize = 30;
/// Core-seconds of the rest of an analysis for each such pair.
const A_PAIR: f64 = 0.015;
/// Shorter proofs (s) are not worth a word.
const SHORT: f64 = 60.0;

/// From so many different pairs of faces on, states take minutes: about a second for each pair.
const MANY_PAIRS: usize = 100;

/// The number of faces with magnets that differ from each other in these.
fn different_faces(tile: &Tile) -> usize {
    let rounded = |x: f64| (1e6 * x).round() as i64;
    let faces = tile.faces.iter().enumerate().map(|(number, face)| {
        let (middle, normal) = (face.middle(), face.normal());
        let on = tile.magnets.iter().filter(|it| it.face == number);
        let mut magnets: Vec<_> = on
            .map(|it| {
                let way = it.position - middle;
                let pole = it.pole(normal) as u8;
                (rounded(normal.perp(&way)), rounded(normal.dot(&way)), pole)
            })
            .collect();
        magnets.sort_unstable();
        magnets
    });
    let kinds: BTreeSet<_> = faces.filter(|it| !it.is_empty()).collect();
    kinds.len()
}

/// For tiles of very many different faces, whose states take minutes, says so.
fn tell_faces(design: &Design) {
    let [fixed, moving] = [&design.pair.fixed, &design.pair.moving].map(different_faces);
    if fixed * moving >= MANY_PAIRS {
        tell(format!(
            "note: {} pairs of faces have different magnets, and each is searched for states: expect \
             minutes; the progress shows how many are left",
            fixed * moving
        ));
    }
}

/// For proofs that may take minutes, says how long, and how to do without them; and so for states.
pub fn tell_time(design: &Design, asked: &Request, threads: usize) {
    tell_faces(design);
    if let Some(note) = of_trajectories(asked.check.dynamics_runs, threads as f64) {
        tell(note);
    }
    if let Some(note) = of_time(design, asked, threads as f64) {
        tell(note);
    }
}

/// Core-seconds of a trajectory that checks a barrier: of plain and of curved shapes.
const A_TRAJECTORY: [f64; 2] = [1e-3, 5e-3];

fn of_trajectories(runs: usize, threads: f64) -> Option<String> {
    let [least, most] = A_TRAJECTORY.map(|one| one * runs as f64 / threads);
    (most >= SHORT).then(|| {
        format!(
            "note: {runs} trajectories of each barrier (--dynamics) take about {} to {}, times the number of \
             barriers; fewer take less",
            duration(least, 2),
            duration(most, 2)
        )
    })
}

fn of_time(design: &Design, asked: &Request, threads: f64) -> Option<String> {
    let (pair, model) = (&design.pair, design.interaction.model);
    let pairs = pair.fixed.magnets.len() * pair.moving.magnets.len();
    let is_proved = design.interaction.bounds(&pair.fixed, &pair.moving).is_ok();
    let is_slow = model == MagnetModel::Cuboid && pairs >= MANY_BODIES && is_proved;
    let [bounds, list] = [asked.certify.allowed(), asked.completeness().allowed].map(|allowed| {
        let work = allowed.work.unwrap_or(f64::INFINITY) / threads;
        work.min(allowed.seconds.unwrap_or(f64::INFINITY))
    });
    let survey = (A_PAIR * pairs as f64 / threads).max(1.0);
    (is_slow && bounds + list >= SHORT).then(|| {
        format!(
            "note: {pairs} pairs of {}: states and barriers take about {survey:.0} s, and their \
             proofs up to {:.0} minutes more; --quick leaves the proofs out, --certify-work and \
             --complete-work shorten them",
            model.plural(pair),
            ((bounds + list) / 60.0).ceil()
        )
    })
}

/// Says how long trajectories take that do not end early, if they take long; given the time (s) on one
/// core.
pub fn tell_expected(on_one_core: Option<f64>, threads: usize) {
    let time = on_one_core.map(|time| time / threads as f64);
    if let Some(time) = time.filter(|time| *time >= SHORT) {
        tell(format!(
            "note: expect up to about {}; trajectories that end early take less",
            duration(time, 2)
        ));
    }
}

/// Reports a check of the memory: an error if the machine does not have it.
pub fn tell_memory(checked: Result<Option<String>, String>) -> Result<(), Failure> {
    if let Some(told) = checked.map_err(Failure::Usage)? {
        tell(format!("note: {told}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tilebind::pipeline::Certify;

    /// Sides with equal codes are one kind; with a code of its own, each is one.
    #[test]
    fn faces_with_the_same_magnets_are_one_kind() {
        let design = |codes: fn(usize) -> String| {
            let faces = |tile: &str| {
                let codes = (0..12).map(|k| match (tile, k) {
                    ("moving", 0) => "0 = { mates = \"0\" }\n".to_owned(),
                    _ => format!("{k} = {{ code = \"{}\" }}\n", codes(k)),
                });
                let codes: String = codes.collect();
                format!(
                    "[{tile}]\nsides = 12\nside = 0.08\nthickness = 0.013\nmass = 0.1\n[{tile}.faces]\n{codes}"
                )
            };
            let text = format!(
                "name = \"many\"\n[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.004, 0.004, 0.003]\n\
                 remanence = 1.2\npitch = 0.015\n{}{}[target]\nfixed = 0\nmoving = 0\n",
                faces("fixed"),
                faces("moving")
            );
            Design::parse(&text, "many.toml").unwrap()
        };
        let own = |k: usize| -> String {
            (0..4)
                .map(|bit| if k >> bit & 1 == 1 { 'N' } else { 'S' })
                .collect()
        };
        assert_eq!(different_faces(&design(own).pair.fixed), 12);
        assert_eq!(different_faces(&design(|_| "NNS".to_owned()).pair.fixed), 1);
    }

    #[test]
    fn many_trajectories_are_told_before() {
        let told = of_trajectories(1_000_000, 2.0).unwrap();
        assert!(told.contains("8.3 minutes to 42 minutes"), "{told}");
        assert_eq!(of_trajectories(1000, 1.0), None);
    }

    #[test]
    fn proofs_of_minutes_are_told_before() {
        let load = |model: MagnetModel| {
            let text = std::fs::read_to_string("shapes/paper-tile.toml").unwrap();
            let text = text.replace(
                "model = \"dipole\"",
                &format!("model = \"{}\"", model.name()),
            );
            Design::parse(&text, "paper-tile.toml").unwrap()
        };
        let usual = Request::default();
        let [blocks, dipoles] = [MagnetModel::Cuboid, MagnetModel::Dipole].map(load);
        let on_two = of_time(&blocks, &usual, 2.0).unwrap();
        let told = ["256 pairs", "about 2 s", "up to 3 minutes", "--quick"];
        assert!(told.iter().all(|it| on_two.contains(it)), "{on_two}");
        let on_one = of_time(&blocks, &usual, 1.0).unwrap();
        assert!(on_one.contains("up to 6 minutes"), "{on_one}");
        let mut short = usual.clone();
        short.certify = Certify::of(10.0);
        short.complete_work = Some(0.0);
        assert_eq!(of_time(&blocks, &short, 1.0), None);
        assert_eq!(of_time(&dipoles, &usual, 1.0), None);
    }
}
