//! Docking: the chance of a match over orientation and speed, and trajectories.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::heat::{Key, POLE_KEYS, frame, keys};
use super::marks::{View, outline, polyline, seamed_line, tile};
use super::picture::{Area, Bitmap, Picture, PictureError, Underlay};
use super::scale::colour;
use super::style::{
    Axis, FIXED_FILL, GREEN, INK, LABEL, MOVING_FILL, SMALL, SOFT, Text, chart, pixel, title, units,
};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::dynamics::Snapshot;
use crate::dynamics::docking::{DockingMap, End};

const WIDTH: u32 = 860;
const HEIGHT: u32 = 640;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [54.0, 150.0, 62.0, 84.0];
/// Chances with contours.
const LEVELS: [f64; 5] = [0.04, 0.08, 0.12, 0.16, 0.24];
const COLOURS: usize = 200;
/// Pixels of the embedded image across a cell, so that cells keep their edges.
const SHARP: usize = 16;

/// The chance of a match over relative orientation and speed, with contours of the chances
/// averaged over neighbouring cells.
///
/// # Errors
/// See [`PictureError`].
pub fn map(design: &Design, map: &DockingMap) -> Result<Picture, PictureError> {
    let [columns, rows] = map.size;
    let share = |i: usize, j: usize| map.cells[j * columns + i].matched.share();
    let most = map
        .cells
        .iter()
        .map(|c| c.matched.share())
        .fold(0.05, f64::max);
    let (first, last) = (&map.cells[0], &map.cells[map.cells.len() - 1]);
    let (across, up) = (
        [first.orientation[0], last.orientation[1]],
        [first.speed[0], last.speed[1]],
    );
    Picture::draw((WIDTH, HEIGHT), |root, underlays| {
        title(root, &format!("{}: chance of a match", design.name))?;
        let x_axis = Axis::linear(
            across[0]..across[1],
            7,
            "orientation relative to the bond (rad)",
        );
        let y_axis = Axis::linear(up[0]..up[1], 8, "speed (m/s)");
        let chart = chart(root, MARGIN, &x_axis, &y_axis, false)?;
        let frame = frame(&chart, &across, &up);
        let shade = |p: f64| (p / most * (COLOURS - 1) as f64).round() as u8;
        let palette = |k: usize| colour(-(k as f64) / (COLOURS - 1) as f64);
        let palette: Vec<_> = (0..COLOURS).map(palette).collect();
        underlays.push(Underlay {
            bitmap: Bitmap {
                width: columns * SHARP,
                palette: palette.clone(),
                pixels: (0..rows * columns * SHARP * SHARP)
                    .map(|k| {
                        let (i, j) = (k % (columns * SHARP), k / (columns * SHARP));
                        shade(share(i / SHARP, rows - 1 - j / SHARP))
                    })
                    .collect(),
            },
            rectangle: frame.map(units),
        });
        outline(root, frame, INK)?;
        let smooth = smoothed(map);
        let at = |u: f64, v: f64| {
            pixel(
                &chart,
                across[0] + (u + 0.5) / columns as f64 * (across[1] - across[0]),
                up[0] + (v + 0.5) / rows as f64 * (up[1] - up[0]),
            )
        };
        for level in LEVELS {
            for [a, b] in contour(&smooth, map.size, level) {
                let width = if level == LEVELS[0] { 2.4 } else { 1.2 };
                seamed_line(root, &[at(a.0, a.1), at(b.0, b.1)], INK, width)?;
            }
        }
        bar(root, underlays, palette, most)
    })
}

/// The colours with their chances and the contours' levels, at the right.
fn bar(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    palette: Vec<[u8; 3]>,
    most: f64,
) -> Result<(), PictureError> {
    let [left, top, right, bottom] = [740.0, 90.0, 762.0, 400.0];
    underlays.push(Underlay {
        bitmap: Bitmap {
            width: 1,
            palette,
            pixels: (0..COLOURS).rev().map(|k| k as u8).collect(),
        },
        rectangle: [left, top, right, bottom].map(units),
    });
    outline(root, [left, top, right, bottom], INK)?;
    Text::new(LABEL).write(
        root,
        "chance",
        (left, top - 12.0),
        (HPos::Left, VPos::Bottom),
    )?;
    for level in [0.0].into_iter().chain(LEVELS).filter(|l| *l <= most) {
        let y = bottom - (bottom - top) * level / most;
        polyline(root, &[(left, y), (right + 6.0, y)], INK, 1.2)?;
        let text = format!("{:.0} %", 100.0 * level);
        Text::new(SMALL).write(root, &text, (right + 11.0, y), (HPos::Left, VPos::Center))?;
    }
    let note = Text::new(SMALL).colour(SOFT);
    for (k, line) in ["lines: averaged", "over neighbours", "thick: 4 %"]
        .iter()
        .enumerate()
    {
        let place = (left - 12.0, bottom + 34.0 + 19.0 * k as f64);
        note.write(root, line, place, (HPos::Left, VPos::Center))?;
    }
    Ok(())
}

