//! The design file: a pair of tiles in TOML, read and checked.
//!
//! [`Design::load`] turns a file into a [`Pair`] of tiles, the configuration in which they are
//! meant to bind, and the table they float on. All mistakes in a file are found here and reported
//! as a [`DesignError`] with line, column and fix, so that all tiles beyond this point are valid.
//! Lengths are in m, masses in kg, angles in rad, fields in T, moments in A m^2; a number in quotes
//! may carry another unit: `"12 cm"`, `"100 g"`, `"30 deg"`, `"300 mT"`. All mistakes in a file are
//! reported together, as far as it can be read.
//!
//! The meaning of keys that leave a choice:
//!
//! - `[tile]` describes both tiles, as does `[fixed]` with `moving = "fixed"`: they are of one kind,
//!   and a face that `mates` another is the complement of that face of the same tile.
//! - The bond is every contact equal to the target: by turns of the tiles onto themselves, by
//!   exchange of equal tiles, and of other faces that are drawn like the target faces and carry the
//!   same magnets. `[target] only = true` makes it the stated contact alone.
//! - A face's own entry overrides `all` key by key. `code`, `magnets` or `profile` in a face's own
//!   entry override a `mates` of `all`.
//! - A mate takes over its partner's line, code or magnets *and* its `magnet` keys (with another
//!   pitch or size it would not be the complement); `magnet` keys given for the mate itself take
//!   precedence.
//! - The outermost point of a magnet's block is `inset` behind the outline at the magnet's s,
//!   measured along the face's normal. For a block along the normal this is the centre of its outer
//!   pole face. At a step of the outline, the lower side counts; on a face drawn back by `fit`, the
//!   line drawn back.
//! - `[shield]` gives the constants of every face's soft-iron shield: `attenuation` (A), `length`
//!   (l, m), `width` (delta) and `front_gain` (G, default 1), see
//!   [`physics::potential::shielding`]. `shield` under `[fixed]` or `[moving]`, and in a face's
//!   entry, overrides them key by key; `shield = false` removes the shield. A mate does not take
//!   over its partner's shield, which is iron of the other tile. `[shield] rule = "nearest-face"`
//!   takes no constants.
//! - Drawings (`shape = "svg"` of a profile, `outline` of a tile) are SVG files; their paths are
//!   relative to the design file's folder. The module `svg` below describes how they are read:
//!   sizes in physical units or with a `unit` or `dpi`, curves to within 1/2150 of the drawn
//!   shape's size. A face of a drawn outline follows its drawn line unless it has a `profile` or
//!   `mates`.
//! - Faces that meet may differ by less than a cutter resolves, up to 50 um or a thousandth of
//!   their length: see `tolerance` for how they are treated.
//! - `axis` turns a magnet counter-clockwise from the face's outward normal (`N`) or from its
//!   opposite (`S`). It also moves the magnet's centre along the normal, so that its outermost corner
//!   keeps the inset.

mod base;
mod blocks;
mod build;
mod doubts;
pub(crate) mod drawings;
mod error;
mod face;
mod faults;
pub(crate) mod file;
mod inset;
mod magnet;
mod overlap;
mod placement;
mod potential;
mod profile;
pub(crate) mod quantity;
mod reader;
mod schema;
mod shield;
mod source;
mod starting;
mod svg;
mod syntax;
mod target;
mod tile;
mod tolerance;
pub(crate) mod units;
mod weight;
mod word_places;
mod word_set;
mod word_stage;
pub mod written;

pub use drawings::Drawing;
pub use error::{DesignError, FilePlace};
pub(crate) use file::read_text;
pub use physics::potential::MagnetModel;
pub(crate) use reader::nearest_help;
pub use schema::{SCHEMA, STARTER};
pub(crate) use starting::check_name;
pub use starting::{Material, ProfileShape, ShopMagnet, Start, StartError};
pub use units::{angle, area, density, energy, frequency, length, rate, speed, spin, time};
pub use weight::Weight;
pub use word_set::WordSet;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use toml::de::DeTable;

