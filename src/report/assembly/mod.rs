//! Assemblies as documents: files for the engines, designs of all pairs that meet, the workshop
//! sheet and the results.

mod picture;
mod sheet;
mod text;

use serde_json::{Map, Value, json};

use super::document::{Document, Drawing, Entries, Table, rows};
use super::files::{Files, PAGE, REPORT};
use super::values::positive_zero;
use jobs::assembly::built::{GrowthVerdict, Shaken};
use jobs::assembly::choice::{Choice, WordsVerdict};
use jobs::assembly::kinetic::Growth as Kinetic;
use jobs::assembly::slides::{self, Slid};
use jobs::assembly::wiring::Bond;
use jobs::assembly::{Assembly, Growing, MeetingAxis, SIDES, Tau, TileType, designs, rgrow, xgrow};
use jobs::output::Command;
use physics::order::Order;
use physics::units::{plain, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "assemble",
    files: &[
        REPORT,
        PAGE,
        "assembly.yaml",
        "assembly.tiles",
        "tileset.yaml",
        "matrix.csv",
        "pairs.csv",
        "slides.csv",
        "words.toml",
        "sheet.md",
        "designs/*.toml",
    ],
    pictures: &["grown"],
};

/// Number of slid contacts shown to people, deepest first.
const SHOWN: usize = 40;
/// Number of rows on a terminal.
const LISTED: usize = 5;

/// The document of an assembly.
pub fn document<'a>(assembly: &'a Assembly) -> Document<'a> {
    let title = "Error-free growth";
    Document {
        title: format!("Assembly {}", assembly.built.set.name),
        answer: text::headline(assembly),
        remarks: text::known(assembly),
        entries: entries(assembly),
        pictures: assembly
            .growing
            .iter()
            .map(|_| Drawing::new(title, |sheet| picture::grown(assembly, title, sheet)))
            .collect(),
        beside: beside(assembly),
        origin: format!("seed {}", assembly.request.seed),
        ..Document::default()
    }
}

// One line an entry.
#[rustfmt::skip]
fn entries(assembly: &Assembly) -> Entries {
    let (built, request) = (&assembly.built, &assembly.request);
    let (set, matrix, grown) = (&built.set, &built.matrix, &built.grown);
    let of_each = |counts: &[usize]| -> Value {
        set.tiles.iter().zip(counts).map(|(tile, count)| json!([tile.name, count])).collect()
    };
    let codes = |faces: std::ops::Range<usize>| -> Value {
        faces.map(|face| matrix.code(face).to_string()).collect()
    };
    let n = matrix.words.len();
    let wrong = built.strongest_wrong();
    let mismatch = wrong.map(|(i, j, energy)| {
        json!({"first": assembly.face(i), "second": assembly.face(j), "energy_J": energy})
    });
    let deeper = built.deeper();
    let (tau, tau_from) = match set.tau_from() {
        (tau, Tau::Stated) => (tau, "file"),
        (tau, Tau::OfEnergies) => (tau, "Gmc / Gse"),
        (tau, Tau::Assumed) => (tau, "assumed"),
    };
    let counts = assembly.counts();
    let shaken = assembly.growing.as_ref().map(|it| &it.shaken);
    let describe = |[least, most]: [f64; 2]| format!("{:+.1} to {:+.1} %", 100.0 * least, 100.0 * most);
    let mut deepest: Vec<_> = assembly.slides.iter().filter(|it| it.deepest.is_some()).collect();
    let all = slid(assembly, deepest.clone());
    deepest.order_by(|a, b| a.energy().total_cmp(&b.energy()));
    deepest.truncate(SHOWN);
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("tile_set", json!({
            "name": set.name,
            "tiles": set.tiles.len(),
            "glues": set.glues.len(),
            "words_needed": built.wiring.bonds.len(),
            "tau": tau,
            "tau_from": tau_from,
            "proofread": request.proofread,
            "lattice": request.lattice,
        }))
        .fact("tiles", "tiles", set.tiles.len()).in_view()
        .fact("words", "words", built.wiring.bonds.len()).in_view().noted("one per glue and axis")
        .and(assembly.growing.as_ref().map_or_else(Entries::default, |it| growing(assembly, it)))
        .data("bond_J", built.unit)
        .data("passed_over", &set.passed_over)
        .data("words", codes(0..n))
        .data("mates", codes(n..2 * n))
        .table(bonds(assembly))
        .table(slid(assembly, deepest).titled("Slid traps", format!(
            "the {SHOWN} deepest; the engines ignore them. Deeper than Gmc, one holds a tile alone"
        )).listing(LISTED).in_view())
        .table(all.in_csv("slides"))
        .data("matrix_J", matrix.energies.iter().map(|row| row.iter().copied().map(positive_zero).collect()).collect::<Vec<Value>>())
        .table(energies(assembly))
        .fact("strongest_mismatch", "strongest mismatch", mismatch)
            .viewed(si(wrong.map_or(0.0, |it| it.2), "J", 4)).noted("aligned")
        .fact("deeper_in_whole_tiles", "bonds between whole tiles", deeper.map(|ends| json!(ends)))
            .viewed(deeper.map_or(String::new(), describe)).noted("deeper than between two faces")
        .data("slides", slides::summary(built, shaken, &assembly.slides).map(|it| json!({
            "deepest_J": it.deepest,
            "pairs_that_hold_alone": it.holding,
            "pairs": it.pairs,
            "bonds_slid_share": it.share,
        })))
        .data("seed_tiles", text::seeds(assembly).into_iter().map(|it| it.0.as_str()).collect::<Value>())
        .data("grown", assembly.growing.as_ref().map(|_| json!({
            "tiles": grown.tiles.len(),
            "complete": grown.complete,
            "choices": grown.choices,
            "of_each": of_each(&counts),
        })))
        .data("laid", assembly.growing.is_none().then(|| json!({
            "tiles": counts.iter().sum::<usize>(),
            "of_each": of_each(&counts),
        })))
        .table(tiles(assembly))
        .table(pairs(assembly).in_file("pairs").in_data())
        .data("faces_tried", assembly.tried.iter().map(tried).collect::<Value>())
        .data("seed", request.seed)
}

