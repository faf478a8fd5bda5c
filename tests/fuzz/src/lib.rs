//! Properties that every answer of the readers, and every bound of energies, must have.

mod check_bounds;
mod interval;
#[path = "../../shared/small_design.rs"]
mod small_design;
mod truth;

use std::collections::BTreeMap;
use std::fmt::Display;

use jobs::Design;
use jobs::assembly::{TileSet, rgrow, xgrow};
use jobs::calibration::{Fitted, bonds, distances, read_rows};
use jobs::design::{DesignError, WordSet};
use jobs::pipeline::{self, Certify, Request};
use jobs::query::poses;
use jobs::sweep::Plan;
use jobs::table::{About, Ensemble, read_start};
use jobs::text::with_commas;
use physics::Configuration;
use physics::observer::Silent;
use physics::table::run::Start;

pub use check_bounds::bounds;

/// Tiles that are drawn, and a face that is.
const DRAWN: [&str; 2] = [include_str!("outline.toml"), include_str!("line.toml")];

/// Checks that any design has an answer. No drawings, because the fuzzer must not read files of this
/// machine.
///
/// # Panics
/// Where it has not.
pub fn design(text: &str) {
    check(Design::parse_with(text, "fuzz.toml", &BTreeMap::new()));
}

/// Checks that any drawing has an answer, as a tile's outline and as a face's profile.
///
/// # Panics
/// Where it has not.
pub fn drawing(text: &str) {
    let drawings = BTreeMap::from([("a.svg".to_owned(), text.to_owned())]);
    for design in DRAWN {
        check(Design::parse_with(design, "fuzz.toml", &drawings));
    }
}

/// Checks that an answer can be printed in a terminal, and that a design that was read is valid.
///
/// # Panics
/// Where it cannot, or is not.
fn check(answer: Result<Design, DesignError>) {
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

/// Checks that an answer can be printed in a terminal.
///
/// # Panics
/// Where it cannot.
fn tell<E: Display>(answer: Result<String, E>) {
    let told = answer.unwrap_or_else(|error| error.to_string());
    let escapes = |c: char| c.is_control() && c != '\n';
    assert!(!told.contains(escapes), "{told:?}");
    keep_short(&told);
}

/// Checks that a message is not too long.
fn keep_short(told: &str) {
    assert!(told.len() < 100_000, "{} bytes are told", told.len());
}

/// Checks that any tile set has an answer, and that one that was read is the same after writing and
/// reading.
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

/// Checks that any set of words has an answer, and that one that was read is valid.
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

/// Checks that any manifest of a sweep and the designs of its first points have answers, and that a
/// manifest is the same after writing and reading.
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

/// Checks that every reader of tables has an answer, and that all values read are finite.
///
/// # Panics
/// Where it has not, or is not.
pub fn table(text: &str, pair: &Design) {
    let text = &with_commas(text)[..];
    let sound = |q: &Configuration| assert!(q.to_array().iter().all(|x| x.abs() <= 1e30), "{q:?}");
    // The program removes control characters from messages about tables when it prints them.
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
    let (about, crowd) = About::of_designs(std::slice::from_ref(pair)).expect("a shipped design");
    let read = read_start(text, (&crowd, &about.named), &Silent).map_err(|error| error.to_string());
    tell(read.map(|_| String::new()));
}

/// Checks that the reader of starting tiles has an answer, and that tiles that were read lie apart on
/// their table.
///
/// # Panics
/// Where it has not, or they do not.
pub fn start(text: &str, pair: &Design) {
    let (about, crowd) = About::of_designs(std::slice::from_ref(pair)).expect("a shipped design");
    let read = read_start(&with_commas(text), (&crowd, &about.named), &Silent);
    if let Ok(movers) = &read {
        physics::table::start::check(&crowd, movers, true).expect("they were moved apart");
    }
    keep_short(&read.map_or_else(|error| error.to_string(), |_| String::new()));
}

/// Checks that any file has an answer as a part of a table, also if its checksum is right, and that
/// a part that is taken is the same after writing and reading.
///
/// # Panics
/// Where it has not, or is not.
pub fn part(text: &str, pair: &Design) {
    let (about, crowd) = About::of_designs(std::slice::from_ref(pair)).expect("a shipped design");
    let request = [("count", "1,1"), ("time", "0.1")];
    let request = request.map(|(key, value)| (key.to_owned(), vec![value.to_owned()]));
    let Ok(request) = jobs::request::of_keywords::<jobs::table::Request>(request) else {
        panic!("a request");
    };
    let whole = Ensemble::of(&about, &crowd, &request, Start::Random(vec![1, 1]));
    let parts = |text: String| [("part.json".to_owned(), text)];
    let given = whole.merge(&crowd, &parts(text.to_owned()));
    let summed = serde_json::from_str(text).map(|runs: Vec<_>| whole.part(&runs));
    let summed = summed.map(|part| String::from_utf8(part).expect("a part is text"));
    let summed = summed.map(|part| whole.merge(&crowd, &parts(part)));
    for merged in [Ok(given), summed].into_iter().flatten() {
        if let Ok(runs) = &merged {
            let part = |runs: &[_]| String::from_utf8(whole.part(runs)).expect("a part is text");
            let again = whole.merge(&crowd, &parts(part(runs)));
            assert_eq!(again.map(|runs| part(&runs)), Ok(part(runs)));
        }
        keep_short(&merged.map_or_else(|error| error, |_| String::new()));
    }
}

/// Checks that any table of gaps and forces has an answer, and that a fit is finite.
///
/// # Panics
/// Where it has not, or is not.
pub fn gaps(text: &str, pair: &Design) {
    match Fitted::of_gaps(pair, &with_commas(text)) {
        Ok(Fitted::Strength(found)) => {
            let told = format!("{found:?}");
            assert!(!told.contains("NaN"), "{told}");
        }
        Ok(_) => panic!("gaps are fitted by a strength"),
        Err(error) => keep_short(&error.to_string()),
    }
}

/// Checks that small designs of any kind are analysed, that their bounds are in order, and that all
/// far starts are counted. Each byte is one choice; missing ones are 0.
///
/// # Panics
/// Where one is not, or they are not.
pub fn analyse(bytes: &[u8]) {
    const FAR_STARTS: usize = 20;
    let Ok(design) = Design::parse_with(&small_design::of(bytes), "fuzz.toml", &BTreeMap::new())
    else {
        return;
    };
    let seed = u64::from(bytes.last().copied().unwrap_or_default());
    let request = Request {
        seed: 1 + seed,
        certify: Certify::of(0.05),
        complete_work: Some(0.05),
        ..Request::default().surveyed(300, FAR_STARTS)
    };
    let found = pipeline::analyse(&design, &request, &Silent);
    let states = &found.catalogue.states;
    let deepest = states.iter().map(|it| it.energy.abs()).fold(0.0, f64::max);
    for state in states {
        assert!(state.energy.is_finite());
    }
    for barrier in &found.catalogue.barriers {
        if let Some((lower, upper)) = barrier.bounds.both() {
            assert!(lower <= upper + 1e-9 * deepest, "{lower} above {upper}");
        }
        for point in &barrier.pathway {
            let clearance = point.clearance;
            assert!(point.energy.is_finite() && clearance > -1e-6, "{point:?}");
        }
    }
    let caught: usize = states
        .iter()
        .filter_map(|it| it.capture)
        .map(|it| it.count)
        .sum();
    assert_eq!(caught + found.uncaptured.all().count, FAR_STARTS);
    let _ = found.contradicted();
}