use crate::checksum::sha256;
use crate::text::{decode, is_invisible};
use build::BuiltTile;
use drawings::Drawings;
use error::Result;
use face::FaceContent;
use faults::Faults;
use magnet::{MAGNET_KEYS, MagnetKeys};
use physics::configuration::{Configuration, ConfigurationSpace};
use physics::potential::Interaction;
use physics::potential::shielding::{ShieldRule, Shields};
use physics::problem::Problem;
use physics::tile::congruence::congruence;
use physics::tile::strength::Strength;
use physics::tile::{Magnet, Pair};
use reader::Section;
use source::Source;
use target::Bound;
use tile::{ONE_TILE, TILES, TileEntry};

/// A pair of tiles and how they are meant to bind.
///
/// ```
/// use tilebind_jobs::design::Design;
///
/// # std::env::set_current_dir("../..")?;
/// let design = Design::load("shapes/paper-tile.toml".as_ref())?;
/// assert_eq!(design.pair.bound.to_array(), [0.43, 0.0, 0.0]);
/// assert_eq!(design.pair.fixed.magnets.len(), 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Design {
    /// The design's name; by default the file's.
    pub name: String,
    /// The design's description; empty if there is none.
    pub description: String,
    /// SHA-256 of the file's bytes, in hexadecimal.
    pub sha256: String,
    /// Size of the air table (m) along x and along y.
    pub table: [f64; 2],
    /// Whether it is round; its diameter is its size along x and along y. Analyses of pairs of tiles use
    /// the square around it.
    pub is_round: bool,
    /// The two tiles and their intended bond.
    pub pair: Arc<Pair>,
    /// The magnet model, and the shields behind the magnets.
    pub interaction: Interaction,
    /// Distance between centres of neighbouring magnets (m), as given in `[magnet]`.
    pub pitch: Option<f64>,
    /// The kinds of magnets specified by a shop's grade or pull, each with its size (m).
    pub sold: Vec<(Strength, Magnet)>,
    /// The drawings that the design refers to.
    pub drawings: Vec<Drawing>,
    /// Non-fatal warnings, such as a magnet whose corners break through a curved surface.
    pub warnings: Vec<DesignError>,
}

/// Largest relative difference of mass and thickness of tiles of one kind.
const SAME_BODY: f64 = 1e-3;

const ROOT_KEYS: [&str; 10] = [
    "name",
    "description",
    "table",
    "magnet",
    "fixed",
    "moving",
    "tile",
    "target",
    "potential",
    "shield",
];

impl Design {
    /// Reads a design file.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a valid design.
    pub fn load(path: &Path) -> Result<Self> {
        let file = path.display().to_string();
        let bytes = file::read(path).map_err(|error| {
            let message = format!("cannot read the design file: {error}");
            let help = "check the path; shipped designs are in shapes/";
            DesignError::new(&file, None, message, help)
        })?;
        let checksum = sha256(&bytes);
        match decode(bytes.clone()) {
            Ok(text) => Ok(Self {
                sha256: checksum,
                ..Self::parse(&text, &file)?
            }),
            Err(error) => {
                let text = String::from_utf8_lossy(&bytes[..error.at]);
                let place = FilePlace::of(&text, text.len()..text.len());
                Err(DesignError::new(
                    &file,
                    Some(place),
                    "the file is not text in UTF-8 or UTF-16",
                    "save it as UTF-8",
                ))
            }
        }
    }

    /// Reads a design from the text of its file; `file` is its name, for messages and as the
    /// default name of the design.
    ///
    /// # Errors
    /// If the text is not a valid design.
    pub fn parse(text: &str, file: &str) -> Result<Self> {
        Self::read(text, file, Drawings::default())
    }

