//! The animation of many tiles on a page.

use serde::Serialize;

use super::landscape::Drawn;
use super::numbers::rounded;
use jobs::table::TableResult;
use physics::table::contacts::{Held, Tie};
use physics::table::{Mover, Sample};

/// Largest number of poses on a page; with more tiles there are fewer frames.
const MOST_POSES: usize = 20_000;

/// A run, frame by frame.
#[derive(Clone, Debug, Serialize)]
pub struct Crowd {
    /// The caption.
    note: String,
    /// The table's size (m).
    size: [f64; 2],
    /// Whether it is a disc.
    round: bool,
    /// The kinds of tiles.
    kinds: Vec<TileKind>,
    /// The index of each tile's kind.
    tiles: Vec<usize>,
    /// The frames, in order.
    frames: Vec<Frame>,
}

/// A kind of tiles.
#[derive(Clone, Debug, Serialize)]
struct TileKind {
    name: String,
    /// The centre of mass (m), where lines end.
    centre: [f64; 2],
    #[serde(flatten)]
    shape: Drawn,
}

/// The table at one time.
#[derive(Clone, Debug, Serialize)]
struct Frame {
    time: f64,
    /// x, y (m) and theta (rad) of each tile.
    poses: Vec<[f64; 3]>,
    bonds: Vec<[usize; 2]>,
    traps: Vec<[usize; 2]>,
    /// The kind of structure that each tile belongs to; empty for single tiles.
    built: Vec<&'static str>,
}

impl Crowd {
    /// The animation of the first computed run; it always includes the last frame.
    pub fn new(found: &TableResult) -> Self {
        let crowd = &found.crowd;
        let run = found.runs.first();
        let kept: Vec<(&Sample, &Vec<Mover>)> = run
            .into_iter()
            .flat_map(|run| &run.samples)
            .filter_map(|sample| Some((sample, sample.movers.as_ref()?)))
            .collect();
        let tiles = found.ensemble.kinds();
        let most = (MOST_POSES / tiles.len().max(1)).max(2);
        let every = kept.len().div_ceil(most).max(1);
        let last = kept.len().saturating_sub(1);
        let tied = |held: &[Held], tie: Tie| -> Vec<[usize; 2]> {
            let of_tie = held.iter().filter(|held| held.tie == tie);
            of_tie.map(|held| held.tiles).collect()
        };
        let pose = |mover: &Mover| {
            let [x, y, theta] = mover.motion(crowd).configuration.to_array();
            // A tenth of a millimetre on a table of a metre is less than a pixel.
            [rounded(x, 4), rounded(y, 4), rounded(theta, 4)]
        };
        let shown = kept
            .iter()
            .enumerate()
            .filter(|(k, _)| (last - k).is_multiple_of(every));
        let frames = shown.map(|(_, (sample, movers))| Frame {
            time: rounded(sample.time, 6),
            poses: movers.iter().map(pose).collect(),
            bonds: tied(&sample.held, Tie::Bond),
            traps: tied(&sample.held, Tie::Trap),
            built: built(sample, movers.len()),
        });
        Self {
            note: format!(
                "Run {}: lines join the tiles of bonds and traps; the tiles of rings, chains and sheets, and of \
                 the target, have one colour each.",
                run.map_or(0, |run| run.index)
            ),
            size: crowd.rim.half_size().map(|half| 2.0 * half),
            round: crowd.rim.radius().is_some(),
            kinds: crowd
                .kinds
                .iter()
                .map(|kind| TileKind {
                    name: kind.name.clone(),
                    centre: kind.body.centre.into(),
                    shape: Drawn::new(&kind.tile),
                })
                .collect(),
            tiles,
            frames: frames.collect(),
        }
    }
}

/// The kind of structure of each tile; the target comes before its own kind.
fn built(sample: &Sample, tiles: usize) -> Vec<&'static str> {
    let mut built = vec![""; tiles];
    for structure in sample.structures.iter().rev() {
        for tile in &structure.tiles {
            built[*tile] = structure.shape.name();
        }
    }
    built
}
