//! Sections through the landscape for the eye: the lowest energy over theta at each (x, y), and
//! two slices in front of the target face.
//!
//! Every number is an energy of a free configuration, so no section shows an energy that only
//! overlapping tiles could have. Grids are computed row by row in parallel and gathered in order;
//! the same numbers come out on any number of threads.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use rayon::prelude::*;

use crate::configuration::{Configuration, wrap_angle};
use crate::potential::Potential;
use crate::tile::{Face, Tile};

/// Signed clearance (m) of the two tiles: at most their distance where they are apart, negative
/// where they overlap.
pub type Clearance<'a> = &'a (dyn Fn(&Configuration) -> f64 + Sync);

/// Overlaps up to this depth (m) count as touching.
const TOUCH: f64 = 1e-9;

/// The pair of tiles that a section is taken of.
#[derive(Clone, Copy)]
pub struct Pair<'a> {
    pub fixed: &'a Tile,
    pub moving: &'a Tile,
    pub potential: &'a dyn Potential,
    pub clearance: Clearance<'a>,
}

/// Values on a grid, row by row from the lowest y; `None` where no free configuration belongs to
/// the grid point.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub values: Vec<Option<T>>,
}

impl<T> Grid<T> {
    pub fn value(&self, column: usize, row: usize) -> Option<&T> {
        self.values[row * self.x.len() + column].as_ref()
    }
}

/// A free configuration and its energy U (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub configuration: Configuration,
    pub energy: f64,
}

/// The lowest energy over theta at each (x, y).
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyMap {
    /// The sample of lowest energy at each (x, y) (m).
    pub lowest: Grid<Sample>,
    /// Largest clearance over theta (m) at the grid points beside the border of the blocked
    /// region, 0 or more where something is free; elsewhere only its sign means something. It
    /// tells where between two grid points the border runs.
    pub room: Vec<f64>,
}

/// Resolution of an [`EnergyMap`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Half the width and half the height of the map (m).
    pub half_size: [f64; 2],
    /// Grid points along the longer side.
    pub samples: usize,
    /// Evenly spread orientations; those that lay two faces flush are added to them.
    pub orientations: usize,
}

impl EnergyMap {
    pub fn new(pair: &Pair, settings: &MapSettings) -> Self {
        let [half_x, half_y] = settings.half_size;
        let longer = half_x.max(half_y);
        let count = |half: f64| ((settings.samples as f64 * half / longer).round() as usize).max(2);
        let (x, y) = (
            evenly(-half_x, half_x, count(half_x)),
            evenly(-half_y, half_y, count(half_y)),
        );
        let thetas = orientations(pair.fixed, pair.moving, settings.orientations);
        let values: Vec<_> = y
            .par_iter()
            .flat_map_iter(|&y| lowest_in_row(pair, &x, y, &thetas))
            .collect();
        let lowest = Grid { x, y, values };
        let room = room_beside_border(pair, &lowest, &thetas);
        Self { lowest, room }
    }
}

/// Two slices in front of the target face, the moving tile's target face turned towards it.
///
/// The moving tile is turned by the tilt about the middle of its target face, shifted by the slide
/// along the fixed tile's target face, and brought up along that face's normal until it touches;
/// the gap is then opened along the normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ApproachSlices {
    /// Tilt (rad) along x, gap (m) along y, at slide 0.
    pub gap: Grid<Sample>,
    /// Tilt (rad) along x, slide (m) along y, in contact.
    pub slide: Grid<Sample>,
}

/// Extent and resolution of [`ApproachSlices`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceSettings {
    /// Largest tilt to either side (rad).
    pub tilt: f64,
    /// Largest gap (m).
    pub gap: f64,
    /// Largest slide to either side (m).
    pub slide: f64,
    /// Grid points along each axis.
    pub samples: usize,
}

/// The motion of the moving tile in front of the target face.
#[derive(Clone, Copy, Debug)]
pub struct Approach<'a> {
    bound: Configuration,
    /// Middle of the moving tile's target face in its own frame (m).
    pivot: Vector2<f64>,
    face: &'a Face,
}

impl<'a> Approach<'a> {
    /// `target` are the faces of the fixed and the moving tile that `bound` lays together.
    pub fn new(
        fixed: &'a Tile,
        moving: &Tile,
        target: (usize, usize),
        bound: Configuration,
    ) -> Self {
        Self {
            bound,
            pivot: moving.faces[target.1].middle(),
            face: &fixed.faces[target.0],
        }
    }

