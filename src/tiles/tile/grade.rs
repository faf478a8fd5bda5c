//! Grades of magnets as sold, and the remanence of each.
//!
//! A grade guarantees an energy product; the corresponding remanence (T) has a range. The value
//! used is the middle of the range, rounded to 0.01 T, less the magnet's own demagnetising field
//! ([`super::demagnetising`]).
//!
//! Sources: for neodymium, tables of Shanghai Magnet, Jofov and Brisingi, which agree to 0.02 T
//! (N42: 1.28 to 1.32 T; N56 is in the first only); for ferrite, the Chinese standard SJ/T 10410 as
//! printed by Ao Magnet, and for C8B, C9, C11 and C12 the American one as printed by Jingxin; for
//! samarium cobalt, Horizon Magnets. The letters after the number (N42M, N42SH) give the
//! temperature up to which a magnet keeps its strength, not the strength.

/// A grade and its remanence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grade {
    /// Its trade name: `N42`.
    pub name: &'static str,
    /// Lowest, usual and highest remanence (T).
    pub remanence: [f64; 3],
}

/// Letters after a grade of neodymium or samarium cobalt for its maximum temperature.
const SUFFIXES: [&str; 9] = ["M", "H", "SH", "UH", "EH", "AH", "TH", "VH", "T"];

const fn grade(name: &'static str, least: f64, usual: f64, most: f64) -> Grade {
    Grade {
        name,
        remanence: [least, usual, most],
    }
}

/// Sintered neodymium, from weak to strong.
pub const NEODYMIUM: [Grade; 13] = [
    grade("N30", 1.08, 1.11, 1.14),
    grade("N33", 1.13, 1.15, 1.18),
    grade("N35", 1.17, 1.19, 1.22),
    grade("N38", 1.22, 1.24, 1.26),
    grade("N40", 1.25, 1.27, 1.29),
    grade("N42", 1.28, 1.30, 1.32),
    grade("N45", 1.32, 1.35, 1.38),
    grade("N48", 1.37, 1.40, 1.43),
    grade("N50", 1.39, 1.43, 1.45),
    grade("N52", 1.42, 1.46, 1.48),
    grade("N54", 1.44, 1.47, 1.50),
    grade("N55", 1.45, 1.48, 1.51),
    grade("N56", 1.46, 1.48, 1.50),
];

/// Hard ferrite, and American names of it.
const FERRITE: [Grade; 26] = [
    grade("Y8T", 0.20, 0.22, 0.235),
    grade("Y10T", 0.20, 0.22, 0.235),
    grade("Y20", 0.32, 0.35, 0.38),
    grade("Y22H", 0.31, 0.34, 0.36),
    grade("Y25", 0.36, 0.38, 0.40),
    grade("Y26H", 0.36, 0.38, 0.39),
    grade("Y27H", 0.37, 0.385, 0.40),
    grade("Y28", 0.37, 0.38, 0.40),
    grade("Y28H", 0.36, 0.38, 0.40),
    grade("Y30", 0.37, 0.39, 0.40),
    grade("Y30H", 0.38, 0.39, 0.40),
    grade("Y30BH", 0.38, 0.39, 0.40),
    grade("Y32", 0.40, 0.41, 0.42),
    grade("Y33", 0.41, 0.42, 0.43),
    grade("Y35", 0.40, 0.42, 0.45),
    grade("Y40", 0.44, 0.45, 0.46),
    grade("C1", 0.20, 0.22, 0.235),
    grade("C5", 0.37, 0.38, 0.40),
    grade("C7", 0.33, 0.34, 0.36),
    grade("C8", 0.38, 0.39, 0.40),
    grade("C8A", 0.38, 0.39, 0.40),
    grade("C8B", 0.40, 0.41, 0.42),
    grade("C9", 0.37, 0.38, 0.39),
    grade("C10", 0.40, 0.41, 0.42),
    grade("C11", 0.41, 0.42, 0.43),
    grade("C12", 0.39, 0.40, 0.41),
];