    /// Reads a design whose drawings are given as text, by their names in the design.
    ///
    /// # Errors
    /// If the text is not a valid design.
    pub fn parse_with(text: &str, file: &str, drawings: &BTreeMap<String, String>) -> Result<Self> {
        Self::read(text, file, Drawings::new(Some(drawings)))
    }

    fn read(text: &str, file: &str, drawings: Drawings) -> Result<Self> {
        let faults = Faults::default();
        let source = Source {
            file,
            text,
            quoted: true,
            drawings: &drawings,
            faults: &faults,
        };
        let design = syntax::parse(source).and_then(|root| Self::of(source, &root));
        let design = faults.conclude(design)?;
        let (used, skipped) = drawings.finish();
        let mut warnings = design.warnings;
        warnings.extend(skipped);
        Ok(Self {
            drawings: used,
            warnings,
            ..design
        })
    }

    /// The design of a file; reads as much of it as possible before it reports faults.
    fn of(source: Source, root: &DeTable) -> Result<Self> {
        let faults = source.faults;
        let root = Section::root(source, root, "the design file");
        root.allow(&ROOT_KEYS);
        let table = table(&root);
        let keys = magnet_keys(&root);
        let model = potential::read(&root, MagnetModel::default());
        let name = root.get("name").map(|name| name.line()).transpose();
        let description = root.string("description");
        let entries = tile_entries(&root)?;
        let target = target::read(&root, &entries);
        let shields = shields(&root, &entries);
        let contents = tile::resolve(&entries, keys.clone().unwrap_or_default());
        // From here on parts are combined, each of which is valid by itself.
        faults.check()?;
        let ((table, is_round), keys, contents, target) = (table?, keys?, contents?, target?);
        let [fixed, moving] = [0, 1].map(|i| build::build(&entries[i], &contents[i]));
        let mut built = [fixed?, moving?];
        let (bound, too_near) = bound(&target, &entries, &contents, &mut built)?;
        let mut warnings = overlap::check_magnets(&entries, &built)?;
        let (shields, doubt) = shields?;
        warnings.extend(doubt);
        warnings.extend(doubts::find(&root, &entries, &contents, table));
        warnings.extend(doubts::masses(&entries, &built));
        let sold = sold(&built);
        let [fixed, moving] = built.map(|built| built.tile);
        warnings.extend(too_near);
        warnings.extend(target.doubt);
        // What is odd about [tile] is found with both tiles.
        let mut told: Vec<DesignError> = Vec::new();
        warnings.retain(|it| {
            let is_new = !told.iter().any(|known| known == it);
            is_new.then(|| told.push(it.clone())).is_some()
        });
        let design = Self {
            name: name?.map_or_else(|| stem(source.file), str::to_owned),
            description: description?.unwrap_or_default().to_owned(),
            sha256: sha256(source.text),
            table,
            is_round,
            pair: Arc::new(Pair {
                bound,
                target: target.faces,
                only: target.only,
                fixed,
                moving,
            }),
            interaction: Interaction {
                model: model?,
                shields,
            },
            pitch: keys.pitch,
            sold,
            drawings: Vec::new(),
            warnings,
        };
        design.check_table(&root)?;
        Ok(design)
    }

    /// The same design with tiles that are drawn about their centres of mass: distances of reference
    /// points are then those of centres, wherever a drawing has its origin. Poses change, see
    /// [`Pair::pose_of`].
    #[must_use]
    pub fn centred(&self) -> Self {
        Self {
            pair: Arc::new(self.pair.centred()),
            ..self.clone()
        }
    }

    /// The space of configurations of the moving tile: its reference point is on the table, rho is
    /// its radius of gyration, and the tiles are free of each other where the circles around their
    /// reference points are.
    pub fn space(&self) -> ConfigurationSpace {
        ConfigurationSpace {
            half_size: self.table.map(|size| size / 2.0),
            rho: self.pair.moving.radius_of_gyration(),
            free_distance: self.pair.free_distance(),
        }
    }

