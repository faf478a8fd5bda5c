//! DXF files that programs open at true size.
//!
//! Release 2000 (AC1015) in ASCII: the oldest with `$INSUNITS`, which states the unit of the
//! drawing, and one that all DXF readers understand. Besides lines it requires tables, blocks for
//! model and paper, a dictionary of objects, and a handle and an owner for everything.

use std::fmt::Write;

use jobs::workshop::{Corner, extent};
use nalgebra::Vector2;

/// A layer: its name, and its colour by AutoCAD's index.
pub(super) type Layer = (&'static str, u8);

/// A drawing in mm.
pub(super) struct Dxf {
    entities: Pairs,
    layers: Vec<Layer>,
    low: [f64; 2],
    high: [f64; 2],
}

/// Handles of the objects of every file (hexadecimal); drawn objects continue from [`FIRST`].
const MODEL: u32 = 0x20;
const PAPER: u32 = 0x21;
const FIRST: u32 = 0x100;

/// Codes and their values, line by line.
struct Pairs {
    text: String,
    handle: u32,
}

impl Pairs {
    fn new(handle: u32) -> Self {
        Self {
            text: String::new(),
            handle,
        }
    }

    fn push(&mut self, code: u32, value: &str) {
        let _ = writeln!(self.text, "{code:>3}\n{value}");
    }

    fn all(&mut self, pairs: &[(u32, &str)]) {
        for (code, value) in pairs {
            self.push(*code, value);
        }
    }

    fn numbers(&mut self, pairs: &[(u32, f64)]) {
        for (code, value) in pairs {
            self.push(*code, &number(*value));
        }
    }

    /// The beginning of an entry: its kind, its handle and its owner's handle.
    fn entry(&mut self, kind: &str, owner: u32, classes: &[&str]) -> u32 {
        let handle = self.handle;
        self.handle += 1;
        self.with_handle(kind, handle, owner, classes);
        handle
    }

    fn with_handle(&mut self, kind: &str, handle: u32, owner: u32, classes: &[&str]) {
        self.push(0, kind);
        // Dimension styles have their handle under another code.
        self.push(
            if kind == "DIMSTYLE" { 105 } else { 5 },
            &format!("{handle:X}"),
        );
        self.push(330, &format!("{owner:X}"));
        for class in classes {
            self.push(100, class);
        }
    }

    fn table(&mut self, name: &str, entries: usize) -> u32 {
        self.push(0, "TABLE");
        self.push(2, name);
        let handle = self.handle;
        self.handle += 1;
        self.push(5, &format!("{handle:X}"));
        self.all(&[
            (330, "0"),
            (100, "AcDbSymbolTable"),
            (70, &entries.to_string()),
        ]);
        handle
    }

    fn record(&mut self, kind: &str, table: u32, class: &str, name: &str) {
        self.entry(kind, table, &["AcDbSymbolTableRecord", class]);
        self.all(&[(2, name), (70, "0")]);
    }
}

/// A number of mm: to a nanometre, with a point.
fn number(value: f64) -> String {
    let text = format!("{:.6}", value + 0.0);
    let text = text.trim_end_matches('0');
    let text = if text.ends_with('.') {
        format!("{text}0")
    } else {
        text.to_owned()
    };
    if text == "-0.0" {
        "0.0".to_owned()
    } else {
        text
    }
}

impl Dxf {
    pub fn new(layers: &[Layer]) -> Self {
        Self {
            entities: Pairs::new(FIRST),
            layers: layers.to_vec(),
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        }
    }

    /// A closed line of lines and arcs, its corners in m.
    pub fn closed_line(&mut self, layer: &str, corners: &[Corner]) {
        let pairs = &mut self.entities;
        pairs.entry("LWPOLYLINE", MODEL, &["AcDbEntity"]);
        pairs.all(&[
            (8, layer),
            (100, "AcDbPolyline"),
            (90, &corners.len().to_string()),
            (70, "1"),
        ]);
        for corner in corners {
            let at = [0, 1].map(|k| 1e3 * corner.point[k]);
            pairs.numbers(&[(10, at[0]), (20, at[1])]);
            if corner.bulge != 0.0 {
                pairs.push(42, &format!("{:.12}", corner.bulge));
            }
        }
        let [low, high] = extent(corners);
        self.reach(low, high);
    }

    /// A circle, lengths in m.
    pub fn circle(&mut self, layer: &str, middle: Vector2<f64>, radius: f64) {
        let pairs = &mut self.entities;
        pairs.entry("CIRCLE", MODEL, &["AcDbEntity"]);
        pairs.all(&[(8, layer), (100, "AcDbCircle")]);
        pairs.numbers(&[(10, 1e3 * middle.x), (20, 1e3 * middle.y), (30, 0.0)]);
        pairs.numbers(&[(40, 1e3 * radius)]);
        let at = |side: f64| [middle.x + side * radius, middle.y + side * radius];
        self.reach(at(-1.0), at(1.0));
    }

    /// A straight line, its ends in m.
    pub fn line(&mut self, layer: &str, ends: [Vector2<f64>; 2]) {
        let pairs = &mut self.entities;
        pairs.entry("LINE", MODEL, &["AcDbEntity"]);
        pairs.all(&[(8, layer), (100, "AcDbLine")]);
        for (k, end) in (0..).zip(&ends) {
            pairs.numbers(&[(10 + k, 1e3 * end.x), (20 + k, 1e3 * end.y), (30 + k, 0.0)]);
        }
        for end in ends {
            self.reach(end.into(), end.into());
        }
    }

    /// Extends the drawing's limits to a rectangle (m).
    fn reach(&mut self, low: [f64; 2], high: [f64; 2]) {
        for k in 0..2 {
            self.low[k] = self.low[k].min(1e3 * low[k]);
            self.high[k] = self.high[k].max(1e3 * high[k]);
        }
    }

    /// A text centred at a position; position and height in m, the direction in rad.
    pub fn text(
        &mut self,
        layer: &str,
        middle: Vector2<f64>,
        (height, turn): (f64, f64),
        text: &str,
    ) {
        let [x, y, height] = [middle.x, middle.y, height].map(|length| 1e3 * length);
        let pairs = &mut self.entities;
        pairs.entry("TEXT", MODEL, &["AcDbEntity"]);
        pairs.all(&[(8, layer), (100, "AcDbText")]);
        pairs.numbers(&[(10, x), (20, y), (30, 0.0), (40, height)]);
        // Aligned by its centre, horizontally and vertically.
        pairs.push(1, text);
        if turn != 0.0 {
            pairs.numbers(&[(50, turn.to_degrees())]);
        }
        pairs.push(72, "1");
        pairs.numbers(&[(11, x), (21, y), (31, 0.0)]);
        pairs.all(&[(100, "AcDbText"), (73, "2")]);
    }

    /// The file.
    pub fn finish(self) -> String {
        let next = self.entities.handle;
        let mut rest = Pairs::new(0x30);
        self.tables(&mut rest);
        blocks(&mut rest);
        rest.all(&[(0, "SECTION"), (2, "ENTITIES")]);
        let mut objects = Pairs::new(0x10);
        objects.all(&[(0, "ENDSEC"), (0, "SECTION"), (2, "OBJECTS")]);
        objects.with_handle("DICTIONARY", 0xC, 0, &["AcDbDictionary"]);
        objects.all(&[(281, "1"), (3, "ACAD_GROUP"), (350, "D")]);
        objects.with_handle("DICTIONARY", 0xD, 0xC, &["AcDbDictionary"]);
        objects.all(&[(281, "1"), (0, "ENDSEC"), (0, "EOF")]);
        let head = self.header(next);
        head + &rest.text + &self.entities.text + &objects.text
    }

    fn header(&self, next: u32) -> String {
        let mut pairs = Pairs::new(0);
        pairs.all(&[
            (999, "tilebind, lengths in mm"),
            (0, "SECTION"),
            (2, "HEADER"),
            (9, "$ACADVER"),
            (1, "AC1015"),
            (9, "$DWGCODEPAGE"),
            (3, "ANSI_1252"),
            (9, "$HANDSEED"),
            (5, &format!("{next:X}")),
            // Millimetres, metric.
            (9, "$INSUNITS"),
            (70, "4"),
            (9, "$MEASUREMENT"),
            (70, "1"),
            (9, "$LUNITS"),
            (70, "2"),
        ]);
        for (name, corner) in [("$EXTMIN", self.low), ("$EXTMAX", self.high)] {
            pairs.push(9, name);
            pairs.numbers(&[(10, corner[0]), (20, corner[1]), (30, 0.0)]);
        }
        pairs.push(0, "ENDSEC");
        pairs.text
    }

    fn tables(&self, pairs: &mut Pairs) {
        pairs.all(&[(0, "SECTION"), (2, "TABLES")]);
        let table = pairs.table("VPORT", 1);
        pairs.record("VPORT", table, "AcDbViewportTableRecord", "*Active");
        let middle = [0, 1].map(|k| (self.low[k] + self.high[k]) / 2.0);
        let size = [0, 1].map(|k| self.high[k] - self.low[k]);
        pairs.numbers(&[(10, 0.0), (20, 0.0), (11, 1.0), (21, 1.0)]);
        pairs.numbers(&[(12, middle[0]), (22, middle[1])]);
        pairs.numbers(&[
            (13, 0.0),
            (23, 0.0),
            (14, 10.0),
            (24, 10.0),
            (15, 10.0),
            (25, 10.0),
        ]);
        pairs.numbers(&[
            (16, 0.0),
            (26, 0.0),
            (36, 1.0),
            (17, 0.0),
            (27, 0.0),
            (37, 0.0),
        ]);
        // The view's height and aspect ratio: the whole drawing with a margin.
        pairs.numbers(&[
            (40, 1.2 * size[1].max(size[0] / 1.5)),
            (41, 1.5),
            (42, 50.0),
        ]);
        pairs.all(&[(0, "ENDTAB")]);
        let table = pairs.table("LTYPE", 3);
        for name in ["ByBlock", "ByLayer", "Continuous"] {
            pairs.record("LTYPE", table, "AcDbLinetypeTableRecord", name);
            pairs.all(&[(3, ""), (72, "65"), (73, "0"), (40, "0.0")]);
        }
        pairs.all(&[(0, "ENDTAB")]);
        let table = pairs.table("LAYER", self.layers.len() + 1);
        for (name, colour) in std::iter::once(("0", 7)).chain(self.layers.iter().copied()) {
            pairs.record("LAYER", table, "AcDbLayerTableRecord", name);
            pairs.all(&[(62, &colour.to_string()), (6, "Continuous")]);
        }
        pairs.all(&[(0, "ENDTAB")]);
        let table = pairs.table("STYLE", 1);
        pairs.record("STYLE", table, "AcDbTextStyleTableRecord", "Standard");
        pairs.numbers(&[(40, 0.0), (41, 1.0), (50, 0.0)]);
        pairs.all(&[(71, "0"), (42, "2.5"), (3, "txt"), (4, ""), (0, "ENDTAB")]);
        for name in ["VIEW", "UCS"] {
            pairs.table(name, 0);
            pairs.push(0, "ENDTAB");
        }
        let table = pairs.table("APPID", 1);
        pairs.record("APPID", table, "AcDbRegAppTableRecord", "ACAD");
        pairs.push(0, "ENDTAB");
        let table = pairs.table("DIMSTYLE", 1);
        pairs.push(100, "AcDbDimStyleTable");
        pairs.record("DIMSTYLE", table, "AcDbDimStyleTableRecord", "Standard");
        pairs.push(0, "ENDTAB");
        let table = pairs.table("BLOCK_RECORD", 2);
        for (name, handle) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
            let classes = ["AcDbSymbolTableRecord", "AcDbBlockTableRecord"];
            pairs.with_handle("BLOCK_RECORD", handle, table, &classes);
            pairs.push(2, name);
        }
        pairs.all(&[(0, "ENDTAB"), (0, "ENDSEC")]);
    }
}