/// Samarium cobalt, 1:5 (YX) and 2:17 (YXG).
const SAMARIUM: [Grade; 11] = [
    grade("YX16", 0.79, 0.82, 0.85),
    grade("YX18", 0.84, 0.87, 0.90),
    grade("YX20", 0.89, 0.92, 0.94),
    grade("YX22", 0.92, 0.94, 0.96),
    grade("YX24", 0.95, 0.98, 1.00),
    grade("YXG22", 0.93, 0.95, 0.97),
    grade("YXG24", 0.95, 0.99, 1.02),
    grade("YXG26", 1.02, 1.04, 1.05),
    grade("YXG28", 1.03, 1.06, 1.08),
    grade("YXG30", 1.08, 1.09, 1.10),
    grade("YXG32", 1.10, 1.13, 1.15),
];

/// The words for materials, longest first, each with the letters of its grades and all of them.
const MATERIALS: [(&str, (&str, &[Grade])); 9] = [
    ("SAMARIUMCOBALT", ("YX", &SAMARIUM)),
    ("NEODYMIUM", ("N", &NEODYMIUM)),
    ("HARDFERRITE", ("Y", &FERRITE)),
    ("FERRITE", ("Y", &FERRITE)),
    ("CERAMIC", ("C", &FERRITE)),
    ("SM2CO17", ("YXG", &SAMARIUM)),
    ("NDFEB", ("N", &NEODYMIUM)),
    ("SMCO", ("YX", &SAMARIUM)),
    ("NEO", ("N", &NEODYMIUM)),
];

fn all() -> impl Iterator<Item = &'static Grade> + Clone {
    NEODYMIUM.iter().chain(&FERRITE).chain(&SAMARIUM)
}

/// A name's material, and the name in capitals without it, spaces and hyphens. `Ceramic 5` is C5.
fn plain(name: &str) -> (Option<(&'static str, &'static [Grade])>, String) {
    let kept = name
        .chars()
        .filter(|c| !c.is_whitespace() && !['-', '/', ':'].contains(c));
    let text: String = kept.flat_map(char::to_uppercase).collect();
    let text = text.strip_prefix("GRADE").unwrap_or(&text);
    for (word, material) in MATERIALS {
        if let Some(rest) = text.strip_prefix(word) {
            let is_number = rest.starts_with(|c: char| c.is_ascii_digit());
            let letters = match material.0 {
                // The 2:17 is what is sold by this name.
                "YX" if is_number => "YXG",
                letters if is_number => letters,
                _ => "",
            };
            return (Some(material), format!("{letters}{rest}"));
        }
    }
    (None, text.to_owned())
}

/// The letters before a number in a name, and the number.
fn parts(name: &str) -> (&str, Option<f64>) {
    let digits = name
        .find(|c: char| c.is_ascii_digit())
        .unwrap_or(name.len());
    let (letters, rest) = name.split_at(digits);
    let end = rest
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(rest.len());
    (letters, rest[..end].parse().ok())
}