    /// Whether both tiles are of one kind, drawn in the same frame: congruent, with the same magnets,
    /// shields and mass, to the tolerances of making.
    pub fn is_of_one_kind(&self) -> bool {
        let Pair { fixed, moving, .. } = &*self.pair;
        let near = |a: f64, b: f64| (a - b).abs() <= SAME_BODY * a.max(b);
        let shields = &self.interaction.shields;
        near(fixed.mass, moving.mass)
            && near(fixed.thickness, moving.thickness)
            && shields.fixed == shields.moving
            && congruence(fixed, moving).is_some_and(|map| map.to_array() == [0.0; 3])
    }

    /// The problem of the design.
    pub fn problem(&self) -> Problem {
        Problem::new(self.space(), self.pair.clone(), &self.interaction)
    }

    /// Checks that the tiles can bind and come apart on the table.
    fn check_table(&self, root: &Section) -> Result<()> {
        let space = self.space();
        let entry = root
            .require("table", TABLE_HELP)?
            .section("[table]")?
            .require(if self.is_round { "diameter" } else { "size" }, TABLE_HELP)?;
        let [x, y] = space.half_size;
        if !space.contains(&self.pair.bound) {
            return Err(entry.error(
                "the bound configuration is off the table",
                "make the table larger",
            ));
        }
        if libm::hypot(x, y) <= space.free_distance {
            let needed = quantity::four_digits(3.0 * space.free_distance);
            return Err(entry.error(
                "the table is too small for the tiles to separate",
                format!("make it larger: size = [{needed}, {needed}]"),
            ));
        }
        Ok(())
    }
}

/// The bound configuration, and a warning if the target faces overlap a little there; if necessary,
/// the moving tile is rebuilt with its face drawn back by the overlap.
fn bound(
    target: &target::Target,
    entries: &[TileEntry; 2],
    contents: &[Vec<FaceContent>; 2],
    built: &mut [BuiltTile; 2],
) -> Result<(Configuration, Option<DesignError>)> {
    let met = target.meet(&built[0].tile, &built[1].tile)?;
    let overlap = match met {
        Bound::At(bound, doubt) => return Ok((bound, doubt)),
        Bound::Overlap(overlap) => overlap,
    };
    // With a tolerance for rounded corners.
    let drawn = overlap * (1.0 + 1e-6);
    let mut moving = contents[1].clone();
    moving[target.faces.1].fit += drawn;
    built[1] = build::build(&entries[1], &moving)?;
    let doubt = target.overlapping(
        overlap,
        &format!(
            "the moving face is drawn back by {}, as by `fit`",
            tolerance::micrometres(drawn)
        ),
    );
    match target.meet(&built[0].tile, &built[1].tile)? {
        Bound::At(bound, _) => Ok((bound, Some(doubt))),
        // Not the face's line but something beside it is in the way.
        Bound::Overlap(_) => Err(target.blocked(overlap)),
    }
}

/// The kinds of magnets whose strength is a grade or a pull, and that strength.
fn sold(built: &[BuiltTile; 2]) -> Vec<(Strength, Magnet)> {
    let mut sold = Vec::new();
    for tile in built {
        for (magnet, placing) in tile.tile.magnets.iter().zip(&tile.placings) {
            if let Some(strength @ (Strength::Grade(_) | Strength::Pull(_))) = placing.strength
                && !sold.iter().any(|known: &(Strength, Magnet)| {
                    known.0 == strength && known.1.is_sold_as(magnet)
                })
            {
                sold.push((strength, magnet.clone()));
            }
        }
    }
    sold
}

const TABLE_HELP: &str = "give the size of the table: [table] with size = [2.0, 2.0] (m), or with shape = \
                          \"disc\" and diameter = 0.25 (m)";

const TABLE_KEYS: [&str; 3] = ["size", "shape", "diameter"];

