//! Workshop files of a design: outlines with pockets for the magnets, and the order of assembly.
//!
//! - [`Part`]: the cutting lines of each tile;
//! - [`order`]: the order in which the magnets of a face are inserted, so that none is pushed out;
//! - [`grade`]: the nearest magnets of the catalogue;
//! - [`marks`]: what is engraved beside the pockets;
//! - `notch`: pockets without a wall as notches of the outline;
//! - [`nest`]: parts on sheets of material;
//! - [`stack`]: tiles of several layers.

pub mod grade;
pub mod marks;
pub mod nest;
mod notch;
pub mod order;
mod part;
mod rim;
mod sheets;
pub mod stack;

use clap::Args;

use crate::design::Design;
use crate::request;
pub use part::{Part, PartError, Pocket};
use physics::tile::{Magnet, Tile};
pub use rim::{Corner, extent};
pub use sheets::{Placed, Sheet};
pub use stack::Stack;

/// Density of neodymium magnets (kg/m^3).
const DENSITY: f64 = 7500.0;
/// Standard gravity (m/s^2).
const GRAVITY: f64 = 9.806_65;
/// Largest kerf and clearance (m): larger ones were meant in millimetres.
const LONGEST: f64 = 0.01;

/// The options of the workshop files.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Making {
    /// Width of the cut (m), or with a unit
    ///
    /// Outlines are offset outwards by half of it.
    #[arg(long, value_name = "M", default_value = "0", value_parser = small)]
    pub kerf: f64,

    /// Gap between magnet and pocket on each side (m), or with a unit
    #[arg(long, value_name = "M", default_value = "0.1 mm", value_parser = small)]
    pub clearance: f64,

    /// Copies of both tiles, nested on sheets
    #[arg(long, value_name = "N", value_parser = copies, conflicts_with = "count")]
    pub copies: Option<usize>,

    /// Copies of the fixed tile and of the moving one, nested on sheets
    ///
    /// One number if both tiles are the same.
    #[arg(long, value_name = "N,M", value_parser = counts)]
    pub count: Option<Counts>,

    /// Size of a sheet of material: "600x400 mm" [default: 600x400 mm, if there are copies]
    #[arg(long, value_name = "SIZE", value_parser = sheet)]
    pub sheet: Option<SheetSize>,

    /// Gap between parts on a sheet, and to its edges (m), or with a unit
    #[arg(long, value_name = "M", default_value = "2 mm", value_parser = small)]
    pub spacing: f64,

    /// Thickness of the layers of which a tile is glued, lowest first: "4 mm,4 mm"
    ///
    /// One part and file for each: pockets are cut through the layers that hold the magnets, and the
    /// others are lids.
    #[arg(long, value_name = "M,M", value_parser = layers)]
    pub layers: Option<Layers>,
}

/// Numbers of copies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts(pub Vec<usize>);

/// The size of a sheet (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetSize(pub [f64; 2]);

/// Thicknesses (m), lowest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers(pub Vec<f64>);

/// Largest number of copies.
const MOST_COPIES: usize = 10_000;
/// The usual sheet (m).
const USUAL_SHEET: [f64; 2] = [0.6, 0.4];
/// The farthest that facing magnets of a bond are apart, in lengths of the larger one.
const FACING: f64 = 3.0;

fn copies(text: &str) -> Result<usize, String> {
    let count = request::count(text)?;
    let few = count <= MOST_COPIES;
    few.then_some(count)
        .ok_or_else(|| format!("at most {MOST_COPIES} copies"))
}

fn counts(text: &str) -> Result<Counts, String> {
    let numbers: Option<Vec<usize>> = text
        .split(',')
        .map(|one| request::count_or_none(one.trim()).ok())
        .collect();
    let numbers = numbers.filter(|it| (1..=2).contains(&it.len()));
    let total = |it: &Vec<usize>| {
        it.iter()
            .fold(0, |all: usize, &one| all.saturating_add(one))
    };
    let numbers = numbers.filter(|it| (1..=MOST_COPIES).contains(&total(it)));
    numbers.map(Counts).ok_or_else(|| {
        format!("the numbers of fixed and moving tiles are needed, such as 6,6: 1 to {MOST_COPIES} in all")
    })
}

fn sheet(text: &str) -> Result<SheetSize, String> {
    let wrong = || "a size is width x height with a unit, such as \"600x400 mm\"".to_owned();
    let text = text.replace(['X', '\u{d7}', '*'], "x");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let (width, height) = (width.trim(), height.trim());
    let unit = height.trim_start_matches(|c: char| c.is_ascii_digit() || ".eE+- ".contains(c));
    // The width has its own unit, or that of the height.
    let own = width.ends_with(|c: char| c.is_alphabetic() || c == '"');
    let width = if own {
        width.to_owned()
    } else {
        format!("{width} {unit}")
    };
    let width = request::length(width.trim()).map_err(|_| wrong())?;
    let height = request::length(height).map_err(|_| wrong())?;
    match width.max(height) <= LARGEST_SHEET {
        true => Ok(SheetSize([width, height])),
        false => Err(format!(
            "a sheet is at most {LARGEST_SHEET} m long; {}",
            wrong()
        )),
    }
}

/// Longest side of a sheet (m): longer ones were meant in millimetres.
const LARGEST_SHEET: f64 = 20.0;

fn layers(text: &str) -> Result<Layers, String> {
    let each: Result<Vec<f64>, String> = text
        .split(',')
        .map(|one| request::length(one.trim()))
        .collect();
    each.map(Layers).map_err(|_| {
        "thicknesses with units are needed, lowest layer first: \"4 mm,4 mm\"".to_owned()
    })
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
    /// The number of copies of each.
    pub counts: [usize; 2],
    /// The sheets with all copies, if they were requested.
    pub sheets: Vec<Sheet>,
}

