//! Grades of magnets as sold, and the remanence of each.
//!
//! A grade guarantees an energy product; the corresponding remanence (T) has a range. The value
//! used is the middle of the range, rounded to 0.01 T.
//!
//! Sources: for neodymium, tables of Shanghai Magnet, Jofov and Brisingi, which agree to 0.02 T
//! (N42: 1.28 to 1.32 T); for ferrite, the Chinese standard SJ/T 10410 as printed by Ao Magnet; for
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
pub const NEODYMIUM: [Grade; 12] = [
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
];

/// Hard ferrite, and American names of it.
const FERRITE: [Grade; 19] = [
    grade("Y10T", 0.20, 0.22, 0.235),
    grade("Y20", 0.32, 0.35, 0.38),
    grade("Y22H", 0.31, 0.34, 0.36),
    grade("Y25", 0.36, 0.38, 0.40),
    grade("Y26H", 0.36, 0.38, 0.39),
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
    grade("C10", 0.40, 0.41, 0.42),
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

impl Grade {
    /// The grade with this trade name: in upper or lower case, with or without a space or a hyphen,
    /// the letters for temperature and the leading `N`.
    ///
    /// ```
    /// use tilebind_physics::tile::grade::Grade;
    /// assert_eq!(Grade::named("n42 sh"), Grade::named("N42"));
    /// assert_eq!(Grade::named("Y30BH").unwrap().remanence, [0.38, 0.39, 0.40]);
    /// assert_eq!(Grade::named("N43"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        let plain: String = name
            .chars()
            .filter(|c| !c.is_whitespace() && *c != '-')
            .flat_map(char::to_uppercase)
            .collect();
        let mut all = NEODYMIUM.iter().chain(&FERRITE).chain(&SAMARIUM);
        if let Some(grade) = all.clone().find(|grade| grade.name == plain) {
            return Some(*grade);
        }
        // `42SH` is N42SH; `SmCo28` the 2:17 of that number; `Y30H1` one of the kinds of Y30H.
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
                b'Y' if own.starts_with("YX") => {
                    let number = own.trim_start_matches(|c: char| !c.is_ascii_digit());
                    let smco = own.starts_with("YXG") && plain == format!("SMCO{number}");
                    smco || rest.is_some_and(|rest| SUFFIXES.contains(&rest))
                }
                _ => rest.is_some_and(|rest| rest == "1" || rest == "2"),
            }
        };
        all.find(known).copied()
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
        ] {
            assert_eq!(found(name), Some(expected), "{name}");
        }
        for name in ["", "N", "42", "N43", "N42X", "iron", "N420", "Y300"] {
            assert_eq!(found(name), None, "{name}");
        }
    }

    #[test]
    fn ranges_are_in_order_and_neodymium_rises() {
        for grade in NEODYMIUM.iter().chain(&FERRITE).chain(&SAMARIUM) {
            let [least, usual, most] = grade.remanence;
            assert!(0.0 < least && least < usual && usual < most, "{grade:?}");
        }
        assert!(NEODYMIUM.is_sorted_by(|a, b| a.remanence[1] < b.remanence[1]));
    }
}