fn blocks(pairs: &mut Pairs) {
    pairs.all(&[(0, "SECTION"), (2, "BLOCKS")]);
    for (name, record) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
        pairs.entry("BLOCK", record, &["AcDbEntity"]);
        pairs.all(&[(8, "0"), (100, "AcDbBlockBegin"), (2, name), (70, "0")]);
        pairs.numbers(&[(10, 0.0), (20, 0.0), (30, 0.0)]);
        pairs.all(&[(3, name), (1, "")]);
        pairs.entry("ENDBLK", record, &["AcDbEntity"]);
        pairs.all(&[(8, "0"), (100, "AcDbBlockEnd")]);
    }
    pairs.push(0, "ENDSEC");
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_handle_is_its_own_and_every_owner_is_there() {
        let mut dxf = Dxf::new(&[("A", 1), ("B", 2)]);
        let corner = |x: f64, y: f64, bulge: f64| Corner {
            point: Vector2::new(x, y),
            bulge,
        };
        dxf.closed_line(
            "A",
            &[
                corner(0.0, 0.0, 0.0),
                corner(0.1, 0.0, 0.5),
                corner(0.0, -0.05, 0.0),
            ],
        );
        dxf.text("B", Vector2::new(-1e-12, 0.02), (0.005, 0.0), "N");
        let text = dxf.finish();
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        assert_eq!(lines.len() % 2, 0);
        let pairs = || lines.chunks(2).map(|pair| (pair[0], pair[1]));
        let handles = || {
            pairs()
                .zip(pairs().skip(1))
                .filter(|((_, before), (code, _))| {
                    *code == "105" || (*code == "5" && *before != "$HANDSEED")
                })
        };
        let known: BTreeSet<&str> = handles().map(|(_, (_, handle))| handle).collect();
        assert_eq!(known.len(), handles().count());
        for (code, owner) in pairs() {
            assert!(
                code != "330" || owner == "0" || known.contains(owner),
                "{owner}"
            );
        }
        let seed = pairs()
            .skip_while(|pair| pair.1 != "$HANDSEED")
            .nth(1)
            .unwrap()
            .1;
        let value = |handle: &str| u32::from_str_radix(handle, 16).unwrap();
        assert!(known.iter().all(|handle| value(handle) < value(seed)));
        // No number in mm is written as -0, and the unit is a millimetre.
        assert!(text.contains(" 10\n100.0\n") && text.contains(" 10\n0.0\n 20\n20.0\n"));
        assert!(!text.contains("-0.0\n"));
        assert!(text.contains("$INSUNITS\n 70\n4\n") && text.contains(" 42\n0.500000000000\n"));
    }
}
