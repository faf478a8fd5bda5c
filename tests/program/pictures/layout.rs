//! Where things are in pictures, read back from their SVG: texts within the frame and apart from
//! each other, cells of a matrix in rows and columns with their names beside them.

use std::path::Path;

use roxmltree::{Document, Node};
use tilebind::report::plots::matrix::Matrix;
use tilebind::report::plots::{Figure, Sheet};

use super::figures;
use crate::program::{command, stderr};

/// A text with a box that it certainly fills: fonts are wider than 0.35 of their size a letter.
struct Written {
    text: String,
    middle: [f64; 2],
    half: [f64; 2],
}

fn number(node: &Node, key: &str) -> f64 {
    node.attribute(key).unwrap().parse().unwrap()
}

fn written(document: &Document) -> Vec<Written> {
    let texts = document.descendants().filter(|it| it.has_tag_name("text"));
    let upright = texts.filter(|it| it.attribute("transform").is_none());
    let read = upright.map(|node| {
        let text = node.text().unwrap_or_default().trim().to_owned();
        let size = number(&node, "font-size");
        let half = [0.5 * 0.35 * size * text.chars().count() as f64, 0.3 * size];
        let [x, y] = ["x", "y"].map(|key| number(&node, key));
        let across = match node.attribute("text-anchor") {
            Some("middle") => 0.0,
            Some("end") => -half[0],
            _ => half[0],
        };
        let down = match node.attribute("dy") {
            Some("0.5ex") => 0.0,
            Some("0.76em") => half[1],
            _ => -half[1],
        };
        Written {
            middle: [x + across, y + down],
            text,
            half,
        }
    });
    read.filter(|it| !it.text.is_empty()).collect()
}

fn size(document: &Document) -> [f64; 2] {
    let view = document.root_element().attribute("viewBox").unwrap();
    let all: Vec<f64> = view.split(' ').map(|it| it.parse().unwrap()).collect();
    [all[2], all[3]]
}

/// Texts lie in the picture and not on one another.
fn is_legible(name: &str, svg: &str) {
    let document = Document::parse(svg).unwrap();
    let (all, size) = (written(&document), size(&document));
    assert!(!all.is_empty(), "{name}");
    for (k, one) in all.iter().enumerate() {
        for axis in 0..2 {
            let (at, half) = (one.middle[axis], one.half[axis]);
            let inside = at - half >= 0.0 && at + half <= size[axis];
            assert!(
                inside,
                "{name}: {} at {:?} of {size:?}",
                one.text, one.middle
            );
        }
        for other in &all[..k] {
            let apart = (0..2).any(|axis| {
                let between = (one.middle[axis] - other.middle[axis]).abs();
                between >= one.half[axis] + other.half[axis]
            });
            assert!(apart, "{name}: {} on {}", one.text, other.text);
        }
    }
}

#[test]
fn texts_of_pictures_lie_inside_and_apart() {
    for figure in figures() {
        for (name, picture) in &figure.pictures {
            is_legible(name, &picture.svg);
        }
    }
}

fn matrix(count: usize) -> Figure {
    let share = |row: usize, column: usize| match (row + 2 * column) % 5 {
        4 => None,
        k => Some(k as f64 / 3.0),
    };
    let shares = (0..count).map(|row| (0..count).map(|column| share(row, column)).collect());
    Matrix {
        name: "matrix",
        title: "A matrix".to_owned(),
        names: (0..count).map(|k| format!("face {k}")).collect(),
        shares: shares.collect(),
        is_framed: |row, column, count| row + column + 1 == count,
        legend: "a share",
        remark: "",
        numbers: String::new(),
    }
    .draw(&Sheet::SCREEN)
    .unwrap()
}

