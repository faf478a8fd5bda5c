//! The quantities of a design file: their units, and the magnitudes that are implausible.

use std::f64::consts::{PI, TAU};

use super::units::{self, Units};
use physics::units::to_digits;

/// A kind of quantity, with its range for tiles and magnets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantity {
    kind: Dimension,
    sign: Sign,
    /// Magnitudes accepted without question.
    accepted: (f64, f64),
    /// Magnitudes that may be proposed.
    typical: (f64, f64),
}

/// A dimension with its units.
#[derive(Clone, Copy, Debug)]
struct Dimension {
    /// The symbol of the unit after a number: `m`.
    unit: &'static str,
    /// The message for a user who used another unit.
    rule: &'static str,
    /// Other units that may have been meant: how many make one, and their name.
    others: &'static [(f64, &'static str)],
    /// Units allowed after a number in quotes.
    units: Units,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Sign {
    Positive,
    NotNegative,
    Any,
}

const LENGTH: Dimension = Dimension {
    unit: "m",
    rule: "lengths are in metres",
    others: &[(100.0, "cm"), (1000.0, "mm")],
    units: units::LENGTH,
};
const ANGLE: Dimension = Dimension {
    unit: "rad",
    rule: "angles are in radians",
    others: &[(180.0 / PI, "degrees")],
    units: units::ANGLE,
};
const WEIGHT: Dimension = Dimension {
    unit: "kg",
    rule: "masses are in kilograms",
    others: &[(1000.0, "g")],
    units: units::MASS,
};
const FIELD: Dimension = Dimension {
    unit: "T",
    rule: "remanence and surface field are in tesla",
    others: &[(1000.0, "mT"), (1e4, "G")],
    units: units::FIELD,
};
const FORCE: Dimension = Dimension {
    unit: "N",
    rule: "a pull is in newtons, or in kilograms as shops state it: pull = \"1.8 kg\"",
    others: &[],
    units: units::FORCE,
};
const DIPOLE: Dimension = Dimension {
    unit: "A m^2",
    rule: "magnetic moments are in A m^2",
    others: &[(1000.0, "mA m^2, or emu")],
    units: units::MOMENT,
};

const fn share(rule: &'static str) -> Dimension {
    Dimension {
        unit: "",
        rule,
        others: &[(100.0, "%")],
        units: units::SHARE,
    }
}

impl Dimension {
    const fn positive(self, accepted: (f64, f64), typical: (f64, f64)) -> Quantity {
        self.signed(Sign::Positive, accepted, typical)
    }

    const fn not_negative(self, most: f64, typical: (f64, f64)) -> Quantity {
        self.signed(Sign::NotNegative, (0.0, most), typical)
    }

    const fn any(self, most: f64, typical: (f64, f64)) -> Quantity {
        self.signed(Sign::Any, (0.0, most), typical)
    }

    const fn signed(self, sign: Sign, accepted: (f64, f64), typical: (f64, f64)) -> Quantity {
        Quantity {
            kind: self,
            sign,
            accepted,
            typical,
        }
    }
}

pub(super) const TILE_SIDE: Quantity = LENGTH.positive((1e-3, 10.0), (0.01, 2.0));
pub(super) const TILE_CORNER: Quantity = LENGTH.any(10.0, (0.01, 2.0));
pub(super) const TILE_THICKNESS: Quantity = LENGTH.positive((1e-5, 0.5), (5e-4, 0.1));
pub(super) const TABLE_SIZE: Quantity = LENGTH.positive((1e-3, 100.0), (0.1, 10.0));
pub(super) const MAGNET_SIZE: Quantity = LENGTH.positive((1e-5, 0.5), (5e-4, 0.05));
pub(super) const PITCH: Quantity = LENGTH.positive((1e-5, 2.0), (1e-3, 0.2));
pub(super) const INSET: Quantity = LENGTH.not_negative(0.5, (1e-4, 0.05));
pub(super) const FIT: Quantity = LENGTH.not_negative(0.05, (1e-5, 5e-3));
pub(super) const PROFILE_WIDTH: Quantity = LENGTH.positive((1e-4, 10.0), (1e-3, 2.0));
pub(super) const PROFILE_DEPTH: Quantity = LENGTH.any(1.0, (1e-4, 0.1));
pub(super) const ALONG_FACE: Quantity = LENGTH.any(10.0, (1e-3, 2.0));
/// A user unit of a drawing: from that of 25,400 dots per inch to drawings in metres.
pub(super) const DRAWING_UNIT: Quantity = LENGTH.positive((1e-6, 1.0), (1e-5, 0.01));
/// Dots per inch of a drawing.
pub(super) const DPI: Quantity = Dimension {
    unit: "",
    rule: "a user unit of the drawing is an inch over `dpi`",
    others: &[],
    units: &[("dpi", 1.0), ("ppi", 1.0)],
}
.positive((1.0, 25_400.0), (10.0, 2400.0));
/// The draft of a side: below a right angle.
pub(super) const DRAFT: Quantity = ANGLE.any(1.5, (0.0, 1.5));
/// A direction: up to a full turn either way.
pub(super) const AXIS: Quantity = ANGLE.any(TAU, (0.0, TAU));
/// The share of the energy that a shield removes behind it, at short distance.
pub(super) const ATTENUATION: Quantity =
    share("the attenuation is a fraction").not_negative(1.0, (0.0, 1.0));
