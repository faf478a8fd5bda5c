//! New designs made to given measures, valid as written.

mod code;
mod material;
mod shape;
mod shop;

use std::f64::consts::PI;
use std::fmt::Write;

use super::quantity::{four_digits, rounded_down};
use super::{Design, DesignError};
use crate::text::check_visible;
use physics::tile::barcode::Barcode;

use code::code;
pub use material::Material;
pub use shape::ProfileShape;
pub use shop::ShopMagnet;

/// Common magnets on the market (m): along the axis, along the face, through the thickness.
const BLOCKS: [[f64; 3]; 5] = [
    [0.010, 0.010, 0.003],
    [0.008, 0.008, 0.003],
    [0.005, 0.005, 0.002],
    [0.003, 0.003, 0.002],
    [0.002, 0.002, 0.001],
];
/// Widest spacing of magnets (m), that of the paper's tile.
const WIDEST: f64 = 0.040;
/// Least spacing, in widths of a magnet, also for the smallest magnets: with closer ones, codes
/// hardly differ.
const CLOSE: f64 = 2.0;
const CLOSEST: f64 = 1.6;
/// Length of a code over that of its side, as on the paper's tile, if the magnets' sizes leave the
/// choice: if they are farther apart, single magnets catch tiles from elsewhere (a square with four
/// magnets over three quarters of its side captures 24 % of far starts, over a quarter 44 %).
const COMPACT: f64 = 0.28;
/// A code with fewer gaps than this is shorter.
const GAPS: usize = 3;
/// Least distance from a tile's centre to its faces, in magnets, so that the magnets of one face
/// hardly act through the tile.
const ACROSS: f64 = 8.0;
/// Largest radius of a tile (m).
const LARGEST: f64 = 1.5;
/// Share of a face that magnets may take.
const USED: f64 = 0.85;
/// Density of magnets of neodymium (kg / m^3).
const OF_MAGNETS: f64 = 7.5e3;
/// Least inset (m), and least wall (m) on all sides of a magnet: a pocket 0.1 mm larger than its
/// magnet, a wall of 0.5 mm and a cut of 0.2 mm.
const INSET: f64 = 8e-4;
const WALL: f64 = 6e-4;
/// Factors by which profiles are widened until their magnets have walls.
const WIDER: [f64; 4] = [1.0, 1.2, 1.4, 1.7];
/// If magnets do not fit, sides this much longer are tried, so many times.
const LONGER: f64 = 1.03;
const LENGTHENED: u8 = 60;
/// Largest number of sides: with more, a tile is nearly a disc, and its faces hardly differ.
const MOST_SIDES: u32 = 24;
/// Largest number of magnets: codes for more are not searched here.
const MOST_MAGNETS: usize = 16;

/// The options of a new design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Sides of both tiles.
    pub sides: u32,
    /// Length of a side (m).
    pub side: f64,
    /// Magnets on each target face.
    pub magnets: usize,
    /// The line of the target faces.
    pub shape: ProfileShape,
    /// The magnets; by default the best fitting ones on the market.
    pub magnet: Option<ShopMagnet>,
    /// Thickness of both tiles (m); by default in proportion to the side.
    pub thickness: Option<f64>,
    /// What they are made of.
    pub material: Material,
    /// Whether both tiles are of one kind.
    pub one_kind: bool,
}

impl Default for Start {
    fn default() -> Self {
        Self {
            sides: 4,
            side: 0.43,
            magnets: 4,
            shape: ProfileShape::Tab,
            magnet: None,
            thickness: None,
            material: Material::USUAL,
            one_kind: false,
        }
    }
}

/// Why there is no such design, and what to request instead.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{wrong}\n  help: {fix}")]
pub struct StartError {
    wrong: String,
    fix: String,
}

fn wrong(wrong: impl Into<String>, fix: impl Into<String>) -> StartError {
    StartError {
        wrong: wrong.into(),
        fix: fix.into(),
    }
}

/// Refuses a name with characters that are not seen.
pub(crate) fn check_name(name: &str) -> Result<(), StartError> {
    let told = check_visible(name, |_| false);
    told.map_err(|told| wrong(format!("the name {told}"), "delete it"))
}

impl Start {
    /// The text of a design file called `name`: magnets spaced and sized roughly as on the paper's
    /// tile, with the code that has the weakest slid matches, only on the target faces.
    ///
    /// # Errors
    /// If there is no such tile, or no room for the magnets.
    pub fn design(&self, name: &str) -> Result<String, StartError> {
        self.check()?;
        self.fitted(name).map_err(|fault| self.no_room(fault))
    }

