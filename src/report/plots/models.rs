//! What the model of the magnets costs: the energy of point dipoles against that of blocks, and
//! the error of the dipoles, as the bound tiles are drawn apart along the target face's normal.

use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part};
use super::marks::{Box4, Pixel, polyline};
use super::picture::{Area, PictureError};
use super::scale::minus;
use super::scene::Scene;
use super::style::{Axis, BLUE, INK, LABEL, SMALL, Text, VERMILLION, chart, pixel};
use super::{energy, length};
use crate::csv::table;
use physics::landscape::StateKind;
use physics::landscape::approach::Approach;
use physics::potential::{Interaction, MagnetModel, Potential};
use physics::units::{prefix_of, si};

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 390.0;
/// The least width (pixels) of a panel beside the other.
const LEAST: f64 = 380.0;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [32.0, 24.0, 60.0, 80.0];
const SAMPLES: usize = 101;
/// Largest gap as a multiple of the largest magnet's length or width.
const FARTHEST: f64 = 5.0;
/// Gaps (in the same unit) at which the error is written out.
const MARKED: [f64; 3] = [0.0, 0.1, 1.0];

/// Energies (J) of both models over the gap (m).
pub struct Curves {
    gaps: Vec<f64>,
    dipoles: Vec<f64>,
    blocks: Vec<f64>,
    /// Of dipoles and of blocks in the bond, which need not lie on the way of the curves.
    bond: Option<[f64; 2]>,
}

impl Curves {
    /// `None` where there are no magnets, the faces cannot meet along the normal, or nothing is to
    /// be compared.
    pub fn new(scene: &Scene) -> Option<Self> {
        let pair = scene.pair;
        let magnets = pair.fixed.magnets.iter().chain(&pair.moving.magnets);
        let size = magnets
            .map(|magnet| magnet.size[0].max(magnet.size[1]))
            .fold(0.0, f64::max);
        if size == 0.0 {
            return None;
        }
        let approach = Approach::new(pair);
        // From the bond on, also where shapes hold the tile in it: head-on it may touch before.
        let landing = match scene.problem.is_clear(&pair.bound) {
            true => 0.0,
            false => approach.landing(scene.problem, 0.0, 0.0)?,
        };
        let gaps: Vec<f64> = (0..SAMPLES)
            .map(|k| FARTHEST * size * k as f64 / (SAMPLES - 1) as f64)
            .collect();
        let [dipoles, blocks] = [MagnetModel::Dipole, MagnetModel::Cuboid].map(|model| {
            let interaction = Interaction {
                model,
                ..scene.interaction.clone()
            };
            interaction.between(&pair.fixed, &pair.moving).potential
        });
        let energies = |potential: &dyn Potential| {
            let at = |gap: &f64| potential.energy(&approach.configuration(0.0, 0.0, landing + gap));
            gaps.iter().map(at).collect::<Vec<_>>()
        };
        let bond = scene.catalogue.first(StateKind::Bond);
        let curves = Self {
            dipoles: energies(&*dipoles),
            blocks: energies(&*blocks),
            bond: bond.map(|bond| {
                [&dipoles, &blocks].map(|potential| potential.energy(&bond.configuration))
            }),
            gaps,
        };
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        (finite(&curves.dipoles) && finite(&curves.errors())).then_some(curves)
    }

    /// The dipoles' error (%) relative to the blocks' energy.
    fn errors(&self) -> Vec<f64> {
        let pairs = self.dipoles.iter().zip(&self.blocks);
        pairs
            .map(|(dipole, block)| 100.0 * (dipole - block).abs() / block.abs())
            .collect()
    }
}

/// The picture: energies, and the error.
pub fn composed<'a>(scene: &Scene, curves: &'a Curves) -> Composition<'a> {
    let height = |_| HEIGHT;
    let energy = Panel::new("energy", LEAST, height, |root, _, place| {
        energies(root, place, curves)
    });
    let error = Panel::new("error", LEAST, height, |root, _, place| {
        errors(root, place, curves)
    });
    let note = curves.bond.map(|[dipoles, blocks]| {
        let off = 100.0 * (dipoles - blocks).abs() / blocks.abs();
        let [dipoles, blocks] = [dipoles, blocks].map(|u| minus(&si(u, "J", 4)));
        format!("in the bond: dipoles {dipoles}, blocks {blocks}, {off:.1} % off")
    });
    Composition {
        name: "models".to_owned(),
        title: format!("{}: magnets as point dipoles and as blocks", scene.name),
        note,
        width: WIDTH,
        panels: vec![energy, error],
        key: None,
    }
}

