//! Docking: the chance of a match over orientation and speed.

use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part, remark, stacked};
use super::contour::contour;
use super::heat::frame;
use super::marks::{Box4, outline, polyline, seamed_line};
use super::picture::{Area, Bitmap, PictureError, Underlay};
use super::scale::colour;
use super::style::{Axis, INK, SMALL, Text, chart, pixel, units};
use super::{Figure, Sheet};
use jobs::design::Design;
use physics::dynamics::docking::DockingMap;

const WIDTH: f64 = 860.0;
/// Space around a plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
/// Chances with contours.
const LEVELS: [f64; 5] = [0.04, 0.08, 0.12, 0.16, 0.24];
const COLOURS: usize = 200;
/// Pixels of the embedded image across a cell, so that cells keep their edges.
const SHARP: usize = 48;
/// Runs a cell at least, as far as cells can be made larger: the 95 % interval of a chance of a tenth
/// is then 0.04 to 0.24.
const RUNS_A_CELL: usize = 32;
/// The most cells along the orientation and the speed, and the fewest along either.
const CELLS: [usize; 2] = [12, 13];
const FEWEST: usize = 3;

/// How many cells along the orientation and the speed so many runs can fill.
pub fn cells(runs: usize) -> [usize; 2] {
    let side = (runs as f64 / RUNS_A_CELL as f64).sqrt() as usize;
    CELLS.map(|most| side.clamp(FEWEST, most))
}

/// The chance of a match over relative orientation and speed, with contours of the chances
/// averaged over neighbouring cells.
///
/// # Errors
/// See [`PictureError`].
pub fn chances(design: &Design, map: &DockingMap, sheet: &Sheet) -> Result<Figure, PictureError> {
    let most = map
        .cells
        .iter()
        .map(|c| c.matched.share())
        .fold(0.05, f64::max);
    let runs = map.cells.iter().map(|c| c.matched.of);
    let (fewest, many) = (runs.clone().min().unwrap_or(0), runs.max().unwrap_or(0));
    let bar = Panel::new(
        "",
        0.0,
        |_| 82.0,
        move |root, underlays, place| bar(root, underlays, most, place),
    );
    let said = format!(
        "cells: {fewest} to {many} runs each; lines: chances averaged over neighbouring cells, the \
         thick one at {:.0} %",
        100.0 * LEVELS[0]
    );
    let panel = Panel::new(
        "",
        0.0,
        |width| 0.68 * width,
        |root, underlays, place| map_panel(root, underlays, place, map, most),
    );
    let composition = Composition {
        name: "chances".to_owned(),
        title: format!("{}: chance of a match", design.name),
        note: None,
        width: WIDTH,
        panels: vec![panel],
        key: Some(stacked(bar, remark(said))),
    };
    Figure::new(&composition, sheet, crate::docking::chances(map).csv())
}

/// Colour of a share of the greatest chance.
fn shaded(share: f64) -> u8 {
    (share * (COLOURS - 1) as f64).round() as u8
}

fn palette() -> Vec<[u8; 3]> {
    let shade = |k: usize| colour(-(k as f64) / (COLOURS - 1) as f64);
    (0..COLOURS).map(shade).collect()
}

fn map_panel(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    place: Box4,
    map: &DockingMap,
    most: f64,
) -> Result<(), PictureError> {
    let [columns, rows] = map.size;
    let share = |i: usize, j: usize| map.cells[j * columns + i].matched.share();
    let (first, last) = (&map.cells[0], &map.cells[map.cells.len() - 1]);
    let (across, up) = (
        [first.orientation[0], last.orientation[1]],
        [first.speed[0], last.speed[1]],
    );
    let x_axis = Axis::linear(
        across[0]..across[1],
        7,
        "orientation relative to the bond (rad)",
    );
    let y_axis = Axis::linear(up[0]..up[1], 8, "speed (m/s)");
    let area = part(root, place);
    let chart = chart(&area, MARGIN, &x_axis, &y_axis, false)?;
    let frame = frame(&chart, &across, &up);
    underlays.push(Underlay {
        bitmap: Bitmap {
            width: columns * SHARP,
            palette: palette(),
            pixels: (0..rows * columns * SHARP * SHARP)
                .map(|k| {
                    let (i, j) = (k % (columns * SHARP), k / (columns * SHARP));
                    shaded(share(i / SHARP, rows - 1 - j / SHARP) / most)
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
    Ok(())
}

/// The colours with their chances, up to the greatest, and the contours' levels.
fn bar(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    most: f64,
    [left, top, right, _]: Box4,
) -> Result<(), PictureError> {
    let [left, top, right, bottom] = [left + MARGIN[3], top + 26.0, right - MARGIN[1], top + 44.0];
    underlays.push(Underlay {
        bitmap: Bitmap {
            width: COLOURS,
            palette: palette(),
            pixels: (0..COLOURS).map(|k| k as u8).collect(),
        },
        rectangle: [left, top, right, bottom].map(units),
    });
    outline(root, [left, top, right, bottom], INK)?;
    let small = Text::new(SMALL);
    small.write(
        root,
        "chance",
        (left, top - 6.0),
        (HPos::Left, VPos::Bottom),
    )?;
    let mut last = f64::INFINITY;
    // The ends first; then the levels, as far as their numbers keep clear of those to their right.
    let levels = LEVELS.iter().rev().copied().filter(|level| *level < most);
    for level in [most].into_iter().chain(levels).chain([0.0]) {
        let x = left + (right - left) * level / most;
        polyline(root, &[(x, top), (x, bottom + 6.0)], INK, 1.2)?;
        if last - x > 42.0 || level == 0.0 {
            last = x;
            let text = format!("{:.0} %", 100.0 * level);
            small.write(root, &text, (x, bottom + 10.0), (HPos::Center, VPos::Top))?;
        }
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

#[cfg(test)]
mod tests {
    use super::{CELLS, cells};

    #[test]
    fn cells_are_as_many_as_the_runs_fill() {
        assert_eq!(cells(100_000), CELLS);
        let [columns, rows] = cells(600);
        assert!(columns * rows * 30 <= 600 && columns > 3);
        assert_eq!(cells(1), [3, 3]);
    }
}
