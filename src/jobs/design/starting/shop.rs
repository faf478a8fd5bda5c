//! Magnets as shops describe them: `10 x 5 x 2 mm N42`, or discs: `10 x 3 mm N42`.

use crate::design::quantity::{MAGNET_SIZE, PULL, REMANENCE, four_digits};
use crate::design::{magnet, units};
use physics::tile::grade::Grade;
use physics::tile::magnet::Shape;
use physics::tile::strength::Strength;

/// A magnet as sold in shops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShopMagnet {
    /// Along its magnetic axis, along the face, through the tile's thickness (m).
    pub size: [f64; 3],
    pub(super) shape: Shape,
    strength: Strength,
    /// Whether it is magnetised across the tile.
    pub(super) up: bool,
}

const HELP: &str = "write length x width x height as sold, magnetised along the last: \"10 x 5 x \
    2 mm N42\", or diameter x height of a disc: \"10 x 3 mm N42\"; instead of the grade, a pull \
    (\"1.8 kg\") or a remanence (\"1.2 T\"); and `up` for an axis across the tile";

impl ShopMagnet {
    /// Reads the dimensions of a block (by the shops' convention it is magnetised through the last
    /// one), or the diameter and height of a disc, with a unit, and a grade, a pull or a remanence
    /// before or after them.
    ///
    /// ```
    /// use tilebind_jobs::design::ShopMagnet;
    /// assert_eq!(ShopMagnet::parse("10 x 5 x 2 mm N42")?.size, [0.002, 0.010, 0.005]);
    /// assert_eq!(ShopMagnet::parse("N42 10 x 3 mm disc")?.size, [0.003, 0.010, 0.010]);
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// If it is not such a description; the message says what is missing.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wrong = |what: &str| format!("{what}; {HELP}");
        let (plain, up) = plain(text);
        let parts: Vec<&str> = plain.splitn(3, BY).map(str::trim).collect();
        let (last, before) = parts.split_last().unwrap_or((&"", &[]));
        let (last, unit, rest) = last_length(last)
            .ok_or_else(|| wrong("the lengths have no unit, or an unknown one (use mm, cm, in)"))?;
        // A length has its own unit, or that of the last length.
        let length = |text: &&str| {
            let own = units::read(text, units::LENGTH);
            own.or_else(|| units::read(&format!("{text} {unit}"), units::LENGTH))
        };
        let lengths: Option<Vec<f64>> = before.iter().map(length).chain([Some(last)]).collect();
        let (size, shape) = match lengths.as_deref() {
            // The longer side along the face: that leaves the tile thin.
            Some(&[long, wide, through]) => {
                ([through, long.max(wide), long.min(wide)], Shape::Block)
            }
            Some(&[diameter, height]) => ([height, diameter, diameter], Shape::Disc),
            _ => return Err(wrong("a block has three lengths, a disc two")),
        };
        for length in size {
            let checked = MAGNET_SIZE.check("a length of the magnet", length);
            checked.map_err(|(message, _)| message)?;
        }
        let strength = match rest {
            "" => Strength::Remanence(1.2),
            rest => {
                let unknown = || {
                    wrong(&format!(
                        "`{rest}` is not a known grade: {}",
                        magnet::known(rest)
                    ))
                };
                strength(rest).ok_or_else(unknown)?
            }
        };
        Ok(Self {
            size,
            shape,
            strength,
            up,
        })
    }

    /// Its size along the face's normal, along the face and through the tile (m).
    pub(super) fn in_plane(&self) -> [f64; 3] {
        let [axis, long, short] = self.size;
        match self.up {
            true => [short, long, axis],
            false => self.size,
        }
    }

    /// The lines of a design file for its size.
    /// Those of an upright one are stated with its axis first.
    pub(super) fn lengths(size: [f64; 3], shape: Shape, up: bool) -> String {
        let size = match (up, size) {
            (true, [short, long, axis]) => [axis, long, short],
            (false, size) => size,
        };
        let axis = match up {
            true => {
                "\naxis = \"up\"                  # magnetised across the tile: codes of U and D"
            }
            false => "",
        };
        let along = match up {
            true => "its axis",
            false => "its axis, which is the face's normal",
        };
        let lengths = match (shape, size) {
            (Shape::Block, [a, b, c]) => format!(
                "size = [{a}, {b}, {c}]  # along its axis, along the face, through the thickness"
            ),
            (Shape::Disc, [height, diameter, _]) => format!(
                "shape = \"disc\"\ndiameter = {diameter}\nheight = {height}                # along \
                 {along}"
            ),
        };
        lengths + axis
    }

    /// The line of a design file for its strength.
    pub(super) fn strength(&self) -> String {
        match self.strength {
            Strength::Grade(grade) => format!("grade = \"{}\"", grade.name),
            Strength::Pull(force) => format!(
                "pull = \"{} kg\"               # off thick steel",
                four_digits(force / 9.806_65)
            ),
            Strength::Remanence(remanence) => format!("remanence = {remanence}"),
            _ => String::new(),
        }
    }
}

/// Between the lengths.
const BY: char = '\u{d7}';

