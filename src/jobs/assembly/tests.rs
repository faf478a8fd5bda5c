//! Tests of tile sets: reading returns what was written, and growth follows the definitions.

use super::built::Plan;
use super::choice::{self, WordsVerdict};
use super::growth::{Grown, grow};
use physics::kinetics::bond::Shaking;

use super::{
    Built, MeetingAxis, Request, TileSet, Wiring, lattice, proofread, rgrow, square, xgrow,
};
use crate::design::WordSet;
use crate::request::of_keywords;
use physics::observer::Silent;
use physics::words::Bar;

fn shipped(name: &str) -> TileSet {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shapes/assemblies/");
    TileSet::load(format!("{folder}{name}.yaml").as_ref()).expect("it is shipped")
}

const SHIPPED: [&str; 6] = [
    "unary-square",
    "binary-tree",
    "binary-counter",
    "beaver-square",
    "spiral",
    "sierpinski",
];

#[test]
fn what_is_written_is_read_again() {
    let mut sets: Vec<TileSet> = SHIPPED.map(shipped).into();
    sets.extend([lattice::unique([2, 3]), square::counted(8)]);
    for set in &mut sets {
        set.gse = Some(8.125);
        set.gmc = Some(15.75);
        set.links = vec![(0, 1, -0.25)];
        set.tiles[0].stoic = 0.5;
        let again = rgrow::read(&rgrow::write(set, &["a remark".to_owned()]), "a").unwrap();
        assert_eq!(
            again,
            TileSet {
                name: String::new(),
                ..set.clone()
            }
        );
        let again = xgrow::read(&xgrow::write(set, &["a remark".to_owned()]), "a").unwrap();
        assert_eq!((&again.glues, &again.links), (&set.glues, &set.links));
        for (one, other) in again.tiles.iter().zip(&set.tiles) {
            assert_eq!((one.glues, one.stoic), (other.glues, other.stoic));
        }
        assert_eq!((again.gse, again.gmc), (set.gse, set.gmc));
    }
}

#[test]
fn files_of_the_engines_are_read() {
    let text = "% a remark\ntile edges matches {{N E S W}*}\nnum tile types=2\nnum binding types=2\n\
                tile edges={\n{1 0 2 0}[.5](red) % one\n{2 1 0 0}\n}\nbinding strengths={2 1}\n\
                g(1,2)=0.5\nblock=2\nseed=3,4,2\nGse=8.5\nT=2\n";
    let set = TileSet::parse(text, "a.tiles").unwrap();
    assert_eq!(set.tiles[0].glues, [Some(0), None, Some(1), None]);
    assert_eq!(
        (
            set.tiles[0].stoic,
            set.strengths()[0][1],
            set.strengths()[0][0]
        ),
        (0.5, 0.5, 2.0)
    );
    assert_eq!(
        (set.seed[0], set.gse, set.tau),
        ((3, 4, 1), Some(8.5), Some(2.0))
    );
    let json = r#"{"tiles": [{"name": "a", "edges": ["x", 0, "y", "x"]}], "glues": [["x", "y", 0.5]],
                   "bonds": [{"name": "x", "strength": 2}], "options": {"Gse": 9.0, "size": 8}}"#;
    let set = TileSet::parse(json, "a.json").unwrap();
    assert_eq!((set.strengths()[0][1], set.strengths()[1][1]), (0.5, 1.0));
    assert_eq!((set.gse, set.size), (Some(9.0), Some([8, 8])));
}

