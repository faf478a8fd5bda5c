//! Discs, and magnets magnetised across the table.

use super::magnets_of_face;
use tilebind::Configuration;
use tilebind::design::Design;
use tilebind::tile::magnet::{Form, Shape, Standing};

const DISC: &str = "shape = \"disc\"\ndiameter = \"10 mm\"\nheight = \"5 mm\"";

fn text(magnet: &str, codes: [&str; 2]) -> String {
    let tile = |name: &str, code: &str| {
        format!(
            "[{name}]\nside = 0.1\nthickness = 0.012\nmass = 0.05\n[{name}.faces]\nall = {{ code = \
             \"{code}\" }}\n"
        )
    };
    format!(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\n{magnet}\nremanence = 1.3\npitch = 0.02\ninset = 0.001\n\
         {}{}[target]\nfixed = \"east\"\nmoving = \"west\"\n",
        tile("fixed", codes[0]),
        tile("moving", codes[1])
    )
}

/// Keys of people who use other words for magnets, and the messages for them.
#[test]
fn keys_of_discs_by_other_names_are_answered_with_ours() {
    for (from, to, help) in [
        ("height", "length", "`diameter` and `height`"),
        ("height", "thickness", "`diameter` and `height`"),
        ("diameter", "width", "`diameter` and `height`"),
        ("diameter", "radius", "twice the radius"),
        ("\"disc\"", "\"cylinder\"", "write \"disc\""),
    ] {
        let text = text(&DISC.replace(from, to), ["NNNS", "NSSS"]);
        let told = Design::parse(&text, "disc.toml").unwrap_err().to_string();
        assert!(told.contains(help), "{to}: {told}");
    }
}

#[test]
fn codes_have_the_letters_of_their_magnets() {
    let up = format!("{DISC}\naxis = \"up\"");
    for (magnet, codes, help) in [
        (&*up, ["NNNS", "NSSS"], "use U for a north pole up"),
        (DISC, ["UUUD", "UDDD"], "write axis = \"up\""),
    ] {
        let told = Design::parse(&text(magnet, codes), "disc.toml").unwrap_err();
        assert!(told.to_string().contains(help), "{told}");
    }
}

fn design(magnet: &str, codes: [&str; 2]) -> Design {
    Design::parse(&text(magnet, codes), "disc.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// Against magpylib 6.3, whose field of 16 cylinders was summed over the other 16 by Gauss's rule. The
/// series of distant pairs ends where its error is small beside the energy in contact.
#[test]
fn energies_of_discs_agree_with_independent_numbers() {
    let poses = [(0.1, 0.0, 0.0), (0.12, 0.03, 0.4)].map(|(x, y, t)| Configuration::new(x, y, t));
    let standing = format!("{DISC}\naxis = \"up\"");
    for (magnet, codes, energies) in [
        (DISC, ["NNNS", "NSSS"], [-0.184371066194, -0.00574203190134]),
        (
            &standing,
            ["UUUD", "UDDD"],
            [-0.0517495792538, -0.00189658118053],
        ),
    ] {
        let problem = design(magnet, codes).problem();
        for (q, expected) in poses.iter().zip(energies) {
            let found = problem.energy(q);
            let off = (found - expected).abs();
            assert!(off < 1e-10 * energies[0].abs(), "{found} {expected}");
        }
    }
}

#[test]
fn discs_lie_or_stand_as_far_behind_the_face_as_is_said() {
    let lying = design(DISC, ["NNNS", "NSSS"]);
    let first = &magnets_of_face(&lying.pair.fixed, 0)[0];
    assert_eq!(first.size, [0.005, 0.01, 0.01]);
    assert!((first.position.x - (0.05 - 0.001 - 0.0025)).abs() < 1e-15);
    let volume = std::f64::consts::PI * 0.005 * 0.005 * 0.005;
    assert!((first.moment * tilebind::units::MU0 / (1.3 * volume) - 1.0).abs() < 1e-14);
    let standing = design(&format!("{DISC}\naxis = \"up\""), ["UUUD", "UDDD"]);
    let magnets = magnets_of_face(&standing.pair.fixed, 0);
    let form = |stands| Form {
        shape: Shape::Disc,
        stands: Some(stands),
    };
    assert_eq!(magnets[0].form, form(Standing::Up));
    assert_eq!(magnets[3].form, form(Standing::Down));
    assert_eq!(magnets[0].size, [0.01, 0.01, 0.005]);
    assert!((magnets[0].position.x - (0.05 - 0.001 - 0.005)).abs() < 1e-15);
    // An upright block: its height first, then along the face, then into the tile.
    let block = design(
        "size = [0.006, 0.01, 0.004]\naxis = \"up\"",
        ["UUUD", "UDDD"],
    );
    let first = &magnets_of_face(&block.pair.fixed, 0)[0];
    assert_eq!(first.size, [0.004, 0.01, 0.006]);
}

/// U beside D binds, U beside U is repelled; words are written with N and S.
#[test]
fn a_mate_of_standing_magnets_binds() {
    let standing = format!("{DISC}\naxis = \"up\"");
    let mates = design(&standing, ["UUUD", "UDDD"]);
    assert!(mates.problem().energy(&mates.pair.bound) < -0.05);
    let alike = design(&standing, ["UUUU", "UUUU"]);
    assert!(alike.problem().energy(&alike.pair.bound) > 0.05);
}

#[test]
fn what_is_wrong_with_a_disc_is_told() {
    for (magnet, code, expected) in [
        (
            "shape = \"disc\"\nsize = [0.01, 0.01, 0.005]",
            "N",
            "a disc has no `size`",
        ),
        (
            "shape = \"disc\"\ndiameter = 0.01",
            "N",
            "the height of this magnet is missing",
        ),
        (
            "size = [0.01, 0.01, 0.005]\ndiameter = 0.01",
            "N",
            "a block has no `diameter`",
        ),
        ("shape = \"cone\"", "N", "`shape` cannot be \"cone\""),
        (DISC, "U", "these magnets are not upright"),
        (
            &format!("{DISC}\naxis = \"down\""),
            "N",
            "`axis` cannot be \"down\"",
        ),
    ] {
        let told = match Design::parse(&text(magnet, [code, code]), "disc.toml") {
            Ok(_) => "loads".to_owned(),
            Err(error) => error.to_string(),
        };
        assert!(told.contains(expected), "{magnet}: {told}");
    }
}

#[test]
fn shields_stand_behind_any_magnets() {
    let shield = "[shield]\nattenuation = 0.5\nlength = 0.03\nwidth = 0.3\n";
    let up = format!("{DISC}\naxis = \"up\"");
    for (magnet, codes) in [(&*up, ["UUUD", "UDDD"]), (DISC, ["NNNS", "NSSS"])] {
        let parse = |text: &str| Design::parse(text, "disc.toml").unwrap();
        let [bare, shielded] = ["", shield].map(|end| parse(&(text(magnet, codes) + end)));
        assert!(
            shielded
                .interaction
                .shields
                .fixed
                .iter()
                .all(Option::is_some)
        );
        // Both magnets of the bond are in front of their shields; the fronts' neighbours are aside.
        let [full, left] = [&bare, &shielded].map(|it| {
            let bond = it.pair.bound;
            it.problem().energy(&bond)
        });
        assert!(full < left && left < 0.8 * full, "{full} {left}");
        let tiles = [&shielded.pair.fixed, &shielded.pair.moving];
        assert!(shielded.interaction.bounds(tiles[0], tiles[1]).is_ok());
    }
}
