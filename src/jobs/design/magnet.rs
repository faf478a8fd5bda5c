//! The keys that describe a magnet, in `[magnet]`, in a face's `magnet = { ... }` and in the
//! entries of `magnets`.

use super::error::{DesignError, Result, Span};
use super::quantity::{self, four_digits};
use super::reader::{Entry, Section};
use physics::order::Order;
use physics::tile::barcode::Pole;
use physics::tile::grade::Grade;
use physics::tile::magnet::Shape;
use physics::tile::strength::{Strength, pull};

/// The magnet keys of one place in the file; keys that are not given are `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MagnetKeys {
    pub size: Option<Size>,
    pub strength: Option<Strength>,
    pub pitch: Option<f64>,
    pub inset: Option<f64>,
    pub axis: Option<AxisDirection>,
}

/// The size of a magnet (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Size {
    /// A block: along its axis, and the two others.
    Block([f64; 3]),
    /// A disc: its height, which is along its axis, and its diameter.
    Disc(Option<f64>, Option<f64>),
}

/// The direction of a magnet's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AxisDirection {
    /// At this angle (rad) from the face's normal.
    Lying(f64),
    /// Out of the tiles' plane.
    Up,
}

/// A magnet by itself.
pub(super) struct Body {
    pub shape: Shape,
    /// Its dimensions, the one along its axis first (m).
    pub size: [f64; 3],
    /// A m^2.
    pub moment: f64,
}

const STRENGTHS: [&str; 5] = ["remanence", "moment", "surface_field", "grade", "pull"];
/// The keys of `[magnet]` and of a face's `magnet`.
pub(super) const MAGNET_KEYS: [&str; 12] = [
    "shape",
    "size",
    "diameter",
    "height",
    "remanence",
    "moment",
    "surface_field",
    "grade",
    "pull",
    "pitch",
    "inset",
    "axis",
];

impl MagnetKeys {
    /// Reads the magnet keys of a table; the caller checks the other keys.
    pub fn read(section: &Section) -> Result<Self> {
        let strength = strength(section);
        let [pitch, inset] = [("pitch", quantity::PITCH), ("inset", quantity::INSET)]
            .map(|(key, quantity)| section.number(key, quantity));
        let axis = section.get("axis").map(|entry| match entry.text() {
            Some(text) if text.starts_with(char::is_alphabetic) => {
                entry.word(&[("up", AxisDirection::Up)])
            }
            _ => entry.number(quantity::AXIS).map(AxisDirection::Lying),
        });
        let axis = axis.transpose();
        Ok(Self {
            size: size(section)?,
            strength: strength?,
            pitch: pitch?,
            inset: inset?,
            axis: axis?,
        })
    }

    /// These keys, with missing ones from `lower`.
    pub fn over(self, lower: Self) -> Self {
        Self {
            size: Size::over(self.size, lower.size),
            strength: self.strength.or(lower.strength),
            pitch: self.pitch.or(lower.pitch),
            inset: self.inset.or(lower.inset),
            axis: self.axis.or(lower.axis),
        }
    }

    /// The keys of the mating magnet.
    pub fn mate(self) -> Self {
        Self {
            axis: self.axis.map(|axis| match axis {
                AxisDirection::Lying(angle) => AxisDirection::Lying(-angle),
                AxisDirection::Up => AxisDirection::Up,
            }),
            ..self
        }
    }

    /// The magnet, if all required keys are given; otherwise the missing key.
    pub fn body(&self) -> std::result::Result<Body, &'static str> {
        let (shape, size) = self.size.ok_or("size")?.describe()?;
        let strength = self.strength.ok_or("remanence")?;
        Ok(Body {
            shape,
            size,
            moment: strength.moment(shape, size),
        })
    }

    /// Its width along a face (m).
    pub fn width(&self) -> Option<f64> {
        let (_, size) = self.size?.describe().ok()?;
        Some(size[1])
    }
}

impl Body {
    /// Its size along the face's normal, along the face and through the tile's thickness (m).
    pub fn in_plane(&self, stands: bool) -> [f64; 3] {
        let [height, width, depth] = self.size;
        match stands {
            true => [depth, width, height],
            false => self.size,
        }
    }
}

impl Size {
    /// A size, with missing dimensions from another one of the same kind.
    fn over(upper: Option<Self>, lower: Option<Self>) -> Option<Self> {
        Some(match (upper, lower) {
            (Some(Self::Disc(height, diameter)), Some(Self::Disc(below, across))) => {
                Self::Disc(height.or(below), diameter.or(across))
            }
            _ => upper.or(lower)?,
        })
    }

