//! Trajectories of docking tiles.

use nalgebra::Vector2;
use plotters::style::RGBColor;

use super::axes::{Axis, Plot};
use super::canvas::Canvas;
use super::composition::{Composition, Panel};
use super::key::{POLES, Sign, key, start};
use super::marks::{View, extent};
use super::picture::PictureError;
use super::style::{GREEN, INK};
use super::{Decimals, Figure, Sheet};
use crate::csv::{rounded, table};
use jobs::design::Design;
use jobs::docking::Path;
use physics::dynamics::docking::End;

const WIDTH: f64 = 860.0;
/// Space around the plot (pixels): top, right, bottom, left; its greatest height.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
const HIGHEST: f64 = 700.0;

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
    let reach = reach(trajectories);
    let [low, high] = seen(design, trajectories, reach);
    let size = high - low;
    let wide = move |width: f64| (width - MARGIN[1] - MARGIN[3]).min(HIGHEST * size.x / size.y);
    let height = move |width| MARGIN[0] + wide(width) * size.y / size.x + MARGIN[2];
    let panel = Panel::alone(height, |canvas, [left, top, right, bottom]| {
        let right = left + MARGIN[3] + wide(right - left) + MARGIN[1];
        let plotted = Plot::new(
            canvas,
            [left, top, right, bottom],
            MARGIN,
            [0, 1].map(|k| Axis::even([low[k], high[k]], 1.0, 6, ["x (m)", "y (m)"][k])),
            true,
        );
        let view = View::plotted(&plotted, size.x);
        paths(canvas, &view, design, trajectories, reach);
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
    let decimals = Decimals::of(&design.pair);
    let rows = trajectories
        .iter()
        .enumerate()
        .flat_map(|(number, (run, snapshots))| {
            snapshots.iter().map(move |snapshot| {
                let q = snapshot.motion.configuration;
                let mut row = vec![number.to_string(), ending(&run.end).to_owned()];
                row.push(rounded(snapshot.time, 7));
                row.extend(decimals.pose(q.to_array()));
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
        End::Unsolved => "unsolved",
    }
}

/// The largest |x| or |y| (m) that the picture shows.
fn reach(trajectories: &[Path]) -> f64 {
    let starts = trajectories.iter().filter_map(|(_, them)| them.first());
    let distances = starts.map(|start| start.motion.configuration.position().amax());
    1.02 * distances.fold(0.5, f64::max)
}

/// Where a path leads, as far as it is followed.
fn followed(path: &Path, reach: f64) -> impl Iterator<Item = Vector2<f64>> {
    let points = path.1.iter().map(|it| it.motion.configuration.position());
    points.take_while(move |p| p.amax() <= reach)
}

/// The corners of the rectangle (m) that holds the bound tiles and all paths, with a little room.
fn seen(design: &Design, trajectories: &[Path], reach: f64) -> [Vector2<f64>; 2] {
    let points = trajectories.iter().flat_map(|path| followed(path, reach));
    let tiles = extent(&design.pair, [&design.pair.bound]);
    let [low, high] = points.fold(tiles, |[low, high], p| [low.inf(&p), high.sup(&p)]);
    let room = 0.04 * (high - low);
    [low - room, high + room]
}

fn paths(canvas: &mut Canvas, view: &View, design: &Design, trajectories: &[Path], reach: f64) {
    view.tiles(canvas, &design.pair, &design.pair.bound);
    for path in trajectories {
        let points: Vec<_> = followed(path, reach).map(|p| view.pixel(p)).collect();
        let (colour, width) = match path.0.end {
            End::Bound { .. } => (GREEN, 2.4),
            End::Trapped { .. } => (INK, 1.4),
            End::Free | End::Unsolved => (FAINT, 1.0),
        };
        canvas.line(&points, colour, width);
        if let Some(first) = points.first() {
            start(canvas, *first, colour);
        }
    }
}

/// The colour of paths that end free, which are most of them.
const FAINT: RGBColor = RGBColor(150, 150, 150);
