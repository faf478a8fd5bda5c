//! The runs of a table, which can be computed in parts on different machines.

use serde::{Deserialize, Serialize};

use super::About;
use crate::checksum::sha256;
use physics::table::run::{Run, Start};
use physics::table::{Crowd, Mover, TableSettings};

/// The file of a part.
pub const PART: &str = "part.json";

/// Everything that determines the runs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ensemble {
    /// The version that computes them.
    pub tilebind: String,
    /// A checksum of the tiles and their magnets.
    pub tiles: String,
    /// The settings of each run.
    pub settings: TableSettings,
    /// The random seed.
    pub seed: u64,
    /// The number of runs.
    pub runs: usize,
    /// The starting positions.
    pub start: Start,
    /// Whether poses are recorded in all runs, not only in the first.
    pub frames: bool,
}

impl Ensemble {
    /// A checksum of tiles.
    pub(super) fn checksum(about: &About, crowd: &Crowd) -> String {
        let tiles: Vec<_> = crowd.kinds.iter().map(|it| (&it.name, &it.tile)).collect();
        sha256(format!("{about:?} {:?} {tiles:?}", crowd.half_size))
    }

    /// The index of each tile's kind.
    pub fn kinds(&self) -> Vec<usize> {
        match &self.start {
            Start::Random(counts) => {
                let of_kind = counts.iter().enumerate();
                of_kind
                    .flat_map(|(kind, count)| std::iter::repeat_n(kind, *count))
                    .collect()
            }
            Start::Given(movers) => movers.iter().map(|mover| mover.kind).collect(),
        }
    }

    /// All runs, in order, from the files of all parts, given by their names and texts.
    ///
    /// # Errors
    /// If a file is not a part of these runs, or runs are missing or occur twice.
    pub fn merge(&self, parts: &[(String, String)]) -> Result<Vec<Run>, String> {
        let kinds = self.kinds();
        let mut all: Vec<Option<Run>> = vec![None; self.runs];
        for (name, text) in parts {
            let (whole, runs): (Self, Vec<Run>) = serde_json::from_str(text)
                .map_err(|error| format!("{name}: no part of a table: {error}"))?;
            if let Some(what) = self.difference(&whole) {
                return Err(format!(
                    "{name} was computed with {what}: give the command that computed the parts, with --merge \
                     in place of --shard"
                ));
            }
            for mut run in runs {
                let index = run.index;
                if index > 0 && !self.frames {
                    // The first run of every part has them.
                    run.samples.iter_mut().for_each(|it| it.movers = None);
                }
                let place = all.get_mut(index).filter(|_| is_sound(&run, &kinds));
                let Some(place) = place else {
                    return Err(format!("{name}: run {index} has been changed by hand"));
                };
                if place.replace(run).is_some() {
                    return Err(format!("{name}: run {index} is in another part, too"));
                }
            }
        }
        let missing: Vec<String> = (0..self.runs)
            .filter(|index| all[*index].is_none())
            .map(|index| index.to_string())
            .collect();
        match missing.is_empty() {
            true => Ok(all.into_iter().flatten().collect()),
            false => Err(format!(
                "{} of {} runs are in no part: numbers {} (from 0)",
                missing.len(),
                self.runs,
                missing.join(", ")
            )),
        }
    }

    /// What differs between two ensembles.
    fn difference(&self, other: &Self) -> Option<&'static str> {
        [
            (self.tilebind == other.tilebind, "another version"),
            (self.tiles == other.tiles, "other tiles"),
            (self.settings == other.settings, "other settings"),
            (self.seed == other.seed, "another seed"),
            (self.runs == other.runs, "another number of runs"),
            (self.start == other.start, "another start"),
            (self.frames == other.frames, "another --frames"),
        ]
        .into_iter()
        .find_map(|(same, what)| (!same).then_some(what))
    }
}

/// Whether all tiles of a run exist, and are of their kinds.
fn is_sound(run: &Run, kinds: &[usize]) -> bool {
    let exist = |tiles: &[usize]| tiles.iter().all(|tile| *tile < kinds.len());
    let are_all = |movers: &[Mover]| movers.iter().map(|it| it.kind).eq(kinds.iter().copied());
    are_all(&run.movers)
        && !run.samples.is_empty()
        && run.lives.iter().all(|life| exist(&life.tiles))
        && run.samples.iter().all(|sample| {
            sample.held.iter().all(|held| exist(&held.tiles))
                && sample.movers.as_ref().is_none_or(|movers| are_all(movers))
        })
}