pub(super) const SHIELD_LENGTH: Quantity = LENGTH.positive((1e-4, 10.0), (1e-3, 1.0));
/// The width of the passage from a shield's front to its back, in the cosine of the angle.
pub(super) const SHIELD_WIDTH: Quantity =
    share("the width is a difference of cosines").positive((1e-3, 10.0), (1e-3, 10.0));
pub(super) const FRONT_GAIN: Quantity =
    share("the gain is a factor, 1 for a shield that only attenuates")
        .positive((0.1, 10.0), (0.1, 10.0));
/// The mass of a tile.
pub(super) const MASS: Quantity = WEIGHT.positive((1e-9, 1e3), (1e-3, 10.0));
pub(super) const REMANENCE: Quantity = FIELD.positive((1e-3, 2.5), (0.05, 1.6));
pub(super) const SURFACE_FIELD: Quantity = FIELD.positive((1e-5, 1.25), (0.01, 0.8));
/// The pull-off force of a magnet from thick steel.
pub(super) const PULL: Quantity = FORCE.positive((1e-4, 1e5), (0.01, 2e3));
pub(super) const MOMENT: Quantity = DIPOLE.positive((1e-9, 1e4), (1e-4, 100.0));

impl Quantity {
    /// Checks `value`, given for `what`; otherwise returns what is wrong with it and the fix.
    pub fn check(&self, what: &str, value: f64) -> Result<(), (String, String)> {
        let help = |text: &str| format!("{text}; {}", self.kind.rule);
        let value_and_unit = self.with_unit(value);
        let wrong = if !value.is_finite() {
            Some((
                format!("{what} is {value}, which is not a number"),
                "give a finite number",
            ))
        } else if self.sign == Sign::Positive && value <= 0.0 {
            let message = format!("{what} must be above zero, not {value_and_unit}");
            Some((message, "give a positive number"))
        } else if self.sign == Sign::NotNegative && value < 0.0 {
            let message = format!("{what} must not be negative: {value_and_unit}");
            Some((message, "give zero or a positive number"))
        } else {
            None
        };
        if let Some((message, fix)) = wrong {
            return Err((message, help(fix)));
        }
        let (low, high) = self.accepted;
        if (low..=high).contains(&value.abs()) {
            return Ok(());
        }
        let size = if value.abs() < low { "small" } else { "large" };
        let high = self.with_unit(high);
        let limits = match low > 0.0 {
            true => format!("from {} to {high}", short(low)),
            false => format!("up to {high}"),
        };
        let message = match self.proposals(value).as_slice() {
            [] => format!("{what} = {value_and_unit} is too {size} for a tile"),
            proposals => format!(
                "{what} = {value_and_unit}: did you mean {}?",
                proposals.join(" or ")
            ),
        };
        Err((message, help(&format!("{what} must be {limits}"))))
    }

    /// A number with a unit, converted to the file's own unit.
    pub fn read(&self, text: &str) -> Option<f64> {
        units::read(text, self.kind.units)
    }

