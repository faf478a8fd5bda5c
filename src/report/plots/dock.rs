//! The probability of a match over orientation and speed.

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel, remark};
use super::contour::contour;
use super::heat::{Marked, bar, cells as fill};
use super::picture::PictureError;
use super::scale::colour;
use super::style::INK;
use super::{Figure, Sheet};
use jobs::design::Design;
use physics::dynamics::docking::DockingMap;
use physics::units::share_with;

const WIDTH: f64 = 860.0;
/// Space around a plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
/// Probabilities of the contour lines.
const LEVELS: [f64; 5] = [0.04, 0.08, 0.12, 0.16, 0.24];
/// Least number of runs per cell, as far as cells can be enlarged: the 95 % interval of a
/// probability of a tenth is then 0.04 to 0.24.
const RUNS_A_CELL: usize = 32;
/// Largest numbers of cells along the orientation and the speed, and the smallest along each.
const CELLS: [usize; 2] = [12, 13];
const FEWEST: usize = 3;

/// The numbers of cells along the orientation and the speed for a number of runs.
pub fn cells(runs: usize) -> [usize; 2] {
    let side = (runs as f64 / RUNS_A_CELL as f64).sqrt() as usize;
    CELLS.map(|most| side.clamp(FEWEST, most))
}

/// The probability of a match over relative orientation and speed, with contours of the
/// probabilities averaged over neighbouring cells; `numbers` are the same as CSV.
///
/// # Errors
/// See [`PictureError`].
pub fn chances(
    design: &Design,
    map: &DockingMap,
    numbers: String,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let most = map
        .cells
        .iter()
        .map(|c| c.matched.share())
        .fold(0.05, f64::max);
    let runs = map.cells.iter().map(|c| c.matched.of);
    let (fewest, many) = (runs.clone().min().unwrap_or(0), runs.max().unwrap_or(0));
    // The ends first; then the levels whose numbers do not overlap others.
    let levels = LEVELS.into_iter().rev().filter(|level| *level < most);
    let marks = [most, 0.0].into_iter().chain(levels).map(|level| Marked {
        at: level / most,
        text: share_with(level, 0),
        is_crossed: true,
    });
    let said = format!(
        "cells: {fewest} to {many} runs each; lines: chances averaged over neighbouring cells, the \
         thick one at {}",
        share_with(LEVELS[0], 0)
    );
    let panel = Panel::alone(
        |width| 0.68 * width,
        |canvas, place| map_panel(canvas, place, map, most),
    );
    let composition = Composition {
        name: "chances".to_owned(),
        title: format!("{}: chance of a match", design.name),
        width: WIDTH,
        panels: vec![panel],
        keys: vec![bar("chance", shade, marks), remark(said)],
        ..Composition::default()
    };
    Figure::new(&composition, sheet, numbers)
}

/// The colour of a probability, relative to the largest one.
fn shade(share: f64) -> [u8; 3] {
    colour(-share)
}

fn map_panel(canvas: &mut Canvas, place: Box4, map: &DockingMap, most: f64) {
    let [columns, rows] = map.size;
    let (first, last) = (&map.cells[0], &map.cells[map.cells.len() - 1]);
    let (across, up) = (
        [first.orientation[0], last.orientation[1]],
        [first.speed[0], last.speed[1]],
    );
    let axes = [
        Axis::even(across, 1.0, 7, "orientation relative to the bond (rad)"),
        Axis::even(up, 1.0, 8, "speed (m/s)"),
    ];
    let plot = Plot::new(canvas, place, MARGIN, axes, false);
    fill(canvas, &plot, map.size, shade, |i, j| {
        Some(map.cells[j * columns + i].matched.share() / most)
    });
    let smooth = smoothed(map);
    let along = |[low, high]: [f64; 2], place: f64, of: usize| {
        low + (place + 0.5) / of as f64 * (high - low)
    };
    let at = |(u, v): (f64, f64)| plot.at(along(across, u, columns), along(up, v, rows));
    for level in LEVELS {
        let width = if level == LEVELS[0] { 2.4 } else { 1.2 };
        for piece in contour(&smooth, map.size, level) {
            canvas.seamed(&piece.map(at), INK, width);
        }
    }
}

/// Probabilities averaged over neighbouring cells, with weights 1, 2, 1 along each direction.
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