/// The figures of growth on a shaken table.
#[rustfmt::skip]
fn growing(assembly: &Assembly, growing: &Growing) -> Entries {
    let built = &assembly.built;
    let Shaken { shaking, gse, gmc, docking_cost, volume } = growing.shaken;
    Entries::default()
        .fact("kt_J", "kT", shaking.kt)
        .fact("coverage", "covered", shaking.coverage).share().noted("of the table")
        .fact("Gse", "Gse", gse).viewed(kt(gse)).noted("weakest bond of strength 1")
        .fact("Gmc", "Gmc", gmc).viewed(kt(gmc)).noted("docking cost, per kind of tile")
        .data("bond_volume_m2_rad", volume)
        .data("docking_cost_kT", docking_cost)
        .fact("tau_effective", "Gmc / Gse", gmc / gse).noted("grows if below tau")
        .data("window_kt_J", built.window(&growing.shaken))
        .data("errors_at_standstill", built.errors_at_standstill(&growing.shaken))
        .and(grown_with_errors(&growing.growth))
        .data("proposed_kt_J", growing.proposal().map(|it| it.0))
        .data("verdict", verdict(growing.verdict(built)))
        .table(growths(growing))
}

/// The verdict, for programs.
fn verdict(verdict: GrowthVerdict) -> &'static str {
    match verdict {
        GrowthVerdict::Stuck => "nothing attaches to the seed",
        GrowthVerdict::FewerSuffice => "fewer bonds than tau hold, growths right",
        GrowthVerdict::TooHard => "nothing holds",
        GrowthVerdict::MoreHold => "more bonds hold",
        GrowthVerdict::FewerHold => "fewer bonds than tau hold",
        GrowthVerdict::MismatchHolds => "a mismatch holds",
        GrowthVerdict::TauHolds | GrowthVerdict::OneHolds => "right",
        GrowthVerdict::ErrorsStay => "errors stay",
        GrowthVerdict::Slow => "too slow",
    }
}

/// Growth from a seed at one kT, with errors.
#[rustfmt::skip]
pub(crate) fn grown_with_errors(growth: &Kinetic) -> Entries {
    Entries::default()
        .fact("errors_a_tile", "errors per tile", growth.errors_a_tile)
            .digits(2).noted("as grown, wrong tiles that stay")
        .fact("grown_right", "grown correctly", json!([growth.right, growth.runs]))
            .viewed(format!("{} of {}", growth.right, growth.runs)).in_view()
}

