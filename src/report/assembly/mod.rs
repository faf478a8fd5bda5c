//! Tile sets whose glues are words: what engines read, designs of all pairs that meet, the sheet for
//! the workshop, and what is known of them in words.

mod designs;
mod pairs;
mod picture;
mod text;

use serde_json::{Value, json};

pub(crate) use pairs::deeper;
pub use text::{headline, summary};

use super::csv::table;
use super::files::{Files, PICTURES, with_report};
use super::json as layout;
use super::page::Page;
use super::values::positive_zero;
use jobs::assembly::built::face_name;
use jobs::assembly::choice::{Choice, Verdict};
use jobs::assembly::slides::Slid;
use jobs::assembly::{Axis, Built, SIDES, rgrow, xgrow};
use jobs::design::{Design, WordSet};
use physics::tile::Magnet;
use physics::words::{Rules, Word};

/// What is written, for the terminal.
pub const FILES: &str = "report.html to look at; assembly.yaml (rgrow), assembly.tiles (xgrow), \
                         designs/, sheet.md, matrix.csv, pairs.csv, slides.csv, words.toml, \
                         report.json";

/// A tile set that was built, and all that reproduces it.
pub struct Assembly<'a> {
    /// It.
    pub built: &'a Built,
    /// Where its words come from.
    pub words: &'a WordSet,
    /// The text of `words.toml`.
    pub words_toml: String,
    /// The design of which thickness, mass and table are taken, if one was given.
    pub design: Option<&'a Design>,
    /// What was tried to find words; empty where they were given.
    pub tried: Vec<Choice>,
    /// Rows and columns, if it is a lattice.
    pub lattice: Option<[usize; 2]>,
    /// Which meetings are wrong.
    pub rules: Rules,
    /// Tiles along a block's edge.
    pub proofread: usize,
    /// Of all random numbers.
    pub seed: u64,
}

impl Assembly<'_> {
    pub(super) fn face(&self, face: usize) -> String {
        face_name(face, self.built.matrix.words.len())
    }

    /// Where a word's magnets lie along the face (m), and their poles.
    pub(super) fn magnets(&self, word: Word) -> Vec<(f64, char)> {
        let pitch = self.words.stage.pitch.unwrap_or_default();
        let middle = (word.places() as f64 - 1.0) / 2.0;
        let at = |k: usize| match &self.words.places {
            Some(places) => places[k],
            None => (k as f64 - middle) * pitch,
        };
        let pole = |k: usize| match word.at(k) {
            1 => Some('N'),
            -1 => Some('S'),
            _ => None,
        };
        (0..word.places())
            .filter_map(|k| Some((at(k), pole(k)?)))
            .collect()
    }

    /// From the face to the magnets' outer pole faces (m).
    pub(super) fn inset(&self) -> f64 {
        let (tile, magnet) = (&self.words.stage.pair.fixed, self.magnet());
        let face = &tile.faces[magnet.face];
        let depth = -(magnet.position - face.middle()).dot(&face.normal());
        let inset = depth - magnet.size[0] / 2.0;
        // What rounding leaves.
        if inset.abs() < 1e-9 {
            0.0
        } else {
            (inset * 1e12).round() / 1e12
        }
    }

    /// A magnet like all of them.
    pub(super) fn magnet(&self) -> &Magnet {
        &self.words.stage.pair.fixed.magnets[0]
    }

    /// Of every two faces what holds them slid, where words have a pitch.
    pub(super) fn slides(&self) -> Vec<(usize, usize, Slid)> {
        let lags = Built::lags(self.words).filter(|_| self.rules.slides());
        let Some(lags) = lags else {
            return Vec::new();
        };
        let matrix = &self.built.matrix;
        let faces = matrix.energies.len();
        let pairs = (0..faces).flat_map(|i| (i..faces).map(move |j| (i, j)));
        let of = |(i, j)| {
            let slid = Slid::of(&lags, &self.rules, matrix.code(i), matrix.code(j));
            (i, j, slid)
        };
        pairs.map(of).collect()
    }
}

/// All files, made by `command`.
pub fn files(assembly: &Assembly, command: &str) -> Files {
    let mut files = Files::new();
    let mut add = |name: &str, text: String| {
        files.insert(name.to_owned(), text.into_bytes());
    };
    let engine = assembly.built.engine();
    let remarks = text::remarks(assembly);
    add("assembly.yaml", rgrow::write(&engine, &remarks));
    add(
        "assembly.tiles",
        xgrow::write(&engine.without_repulsion(), &remarks),
    );
    add("tileset.yaml", rgrow::write(&assembly.built.set, &[]));
    add("matrix.csv", matrix_csv(assembly));
    add("pairs.csv", pairs::csv(assembly));
    let slides = assembly.slides();
    add("slides.csv", slides_csv(assembly, &slides));
    add("words.toml", assembly.words_toml.clone());
    add("sheet.md", designs::sheet(assembly));
    for (name, text) in designs::all(assembly) {
        add(&format!("designs/{name}.toml"), text);
    }
    let svg = picture::grown(assembly);
    add(&format!("{PICTURES}/grown.svg"), svg.clone());
    let page = Page::of_assembly(assembly, &slides, svg);
    with_report(files, Some(page), &value(assembly, &slides), command)
}

/// `report.json`, and what `--json` prints.
pub fn json(assembly: &Assembly) -> String {
    layout::text(&value(assembly, &assembly.slides()))
}

