//! Equal tiles: one kind, many copies, and what they build.

use std::f64::consts::{FRAC_PI_3, TAU};

use tilebind::design::Design;
use tilebind::dynamics::Motion;
use tilebind::many_bodies::contacts::{Tie, held};
use tilebind::many_bodies::structures::{Goal, Structure, StructureShape, are_joined, structures};
use tilebind::many_bodies::{Crowd, Mover};
use tilebind::table::of_designs;
use tilebind::{Configuration, Problem};

const HEAD: &str = "[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.003, 0.005, 0.003]\nremanence = 1.2\n\
    pitch = 0.012\ninset = 0.0005\n[potential]\nmodel = \"dipole\"\n";

const BODY: &str = "thickness = 0.006\nmass = 0.02\n";

fn read(text: &str) -> Design {
    Design::parse(text, "equal.toml").unwrap()
}

/// A sector of a ring of this many: north on one cut, south on the other.
fn sector(count: usize) -> String {
    let half = TAU / count as f64 / 2.0;
    let corner = |r: f64, turn: f64| format!("[{:?}, {:?}]", r * turn.cos(), r * turn.sin());
    let (inner, outer) = (0.030, 0.070);
    let corners = [
        corner(inner, -half),
        corner(outer, -half),
        corner(outer, half),
        corner(inner, half),
    ];
    format!("vertices = [{}]\n{BODY}", corners.join(", "))
}

/// The same magnets, upright.
fn upright(tile: &str, faces: &str, target: &str) -> Design {
    let head = HEAD.replace("pitch", "axis = \"up\"\npitch");
    let head = head.replace("\"dipole\"", "\"cuboid\"");
    read(&format!(
        "{head}[tile]\n{tile}[tile.faces]\n{faces}\n[target]\n{target}\n"
    ))
}

fn one(tile: &str, faces: &str, target: &str) -> Design {
    read(&format!(
        "{HEAD}[tile]\n{tile}[tile.faces]\n{faces}\n[target]\n{target}\n"
    ))
}

fn two(tile: &str, faces: &str, target: [&str; 2]) -> Design {
    let [fixed, moving] = target;
    read(&format!(
        "{HEAD}[fixed]\n{tile}[fixed.faces]\n{faces}\n[moving]\n{tile}[moving.faces]\n{faces}\n\
         [target]\nfixed = \"{fixed}\"\nmoving = \"{moving}\"\n"
    ))
}

/// Tiles at rest, by kind and place.
fn at_rest(crowd: &Crowd, places: &[(usize, [f64; 3])]) -> Vec<Mover> {
    let mover = |(kind, place): &(usize, [f64; 3])| {
        let motion = Motion {
            configuration: Configuration::from(*place),
            velocity: Default::default(),
        };
        Mover::new(crowd, *kind, &motion)
    };
    places.iter().map(mover).collect()
}

/// The numbers of bonds, traps and other contacts, and what was built.
fn found(crowd: &Crowd, places: &[(usize, [f64; 3])]) -> ([usize; 3], Vec<Structure>) {
    use tilebind::many_bodies::run::{Start, run};
    let settings = tilebind::many_bodies::TableSettings {
        duration: 1e-3,
        drag: 0.0,
        friction: 0.3,
        restitution: 0.01,
        shaking: None,
        kicks: 5e-3,
        orbital: None,
        linear: None,
        table_friction: 0.0,
        fans: Vec::new(),
        step: 1e-3,
        sampling: 1e-3,
        walls: true,
    };
    let start = Start::Given(at_rest(crowd, places));
    let run = run(crowd, &settings, (1, 0), &start, false).unwrap();
    let first = &run.samples[0];
    let counts = [Tie::Bond, Tie::Trap, Tie::Contact].map(|tie| first.count(tie));
    (counts, first.structures.clone())
}

fn ring(count: usize) -> Vec<[f64; 3]> {
    let turn = |k: usize| TAU * k as f64 / count as f64;
    (0..count).map(|k| [0.0, 0.0, turn(k)]).collect()
}

fn of_kind(kind: usize, places: &[[f64; 3]]) -> Vec<(usize, [f64; 3])> {
    places.iter().map(|place| (kind, *place)).collect()
}