/// Chances averaged over the cells around, with weights 1, 2, 1 along each direction.
fn smoothed(map: &DockingMap) -> Vec<f64> {
    let [columns, rows] = map.size;
    let near = |k: usize, n: usize| (k.saturating_sub(1)..(k + 2).min(n)).collect::<Vec<_>>();
    (0..columns * rows)
        .map(|cell| {
            let (i, j) = (cell % columns, cell / columns);
            let (mut matched, mut of) = (0, 0);
            for b in near(j, rows) {
                for a in near(i, columns) {
                    let weight = (1 + usize::from(a == i)) * (1 + usize::from(b == j));
                    let p = map.cells[b * columns + a].matched;
                    matched += weight * p.count;
                    of += weight * p.of;
                }
            }
            matched as f64 / of.max(1) as f64
        })
        .collect()
}

type Place = (f64, f64);

/// The pieces of a contour line of values on a grid, by marching triangles: each square is cut
/// along a diagonal, and a line crosses each triangle in at most one piece.
fn contour(values: &[f64], [columns, rows]: [usize; 2], level: f64) -> Vec<[Place; 2]> {
    let corner = |i: usize, j: usize| ((i as f64, j as f64), values[j * columns + i]);
    let mut pieces = Vec::new();
    for j in 0..rows.saturating_sub(1) {
        for i in 0..columns.saturating_sub(1) {
            let [a, b, c, d] = [
                corner(i, j),
                corner(i + 1, j),
                corner(i + 1, j + 1),
                corner(i, j + 1),
            ];
            for triangle in [[a, b, c], [a, c, d]] {
                let crossings: Vec<Place> = (0..3)
                    .filter_map(|k| {
                        let (p, q) = (triangle[k], triangle[(k + 1) % 3]);
                        let crosses = (p.1 < level) != (q.1 < level);
                        let t = (level - p.1) / (q.1 - p.1);
                        let between = |a: f64, b: f64| a + (b - a) * t;
                        crosses.then(|| (between(p.0.0, q.0.0), between(p.0.1, q.0.1)))
                    })
                    .collect();
                if let [p, q] = crossings[..] {
                    pieces.push([p, q]);
                }
            }
        }
    }
    pieces
}

/// Paths of the moving tile's reference point by where they end, and the tile where it is bound.
///
/// # Errors
/// See [`PictureError`].
pub fn trajectories(
    design: &Design,
    trajectories: &[(End, Vec<Snapshot>)],
) -> Result<Picture, PictureError> {
    const SIDE: u32 = 760;
    const PLOT: f64 = 620.0;
    let reach = trajectories
        .iter()
        .filter_map(|(_, snapshots)| snapshots.first())
        .map(|s| s.motion.configuration.position().amax())
        .fold(0.5, f64::max)
        * 1.08;
    Picture::draw((SIDE + 160, SIDE - 24), |root, underlays| {
        title(root, &format!("{}: sampled trajectories", design.name))?;
        let margin = [54.0, f64::from(SIDE) + 160.0 - PLOT - 84.0, 62.0, 84.0];
        let axis = |name: &str| Axis::linear(-reach..reach, 8, name);
        let chart = chart(root, margin, &axis("x (m)"), &axis("y (m)"), true)?;
        let view = View {
            origin: pixel(&chart, 0.0, 0.0),
            scale: PLOT / (2.0 * reach),
            centre: nalgebra::Vector2::zeros(),
            turn: 0.0,
        };
        tile(
            root,
            &view,
            &design.pair.moving,
            &design.pair.bound,
            MOVING_FILL,
        )?;
        let origin = Configuration::new(0.0, 0.0, 0.0);
        tile(root, &view, &design.pair.fixed, &origin, FIXED_FILL)?;
        for (end, snapshots) in trajectories {
            let points: Vec<_> = snapshots
                .iter()
                .map(|s| s.motion.configuration.position())
                .take_while(|p| p.amax() <= reach)
                .map(|p| view.pixel(p))
                .collect();
            let (colour, width) = look(end);
            polyline(root, &points, colour, width)?;
            if let Some((x, y)) = points.first() {
                let dot = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)];
                let dot = dot.map(|(dx, dy)| (x + dx, y + dy));
                super::marks::polygon(root, &dot, colour, None)?;
            }
        }
        let mut entries = vec![
            (Key::Colour(GREEN), "path, ends bound"),
            (Key::Colour(INK), "path, ends in a trap"),
            (Key::Colour(FAINT), "path, ends free"),
        ];
        entries.extend(POLE_KEYS);
        keys(root, underlays, (84.0 + PLOT + 24.0, 90.0), &entries)?;
        Ok(())
    })
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

#[cfg(test)]
mod tests {
    use super::contour;

    #[test]
    fn the_contour_of_a_plane_is_a_straight_line() {
        // Values x + y on 4 x 3 points; the level 2.5 is the line x + y = 2.5.
        let values: Vec<f64> = (0..12).map(|k| (k % 4 + k / 4) as f64).collect();
        let pieces = contour(&values, [4, 3], 2.5);
        assert!(!pieces.is_empty());
        assert!(
            pieces
                .iter()
                .flatten()
                .all(|p| (p.0 + p.1 - 2.5).abs() < 1e-12)
        );
        assert!(contour(&values, [4, 3], 9.0).is_empty());
    }
}