    /// The units allowed after a number in quotes.
    pub fn unit_names(&self) -> impl Iterator<Item = &'static str> {
        self.kind.units.iter().map(|(name, _)| *name)
    }

    /// What follows the number in a quoted text, unless it is an allowed unit.
    pub fn unknown_unit<'a>(&self, text: &'a str) -> Option<&'a str> {
        let text = text.trim();
        let starts_unit = |c: char| !c.is_ascii_digit() && !"+-.".contains(c);
        let (number, unit) = text.split_at(text.find(starts_unit)?);
        let unit = unit.trim();
        let is_known = self.unit_names().any(|name| name == unit);
        (number.trim().parse::<f64>().is_ok() && unit.chars().all(char::is_alphabetic) && !is_known)
            .then_some(unit)
    }

    /// An example of how to write a quoted number correctly.
    pub fn example(&self, text: &str) -> String {
        let with_unit = self.kind.units.iter().find(|(_, factor)| *factor > 1.0);
        let (name, _) = with_unit.unwrap_or(&self.kind.units[0]);
        let with_point = text.replacen(',', ".", 1);
        if text.matches(',').count() == 1 && self.read(&with_point).is_some() {
            return format!(
                "use a decimal point, not a comma: \"{}\"",
                with_point.trim()
            );
        }
        let number = with_point.trim().parse::<f64>();
        match number.ok().filter(|x| x.is_finite()) {
            Some(value) => {
                let meant = self.meant(value);
                format!(
                    "a number in quotes needs a unit: write {}",
                    meant.join(", or ")
                )
            }
            None => {
                let names: Vec<_> = self.unit_names().collect();
                format!(
                    "write a number, or a number with one of these units in quotes, such as \"5 {name}\": {}",
                    names.join(", ")
                )
            }
        }
    }

    /// Possible meanings of a quoted number without a unit: without the quotes, or with units in
    /// which it has a common magnitude.
    fn meant(&self, value: f64) -> Vec<String> {
        let (low, high) = self.typical;
        let common = |meant: f64| (low..=high).contains(&meant.abs());
        let plain = format!("{value} without the quotes");
        let own = match self.kind.unit {
            "" => plain,
            unit => format!("{plain} for {unit}"),
        };
        let mut factors: Vec<f64> = Vec::new();
        let others = self.kind.units.iter().filter(|(_, factor)| {
            let first = *factor != 1.0 && !factors.contains(factor) && common(value / factor);
            factors.push(*factor);
            first
        });
        let others: Vec<String> = others
            .map(|(name, _)| format!("\"{value} {name}\""))
            .collect();
        match others.is_empty() {
            true => vec![own],
            false if common(value) => [vec![own], others].concat(),
            false => [others, vec![own]].concat(),
        }
    }

    /// A valid magnitude close to the intended one, in place of an invalid one.
    pub fn guess(&self, value: f64) -> f64 {
        let (low, high) = self.typical;
        let mut meant = self.kind.others.iter().map(|(factor, _)| value / factor);
        let meant = meant.find(|meant| (low..=high).contains(&meant.abs()));
        let (low, high) = self.accepted;
        let sign = if self.sign == Sign::Any { value } else { 1.0 };
        meant
            .filter(|meant| self.sign == Sign::Any || *meant >= 0.0)
            .unwrap_or_else(|| value.abs().clamp(low, high).copysign(sign))
    }

    /// Possible meanings of an unusually large magnitude; `None` if it is not.
    pub fn doubt(&self, value: f64) -> Option<Vec<String>> {
        (value.abs() > self.typical.1).then(|| self.proposals(value))
    }

    /// A number with its unit, if there is one.
    fn with_unit(&self, value: f64) -> String {
        let value = short(value);
        format!("{value} {}", self.kind.unit).trim_end().to_owned()
    }

    fn proposals(&self, value: f64) -> Vec<String> {
        let (low, high) = self.typical;
        self.kind
            .others
            .iter()
            .map(|(factor, name)| (value / factor, name))
            .filter(|(meant, _)| (low..=high).contains(&meant.abs()))
            .map(|(meant, name)| format!("{} ({value} {name})", four_digits(meant)))
            .collect()
    }
}

/// A number without more zeros than are easily counted.
pub(crate) fn short(value: f64) -> String {
    match value.abs() {
        0.0 | 1e-5..1e15 => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// A positive limit to three significant digits, never above it.
pub(super) fn rounded_down(limit: f64) -> f64 {
    let scale = 10_f64.powi(2 - libm::log10(limit.abs()).floor() as i32);
    four_digits((limit * scale * (1.0 - 1e-12)).floor() / scale)
}

/// A number to four significant digits, without trailing zeros.
pub(super) fn four_digits(value: f64) -> f64 {
    to_digits(value, 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(quantity: Quantity, value: f64) -> String {
        quantity.check("`it`", value).unwrap_err().0
    }

    #[test]
    fn a_wrong_unit_gets_a_question() {
        assert_eq!(
            message(TILE_SIDE, 430.0),
            "`it` = 430 m: did you mean 0.43 (430 mm)?"
        );
        assert_eq!(
            message(TILE_SIDE, 43.0),
            "`it` = 43 m: did you mean 0.43 (43 cm) or 0.043 (43 mm)?"
        );
        assert_eq!(
            message(DRAFT, -17.0),
            "`it` = -17 rad: did you mean -0.2967 (-17 degrees)?"
        );
        assert!(message(REMANENCE, 12000.0).contains("1.2 (12000 G)"));
    }

    #[test]
    fn what_no_unit_explains_is_refused_without_a_guess() {
        assert!(message(TILE_SIDE, 1e9).contains("too large for a tile"));
        for (quantity, value) in [(TILE_SIDE, 1e-6), (MASS, 1e-320), (REMANENCE, 1e-4)] {
            let told = message(quantity, value);
            assert!(told.ends_with("too small for a tile"), "{told}");
            assert!(told.len() < 60, "{told}");
        }
        assert!(message(TILE_SIDE, f64::NAN).contains("not a number"));
        assert!(message(TILE_SIDE, 0.0).contains("above zero"));
        assert!(message(INSET, -0.001).contains("must not be negative"));
    }

    #[test]
    fn the_paper_s_numbers_pass() {
        for (quantity, value) in [
            (TILE_SIDE, 0.43),
            (MAGNET_SIZE, 0.003),
            (REMANENCE, 1.2),
            (MOMENT, 0.2865),
            (INSET, 0.0),
            (TABLE_SIZE, 2.0),
        ] {
            assert_eq!(quantity.check("it", value), Ok(()));
        }
    }
}
