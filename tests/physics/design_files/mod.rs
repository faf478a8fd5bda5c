//! Design files, valid and invalid: what they load as, and the messages for those that do not load.

mod cases;
mod discs;
mod drawing_faults;
mod drawings;
mod excess;
mod geometry;
mod shields;
mod starter;
mod tolerance;

use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

use crate::designs;
use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::design::Design;
use tilebind::tile::{Magnet, Tile, symmetry};

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    files.sort();
    files
}

#[test]
fn every_shipped_design_loads_without_a_doubt() {
    let shapes = files("shapes");
    for path in &shapes {
        let stem = path.file_stem().unwrap().to_string_lossy();
        let design = Design::load(path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(design.warnings, [], "{stem}");
        assert_eq!(design.name, stem);
        assert!(
            std::fs::read_to_string(path).unwrap().starts_with("# "),
            "{stem} has no comment"
        );
    }
}

/// A bad file states in its first lines the place of its fault, `# at: line:column`, and what the
/// message must contain, `# expect: ...`.
#[test]
fn every_bad_design_is_told_where_and_why() {
    let mut faults = Vec::new();
    for path in files("tests/designs/bad") {
        let text = std::fs::read_to_string(&path).unwrap();
        let told = match Design::load(&path) {
            Ok(_) => "loads without an error".to_owned(),
            Err(error) => error.to_string(),
        };
        let noted = |key: &str| -> Vec<String> {
            let lines = text.lines().filter_map(|line| line.strip_prefix(key));
            lines.map(|line| line.trim().to_owned()).collect()
        };
        let mut expected = noted("# expect:");
        expected.extend(
            noted("# at:")
                .iter()
                .map(|at| format!("{}:{at}: ", path.display())),
        );
        assert!(expected.len() >= 2, "{} expects nothing", path.display());
        for expected in expected {
            if !told.contains(&expected) {
                faults.push(format!("expected: {expected}\n{told}\n"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A design of `tests/designs/good` with the text changed and another pair of target faces.
fn changed(file: &str, changes: &[(&str, &str)]) -> Design {
    let path = format!("{}/tests/designs/good/{file}", env!("CARGO_MANIFEST_DIR"));
    let mut text = std::fs::read_to_string(path).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Design::parse(&text, file).unwrap_or_else(|error| panic!("{error}"))
}

fn magnets_of_face(tile: &Tile, face: usize) -> Vec<Magnet> {
    let magnets = tile.magnets.iter().filter(|magnet| magnet.face == face);
    magnets.cloned().collect()
}

#[test]
fn the_paper_s_tile_is_what_its_file_says() {
    let design = designs::load("tests/designs/good/flat.toml");
    assert_eq!(
        (design.name.as_str(), design.sha256.as_str()),
        (
            "flat-nnns",
            "5d8d9d7286d8f6babba4ed4fc3e3c3335169737d415281edf1f10a2df714d4fa"
        )
    );
    assert_eq!(design.pair.bound, Configuration::new(0.43, 0.0, 0.0));
    assert_eq!(design.pair.target, (0, 2));
    let space = design.space();
    assert_eq!(space.half_size, [1.0, 1.0]);
    // A square's radius of gyration is side / sqrt(6), its circle's radius side / sqrt(2).
    assert!((space.rho - 0.43 / 6_f64.sqrt()).abs() < 1e-15);
    assert!((space.free_distance - 0.43 * 2_f64.sqrt()).abs() < 1e-15);
    assert_eq!(
        (
            design.pair.fixed.magnets.len(),
            design.pair.moving.magnets.len()
        ),
        (16, 16)
    );
    let north = &design.pair.fixed.magnets[4];
    assert_eq!(north.face, 1);
    assert!((north.position - Vector2::new(0.06, 0.21)).norm() < 1e-15);
    assert!((north.angle - FRAC_PI_2).abs() < 1e-15);
    assert!((north.moment - 0.286_479).abs() < 1e-6);
    let outer_pole = north.position + Vector2::new(0.0, north.size[0] / 2.0);
    assert!((outer_pole.y - 0.215).abs() < 1e-15);
    assert_eq!(symmetry::rotations(&design.pair.fixed).len(), 4);
    assert_eq!(
        symmetry::rotations(&designs::load("shapes/hexagon.toml").pair.moving).len(),
        6
    );
    assert_eq!(
        symmetry::rotations(&designs::load("shapes/tab-10mm.toml").pair.fixed).len(),
        1
    );
}

#[test]
fn a_terse_design_takes_the_defaults() {
    let design = designs::load("tests/designs/good/terse.toml");
    assert_eq!(design.name, "terse");
    assert_eq!(
        (
            design.pair.fixed.magnets.len(),
            design.pair.moving.magnets.len()
        ),
        (1, 1)
    );
    assert_eq!(design.pair.moving.magnets[0].moment, 0.5);
    assert_eq!(design.pair.bound, Configuration::new(0.4, 0.0, 0.0));
}

#[test]
fn magnets_are_read_as_shops_sell_them() {
    let design = designs::load("tests/designs/good/shop.toml");
    let of = |tile: &Tile, face: &str| {
        let magnets = tile.magnets.iter();
        let mut own = magnets.filter(|magnet| tile.faces[magnet.face].name == face);
        own.next().unwrap().clone()
    };
    let [fixed, moving] = [&design.pair.fixed, &design.pair.moving];
    let east = of(fixed, "east");
    for size in east.size {
        assert!((size - 0.0127).abs() < 1e-17);
    }
    for (tile, face, remanence) in [
        // Grades are at the working point, of a cube.
        (fixed, "east", 1.30 / (1.0 + 0.05 / 3.0)),
        (fixed, "west", 1.2),
        (moving, "west", 1.30 / (1.0 + 0.05 / 3.0)),
        (moving, "north", 0.39 / (1.0 + 0.05 / 3.0)),
    ] {
        let found = of(tile, face).remanence();
        assert!((found - remanence).abs() < 1e-12, "{face}: {found}");
    }
    let pulls = tilebind::tile::strength::pull(
        Default::default(),
        east.size,
        of(fixed, "north").remanence(),
    );
    assert!((pulls / (5.0 * 9.806_65) - 1.0).abs() < 1e-12);
    assert!((design.pitch.unwrap() - 0.0381).abs() < 1e-15);
    assert!((fixed.mass - 0.113_398_092_5).abs() < 1e-12 && moving.mass == 0.11);
    assert_eq!(design.sold.len(), 3, "{:?}", design.sold);
}

#[test]
fn numbers_may_carry_units() {
    let design = designs::load("tests/designs/good/units.toml");
    assert_eq!(design.table, [2.0, 2.0]);
    assert_eq!(design.pair.bound, Configuration::new(0.43, 0.0, 0.0));
    let magnet = &design.pair.fixed.magnets[0];
    assert_eq!(
        (magnet.size, design.pitch),
        ([0.01, 0.01, 0.003], Some(0.04))
    );
    assert!((magnet.remanence() - 1.2).abs() < 1e-15);
    let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
    assert_eq!((fixed.mass, moving.mass), (0.1, 0.1));
    assert_eq!((fixed.thickness, moving.thickness), (0.013, 0.013));
    // Draft of 30 degrees over 20 mm, drawn back by half a millimetre on the other side.
    let top = fixed
        .outline
        .vertices()
        .iter()
        .map(|v| v.x)
        .fold(0.0, f64::max);
    assert!((top - 0.235).abs() < 1e-12);
    assert!(design.problem().clearance(&design.pair.bound) > 0.49e-3);
}

/// All faults of a file are reported together, in order, each with its place.
#[test]
fn all_faults_are_told_at_once() {
    let path = "tests/designs/bad/all-kinds-of-faults.toml";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let error = Design::load(&path).unwrap_err();
    assert_eq!(error.also.len(), 7, "{error}");
    let all = std::iter::once(&error).chain(&error.also);
    let lines: Vec<usize> = all
        .map(|fault| fault.place.as_ref().unwrap().line)
        .collect();
    assert!(lines.is_sorted(), "{lines:?}");
    assert!(error.also.iter().all(|fault| fault.also.is_empty()));
}

#[test]
fn own_keys_go_before_all_and_those_before_the_rest() {
    let design = designs::load("tests/designs/good/overrides.toml");
    let east = magnets_of_face(&design.pair.fixed, 0);
    assert_eq!(east.len(), 3);
    assert!((east[1].position - Vector2::new(0.194, 0.0)).norm() < 1e-15);
    assert!((east[2].position.y - 0.05).abs() < 1e-15);
    assert!(east.iter().all(|magnet| magnet.moment == 0.1));
    // The mate: the partner's pitch and inset, its own moment.
    let west = magnets_of_face(&design.pair.moving, 2);
    assert!((west[0].position - Vector2::new(-0.194, 0.05)).norm() < 1e-15);
    assert!(west.iter().all(|magnet| magnet.moment == 0.2));
    // The hollow of the fixed tile's north face, and its mates on two faces of the moving tile,
    // drawn back by `fit`.
    let reach = |tile: &Tile, direction: Vector2<f64>| {
        let vertices = tile.outline.vertices().iter();
        vertices.map(|v| v.dot(&direction)).fold(f64::MIN, f64::max)
    };
    assert!((reach(&design.pair.fixed, Vector2::y()) - 0.2).abs() < 1e-15);
    // (Its highest point is a corner of two chords, which moves by a hair more than they do.)
    assert!((reach(&design.pair.moving, Vector2::x()) - 0.2195).abs() < 1e-6);
    assert!((reach(&design.pair.moving, -Vector2::y()) - 0.2).abs() < 1e-12);
    assert!(magnets_of_face(&design.pair.moving, 3).is_empty());
}

#[test]
fn a_doubtful_design_loads_with_a_warning() {
    let bare = changed(
        "flat.toml",
        &[("code = \"NSSS\"", "code = \"\""), ("mates = \"east\"", "")],
    );
    assert!(
        bare.warnings[0]
            .to_string()
            .contains("the moving tile has no magnet")
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes/sine-teeth-20mm.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let shallow = Design::parse(&text.replace("inset = 0.004", "inset = 0.0"), "a.toml").unwrap();
    // One for each face with magnets, and the fix is enough of a fix.
    assert_eq!(shallow.warnings.len(), 2);
    let help = &shallow.warnings[0].help;
    let more: f64 = help.split(' ').nth(3).unwrap().parse().unwrap();
    let inset = format!("inset = {}", more + 1e-6);
    let mended = Design::parse(&text.replace("inset = 0.004", &inset), "a.toml").unwrap();
    assert_eq!(mended.warnings.len(), 0, "{inset}");
    // A table of a hundred metres, and a fit that leaves nothing of the shape.
    let wide = changed("flat.toml", &[("[2.0, 2.0]", "[100.0, 100.0]")]);
    assert!(wide.warnings[0].message.contains("did you mean 1 (100 cm)"));
    let loose = changed("units.toml", &[("\"0.5 mm\"", "\"2 cm\"")]);
    assert!(loose.warnings[0].message.contains("no longer guides"));
}

/// Files damaged at random are refused or load; nothing panics, whatever the damage.
#[test]
fn damaged_files_never_panic() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let wild = [
        "0", "-1", "nan", "inf", "1e308", "1e-308", "5e-324", "0.43", "7", "\"\"", "[]", "{}",
        "\"ä\"",
    ];
    for path in files("shapes").iter().chain(&files("tests/designs/good")) {
        let text = std::fs::read_to_string(path).unwrap();
        for _ in 0..60 {
            let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
            for _ in 0..random.random_range(1..4) {
                let k = random.random_range(0..lines.len());
                let values: Vec<_> = lines[k]
                    .match_indices(|c: char| c.is_ascii_digit())
                    .collect();
                match random.random_range(0..4) {
                    0 => drop(lines.remove(k)),
                    1 => {
                        let chars: Vec<char> = lines[k].chars().collect();
                        let cut = random.random_range(0..=chars.len());
                        lines[k] = chars[..cut].iter().collect();
                    }
                    _ if values.is_empty() => lines.push(lines[k].clone()),
                    _ => {
                        let start = values[0].0;
                        let number = |c: char| c.is_ascii_digit() || c == '.';
                        let length = lines[k][start..].find(|c| !number(c));
                        let end = length.map_or(lines[k].len(), |length| start + length);
                        let value = wild[random.random_range(0..wild.len())];
                        lines[k].replace_range(start..end, value);
                    }
                }
            }
            if let Err(error) = Design::parse(&lines.join("\n"), "damaged.toml") {
                assert!(error.place.is_some() && !error.help.is_empty(), "{error}");
                let _ = error.to_string();
            }
        }
    }
}
