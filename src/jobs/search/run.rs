//! A search from its manifest: which points are tried, in which order.

use std::collections::HashSet;

use ordered_float::OrderedFloat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::energies;
use super::manifest::{Search, Stage};
use super::model::Model;
use super::race;
use super::rank::{self, Figures, Standing, levels, scores, weighted};
use super::space::{GridPoint, Space};
use super::tried::{SearchError, SearchResult, Tried};
use crate::sweep::{Outcome, Plan, PlanError, SweepPoint};
use physics::order::Order;

/// The share of the points that are spread over the space.
const SPREAD: f64 = 1.0 / 3.0;
/// The share of the points of a round, and the limits of their number.
const ROUND: f64 = 1.0 / 15.0;
const ROUNDS: [usize; 2] = [4, 32];
/// Number of places from which the next point is chosen: from everywhere, and near the best.
const ANYWHERE: usize = 400;
const NEAR: usize = 200;
/// The reach of the box about the best, relative to the ranges: at first, and at least.
const REACH: f64 = 0.25;
const LEAST_REACH: f64 = 0.002;
/// Largest number of points that the model follows: the best of them.
const FOLLOWED: usize = 200;
/// The steps beside the best are taken if they are at most this share of the points.
const BESIDE: f64 = 0.25;
/// Steps of two keys at once, to all sides.
const ACROSS: usize = 4;
/// Impossible designs that are met for each point, at most.
const MOST_REFUSED: usize = 20;

impl Search {
    /// Searches. `work` gives the outcomes of points of a plan, or the number of those that have
    /// none yet.
    ///
    /// # Errors
    /// The first error of `work`.
    pub fn run<E>(
        &self,
        mut work: impl FnMut(&Plan, &[SweepPoint]) -> Result<Result<Vec<Outcome>, usize>, E>,
    ) -> Result<Result<SearchResult, SearchError>, E> {
        let mut course = Course::new(self);
        while let Some(round) = course.next() {
            let points: Vec<SweepPoint> = round.iter().map(|(point, _)| point.clone()).collect();
            match work(&course.plan, &points)? {
                Ok(outcomes) => course.take(round, outcomes),
                Err(missing) => {
                    let known = course.tried.len();
                    return Ok(Err(SearchError::Unfinished(missing, known)));
                }
            }
        }
        if course.analysed == 0 {
            return Ok(Err(SearchError::NonePossible(course.none_possible())));
        }
        let mut found = SearchResult {
            tried: course.tried,
        };
        let known = found.tried.len();
        let proofs = race::race(self, &mut found.tried, &mut work)?;
        Ok(match proofs {
            Ok(()) => Ok(found),
            Err(missing) => Err(SearchError::Unfinished(missing, known)),
        })
    }
}

/// A search on its way.
struct Course<'a> {
    search: &'a Search,
    /// The plan of the points without proofs.
    plan: Plan,
    space: Space,
    random: ChaCha8Rng,
    tried: Vec<Tried>,
    known: HashSet<GridPoint>,
    analysed: usize,
    refused: usize,
    reach: f64,
    best: Option<usize>,
    /// The best about which single keys were varied.
    about: Option<usize>,
    /// Whether two keys at once were varied about it.
    is_crossed: bool,
}

/// Points that are analysed at the same time, with their places.
type Round = Vec<(SweepPoint, GridPoint)>;

impl<'a> Course<'a> {
    fn new(search: &'a Search) -> Self {
        Self {
            search,
            plan: search.stage(Stage::States),
            space: Space::of(&search.plan),
            random: ChaCha8Rng::seed_from_u64(search.plan.seed),
            tried: Vec::new(),
            known: HashSet::new(),
            analysed: 0,
            refused: 0,
            reach: REACH,
            best: None,
            about: None,
            is_crossed: false,
        }
    }

    /// The points of the next round; `None` at the end.
    fn next(&mut self) -> Option<Round> {
        let points = self.search.aim.points;
        let round = if self.space.count() <= points {
            let places = self.space.all();
            self.admitted(places, points)
        } else if self.analysed < self.spread() {
            self.spreading()
        } else {
            match (points - self.reserved()).saturating_sub(self.analysed) {
                // Steps from a better point than before begin anew.
                0 if self.about != self.best => self.beside(),
                0 => self.across(),
                left => self.improving(left),
            }
        };
        // What the steps do not need is left for the model.
        let round = match points.saturating_sub(self.analysed) {
            left if round.is_empty() && left > 0 => self.improving(left),
            _ => round,
        };
        Some(round).filter(|round| !round.is_empty())
    }

    /// Number of points that are spread over the space.
    fn spread(&self) -> usize {
        let points = self.search.aim.points;
        ((SPREAD * points as f64).ceil() as usize)
            .max(2)
            .min(points)
    }

