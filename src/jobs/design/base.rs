//! The base polygon of a tile, `side`, `sides`, `vertices` or `outline`, and the names of its faces.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::error::Result;
use super::quantity;
use super::reader::{Entry, Section};
use super::svg;
use physics::tile::Face;
use physics::tile::outline::{Outline, OutlineError};
use physics::tile::profile::{Arcs, Polyline};

/// Largest number of faces of a tile.
const MOST_FACES: u32 = 64;

/// The straight faces of a tile with all names of each; messages use the first.
pub(super) struct Base {
    pub faces: Vec<Face>,
    /// The line of each face that has no profile of its own; empty for the base line.
    pub lines: Vec<Polyline>,
    /// The points of these lines that lie on arcs.
    pub arcs: Vec<Arcs>,
    pub names: Vec<Vec<String>>,
}

/// Reads the base polygon of a tile.
pub(super) fn read(section: &Section) -> Result<Base> {
    let listed = ["vertices", "outline"].map(|key| section.get(key));
    let Some(entry) = listed.into_iter().flatten().next() else {
        return regular(section);
    };
    let others = ["side", "sides", "outline"].into_iter();
    let mut others = others.filter(|key| *key != entry.key);
    if let Some(other) = others.find_map(|key| section.get(key)) {
        return Err(other.key_error(
            format!(
                "`{}` and `{}` both describe the outline",
                entry.key, other.key
            ),
            "keep one of the two",
        ));
    }
    if entry.key == "outline" {
        let drawn = svg::read_outline(&entry)?;
        let (corners, lines): (Vec<_>, Vec<_>) = drawn.into_iter().unzip();
        let (lines, arcs) = lines.into_iter().unzip();
        return Ok(Base {
            lines,
            arcs,
            ..base(&corners, &[])
        });
    }
    Ok(base(&vertices(&entry)?, &[]))
}

/// A regular polygon around its centre; face 0 has its outward normal along +x.
fn regular(section: &Section) -> Result<Base> {
    let help = "give the side length, side = 0.43 (m), the corners, vertices = [...], or a \
        drawing: outline = { file = \"tile.svg\" }";
    let side = section.require("side", help)?.number(quantity::TILE_SIDE)?;
    let sides = match section.get("sides") {
        Some(entry) => entry.count(MOST_FACES)?,
        None => 4,
    };
    if sides < 3 {
        let message = format!("a tile cannot have {sides} sides");
        return Err(section
            .require("sides", help)?
            .error(message, "give 3 or more"));
    }
    if sides == 4 {
        let h = side / 2.0;
        let corners = [[h, -h], [h, h], [-h, h], [-h, -h]].map(Vector2::from);
        return Ok(base(&corners, &["east", "north", "west", "south"]));
    }
    let turn = TAU / f64::from(sides);
    let radius = side / (2.0 * libm::sin(turn / 2.0));
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(turn * (f64::from(k) - 0.5));
        Vector2::new(cos, sin) * radius
    };
    let corners: Vec<_> = (0..sides).map(corner).collect();
    Ok(base(&corners, &[]))
}

/// The faces between corners; the name of each is its number, after one of `names` if given.
fn base(corners: &[Vector2<f64>], names: &[&str]) -> Base {
    let n = corners.len();
    let named = |i: usize| names.get(i).map(|name| (*name).to_owned());
    let names = (0..n).map(|i| named(i).into_iter().chain([i.to_string()]).collect());
    let names: Vec<Vec<String>> = names.collect();
    let face = |i: usize| Face {
        name: names[i][0].clone(),
        start: corners[i],
        end: corners[(i + 1) % n],
    };
    Base {
        faces: (0..n).map(face).collect(),
        lines: vec![Polyline::new(); n],
        arcs: vec![Arcs::new(); n],
        names,
    }
}

fn vertices(entry: &Entry) -> Result<Vec<Vector2<f64>>> {
    let items = entry.array()?;
    let vertices = items
        .iter()
        .map(|item| item.numbers::<2>(quantity::TILE_CORNER, "x and y of a corner"))
        .collect::<Result<Vec<_>>>()?;
    if vertices.len() > MOST_FACES as usize {
        return Err(entry.error(
            format!("a tile cannot have {} corners", vertices.len()),
            format!("give at most {MOST_FACES}; a face can have more points: shape = \"points\""),
        ));
    }
    let vertices: Vec<_> = vertices.into_iter().map(Vector2::from).collect();
    match Outline::new(vertices.clone()) {
        Ok(_) => Ok(vertices),
        Err(error) => Err(fix(entry, &items, error)),
    }
}

/// The fault of a list of corners that is not a valid outline, at the corner to change.
fn fix(entry: &Entry, items: &[Entry], error: OutlineError) -> super::DesignError {
    let message = error.to_string();
    match error {
        OutlineError::RepeatedVertex(i, j) => {
            items[i.max(j)].error(message, "remove one of the two")
        }
        OutlineError::SelfCrossing(_, j) => items[j].error(
            message,
            "corners are counted from 0; list them in order around the tile",
        ),
        OutlineError::Clockwise => entry.error(message, "reverse the list"),
        OutlineError::TooFewVertices(_) => entry.error(message, "give three corners or more"),
        OutlineError::NotDecomposable => entry.error(message, "move corners away from other edges"),
    }
}
