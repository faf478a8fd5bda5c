//! Random choices.

/// A choice in proportion to weights: the one in which `rest`, from 0 to their sum, falls.
pub fn chosen(weights: impl IntoIterator<Item = f64>, mut rest: f64) -> usize {
    let mut last = 0;
    for (k, weight) in weights.into_iter().enumerate() {
        if weight <= 0.0 {
            continue;
        }
        last = k;
        if rest < weight {
            break;
        }
        rest -= weight;
    }
    last
}