/// Simulated growth at each kT, with errors.
#[rustfmt::skip]
fn growths(growing: &Growing) -> Table {
    let asked = [(growing.shaken.shaking.kt, growing.growth)];
    let mut all: Vec<(f64, Kinetic)> = asked.into_iter().chain(growing.others.iter().copied()).collect();
    all.order_by(|a, b| a.0.total_cmp(&b.0));
    rows(all)
        .column("kT_J", "kT", "effective energy of shaking", |it| it.0).digits(3)
        .column("runs", "growths", "simulated tile by tile", |it| it.1.runs)
        .column("right", "right", "growths with every tile in its place", |it| it.1.right)
        .column("wrong", "wrong", "growths in which wrong tiles remain", |it| it.1.wrong)
        .column("errors_a_tile", "errors per tile", "wrong tiles that remain", |it| it.1.errors_a_tile).digits(2)
        .column("waits", "docking times", "mean time to completion; in one docking time a tile of each kind arrives at \
            every place", |it| it.1.waits).digits(2)
        .table("growths")
        .titled("Growth over kT", "")
        .listing(2 * LISTED)
}

fn kt(energy: f64) -> String {
    match energy {
        ..1e4 => format!("{energy:.3} kT"),
        _ => format!("{} kT", plain(energy, 3)),
    }
}

fn tried(choice: &Choice) -> Value {
    let classes = choice.classes.iter().map(|class| {
        json!({
            "magnets": class.magnets,
            "needed": class.needed,
            "found": class.found,
            "at_most": (class.upper < usize::MAX).then_some(class.upper),
        })
    });
    json!({
        "places": choice.places,
        "gap": choice.gap,
        "verdict": match choice.verdict {
            WordsVerdict::Found => "found",
            WordsVerdict::Refuted => "proved impossible",
            WordsVerdict::Open => "open",
        },
        "words": choice.words.len(),
        "classes": classes.collect::<Value>(),
    })
}

// One line a column.
#[rustfmt::skip]
fn tiles(assembly: &Assembly) -> Table {
    type Row<'a> = (usize, &'a TileType);
    let built = &assembly.built;
    let counts = assembly.counts();
    let count = match assembly.growing {
        Some(_) => ["grown", "copies in the error-free growth"],
        None => ["how many", "copies to be laid"],
    };
    let faces = |it: &Row| -> Value {
        let face = |side: usize| built.face(it.0, side).map(|face| assembly.face(face));
        (0..4).map(|side| (SIDES[side].to_owned(), json!(face(side)))).collect::<Map<_, _>>().into()
    };
    let face = |side: usize| move |it: &Row| {
        let face = built.face(it.0, side)?;
        Some(format!("{} {}", assembly.face(face), built.matrix.code(face)))
    };
    rows(built.set.tiles.iter().enumerate())
        .column("name", "tile", "", |it: &Row| it.1.name.clone())
        .data("faces", faces)
        .column("grown", count[0], count[1], move |it| counts[it.0]).in_view()
        .column("north", "north", "the word of the face, read counter-clockwise", face(0)).in_view()
        .column("east", "east", "the word of the face, read counter-clockwise", face(1)).in_view()
        .column("south", "south", "the word of the face, read counter-clockwise", face(2)).in_view()
        .column("west", "west", "the word of the face, read counter-clockwise", face(3)).in_view()
        .table("tiles")
        .titled("Tiles", "")
        .listing(LISTED)
}

#[rustfmt::skip]
fn bonds(assembly: &Assembly) -> Table {
    type Row<'a> = (usize, &'a Bond);
    let built = &assembly.built;
    let glues = |it: &Row| json!(it.1.glues.each_ref().map(|glues| {
        glues.iter().map(|glue| &built.set.glues[*glue].name).collect::<Vec<_>>()
    }));
    let kt = assembly.growing.as_ref().map(|it| it.shaken.shaking.kt);
    let axis = |it: &Row| match it.1.axis {
        MeetingAxis::Horizontal => "west-east",
        MeetingAxis::Vertical => "south-north",
    };
    rows(built.wiring.bonds.iter().enumerate())
        .column("word", "word", "on east or north faces; its mate is on west or south ones", |it: &Row| assembly.face(it.0))
        .column("code", "code", "read counter-clockwise", |it| built.matrix.words[it.0].to_string()).in_view()
        .column("axis", "axis", "on which the tiles meet", axis)
        .column("strength", "strength", "of the glue", |it| it.1.strength)
        .column("energy_J", "bond", "flush and aligned, as used by the engines", |it| -built.matrix.bond(it.0)).digits(4)
        .column("depth_kT", "depth", "of the bond, in kT", move |it| kt.map(|kt| built.matrix.bond(it.0) / kt))
        .data("glues", glues)
        .table("bonds")
        .titled("Bonds", "")
        .listing(LISTED)
}

