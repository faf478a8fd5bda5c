//! The error of the dipole model: the energy of point dipoles against that of blocks, and the
//! difference, as the bound tiles are drawn apart along the target face's normal.

use super::canvas::{Box4, Canvas};
use super::chart::{Dimension, Look, Series, plotted};
use super::composition::{Composition, Panel};
use super::decimals::{Decimals, energy};
use super::scene::Scene;
use super::style::{Anchor, COLOURS, INK, LABEL, minus};
use crate::csv::table;
use physics::landscape::approach::ModelCurves;
use physics::potential::MagnetModel;
use physics::units::{plain, share_with, si};

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
/// Gaps, as multiples of the largest magnet's length or width, at which the error is written out.
const MARKED: [f64; 3] = [0.0, 0.1, 1.0];

/// The picture: energies, and the error.
pub fn composed<'a>(scene: &Scene<'a>, curves: &'a ModelCurves) -> Composition<'a> {
    let bodies = scene.pair.bodies();
    let height = |_| HEIGHT;
    let energy = Panel::new("energy", LEAST, height, move |canvas, place| {
        let line = |energies: &[f64]| -> Vec<[f64; 2]> {
            let points = curves.gaps.iter().zip(energies);
            points.map(|(gap, energy)| [*gap, *energy]).collect()
        };
        let series = [
            Series::new("dipoles", Look::Steps, DIPOLES, line(&curves.dipoles)),
            Series::new(bodies, Look::Steps, BLOCKS, line(&curves.blocks)),
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
    let note = curves.bond.map(|bond| {
        let [dipoles, blocks] = bond.map(|u| minus(&si(u, "J", 4)));
        match scene.interaction.model {
            MagnetModel::Dipole => {
                let off = distance(bond);
                format!("in the bond: dipoles {dipoles}, {bodies} {blocks}: {off}")
            }
            MagnetModel::Cuboid => {
                format!("in the bond: {bodies} {blocks}; as point dipoles it would be {dipoles}")
            }
        }
    });
    Composition {
        name: "models".to_owned(),
        title: format!("{}: magnets as point dipoles and as {bodies}", scene.name),
        note: note.unwrap_or_default(),
        width: WIDTH,
        panels: vec![energy, error],
        ..Composition::default()
    }
}

/// How far dipoles are from blocks, in words: a share, or a ratio where the two have little in
/// common.
fn distance([dipoles, blocks]: [f64; 2]) -> String {
    let off = (dipoles - blocks).abs() / blocks.abs();
    match dipoles / blocks {
        _ if off < 1.0 => format!("{} off", share_with(off, 1)),
        times if times > 0.0 && times.is_finite() => format!("{} times as much", plain(times, 2)),
        _ => "without any likeness".to_owned(),
    }
}

/// The numbers of the picture.
pub fn data(curves: &ModelCurves, decimals: Decimals) -> String {
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

fn errors(canvas: &mut Canvas, place: Box4, curves: &ModelCurves) {
    let most = curves.errors().fold(1.0, f64::max);
    let points = curves.gaps.iter().zip(curves.errors());
    let points: Vec<[f64; 2]> = points.map(|(gap, error)| [*gap, error]).collect();
    let series = [Series::new("", Look::Steps, ERROR, points.iter().copied())];
    let y = Dimension::new("", "error of the dipoles' energy (%)").within([0.0, 1.1 * most]);
    let plot = plotted(canvas, place, MARGIN, [&gap_dimension(), &y], &series);
    plot.heading(canvas, "relative to the blocks");
    for mark in MARKED {
        if let Some([gap, error]) = points
            .iter()
            .find(|[gap, _]| *gap >= (mark - 1e-9) * curves.magnet)
        {
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
