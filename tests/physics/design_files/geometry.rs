//! Geometry of loaded designs: mates, fits, and the positions of magnets.

use std::f64::consts::TAU;
use std::path::Path;

use nalgebra::Vector2;
use tilebind::Configuration;
use tilebind::contact::Contact;
use tilebind::design::Design;
use tilebind::potential::{DipolePotential, Potential};
use tilebind::tile::Tile;
use tilebind::tile::profile::CHORD_SHARE;

use super::{changed, files, magnets_of_face};
use crate::designs;

/// All designs in which the target faces are exact mates.
fn exact_mates() -> Vec<Design> {
    let mut designs: Vec<_> = files("shapes")
        .iter()
        .filter(|path| {
            let text = std::fs::read_to_string(path).unwrap();
            text.contains("mates =") && !text.contains("fit =")
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
            d.dot(&face.tangent()).abs() < 0.9 * half && d.dot(&face.normal()).abs() < 0.45 * half
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
        let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
        for p in along_face(fixed, design.pair.target.0, &AT_ORIGIN) {
            let gap = distance(moving, &design.pair.bound, p).abs();
            assert!(gap < 1e-12, "{}: {p} is {gap} off", design.name);
        }
        for p in along_face(moving, design.pair.target.1, &design.pair.bound) {
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
            let area = design.pair.fixed.outline.area() + design.pair.moving.outline.area();
            assert!((area - 2.0 * 0.43 * 0.43).abs() < 1e-14, "{}", design.name);
        }
    }
}

#[test]
fn a_fit_leaves_a_gap_of_its_own_width_everywhere() {
    let fit = 0.001;
    for face in 0..8 {
        let design = every_profile(face, "0.001");
        let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
        let clearance = Contact::new(&fixed.outline, &moving.outline).clearance(&design.pair.bound);
        assert!((clearance - fit).abs() < 1e-12, "face {face}: {clearance}");
        // The middles of the edges face an edge; corners are farther away, never nearer.
        let middles = (0..moving.outline.vertices().len()).map(|i| {
            let (a, b) = moving.outline.edge(i);
            design.pair.bound.transform((a + b) / 2.0)
        });
        let line = &fixed.faces[design.pair.target.0];
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
        let face = &design.pair.fixed.faces[design.pair.target.0];
        let fixed = magnets_of_face(&design.pair.fixed, design.pair.target.0);
        let mut moving = magnets_of_face(&design.pair.moving, design.pair.target.1);
        moving.reverse();
        assert_eq!(fixed.len(), moving.len());
        for (a, b) in fixed.iter().zip(&moving) {
            let apart = design.pair.bound.transform(b.position) - a.position;
            let m = Vector2::new(
                (b.angle + design.pair.bound.theta).cos(),
                (b.angle + design.pair.bound.theta).sin(),
            );
            let n = Vector2::new(a.angle.cos(), a.angle.sin());
            // Straight across the gap; the moments equal along the normal, opposite along the face
            // and across the table.
            assert!(apart.dot(&face.tangent()).abs() < 1e-12, "{}", design.name);
            assert!(apart.dot(&face.normal()) >= a.size[0].min(a.size[1]) - 1e-12);
            assert_eq!(a.form, b.form.reversed(), "{}", design.name);
            if a.form.stands.is_some() {
                continue;
            }
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
    let design = designs::load("shapes/sine-teeth-20mm.toml");
    for magnet in &design.pair.fixed.magnets {
        let s = magnet.position.y;
        let surface = 0.215 + 0.010 * (TAU * 4.0 * s / 0.43).sin();
        let expected = surface - 0.004 - 0.005;
        assert!((magnet.position.x - expected).abs() <= CHORD_SHARE * 0.020);
    }
}

#[test]
fn a_halbach_row_gathers_its_field_outside() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes/halbach.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let energy = |text: &str| {
        let design = Design::parse(text, "halbach.toml").unwrap();
        let potential =
            DipolePotential::new(&design.pair.fixed.magnets, &design.pair.moving.magnets);
        potential.energy(&design.pair.bound)
    };
    let (outside, inside) = (
        energy(&text),
        energy(&text.replace("axis = -1.5708", "axis = 1.5708")),
    );
    assert!(outside < 2.0 * inside, "{outside} {inside}");
}

/// The pose in which squares of 6 cm with these shapes of their target faces bind, if they do.
fn shaped(fixed: &str, moving: &str) -> Option<Configuration> {
    let tile = |name: &str, face: &str, shape: &str| {
        format!(
            "[{name}]\nside = 0.06\nthickness = 0.01\nmass = 0.03\n[{name}.faces]\n{face} = {{ code = \
             \"N\"{shape} }}\n"
        )
    };
    let text = format!(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.004, 0.006, 0.006]\nremanence = 1.3\ninset = \
         0.001\n{}{}[target]\nfixed = \"east\"\nmoving = \"west\"\n",
        tile("fixed", "east", fixed),
        tile("moving", "west", moving)
    );
    let design = Design::parse(&text, "shaped.toml").ok()?;
    Some(design.pair.bound)
}

/// Arcs on straight faces, two of them, one against a flat face; not hollows, and not tabs.
#[test]
fn faces_that_bulge_touch_in_a_point() {
    let arc = |depth: f64| {
        format!(", profile = {{ shape = \"arc\", width = 0.05, depth = {depth}, offset = 0.0 }}")
    };
    let tab = ", profile = { shape = \"tab\", width = 0.02, depth = 0.005 }";
    for (fixed, moving, apart) in [
        (arc(3e-4), arc(3e-4), 6e-4),
        (arc(0.01), arc(0.004), 0.014),
        (arc(0.008), String::new(), 0.008),
        (String::new(), arc(2e-4), 2e-4),
    ] {
        let bound = shaped(&fixed, &moving).unwrap_or_else(|| panic!("{fixed} {moving}"));
        let error = bound.x - 0.06 - apart;
        assert!(
            error.abs() < 1e-6 && bound.y == 0.0,
            "{fixed} {moving}: {bound:?}"
        );
    }
    for (fixed, moving) in [
        (arc(0.01), arc(-0.005)),
        (tab.to_owned(), tab.to_owned()),
        (tab.to_owned(), arc(0.004)),
    ] {
        assert_eq!(shaped(&fixed, &moving), None, "{fixed} {moving}");
    }
}
