//! Design files, good and bad: what loads, what it loads as, and what is said of what does not.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::{Path, PathBuf};

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::contact::Contact;
use tilebind::design::Design;
use tilebind::potential::{DipolePotential, Potential};
use tilebind::tile::profile::CHORD_ERROR;
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

/// A bad file says in its first lines where its fault is, `# at: line:column`, and what the
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

fn load(path: &str) -> Design {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    Design::load(&path).unwrap_or_else(|error| panic!("{error}"))
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

/// All designs in which the target faces are exact mates.
fn exact_mates() -> Vec<Design> {
    let mut designs: Vec<_> = files("shapes")
        .iter()
        .filter(|path| {
            let text = std::fs::read_to_string(path).unwrap();
            text.contains("mates") && !text.contains("fit =")
        })
        .map(|path| Design::load(path).unwrap())
        .collect();
    assert!(designs.len() > 10);
    for face in 0..8 {
        designs.push(every_profile(face, "0.0"));
    }
    designs
}

fn every_profile(face: usize, fit: &str) -> Design {
    let number = format!("\"{face}\"");
    let fixed = format!("fixed = {number}");
    let moving = format!("moving = {number}");
    changed(
        "every-profile.toml",
        &[
            ("fixed = \"0\"", &fixed),
            ("moving = \"0\"", &moving),
            ("fit = 0.001", &format!("fit = {fit}")),
        ],
    )
}

#[test]
fn the_paper_s_tile_is_what_its_file_says() {
    let design = load("tests/designs/good/flat.toml");
    assert_eq!(
        (design.name.as_str(), design.sha256.as_str()),
        (
            "flat-nnns",
            "b80ed904c0b0071175466d563911a5e45a26fd2839b260d3301619e08fe29354"
        )
    );
    assert_eq!(design.bound, Configuration::new(0.43, 0.0, 0.0));
    assert_eq!(design.target, (0, 2));
    let space = design.space();
    assert_eq!(space.half_size, [1.0, 1.0]);
    // A square's radius of gyration is side / sqrt(6), its circle's radius side / sqrt(2).
    assert!((space.rho - 0.43 / 6_f64.sqrt()).abs() < 1e-15);
    assert!((space.free_distance - 0.43 * 2_f64.sqrt()).abs() < 1e-15);
    assert_eq!(
        (design.fixed.magnets.len(), design.moving.magnets.len()),
        (16, 16)
    );
    let north = &design.fixed.magnets[4];
    assert_eq!(north.face, 1);
    assert!((north.position - Vector2::new(0.06, 0.21)).norm() < 1e-15);
    assert!((north.angle - FRAC_PI_2).abs() < 1e-15);
    assert!((north.moment - 0.286_479).abs() < 1e-6);
    let outer_pole = north.position + Vector2::new(0.0, north.size[0] / 2.0);
    assert!((outer_pole.y - 0.215).abs() < 1e-15);
    assert_eq!(symmetry::rotations(&design.fixed).len(), 4);
    assert_eq!(
        symmetry::rotations(&load("shapes/hexagon.toml").moving).len(),
        6
    );
    assert_eq!(
        symmetry::rotations(&load("shapes/tab-10mm.toml").fixed).len(),
        1
    );
}

#[test]
fn a_terse_design_takes_the_defaults() {
    let design = load("tests/designs/good/terse.toml");
    assert_eq!(design.name, "terse");
    assert_eq!(
        (design.fixed.magnets.len(), design.moving.magnets.len()),
        (1, 1)
    );
    assert_eq!(design.moving.magnets[0].moment, 0.5);
    assert_eq!(design.bound, Configuration::new(0.4, 0.0, 0.0));
}

#[test]
fn own_keys_go_before_all_and_those_before_the_rest() {
    let design = load("tests/designs/good/overrides.toml");
    let magnets = |tile: &Tile, face: usize| -> Vec<Magnet> {
        let of_face = tile.magnets.iter().filter(|magnet| magnet.face == face);
        of_face.cloned().collect()
    };
    let east = magnets(&design.fixed, 0);
    assert_eq!(east.len(), 3);
    assert!((east[1].position - Vector2::new(0.194, 0.0)).norm() < 1e-15);
    assert!((east[2].position.y - 0.05).abs() < 1e-15);
    assert!(east.iter().all(|magnet| magnet.moment == 0.1));
    // The mate: the partner's pitch and inset, its own moment.
    let west = magnets(&design.moving, 2);
    assert!((west[0].position - Vector2::new(-0.194, 0.05)).norm() < 1e-15);
    assert!(west.iter().all(|magnet| magnet.moment == 0.2));
    // The hollow of the fixed tile's north face, and its mates on two faces of the moving tile,
    // drawn back by `fit`.
    let reach = |tile: &Tile, direction: Vector2<f64>| {
        let vertices = tile.outline.vertices().iter();
        vertices.map(|v| v.dot(&direction)).fold(f64::MIN, f64::max)
    };
    assert!((reach(&design.fixed, Vector2::y()) - 0.2).abs() < 1e-15);
    // (Its highest point is a corner of two chords, which moves by a hair more than they do.)
    assert!((reach(&design.moving, Vector2::x()) - 0.2195).abs() < 1e-6);
    assert!((reach(&design.moving, -Vector2::y()) - 0.2).abs() < 1e-12);
    assert!(magnets(&design.moving, 3).is_empty());
}

/// Points along the part of a tile's outline that belongs to one of its faces, in the frame of
/// the fixed tile.
fn along_face(tile: &Tile, face: usize, q: &Configuration) -> Vec<Vector2<f64>> {
    let face = &tile.faces[face];
    let half = face.length() / 2.0;
    (0..tile.outline.vertices().len())
        .flat_map(|i| {
            let (a, b) = tile.outline.edge(i);
            [a, (a + b) / 2.0, a * 0.01 + b * 0.99]
        })
        .filter(|p| {
            let d = p - face.middle();
            d.dot(&face.tangent()).abs() < half - 0.02 && d.dot(&face.normal()).abs() < 0.1
        })
        .map(|p| q.transform(p))
        .collect()
}

fn distance(tile: &Tile, q: &Configuration, p: Vector2<f64>) -> f64 {
    tile.outline.signed_distance(q.inverse_transform(p))
}

const AT_ORIGIN: Configuration = Configuration::new(0.0, 0.0, 0.0);

#[test]
fn mates_coincide_in_the_bound_configuration() {
    for design in exact_mates() {
        let (fixed, moving) = (&design.fixed, &design.moving);
        for p in along_face(fixed, design.target.0, &AT_ORIGIN) {
            let gap = distance(moving, &design.bound, p).abs();
            assert!(gap < 1e-12, "{}: {p} is {gap} off", design.name);
        }
        for p in along_face(moving, design.target.1, &design.bound) {
            let gap = distance(fixed, &AT_ORIGIN, p).abs();
            assert!(gap < 1e-12, "{}: {p} is {gap} off", design.name);
        }
    }
}

#[test]
fn what_a_profile_adds_to_one_tile_its_mate_lacks() {
    for path in files("shapes") {
        let design = Design::load(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        if text.matches("side = 0.43").count() == 2 && !text.contains("fit =") {
            let area = design.fixed.outline.area() + design.moving.outline.area();
            assert!((area - 2.0 * 0.43 * 0.43).abs() < 1e-14, "{}", design.name);
        }
    }
}

#[test]
fn a_fit_leaves_a_gap_of_its_own_width_everywhere() {
    let fit = 0.001;
    for face in 0..8 {
        let design = every_profile(face, "0.001");
        let (fixed, moving) = (&design.fixed, &design.moving);
        let clearance = Contact::new(&fixed.outline, &moving.outline).clearance(&design.bound);
        assert!((clearance - fit).abs() < 1e-12, "face {face}: {clearance}");
        // The middles of the edges face an edge; corners are farther away, never nearer.
        let middles = (0..moving.outline.vertices().len()).map(|i| {
            let (a, b) = moving.outline.edge(i);
            design.bound.transform((a + b) / 2.0)
        });
        let line = &fixed.faces[design.target.0];
        let near = |p: &Vector2<f64>| {
            let d = p - line.middle();
            d.dot(&line.tangent()).abs() < line.length() / 2.0 - 0.01
                && d.dot(&line.normal()).abs() < 0.1
        };
        let gaps: Vec<_> = middles
            .filter(near)
            .map(|p| distance(fixed, &AT_ORIGIN, p))
            .collect();
        assert!(gaps.len() > 2);
        for gap in gaps {
            assert!((gap - fit).abs() < 1e-12, "face {face}: {gap}");
        }
    }
}

#[test]
fn mated_magnets_face_each_other_head_to_tail() {
    for design in exact_mates() {
        let face = &design.fixed.faces[design.target.0];
        let of_face = |tile: &Tile, face: usize| -> Vec<Magnet> {
            let magnets = tile.magnets.iter().filter(|magnet| magnet.face == face);
            magnets.cloned().collect()
        };
        let fixed = of_face(&design.fixed, design.target.0);
        let mut moving = of_face(&design.moving, design.target.1);
        if design.name == "wrong-partner" || design.name == "arrowhead" {
            continue;
        }
        moving.reverse();
        assert_eq!(fixed.len(), moving.len());
        for (a, b) in fixed.iter().zip(&moving) {
            let apart = design.bound.transform(b.position) - a.position;
            let m = Vector2::new(
                (b.angle + design.bound.theta).cos(),
                (b.angle + design.bound.theta).sin(),
            );
            let n = Vector2::new(a.angle.cos(), a.angle.sin());
            // Straight across the gap; the moments equal along the normal, opposite along the face.
            assert!(apart.dot(&face.tangent()).abs() < 1e-12, "{}", design.name);
            assert!(apart.dot(&face.normal()) >= a.size[0].min(a.size[1]) - 1e-12);
            assert!((m - n).dot(&face.normal()).abs() < 1e-12, "{}", design.name);
            assert!(
                (m + n).dot(&face.tangent()).abs() < 1e-12,
                "{}",
                design.name
            );
            assert_eq!((a.moment, a.size), (b.moment, b.size));
        }
    }
}

#[test]
fn a_magnet_sits_behind_the_line_at_its_place() {
    let design = load("shapes/sine-teeth-20mm.toml");
    for magnet in &design.fixed.magnets {
        let s = magnet.position.y;
        let surface = 0.215 + 0.010 * (TAU * 4.0 * s / 0.43).sin();
        let expected = surface - 0.004 - 0.005;
        assert!((magnet.position.x - expected).abs() <= CHORD_ERROR);
    }
}

#[test]
fn a_halbach_row_gathers_its_field_outside() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes/halbach.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let energy = |text: &str| {
        let design = Design::parse(text, "halbach.toml").unwrap();
        let potential = DipolePotential::new(&design.fixed.magnets, &design.moving.magnets);
        potential.energy(&design.bound)
    };
    let (outside, inside) = (
        energy(&text),
        energy(&text.replace("axis = -1.5708", "axis = 1.5708")),
    );
    assert!(outside < 2.0 * inside, "{outside} {inside}");
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
    // One for each face with magnets, and the mend is enough of a mend.
    assert_eq!(shallow.warnings.len(), 2);
    let help = &shallow.warnings[0].help;
    let more: f64 = help.split(' ').nth(3).unwrap().parse().unwrap();
    let inset = format!("inset = {}", more + 1e-6);
    let mended = Design::parse(&text.replace("inset = 0.004", &inset), "a.toml").unwrap();
    assert_eq!(mended.warnings.len(), 0, "{inset}");
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