#[test]
fn faults_are_told_with_their_place() {
    let tiles = |rest: &str| format!("tiles:\n- {{name: t, edges: [a, a, a{rest}\n");
    let one = |line: &str| {
        format!(
            "tile edges matches {{{{N E S W}}*}}\nnum tile types=1\nnum binding types=1\ntile \
             edges={{\n{{1 1 1 1}}\n}}\nbinding strengths={{1}}\n{line}\n"
        )
    };
    for (text, line) in [
        (tiles("]}"), Some(2)),
        (tiles(", a], stoic: -1}"), Some(2)),
        (tiles(", a], stoic: much}"), Some(2)),
        (tiles(", a], stoic: 1e308}"), Some(2)),
        (tiles(", a], stoic: 1e-320}"), Some(2)),
        (tiles(", a]}") + "glues:\n- [a, b, 1]", Some(4)),
        (tiles(", a]}") + "seed: [1, 1, u]", Some(3)),
        (tiles(", a]}") + "hdoubletiles: [[t, t]]", Some(3)),
        (
            "num tile types=1\nnum binding types=1\ntile edges={\n{1 9 0 0}\n}".to_owned(),
            Some(4),
        ),
        (
            "num tile types=1\nnum binding types=x\ntile edges={".to_owned(),
            Some(2),
        ),
        (tiles(", a]}") + "tua: 5", Some(3)),
        (tiles(", a]}") + "bond:\n- {name: a, strength: 2}", Some(3)),
        (tiles(", a], label: x}"), Some(2)),
        (tiles(", a]}") + "canvas_type: tube-diagonals", Some(3)),
        (tiles(", a]}") + "options: {canvas_type: periodic}", Some(3)),
        (tiles(", a]}") + "cover_strands: [a]", Some(3)),
        (tiles(", a]}") + "model: SDC", Some(3)),
        (tiles(", a], stoic: 0}"), Some(2)),
        (
            tiles(", a]}") + "bonds: [{name: a, strength: 1e308}]",
            Some(3),
        ),
        (tiles(", a]}") + "options: {threshold: -1}", Some(3)),
        (tiles(", a]}") + "seed: [4294967296, 0, t]", Some(3)),
        (tiles(", a]}") + "seed: [[1, 1, t], [1, 1, t]]", Some(3)),
        (tiles(", a]}") + "tau: -1", Some(3)),
        (tiles(", a]}") + "tau: 1\nthreshold: 2", Some(4)),
        (tiles(", a]}") + "options: {Gmc: -1}", Some(3)),
        (tiles(", a]}") + "size: [8, 0]", Some(3)),
        (tiles(", a]}") + "size: 8.5", Some(3)),
        (tiles(", a]}") + "bonds: [{name: a}]", Some(3)),
        (tiles(", 1.5]}"), Some(2)),
        (tiles(", null]}"), Some(2)),
        (tiles(", a], name: u}"), Some(2)),
        (tiles(", a], color: \"x) % y\"}"), Some(2)),
        (tiles(", a]}").replace("t,", "\"t\\n}\","), None),
        (tiles(", a]}") + &"{a: ".repeat(40_000), None),
        (one("importfile=corner.seed"), Some(8)),
        (one("periodic"), Some(8)),
        (one("stoic=1[0.5]"), Some(8)),
        (one("sed=1,1,1"), Some(8)),
        (one("T=-1"), Some(8)),
        (one("g(1,1)=1e9"), Some(8)),
        (one("").replace("1 1}", "1 1}[inf]"), Some(5)),
        (one("size=8,9"), Some(8)),
        (
            "num tile types=1\nnum binding types=2\nbinding type names={a a}\ntile edges={\n{a 0 0 \
             0}\n}"
            .to_owned(),
            Some(3),
        ),
        ("[1, 2".to_owned(), None),
        (String::new(), None),
    ] {
        let fault = TileSet::parse(&text, "a").expect_err(&text);
        assert!(!fault.help.is_empty(), "{fault}");
        if line.is_some() {
            assert_eq!(
                fault.place.as_ref().map(|place| place.line),
                line,
                "{fault}"
            );
        }
    }
}

#[test]
fn names_stay_in_their_lines() {
    let text = "tiles:\n- {name: \"a % }\", edges: [0, \"g h\", 0, \"}\"], color: red}\n";
    let set = TileSet::parse(text, "a\n}.yaml").unwrap();
    assert_eq!(set.name, "a\u{fffd}}");
    let remarks = [set.name.clone()];
    let again = TileSet::parse(&xgrow::write(&set, &remarks), "a").unwrap();
    assert_eq!(again.tiles[0].glues, set.tiles[0].glues);
    assert_eq!(again.tiles[0].color, set.tiles[0].color);
    let again = TileSet::parse(&rgrow::write(&set, &remarks), "a").unwrap();
    assert_eq!((again.tiles, again.glues), (set.tiles, set.glues));
}

