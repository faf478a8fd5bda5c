//! Slices through the landscape in front of the target face.

use nalgebra::Vector2;
use rayon::prelude::*;

use super::map::{Grid, Pair, Sample, evenly, with_energies};
use crate::configuration::{Configuration, wrap_angle};
use crate::contact::TOUCH;
use crate::tile::{Face, Tile};

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
            let clearance = pair
                .contact
                .clearance(&self.configuration(tilt, slide, distance));
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
