//! Halving an interval in which a condition ceases to hold.

/// The last place where `holds` and the next where it does not, after this many halvings of the way from
/// a place where it holds to one where it does not.
///
/// ```
/// use tilebind_tiles::bisection::bisected;
/// assert_eq!(bisected(0.0, 1.0, 3, |x| x < 0.3), [0.25, 0.375]);
/// assert_eq!(bisected(1.0, 0.0, 1, |x| x > 0.3), [0.5, 0.0]);
/// ```
pub fn bisected(
    mut inside: f64,
    mut outside: f64,
    halvings: u32,
    mut holds: impl FnMut(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = (inside + outside) / 2.0;
        match holds(middle) {
            true => inside = middle,
            false => outside = middle,
        }
    }
    [inside, outside]
}