fn matrix_csv(assembly: &Assembly) -> String {
    let matrix = &assembly.built.matrix;
    let faces = matrix.energies.len();
    let header = ["face".to_owned(), "code".to_owned()];
    let header = header
        .into_iter()
        .chain((0..faces).map(|face| assembly.face(face) + "_J"));
    let rows = (0..faces).map(|i| {
        let energies = matrix.energies[i]
            .iter()
            .map(|energy| positive_zero(*energy).to_string());
        [assembly.face(i), matrix.code(i).to_string()]
            .into_iter()
            .chain(energies)
            .collect::<Vec<_>>()
    });
    table(header.collect::<Vec<_>>(), rows)
}

fn slides_csv(assembly: &Assembly, slides: &[(usize, usize, Slid)]) -> String {
    let built = assembly.built;
    let pitch = assembly.words.stage.pitch.unwrap_or_default();
    let rows = slides.iter().filter_map(|(i, j, slid)| {
        let (slide, energy) = slid.deepest?;
        Some(vec![
            assembly.face(*i),
            assembly.face(*j),
            slide.to_string(),
            positive_zero(f64::from(slide) * pitch).to_string(),
            energy.to_string(),
            (energy / built.shaking.kt).to_string(),
            (-energy / built.shaking.kt > built.gmc).to_string(),
            slid.captured[0].to_string(),
            slid.captured[1].to_string(),
        ])
    });
    let header = [
        "first",
        "second",
        "slide",
        "slide_m",
        "energy_J",
        "energy_kT",
        "holds_alone",
        "slides_to_aligned",
        "slides_to_slid",
    ];
    table(header.map(str::to_owned), rows)
}

fn value(assembly: &Assembly, slides: &[(usize, usize, Slid)]) -> Value {
    let built = assembly.built;
    let (set, matrix) = (&built.set, &built.matrix);
    let codes = |faces: std::ops::Range<usize>| -> Vec<String> {
        faces.map(|face| matrix.code(face).to_string()).collect()
    };
    let n = matrix.words.len();
    let mismatch = matrix.strongest_wrong().map(|(i, j, energy)| {
        json!({"first": assembly.face(i), "second": assembly.face(j), "energy_J": energy})
    });
    let window = text::window(built);
    json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "tile_set": {
            "name": set.name,
            "tiles": set.tiles.len(),
            "glues": set.glues.len(),
            "words_needed": built.wiring.bonds.len(),
            "tau": set.tau(),
            "proofread": assembly.proofread,
            "lattice": assembly.lattice,
        },
        "kt_J": built.shaking.kt,
        "coverage": built.shaking.coverage,
        "Gse": built.gse(),
        "Gmc": built.gmc,
        "bond_J": built.unit,
        "bond_volume_m2_rad": built.volume,
        "docking_cost_kT": built.docking_cost,
        "tau_effective": built.gmc / built.gse(),
        "window_kt_J": window,
        "errors_at_standstill": built.errors_at_standstill(),
        "words": codes(0..n),
        "mates": codes(n..2 * n),
        "bonds": built.wiring.bonds.iter().enumerate().map(|(word, bond)| json!({
            "word": assembly.face(word),
            "axis": axis(bond.axis),
            "strength": bond.strength,
            "energy_J": -matrix.bond(word),
            "glues": bond.glues.each_ref().map(|glues| glues.iter().map(|glue| &set.glues[*glue].name).collect::<Vec<_>>()),
        })).collect::<Value>(),
        "matrix_J": matrix.energies.iter()
            .map(|row| row.iter().map(|energy| positive_zero(*energy)).collect::<Value>())
            .collect::<Value>(),
        "strongest_mismatch": mismatch,
        "deeper_in_whole_tiles": deeper(assembly),
        "slides": text::slid(assembly, slides).map(|slid| json!({
            "deepest_J": slid.deepest,
            "pairs_that_hold_alone": slid.holding,
            "pairs": slid.pairs,
            "bonds_slid_share": slid.share,
        })),
        "grown": {
            "tiles": built.grown.tiles.len(),
            "complete": built.grown.complete,
            "choices": built.grown.choices,
            "of_each": set.tiles.iter().zip(built.grown.counts(set.tiles.len()))
                .map(|(tile, count)| json!([tile.name, count])).collect::<Value>(),
        },
        "tiles": set.tiles.iter().enumerate().map(|(number, tile)| {
            let face = |side: usize| built.face(number, side).map(|face| assembly.face(face));
            let faces = (0..4).map(|side| (SIDES[side].to_owned(), json!(face(side))));
            json!({"name": tile.name, "faces": faces.collect::<serde_json::Map<_, _>>()})
        }).collect::<Value>(),
        "faces_tried": assembly.tried.iter().map(|it| json!({
            "places": it.places,
            "gap": it.gap,
            "verdict": verdict(it.verdict),
            "words": it.words.len(),
            "classes": it.classes.iter().map(|class| json!({
                "magnets": class.magnets,
                "needed": class.needed,
                "found": class.found,
                "at_most": (class.upper < usize::MAX).then_some(class.upper),
            })).collect::<Value>(),
        })).collect::<Value>(),
        "seed": assembly.seed,
    })
}

fn axis(axis: Axis) -> &'static str {
    match axis {
        Axis::Horizontal => "west-east",
        Axis::Vertical => "south-north",
    }
}

pub(super) fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Found => "found",
        Verdict::Refuted => "proved impossible",
        Verdict::Open => "open",
    }
}