#[test]
fn what_only_steers_an_engine_is_noted() {
    let yaml = "tiles:\n- {name: t, edges: [a, a, a, a]}\nblock: 4\nfission: keep-seeded\noptions: \
                {update_rate: 100, canvas_type: square}\n";
    assert_eq!(
        TileSet::parse(yaml, "a").unwrap().passed_over,
        ["block", "update_rate"]
    );
    let marked = format!("\u{feff}{yaml}");
    assert_eq!(TileSet::parse(&marked, "a").unwrap().passed_over.len(), 2);
    let xgrow = "num tile types=1\nnum binding types=1\ntile edges={\n{00 1 0 1}\n}\nbinding \
                 strengths={1}\nblock=2 % large\nfission\nperiodic=False\nupdate_rate=10\n";
    let set = TileSet::parse(xgrow, "a").unwrap();
    assert_eq!(set.passed_over, ["block", "update_rate"]);
    assert_eq!(set.tiles[0].glues, [None, Some(0), None, Some(0)]);
}

/// Two glues that bind themselves, and each other half as strongly: two words, equal in three
/// places of four; their strengths are as requested.
#[test]
fn glues_that_bind_each_other_less_than_themselves_have_words_alike_in_part() {
    for asked in [0.5, 0.34] {
        let text = format!(
            "num tile types=2\nnum binding types=2\ntile edges={{\n{{0 1 0 2}}\n{{0 2 0 \
             1}}\n}}\nbinding strengths={{1 1}}\ng(1,2)={asked}\n"
        );
        let set = TileSet::parse(&text, "a.tiles").unwrap();
        let wiring = Wiring::new(&set).unwrap();
        assert_eq!((wiring.bonds.len(), wiring.links.len()), (2, 1));
        let asked_for = [("kt", "1e-3"), ("seconds", "4")];
        let request: Request =
            of_keywords(asked_for.map(|(key, value)| (key.to_owned(), vec![value.to_owned()])))
                .unwrap();
        let assembly = request.build(&set, None, None, &Silent).unwrap();
        let matrix = &assembly.built.matrix;
        let held = -matrix.energies[0][matrix.mate(1)] / matrix.bond(0);
        assert!((held / asked - 1.0).abs() < 0.13, "{asked}: {held}");
        let again = -matrix.energies[1][matrix.mate(0)] / matrix.bond(1);
        assert!((held - again).abs() < 0.02, "{held} {again}");
        // No other contact is stronger than the gap allows.
        let wrong = assembly
            .built
            .strongest_wrong()
            .map_or(0.0, |it| -it.2 / matrix.bond(0));
        assert!(wrong <= 0.55, "{wrong}");
    }
}

#[test]
fn strengths_near_each_other_share_words() {
    for strengths in ["1 0.95", "1 2", "1.15 0.92", "1 1.5"] {
        let text = format!(
            "num tile types=1\nnum binding types=2\ntile edges={{\n{{1 2 1 2}}\n}}\nbinding \
             strengths={{{strengths}}}\n"
        );
        let set = TileSet::parse(&text, "a.tiles").unwrap();
        let request: Request = of_keywords([("kt".to_owned(), vec!["1e-3".to_owned()])]).unwrap();
        let built = request.build(&set, None, None, &Silent).unwrap().built;
        let (_, asked, has) = built.unlike().unwrap();
        assert!(
            (has / asked - 1.0).abs() < 0.13,
            "{strengths}: {asked} {has}"
        );
        assert_ne!(built.matrix.words[0], built.matrix.words[1]);
    }
}

#[test]
fn a_glue_on_both_axes_needs_two_words() {
    let words = |name: &str| Wiring::new(&shipped(name)).unwrap().bonds.len();
    assert_eq!(
        ["unary-square", "binary-counter", "spiral", "beaver-square"].map(words),
        [10, 6, 17, 64]
    );
    let wiring = Wiring::new(&lattice::homogeneous([3, 3])).unwrap();
    assert_eq!(
        wiring
            .bonds
            .iter()
            .map(|bond| bond.axis)
            .collect::<Vec<_>>(),
        [MeetingAxis::Vertical, MeetingAxis::Horizontal]
    );
    for (m, n) in [(1, 2), (3, 3), (4, 7)] {
        let needed = Wiring::new(&lattice::unique([m, n])).unwrap().bonds.len();
        assert_eq!(needed, m * (n - 1) + n * (m - 1));
        assert_eq!(needed, lattice::words(m, n));
    }
}

