//! Paths of docking tiles.

use plotters::prelude::RGBColor;

use super::composition::{Composition, Panel, part};
use super::key::{Key, POLE_KEYS, key_table, start};
use super::marks::{Box4, View, polyline, tile};
use super::picture::{Area, PictureError};
use super::style::{Axis, FIXED_FILL, GREEN, INK, MOVING_FILL, chart, pixel};
use super::{Figure, Sheet};
use crate::csv::table;
use jobs::design::Design;
use jobs::docking::Path;
use physics::configuration::Configuration;
use physics::dynamics::docking::End;
use physics::tile::Pair;

const WIDTH: f64 = 860.0;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];

/// Paths of the moving tile's reference point by where they end, and the tile where it is bound.
///
/// # Errors
/// See [`PictureError`].
pub fn trajectories(
    design: &Design,
    trajectories: &[Path],
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let mut entries = vec![
        (Key::Line(GREEN), "ends bound"),
        (Key::Line(INK), "ends in a trap"),
        (Key::Line(FAINT), "ends free"),
        (Key::Start, "start"),
    ];
    entries.extend(POLE_KEYS);
    let panel = Panel::new("", 0.0, plot_height, |root, _, place| {
        paths(root, place, design, trajectories)
    });
    let composition = Composition {
        name: "trajectories".to_owned(),
        title: format!(
            "{}: paths of the moving tile's centre, {} of the runs",
            design.name,
            trajectories.len()
        ),
        note: None,
        width: WIDTH,
        panels: vec![panel],
        key: Some(key_table(entries)),
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

/// What a path's end is called.
pub fn ending(end: &End) -> &'static str {
    match end {
        End::Bound { .. } => "bound",
        End::Trapped { .. } => "misbound",
        End::Free => "free",
    }
}

/// Of a square plot at a width (pixels).
fn plot_height(width: f64) -> f64 {
    MARGIN[0] + (width - MARGIN[1] - MARGIN[3]).min(700.0) + MARGIN[2]
}

fn paths(
    root: &Area,
    place: Box4,
    design: &Design,
    trajectories: &[Path],
) -> Result<(), PictureError> {
    let reach = trajectories
        .iter()
        .filter_map(|(_, snapshots)| snapshots.first())
        .map(|s| s.motion.configuration.position().amax())
        .fold(0.5, f64::max)
        * 1.08;
    let [left, top, right, bottom] = place;
    let plot = plot_height(right - left) - MARGIN[0] - MARGIN[2];
    let square = [left, top, left + plot + MARGIN[1] + MARGIN[3], bottom];
    let axis = |name: &str| Axis::linear(-reach..reach, 8, name);
    let area = part(root, square);
    let chart = chart(&area, MARGIN, &axis("x (m)"), &axis("y (m)"), true)?;
    let view = View {
        origin: pixel(&chart, 0.0, 0.0),
        scale: plot / (2.0 * reach),
        centre: nalgebra::Vector2::zeros(),
        turn: 0.0,
    };
    let Pair {
        fixed,
        moving,
        bound,
        ..
    } = &*design.pair;
    tile(root, &view, moving, bound, MOVING_FILL)?;
    let origin = Configuration::new(0.0, 0.0, 0.0);
    tile(root, &view, fixed, &origin, FIXED_FILL)?;
    for (run, snapshots) in trajectories {
        let points: Vec<_> = snapshots
            .iter()
            .map(|s| s.motion.configuration.position())
            .take_while(|p| p.amax() <= reach)
            .map(|p| view.pixel(p))
            .collect();
        let (colour, width) = look(&run.end);
        polyline(root, &points, colour, width)?;
        if let Some(first) = points.first() {
            start(root, *first, colour)?;
        }
    }
    Ok(())
}

/// Paths that end free, most of them.
const FAINT: RGBColor = RGBColor(150, 150, 150);

fn look(end: &End) -> (RGBColor, f64) {
    match end {
        End::Bound { .. } => (GREEN, 2.4),
        End::Trapped { .. } => (INK, 1.4),
        End::Free => (FAINT, 1.0),
    }
}