#[test]
fn rings_of_three_to_twelve_are_closed() {
    for count in 3..=12 {
        let design = one(
            &sector(count),
            "0 = { code = \"S\" }\n2 = { code = \"N\" }",
            "faces = [\"0\", \"2\"]",
        );
        let mut crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
        assert_eq!(crowd.kinds.len(), 1);
        crowd.goal = Some(Goal::Ring(count));
        let (counts, built) = found(&crowd, &of_kind(0, &ring(count)));
        assert_eq!(counts[..2], [count, 0], "{count}");
        let shapes: Vec<StructureShape> = built.iter().map(|it| it.shape).collect();
        assert_eq!(
            shapes,
            [StructureShape::Target, StructureShape::Ring],
            "{count}"
        );
        assert_eq!((built[1].tiles.len(), built[1].bonds), (count, count));
        // Without one tile it is a chain.
        if count > 3 {
            let (counts, built) = found(&crowd, &of_kind(0, &ring(count)[1..]));
            assert_eq!(counts[..2], [count - 2, 0]);
            assert_eq!((built.len(), built[0].shape), (1, StructureShape::Chain));
        }
    }
}

const SQUARE: &str = "side = 0.05\nthickness = 0.006\nmass = 0.02\n";

#[test]
fn sheets_of_squares_are_whole_or_have_holes() {
    let design = one(SQUARE, "all = { code = \"NS\" }", "faces = [\"east\"]");
    let mut crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
    assert_eq!(design.problem().bonds().len(), 16);
    for side in 2..=5_usize {
        crowd.goal = Some(Goal::Sheet(side, side));
        let place = |k: usize| {
            let turn = (k % 4) as f64 * TAU / 4.0;
            [0.05 * (k % side) as f64, 0.05 * (k / side) as f64, turn]
        };
        let all: Vec<[f64; 3]> = (0..side * side).map(place).collect();
        let (counts, built) = found(&crowd, &of_kind(0, &all));
        assert_eq!(counts[..2], [2 * side * (side - 1), 0], "{side}");
        assert_eq!(built[1].shape, StructureShape::Sheet);
        assert_eq!(built[0].shape, StructureShape::Target);
        assert_eq!((built[1].bonds, built[1].holes), (built[1].possible, 0));
        assert_eq!(built[1].rectangle, Some([side, side]));
        if side == 3 {
            let around: Vec<[f64; 3]> = (0..9).filter(|k| *k != 4).map(place).collect();
            let (counts, built) = found(&crowd, &of_kind(0, &around));
            assert_eq!((counts[0], built.len()), (8, 1));
            assert_eq!((built[0].holes, built[0].rectangle), (1, None));
        }
    }
}

#[test]
fn hexagons_fit_around_one() {
    let tile = "sides = 6\nside = 0.03\nthickness = 0.006\nmass = 0.01\n";
    let design = upright(tile, "all = { code = \"UD\" }\n", "faces = [\"0\"]");
    assert_eq!(design.problem().bonds().len(), 36);
    let crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
    let far = 0.03 * libm::sqrt(3.0);
    let around = (0..6).map(|k| {
        let turn = FRAC_PI_3 * k as f64;
        [far * libm::cos(turn), far * libm::sin(turn), turn]
    });
    let all: Vec<[f64; 3]> = std::iter::once([0.0; 3]).chain(around).collect();
    let (counts, built) = found(&crowd, &of_kind(0, &all));
    assert_eq!(counts[..2], [12, 0]);
    assert_eq!(built.len(), 1);
    assert_eq!(
        (built[0].shape, built[0].tiles.len(), built[0].holes),
        (StructureShape::Sheet, 7, 0)
    );
    let (_, built) = found(&crowd, &of_kind(0, &all[1..]));
    assert_eq!(
        (built[0].shape, built[0].tiles.len(), built[0].holes),
        (StructureShape::Ring, 6, 1)
    );
}

