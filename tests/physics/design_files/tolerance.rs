//! Faces that differ by less than a cutter resolves: accepted with a warning, and bound all the
//! same.

use tilebind::design::Design;
use tilebind::problem::Problem;

/// Two squares (or other tiles) with such keys and target faces, east and west of squares.
fn pair([fixed, face]: [&str; 2], [moving, mate]: [&str; 2]) -> Result<Design, String> {
    let tile = |name: &str, keys: &str, face: &str| {
        format!("[{name}]\n{keys}\nthickness = 0.005\nmass = 0.05\n[{name}.faces]\n{face}\n")
    };
    let text = format!(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.005, 0.005, 0.003]\nremanence = 1.2\n\
         pitch = 0.015\ninset = 0.002\n{}{}[target]\nfixed = \"0\"\nmoving = \"2\"\n",
        tile("fixed", fixed, face),
        tile("moving", moving, mate)
    );
    Design::parse(&text, "pair.toml").map_err(|error| error.to_string())
}

const SIDE: &str = "side = \"80 mm\"";
const CODE: &str = "0 = { code = \"NNNS\" }";
const MATE: &str = "2 = { code = \"NSSS\" }";

fn tab(face: usize, code: &str, width: f64, depth: f64, draft: f64) -> String {
    format!(
        "{face} = {{ code = \"{code}\", profile = {{ shape = \"tab\", width = {width}, depth = \
         {depth}, draft = {draft} }} }}"
    )
}

/// The bound configuration is free, and touches to within what is told of the pair.
#[track_caller]
fn check_bound(design: &Design) {
    let problem: Problem = design.problem();
    assert!(problem.is_free(&design.pair.bound));
    assert!(problem.clearance(&design.pair.bound).abs() < 1e-6);
    assert!(problem.energy(&design.pair.bound) < 0.0);
    // Nearby contacts are left: the tiles come straight out.
    let mut out = design.pair.bound;
    out.x += 0.02;
    assert!(problem.motion_is_free(&design.pair.bound, &out));
}

#[test]
fn sides_that_differ_by_less_than_a_cutter_resolves_meet_middle_on_middle() {
    for (side, told) in [
        ("3.1496 in", "79.9998 mm"),
        ("80.00012 mm", "80.0001 mm"),
        ("80.05 mm", "80.05 mm"),
        ("79.951 mm", "79.95 mm"),
    ] {
        let side = format!("side = \"{side}\"");
        for design in [
            pair([SIDE, CODE], [&side, MATE]),
            pair([&side, CODE], [SIDE, "2 = { mates = \"0\" }"]),
        ] {
            let design = design.unwrap();
            assert_eq!(design.warnings.len(), 1, "{:?}", design.warnings);
            let told_of = design.warnings[0].to_string();
            for said in [
                told,
                "80 mm",
                "less than a cutter can resolve",
                "centre to centre",
            ] {
                assert!(told_of.contains(said), "{said} in {told_of}");
            }
            let [fixed, moving] = [&design.pair.fixed, &design.pair.moving];
            let expected = (fixed.faces[0].length() + moving.faces[0].length()) / 2.0;
            let [x, y, theta] = design.pair.bound.to_array();
            assert!((x - expected).abs() < 1e-15 && y == 0.0 && theta == 0.0);
            check_bound(&design);
        }
    }
}

#[test]
fn sides_that_differ_by_more_are_refused_with_the_digits_that_differ() {
    for (side, told) in [
        ("80.06 mm", "they are 80 mm and 80.06 mm long"),
        ("100 mm", "they are 80 mm and 100 mm long"),
    ] {
        let side = format!("side = \"{side}\"");
        let refused = pair([SIDE, CODE], [&side, MATE]).unwrap_err();
        assert!(refused.contains(told), "{refused}");
        let refused = pair([SIDE, CODE], [&side, "2 = { mates = \"0\" }"]).unwrap_err();
        assert!(refused.contains("cannot mate a face of 80 mm"), "{refused}");
    }
    // A small tile is cut as finely as a large one, and may differ by a thousandth.
    let [small, off] = ["side = \"20 mm\"", "side = \"20.03 mm\""];
    let [face, mate] = ["0 = { code = \"N\" }", "2 = { code = \"S\" }"];
    let refused = pair([small, face], [off, mate]).unwrap_err();
    assert!(refused.contains("20 mm and 20.03 mm"), "{refused}");
}

#[test]
fn corners_rounded_by_a_drawing_program_are_taken_as_they_are() {
    let rounded =
        "vertices = [[0.04001, -0.04], [0.04, 0.03999], [-0.03999, 0.04], [-0.04, -0.04]]";
    let design = pair([SIDE, CODE], [rounded, MATE]).unwrap();
    assert_eq!(design.warnings.len(), 1, "{:?}", design.warnings);
    check_bound(&design);
}

#[test]
fn a_tab_that_is_a_little_too_wide_is_bound_where_it_touches() {
    let (wide, depth, draft) = (0.03, 0.004, 0.3_f64);
    let fixed = tab(0, "NNNS", wide, depth, draft);
    let moving = tab(2, "NSSS", wide - 1e-5, -depth, -draft);
    let design = pair([SIDE, &fixed], [SIDE, &moving]).unwrap();
    let told = design.warnings[0].to_string();
    assert!(told.contains("farther apart"), "{told}");
    // Either flank is 5 um too far out, and gives way by that over the tangent of its lean.
    let expected = 0.08 + 5e-6 / draft.tan();
    assert!((design.pair.bound.x - expected).abs() < 2e-9);
    check_bound(&design);
}

#[test]
fn a_tab_with_upright_flanks_that_is_a_little_too_wide_has_its_slot_drawn_back() {
    let (wide, depth) = (0.03, 0.004);
    let fixed = tab(0, "NNNS", wide, depth, 0.0);
    let slot = |play: f64| tab(2, "NSSS", wide - play, -depth, 0.0);
    let design = pair([SIDE, &fixed], [SIDE, &slot(1e-5)]).unwrap();
    let told = design.warnings[0].to_string();
    assert!(
        told.contains("drawn back by 5.00 um, as by `fit`"),
        "{told}"
    );
    check_bound(&design);
    let refused = pair([SIDE, &fixed], [SIDE, &slot(2e-4)]).unwrap_err();
    assert!(refused.contains("overlap by 0.1 mm"), "{refused}");
}

#[test]
fn teeth_that_end_at_the_corners_mate_a_face_of_nearly_that_length() {
    let teeth = "0 = { code = \"NNNS\", profile = { shape = \"teeth\", form = \"triangle\", count = \
                 4, depth = 0.003 } }";
    let other = "side = \"3.1496 in\"";
    for [fixed, moving] in [[SIDE, other], [other, SIDE]] {
        let design = pair([fixed, teeth], [moving, "2 = { mates = \"0\" }"]).unwrap();
        check_bound(&design);
    }
}
