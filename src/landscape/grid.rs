//! Energies of free configurations on grids.

use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// Values on a grid, row by row from the lowest y; `None` if no free configuration belongs to the
/// grid point.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    /// Abscissas (m, or rad where the grid says so), ascending.
    pub x: Vec<f64>,
    /// Ordinates (m), ascending.
    pub y: Vec<f64>,
    /// One value per grid point.
    pub values: Vec<Option<T>>,
}

impl<T> Grid<T> {
    /// The value at a grid point.
    pub fn value(&self, column: usize, row: usize) -> Option<&T> {
        self.values[row * self.x.len() + column].as_ref()
    }
}

/// A free configuration and its energy U (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where the tiles do not overlap.
    pub configuration: Configuration,
    /// U there (J).
    pub energy: f64,
}

/// `count` numbers from `low` to `high`, both included.
pub fn evenly(low: f64, high: f64, count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count)
        .map(|i| low + (high - low) * i as f64 / last)
        .collect()
}

/// Samples of a grid with the given numbers of rows and columns, row by row; `configuration` gives
/// the free configuration at a row and a column.
pub(super) fn sampled(
    problem: &Problem,
    [rows, columns]: [usize; 2],
    configuration: impl Fn(usize, usize) -> Option<Configuration> + Sync,
) -> Vec<Option<Sample>> {
    parallel::flat_map(0..rows, |row| {
        let row: Vec<_> = (0..columns)
            .map(|column| configuration(row, column))
            .collect();
        let free: Vec<_> = row.iter().flatten().copied().collect();
        let mut samples = with_energies(problem, &free).into_iter();
        let sample = |q: Option<Configuration>| q.and_then(|_| samples.next());
        row.into_iter().map(sample).collect::<Vec<_>>()
    })
}

/// Configurations with their energies, evaluated together.
pub(super) fn with_energies(problem: &Problem, free: &[Configuration]) -> Vec<Sample> {
    let mut energies = vec![0.0; free.len()];
    problem.potential().energies(free, &mut energies);
    free.iter()
        .zip(energies)
        .map(|(&configuration, energy)| Sample {
            configuration,
            energy,
        })
        .collect()
}