    /// The configuration with this tilt (rad), slide (m) and distance (m) along the normal from
    /// the bound position.
    pub fn configuration(&self, tilt: f64, slide: f64, distance: f64) -> Configuration {
        let pivot = self.bound.transform(self.pivot)
            + self.face.tangent() * slide
            + self.face.normal() * distance;
        let turned = Configuration::new(0.0, 0.0, wrap_angle(self.bound.theta + tilt));
        let position = pivot - turned.transform(self.pivot);
        Configuration::new(position.x, position.y, turned.theta)
    }

    /// Tilt (rad) and slide (m) of a configuration.
    pub fn tilt_and_slide(&self, q: &Configuration) -> (f64, f64) {
        let moved = q.transform(self.pivot) - self.bound.transform(self.pivot);
        (
            wrap_angle(q.theta - self.bound.theta),
            moved.dot(&self.face.tangent()),
        )
    }

    /// Distance along the normal (m) at which the moving tile, coming from far away, first
    /// touches; `None` where it passes by.
    ///
    /// Conservative advancement (Mirtich 1996): a translation no longer than the clearance stays
    /// free, so steps of the clearance's length close in on the contact from the free side.
    pub fn contact_distance(&self, pair: &Pair, tilt: f64, slide: f64) -> Option<f64> {
        const STEPS: usize = 100;
        let reach = pair.fixed.outline.circumradius() + pair.moving.outline.circumradius();
        let near = 1e-6 * reach;
        let mut distance = 2.0 * reach;
        for _ in 0..STEPS {
            let clearance = (pair.clearance)(&self.configuration(tilt, slide, distance));
            if clearance < near {
                return (clearance >= -TOUCH).then_some(distance);
            }
            if distance < -2.0 * reach {
                return None;
            }
            distance -= clearance;
        }
        Some(distance)
    }
}

impl ApproachSlices {
    pub fn new(pair: &Pair, approach: &Approach, settings: &SliceSettings) -> Self {
        let tilts = evenly(-settings.tilt, settings.tilt, settings.samples);
        let gaps = evenly(0.0, settings.gap, settings.samples);
        let slides = evenly(-settings.slide, settings.slide, settings.samples);
        let contacts: Vec<_> = tilts
            .par_iter()
            .map(|&tilt| approach.contact_distance(pair, tilt, 0.0))
            .collect();
        let gap = sampled(pair, &tilts, &gaps, |i, gap| {
            contacts[i].map(|contact| approach.configuration(tilts[i], 0.0, contact + gap))
        });
        let slide = sampled(pair, &tilts, &slides, |i, slide| {
            approach
                .contact_distance(pair, tilts[i], slide)
                .map(|contact| approach.configuration(tilts[i], slide, contact))
        });
        Self { gap, slide }
    }
}

/// `count` numbers from `low` to `high`, both included.
fn evenly(low: f64, high: f64, count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count)
        .map(|i| low + (high - low) * i as f64 / last)
        .collect()
}

/// Evenly spread orientations in (-pi, pi] together with those that lay two faces flush.
fn orientations(fixed: &Tile, moving: &Tile, count: usize) -> Vec<f64> {
    let spread = (0..count).map(|k| wrap_angle(k as f64 * TAU / count as f64));
    let direction = |face: &Face| face.normal().y.atan2(face.normal().x);
    let flush = fixed.faces.iter().flat_map(|to| {
        moving
            .faces
            .iter()
            .map(move |from| wrap_angle(direction(to) - direction(from) + TAU / 2.0))
    });
    let mut thetas: Vec<f64> = spread.chain(flush).collect();
    thetas.sort_by(f64::total_cmp);
    thetas.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    thetas
}

/// How the distance of the reference points alone decides whether the tiles overlap.
struct Circles {
    /// Free in any orientation where the reference points are at least this far apart (m).
    outer: f64,
    /// Blocked in every orientation where they are closer than this (m).
    inner: f64,
}

impl Circles {
    fn of(pair: &Pair) -> Self {
        let (fixed, moving) = (&pair.fixed.outline, &pair.moving.outline);
        let inradius = |d: f64| (-d).max(0.0);
        let origin = Vector2::zeros();
        let (a, b) = (
            fixed.signed_distance(origin),
            moving.signed_distance(origin),
        );
        Self {
            outer: fixed.circumradius() + moving.circumradius(),
            // Discs about two inner points overlap; with one reference point outside its tile
            // nothing is known.
            inner: if a < 0.0 && b < 0.0 {
                inradius(a) + inradius(b) - 2.0 * TOUCH
            } else {
                0.0
            },
        }
    }

    fn free(&self, pair: &Pair, q: &Configuration) -> bool {
        q.x.hypot(q.y) >= self.outer || (pair.clearance)(q) >= -TOUCH
    }
}

