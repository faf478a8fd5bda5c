//! The base polygon of a tile, `side`, `sides` or `vertices`, and the names of its faces.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::quantity;
use super::reader::{Entry, Result, Section};
use crate::tile::Face;
use crate::tile::outline::{Outline, OutlineError};

/// Most faces of a tile.
const MOST_FACES: u32 = 64;

/// The straight faces of a tile, and all names of each; the first is what messages use.
pub(super) struct Base {
    pub faces: Vec<Face>,
    pub names: Vec<Vec<String>>,
}

/// Reads the base polygon of a tile.
pub(super) fn read(section: &Section) -> Result<Base> {
    let Some(entry) = section.get("vertices") else {
        return regular(section);
    };
    if let Some(other) = section.get("side").or_else(|| section.get("sides")) {
        return Err(other.key_error(
            format!("`vertices` and `{}` both describe the outline", other.key),
            "keep one of the two",
        ));
    }
    let vertices = vertices(&entry)?;
    Ok(base(
        &vertices,
        (0..vertices.len()).map(|i| vec![i.to_string()]).collect(),
    ))
}

/// A regular polygon about its centre; face 0 has its outward normal along +x.
fn regular(section: &Section) -> Result<Base> {
    let help = "say how long its sides are, side = 0.43 (m), or list its corners: vertices = [...]";
    let side = section.require("side", help)?.number(quantity::TILE_SIDE)?;
    let sides = match section.get("sides") {
        Some(entry) => entry.count(MOST_FACES)?,
        None => 4,
    };
    if sides < 3 {
        let entry = section.require("sides", help)?;
        return Err(entry.error(
            format!("a tile cannot have {sides} sides"),
            "give 3 or more",
        ));
    }
    if sides == 4 {
        let h = side / 2.0;
        let corners = [[h, -h], [h, h], [-h, h], [-h, -h]].map(Vector2::from);
        let names = ["east", "north", "west", "south"];
        let names = (0..4)
            .map(|i| vec![names[i].to_owned(), i.to_string()])
            .collect();
        return Ok(base(&corners, names));
    }
    let turn = TAU / f64::from(sides);
    let radius = side / (2.0 * (turn / 2.0).sin());
    let corners: Vec<_> = (0..sides)
        .map(|k| {
            let (sin, cos) = (turn * (f64::from(k) - 0.5)).sin_cos();
            Vector2::new(cos, sin) * radius
        })
        .collect();
    Ok(base(
        &corners,
        (0..sides).map(|i| vec![i.to_string()]).collect(),
    ))
}

fn base(corners: &[Vector2<f64>], names: Vec<Vec<String>>) -> Base {
    let n = corners.len();
    let faces = (0..n)
        .map(|i| Face {
            name: names[i][0].clone(),
            start: corners[i],
            end: corners[(i + 1) % n],
        })
        .collect();
    Base { faces, names }
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
            format!("give at most {MOST_FACES}; a face's line may have more: shape = \"points\""),
        ));
    }
    let vertices: Vec<_> = vertices.into_iter().map(Vector2::from).collect();
    match Outline::new(vertices.clone()) {
        Ok(_) => Ok(vertices),
        Err(error) => Err(mend(entry, &items, error)),
    }
}

/// A list of corners that is no outline, as a fault of the corner that is to be changed.
fn mend(entry: &Entry, items: &[Entry], error: OutlineError) -> super::DesignError {
    let message = error.to_string();
    match error {
        OutlineError::RepeatedVertex(i, j) => {
            items[i.max(j)].error(message, "take one of the two away")
        }
        OutlineError::SelfCrossing(_, j) => items[j].error(
            message,
            "corners are counted from 0; list them in their order around the tile",
        ),
        OutlineError::Clockwise => entry.error(message, "reverse the list"),
        OutlineError::TooFewVertices(_) => entry.error(message, "give three corners or more"),
        OutlineError::NotDecomposable => {
            entry.error(message, "move corners that lie very close to another edge")
        }
    }
}