/// Normalises the notation: one sign between lengths, `in` for inches, the grade after them, and no
/// redundant words for the form. Also whether it is to be upright.
fn plain(text: &str) -> (String, bool) {
    let text = text
        .replace(['"', '\u{2033}', '\u{201d}'], " in ")
        .replace([',', '\u{d8}', '\u{f8}', '\u{2300}'], " ");
    let text = with_one_sign(&text);
    let is_up = |word: &str| ["up", "upright", "standing"].contains(&word.to_lowercase().as_str());
    let up = text.split_whitespace().any(is_up);
    let is_shape = |word: &&str| {
        ["disc", "disk", "block", "magnet", "cylinder"].contains(&word.to_lowercase().as_str())
    };
    let mut words: Vec<&str> = text
        .split_whitespace()
        .filter(|w| !is_shape(w) && !is_up(w))
        .collect();
    // A grade has up to three words: samarium cobalt 28.
    let leads = |count: &usize| Grade::named(&words[..*count].join(" ")).is_some();
    if let Some(count) = (1..=words.len().min(3)).rev().find(leads) {
        words.rotate_left(count);
    }
    (words.join(" "), up)
}

/// The text with [`BY`] for the `x` or `*` between lengths, but not for that of `YX18`.
fn with_one_sign(text: &str) -> String {
    let sign = |(at, c): (usize, char)| {
        let before = text[..at].trim_end().chars().last();
        let after = text[at + c.len_utf8()..].trim_start().chars().next();
        let between = after.is_some_and(|c| c.is_ascii_digit() || c == '.')
            && !before.is_some_and(|c| c.eq_ignore_ascii_case(&'y'));
        if ['x', 'X', '*'].contains(&c) && between {
            BY
        } else {
            c
        }
    };
    text.char_indices().map(sign).collect()
}

/// A length (m) at the beginning of a text, its unit and what is left.
fn last_length(text: &str) -> Option<(f64, &str, &str)> {
    let unit = text.find(|c: char| c.is_alphabetic())?;
    let after = text[unit..].find(|c: char| !c.is_alphabetic());
    let (length, rest) = text.split_at(after.map_or(text.len(), |at| unit + at));
    Some((
        units::read(length, units::LENGTH)?,
        &length[unit..],
        rest.trim(),
    ))
}

fn strength(text: &str) -> Option<Strength> {
    if let Some(grade) = Grade::named(text) {
        return Some(Strength::Grade(grade));
    }
    let pull = PULL.read(text).map(Strength::Pull);
    let pull = pull.or_else(|| REMANENCE.read(text).map(Strength::Remanence));
    pull.filter(|strength| match strength {
        Strength::Pull(force) => PULL.check("", *force).is_ok(),
        Strength::Remanence(remanence) => REMANENCE.check("", *remanence).is_ok(),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnets_are_read_as_shops_write_them() {
        let n42 = Strength::Grade(Grade::named("N42").unwrap());
        let yx18 = Strength::Grade(Grade::named("YX18").unwrap());
        let [block, disc] = [Shape::Block, Shape::Disc];
        for (text, size, shape, strength) in [
            ("10 x 5 x 2 mm N42", [0.002, 0.010, 0.005], block, n42),
            ("5x10x2mm, N42", [0.002, 0.010, 0.005], block, n42),
            (
                "1 cm \u{d7} 5 mm \u{d7} 2 mm N42SH",
                [0.002, 0.010, 0.005],
                block,
                n42,
            ),
            (
                "10*5*2 mm",
                [0.002, 0.010, 0.005],
                block,
                Strength::Remanence(1.2),
            ),
            (
                "1/2 x 1/4 x 1/8 in N42",
                [0.003175, 0.0127, 0.00635],
                block,
                n42,
            ),
            (
                "1/2\" x 1/4\" x 1/8\" N42",
                [0.003175, 0.0127, 0.00635],
                block,
                n42,
            ),
            ("N42 10 x 5 x 2 mm block", [0.002, 0.010, 0.005], block, n42),
            ("\u{d8}10 x 3 mm N42", [0.003, 0.010, 0.010], disc, n42),
            ("10x3mm YX18", [0.003, 0.010, 0.010], disc, yx18),
            (
                "samarium cobalt YX18 10 X 3 mm",
                [0.003, 0.010, 0.010],
                disc,
                yx18,
            ),
            (
                "Disc N42, 1/2\" x 1/8\"",
                [0.003175, 0.0127, 0.0127],
                disc,
                n42,
            ),
            (
                "10 x 5 x 2 mm 1.1 T",
                [0.002, 0.010, 0.005],
                block,
                Strength::Remanence(1.1),
            ),
            (
                "10 x 5 x 2 mm 18 N",
                [0.002, 0.010, 0.005],
                block,
                Strength::Pull(18.0),
            ),
        ] {
            let read = ShopMagnet::parse(text);
            assert_eq!(
                read,
                Ok(ShopMagnet {
                    size,
                    shape,
                    strength,
                    up: false,
                }),
                "{text}"
            );
        }
        let up = ShopMagnet::parse("6 x 3 mm disc N42 up").unwrap();
        assert!(up.up && up.in_plane() == [0.006, 0.006, 0.003]);
        for text in [
            "",
            "10 mm",
            "10 x 5 x 2 x 1 mm",
            "10 x 5 x 2",
            "10 x 5 x 2 mm N43",
            "10 x 5 x 2 m",
            "a x b x c mm",
        ] {
            assert!(ShopMagnet::parse(text).is_err(), "{text}");
        }
    }
}