/// Halvings of the step between orientations in search of the lowest energy.
const REFINEMENTS: usize = 4;

fn lowest_in_row(pair: &Pair, x: &[f64], y: f64, thetas: &[f64]) -> Vec<Option<Sample>> {
    let circles = Circles::of(pair);
    let mut best = lowest_of_all(pair, &circles, x, y, thetas);
    let mut step = TAU / thetas.len() as f64;
    for _ in 0..REFINEMENTS {
        step /= 2.0;
        refine(pair, &circles, &mut best, step);
    }
    best
}

/// The lowest free sample among all orientations, at each x.
fn lowest_of_all(
    pair: &Pair,
    circles: &Circles,
    x: &[f64],
    y: f64,
    thetas: &[f64],
) -> Vec<Option<Sample>> {
    let mut free = Vec::with_capacity(x.len() * thetas.len());
    let mut ends = Vec::with_capacity(x.len());
    for &x in x {
        let distance = x.hypot(y);
        if distance >= circles.inner {
            let all = thetas.iter().map(|&theta| Configuration::new(x, y, theta));
            free.extend(all.filter(|q| circles.free(pair, q)));
        }
        ends.push(free.len());
    }
    let samples = with_energies(pair.potential, &free);
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts
        .zip(&ends)
        .map(|(start, &end)| lowest(&samples[start..end]))
        .collect()
}

/// Turns each sample by `step` (rad) to either side where that is free and lower.
fn refine(pair: &Pair, circles: &Circles, best: &mut [Option<Sample>], step: f64) {
    let mut owners = Vec::new();
    let mut turned = Vec::new();
    for (index, sample) in best.iter().enumerate() {
        let Some(sample) = sample else { continue };
        for turn in [-step, step] {
            let mut q = sample.configuration;
            q.theta = wrap_angle(q.theta + turn);
            if circles.free(pair, &q) {
                owners.push(index);
                turned.push(q);
            }
        }
    }
    for (index, sample) in owners
        .into_iter()
        .zip(with_energies(pair.potential, &turned))
    {
        if best[index].is_some_and(|lowest| sample.energy < lowest.energy) {
            best[index] = Some(sample);
        }
    }
}

fn lowest(samples: &[Sample]) -> Option<Sample> {
    samples
        .iter()
        .copied()
        .min_by(|a, b| a.energy.total_cmp(&b.energy))
}

fn with_energies(potential: &dyn Potential, free: &[Configuration]) -> Vec<Sample> {
    let mut energies = vec![0.0; free.len()];
    potential.energies(free, &mut energies);
    free.iter()
        .zip(energies)
        .map(|(&configuration, energy)| Sample {
            configuration,
            energy,
        })
        .collect()
}

/// The largest clearance over theta at each grid point that has a neighbour on the other side of
/// the blocked region's border; elsewhere plus or minus the grid's spacing.
fn room_beside_border(pair: &Pair, grid: &Grid<Sample>, thetas: &[f64]) -> Vec<f64> {
    let (columns, rows) = (grid.x.len(), grid.y.len());
    let spacing = grid.x[1] - grid.x[0];
    (0..columns * rows)
        .into_par_iter()
        .map(|index| {
            let (column, row) = (index % columns, index / columns);
            let free = grid.values[index].is_some();
            let at_border = (row.saturating_sub(1)..(row + 2).min(rows)).any(|r| {
                (column.saturating_sub(1)..(column + 2).min(columns))
                    .any(|c| grid.value(c, r).is_some() != free)
            });
            if !at_border {
                return if free { spacing } else { -spacing };
            }
            let (x, y) = (grid.x[column], grid.y[row]);
            let room = thetas
                .iter()
                .map(|&theta| (pair.clearance)(&Configuration::new(x, y, theta)))
                .fold(f64::NEG_INFINITY, f64::max);
            room.clamp(-2.0 * spacing, 2.0 * spacing)
        })
        .collect()
}

fn sampled(
    pair: &Pair,
    x: &[f64],
    y: &[f64],
    configuration: impl Fn(usize, f64) -> Option<Configuration> + Sync,
) -> Grid<Sample> {
    let values = y
        .par_iter()
        .flat_map_iter(|&y| {
            let row: Vec<_> = (0..x.len()).map(|i| configuration(i, y)).collect();
            let free: Vec<_> = row.iter().flatten().copied().collect();
            let mut samples = with_energies(pair.potential, &free).into_iter();
            row.into_iter()
                .map(move |q| q.and_then(|_| samples.next()))
                .collect::<Vec<_>>()
        })
        .collect();
    Grid {
        x: x.to_vec(),
        y: y.to_vec(),
        values,
    }
}