/// Squares that all bind each other, in these cells of a sheet: the only structure.
fn of_cells(cells: &[[usize; 2]]) -> Structure {
    let design = one(SQUARE, "all = { code = \"NS\" }", "faces = [\"east\"]");
    let crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
    let place = |[i, j]: &[usize; 2]| [0.05 * *i as f64, 0.05 * *j as f64, 0.0];
    let places: Vec<[f64; 3]> = cells.iter().map(place).collect();
    let (counts, built) = found(&crowd, &of_kind(0, &places));
    assert_eq!((counts[1], built.len()), (0, 1));
    built[0].clone()
}

#[test]
fn holes_tails_and_joined_rings_are_counted() {
    let cells = |side: usize, without: &[[usize; 2]]| -> Vec<[usize; 2]> {
        let all = (0..side * side).map(|k| [k % side, k / side]);
        all.filter(|cell| !without.contains(cell)).collect()
    };
    let of = |cells: &[[usize; 2]]| {
        let it = of_cells(cells);
        (it.shape, it.tiles.len(), it.bonds, it.holes)
    };
    // A hole of one tile, of two tiles, two holes, and a bay, which is none.
    assert_eq!(of(&cells(4, &[[1, 1]])), (StructureShape::Sheet, 15, 20, 1));
    assert_eq!(
        of(&cells(4, &[[1, 1], [2, 1]])),
        (StructureShape::Sheet, 14, 17, 1)
    );
    assert_eq!(
        of(&cells(5, &[[1, 1], [3, 3]])),
        (StructureShape::Sheet, 23, 32, 2)
    );
    assert_eq!(of(&cells(4, &[[0, 1]])), (StructureShape::Sheet, 15, 21, 0));
    // A ring alone, with a tail, and two rings that share a tile.
    let ring = cells(3, &[[1, 1]]);
    assert_eq!(of(&ring), (StructureShape::Ring, 8, 8, 1));
    let with = |more: &[[usize; 2]]| [&ring, more].concat();
    assert_eq!(
        of(&with(&[[3, 0], [4, 0]])),
        (StructureShape::Sheet, 10, 10, 1)
    );
    let next = cells(3, &[[1, 1], [0, 0]]);
    let next: Vec<[usize; 2]> = next.iter().map(|[i, j]| [i + 2, j + 2]).collect();
    assert_eq!(of(&with(&next)), (StructureShape::Sheet, 15, 16, 2));
    // Rows are chains, straight or bent.
    assert_eq!(
        of(&[[0, 0], [1, 0], [2, 0]]),
        (StructureShape::Chain, 3, 2, 0)
    );
    assert_eq!(
        of(&[[0, 0], [1, 0], [1, 1]]),
        (StructureShape::Chain, 3, 2, 0)
    );
    assert_eq!(
        of(&[[0, 1], [1, 1], [2, 1], [1, 0]]),
        (StructureShape::Sheet, 4, 3, 0)
    );
}

#[test]
fn hexagons_of_two_codes_fit_around_one() {
    let tile = "sides = 6\nside = 0.03\nthickness = 0.006\nmass = 0.01\n";
    for [code, mate] in [["N", "S"], ["NS.N", "S.NS"]] {
        let face = |k: usize| {
            format!(
                "{k} = {{ code = \"{}\", magnet = {{ pitch = 0.006 }} }}\n",
                [code, mate][k % 2]
            )
        };
        let faces: String = (0..6).map(face).collect();
        let design = one(tile, &faces, "faces = [\"0\", \"3\"]");
        let mut crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
        let far = 0.03 * libm::sqrt(3.0);
        let around = (0..6).map(|k| {
            let (sin, cos) = libm::sincos(FRAC_PI_3 * k as f64);
            // A third of a turn lays a tile onto itself.
            [far * cos, far * sin, 2.0 * FRAC_PI_3 * k as f64]
        });
        let all: Vec<[f64; 3]> = std::iter::once([0.0; 3]).chain(around).collect();
        // The pattern lies elsewhere, turned.
        let off = Configuration::new(0.1, -0.2, 0.7);
        let pattern = all
            .iter()
            .map(|it| (0, off.compose(&Configuration::from(*it))));
        let pattern: Vec<(usize, Configuration)> = pattern.collect();
        assert!(are_joined(&crowd, &pattern));
        assert!(!are_joined(&crowd, &[pattern[1], pattern[4]]));
        crowd.goal = Some(Goal::Pattern(pattern));
        let (counts, built) = found(&crowd, &of_kind(0, &all));
        assert_eq!(counts[..2], [12, 0]);
        let shapes: Vec<StructureShape> = built.iter().map(|it| it.shape).collect();
        assert_eq!(shapes, [StructureShape::Target, StructureShape::Sheet]);
        // One tile turned by a sixth binds nothing, and six are not the pattern.
        let mut turned = all;
        turned[3][2] += FRAC_PI_3;
        let (counts, built) = found(&crowd, &of_kind(0, &turned));
        assert_eq!((counts[0], built.len()), (9, 1));
    }
}

