//! All copies of the tiles on sheets of material.

use super::error::PartError;
use super::nest::{SheetPlace, nest};
use super::rim::extent;
use super::{MadeTile, Request};

/// A sheet of material with parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Thickness of the material (m).
    pub thickness: f64,
    /// The parts.
    pub parts: Vec<Placed>,
}

/// A part on a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// The index of the kind of tile.
    pub tile: usize,
    /// The number of the copy, from 1.
    pub number: usize,
    /// The layer of the tile, from 0, if it has several.
    pub layer: Option<usize>,
    /// The lower left corner of the part's rectangle on the sheet (m).
    pub corner: [f64; 2],
    /// Whether it is turned by a quarter turn.
    pub turned: bool,
}

/// The sheets, one thickness after the other.
///
/// # Errors
/// If a part is larger than a sheet.
pub(super) fn sheets(tiles: &[MadeTile], making: &Request) -> Result<Vec<Sheet>, PartError> {
    // Thickness, tile, number and layer of every part.
    let mut parts = Vec::new();
    for (tile, made) in tiles.iter().enumerate() {
        let layers: Vec<(Option<usize>, f64)> = match &made.stack {
            None => vec![(None, made.part.thickness)],
            Some(stack) => (stack.layers.iter().enumerate())
                .map(|(layer, &(thickness, _))| (Some(layer), thickness))
                .collect(),
        };
        for number in 1..=made.copies {
            parts.extend(
                layers
                    .iter()
                    .map(|&(layer, thick)| (thick, tile, number, layer)),
            );
        }
    }
    let mut kinds: Vec<f64> = parts.iter().map(|part| part.0).collect();
    kinds.sort_by(f64::total_cmp);
    kinds.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    let size_of = |made: &MadeTile| {
        let [low, high] = extent(&made.part.outline);
        [0, 1].map(|k| high[k] - low[k])
    };
    let boxes: Vec<[f64; 2]> = tiles.iter().map(size_of).collect();
    let size = making.sheet();
    let mut sheets = Vec::new();
    for thickness in kinds {
        let mine = parts
            .iter()
            .filter(|part| (part.0 - thickness).abs() < 1e-6);
        let mine: Vec<_> = mine.collect();
        let sizes: Vec<[f64; 2]> = mine.iter().map(|part| boxes[part.1]).collect();
        let places =
            nest(&sizes, size, making.spacing, true).ok_or_else(|| too_small(&sizes, making))?;
        let count = places
            .iter()
            .map(|place| place.sheet + 1)
            .max()
            .unwrap_or(0);
        for sheet in 0..count {
            let on_it = mine.iter().zip(&places).filter(|it| it.1.sheet == sheet);
            let placed = |(&&(_, tile, number, layer), place): (
                &&(f64, usize, usize, Option<usize>),
                &SheetPlace,
            )| Placed {
                tile,
                number,
                layer,
                corner: place.corner,
                turned: place.turned,
            };
            sheets.push(Sheet {
                thickness,
                parts: on_it.map(placed).collect(),
            });
        }
    }
    Ok(sheets)
}

fn too_small(sizes: &[[f64; 2]], making: &Request) -> PartError {
    let mm = |length: f64| (length * 1e4).ceil() / 10.0;
    let largest = sizes
        .iter()
        .copied()
        .max_by(|a, b| (a[0] * a[1]).total_cmp(&(b[0] * b[1])));
    let [width, height] = largest
        .unwrap_or_default()
        .map(|length| mm(length + 2.0 * making.spacing));
    let [wide, high] = making.sheet().map(mm);
    PartError::Sheet(format!(
        "a part needs {width} x {height} mm of a sheet, which has {wide} x {high} mm: use larger \
         sheets (--sheet \"{}x{} mm\"), or a smaller --spacing",
        width.ceil(),
        height.ceil()
    ))
}
