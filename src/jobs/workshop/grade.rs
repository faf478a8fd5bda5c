//! Magnets of the catalogue.

/// Grades of sintered neodymium magnets by their remanence (T), typical of what makers state (N42:
/// 1.29 to 1.32 T, for example).
pub const GRADES: [(&str, f64); 8] = [
    ("N35", 1.19),
    ("N38", 1.24),
    ("N40", 1.27),
    ("N42", 1.30),
    ("N45", 1.35),
    ("N48", 1.40),
    ("N50", 1.43),
    ("N52", 1.46),
];

/// How far (T) from a grade's remanence magnets of that grade may be.
const SPREAD: f64 = 0.03;

/// The grade nearest to a remanence (T), and its own; `None` where none is near.
///
/// ```
/// use tilebind_jobs::workshop::grade::nearest;
/// assert_eq!(nearest(1.2), Some(("N35", 1.19)));
/// assert_eq!(nearest(0.4), None);
/// ```
pub fn nearest(remanence: f64) -> Option<(&'static str, f64)> {
    let distance = |grade: &(&str, f64)| (grade.1 - remanence).abs();
    let nearest = GRADES
        .into_iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.filter(|grade| distance(grade) <= SPREAD)
}
