//! The page of an assembly.

use serde_json::{Value, json};

use super::{Column, Fact, Illustration, Page, Table};
use crate::assembly::{Assembly, headline};
use jobs::assembly::slides::Slid;
use physics::order::Order;
use physics::units::si;

/// Rows of a table at most.
const MOST_ROWS: usize = 500;

impl Page {
    /// The page of an assembly, with what slid faces hold and a picture of what grows.
    pub fn of_assembly(
        assembly: &Assembly,
        slides: &[(usize, usize, Slid)],
        grown: String,
    ) -> Self {
        let built = assembly.built;
        let fact = |name: &str, value: String, note: &str| Fact {
            name: name.to_owned(),
            value,
            note: note.to_owned(),
        };
        let wrong = built.matrix.strongest_wrong().map_or(0.0, |it| it.2);
        let facts = vec![
            fact("tiles", built.set.tiles.len().to_string(), ""),
            fact(
                "words",
                built.wiring.bonds.len().to_string(),
                "one a glue and axis",
            ),
            fact(
                "Gse",
                format!("{:.3} kT", built.gse()),
                "weakest bond of strength 1",
            ),
            fact(
                "Gmc",
                format!("{:.3} kT", built.gmc),
                "cost of docking, of a kind of tile",
            ),
            fact(
                "Gmc / Gse",
                format!("{:.3}", built.gmc / built.gse()),
                "below tau it grows",
            ),
            fact("strongest mismatch", si(wrong, "J", 4), "aligned"),
            fact(
                "bonds in whole tiles",
                crate::assembly::deeper(assembly).map_or(String::new(), |range| {
                    let [least, most] = range.map(|share| 100.0 * share);
                    format!("{least:+.1} to {most:+.1} %")
                }),
                "deeper than of two faces",
            ),
            fact(
                "errors a tile",
                format!("{:.1e}", built.errors_at_standstill()),
                "just above standstill",
            ),
        ];
        Self {
            subtitle: headline(assembly),
            facts,
            pictures: vec![Illustration {
                is_titled: false,
                title: "What grows without errors".to_owned(),
                svg: grown,
            }],
            tables: vec![tiles(assembly), bonds(assembly), slid(assembly, slides)],
            origin: format!(
                "tilebind {}, seed {}",
                env!("CARGO_PKG_VERSION"),
                assembly.seed
            ),
            ..Self::titled(format!("Assembly {}", built.set.name))
        }
    }
}

fn table(
    title: &str,
    note: &str,
    columns: &[(&str, &'static str)],
    rows: Vec<Vec<Value>>,
) -> Table {
    Table {
        title: title.to_owned(),
        note: note.to_owned(),
        columns: columns
            .iter()
            .map(|(name, unit)| Column::new(name, unit))
            .collect(),
        rows,
        states: Vec::new(),
        paths: Vec::new(),
    }
}

fn tiles(assembly: &Assembly) -> Table {
    let built = assembly.built;
    let counts = built.grown.counts(built.set.tiles.len());
    let face = |tile: usize, side: usize| match built.face(tile, side) {
        Some(face) => json!(format!(
            "{} {}",
            assembly.face(face),
            built.matrix.code(face)
        )),
        None => Value::Null,
    };
    let row = |(number, tile): (usize, &jobs::assembly::TileType)| {
        let head = [json!(tile.name), json!(counts[number])];
        head.into_iter()
            .chain((0..4).map(|side| face(number, side)))
            .collect()
    };
    let rows = built
        .set
        .tiles
        .iter()
        .enumerate()
        .take(MOST_ROWS)
        .map(row)
        .collect();
    let columns = [
        ("tile", ""),
        ("grown", ""),
        ("north", ""),
        ("east", ""),
        ("south", ""),
        ("west", ""),
    ];
    table(
        "Tiles",
        "words of their faces, read counter-clockwise",
        &columns,
        rows,
    )
}

fn bonds(assembly: &Assembly) -> Table {
    let built = assembly.built;
    let row = |(word, bond): (usize, &jobs::assembly::wiring::Bond)| {
        let energy = -built.matrix.bond(word);
        vec![
            json!(assembly.face(word)),
            json!(built.matrix.words[word].to_string()),
            json!(bond.strength),
            json!(energy),
            json!(super::rounded(-energy / built.shaking.kt, 4)),
        ]
    };
    let rows = built
        .wiring
        .bonds
        .iter()
        .enumerate()
        .take(MOST_ROWS)
        .map(row)
        .collect();
    let columns = [
        ("word", ""),
        ("code", ""),
        ("strength", ""),
        ("bond", "J"),
        ("in kT", ""),
    ];
    table(
        "Bonds",
        "flush and aligned, as the engines have them",
        &columns,
        rows,
    )
}

fn slid(assembly: &Assembly, slides: &[(usize, usize, Slid)]) -> Table {
    let kt = assembly.built.shaking.kt;
    let mut found: Vec<_> = slides
        .iter()
        .filter_map(|it| Some((it, it.2.deepest?)))
        .collect();
    found.order_by(|a, b| a.1.1.total_cmp(&b.1.1));
    let row = |((i, j, _), (slide, energy)): &(&(usize, usize, Slid), (i32, f64))| {
        vec![
            json!(assembly.face(*i)),
            json!(assembly.face(*j)),
            json!(slide),
            json!(energy),
            json!(super::rounded(-energy / kt, 4)),
        ]
    };
    let rows = found.iter().take(40).map(row).collect();
    let columns = [
        ("first", ""),
        ("second", ""),
        ("slid by places", ""),
        ("energy", "J"),
        ("in kT", ""),
    ];
    let note =
        "the 40 deepest; the engines do not know them: what exceeds Gmc holds a tile by itself";
    table("Slid traps", note, &columns, rows)
}
