//! Workshop files of a design: outlines with pockets for the magnets, and the order of assembly.
//!
//! - [`Part`]: the cutting lines of each tile;
//! - [`order`]: the order in which the magnets of a face are inserted, so that none is pushed out;
//! - [`grade`]: the nearest magnets of the catalogue.

pub mod grade;
pub mod order;
mod part;
mod rim;

use clap::Args;

use crate::design::Design;
use crate::request;
pub use part::{Part, PartError, Pocket};
use physics::tile::{Magnet, Tile};
pub use rim::Corner;

/// Density of neodymium magnets (kg/m^3).
const DENSITY: f64 = 7500.0;
/// Standard gravity (m/s^2).
const GRAVITY: f64 = 9.806_65;
/// Largest kerf and clearance (m): larger ones were meant in millimetres.
const LONGEST: f64 = 0.01;

/// The options of the workshop files.
#[derive(Clone, Copy, Debug, PartialEq, Args)]
pub struct Making {
    /// Width of the cut (m), or with a unit
    ///
    /// Outlines are offset outwards by half of it.
    #[arg(long, value_name = "M", default_value = "0", value_parser = small)]
    pub kerf: f64,

    /// Gap between magnet and pocket on each side (m), or with a unit
    #[arg(long, value_name = "M", default_value = "0.1 mm", value_parser = small)]
    pub clearance: f64,
}

/// A length of a few millimetres at most.
fn small(text: &str) -> Result<f64, String> {
    match request::length_or_none(text)? {
        length if length > LONGEST => {
            let most = format!("it can be at most {} mm", 1e3 * LONGEST);
            let is_plain = text.trim().parse::<f64>().is_ok();
            Err(match is_plain && length <= 1e3 * LONGEST {
                true => format!("{most}; lengths are in m: in millimetres write \"{length} mm\""),
                false => most,
            })
        }
        length => Ok(length),
    }
}

/// The workshop data of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// The request.
    pub making: Making,
    /// Kinds of magnets, and the number of each.
    pub magnets: Vec<(Magnet, usize)>,
    /// The fixed tile and the moving one.
    pub tiles: [MadeTile; 2],
}

/// The workshop data of a tile.
#[derive(Clone, Debug, PartialEq)]
pub struct MadeTile {
    /// Its lines.
    pub part: Part,
    /// Its magnets in the order of insertion.
    pub steps: Vec<Filled>,
}

/// The insertion of a magnet into its pocket.
#[derive(Clone, Debug, PartialEq)]
pub struct Filled {
    /// The index of the pocket.
    pub pocket: usize,
    /// The largest force (N) that pushes the magnet out during insertion; 0 if it is drawn in.
    pub push: f64,
    /// Whether this exceeds its weight.
    pub is_to_be_held: bool,
}

impl Made {
    /// The workshop data of a design.
    ///
    /// # Errors
    /// If the kerf is too wide for it.
    pub fn new(design: &Design, making: &Making) -> Result<Self, PartError> {
        let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
        let mut magnets: Vec<(Magnet, usize)> = Vec::new();
        for magnet in fixed.magnets.iter().chain(&moving.magnets) {
            let same = |known: &&mut (Magnet, usize)| known.0.is_sold_as(magnet);
            match magnets.iter_mut().find(same) {
                Some(kind) => kind.1 += 1,
                None => magnets.push((magnet.clone(), 1)),
            }
        }
        Ok(Self {
            making: *making,
            magnets,
            tiles: [
                MadeTile::new(fixed, making)?,
                MadeTile::new(moving, making)?,
            ],
        })
    }
}

impl MadeTile {
    fn new(tile: &Tile, making: &Making) -> Result<Self, PartError> {
        let mut steps = Vec::new();
        for face in 0..tile.faces.len() {
            let own = |i: &usize| tile.magnets[*i].face == face;
            let places: Vec<usize> = (0..tile.magnets.len()).filter(own).collect();
            let magnets: Vec<&Magnet> = places.iter().map(|&i| &tile.magnets[i]).collect();
            steps.extend(order::order(&magnets).into_iter().map(|step| {
                let weight = DENSITY
                    * GRAVITY
                    * magnets[step.magnet]
                        .form
                        .shape
                        .volume(magnets[step.magnet].size);
                Filled {
                    pocket: places[step.magnet],
                    push: step.push,
                    is_to_be_held: step.push > weight,
                }
            }));
        }
        Ok(Self {
            part: Part::new(tile, making)?,
            steps,
        })
    }
}