/// The deepest slid contacts of faces.
#[rustfmt::skip]
fn slid<'a>(assembly: &'a Assembly, all: Vec<&'a Slid>) -> Table {
    let pitch = assembly.words.stage.pitch.unwrap_or_default();
    let slide = |it: &Slid| it.deepest.map_or(0, |it| it.0);
    let shaken = assembly.growing.as_ref().map(|it| it.shaken);
    let depth = move |it: &Slid| Some(it.energy() / shaken?.shaking.kt);
    let view = move |it: &Slid| depth(it).map_or("-".to_owned(), |depth| format!("{:.1} kT", -depth));
    let holds = move |it: &Slid| Some(-depth(it)? > shaken?.gmc);
    rows(all)
        .column("first", "first", "a face", |it| assembly.face(it.faces[0]))
        .column("second", "second", "the face that it meets", |it| assembly.face(it.faces[1]))
        .column("slide", "slid by", "places", move |it| slide(it))
        .data("slide_m", move |it| positive_zero(f64::from(slide(it)) * pitch))
        .column("energy_J", "energy", "of the deepest slid contact that holds", |it| it.energy()).digits(4)
        .column("energy_kT", "depth", "in kT", move |it| depth(it)).viewed(move |it| view(it))
        .column("holds_alone", "holds alone", "whether it holds a tile alone: depth above Gmc", move |it| holds(it))
        .data("slides_to_aligned", |it| it.captured[0])
        .data("slides_to_slid", |it| it.captured[1])
        .table("slid")
}

/// One row per pair of tiles that meet: its design, the word of its bond, the energy of the two
/// faces in contact (from the matrix), of all other faces, and of the whole tiles, as `tilebind
/// energy` computes it for the design.
#[rustfmt::skip]
fn pairs(assembly: &Assembly) -> Table {
    let built = &assembly.built;
    let kt = assembly.growing.as_ref().map(|it| it.shaken.shaking.kt);
    let met = designs::named(assembly).into_iter().filter_map(|(name, met)| {
        let (bond, rest) = built.whole(&met)?;
        Some((name, bond, -built.matrix.bond(bond), rest))
    });
    rows(met)
        .data("design", |it| format!("designs/{}.toml", it.0))
        .data("word", |it| assembly.face(it.1))
        .data("faces_J", |it| it.2)
        .data("other_faces_J", |it| it.3)
        .data("tiles_J", |it| it.2 + it.3)
        .data("tiles_kT", move |it| kt.map(|kt| (it.2 + it.3) / kt))
        .table("pairs")
}

/// Files for engines and other commands.
fn beside(assembly: &Assembly) -> Files {
    let engines = assembly.growing.as_ref().map(|growing| {
        let engine = assembly.built.engine(&growing.shaken);
        let remarks = text::for_engines(assembly, &growing.shaken);
        [
            ("assembly.yaml", rgrow::write(&engine, &remarks)),
            (
                "assembly.tiles",
                xgrow::write(&engine.without_repulsion(), &remarks),
            ),
        ]
    });
    let files = [
        ("tileset.yaml", rgrow::write(&assembly.built.set, &[])),
        ("words.toml", assembly.words_toml.clone()),
        ("sheet.md", sheet::sheet(assembly)),
    ];
    let files = engines.into_iter().flatten().chain(files);
    let files = files.map(|(name, text)| (name.to_owned(), text));
    let designs = designs::all(assembly);
    let designs = designs.map(|(name, text)| (format!("designs/{name}.toml"), text));
    let all = files.chain(designs);
    all.map(|(name, text)| (name, text.into_bytes())).collect()
}

/// The energies of all pairs of faces.
fn energies(assembly: &Assembly) -> Table {
    let matrix = &assembly.built.matrix;
    let faces = 0..matrix.energies.len();
    let head = rows(faces.clone())
        .data("face", |i| assembly.face(*i))
        .data("code", |i| matrix.code(*i).to_string());
    let table = faces.fold(head, |table, j| {
        let key = assembly.face(j) + "_J";
        table.data(key, move |i| matrix.energies[*i][j])
    });
    table.table("matrix").in_csv("matrix")
}
