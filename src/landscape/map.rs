//! The map of the lowest energy over theta at each (x, y).
//!
//! Every number is the energy of a free configuration, so that no map shows an energy that only
//! overlapping tiles could have. Grids are computed row by row in parallel and gathered in order:
//! the same numbers come out on any number of threads.

use nalgebra::{Rotation2, Vector2};

use super::grid::{Grid, Sample, evenly};
use super::orientation::{Found, OrientationSearch};
use tiles::bisection::bisected;
use tiles::parallel;
use tiles::problem::Problem;
use tiles::tile::Pair;

/// Grid points along the longer side of a plot's map.
const SAMPLES: f64 = 160.0;
/// The same for outlines with many parts, for which contact queries are expensive.
const SAMPLES_OF_MANY_PARTS: f64 = 96.0;
const MANY_PARTS: usize = 200;
/// Orientations at each grid point of a plot's map.
const ORIENTATIONS: usize = 48;

/// A rectangle of the plane with a grid on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Where the grid's origin lies in the fixed tile's frame (m).
    pub origin: Vector2<f64>,
    /// Direction of the grid's x axis in the fixed tile's frame (rad).
    pub angle: f64,
    /// Lowest x and y on the grid (m).
    pub low: [f64; 2],
    /// Highest x and y on the grid (m).
    pub high: [f64; 2],
    /// Grid points along x and along y, at least two.
    pub samples: [usize; 2],
}

impl Window {
    /// The window from `low` to `high` with `samples` grid points along its longer side.
    pub fn new(origin: Vector2<f64>, angle: f64, [low, high]: [[f64; 2]; 2], samples: f64) -> Self {
        let span = [high[0] - low[0], high[1] - low[1]];
        let longer = span[0].max(span[1]);
        Self {
            origin,
            angle,
            low,
            high,
            samples: span.map(|s| ((samples * s / longer).round() as usize).max(2)),
        }
    }

    /// A point of the grid in the fixed tile's frame (m).
    fn place(&self, x: f64, y: f64) -> Vector2<f64> {
        self.origin + Rotation2::new(self.angle) * Vector2::new(x, y)
    }

    /// A point of the fixed tile's frame on the grid (m).
    pub fn locate(&self, p: Vector2<f64>) -> Vector2<f64> {
        Rotation2::new(-self.angle) * (p - self.origin)
    }
}

/// The lowest energy over theta at each (x, y) of a window.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyMap {
    /// The window of the map.
    pub window: Window,
    /// The sample of lowest energy at each grid point.
    pub lowest: Grid<Sample>,
    /// How far (m) each grid point lies from the border of the blocked region towards the nearest
    /// of its neighbours across it, negative on the blocked side; plus or minus the grid's spacing
    /// where all of them are alike.
    pub border_distance: Vec<f64>,
}

impl EnergyMap {
    /// The map all around the fixed tile, in proportion to a plot's width and height.
    pub fn around(problem: &Problem, pair: &Pair, [width, height]: [f64; 2]) -> Self {
        let [x, y] = problem.space.map_half_size();
        let half = [x.max(y * width / height), y.max(x * height / width)];
        let ends = [half.map(|h| -h), half];
        Self::plotted(problem, pair, (Vector2::zeros(), 0.0), ends)
    }

    /// The map in front of the target face, in proportion to a plot's width and height: x away from
    /// the face, with the share `behind` of the width behind the bound position, which is the
    /// origin; y along the face.
    pub fn in_front(
        problem: &Problem,
        pair: &Pair,
        [width, height]: [f64; 2],
        behind: f64,
    ) -> Self {
        let face = pair.target_face();
        let normal = face.normal();
        let half = 0.6 * face.length();
        let across = 2.0 * half * width / height;
        let frame = (pair.bound.position(), libm::atan2(normal.y, normal.x));
        let ends = [[-behind * across, -half], [(1.0 - behind) * across, half]];
        Self::plotted(problem, pair, frame, ends)
    }

    fn plotted(
        problem: &Problem,
        pair: &Pair,
        (origin, angle): (Vector2<f64>, f64),
        ends: [[f64; 2]; 2],
    ) -> Self {
        let [fixed, moving] = [&pair.fixed, &pair.moving].map(|tile| tile.outline.parts().len());
        let samples = match fixed * moving > MANY_PARTS {
            true => SAMPLES_OF_MANY_PARTS,
            false => SAMPLES,
        };
        let window = Window::new(origin, angle, ends, samples);
        Self::new(problem, &window, ORIENTATIONS)
    }