#[test]
fn glues_that_hold_others_share_their_word() {
    let text = "tiles:\n- {name: t, edges: [0, a, 0, b]}\n- {name: u, edges: [0, c, 0, d]}\n\
                bonds: [{name: a, strength: 0}, {name: b, strength: 0}, {name: c, strength: 0}, \
                {name: d, strength: 0}]\nglues:\n- [a, b, 1]\n- [c, d, 1]\n";
    let wiring = Wiring::new(&TileSet::parse(text, "a").unwrap()).unwrap();
    assert_eq!(wiring.bonds.len(), 2);
    // a binds b and d, c binds only d, and none binds itself: no words can do that.
    let mixed = TileSet::parse(&(text.to_owned() + "- [a, d, 1]\n"), "a").unwrap();
    assert!(
        Wiring::new(&mixed)
            .unwrap_err()
            .to_string()
            .contains("separate glues")
    );
}

fn side(grown: &Grown) -> [i32; 2] {
    let [low, high] = grown.extent();
    [high.0 - low.0 + 1, high.1 - low.1 + 1]
}

#[test]
fn shipped_sets_grow_into_what_they_are_called() {
    for (name, tiles) in [
        ("unary-square", 25),
        ("binary-tree", 223),
        ("beaver-square", 961),
    ] {
        let grown = grow(&shipped(name), 2000);
        assert_eq!(
            (grown.tiles.len(), grown.complete, grown.choices),
            (tiles, true, 0),
            "{name}"
        );
    }
    // The busy beaver writes six ones, in each of four copies.
    let set = shipped("beaver-square");
    let halts = grow(&set, 2000)
        .tiles
        .into_values()
        .filter(|it| set.tiles[*it].name.starts_with("halt"));
    assert_eq!(halts.count(), 4);
    let counter = shipped("binary-counter");
    let grown = grow(&counter, 1500);
    for row in 1..20 {
        let shows = |x: i32| {
            let tile = &counter.tiles[grown.tiles[&(-x, row)]];
            i32::from(tile.glues[0].is_some_and(|glue| counter.glues[glue].name == "one"))
        };
        let value: i32 = (1..8).map(|x| shows(x) << (x - 1)).sum();
        assert_eq!(value, row);
    }
    let spiral = grow(&shipped("spiral"), 1681);
    assert_eq!((spiral.choices, spiral.tiles.len()), (0, 1681));
    assert!(
        side(&spiral).iter().all(|side| (40..=43).contains(side)),
        "{:?}",
        side(&spiral)
    );
}

#[test]
fn squares_are_counted_with_few_tiles() {
    for n in [8, 9, 12, 15, 16, 17, 31, 32, 33, 40] {
        let set = square::counted(n);
        let grown = grow(&set, n * n + 10);
        assert!(grown.complete && grown.choices == 0, "{n}");
        assert_eq!(
            (grown.tiles.len(), side(&grown)),
            (n * n, [n as i32; 2]),
            "{n}"
        );
        let bits = libm::log2(n as f64 / 2.0).ceil() as usize + 1;
        assert!(set.tiles.len() <= 2 * bits + 42, "{n}: {}", set.tiles.len());
    }
}

#[test]
fn blocks_grow_into_the_same_pattern() {
    for name in ["sierpinski", "binary-counter", "unary-square", "spiral"] {
        let set = shipped(name);
        let plain = grow(&set, 300);
        for k in [2, 3] {
            let blocks = proofread::blocks(&set, k).unwrap();
            assert_eq!(blocks.tiles.len(), set.tiles.len() * k * k);
            let grown = grow(&blocks, 6000);
            assert_eq!(grown.choices, 0, "{name} {k}");
            let k = k as i32;
            for ((x, y), tile) in &plain.tiles {
                // The seed is the block's north-west... its corner of row and column 0.
                let there = grown.tiles.get(&(x * k, y * k));
                let expected = tile * (k * k) as usize;
                assert_eq!(there, Some(&expected), "{name} {k} at {x}, {y}");
            }
        }
    }
}