#[test]
fn one_kind_is_written_in_three_ways() {
    let tile = sector(8);
    let faces = "0 = { code = \"S\" }\n2 = { code = \"N\" }";
    let new = one(&tile, faces, "faces = [\"0\", \"2\"]");
    let old = two(&tile, faces, ["0", "2"]);
    let same = read(&format!(
        "moving = \"fixed\"\n{HEAD}[fixed]\n{tile}[fixed.faces]\n{faces}\n[target]\nfixed = \"0\"\nmoving = 2\n"
    ));
    for other in [&old, &same] {
        assert_eq!(format!("{:?}", new.pair), format!("{:?}", other.pair));
        assert!(other.is_of_one_kind());
        let [one, two] = [&new, other].map(|it| of_designs(std::slice::from_ref(it)).unwrap().0);
        assert_eq!(one.kinds.len(), two.kinds.len());
        assert_eq!(one.kinds[0].name, two.kinds[0].name);
    }
    assert_eq!(new.problem().bonds().len(), 2);
}

#[test]
fn nearly_equal_tiles_are_one_kind_and_others_are_not() {
    let design = |side: &str, code: &str| {
        read(&format!(
            "{HEAD}[fixed]\nside = 0.0762\n{BODY}[fixed.faces]\nall = {{ code = \"NS\" }}\n\
             [moving]\nside = {side}\n{BODY}[moving.faces]\nall = {{ code = \"{code}\" }}\n\
             [target]\nfixed = \"east\"\nmoving = \"west\"\n"
        ))
    };
    assert!(design("0.0762", "NS").is_of_one_kind());
    assert!(design("0.07622", "NS").is_of_one_kind());
    assert!(!design("0.0762", "SN").is_of_one_kind());
}

/// The bonds in the order of their poses.
fn poses(problem: &Problem) -> Vec<[i64; 3]> {
    let rounded = |q: &Configuration| q.to_array().map(|it| (it * 1e6).round() as i64);
    let mut poses: Vec<_> = problem.bonds().iter().map(|it| rounded(&it.pose)).collect();
    poses.sort_unstable();
    poses
}

#[test]
fn a_bond_is_what_the_faces_say() {
    // The two faces of each kind in exchanged places are the same contact.
    let hexagon = "sides = 6\nside = 0.03\nthickness = 0.006\nmass = 0.01\n";
    let faces: String = (0..6)
        .map(|k| {
            format!(
                "{k} = {{ code = \"{}\" }}\n",
                if k % 2 == 0 { 'N' } else { 'S' }
            )
        })
        .collect();
    let [there, back] = [["0", "3"], ["3", "0"]].map(|target| two(hexagon, &faces, target));
    assert_eq!(there.problem().bonds().len(), 18);
    assert_eq!(poses(&there.problem()), poses(&back.problem()));
    assert!(there.problem().rivals().is_empty());
    // The same faces on a tile without symmetry.
    let plate = "vertices = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.05], [0.0, 0.05]]\nthickness = 0.006\nmass = 0.02\n";
    let design = two(
        plate,
        "1 = { code = \"NN\" }\n0 = { code = \"NNSN\" }\n3 = { code = \"SS\" }",
        ["1", "3"],
    );
    assert_eq!(design.problem().bonds().len(), 2);
    let text = "1 = { code = \"NS\" }\n0 = { code = \"NNSN\" }\n3 = { code = \"NS\" }";
    assert_eq!(two(plate, text, ["1", "3"]).problem().bonds().len(), 4);
    let only = one(plate, text, "faces = [\"1\", \"3\"]\nonly = true");
    assert_eq!(only.problem().bonds().len(), 1);
    // A slid contact is none of them.
    let bound = design.pair.bound;
    let slid = Configuration::new(bound.x, bound.y + 0.012, bound.theta);
    assert!(design.problem().distance_to_bond(&slid) > 0.01);
}

