//! The figures that stay comparable between machines, for the history in `results/bench.csv`.

/// Prints the median of ratios, each of two times (or rates) taken in the same round, as
/// `history.py` reads it: `ratio NAME VALUE`. Returns it.
pub fn ratio(name: &str, rounds: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = rounds.collect();
    values.sort_by(f64::total_cmp);
    let median = values[values.len() / 2];
    println!("ratio {name} {median:.3}");
    median
}
