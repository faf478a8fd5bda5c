//! The nearest magnets of the catalogue.

use physics::tile::grade::{Grade, NEODYMIUM};

/// Largest deviation (T) of a magnet's remanence from that of its grade.
const SPREAD: f64 = 0.03;

/// Common grades: N35 to N52, weakest first.
pub fn sold() -> &'static [Grade] {
    &NEODYMIUM[2..10]
}

/// The grade nearest to a remanence (T), and its remanence; `None` if none is near.
///
/// ```
/// use tilebind_jobs::workshop::grade::nearest;
/// assert_eq!(nearest(1.2), Some(("N35", 1.19)));
/// assert_eq!(nearest(0.4), None);
/// ```
pub fn nearest(remanence: f64) -> Option<(&'static str, f64)> {
    let distance = |grade: &Grade| (grade.remanence[1] - remanence).abs();
    let nearest = sold()
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let nearest = nearest.filter(|grade| distance(grade) <= SPREAD);
    nearest.map(|grade| (grade.name, grade.remanence[1]))
}