#[test]
fn labels_of_tiles_change_nothing() {
    let design = two(
        &sector(8),
        "0 = { code = \"S\" }\n2 = { code = \"N\" }",
        ["0", "2"],
    );
    let crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
    let places = ring(8);
    let (straight, _) = found(&crowd, &of_kind(0, &places));
    let mut mixed = places.clone();
    mixed.swap(0, 5);
    mixed.swap(2, 3);
    assert_eq!(found(&crowd, &of_kind(0, &mixed)).0, straight);
    // Equal tiles in different frames remain two kinds, with the same bonds among all of them.
    let turned = read(&format!(
        "{HEAD}[fixed]\n{SQUARE}[fixed.faces]\neast = {{ code = \"NS\" }}\n[moving]\n{SQUARE}[moving.faces]\n\
         west = {{ mates = \"east\" }}\n[target]\nfixed = \"east\"\nmoving = \"west\"\n"
    ));
    let crowd = of_designs(std::slice::from_ref(&turned)).unwrap().0;
    assert_eq!(crowd.kinds.len(), 2);
    let half = TAU / 2.0;
    // A tile whose magnets are on its east side, and one beside it with them on its west side.
    for (first, second) in [
        ((0, 0.0), (1, 0.0)),
        ((0, 0.0), (0, half)),
        ((1, half), (1, 0.0)),
    ] {
        let places = [
            (first.0, [0.0, 0.0, first.1]),
            (second.0, [0.05, 0.0, second.1]),
        ];
        assert_eq!(found(&crowd, &places).0, [1, 0, 0], "{first:?} {second:?}");
    }
}

#[test]
fn magnets_in_the_corners_bind() {
    let corners = "\
        east = { magnets = [{ at = -0.022, pole = \"U\" }] }\n\
        north = { magnets = [{ at = -0.022, pole = \"D\" }] }\n\
        west = { magnets = [{ at = -0.022, pole = \"U\" }] }\n\
        south = { magnets = [{ at = -0.022, pole = \"D\" }] }\n";
    let design = upright(SQUARE, corners, "faces = [\"east\"]");
    let crowd = of_designs(std::slice::from_ref(&design)).unwrap().0;
    let places = [(0, [0.0; 3]), (0, [0.05, 0.0, TAU / 2.0])];
    let (counts, _) = found(&crowd, &places);
    assert_eq!(counts[..2], [1, 0]);
    let unused = held(&crowd, &at_rest(&crowd, &places), std::iter::empty());
    assert!(structures(&crowd, &at_rest(&crowd, &places), &unused).is_empty());
}

/// Copies counted by hand: pairs of faces that bind, each in both orders if they differ.
#[test]
fn copies_of_the_bond_are_counted_right() {
    let polygon = |sides: usize, code: &dyn Fn(usize) -> String, target: &str| {
        let tile = format!("sides = {sides}\nside = 0.03\nthickness = 0.006\nmass = 0.01\n");
        let face = |k: usize| format!("{k} = {{ code = \"{}\" }}\n", code(k));
        let faces: String = (0..sides)
            .filter(|k| !code(*k).is_empty())
            .map(face)
            .collect();
        let faces = faces.replace(" }", ", magnet = { pitch = 0.006 } }");
        let count = |more: &str| {
            let design = one(&tile, &faces, &format!("faces = {target}{more}"));
            design.problem().bonds().len()
        };
        [count(""), count("\nonly = true")]
    };
    let each = |codes: &'static [&'static str]| move |k: usize| codes[k % codes.len()].to_owned();
    let all_different = each(&["NNSN", "NNNN", "NSSN", "SNSS", "SNNS", "SSSS"]);
    for (sides, code, target, copies) in [
        // Every face binds every face: all pairs.
        (3, each(&["NS"]), "[\"0\"]", 9),
        (6, each(&["NS"]), "[\"0\"]", 36),
        (12, each(&["NS"]), "[\"0\"]", 144),
        // Half of the faces bind the other half, either way round.
        (6, each(&["N", "S"]), "[\"0\", \"3\"]", 18),
        (12, each(&["N", "S"]), "[\"0\", \"3\"]", 72),
        // Two codes that bind their own kind alternate: the target's are meant.
        (6, each(&["NS", "NNSS"]), "[\"0\"]", 9),
        (6, each(&["NS", "NNSS"]), "[\"1\"]", 9),
        // One face alone binds itself; one face and its mate make two contacts.
        (6, each(&["NS", "", "", "", "", ""]), "[\"0\"]", 1),
        (6, all_different, "[\"0\", \"3\"]", 2),
    ] {
        assert_eq!(
            polygon(sides, &code, target),
            [copies, 1],
            "{sides} {target} {}",
            code(0)
        );
    }
}

