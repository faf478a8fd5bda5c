//! Many tiles on a table: the end of every run, and a run as an animated picture.

use nalgebra::Vector2;

use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel};
use super::marks::View;
use super::picture::{PictureError, animated};
use super::style::{Anchor, FIXED_FILL, INK, LABEL, MOVING_FILL};
use super::{Drawing, Figure, Sheet};
use crate::csv;
use jobs::table::TableResult;
use physics::table::contacts::Tie;
use physics::table::{Mover, Sample};
use physics::units::{counted, duration};
use plotters::style::RGBColor;

/// Width (pixels) of a sheet of panels, and the least width of a panel.
const WIDTH: f64 = 1000.0;
const LEAST: [f64; 2] = [230.0, 170.0];
/// Height of a panel's text and the space around its table (pixels).
const HEAD: f64 = 28.0;
const SPACE: f64 = 10.0;
/// Runs in one picture, and in all of them.
const TOGETHER: usize = 20;
const MOST: usize = 200;
/// The longer side of a frame (pixels), the largest number of frames, and the longest playing time (s).
const FRAME: f64 = 480.0;
const FRAMES: usize = 400;
const LONGEST: f64 = 40.0;
/// Corners of a round rim as it is drawn.
const ROUND: usize = 120;
/// The colours of tiles in structures.
const STRUCTURES: [(&str, RGBColor); 4] = [
    ("ring", RGBColor(63, 159, 216)),
    ("chain", RGBColor(207, 227, 247)),
    ("sheet", RGBColor(243, 211, 91)),
    ("target", RGBColor(209, 116, 159)),
];

/// The end of every computed run, in pictures of some runs each.
pub fn ends(found: &TableResult) -> Vec<Drawing<'_>> {
    let runs = &found.runs[..found.runs.len().min(MOST)];
    let parts = runs.chunks(TOGETHER).enumerate();
    let drawing = |(number, part): (usize, &'_ [physics::table::Run])| {
        let name = match number {
            0 => "ends".to_owned(),
            _ => format!("ends-{}", number + 1),
        };
        let title = match found.runs.len() {
            1 => "The table at the end".to_owned(),
            all if all > MOST => format!("The table at the end of the first {MOST} of {all} runs"),
            _ => "The table at the end of every run".to_owned(),
        };
        let indices: Vec<usize> = part.iter().map(|run| run.index).collect();
        Drawing::new(title.clone(), move |sheet: &Sheet| {
            drawn(found, (&name, &title), &indices, sheet)
        })
        .off_page()
    };
    parts.map(drawing).collect()
}

/// One panel for each of these runs.
fn drawn(
    found: &TableResult,
    (name, title): (&str, &str),
    indices: &[usize],
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let [wide, high] = found.crowd.rim.half_size();
    let height = move |width: f64| HEAD + (width - 2.0 * SPACE) * high / wide + 2.0 * SPACE;
    let runs = found.runs.iter().filter(|it| indices.contains(&it.index));
    let runs: Vec<_> = runs
        .filter_map(|run| Some((run, run.samples.last()?)))
        .collect();
    let tiles = runs.iter().flat_map(|(run, _)| {
        let movers = run.movers.iter().enumerate();
        movers.map(move |(tile, mover)| (run.index, tile, mover))
    });
    let rows = tiles.map(|(run, tile, mover)| {
        let place = mover.motion(&found.crowd).configuration.to_array();
        let kind = found.crowd.kinds[mover.kind].name.clone();
        let [x, y, theta] = place.map(|it| it.to_string());
        [run.to_string(), tile.to_string(), kind, x, y, theta]
    });
    let numbers = csv::table(["run", "tile", "kind", "x", "y", "theta"], rows);
    let least = LEAST[usize::from(sheet.width(WIDTH) < 2.0 * LEAST[0])];
    let panels = runs.iter().map(|(run, last)| {
        let count = |tie: Tie, one: &str| counted(last.count(tie), one);
        let told = format!(
            "run {}: {}, {}",
            run.index,
            count(Tie::Bond, "bond"),
            count(Tie::Trap, "trap")
        );
        let draw = move |canvas: &mut Canvas, [left, top, right, bottom]: Box4| {
            let inner = [left + SPACE, top + HEAD, right - SPACE, bottom - SPACE];
            table(found, canvas, (&run.movers, last), inner);
            let at = ((left + right) / 2.0, top + 6.0);
            canvas.write(LABEL.within(right - left, &told), &told, at, Anchor::Top);
        };
        Panel::new(format!("run-{}", run.index), least, height, draw)
    });
    let composition = Composition {
        name: name.to_owned(),
        title: title.to_owned(),
        width: WIDTH,
        panels: panels.collect(),
        ..Composition::default()
    };
    Figure::new(&composition, sheet, numbers)
}