#[test]
fn blocks_keep_which_glues_hold_each_other() {
    let mut set = lattice::unique([1, 3]);
    set.links = vec![(0, 1, 0.5)];
    let blocks = proofread::blocks(&set, 3).unwrap();
    let name = |glue: usize| blocks.glues[glue].name.as_str();
    let [first, second] = [0, 1].map(|glue| &set.glues[glue].name);
    let found: Vec<_> = blocks
        .links
        .iter()
        .map(|link| (name(link.0).to_owned(), name(link.1).to_owned()))
        .collect();
    let wanted = (0..3).map(|row| (format!("{first}.{row}"), format!("{second}.{row}")));
    assert_eq!(found, wanted.collect::<Vec<_>>());
}

#[test]
fn tiles_without_a_name_are_numbered() {
    let text = "tiles:\n- edges: [0, g, 0, 0]\n- {name: last, edges: [0, 0, 0, g]}\n- edges: [0, 0, 0, g]\n";
    let set = rgrow::read(text, "a.yaml").unwrap();
    let names: Vec<&str> = set.tiles.iter().map(|tile| tile.name.as_str()).collect();
    assert_eq!(names, ["1", "last", "3"]);
}

#[test]
fn sets_of_too_many_tiles_or_glues_are_refused() {
    for (tiles, glues) in [(1, 1_000_000), (1_000_000, 1)] {
        let text = format!("num tile types={tiles}\nnum binding types={glues}\n");
        let error = xgrow::read(&text, "a.tiles").unwrap_err().to_string();
        assert!(error.contains("more than"), "{error}");
    }
}

#[test]
fn blocks_of_a_large_set_are_refused() {
    let set = super::lattice::unique([30, 30]);
    assert!(proofread::blocks(&set, 2).is_ok());
    assert!(
        proofread::blocks(&set, 3)
            .unwrap_err()
            .contains("--proofread")
    );
}

fn words(set: &TileSet, places: usize) -> WordSet {
    let asked = [
        ("kt", "1e-3"),
        ("length", &places.to_string()),
        ("seconds", "2"),
    ];
    let asked = asked.map(|(key, value)| (key.to_owned(), vec![value.to_owned()]));
    let request: Request = of_keywords(asked).unwrap();
    let demand = Wiring::new(set).unwrap().demand();
    let tried = choice::choose((&demand, &[]), places, &Bar::paper(), &request);
    let choice = tried.last().unwrap();
    assert_eq!(choice.verdict, WordsVerdict::Found);
    let list: Vec<String> = choice
        .words
        .iter()
        .map(|word| format!("\"{word}\""))
        .collect();
    WordSet::parse(&format!("words = [{}]", list.join(", ")), "found", None).unwrap()
}

#[test]
fn engines_get_the_energies_of_faces() {
    let set = shipped("binary-counter");
    let shaking = Shaking {
        kt: 2e-3,
        coverage: 0.1,
    };
    let words = words(&set, 8);
    let built = Built::new(&set, &words, Plan::default()).unwrap();
    let shaken = built.shaken(&words, shaking).unwrap();
    let engine = built.engine(&shaken);
    let table = engine.strengths();
    for (i, row) in built.matrix.energies.iter().enumerate() {
        for (j, energy) in row.iter().enumerate() {
            let in_kt = -energy / shaking.kt;
            assert!((table[i][j] * shaken.gse - in_kt).abs() <= 1e-12 * (1.0 + in_kt.abs()));
        }
    }
    // Bonds of strength 2 have twice the magnets, and the weakest of strength 1 is Gse.
    let depth = |word: usize| built.matrix.bond(word) / built.unit;
    for (word, bond) in built.wiring.bonds.iter().enumerate() {
        assert!(
            (depth(word) / bond.strength - 1.0).abs() < 0.05,
            "{}",
            depth(word)
        );
    }
    // Growth with real magnets, without errors, gives the same.
    let grown = grow(
        &TileSet {
            tau: Some(1.9),
            ..engine
        },
        400,
    );
    let plain = grow(&set, 400);
    assert_eq!(grown.tiles, plain.tiles);
    // Twice the tiles on the table reduce the cost by ln 2, for all of seven kinds.
    let more = Shaking {
        coverage: 0.2,
        ..shaking
    };
    let dense = built.shaken(&words, more).unwrap();
    assert!((shaken.gmc - dense.gmc - libm::log(2f64)).abs() < 1e-9);
    assert!((shaken.gmc - shaken.docking_cost - libm::log(7f64)).abs() < 1e-9);
}
