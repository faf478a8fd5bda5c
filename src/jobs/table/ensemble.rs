//! The runs of a table, which can be computed in parts on different machines.

use serde::{Deserialize, Serialize};

use super::{About, Request};
use crate::checksum::sha256;
use physics::table::run::{HALVINGS, Run, Sample, Start};
use physics::table::{Crowd, Mover, TableSettings, usual_step};

/// The file of a part.
pub const PART: &str = "part.json";

/// Largest energy (J) and speed (m/s, rad/s) of a run that means anything.
const MOST_ENERGY: f64 = 1e9;
const FASTEST: f64 = 1e6;

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
    /// The runs of a request.
    pub fn of(about: &About, crowd: &Crowd, request: &Request, start: Start) -> Self {
        Self {
            tilebind: env!("CARGO_PKG_VERSION").to_owned(),
            tiles: Self::checksum(about, crowd),
            settings: request.settings(usual_step(crowd)),
            seed: request.seed,
            runs: request.runs,
            start,
            frames: request.keeps_frames(),
        }
    }

    /// A checksum of tiles.
    fn checksum(about: &About, crowd: &Crowd) -> String {
        let tiles: Vec<_> = crowd.kinds.iter().map(|it| (&it.name, &it.tile)).collect();
        sha256(format!(
            "{about:?} {:?} {:?} {tiles:?}",
            crowd.rim, crowd.goal
        ))
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

    /// The file of a part with these runs: this, the runs and a checksum of both.
    pub fn part(&self, runs: &[Run]) -> Vec<u8> {
        let part = serde_json::to_vec(&(self, runs, self.checksum_with(runs)));
        part.expect("a part has a form in JSON")
    }

    /// A checksum of this and its runs.
    fn checksum_with(&self, runs: &[Run]) -> String {
        sha256(serde_json::to_vec(&(self, runs)).unwrap_or_default())
    }

    /// All runs, in order, from the files of all parts, given by their names and texts.
    ///
    /// # Errors
    /// If a file is not a part of these runs, was changed, or runs are missing or occur twice.
    pub fn merge(&self, crowd: &Crowd, parts: &[(String, String)]) -> Result<Vec<Run>, String> {
        let mut all: Vec<Option<Run>> = vec![None; self.runs];
        for (name, text) in parts {
            let (whole, runs, sum): (Self, Vec<Run>, String) = serde_json::from_str(text)
                .map_err(|error| format!("{name}: no part of a table: {error}"))?;
            if sum != whole.checksum_with(&runs) {
                return Err(format!(
                    "{name} has been changed by hand: compute this part again"
                ));
            }
            if let Some(what) = self.difference(&whole) {
                return Err(format!(
                    "{name} was computed with {what}: give the command that computed the parts, with --merge \
                     in place of --shard"
                ));
            }
            for mut run in runs {
                let index = run.index;
                let is_sound = self.is_sound(crowd, &run);
                if index > 0 && !self.frames {
                    // The first run of every part has them.
                    run.samples.iter_mut().for_each(|it| it.movers = None);
                }
                let place = all.get_mut(index).filter(|_| is_sound);
                let Some(place) = place else {
                    return Err(format!(
                        "{name}: run {index} has values that no run has: compute this part again"
                    ));
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

    /// Whether every value of a run is one that a run can have.
    fn is_sound(&self, crowd: &Crowd, run: &Run) -> bool {
        let (kinds, settings) = (self.kinds(), &self.settings);
        let is_of = |tiles: &[usize; 2]| tiles[0] < tiles[1] && tiles[1] < kinds.len();
        let is_time = |time: f64| (0.0..=settings.duration + settings.step).contains(&time);
        let is_energy = |energy: f64| energy.abs() <= MOST_ENERGY;
        let is_kinetic = |energy: f64| (0.0..=MOST_ENERGY).contains(&energy);
        let are_movers = |movers: &[Mover]| {
            let is_here = |it: &Mover| {
                let [x, y] = crowd.rim.half_size();
                let place = it.place;
                place.x.abs() <= x
                    && place.y.abs() <= y
                    && place.z.is_finite()
                    && it.velocity.iter().all(|v| v.abs() <= FASTEST)
            };
            let of_kinds = movers.iter().map(|it| it.kind);
            of_kinds.eq(kinds.iter().copied()) && movers.iter().all(is_here)
        };
        let is_sample = |it: &Sample| {
            let account = it.account;
            is_time(it.time)
                && is_kinetic(it.kinetic)
                && [
                    it.potential,
                    account.work,
                    account.contact_loss,
                    account.drag_loss,
                ]
                .into_iter()
                .all(is_energy)
                && it
                    .held
                    .iter()
                    .all(|it| is_of(&it.tiles) && is_energy(it.energy))
                && it
                    .clusters
                    .iter()
                    .all(|size| (1..=kinds.len()).contains(size))
                && it.clusters.iter().sum::<usize>() == kinds.len()
                && it.structures.iter().all(|of| {
                    of.tiles.iter().all(|tile| *tile < kinds.len())
                        && (1..=of.possible).contains(&of.bonds)
                })
                && it.movers.as_deref().map_or(!self.frames, are_movers)
        };
        let rises = run.samples.windows(2).all(|two| two[0].time < two[1].time);
        // The same numbers as in the run itself.
        let halved = std::iter::successors(Some(settings.step), |step| Some(0.5 * step));
        let samples = TableSettings {
            step: run.step,
            ..settings.clone()
        }
        .samples();
        halved
            .take(1 + HALVINGS)
            .any(|step| step.to_bits() == run.step.to_bits())
            && run.samples.len() as u64 == samples
            && rises
            && run.samples.iter().all(is_sample)
            && are_movers(&run.movers)
            && is_kinetic(run.kinetic)
            && is_kinetic(run.energy_error)
            && run.lives.iter().all(|life| {
                let to = life.to.unwrap_or(settings.duration);
                is_of(&life.tiles)
                    && is_time(life.from)
                    && is_time(to)
                    && life.from <= to + settings.step
            })
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
