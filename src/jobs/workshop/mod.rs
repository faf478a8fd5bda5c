//! Workshop files of a design: outlines with pockets for the magnets, and the order of assembly.
//!
//! - [`Subject`]: the kinds of tiles of a design, of several, or of a tile set;
//! - [`CutPart`]: the cutting lines of each tile;
//! - [`order`]: the order in which the magnets of a face are inserted, so that none is pushed out;
//! - [`grade`]: the nearest magnets of the catalogue;
//! - [`marks`]: what is engraved beside the pockets;
//! - `notch`: pockets without a wall as notches of the outline;
//! - [`nest`]: parts on sheets of material;
//! - [`stack`]: tiles of several layers.

mod error;
pub mod grade;
mod kinds;
pub mod marks;
mod mates;
pub mod nest;
mod notch;
pub mod order;
mod part;
mod request;
mod rim;
mod sheets;
pub mod stack;

pub use error::PartError;
pub use kinds::{Kind, Subject};
pub use part::{CutPart, Pocket, open_pockets};
use physics::tile::Magnet;
pub use request::{CLEARANCE, Request};
pub use rim::{Corner, extent};
pub use sheets::{Placed, Sheet};
pub use stack::Stack;

/// Density of neodymium magnets (kg/m^3).
const DENSITY: f64 = 7500.0;
/// Standard gravity (m/s^2).
const GRAVITY: f64 = 9.806_65;

/// The workshop data of tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// The request.
    pub making: Request,
    /// The name of the design, or of the tile set.
    pub name: String,
    /// Kinds of magnets, and the number of each.
    pub magnets: Vec<(Magnet, usize)>,
    /// The kinds of tiles.
    pub tiles: Vec<MadeTile>,
    /// The sheets with all copies, if they were requested.
    pub sheets: Vec<Sheet>,
}

/// The workshop data of a kind of tile.
#[derive(Clone, Debug, PartialEq)]
pub struct MadeTile {
    /// Its name, which is also that of its files.
    pub name: String,
    /// The name of its first face.
    pub first_face: String,
    /// The number of copies.
    pub copies: usize,
    /// Its lines.
    pub part: CutPart,
    /// Its magnets in the order of insertion.
    pub steps: Vec<Filled>,
    /// Its layers, if it has several.
    pub stack: Option<Stack>,
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
    /// The pockets that face it in bonds: the index of the tile, and the name of the pocket.
    pub meets: Vec<(usize, String)>,
    /// The share of the bond that is left if this magnet is the wrong way round; `None` if it takes
    /// part in no bond, or in several.
    pub left_if_wrong: Option<f64>,
}

impl Made {
    /// The workshop data of tiles.
    ///
    /// # Errors
    /// If the kerf is too wide for one, its layers do not make it up, or a part is larger than a
    /// sheet.
    pub fn new(subject: &Subject, making: &Request) -> Result<Self, PartError> {
        let kinds: Vec<(&str, usize)> = (subject.kinds.iter())
            .map(|kind| (&kind.name[..], kind.usual))
            .collect();
        let counts = making.counts(&kinds)?;
        let most = counts.iter().copied().max().unwrap_or(0);
        let made = subject.kinds.iter().zip(&counts);
        let made = made.map(|(kind, copies)| MadeTile::new(kind, *copies, most, making));
        let mut tiles = made.collect::<Result<Vec<_>, _>>()?;
        for meeting in &subject.meetings {
            let [one, other] = meeting.pockets;
            for (k, (tile, pocket), (facing, magnet)) in [(0, one, other), (1, other, one)] {
                let met = (facing, tiles[facing].part.pockets[magnet].name.clone());
                let steps = tiles[tile].steps.iter_mut();
                for step in steps.filter(|step| step.pocket == pocket) {
                    if !step.meets.contains(&met) {
                        step.meets.push(met.clone());
                    }
                    step.left_if_wrong = meeting.left_if_wrong.map(|shares| shares[k]);
                }
            }
        }
        let sheets = match making.are_copies() {
            true => sheets::sheets(&tiles, making)?,
            false => Vec::new(),
        };
        Ok(Self {
            making: making.clone(),
            name: subject.name.clone(),
            magnets: bought(&subject.kinds, &counts),
            tiles,
            sheets,
        })
    }
}

/// Kinds of magnets, and the number of each.
fn bought(kinds: &[Kind], counts: &[usize]) -> Vec<(Magnet, usize)> {
    let mut bought: Vec<(Magnet, usize)> = Vec::new();
    for (kind, &copies) in kinds.iter().zip(counts).filter(|it| *it.1 > 0) {
        for magnet in &kind.tile.magnets {
            let same = |known: &&mut (Magnet, usize)| known.0.is_sold_as(magnet);
            match bought.iter_mut().find(same) {
                Some(known) => known.1 += copies,
                None => bought.push((magnet.clone(), copies)),
            }
        }
    }
    bought
}

/// The name engraved on a tile, with a # for every digit of the largest number of copies.
fn label(name: &str, most: usize) -> String {
    match most {
        0 | 1 => name.to_owned(),
        many => format!("{name} {}", "#".repeat(many.to_string().len())),
    }
}

impl MadeTile {
    fn new(kind: &Kind, copies: usize, most: usize, making: &Request) -> Result<Self, PartError> {
        let tile = &kind.tile;
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
                    meets: Vec::new(),
                    left_if_wrong: None,
                }
            }));
        }
        let thickest = tile.magnets.iter().map(|magnet| magnet.size[2]);
        let thickest = thickest.fold(0.0, f64::max);
        let layers = making.layers.as_ref();
        let stack = layers.map(|layers| Stack::new(&layers.0, tile.thickness, thickest));
        Ok(Self {
            name: kind.name.clone(),
            first_face: tile.faces[0].name.clone(),
            copies,
            part: CutPart::new(tile, making, &label(&kind.name, most))?,
            steps,
            stack: stack.transpose()?,
        })
    }
}
