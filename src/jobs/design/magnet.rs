//! The keys that describe a magnet, in `[magnet]`, in a face's `magnet = { ... }` and in the
//! entries of `magnets`.

use super::error::{DesignError, Result, Span};
use super::quantity::{self, four_digits};
use super::reader::{Entry, Section};
use physics::order::Order;
use physics::tile::barcode::Pole;
use physics::tile::grade::Grade;
use physics::tile::strength::{Strength, pull};

/// The magnet keys of one place in the file; what is not given there is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MagnetKeys {
    pub size: Option<[f64; 3]>,
    pub strength: Option<Strength>,
    pub pitch: Option<f64>,
    pub inset: Option<f64>,
    pub axis: Option<f64>,
}

const STRENGTHS: [&str; 5] = ["remanence", "moment", "surface_field", "grade", "pull"];
/// The keys of `[magnet]` and of a face's `magnet`.
pub(super) const MAGNET_KEYS: [&str; 9] = [
    "size",
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
    /// Reads what a table says of a magnet; which other keys it may hold is the caller's affair.
    pub fn read(section: &Section) -> Result<Self> {
        let size = section
            .get("size")
            .map(|entry| {
                let what = "along its magnetic axis, along the face, through the tile's thickness";
                entry.numbers::<3>(quantity::MAGNET_SIZE, what)
            })
            .transpose();
        let strength = strength(section);
        let [pitch, inset, axis] = [
            ("pitch", quantity::PITCH),
            ("inset", quantity::INSET),
            ("axis", quantity::AXIS),
        ]
        .map(|(key, quantity)| section.number(key, quantity));
        Ok(Self {
            size: size?,
            strength: strength?,
            pitch: pitch?,
            inset: inset?,
            axis: axis?,
        })
    }

    /// These keys, and those of `lower` where these are silent.
    pub fn over(self, lower: Self) -> Self {
        Self {
            size: self.size.or(lower.size),
            strength: self.strength.or(lower.strength),
            pitch: self.pitch.or(lower.pitch),
            inset: self.inset.or(lower.inset),
            axis: self.axis.or(lower.axis),
        }
    }

    /// The keys of the mating magnet.
    pub fn mate(self) -> Self {
        Self {
            axis: self.axis.map(|axis| -axis),
            ..self
        }
    }

    /// The size and the moment (A m^2), both of which a magnet must have.
    pub fn block(&self) -> std::result::Result<([f64; 3], f64), &'static str> {
        let size = self.size.ok_or("size")?;
        let strength = self.strength.ok_or("remanence")?;
        Ok((size, strength.moment(size)))
    }
}

/// The one way in which a table says how strong its magnets are.
fn strength(section: &Section) -> Result<Option<Strength>> {
    let mut given: Vec<Entry> = STRENGTHS
        .iter()
        .filter_map(|key| section.get(key))
        .collect();
    given.order_by_key(Entry::span);
    if let [first, second, ..] = given.as_slice() {
        return Err(second.key_error(
            format!(
                "`{}` and `{}` both say how strong the magnet is",
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
            // What is left of its remanence depends on its length and on what it has been through.
            true => {
                "short magnets of AlNiCo lose most of their remanence by themselves: measure \
                     the field at the pole, surface_field = \"60 mT\", or give their pull"
            }
            false => {
                "known are N35 to N52 (also N42SH and the like), Y30 and other ferrite, YXG28 \
                      or SmCo 28; or give remanence = 1.2 (T), or pull = \"1.8 kg\""
            }
        };
        entry.error(format!("`grade` cannot be \"{name}\""), help)
    })
}

/// The remanence (T) that no material comes near; a moment or a surface field that asks for more
/// was given in another unit.
const IMPOSSIBLE_REMANENCE: f64 = 10.0;
/// The largest remanence (T) of magnets that can be bought; what a pull says beyond it, the pull or
/// the size is wrong.
const STRONGEST: f64 = 1.7;

/// What is wrong with the strength of a block, if anything.
pub(super) fn impossible(
    size: [f64; 3],
    strength: Option<Strength>,
    moment: f64,
) -> Option<(String, String)> {
    let remanence = physics::units::MU0 * moment / size.iter().product::<f64>();
    if let Some(Strength::Pull(force)) = strength
        && remanence > STRONGEST
    {
        return Some((
            format!(
                "a block of {} mm that pulls {} N ({} kg) would have a remanence of {} T",
                size.map(|x| four_digits(x * 1e3).to_string()).join(" x "),
                four_digits(force),
                four_digits(force / 9.806_65),
                four_digits(remanence)
            ),
            format!(
                "the strongest, N52, pulls {} kg; the first number of `size` is the one that it is \
                 magnetised through",
                four_digits(pull(size, 1.46) / 9.806_65)
            ),
        ));
    }
    (remanence > IMPOSSIBLE_REMANENCE).then(|| {
        (
            format!(
                "a block of this size and strength would have a remanence of {} T",
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
        let at = section.require("at", "say where along the face it sits: at = 0.02 (m)")?;
        let pole = section.require("pole", "say which pole points outwards: pole = \"N\"")?;
        let at = at.number(quantity::ALONG_FACE);
        let pole = pole.word(&[("N", Pole::North), ("S", Pole::South)]);
        Ok(Self {
            at: at?,
            pole: pole?,
            keys: MagnetKeys::read(&section)?,
            span: entry.span(),
        })
    }

    /// The magnet that binds it on the mating face, which `span` asks for.
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
        _ => ("strength", "remanence = 1.2"),
    };
    error(
        format!("the {what} of this magnet is not given"),
        format!("write `{example}` under [magnet] or in this face's `magnet = {{ ... }}`"),
    )
}