/// Draws the rim and the tiles in a rectangle of a picture.
fn table(
    found: &TableResult,
    canvas: &mut Canvas,
    (movers, sample): (&[Mover], &Sample),
    inner: Box4,
) {
    let crowd = &found.crowd;
    let half = Vector2::from(crowd.rim.half_size());
    let view = View::filling(inner, [-half, half]);
    let rim: Vec<Vector2<f64>> = match crowd.rim.radius() {
        Some(radius) => (0..ROUND)
            .map(|k| {
                let angle = std::f64::consts::TAU * k as f64 / ROUND as f64;
                Vector2::new(libm::cos(angle), libm::sin(angle)) * radius
            })
            .collect(),
        None => [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| Vector2::new(x * half.x, y * half.y))
            .to_vec(),
    };
    let mut rim: Vec<_> = rim.into_iter().map(|p| view.pixel(p)).collect();
    rim.extend(rim.first().copied());
    canvas.line(&rim, INK, 1.5);
    let mut built = vec![None; movers.len()];
    for structure in sample.structures.iter().rev() {
        let name = structure.shape.name();
        let colour = STRUCTURES.iter().find(|it| it.0 == name).map(|it| it.1);
        for tile in &structure.tiles {
            built[*tile] = colour;
        }
    }
    for (mover, built) in movers.iter().zip(built) {
        let own = [FIXED_FILL, MOVING_FILL][mover.kind % 2];
        let q = mover.motion(crowd).configuration;
        view.tile(
            canvas,
            &crowd.kinds[mover.kind].tile,
            &q,
            built.unwrap_or(own),
        );
    }
}

/// The first computed run as an animated PNG: its recorded frames in real time, or faster if it is long.
///
/// # Errors
/// See [`PictureError`].
pub fn film(found: &TableResult) -> Result<Option<Vec<u8>>, PictureError> {
    let run = found.runs.first();
    let samples = run.iter().flat_map(|run| &run.samples);
    let frames: Vec<(&Sample, &Vec<Mover>)> = samples
        .filter_map(|it| Some((it, it.movers.as_ref()?)))
        .collect();
    let every = frames.len().div_ceil(FRAMES).max(1);
    let last = frames.len().saturating_sub(1);
    let shown: Vec<_> = frames
        .iter()
        .enumerate()
        .filter(|(k, _)| (last - k).is_multiple_of(every))
        .map(|it| *it.1)
        .collect();
    if shown.len() < 2 {
        return Ok(None);
    }
    let whole = shown[shown.len() - 1].0.time - shown[0].0.time;
    let delay = whole.min(LONGEST) / (shown.len() - 1) as f64;
    let [wide, high] = found.crowd.rim.half_size();
    let scale = (FRAME - 2.0 * SPACE) / wide.max(high);
    let size = [wide, high].map(|half| half * scale + 2.0 * SPACE);
    let size = [size[0], size[1] + HEAD];
    let frame = |&(sample, movers): &(&Sample, &Vec<Mover>)| {
        let mut canvas = Canvas::new(size);
        let inner = [SPACE, HEAD + SPACE, size[0] - SPACE, size[1] - SPACE];
        table(found, &mut canvas, (movers, sample), inner);
        let told = duration(sample.time, 3);
        canvas.write(LABEL, &told, (size[0] / 2.0, 8.0), Anchor::Top);
        canvas
    };
    animated(shown.len(), delay, shown.iter().map(frame)).map(Some)
}