    /// Number of points left for the steps beside the best: none, or those of single keys and of as
    /// many pairs of keys as there is room for.
    fn reserved(&self) -> usize {
        let most = (BESIDE * self.search.aim.points as f64) as usize;
        let steps = 2 * self.space.numbers().count();
        if self.search.aim.objectives.len() > 1 || steps > most {
            return 0;
        }
        let pairs = self.space.pairs().len().min((most - steps) / ACROSS);
        steps + ACROSS * pairs
    }

    fn spreading(&mut self) -> Round {
        let mut round = Vec::new();
        let wanted = self.spread() - self.analysed;
        while round.len() < wanted && self.may_go_on() {
            let places = self.space.spread(wanted, &mut self.random);
            let left = wanted - round.len();
            round.extend(self.admitted(places, left));
        }
        round
    }

    fn may_go_on(&self) -> bool {
        self.refused < MOST_REFUSED * self.search.aim.points
            && self.known.len() < self.space.count()
    }

    /// The points to be analysed among new places, at most `most`; impossible ones, and those that
    /// energies refuse, are noted.
    fn admitted(&mut self, places: impl IntoIterator<Item = GridPoint>, most: usize) -> Round {
        let mut round = Vec::new();
        for place in places {
            if round.len() == most {
                break;
            }
            round.extend(self.admit(place));
        }
        round
    }

    fn admit(&mut self, place: GridPoint) -> Option<(SweepPoint, GridPoint)> {
        if !self.known.insert(place.clone()) {
            // Counted, so that a search among few possible designs ends.
            self.refused += 1;
            return None;
        }
        let (design, values) = self.space.values(&self.plan, &place);
        let point = self.plan.point_of(self.known.len() - 1, design, values);
        let refused = match self.plan.design(&point) {
            Ok(design) => energies::refusal(&self.search.aim, &design)
                .map(|(violation, reason)| (Some(violation), reason)),
            Err(reason) => Some((None, reason)),
        };
        let Some((refused, reason)) = refused else {
            return Some((point, place));
        };
        self.refused += 1;
        self.tried.push(Tried {
            point,
            place,
            outcome: Outcome::Impossible { reason },
            refused,
            proved: None,
        });
        None
    }

    fn take(&mut self, round: Round, outcomes: Vec<Outcome>) {
        self.analysed += outcomes.len();
        let all = round.into_iter().zip(outcomes);
        self.tried
            .extend(all.map(|((point, place), outcome)| Tried {
                point,
                place,
                outcome,
                refused: None,
                proved: None,
            }));
        self.tried.order_by_key(|one| one.point.index);
        let one = vec![1.0; self.search.aim.objectives.len()];
        let levels = levels(&self.standings(), &one);
        let best = rank::first(&levels).map(|best| self.tried[best].point.index);
        // Impossible points that are met later move the places of others, not their indices.
        let better = best != self.best;
        self.reach = match better {
            true => (1.5 * self.reach).min(REACH),
            false => (0.5 * self.reach).max(LEAST_REACH),
        };
        self.best = best;
    }

    fn standings(&self) -> Vec<Standing> {
        let aim = &self.search.aim;
        self.tried
            .iter()
            .map(|one| Standing::of(aim, one))
            .collect()
    }

    /// The next points by the model, at most `left`.
    fn improving(&mut self, left: usize) -> Round {
        let usual = (ROUND * self.search.aim.points as f64) as usize;
        let count = usual.clamp(ROUNDS[0], ROUNDS[1]).min(left);
        let mut round: Round = Vec::new();
        while round.len() < count && self.may_go_on() {
            let waiting: Vec<GridPoint> = round.iter().map(|(_, place)| place.clone()).collect();
            let is_near = round.len() % 2 == 1;
            let Some(place) = self.most_promising(&waiting, is_near) else {
                self.refused += 1;
                continue;
            };
            round.extend(self.admit(place));
        }
        round
    }

