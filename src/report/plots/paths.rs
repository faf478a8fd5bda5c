//! Trajectories of docking tiles.

use plotters::style::RGBColor;

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel};
use super::key::{POLES, Sign, key, start};
use super::marks::View;
use super::picture::PictureError;
use super::style::{GREEN, INK};
use super::{Figure, Sheet};
use crate::csv::table;
use jobs::design::Design;
use jobs::docking::Path;
use physics::dynamics::docking::End;

const WIDTH: f64 = 860.0;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];

/// Paths of the moving tile's reference point by their ends, and the bound tile.
///
/// # Errors
/// See [`PictureError`].
pub fn trajectories(
    design: &Design,
    trajectories: &[Path],
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let meanings = [
        (Sign::Line(GREEN), "ends bound"),
        (Sign::Line(INK), "ends in a trap"),
        (Sign::Line(FAINT), "ends free"),
        (Sign::Start, "start"),
    ];
    let panel = Panel::alone(plot_height, |canvas, place| {
        paths(canvas, place, design, trajectories);
    });
    let composition = Composition {
        name: "trajectories".to_owned(),
        title: format!(
            "{}: paths of the moving tile's centre, {} of the runs",
            design.name,
            trajectories.len()
        ),
        width: WIDTH,
        panels: vec![panel],
        keys: vec![key(meanings.into_iter().chain(POLES))],
        ..Composition::default()
    };
    let rows = trajectories
        .iter()
        .enumerate()
        .flat_map(|(number, (run, snapshots))| {
            snapshots.iter().map(move |snapshot| {
                let q = snapshot.motion.configuration;
                let mut row = vec![number.to_string(), ending(&run.end).to_owned()];
                row.extend([snapshot.time, q.x, q.y, q.theta].map(super::length));
                row
            })
        });
    let head = ["path", "ends", "time_s", "x_m", "y_m", "theta_rad"];
    Figure::new(&composition, sheet, table(head, rows))
}

/// The name of a path's end.
pub fn ending(end: &End) -> &'static str {
    match end {
        End::Bound { .. } => "bound",
        End::Trapped { .. } => "misbound",
        End::Free => "free",
    }
}

/// The height of a square plot of this width (pixels).
fn plot_height(width: f64) -> f64 {
    MARGIN[0] + (width - MARGIN[1] - MARGIN[3]).min(700.0) + MARGIN[2]
}

fn paths(
    canvas: &mut Canvas,
    [left, top, right, bottom]: Box4,
    design: &Design,
    trajectories: &[Path],
) {
    let reach = trajectories
        .iter()
        .filter_map(|(_, snapshots)| snapshots.first())
        .map(|s| s.motion.configuration.position().amax())
        .fold(0.5, f64::max)
        * 1.08;
    let side = plot_height(right - left) - MARGIN[0] - MARGIN[2];
    let square = [left, top, left + side + MARGIN[1] + MARGIN[3], bottom];
    let axes = ["x (m)", "y (m)"].map(|name| Axis::even([-reach, reach], 1.0, 8, name));
    let plot = Plot::new(canvas, square, MARGIN, axes, true);
    let view = View {
        origin: plot.at(0.0, 0.0),
        scale: side / (2.0 * reach),
        centre: nalgebra::Vector2::zeros(),
        turn: 0.0,
    };
    view.tiles(canvas, &design.pair, &design.pair.bound);
    for (run, snapshots) in trajectories {
        let points: Vec<_> = snapshots
            .iter()
            .map(|s| s.motion.configuration.position())
            .take_while(|p| p.amax() <= reach)
            .map(|p| view.pixel(p))
            .collect();
        let (colour, width) = match run.end {
            End::Bound { .. } => (GREEN, 2.4),
            End::Trapped { .. } => (INK, 1.4),
            End::Free => (FAINT, 1.0),
        };
        canvas.line(&points, colour, width);
        if let Some(first) = points.first() {
            start(canvas, *first, colour);
        }
    }
}

/// The colour of paths that end free, which are most of them.
const FAINT: RGBColor = RGBColor(150, 150, 150);