/// The workshop data of a tile.
#[derive(Clone, Debug, PartialEq)]
pub struct MadeTile {
    /// Its lines.
    pub part: Part,
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
    /// The pocket of the other tile that faces it in the bond.
    pub meets: Option<String>,
}

impl Made {
    /// The workshop data of a design.
    ///
    /// # Errors
    /// If the kerf is too wide for it, its layers do not make up the tile, or a part is larger than
    /// a sheet.
    pub fn new(design: &Design, making: &Making) -> Result<Self, PartError> {
        let pair = [&design.pair.fixed, &design.pair.moving];
        let counts = making.counts(pair)?;
        let mut magnets: Vec<(Magnet, usize)> = Vec::new();
        for (tile, copies) in pair.into_iter().zip(counts) {
            for magnet in &tile.magnets {
                let same = |known: &&mut (Magnet, usize)| known.0.is_sold_as(magnet);
                match magnets.iter_mut().find(same) {
                    Some(kind) => kind.1 += copies,
                    None => magnets.push((magnet.clone(), copies)),
                }
            }
        }
        magnets.retain(|kind| kind.1 > 0);
        let mut tiles = [
            MadeTile::new(pair[0], making, &label("fixed", counts))?,
            MadeTile::new(pair[1], making, &label("moving", counts))?,
        ];
        meet(design, &mut tiles);
        let sheets = match making.are_copies() {
            true => sheets::sheets(&tiles, counts, making)?,
            false => Vec::new(),
        };
        Ok(Self {
            making: making.clone(),
            magnets,
            tiles,
            counts,
            sheets,
        })
    }
}

impl Making {
    /// Whether parts are to be nested on sheets.
    fn are_copies(&self) -> bool {
        self.copies.is_some() || self.count.is_some() || self.sheet.is_some()
    }

    /// The size of a sheet (m).
    pub fn sheet(&self) -> [f64; 2] {
        self.sheet.map_or(USUAL_SHEET, |size| size.0)
    }

    fn counts(&self, pair: [&Tile; 2]) -> Result<[usize; 2], PartError> {
        let copies = self.copies.unwrap_or(1);
        match self.count.as_ref().map(|counts| &counts.0[..]) {
            None => Ok([copies; 2]),
            Some(&[fixed, moving]) => Ok([fixed, moving]),
            Some(&[count]) if same(pair) => Ok([count, 0]),
            _ => Err(PartError::Sheet(
                "the fixed and the moving tile differ: give two numbers, such as --count 6,6"
                    .to_owned(),
            )),
        }
    }
}

/// Whether both tiles are drawn and filled alike.
fn same([fixed, moving]: [&Tile; 2]) -> bool {
    let near = |a: nalgebra::Vector2<f64>, b: nalgebra::Vector2<f64>| (a - b).norm() < 1e-9;
    let (a, b) = (fixed.outline.vertices(), moving.outline.vertices());
    let magnets = || fixed.magnets.iter().zip(&moving.magnets);
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| near(*a, *b))
        && fixed.magnets.len() == moving.magnets.len()
        && magnets().all(|(a, b)| a.is_sold_as(b) && near(a.position, b.position))
        && magnets().all(|(a, b)| near(a.moment_vector(), b.moment_vector()) && a.form == b.form)
}

/// The name engraved on a tile, with a # for every digit of the copies' numbers.
fn label(name: &str, counts: [usize; 2]) -> String {
    match counts[0].max(counts[1]) {
        0 | 1 => name.to_owned(),
        many => format!("{name} {}", "#".repeat(many.to_string().len())),
    }
}

/// Notes for each pocket the one that faces it in the bond.
fn meet(design: &Design, tiles: &mut [MadeTile; 2]) {
    let pair = [&design.pair.fixed, &design.pair.moving];
    let places: [Vec<nalgebra::Vector2<f64>>; 2] = [
        pair[0].magnets.iter().map(|it| it.position).collect(),
        pair[1]
            .magnets
            .iter()
            .map(|it| design.pair.bound.transform(it.position))
            .collect(),
    ];
    let nearest = |tile: usize, own: usize| {
        let from = places[tile][own];
        let others = places[1 - tile].iter().enumerate();
        let nearest = others.min_by(|a, b| (a.1 - from).norm().total_cmp(&(b.1 - from).norm()));
        nearest.map(|(other, place)| (other, (place - from).norm()))
    };
    for (tile, magnets) in pair.map(|it| &it.magnets).into_iter().enumerate() {
        let [own, other] = match tiles {
            [fixed, moving] if tile == 0 => [fixed, moving],
            [fixed, moving] => [moving, fixed],
        };
        for step in &mut own.steps {
            let [a, b, _] = magnets[step.pocket].size;
            let facing = nearest(tile, step.pocket).filter(|(facing, far)| {
                let back = nearest(1 - tile, *facing);
                *far <= FACING * a.max(b) && back.is_some_and(|it| it.0 == step.pocket)
            });
            step.meets = facing.map(|(facing, _)| other.part.pockets[facing].name.clone());
        }
    }
}

impl MadeTile {
    fn new(tile: &Tile, making: &Making, name: &str) -> Result<Self, PartError> {
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
                    meets: None,
                }
            }));
        }
        let thickest = tile.magnets.iter().map(|magnet| magnet.size[2]);
        let thickest = thickest.fold(0.0, f64::max);
        let layers = making.layers.as_ref();
        let stack = layers.map(|layers| Stack::new(&layers.0, tile.thickness, thickest));
        Ok(Self {
            part: Part::new(tile, making, name)?,
            steps,
            stack: stack.transpose()?,
        })
    }
}
