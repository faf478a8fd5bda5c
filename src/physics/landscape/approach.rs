//! Slices through the landscape in front of the target face.

use nalgebra::Vector2;

use super::grid::{Grid, Sample, evenly, sampled};
use crate::configuration::{Configuration, wrap_angle};
use crate::problem::Problem;
use crate::tile::{Face, Pair};

/// Two slices in front of the target face, with the moving tile's target face towards it.
///
/// The moving tile is rotated by the tilt about the middle of its target face, shifted by the slide
/// along the fixed tile's target face, and moved along that face's normal until it touches; the gap
/// is then opened along the normal.
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
    /// Towards the configuration in which the target faces coincide.
    pub fn new(pair: &'a Pair) -> Self {
        Self {
            bound: pair.bound,
            pivot: pair.moving.faces[pair.target.1].middle(),
            face: pair.target_face(),
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

    /// Middle of the moving tile's target face in its own frame (m).
    pub fn pivot(&self) -> Vector2<f64> {
        self.pivot
    }

    /// Tilt (rad) and slide (m) of a configuration.
    pub fn tilt_and_slide(&self, q: &Configuration) -> (f64, f64) {
        let moved = q.transform(self.pivot) - self.bound.transform(self.pivot);
        (
            wrap_angle(q.theta - self.bound.theta),
            moved.dot(&self.face.tangent()),
        )
    }

    /// The distance (m) along the normal from the bound position at which the moving tile with this
    /// tilt and slide, coming from far away, first touches; `None` if it passes by.
    pub fn landing(&self, problem: &Problem, tilt: f64, slide: f64) -> Option<f64> {
        let level = self.configuration(tilt, slide, 0.0);
        let contact = problem.contact.as_ref()?;
        contact.landing(&level, self.face.normal())
    }

    /// The configuration with this tilt and slide in which the moving tile, coming from far away,
    /// first touches, `gap` (m) drawn back; `None` if it passes by.
    pub fn before_contact(
        &self,
        problem: &Problem,
        tilt: f64,
        slide: f64,
        gap: f64,
    ) -> Option<Configuration> {
        let distance = self.landing(problem, tilt, slide)?;
        Some(self.configuration(tilt, slide, distance + gap))
    }
}

impl ApproachSlices {
    /// Samples both slices of the energy in front of the target face.
    pub fn new(problem: &Problem, approach: &Approach, settings: &SliceSettings) -> Self {
        let tilts = evenly(-settings.tilt, settings.tilt, settings.samples);
        let gaps = evenly(0.0, settings.gap, settings.samples);
        let slides = evenly(-settings.slide, settings.slide, settings.samples);
        let grid = |y: Vec<f64>, configuration: &Configurations| Grid {
            values: sampled(problem, [y.len(), tilts.len()], |row, column| {
                configuration(tilts[column], y[row])
            }),
            x: tilts.clone(),
            y,
        };
        Self {
            gap: grid(gaps, &|tilt, gap| {
                approach.before_contact(problem, tilt, 0.0, gap)
            }),
            slide: grid(slides, &|tilt, slide| {
                approach.before_contact(problem, tilt, slide, 0.0)
            }),
        }
    }
}

/// The configuration at each place of a slice, where there is one.
type Configurations<'a> = dyn Fn(f64, f64) -> Option<Configuration> + Sync + 'a;
