//! Soft-iron shields: the section `[shield]`, a tile's `shield` and a face's.

use super::error::{DesignError, Result, Span};
use super::quantity::{self, Quantity};
use super::reader::{Entry, Section};
use physics::potential::shielding::{Shield, ShieldRule};

/// The constants of a shield, with their keys.
pub(super) const CONSTANTS: [(&str, Quantity); 4] = [
    ("attenuation", quantity::ATTENUATION),
    ("length", quantity::SHIELD_LENGTH),
    ("width", quantity::SHIELD_WIDTH),
    ("front_gain", quantity::FRONT_GAIN),
];

/// The shield keys of one place in the file; `None` if not given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ShieldKeys {
    constants: [Option<f64>; CONSTANTS.len()],
    /// Whether there is a shield, and where the file states it.
    present: Option<(bool, Span)>,
}

impl ShieldKeys {
    /// The `shield` of a tile or a face, a table of constants, `true` or `false`; a message calls
    /// the table `name`.
    pub fn read<'a>(section: &Section<'a>, name: &'a str) -> Result<Self> {
        let Some(entry) = section.get("shield") else {
            return Ok(Self::default());
        };
        let mut keys = Self {
            present: Some((true, entry.key_span)),
            ..Self::default()
        };
        if let Some(present) = entry.boolean() {
            keys.present = Some((present, entry.key_span));
            return Ok(keys);
        }
        let section = entry.section(name)?;
        section.allow(&CONSTANTS.map(|(name, _)| name));
        keys.constants = constants(&section)?;
        Ok(keys)
    }

    /// These keys, with missing ones from `lower`.
    pub fn over(self, lower: Self) -> Self {
        Self {
            constants: std::array::from_fn(|i| self.constants[i].or(lower.constants[i])),
            present: self.present.or(lower.present),
        }
    }

    /// The shield of a face that these keys describe; `tile` and `face` are its names.
    pub fn shield(&self, section: &Section, tile: &str, face: &str) -> Result<Option<Shield>> {
        let Some((true, span)) = self.present else {
            return Ok(None);
        };
        let needed = |i: usize| {
            self.constants[i].ok_or_else(|| {
                section.source.error(
                    span,
                    format!("the shield of {tile}.{face} has no `{}`", CONSTANTS[i].0),
                    "a shield needs `attenuation` (0 to 1), `length` (m) and `width`, here or in \
                     [shield]; fit them to measurements with `tilebind calibrate`",
                )
            })
        };
        Ok(Some(Shield {
            attenuation: needed(0)?,
            length: needed(1)?,
            width: needed(2)?,
            front_gain: self.constants[3].unwrap_or(1.0),
        }))
    }

    /// A warning if the file describes shields that its rule does not use.
    pub fn doubt(&self, section: &Section) -> Option<DesignError> {
        let (_, span) = self.present?;
        Some(section.source.doubt(
            span,
            "the nearest-face rule ignores shield constants and `shield = false`",
            "remove them, or write rule = \"smooth\" under [shield]",
        ))
    }
}

/// Reads `[shield]`: the rule, and the constants of every face's shield.
pub(super) fn read(root: &Section) -> Result<(ShieldRule, ShieldKeys)> {
    let Some(section) = root.section("shield", "[shield]")? else {
        return Ok(Default::default());
    };
    let mut known = vec!["rule"];
    known.extend(CONSTANTS.map(|(name, _)| name));
    section.allow(&known);
    let rule = section.get("rule");
    let rule = rule.map(|entry| entry.word(&ShieldRule::NAMES));
    let first: Option<Entry> = CONSTANTS.iter().find_map(|(name, _)| section.get(name));
    let keys = ShieldKeys {
        constants: constants(&section)?,
        present: first.map(|entry| (true, entry.key_span)),
    };
    Ok((rule.transpose()?.unwrap_or_default(), keys))
}

fn constants(section: &Section) -> Result<[Option<f64>; CONSTANTS.len()]> {
    let [attenuation, length, width, front_gain] =
        CONSTANTS.map(|(name, quantity)| section.number(name, quantity));
    Ok([attenuation?, length?, width?, front_gain?])
}
