//! Classes of lengths, by which values tabulated over them are found without a search.

/// The number of the class of a length (m, not negative): longer lengths have no smaller one, and those of
/// one class differ by less than a hundredth.
pub fn class_of(length: f64) -> usize {
    (length.to_bits() >> 45) as usize
}

/// The shortest length (m) of a class.
pub fn shortest(class: usize) -> f64 {
    f64::from_bits((class as u64) << 45)
}
