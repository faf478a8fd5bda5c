//! The error of the dipole model: the energy of point dipoles against that of blocks, and the
//! difference, as the bound tiles are drawn apart along the target face's normal.

use super::canvas::{Box4, Canvas};
use super::chart::{Dimension, Look, Series, plotted};
use super::composition::{Composition, Panel};
use super::decimals::{Decimals, energy};
use super::scene::Scene;
use super::style::{Anchor, COLOURS, INK, LABEL, minus};
use crate::csv::table;
use physics::landscape::StateKind;
use physics::landscape::approach::Approach;
use physics::potential::{Interaction, MagnetModel, Potential};
use physics::units::si;

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 390.0;
/// The least width (pixels) of a panel beside the other.
const LEAST: f64 = 380.0;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [32.0, 24.0, 60.0, 80.0];
/// Indices of the colours of series.
const BLOCKS: usize = 0;
const DIPOLES: usize = 1;
const ERROR: usize = 6;
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
    /// The name of the bodies.
    bodies: &'static str,
    /// Energies of dipoles and of blocks in the bond, which need not lie on the curves.
    bond: Option<[f64; 2]>,
}

impl Curves {
    /// `None` if there are no magnets, the faces cannot meet along the normal, or there is nothing
    /// to compare.
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
        // Starts at the bond, also if shapes lock the tile in it: on the way straight in it may
        // touch earlier.
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
            bodies: pair.bodies(),
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
    let energy = Panel::new("energy", LEAST, height, |canvas, place| {
        let line = |energies: &[f64]| -> Vec<[f64; 2]> {
            let points = curves.gaps.iter().zip(energies);
            points.map(|(gap, energy)| [*gap, *energy]).collect()
        };
        let series = [
            Series::new("dipoles", Look::Steps, DIPOLES, line(&curves.dipoles)),
            Series::new(curves.bodies, Look::Steps, BLOCKS, line(&curves.blocks)),
        ];
        let y = Dimension::new("energy_J", "energy U");
        let plot = plotted(canvas, place, MARGIN, [&gap_dimension(), &y], &series);
        plot.heading(canvas, "energy over the gap");
        let middle = (plot.frame[1] + plot.frame[3]) / 2.0;
        for (k, one) in series.iter().enumerate() {
            let font = LABEL.colour(COLOURS[one.colour]);
            let at = (plot.frame[2] - 12.0, middle + 22.0 * k as f64);
            canvas.write(font, &one.name, at, Anchor::Right);
        }
    });
    let error = Panel::new("error", LEAST, height, |canvas, place| {
        errors(canvas, place, curves);
    });
    let note = curves.bond.map(|[dipoles, blocks]| {
        let off = 100.0 * (dipoles - blocks).abs() / blocks.abs();
        let [dipoles, blocks] = [dipoles, blocks].map(|u| minus(&si(u, "J", 4)));
        format!(
            "in the bond: dipoles {dipoles}, {} {blocks}, {off:.1} % off",
            curves.bodies
        )
    });
    Composition {
        name: "models".to_owned(),
        title: format!(
            "{}: magnets as point dipoles and as {}",
            scene.name, curves.bodies
        ),
        note: note.unwrap_or_default(),
        width: WIDTH,
        panels: vec![energy, error],
        ..Composition::default()
    }
}

/// The numbers of the picture.
pub fn data(curves: &Curves, decimals: Decimals) -> String {
    let columns = curves.dipoles.iter().zip(&curves.blocks);
    let rows = curves.gaps.iter().zip(columns);
    let rows = rows.map(|(gap, (dipoles, blocks))| {
        vec![decimals.length(*gap), energy(*dipoles), energy(*blocks)]
    });
    table(["gap_m", "dipoles_J", "blocks_J"], rows)
}

fn gap_dimension() -> Dimension {
    Dimension::new("gap_m", "gap")
}

fn errors(canvas: &mut Canvas, place: Box4, curves: &Curves) {
    let errors = curves.errors();
    let most = errors.iter().copied().fold(1.0, f64::max);
    let points: Vec<[f64; 2]> = curves
        .gaps
        .iter()
        .zip(errors)
        .map(|(gap, e)| [*gap, e])
        .collect();
    let series = [Series::new("", Look::Steps, ERROR, points.iter().copied())];
    let y = Dimension::new("", "error of the dipoles' energy (%)").within([0.0, 1.1 * most]);
    let plot = plotted(canvas, place, MARGIN, [&gap_dimension(), &y], &series);
    plot.heading(canvas, "relative to the blocks");
    let unit = curves.gaps[SAMPLES - 1] / FARTHEST;
    for mark in MARKED {
        if let Some([gap, error]) = points.iter().find(|[gap, _]| *gap >= (mark - 1e-9) * unit) {
            let (x, y) = plot.at(*gap, *error);
            canvas.line(&[(x, y), (x + 22.0, y)], INK, 0.8);
            let place = match mark {
                0.0 => "in contact".to_owned(),
                _ => format!("at {}", si(*gap, "m", 3)),
            };
            let text = format!("{error:.1} % {place}");
            canvas.note(&text, (x + 26.0, y), Anchor::Left);
        }
    }
}