    /// The map of a window, from `orientations` evenly spread orientations, those that lay two
    /// faces flush, those in contact between a free and a blocked one, and a search about the
    /// lowest of them all.
    pub fn new(problem: &Problem, window: &Window, orientations: usize) -> Self {
        let [columns, rows] = window.samples;
        let x = evenly(window.low[0], window.high[0], columns);
        let y = evenly(window.low[1], window.high[1], rows);
        let search = OrientationSearch::new(problem, orientations);
        let found = parallel::flat_map(&y, |&y| {
            let places: Vec<_> = x.iter().map(|&x| window.place(x, y)).collect();
            search.find(&places)
        });
        let mut field = Field {
            search,
            window,
            x,
            y,
            found,
        };
        field.find_narrow_ranges();
        let border_distance = field.border_distance();
        let values = field.found.iter().map(|found| found.map(|f| f.sample));
        let values = values.collect();
        Self {
            window: *window,
            lowest: Grid {
                x: field.x,
                y: field.y,
                values,
            },
            border_distance,
        }
    }
}

/// Number of rows of points beside the blocked region that are examined again.
const NARROW: usize = 3;
/// Halvings of the way between a free and a blocked point in search of the border.
const HALVINGS: u32 = 4;

/// The free orientations at each point of a grid.
struct Field<'a> {
    search: OrientationSearch<'a>,
    window: &'a Window,
    x: Vec<f64>,
    y: Vec<f64>,
    found: Vec<Option<Found>>,
}

impl Field<'_> {
    fn place(&self, index: usize) -> Vector2<f64> {
        let columns = self.x.len();
        self.window
            .place(self.x[index % columns], self.y[index / columns])
    }

    /// A point and its neighbours, with `corners` also the diagonal ones.
    fn beside(&self, index: usize, corners: bool) -> impl Iterator<Item = usize> + '_ {
        let (columns, rows) = (self.x.len(), self.y.len());
        let (column, row) = (index % columns, index / columns);
        let near = |i: usize, count: usize| i.saturating_sub(1)..(i + 2).min(count);
        near(row, rows).flat_map(move |r| {
            near(column, columns)
                .filter(move |&c| corners || c == column || r == row)
                .map(move |c| r * columns + c)
        })
    }

    /// Examines blocked points beside free ones again, with the orientations that are free there:
    /// the samples miss ranges of free orientations narrower than their step.
    fn find_narrow_ranges(&mut self) {
        for _ in 0..NARROW {
            let more: Vec<_> = parallel::flat_map(0..self.found.len(), |index| {
                if self.found[index].is_some() {
                    return None;
                }
                let free = self.beside(index, true).filter_map(|i| self.found[i]);
                let guesses: Vec<f64> = free
                    .flat_map(|found| [found.middle, found.sample.configuration.theta])
                    .collect();
                let found = self.search.find_near(self.place(index), &guesses)?;
                Some((index, found))
            });
            for (index, found) in more {
                self.found[index] = Some(found);
            }
        }
    }

    /// See [`EnergyMap::border_distance`].
    fn border_distance(&self) -> Vec<f64> {
        let spacing = self.x[1] - self.x[0];
        parallel::map(0..self.found.len(), |index| {
            let free = self.found[index].is_some();
            let across = self
                .beside(index, false)
                .filter(|&i| self.found[i].is_some() != free);
            if free {
                let distances = across.map(|blocked| spacing * self.free_share(index, blocked));
                distances.fold(spacing, f64::min)
            } else {
                let distances = across.map(|free| spacing * (self.free_share(free, index) - 1.0));
                distances.fold(-spacing, f64::max)
            }
        })
    }

    /// The free fraction of the segment from a free point to a blocked one.
    fn free_share(&self, free: usize, blocked: usize) -> f64 {
        let Some(found) = self.found[free] else {
            return 0.0;
        };
        let thetas = [found.middle, found.sample.configuration.theta];
        let (from, to) = (self.place(free), self.place(blocked));
        let is_free = |share| self.search.any_is_free(from.lerp(&to, share), &thetas);
        bisected(0.0, 1.0, HALVINGS, is_free)[0]
    }
}
