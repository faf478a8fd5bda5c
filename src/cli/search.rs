//! `tilebind sweep --maximise`: the best of the designs that varied keys give.

use std::path::Path;

use serde_json::json;
use tilebind::output::Output;
use tilebind::report::json;
use tilebind::report::sweep::Searched;
use tilebind::search::{Search, SearchError, SearchResult, Verdict};
use tilebind::sweep::{self, Outcome, Plan, Shard, Store, SweepPoint};

use super::figures::FigureOptions;
use super::options::PrintOptions;
use super::results::describe_of;
use super::sweep_progress::PointBar;
use super::{Failure, interrupt, print};

/// The command that gives the same results, however the work was divided.
const AGAIN: &str = "tilebind sweep --run plan.json; tilebind sweep --merge plan.json";

/// A search with the folder of its points.
pub struct Searching<'a> {
    pub search: &'a Search,
    pub folder: &'a Path,
    pub threads: usize,
    pub print: &'a PrintOptions,
}

impl Searching<'_> {
    /// Goes on with the results that are there.
    fn known(&self) -> Result<SearchResult, SearchError> {
        let store = Store::new(self.folder);
        let known = |_: &Plan, points: &[SweepPoint]| Ok::<_, Failure>(loaded(&store, points));
        match self.search.run(known) {
            Ok(found) => found,
            // Loading reports no errors.
            Err(_) => Err(SearchError::Unfinished(0, 0)),
        }
    }

    /// Refuses a search without any possible point, before anything is written.
    pub fn check(&self) -> Result<(), Failure> {
        match self.known() {
            Err(SearchError::NonePossible(error)) => Err(Failure::usage(error)),
            _ => Ok(()),
        }
    }

    /// Computes the points of a part, as far as the results of others allow.
    pub fn work(&self, shard: Shard) -> Result<Result<SearchResult, SearchError>, Failure> {
        let store = Store::new(self.folder);
        let most = self.search.aim.points + self.search.most_proofs();
        let bar = PointBar::new(0, most, self.print.quiet);
        let found = self.search.run(|plan, points| {
            let is_missing = |point: &&SweepPoint| store.load(point).is_none();
            let mine = points.iter().filter(|point| shard.contains(point.index));
            let missing: Vec<SweepPoint> = mine.filter(is_missing).cloned().collect();
            bar.known(points.len() - missing.len());
            sweep::run(plan, &missing, self.threads, |point, outcome| {
                interrupt::without(|| store.save(point, outcome))?;
                bar.finished_one();
                Ok(())
            })
            .map_err(|error: tilebind::output::OutputError| Failure::from(error))?;
            Ok(loaded(&store, points))
        });
        bar.finish();
        found
    }

    /// Computes a part, and prints how far it came.
    pub fn part(&self, shard: Shard) -> Result<(), Failure> {
        let (number, of) = (shard.number, shard.of);
        let told = match self.work(shard)? {
            Ok(_) => "all points of the search have results".to_owned(),
            Err(SearchError::Unfinished(missing, known)) => format!(
                "{known} points tried, {missing} of the next belong to other parts: rerun it when \
                 they have results"
            ),
            Err(SearchError::NonePossible(error)) => return Err(Failure::usage(error)),
        };
        match self.print.quiet {
            true => Ok(()),
            false => print(&format!("part {number}/{of}: {told}\n")),
        }
    }

    /// Prints the progress.
    pub fn status(&self) -> Result<(), Failure> {
        let most = self.search.aim.points;
        let (known, missing, is_finished) = match self.known() {
            Ok(found) => (found.tried.len(), 0, true),
            Err(SearchError::Unfinished(missing, known)) => (known, missing, false),
            Err(SearchError::NonePossible(error)) => return Err(Failure::usage(error)),
        };
        if self.print.json {
            let state = json!({
                "points": most, "tried": known, "missing_of_the_round": missing,
                "is_finished": is_finished,
            });
            return print(&json::text(&state));
        }
        print(&match is_finished {
            true => format!("{known} points tried: the search is finished\n"),
            false => format!("{known} points tried of about {most}, {missing} are next\n"),
        })
    }

    /// Writes the results of a finished search.
    pub fn merge(
        &self,
        output: &Output,
        figures: &FigureOptions,
        plan: &str,
    ) -> Result<(), Failure> {
        let found = self.known().map_err(|error| match error {
            SearchError::Unfinished(missing, known) => Failure::Run(format!(
                "the search is not finished, {known} points tried, {missing} are next: rerun its \
                 parts to resume"
            )),
            SearchError::NonePossible(error) => Failure::usage(error),
        })?;
        let searched = Searched::new(self.search, &found);
        let document = searched.document();
        let (mut files, drawn) = document.files(&figures.sheet()?, AGAIN);
        if !output.reads(plan) {
            files.insert(plan.to_owned(), self.search.to_text().into_bytes());
        }
        interrupt::without(|| output.write(&files))?;
        self.print
            .results(&document.report(), || describe_of(&document, self.folder))?;
        drawn?;
        match (searched.count(Verdict::Failed), searched.front.is_empty()) {
            (0, false) => Ok(()),
            (0, true) => Err(Failure::Run(
                "no point is fit: relax a condition of --subject, or widen a range".to_owned(),
            )),
            (failed, _) => Err(Failure::Run(format!(
                "{failed} points failed because of a bug in tilebind; sweep.csv lists them with \
                 the reason"
            ))),
        }
    }
}

/// The outcomes of all points, or the number of those that have none.
fn loaded(store: &Store, points: &[SweepPoint]) -> Result<Vec<Outcome>, usize> {
    let outcomes: Vec<Outcome> = points
        .iter()
        .filter_map(|point| store.load(point))
        .collect();
    match points.len() - outcomes.len() {
        0 => Ok(outcomes),
        missing => Err(missing),
    }
}