/// Cells are equal squares side by side, in order; the number is in the middle of its cell, names
/// are beside their rows and above their columns, and darker cells have larger numbers.
#[test]
fn a_matrix_has_its_numbers_in_rows_and_columns() {
    for count in [1, 4, 7, 30] {
        let figure = matrix(count);
        let svg = figure.svg();
        is_legible("matrix", svg);
        let document = Document::parse(svg).unwrap();
        let (texts, size) = (written(&document), size(&document));
        let cells: Vec<([usize; 2], [f64; 4])> = document
            .descendants()
            .filter_map(|node| {
                let place: Vec<usize> = node
                    .attribute("data-cell")?
                    .split(' ')
                    .map(|it| it.parse().unwrap())
                    .collect();
                let corners: Vec<f64> = node
                    .attribute("points")?
                    .split([' ', ','])
                    .map(|it| it.parse().unwrap())
                    .collect();
                Some((
                    [place[0], place[1]],
                    [corners[0], corners[1], corners[4], corners[5]],
                ))
            })
            .collect();
        assert_eq!(cells.len(), count * count);
        let first = cells[0].1;
        let side = (cells[count * count - 1].1[2] - first[0]) / count as f64;
        assert!(side > 100.0 && first[0] > 0.0 && first[1] > 0.0);
        for ([row, column], [left, top, right, bottom]) in &cells {
            // To the rounding of a tenth of a pixel.
            let x = first[0] + side * *column as f64;
            let y = first[1] + side * *row as f64;
            for (found, asked) in [(left, x), (top, y), (right, x + side), (bottom, y + side)] {
                assert!(
                    (found - asked).abs() <= 1.5,
                    "{row} {column}: {found} {asked}"
                );
            }
            assert!(*right <= size[0] && *bottom <= size[1]);
            let within = |it: &&Written| {
                (it.middle[0] - 0.5 * (left + right)).abs() < 0.3 * side
                    && (it.middle[1] - 0.5 * (top + bottom)).abs() < 0.3 * side
            };
            let asked = (row + 2 * column) % 5;
            let told = texts.iter().find(within).map(|it| it.text.clone());
            if side >= 400.0 {
                let number = format!("{:.2}", asked as f64 / 3.0);
                assert_eq!(told, (asked != 4).then_some(number), "{row} {column}");
            }
        }
        for k in 0..count {
            let name = format!("face {k}");
            let middle = side * (k as f64 + 0.5);
            let named: Vec<&Written> = texts.iter().filter(|it| it.text == name).collect();
            let beside = |it: &&&Written| it.middle[0] < first[0];
            let (rows, columns): (Vec<&Written>, Vec<&Written>) =
                named.iter().partition(|it| beside(it));
            for row in &rows {
                assert!((row.middle[1] - first[1] - middle).abs() <= 1.5, "{name}");
            }
            for column in &columns {
                assert!(
                    (column.middle[0] - first[0] - middle).abs() <= 1.5,
                    "{name}"
                );
                assert!(column.middle[1] < first[1]);
            }
            assert!(
                side < 400.0 || (rows.len(), columns.len()) == (1, 1),
                "{name}"
            );
        }
    }
}

/// All pictures in a folder and those below it.
fn drawn(folder: &Path) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(drawn(&path));
        } else if path.extension().is_some_and(|it| it == "svg") {
            let text = std::fs::read_to_string(&path).unwrap();
            all.push((path.display().to_string(), text));
        }
    }
    all
}

const TAB: &str = "shapes/tab-20mm.toml";

/// The commands that draw, each with little work.
const DRAWING: [&[&str]; 7] = [
    &[
        "compare",
        TAB,
        "shapes/one-face.toml",
        "--milestones=200",
        "--far-starts=10",
        "--certify-cells=0",
        "--complete-cells=0",
    ],
    &["dock", TAB, "--runs", "24", "--duration", "2"],
    &["bond", TAB, "--kt", "3e-3", "--coverage", "0.3"],
    &[
        "yield",
        TAB,
        "--tiles",
        "10",
        "--time",
        "600",
        "--kt",
        "2e-3,3e-3",
        "--runs",
        "16",
    ],
    &[
        "table",
        TAB,
        "--count",
        "2,2",
        "--time",
        "1",
        "--shaking",
        "3e-3",
        "--drag",
        "0.5",
    ],
    &[
        "assemble",
        "lattice",
        "--lattice",
        "2x3",
        "--kt",
        "4e-3",
        "--coverage",
        "0.1",
    ],
    &[
        "sweep",
        TAB,
        "--vary",
        "fixed.faces.east.profile.depth=0.01,0.02",
        "--milestones=200",
        "--far-starts=10",
        "--certify-cells=0",
        "--complete-cells=0",
    ],
];

#[test]
fn pictures_of_every_command_are_legible() {
    for asked in DRAWING {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let more = ["--quiet", "--out", out.to_str().unwrap()];
        let output = command(&[asked, &more[..]].concat()).output().unwrap();
        assert_eq!(
            output.status.code(),
            Some(0),
            "{asked:?}: {}",
            stderr(&output)
        );
        let all = drawn(&out);
        assert!(!all.is_empty(), "{asked:?}");
        for (name, svg) in all {
            is_legible(&name, &svg);
        }
    }
}
