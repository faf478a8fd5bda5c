//! The energy on grids of configurations: all around the fixed tile, and in front of the target
//! face.
//!
//! Every number is the energy of a free configuration. Grids are computed row by row in parallel
//! and gathered in order: the same numbers come out on any number of threads.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::approach::Approach;
use super::map::{evenly, with_energies};
use crate::configuration::{Configuration, wrap_angle};
use crate::problem::Problem;
use crate::tile::symmetry::rotations;

/// U on a grid of three coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Values of the coordinates (m, rad), the slowest first.
    pub axes: [Vec<f64>; 3],
    /// U (J), the last coordinate running fastest; `None` where no free configuration belongs to
    /// the grid point.
    pub energies: Vec<Option<f64>>,
}

impl Volume {
    /// Samples row after row; `configuration` tells the free one at a grid point.
    fn sample(
        problem: &Problem,
        axes: [Vec<f64>; 3],
        configuration: impl Fn([usize; 3]) -> Option<Configuration> + Sync,
    ) -> Self {
        let [planes, rows, columns] = [0, 1, 2].map(|k| axes[k].len());
        let energies = (0..planes * rows)
            .into_par_iter()
            .flat_map_iter(|row| {
                let row: Vec<_> = (0..columns)
                    .map(|column| configuration([row / rows, row % rows, column]))
                    .collect();
                let free: Vec<_> = row.iter().flatten().copied().collect();
                let mut samples = with_energies(problem, &free).into_iter();
                row.into_iter()
                    .map(move |q| q.and_then(|_| samples.next()).map(|sample| sample.energy))
                    .collect::<Vec<_>>()
            })
            .collect();
        Self { axes, energies }
    }
}

/// U(theta, y, x) for `|x|` and `|y|` up to `reach` (m), at `samples` places along the longer of
/// the two. Theta runs over the angle after which the moving tile repeats, in even steps from minus
/// half that angle on, `orientations` of them to a full turn or a few more.
pub fn around(problem: &Problem, reach: [f64; 2], orientations: usize, samples: usize) -> Volume {
    let pair = problem.pair.as_deref();
    let period = pair.map_or(TAU, |pair| TAU / rotations(&pair.moving).len() as f64);
    let count = (orientations as f64 * period / TAU / 2.0).ceil() as usize * 2;
    let step = period / count as f64;
    let thetas: Vec<_> = (0..count)
        .map(|k| step * (k as f64 - (count / 2) as f64))
        .collect();
    let longer = reach[0].max(reach[1]);
    let [x, y] = reach.map(|half| {
        let count = (samples as f64 * half / longer).round() as usize;
        evenly(-half, half, count.max(2))
    });
    Volume::sample(
        problem,
        [thetas.clone(), y.clone(), x.clone()],
        |[plane, row, column]| {
            let q = Configuration::new(x[column], y[row], wrap_angle(thetas[plane]));
            problem.is_clear(&q).then_some(q)
        },
    )
}

/// The energy in front of the target face, and where the moving tile touches.
#[derive(Clone, Debug, PartialEq)]
pub struct InFront {
    /// U(gap, tilt, slide): see [`super::approach::ApproachSlices`].
    pub volume: Volume,
    /// For each tilt and slide, the distance (m) along the target face's normal from the bound
    /// position at which the moving tile, coming from far away, first touches; `None` where it
    /// passes by.
    pub landing: Vec<Option<f64>>,
}

impl InFront {
    /// Samples at these gaps, tilts and slides (m, rad, m), each ascending.
    pub fn new(
        problem: &Problem,
        approach: &Approach,
        gaps: Vec<f64>,
        tilts: Vec<f64>,
        slides: Vec<f64>,
    ) -> Self {
        let columns = slides.len();
        let landing: Vec<_> = (0..tilts.len() * columns)
            .into_par_iter()
            .map(|i| approach.landing(problem, tilts[i / columns], slides[i % columns]))
            .collect();
        let axes = [gaps.clone(), tilts.clone(), slides.clone()];
        let volume = Volume::sample(problem, axes, |[plane, row, column]| {
            let distance = landing[row * columns + column]? + gaps[plane];
            Some(approach.configuration(tilts[row], slides[column], distance))
        });
        Self { volume, landing }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    fn problem(file: &str) -> Problem {
        Design::load(file.as_ref()).unwrap().problem()
    }

    #[test]
    fn around_holds_the_energy_of_each_free_configuration_and_of_no_other() {
        let problem = problem("shapes/tab-10mm.toml");
        let volume = around(&problem, [0.7, 0.5], 8, 21);
        let [thetas, y, x] = &volume.axes;
        assert_eq!((thetas.len(), y.len(), x.len()), (8, 15, 21));
        assert!(thetas.is_sorted() && thetas[0] == -std::f64::consts::PI);
        let mut blocked = 0;
        for (i, energy) in volume.energies.iter().enumerate() {
            let theta = thetas[i / (15 * 21)];
            let q = Configuration::from([x[i % 21], y[i / 21 % 15], theta]);
            assert_eq!(energy.is_some(), problem.is_clear(&q), "{q:?}");
            if let Some(energy) = energy {
                assert!((energy - problem.energy(&q)).abs() <= 1e-12 * energy.abs());
            }
            blocked += usize::from(energy.is_none());
        }
        assert!(blocked > 100 && blocked < volume.energies.len() - 100);
    }

    #[test]
    fn around_covers_what_repeats_once() {
        let problem = problem("shapes/paper-tile.toml");
        let [thetas, ..] = around(&problem, [0.7, 0.7], 16, 5).axes;
        let expected = [-2.0, -1.0, 0.0, 1.0].map(|k| k * TAU / 16.0);
        assert_eq!(thetas, expected);
    }

    #[test]
    fn in_front_the_gap_is_drawn_back_from_touching() {
        let problem = problem("shapes/triangle-teeth-10mm.toml");
        let pair = problem.pair.clone().unwrap();
        let approach = Approach::new(&pair);
        let (tilts, slides) = (vec![-0.2, 0.0, 0.3], vec![-0.05, 0.0, 0.05]);
        let gaps = vec![0.0, 0.02];
        let found = InFront::new(
            &problem,
            &approach,
            gaps.clone(),
            tilts.clone(),
            slides.clone(),
        );
        assert_eq!(found.volume.energies.len(), 18);
        for (i, energy) in found.volume.energies.iter().enumerate() {
            let (gap, tilt, slide) = (gaps[i / 9], tilts[i / 3 % 3], slides[i % 3]);
            let landing = found.landing[i % 9].unwrap();
            let q = approach.configuration(tilt, slide, landing + gap);
            assert!((energy.unwrap() - problem.energy(&q)).abs() <= 1e-12);
            let clearance = problem.clearance(&q);
            if gap == 0.0 {
                assert!(clearance.abs() < 1e-6, "{clearance}");
            } else {
                assert!(clearance > 1e-3 && clearance <= gap + 1e-9, "{clearance}");
            }
        }
        // Flush in the bound configuration.
        assert!(found.landing[4].unwrap().abs() < 1e-9);
    }
}