/// A tile turned over is another tile, unless it is its own mirror image.
#[test]
fn mirror_images_are_one_kind_only_of_tiles_with_a_mirror() {
    let pair = |fixed: [&str; 2], moving: [&str; 2], target: [&str; 2]| {
        let tile = |name: &str, [corners, faces]: [&str; 2]| {
            format!("[{name}]\nvertices = [{corners}]\n{BODY}[{name}.faces]\n{faces}\n")
        };
        let (fixed, moving) = (tile("fixed", fixed), tile("moving", moving));
        let [one, other] = target;
        read(&format!(
            "{HEAD}{fixed}{moving}[target]\nfixed = \"{one}\"\nmoving = \"{other}\"\n"
        ))
    };
    let lopsided = "[0.0, 0.0], [0.06, 0.0], [0.05, 0.03], [0.0, 0.05]";
    let over = "[-0.06, 0.0], [0.0, 0.0], [0.0, 0.05], [-0.05, 0.03]";
    let merged = |design: &Design| {
        let crowd = of_designs(std::slice::from_ref(design)).unwrap().0;
        (design.problem().exchange.is_some(), crowd.kinds.len())
    };
    // Turned over, the face's code runs the other way; NS turned over is SN, which does not bind NS.
    let [straight, turned] = ["0 = { code = \"NN\" }", "0 = { code = \"SS\" }"];
    assert!(!merged(&pair([lopsided, straight], [over, turned], ["0", "0"])).0);
    let same = "0 = { code = \"NS\" }";
    assert!(merged(&pair([lopsided, same], [lopsided, same], ["0", "0"])).0);
    assert_eq!(
        merged(&pair([lopsided, same], [over, same], ["0", "0"])),
        (false, 2)
    );
    // A trapezium that is its own mirror image, drawn as it lies when turned over: from another corner.
    let trapezium = "[-0.03, 0.0], [0.03, 0.0], [0.02, 0.03], [-0.02, 0.03]";
    let drawn_over = "[0.03, 0.0], [0.02, 0.03], [-0.02, 0.03], [-0.03, 0.0]";
    let faces = [
        "1 = { code = \"N\" }\n3 = { code = \"S\" }",
        "0 = { code = \"N\" }\n2 = { code = \"S\" }",
    ];
    assert!(
        merged(&pair(
            [trapezium, faces[0]],
            [drawn_over, faces[1]],
            ["1", "2"]
        ))
        .0
    );
    // Its magnets turned over are not: north is then on the other side.
    let swapped = "0 = { code = \"S\" }\n2 = { code = \"N\" }";
    assert!(
        !merged(&pair(
            [trapezium, faces[0]],
            [drawn_over, swapped],
            ["1", "0"]
        ))
        .0
    );
    // Only its corners have other numbers.
    let alike = [
        "1 = { code = \"NS\" }\n3 = { code = \"NS\" }",
        "0 = { code = \"NS\" }\n2 = { code = \"NS\" }",
    ];
    assert!(
        merged(&pair(
            [trapezium, alike[0]],
            [drawn_over, alike[1]],
            ["1", "0"]
        ))
        .0
    );
}
