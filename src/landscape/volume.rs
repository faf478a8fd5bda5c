//! The energy on grids of configurations: all around the fixed tile, and in front of the target
//! face.
//!
//! Every number is the energy of a free configuration. Grids are computed row by row in parallel
//! and gathered in order: the same numbers come out on any number of threads.

use std::f64::consts::{FRAC_PI_4, TAU};

use super::approach::Approach;
use super::grid::{evenly, sampled};
use tiles::configuration::{Configuration, wrap_angle};
use tiles::parallel;
use tiles::problem::Problem;
use tiles::tile::Pair;
use tiles::tile::symmetry::rotations;

/// Number of orientations of a whole map per full turn of the moving tile, and per period of its
/// symmetry.
const ORIENTATIONS: [usize; 2] = [144, 72];
/// Grid points of a whole map, and the most along a side.
const AROUND: f64 = 400_000.0;
const LONGEST: f64 = 121.0;
/// Gaps, tilts and slides of a map in front of the target face.
const IN_FRONT: [usize; 3] = [25, 61, 61];

/// U on a grid of three coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Values of the coordinates (m, rad), the slowest first.
    pub axes: [Vec<f64>; 3],
    /// U (J), the last coordinate running fastest; `None` if no free configuration belongs to the
    /// grid point.
    pub energies: Vec<Option<f64>>,
}

impl Volume {
    /// Samples row by row; `configuration` gives the free configuration at a grid point.
    fn sample(
        problem: &Problem,
        axes: [Vec<f64>; 3],
        configuration: impl Fn([usize; 3]) -> Option<Configuration> + Sync,
    ) -> Self {
        let [planes, rows, columns] = [0, 1, 2].map(|k| axes[k].len());
        let samples = sampled(problem, [planes * rows, columns], |row, column| {
            configuration([row / rows, row % rows, column])
        });
        let energies = samples.into_iter().map(|sample| Some(sample?.energy));
        let energies = energies.collect();
        Self { axes, energies }
    }
}

/// The whole map around the fixed tile: 72 orientations or more, and as many positions as the number
/// of grid points allows.
pub fn whole(problem: &Problem, pair: &Pair) -> Volume {
    let repeats = rotations(&pair.moving).len();
    let orientations = ORIENTATIONS[usize::from(repeats == 1)];
    let half = problem.space.map_half_size();
    let shape = half[0].min(half[1]) / half[0].max(half[1]);
    let planes = orientations as f64 / repeats as f64;
    let side = (AROUND / planes / shape).sqrt().min(LONGEST);
    around(problem, half, orientations, side as usize)
}

/// The map in front of the target face.
pub fn in_front(problem: &Problem, pair: &Pair) -> InFront {
    let length = pair.target_face().length();
    let [gaps, tilts, slides] = IN_FRONT;
    // Grid points are denser where the energy is steep.
    let gaps = evenly(0.0, 1.0, gaps).into_iter();
    InFront::new(
        problem,
        &Approach::new(pair),
        gaps.map(|u| 0.5 * length * u * u).collect(),
        evenly(-FRAC_PI_4, FRAC_PI_4, tilts),
        evenly(-0.6 * length, 0.6 * length, slides),
    )
}

/// U(theta, y, x) for `|x|` and `|y|` up to `reach` (m), at `samples` places along the longer of
/// the two. Theta runs over the angle after which the moving tile repeats, in even steps from minus
/// half that angle, with `orientations` of them or a few more per full turn.
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
    /// position at which the moving tile, coming from far away, first touches; `None` if it passes
    /// by.
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
        let landing = parallel::map(0..tilts.len() * columns, |i| {
            approach.landing(problem, tilts[i / columns], slides[i % columns])
        });
        let axes = [gaps.clone(), tilts.clone(), slides.clone()];
        let volume = Volume::sample(problem, axes, |[plane, row, column]| {
            let distance = landing[row * columns + column]? + gaps[plane];
            Some(approach.configuration(tilts[row], slides[column], distance))
        });
        Self { volume, landing }
    }
}