    /// The place with the largest expected improvement times the chance that it is fit, while others
    /// wait for their results.
    fn most_promising(&mut self, waiting: &[GridPoint], is_near: bool) -> Option<GridPoint> {
        let weights = match self.search.aim.objectives.len() {
            1 => vec![1.0],
            _ => {
                let one: f64 = self.random.random();
                vec![one, 1.0 - one]
            }
        };
        let standings = self.standings();
        let levels = levels(&standings, &weights);
        let mut order: Vec<usize> = (0..levels.len()).collect();
        order.order_by(|&a, &b| levels[b].total_cmp(&levels[a]));
        order.truncate(FOLLOWED);
        let centre = &self.tried[*order.first()?].place;
        let mut places: Vec<GridPoint> = Vec::new();
        if !is_near {
            places.extend((0..ANYWHERE).map(|_| self.space.anywhere(&mut self.random)));
        }
        let near = |_| self.space.near(centre, self.reach, &mut self.random);
        places.extend((0..NEAR).map(near));

        let model = |known: Vec<usize>, mut values: Vec<f64>| {
            let known = known.iter().map(|&k| &self.tried[k].place).collect();
            let mut model = Model::fitted(&self.space, known, &values);
            for place in waiting {
                model = model.with(place, &mut values);
            }
            model
        };
        // What is not fit teaches its figures as well.
        let known = order
            .iter()
            .filter_map(|&k| Some((k, standings[k].figures()?)));
        let (known, figures): (Vec<usize>, Vec<&Figures>) = known.unzip();
        let values = scores(&weighted(&figures, &weights));
        let fit = known
            .iter()
            .zip(&values)
            .filter(|(k, _)| standings[**k].gains().is_some());
        let best = fit.map(|(_, value)| *value).max_by(f64::total_cmp);
        let gain = (!known.is_empty()).then(|| model(known, values));
        // An impossible design says nothing about the conditions of others; it costs no analysis, so
        // that the nearest point known decides whether one is expected.
        let judged: Vec<usize> = order
            .iter()
            .copied()
            .filter(|&k| standings[k] != Standing::Impossible)
            .collect();
        let margins: Vec<f64> = judged.iter().map(|&k| standings[k].margin()).collect();
        let is_free = margins.iter().all(|margin| *margin == 1.0);
        let margin = (!is_free).then(|| model(judged, margins));
        let away = |k: usize, place: &GridPoint| {
            self.space
                .differences(&self.tried[k].place, place)
                .sum::<f64>()
        };
        let is_possible = |place: &GridPoint| {
            let nearest = (0..standings.len()).min_by_key(|&k| OrderedFloat(away(k, place)));
            nearest.is_none_or(|k| standings[k] != Standing::Impossible)
        };
        let promise = |place: &GridPoint| {
            if !is_possible(place) {
                return 0.0;
            }
            let chance = margin.as_ref().map_or(1.0, |model| model.chance(place));
            match (&gain, best) {
                (Some(model), Some(best)) => chance * model.improvement(place, best),
                // Nothing is fit so far.
                _ => chance,
            }
        };
        let mut most: Option<(f64, &GridPoint)> = None;
        for place in places.iter().filter(|place| !self.known.contains(*place)) {
            let promise = promise(place);
            if most.is_none_or(|(known, _)| promise > known) {
                most = Some((promise, place));
            }
        }
        most.map(|(_, place)| place.clone())
    }

    fn best_place(&self) -> Option<GridPoint> {
        let is_best = |one: &&Tried| Some(one.point.index) == self.best;
        self.tried.iter().find(is_best).map(|one| one.place.clone())
    }

    /// The steps of single keys beside the best.
    fn beside(&mut self) -> Round {
        let Some(best) = self.best_place().filter(|_| self.reserved() > 0) else {
            return Vec::new();
        };
        (self.about, self.is_crossed) = (self.best, false);
        let numbers = self.space.numbers();
        let places = numbers.flat_map(|k| self.space.beside(&best, &[k]));
        let places: Vec<GridPoint> = places.collect();
        let round = self.admitted(places, self.search.aim.points - self.analysed);
        // All steps may be known, or impossible.
        if round.is_empty() {
            self.across()
        } else {
            round
        }
    }

    /// The steps of two keys at once beside the best, once those of single keys are known.
    fn across(&mut self) -> Round {
        if self.is_crossed || self.about.is_none() {
            return Vec::new();
        }
        self.is_crossed = true;
        let found = SearchResult {
            tried: std::mem::take(&mut self.tried),
        };
        let mut matter = found.that_matter(self.search);
        self.tried = found.tried;
        let left = self.search.aim.points - self.analysed;
        matter.truncate(left / ACROSS);
        let places = self.best_place().into_iter().flat_map(|best| {
            let around = |pair: &[usize; 2]| self.space.beside(&best, pair);
            matter.iter().flat_map(around).collect::<Vec<_>>()
        });
        let places: Vec<GridPoint> = places.collect();
        self.admitted(places, left)
    }

    /// Why nothing was analysed: the reason of the point that comes nearest to the conditions, or
    /// else of the first.
    fn none_possible(&self) -> PlanError {
        let count = self.tried.len();
        let violation = |one: &&Tried| OrderedFloat(one.refused.unwrap_or(f64::INFINITY));
        let Some(nearest) = self.tried.iter().min_by_key(violation) else {
            return PlanError::NonePossible(count, String::new());
        };
        let reason = match &nearest.outcome {
            Outcome::Impossible { reason } | Outcome::Failed { reason } => reason.as_str(),
            Outcome::Done { .. } => "",
        };
        let values = self.plan.axes.iter().zip(&nearest.point.values);
        let values = values.map(|(axis, value)| format!("{} = {value}", axis.key));
        let reason = format!("{}: {reason}", values.collect::<Vec<_>>().join(", "));
        match nearest.refused {
            Some(_) => PlanError::NoneFit(count, reason),
            None => PlanError::NonePossible(count, reason),
        }
    }
}