    /// The text of the design; if there is none, the fault of the last one that was tried.
    fn fitted(&self, name: &str) -> Result<String, Option<DesignError>> {
        let mut last = None;
        for (block, pitch) in self.rows() {
            // As far behind the surface as curved lines need, and no farther.
            let insets = (0..=8).map(|k| tenths(INSET + block[0] * f64::from(k) / 10.0));
            for (wider, inset) in WIDER
                .into_iter()
                .flat_map(|w| insets.clone().map(move |i| (w, i)))
            {
                let text = self.text(name, (block, pitch), inset, wider);
                match Design::parse(&text, name) {
                    Ok(design) if !design.warnings.is_empty() => {
                        last = design.warnings.into_iter().next();
                    }
                    Ok(design) if has_walls(&design) => return Ok(text),
                    Ok(_) => {}
                    Err(fault) => last = Some(fault),
                }
                if self.shape == ProfileShape::Flat {
                    break;
                }
            }
        }
        Err(last)
    }

    /// Magnets with their spacings (m), the best first.
    fn rows(&self) -> Vec<([f64; 3], f64)> {
        let inner = self.radius() * libm::cos(PI / f64::from(self.sides));
        let own = self.magnet.map(|magnet| magnet.in_plane());
        let blocks = own.as_ref().map_or(&BLOCKS[..], std::slice::from_ref);
        let smallest = blocks[blocks.len() - 1];
        let gaps = self.magnets.max(2) - 1;
        let wanted = (COMPACT * self.side / gaps.max(GAPS) as f64).min(WIDEST);
        let fits = |block: &[f64; 3]| block[0] <= inner / ACROSS && CLOSE * block[1] <= wanted;
        let blocks = blocks.iter().copied();
        let blocks = blocks.filter(|b| fits(b) || *b == smallest);
        let rows = blocks.flat_map(|block| {
            let room = (USED * self.side - block[1]) / gaps as f64;
            let least = closest(block[1]);
            // Closer ones, and perhaps wider ones, stay clear of flanks.
            let pitches = [1.0, 0.9, 0.8, 0.7, 1.2, 1.5];
            let pitches = pitches.map(|share| tenths(share * wanted.max(least)));
            let pitches = pitches.into_iter();
            let allowed = pitches.filter(move |pitch| (least..=room).contains(pitch));
            allowed.map(move |pitch| (block, pitch))
        });
        rows.collect()
    }

    fn check(&self) -> Result<(), StartError> {
        let Self {
            sides,
            side,
            magnets,
            ..
        } = *self;
        if !(3..=MOST_SIDES).contains(&sides) {
            let fault = format!("a tile cannot have {sides} sides here");
            return Err(wrong(fault, format!("give 3 to {MOST_SIDES}: --sides 6")));
        }
        if !(1..=MOST_MAGNETS).contains(&magnets) {
            return Err(wrong(
                format!("cannot choose a code for {magnets} magnets on a face"),
                format!(
                    "give 1 to {MOST_MAGNETS}: --magnets 4; for more, start with fewer and edit \
                     the code"
                ),
            ));
        }
        let largest = rounded_down(LARGEST * side / self.radius());
        if !(0.01..=largest).contains(&side) {
            return Err(wrong(
                format!("{sides} sides of {side} m are not a practical tile"),
                format!("give sides of 0.01 to {largest} m: --side 0.12, or --side \"12 cm\""),
            ));
        }
        Ok(())
    }

    /// The radius of the circle through the corners (m).
    fn radius(&self) -> f64 {
        self.side / (2.0 * libm::sin(PI / f64::from(self.sides)))
    }

    /// Why the magnets do not fit, and similar requests for which they do.
    fn no_room(&self, fault: Option<DesignError>) -> StartError {
        let fits = |other: &Self| other.check().is_ok() && other.fitted("").is_ok();
        let mut fewer = (1..self.magnets)
            .rev()
            .map(|magnets| Self { magnets, ..*self });
        let mut longer = (1..=LENGTHENED).map(|k| Self {
            side: (self.side * libm::pow(LONGER, f64::from(k)) * 1e3).ceil() / 1e3,
            ..*self
        });
        let flat = Self {
            shape: ProfileShape::Flat,
            ..*self
        };
        let advice = [
            fewer
                .find(fits)
                .map(|it| format!("--magnets {} or fewer", it.magnets)),
            longer
                .find(fits)
                .map(|it| format!("--side {} or longer", it.side)),
            fits(&flat).then(|| "--shape flat".to_owned()),
        ];
        let advice: Vec<String> = advice.into_iter().flatten().collect();
        let message = match fault {
            Some(fault) => format!("the magnets do not fit into this shape: {}", fault.message),
            None => format!(
                "{} magnets do not fit on a side of {} m",
                self.magnets, self.side
            ),
        };
        match advice.is_empty() {
            true => wrong(message, "use smaller magnets"),
            false => wrong(message, format!("use {}", advice.join(", or "))),
        }
    }

