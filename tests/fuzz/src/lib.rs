//! Properties that every answer of the readers must have.

use std::fmt::Display;

use tilebind::assembly::{TileSet, rgrow, xgrow};
use tilebind::calibration::{bonds, distances, read_rows};
use tilebind::design::{DesignError, WordSet};
use tilebind::query::poses;
use tilebind::sweep::Plan;
use tilebind::table::{About, read_start};
use tilebind::text::with_commas;
use tilebind::{Configuration, Design};

/// Whether an answer can be told in a terminal, and a design that was read is sound.
///
/// # Panics
/// Where it cannot, or is not.
pub fn check(answer: Result<Design, DesignError>) {
    tell(answer.map(|design| {
        let pair = &design.pair;
        assert!(design.space().contains(&pair.bound));
        for tile in [&pair.fixed, &pair.moving] {
            assert!(tile.outline.area() > 0.0 && tile.outline.area().is_finite());
            for magnet in &tile.magnets {
                assert!(magnet.moment.is_finite());
                assert!(magnet.position.iter().all(|x| x.is_finite()));
            }
        }
        assert!(!design.name.contains(char::is_control));
        let warnings: Vec<String> = design.warnings.iter().map(ToString::to_string).collect();
        warnings.join("\n")
    }));
}

/// Whether what is told can be, in a terminal.
///
/// # Panics
/// Where it cannot.
fn tell<E: Display>(answer: Result<String, E>) {
    let told = answer.unwrap_or_else(|error| error.to_string());
    let escapes = |c: char| c.is_control() && c != '\n';
    assert!(!told.contains(escapes), "{told:?}");
    keep_short(&told);
}

/// Whether something is told in not too many words.
fn keep_short(told: &str) {
    assert!(told.len() < 100_000, "{} bytes are told", told.len());
}

/// Whether a tile set, whatever is wrong with it, has an answer; one that is read is written so that it
/// is read again as it was.
///
/// # Panics
/// Where it is not.
pub fn tile_set(text: &str) {
    let read = TileSet::parse(text, "fuzz.yaml");
    if let Ok(set) = &read {
        let again = |text: String| TileSet::parse(&text, "fuzz.yaml").expect("it was written here");
        let mut other = again(rgrow::write(set, &[]));
        other.passed_over.clone_from(&set.passed_over);
        assert_eq!(other, *set);
        let other = again(xgrow::write(set, &[]));
        let edges = |set: &TileSet| set.tiles.iter().map(|tile| tile.glues).collect::<Vec<_>>();
        assert_eq!(edges(&other), edges(set));
    }
    tell(read.map(|set| set.name));
}

/// Whether a set of words has an answer, and what was read is sound.
///
/// # Panics
/// Where it is not.
pub fn word_set(text: &str) {
    let read = WordSet::parse(text, "fuzz.toml", None);
    if let Ok(set) = &read {
        let length = set.words[0].places();
        assert!(set.words.iter().all(|word| word.places() == length));
        check(Ok(set.stage.clone()));
    }
    tell(read.map(|_| String::new()));
}

/// Whether the manifest of a sweep has an answer, and so have the designs of its first points; written
/// it is read again as it was.
///
/// # Panics
/// Where it has not, or is not.
pub fn plan(text: &str) {
    const MOST: usize = 100;
    let read = Plan::parse(text);
    if let Ok(plan) = &read
        && plan.count() <= MOST
    {
        assert_eq!(Plan::parse(&plan.to_text()).as_ref(), Ok(plan));
        for point in plan.points().iter().take(3) {
            tell(plan.design(point).map(|design| design.name));
        }
    }
    tell(read.map(|_| String::new()));
}

/// Whether every reader of tables has an answer to one, and what is read is finite.
///
/// # Panics
/// Where it has not, or is not.
pub fn table(text: &str, pair: &Design) {
    let text = &with_commas(text)[..];
    let sound = |q: &Configuration| assert!(q.to_array().iter().all(|x| x.abs() <= 1e30), "{q:?}");
    // Of what is wrong with tables the program takes control characters out when it tells it.
    let tell = |answer: Result<String, String>| keep_short(&answer.unwrap_or_else(|error| error));
    tell(poses::read(text).map(|all| {
        all.iter().for_each(sound);
        String::new()
    }));
    tell(read_rows(text).map(|rows| {
        rows.iter().for_each(|row| sound(&row.configuration));
        String::new()
    }));
    tell(bonds::PairTimes::read(text).map(|times| {
        assert!(times.log_odds().0.is_finite());
        String::new()
    }));
    tell(distances::PairDistances::read(text).map(|_| String::new()));
    let (_, crowd) = About::of_designs(std::slice::from_ref(pair)).expect("a shipped design");
    let read = read_start(text, &crowd).map_err(|error| error.to_string());
    tell(read.map(|_| String::new()));
}
