//! Slices through the landscape in front of the target face.

use std::f64::consts::FRAC_PI_4;

use nalgebra::Vector2;

use super::grid::{Grid, Sample, evenly, sampled};
use tiles::configuration::{Configuration, wrap_angle};
use tiles::potential::{Interaction, MagnetModel};
use tiles::problem::Problem;
use tiles::tile::{Face, Pair};

/// Gaps at which the models are compared.
const GAPS: usize = 101;
/// Largest of them as a multiple of the largest magnet's length or width.
const FARTHEST: f64 = 5.0;

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

    /// Both slices, as far as pictures show them.
    pub fn slices(&self, problem: &Problem) -> ApproachSlices {
        let length = self.face.length();
        let settings = SliceSettings {
            tilt: FRAC_PI_4,
            gap: 0.2 * length,
            slide: 0.5 * length,
            samples: 161,
        };
        ApproachSlices::new(problem, self, &settings)
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

/// Energies (J) of magnets as point dipoles and as blocks, as the bound tiles are drawn apart along
/// the target face's normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelCurves {
    /// Gaps (m), ascending from 0.
    pub gaps: Vec<f64>,
    /// Energies of point dipoles.
    pub dipoles: Vec<f64>,
    /// Energies of blocks, or of the bodies that the magnets are.
    pub blocks: Vec<f64>,
    /// The largest magnet's length or width (m).
    pub magnet: f64,
    /// Energies of dipoles and of blocks in the bond, which need not lie on the curves.
    pub bond: Option<[f64; 2]>,
}

impl ModelCurves {
    /// `None` if there are no magnets, the faces cannot meet along the normal, or there is nothing
    /// to compare.
    pub fn new(
        problem: &Problem,
        pair: &Pair,
        interaction: &Interaction,
        bond: Option<&Configuration>,
    ) -> Option<Self> {
        let magnet = pair
            .fixed
            .largest_magnet()
            .max(pair.moving.largest_magnet());
        if magnet == 0.0 {
            return None;
        }
        let approach = Approach::new(pair);
        // Starts at the bond, also if shapes lock the tile in it: on the way straight in it may
        // touch earlier.
        let landing = match problem.is_clear(&pair.bound) {
            true => 0.0,
            false => approach.landing(problem, 0.0, 0.0)?,
        };
        let gaps = evenly(0.0, FARTHEST * magnet, GAPS);
        let potentials = [MagnetModel::Dipole, MagnetModel::Cuboid].map(|model| {
            let interaction = Interaction {
                model,
                ..interaction.clone()
            };
            interaction.between(&pair.fixed, &pair.moving).potential
        });
        let [dipoles, blocks] = potentials.each_ref().map(|potential| {
            let at = |gap: &f64| potential.energy(&approach.configuration(0.0, 0.0, landing + gap));
            gaps.iter().map(at).collect::<Vec<_>>()
        });
        let curves = Self {
            dipoles,
            blocks,
            magnet,
            bond: bond.map(|bond| potentials.map(|potential| potential.energy(bond))),
            gaps,
        };
        let is_known = curves.dipoles.iter().all(|energy| energy.is_finite())
            && curves.errors().all(f64::is_finite);
        is_known.then_some(curves)
    }

    /// The dipoles' error (%) relative to the blocks' energy, at each gap.
    pub fn errors(&self) -> impl Iterator<Item = f64> {
        let pairs = self.dipoles.iter().zip(&self.blocks);
        pairs.map(|(dipole, block)| 100.0 * (dipole - block).abs() / block.abs())
    }
}