/// The numbers of the picture.
pub fn data(curves: &Curves) -> String {
    let columns = curves.dipoles.iter().zip(&curves.blocks);
    let rows = curves.gaps.iter().zip(columns);
    let rows =
        rows.map(|(gap, (dipoles, blocks))| vec![length(*gap), energy(*dipoles), energy(*blocks)]);
    table(["gap_m", "dipoles_J", "blocks_J"], rows)
}

fn energies(root: &Area, place: Box4, curves: &Curves) -> Result<(), PictureError> {
    let all = curves.dipoles.iter().chain(&curves.blocks);
    let (low, high) = all.fold((0.0f64, 0.0f64), |(low, high), &u| {
        (low.min(u), high.max(u))
    });
    let span = high - low;
    let (joule, prefix) = prefix_of(0.999 * low.abs().max(high));
    let (x_axis, metre) = gap_axis(curves);
    let range = (low - 0.05 * span) / joule..(high + 0.05 * span) / joule;
    let y_axis = Axis::linear(range, 6, format!("energy U ({prefix}J)"));
    let area = part(root, place);
    let chart = chart(&area, MARGIN, &x_axis, &y_axis, true)?;
    let at = |gap: f64, energy: f64| pixel(&chart, gap / metre, energy / joule);
    heading(root, at(0.0, high + 0.05 * span), "energy over the gap")?;
    let named = [
        ("dipoles", &curves.dipoles, VERMILLION),
        ("blocks", &curves.blocks, BLUE),
    ];
    for (k, (name, energies, colour)) in named.into_iter().enumerate() {
        let line: Vec<Pixel> = curves
            .gaps
            .iter()
            .zip(energies)
            .map(|(gap, energy)| at(*gap, *energy))
            .collect();
        polyline(root, &line, colour, 2.4)?;
        let last = at(curves.gaps[SAMPLES - 1], 0.5 * (low + high));
        let place = (last.0 - 12.0, last.1 + 22.0 * k as f64);
        Text::new(LABEL)
            .colour(colour)
            .write(root, name, place, (HPos::Right, VPos::Center))?;
    }
    Ok(())
}

fn errors(root: &Area, place: Box4, curves: &Curves) -> Result<(), PictureError> {
    let errors = curves.errors();
    let most = errors.iter().copied().fold(1.0, f64::max);
    let (x_axis, metre) = gap_axis(curves);
    let y_axis = Axis::linear(0.0..1.1 * most, 6, "error of the dipoles' energy (%)");
    let area = part(root, place);
    let chart = chart(&area, MARGIN, &x_axis, &y_axis, true)?;
    let at = |gap: f64, error: f64| pixel(&chart, gap / metre, error);
    heading(root, at(0.0, 1.1 * most), "relative to the blocks")?;
    let points = || curves.gaps.iter().zip(&errors);
    let line: Vec<Pixel> = points().map(|(gap, error)| at(*gap, *error)).collect();
    polyline(root, &line, INK, 2.4)?;
    let unit = curves.gaps[SAMPLES - 1] / FARTHEST;
    for mark in MARKED {
        let wanted = points().find(|(gap, _)| **gap >= (mark - 1e-9) * unit);
        if let Some((gap, error)) = wanted {
            let (x, y) = at(*gap, *error);
            polyline(root, &[(x, y), (x + 22.0, y)], INK, 0.8)?;
            let place = match mark {
                0.0 => "in contact".to_owned(),
                _ => format!("at {}", si(*gap, "m", 3)),
            };
            let text = format!("{error:.1} % {place}");
            Text::new(SMALL).write(root, &text, (x + 26.0, y), (HPos::Left, VPos::Center))?;
        }
    }
    Ok(())
}

/// The axis of the gap, and its unit (m).
fn gap_axis(curves: &Curves) -> (Axis, f64) {
    let farthest = curves.gaps[SAMPLES - 1];
    let (metre, prefix) = prefix_of(0.999 * farthest);
    let name = format!("gap ({prefix}m)");
    (Axis::linear(0.0..farthest / metre, 6, name), metre)
}

fn heading(root: &Area, (x, y): Pixel, text: &str) -> Result<(), PictureError> {
    Text::new(LABEL)
        .bold()
        .write(root, text, (x, y - 8.0), (HPos::Left, VPos::Bottom))
}