/// The size of the table (m) along x and y, and whether it is round.
fn table(root: &Section) -> Result<([f64; 2], bool)> {
    let section = root.require("table", TABLE_HELP)?.section("[table]")?;
    section.allow(&TABLE_KEYS);
    let is_round = match section.get("shape") {
        None => false,
        Some(shape) => match shape.string()? {
            "rectangle" => false,
            "disc" => true,
            _ => {
                let help = "write shape = \"rectangle\" (the default) with size, or shape = \"disc\" with diameter";
                return Err(shape.error("a table has no such shape", help));
            }
        },
    };
    let [wanted, other] = if is_round {
        ["diameter", "size"]
    } else {
        ["size", "diameter"]
    };
    if let Some(odd) = section.get(other) {
        let help = "a round table has shape = \"disc\" and a diameter, a rectangular one a size";
        return Err(odd.error(
            format!("`{other}` does not fit the shape of the table"),
            help,
        ));
    }
    let entry = section.require(wanted, TABLE_HELP)?;
    let size = match is_round {
        true => [entry.number(quantity::TABLE_SIZE)?; 2],
        false => entry.numbers::<2>(quantity::TABLE_SIZE, "along x and along y")?,
    };
    Ok((size, is_round))
}

fn magnet_keys(root: &Section) -> Result<MagnetKeys> {
    let Some(section) = root.section("magnet", "[magnet]")? else {
        return Ok(MagnetKeys::default());
    };
    section.allow(&MAGNET_KEYS);
    MagnetKeys::read(&section)
}

/// The shields of both tiles, and a warning if the file describes shields that have no effect.
fn shields(root: &Section, entries: &[TileEntry; 2]) -> Result<(Shields, Option<DesignError>)> {
    let (rule, keys) = shield::read(root)?;
    let mut shields = Shields {
        rule,
        ..Shields::default()
    };
    if rule == ShieldRule::NearestFace {
        let [fixed, moving] = [entries[0].shield_keys(keys)?, entries[1].shield_keys(keys)?];
        let doubt = fixed
            .iter()
            .chain(&moving)
            .find_map(|keys| keys.doubt(root));
        return Ok((shields, doubt));
    }
    shields.fixed = entries[0].shields(keys)?;
    shields.moving = entries[1].shields(keys)?;
    Ok((shields, None))
}

/// The entries of the fixed and of the moving tile; both are those of `[tile]` if there is one, and
/// those of `[fixed]` if the file says `moving = "fixed"`.
fn tile_entries<'a>(root: &Section<'a>) -> Result<[TileEntry<'a>; 2]> {
    let read = |key, name, faces_name| {
        let help = format!("describe it under {name}: side, thickness, mass, faces");
        let section = root.require(key, &help)?.section(name)?;
        TileEntry::read(key, section, faces_name)
    };
    let fixed = || read(TILES[0], "[fixed]", "[fixed.faces]");
    if let Some(one) = root.get(ONE_TILE) {
        if let Some(other) = TILES.iter().find_map(|key| root.get(key)) {
            let message = format!("[tile] describes both tiles, and so does `{}`", other.key);
            return Err(other.key_error(message, "keep [tile], or [fixed] and [moving]"));
        }
        let section = one.section("[tile]")?;
        let tile = || TileEntry::read(ONE_TILE, section, "[tile.faces]");
        return Ok([tile()?, tile()?]);
    }
    if let Some(same) = root.get(TILES[1]).filter(|entry| entry.text().is_some()) {
        same.word(&[(TILES[0], ())])?;
        return Ok([fixed()?, fixed()?]);
    }
    if TILES.iter().all(|key| root.get(key).is_none()) {
        return Err(root.error(
            "the design has no tiles",
            "describe them under [fixed] and [moving], or under [tile] if both are equal",
        ));
    }
    let moving = read(TILES[1], "[moving]", "[moving.faces]");
    Ok([fixed()?, moving?])
}

fn stem(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default();
    stem.to_string_lossy().replace(is_invisible, "\u{fffd}")
}