    /// The shape and the size, the one along the axis first; or the missing key.
    fn describe(self) -> std::result::Result<(Shape, [f64; 3]), &'static str> {
        Ok(match self {
            Self::Block(size) => (Shape::Block, size),
            Self::Disc(height, diameter) => {
                let diameter = diameter.ok_or("diameter")?;
                (Shape::Disc, [height.ok_or("height")?, diameter, diameter])
            }
        })
    }
}

/// Reads the size of magnets: a block has a size, a disc a diameter and a height.
fn size(section: &Section) -> Result<Option<Size>> {
    let [shape, size, diameter, height] =
        ["shape", "size", "diameter", "height"].map(|key| section.get(key));
    let shape = shape.map(|entry| body_shape(&entry)).transpose()?;
    let of_disc = diameter.as_ref().or(height.as_ref());
    match (shape, &size, of_disc) {
        (Some(Shape::Disc), Some(size), _) => {
            return Err(size.key_error(
                "a disc has no `size`",
                "write its `diameter` and its `height`, which is along its axis",
            ));
        }
        (Some(Shape::Block), _, Some(entry)) | (None, Some(_), Some(entry)) => {
            return Err(entry.key_error(
                format!("a block has no `{}`", entry.key),
                "write its `size`, or shape = \"disc\" with only `diameter` and `height`",
            ));
        }
        _ => {}
    }
    if let Some(entry) = size {
        let what = "along its magnetic axis, along the face, through the tile's thickness";
        return Ok(Some(Size::Block(
            entry.numbers::<3>(quantity::MAGNET_SIZE, what)?,
        )));
    }
    if shape != Some(Shape::Disc) && of_disc.is_none() {
        return Ok(None);
    }
    let length = |entry: Option<Entry>| {
        let entry = entry.map(|entry| entry.number(quantity::MAGNET_SIZE));
        entry.transpose()
    };
    Ok(Some(Size::Disc(length(height)?, length(diameter)?)))
}

/// The shape of magnets; the error for one that is not modelled names the nearest substitute.
fn body_shape(entry: &Entry) -> Result<Shape> {
    let word = entry.string()?.to_lowercase();
    let help = match word.as_str() {
        "cube" | "cuboid" | "bar" | "square" | "rectangle" | "rectangular" | "prism" | "plate" => {
            "it is a block: write \"block\" with its size, such as size = [\"5 mm\", \"5 mm\", \"5 mm\"]"
        }
        "disk" | "cylinder" | "rod" | "puck" | "round" | "coin" | "pin" => {
            "it is a disc: write \"disc\" with its `diameter` and its `height`"
        }
        "sphere" | "ball" => {
            "balls are not modelled. One that is fixed acts as a point dipole of its own volume, outside \
             itself exactly: write a block of the same volume, size = 0.806 of the diameter in all three \
             directions, and [potential] model = \"dipole\". One that turns in its pocket cannot be modelled"
        }
        "ring" | "tube" | "washer" | "countersunk" | "pot" | "cup" => {
            "holes are not modelled. Nearest is a disc of the outer diameter with less remanence, in \
             proportion to the volume: shape = \"disc\", remanence = 1.3 * (1 - (inner / outer)^2); close to \
             its face it pulls too hard"
        }
        "arc" | "segment" | "sector" | "cone" | "horseshoe" | "ellipse" | "hexagon"
        | "triangle" => {
            "only blocks and discs are modelled: write the block or the disc of the same volume that is \
             nearest to it"
        }
        "steel" | "iron" | "soft" => {
            "steel without magnetisation is not modelled as a piece; soft iron behind magnets is: `shield`"
        }
        _ => return entry.word(&[("block", Shape::Block), ("disc", Shape::Disc)]),
    };
    Err(entry.error(format!("`shape` cannot be \"{}\"", entry.string()?), help))
}

/// Reads the strength of magnets, for which a table must use exactly one key.
fn strength(section: &Section) -> Result<Option<Strength>> {
    let mut given: Vec<Entry> = STRENGTHS
        .iter()
        .filter_map(|key| section.get(key))
        .collect();
    given.order_by_key(Entry::span);
    if let [first, second, ..] = given.as_slice() {
        return Err(second.key_error(
            format!(
                "`{}` and `{}` both set the magnet's strength",
                first.key, second.key
            ),
            "keep exactly one of remanence, moment, surface_field, grade and pull",
        ));
    }
    let Some(entry) = given.first() else {
        return Ok(None);
    };
    Ok(Some(match entry.key {
        "moment" => Strength::Moment(entry.number(quantity::MOMENT)?),
        "remanence" => Strength::Remanence(entry.number(quantity::REMANENCE)?),
        "grade" => Strength::Grade(grade(entry)?),
        "pull" => Strength::Pull(entry.number(quantity::PULL)?),
        _ => Strength::SurfaceField(entry.number(quantity::SURFACE_FIELD)?),
    }))
}

