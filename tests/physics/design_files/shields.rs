//! Shields in design files.

use tilebind::design::Design;
use tilebind::potential::shielding::{Shield, ShieldRule};

use super::changed;
use crate::designs;

const WHOLE: Shield = Shield {
    attenuation: 0.8,
    length: 0.03,
    width: 0.3,
    front_gain: 1.0,
};

#[test]
fn a_face_goes_before_its_tile_and_the_tile_before_the_rest() {
    let shields = designs::load("tests/designs/good/shields.toml")
        .interaction
        .shields;
    assert_eq!(shields.rule, ShieldRule::Smooth);
    let narrow = Shield {
        width: 0.2,
        ..WHOLE
    };
    let west = Shield {
        attenuation: 0.5,
        width: 0.1,
        ..WHOLE
    };
    let south = Shield {
        front_gain: 1.2,
        ..WHOLE
    };
    assert_eq!(
        shields.fixed,
        [Some(narrow), None, Some(west), Some(narrow)]
    );
    // `mates` takes over line and magnets of the other tile, not its iron.
    assert_eq!(shields.moving, [None, Some(WHOLE), None, Some(south)]);
}

#[test]
fn a_rule_alone_shields_nothing_and_the_nearest_face_rule_wants_no_constants() {
    let with = |section: &str| {
        let target = "moving = \"west\"\n";
        changed("flat.toml", &[(target, &format!("{target}{section}"))])
    };
    let bare = with("[shield]\nrule = \"smooth\"\n");
    assert!(bare.interaction.shields.is_none());
    let nearest = with("[shield]\nrule = \"nearest-face\"\n");
    assert_eq!(nearest.interaction.shields.rule, ShieldRule::NearestFace);
    assert_eq!(
        (
            nearest.interaction.shields.is_none(),
            nearest.warnings.len()
        ),
        (false, 0)
    );
    let doubtful = with("[shield]\nrule = \"nearest-face\"\nlength = 0.03\n");
    let warning = doubtful.warnings[0].to_string();
    assert!(warning.contains("ignores shield constants"), "{warning}");
}

#[test]
fn shields_break_the_symmetry_of_tiles() {
    let symmetries = |design: &Design| design.problem().symmetries.len();
    let bare = designs::load("tests/designs/good/flat.toml");
    assert_eq!(symmetries(&bare), 16);
    let shield = "[shield]\nattenuation = 0.8\nlength = 0.03\nwidth = 0.3\n";
    let end = "moving = \"west\"\n";
    let all = changed("flat.toml", &[(end, &format!("{end}{shield}"))]);
    assert_eq!(symmetries(&all), 16);
    let code = "all = { code = \"NNNS\" }";
    let one = format!("{code}\nnorth = {{ shield = false }}");
    let three = changed(
        "flat.toml",
        &[(end, &format!("{end}{shield}")), (code, &one)],
    );
    assert_eq!(symmetries(&three), 4);
}