    fn text(&self, name: &str, row: ([f64; 3], f64), inset: f64, wider: f64) -> String {
        let (block, pitch) = row;
        let Self {
            sides,
            side,
            magnets,
            shape,
            magnet,
            material,
            one_kind,
            ..
        } = *self;
        let area = f64::from(sides) * side * side / (4.0 * libm::tan(PI / f64::from(sides)));
        let usual = tenths((side / 5.0).min(0.013).max(block[2] + 1e-3));
        let thickness = self.thickness.unwrap_or(usual);
        let shape_of_magnets = magnet.map_or(Default::default(), |own| own.shape);
        let taken = magnets as f64 * shape_of_magnets.volume(block);
        let density = material.density;
        let mass = four_digits(density * (area * thickness - taken) + OF_MAGNETS * taken);
        let made = match material.name {
            "" => format!("{density} kg/m3"),
            name => format!("{name}, {density} kg/m3"),
        };
        let table = (6.5 * self.radius() * 100.0).ceil() / 100.0;
        let (from, to) = match sides {
            4 => ("east".to_owned(), "west".to_owned()),
            _ => ("0".to_owned(), (sides / 2).to_string()),
        };
        let stands = magnet.is_some_and(|own| own.up);
        let code = match stands {
            true => code(magnets).replace('N', "U").replace('S', "D"),
            false => code(magnets),
        };
        let mate = Barcode::parse(&code).map_or(String::new(), |code| code.mate().to_string());
        let (profile, how) = match shape.profile(side, wider) {
            Some((profile, how)) => (format!(", profile = {profile}"), format!(" by {how}")),
            None => Default::default(),
        };
        let lengths = ShopMagnet::lengths(block, shape_of_magnets, stands);
        let strength = magnet.map_or_else(|| "remanence = 1.2".to_owned(), |own| own.strength());
        let tile = format!(
            "side = {side}\nsides = {sides}\nthickness = {thickness}\nmass = {mass}  # of {made}, with the magnets"
        );
        let magnets = format!("{from} = {{ code = \"{code}\"{profile} }}");
        let mates = format!(
            "{to} = {{ mates = \"{from}\" }}     # the exact complement: its code is {mate}"
        );
        let tiles = match one_kind {
            true => format!(
                "\
[tile]                        # both tiles: they are of one kind
{tile}

# Faces are numbered counter-clockwise from the one towards +x, face 0. Only the faces that are to
# bind carry magnets, so that nothing else binds as strongly.
[tile.faces]
{magnets}
{mates}

[target]
faces = [\"{from}\", \"{to}\"]
"
            ),
            false => format!(
                "\
[fixed]
{tile}

# Faces are numbered counter-clockwise from the one towards +x, face 0. Only the faces that are to
# bind carry magnets, so that nothing else binds as strongly.
[fixed.faces]
{magnets}

[moving]
{tile}

[moving.faces]
{mates}

[target]
fixed = \"{from}\"
moving = \"{to}\"
"
            ),
        };
        let mut text = String::new();
        let _ = write!(
            text,
            "\
# Lengths are in m, masses in kg, fields in T, angles in rad; \"12 cm\" and \"30 deg\" are read too.
# All keys with remarks: tilebind init -

name = \"{name}\"
description = \"tiles of {sides} sides that bind{how}\"

[table]
size = [{table}, {table}]

[magnet]
{lengths}
{strength}
pitch = {pitch}                  # centre to centre along the face
inset = {inset}                  # from the face's surface to the magnet: a wall that can be cut

{tiles}
[potential]
model = \"cuboid\"                # blocks, as magnets are; \"dipole\": the paper's point dipoles
"
        );
        text
    }
}

/// Whether every magnet has a wall to its tile's rim that can be cut.
fn has_walls(design: &Design) -> bool {
    let tiles = [&design.pair.fixed, &design.pair.moving];
    tiles.into_iter().all(|tile| {
        let mut magnets = tile.magnets.iter();
        magnets.all(|magnet| magnet.wall(&tile.outline) > WALL - 1e-9)
    })
}

/// The least spacing (m) of magnets of this width (m), in tenths of a millimetre.
fn closest(width: f64) -> f64 {
    four_digits((CLOSEST * width * 1e4 - 1e-6).ceil() / 1e4)
}

/// Rounds down to tenths of a millimetre.
fn tenths(length: f64) -> f64 {
    four_digits((length * 1e4 + 1e-6).floor() / 1e4)
}