/// A grade by its name.
fn grade(entry: &Entry) -> Result<Grade> {
    let name = entry.string()?;
    Grade::named(name).ok_or_else(|| {
        let lower = name.to_lowercase();
        let help = match lower.starts_with("aln") || lower.starts_with("lng") {
            // Its remaining remanence depends on its length and its history.
            true => "short AlNiCo magnets demagnetise themselves: measure the field at the pole, \
                 surface_field = \"60 mT\", or give their pull"
                .to_owned(),
            false => format!(
                "{}; or give remanence = 1.2 (T), or pull = \"1.8 kg\"",
                known(name)
            ),
        };
        entry.error(format!("`grade` cannot be \"{name}\""), help)
    })
}

/// The known grades near to an unknown one, or the kinds of grades.
pub(super) fn known(name: &str) -> String {
    match Grade::near(name).as_slice() {
        [] => {
            let kinds = "use N30 to N56 (also N42SH and similar), Y30 and other ferrites, C5, YXG28 or \
                         SmCo 28";
            kinds.to_owned()
        }
        [one] => format!("the nearest known grade is {one}"),
        [first @ .., last] => format!("known grades near it are {} and {last}", first.join(", ")),
    }
}

/// A remanence (T) far beyond any material; a moment or a surface field that implies more was given
/// in another unit.
const IMPOSSIBLE_REMANENCE: f64 = 10.0;
/// The largest remanence (T) of magnets on the market; if a pull implies more, the pull or the size
/// is wrong.
const STRONGEST: f64 = 1.7;

/// Checks whether the strength of a block is possible.
pub(super) fn impossible(body: &Body, strength: Option<Strength>) -> Option<(String, String)> {
    let Body {
        shape,
        size,
        moment,
    } = *body;
    let remanence = physics::units::MU0 * moment / shape.volume(size);
    if let Some(Strength::Pull(force)) = strength
        && remanence > STRONGEST
    {
        return Some((
            format!(
                "a magnet of {} mm that pulls {} N ({} kg) would have a remanence of {} T",
                size.map(|x| four_digits(x * 1e3).to_string()).join(" x "),
                four_digits(force),
                four_digits(force / 9.806_65),
                four_digits(remanence)
            ),
            format!(
                "the strongest grade, N52, pulls {} kg; the first number of `size` is along the \
                 magnetic axis",
                four_digits(pull(shape, size, 1.46) / 9.806_65)
            ),
        ));
    }
    (remanence > IMPOSSIBLE_REMANENCE).then(|| {
        (
            format!(
                "a magnet of this size and strength would have a remanence of {} T",
                four_digits(remanence)
            ),
            format!(
                "strong magnets have 1.2 T, which for this size is moment = {} A m^2",
                four_digits(moment * 1.2 / remanence)
            ),
        )
    })
}

/// One magnet of a list `magnets = [{ at, pole, ... }]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ListedMagnet {
    pub at: f64,
    pub pole: Pole,
    pub keys: MagnetKeys,
    pub span: Span,
}

impl ListedMagnet {
    /// The keys of an entry of `magnets`.
    pub fn keys() -> Vec<&'static str> {
        ["at", "pole"]
            .into_iter()
            .chain(MAGNET_KEYS.into_iter().filter(|key| *key != "pitch"))
            .collect()
    }

    pub fn read(entry: &Entry) -> Result<Self> {
        let section = entry.section("a magnet of `magnets`")?;
        section.allow(&Self::keys());
        let at = section.require("at", "give its position along the face: at = 0.02 (m)")?;
        let pole = section.require("pole", "give the outward pole: pole = \"N\"")?;
        let at = at.number(quantity::ALONG_FACE);
        let pole = pole.word(&[
            ("N", Pole::North),
            ("S", Pole::South),
            ("U", Pole::Up),
            ("D", Pole::Down),
        ]);
        Ok(Self {
            at: at?,
            pole: pole?,
            keys: MagnetKeys::read(&section)?,
            span: entry.span(),
        })
    }

    /// The magnet that binds it on the mating face, requested at `span`.
    pub fn mate(self, span: Span) -> Self {
        Self {
            at: -self.at,
            pole: self.pole.opposite(),
            keys: self.keys.mate(),
            span,
        }
    }
}

/// A fault for a magnet that lacks `key`.
pub(super) fn missing_key(key: &str, error: impl Fn(String, String) -> DesignError) -> DesignError {
    let (what, example) = match key {
        "pitch" => ("spacing", "pitch = 0.040"),
        "size" => ("size", "size = [0.010, 0.010, 0.003]"),
        "diameter" => ("diameter", "diameter = 0.010"),
        "height" => ("height", "height = 0.003"),
        _ => ("strength", "remanence = 1.2"),
    };
    error(
        format!("the {what} of this magnet is missing"),
        format!("write `{example}` under [magnet] or in this face's `magnet = {{ ... }}`"),
    )
}