/// The names of the grades with the next lower and the next higher number, or with that number.
fn nearest(grades: impl Iterator<Item = &'static Grade> + Clone, number: f64) -> Vec<&'static str> {
    let numbers = grades.clone().filter_map(|grade| parts(grade.name).1);
    let below = numbers
        .clone()
        .filter(|it| *it <= number)
        .fold(f64::NAN, f64::max);
    let above = numbers.filter(|it| *it >= number).fold(f64::NAN, f64::min);
    let is_near = |grade: &&Grade| {
        parts(grade.name)
            .1
            .is_some_and(|number| [below, above].contains(&number))
    };
    grades.filter(is_near).map(|grade| grade.name).collect()
}

impl Grade {
    /// The grade with this trade name: in upper or lower case, with or without a space or a hyphen,
    /// the material, the letters for temperature and the leading `N`.
    ///
    /// ```
    /// use tilebind_tiles::tile::grade::Grade;
    /// assert_eq!(Grade::named("n42 sh"), Grade::named("N42"));
    /// assert_eq!(Grade::named("ferrite Y30BH").unwrap().remanence, [0.38, 0.39, 0.40]);
    /// assert_eq!(Grade::named("N43"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        let (_, plain) = plain(name);
        let mut all = all();
        if let Some(grade) = all.clone().find(|grade| grade.name == plain) {
            return Some(*grade);
        }
        // `42SH` is N42SH; `Y30H1` one of the kinds of Y30H.
        let known = |grade: &&Grade| {
            let own = grade.name;
            let rest = plain.strip_prefix(own);
            match own.as_bytes()[0] {
                b'N' => {
                    let bare = plain.strip_prefix(&own[1..]);
                    [rest, bare.filter(|rest| !rest.is_empty())]
                        .into_iter()
                        .flatten()
                        .any(|rest| SUFFIXES.contains(&rest))
                }
                b'Y' if own.starts_with("YX") => rest.is_some_and(|rest| SUFFIXES.contains(&rest)),
                _ => rest.is_some_and(|rest| rest == "1" || rest == "2"),
            }
        };
        all.find(known).copied()
    }

    /// The names of the known grades that are nearest to an unknown one: of its material, or with its
    /// letters and the next lower and higher number; none if neither is known.
    ///
    /// ```
    /// use tilebind_tiles::tile::grade::Grade;
    /// assert_eq!(Grade::near("N38.5"), ["N38", "N40"]);
    /// assert_eq!(Grade::near("SmCo").len(), 11);
    /// ```
    pub fn near(name: &str) -> Vec<&'static str> {
        let (material, plain) = plain(name);
        if plain.is_empty() {
            let all = material.map_or(&[][..], |material| material.1);
            return all.iter().map(|grade| grade.name).collect();
        }
        let (letters, number) = parts(&plain);
        let letters = match (letters, material) {
            ("", None) => "N",
            ("", Some(material)) => material.0,
            (letters, _) => letters,
        };
        let of = |grade: &&Grade| parts(grade.name).0 == letters;
        number.map_or_else(Vec::new, |number| nearest(all().filter(of), number))
    }

    /// The range of the energy of two such magnets, as factors of the energy at the usual
    /// remanence: it is proportional to the square of the remanence.
    pub fn energy_range(&self) -> [f64; 2] {
        let [least, usual, most] = self.remanence;
        [least, most].map(|limit| (limit / usual) * (limit / usual))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grades_are_found_as_sellers_write_them() {
        let found = |name: &str| Grade::named(name).map(|grade| grade.name);
        for (name, expected) in [
            ("N42", "N42"),
            ("n42", "N42"),
            ("N-42", "N42"),
            ("N35H", "N35"),
            ("48 EH", "N48"),
            ("Y30", "Y30"),
            ("y30bh", "Y30BH"),
            ("Y30H-1", "Y30H"),
            ("SmCo 28", "YXG28"),
            ("YXG30H", "YXG30"),
            ("C8", "C8"),
            ("N35-UH", "N35"),
            ("Neodymium N42", "N42"),
            ("NdFeB 42", "N42"),
            ("ferrite Y35", "Y35"),
            ("Ceramic 5", "C5"),
            ("ceramic C8", "C8"),
            ("Samarium Cobalt 26", "YXG26"),
            ("SmCo YX18", "YX18"),
        ] {
            assert_eq!(found(name), Some(expected), "{name}");
        }
        for name in ["", "N", "42", "N43", "N42X", "iron", "N420", "Y300"] {
            assert_eq!(found(name), None, "{name}");
        }
    }

    #[test]
    fn near_grades_are_named() {
        for (name, near) in [
            ("N38.5", &["N38", "N40"][..]),
            ("N43SH", &["N42", "N45"]),
            ("43", &["N42", "N45"]),
            ("N60", &["N56"]),
            ("Y29", &["Y28", "Y28H", "Y30", "Y30H", "Y30BH"]),
            ("C6", &["C5", "C7"]),
            ("SmCo 29", &["YXG28", "YXG30"]),
            ("YX17", &["YX16", "YX18"]),
            ("iron", &[]),
            ("", &[]),
        ] {
            assert_eq!(Grade::near(name), near, "{name}");
        }
        assert_eq!(Grade::near("ferrite").len(), FERRITE.len());
    }

    #[test]
    fn ranges_are_in_order_and_neodymium_rises() {
        for grade in NEODYMIUM.iter().chain(&FERRITE).chain(&SAMARIUM) {
            let [least, usual, most] = grade.remanence;
            assert!(0.0 < least && least < usual && usual < most, "{grade:?}");
        }
        let rises = |a: &Grade, b: &Grade| {
            a.remanence[0] < b.remanence[0] && a.remanence[1] <= b.remanence[1]
        };
        assert!(NEODYMIUM.is_sorted_by(rises));
    }
}
