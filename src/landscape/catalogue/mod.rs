//! The catalogue of a surveyed landscape: its states in order, with the barriers and pathways that
//! are reported.
//!
//! Each barrier is stored once, from the first state of a kind; the escape of a state refers to one
//! of them, and its symmetric image is computed on demand.

mod kind;
mod reader;

pub use kind::Kind;

use self::reader::Reader;
use super::exploration::Exploration;
use super::results::{
    Alternative, Barrier, Pathway, PathwayPoint, Place, Proportion, SAME_ENERGY, State, StateKind,
    Uncaptured,
};
use ordered_float::OrderedFloat;
use tiles::configuration::Configuration;
use tiles::observer::Observer;
use tiles::problem::{Equal, Problem, Symmetry};

/// Configurations closer than this (m, metric of the space) are the same state.
const SAME: f64 = 1e-4;
/// How far (m) images of straight motions may lie beside straight ones.
const CURVED: f64 = 5e-8;
/// How much lower a barrier must be to replace another one, as a fraction of the problem's depth.
pub(super) const LEAST_GAIN: f64 = 1e-6;

/// A map of states onto equal ones: a turn of the tiles, after an exchange of equal tiles if need be.
struct Image<'a> {
    exchange: Option<&'a Equal>,
    turn: &'a Symmetry,
}

impl<'a> Image<'a> {
    /// All of them, the identity first.
    fn all(problem: &'a Problem) -> Vec<Self> {
        let exchanges = std::iter::once(None).chain(problem.exchange.as_ref().map(Some));
        let of = |exchange| {
            problem
                .symmetries
                .iter()
                .map(move |turn| Self { exchange, turn })
        };
        exchanges.flat_map(of).collect()
    }

    fn apply(&self, q: &Configuration) -> Configuration {
        let exchanged = self.exchange.map_or(*q, |exchange| exchange.apply(q));
        self.turn.apply(&exchanged)
    }

    /// The image of a pathway. Where tiles are exchanged, that of a straight motion that turns is curved: it
    /// gets as many points as keep straight motions between them near it.
    fn pathway(&self, problem: &Problem, pathway: &Pathway) -> Pathway {
        let mut images = Pathway::new();
        let mut add = |point: PathwayPoint| {
            let configuration = self.apply(&point.configuration);
            let s = match (self.exchange, images.last()) {
                (Some(_), Some(last)) => {
                    let last: &PathwayPoint = last;
                    last.s + problem.space.distance(&last.configuration, &configuration)
                }
                _ => point.s,
            };
            images.push(PathwayPoint {
                s,
                configuration,
                ..point
            });
        };
        for (number, point) in pathway.iter().enumerate() {
            if let Some(before) = number.checked_sub(1).filter(|_| self.exchange.is_some()) {
                let (from, to) = (&pathway[before].configuration, &point.configuration);
                let parts = parts(problem, from, to);
                for k in 1..parts {
                    let between = from.interpolate(to, f64::from(k) / f64::from(parts));
                    add(PathwayPoint {
                        s: 0.0,
                        configuration: between,
                        energy: problem.energy(&between),
                        clearance: problem.clearance(&between),
                    });
                }
            }
            add(*point);
        }
        images
    }
}

/// The number of parts of a straight motion whose images by an exchange of the tiles are straight to
/// within [`CURVED`]: the image of the place p is turned by theta, which bends it by
/// `2 |p'| theta' + |p| theta'^2`.
fn parts(problem: &Problem, from: &Configuration, to: &Configuration) -> u32 {
    let step = from.step_to(to);
    let far = libm::hypot(from.x, from.y).max(libm::hypot(to.x, to.y));
    let turn = step.z.abs();
    let bend = 2.0 * libm::hypot(step.x, step.y) * turn + far * turn * turn;
    (bend / (8.0 * problem.scaled(CURVED)))
        .sqrt()
        .ceil()
        .clamp(1.0, 100.0) as u32
}

/// States, barriers and pathways, in the order in which they are reported.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Catalogue {
    /// The bond first, then by energy; the states of a kind next to each other.
    pub states: Vec<State>,
    /// Barriers from the first state of each kind: its escape according to the roadmap, and those
    /// to the bond and to `free`.
    pub barriers: Vec<Barrier>,
    /// Pathways by other costs than the highest energy.
    pub alternatives: Vec<Alternative>,
    /// The bound state, if the bond is stable.
    pub bound_state: Option<usize>,
    /// Number of minima omitted because their escape barriers are below the least depth.
    pub shallow: usize,
}

impl Catalogue {
    /// The catalogue of a survey, without minima whose escape barrier is below `least_depth`, a
    /// fraction of the deepest energy.
    pub fn of_survey(survey: &Exploration, least_depth: f64, observer: &dyn Observer) -> Self {
        Reader {
            survey,
            observer,
            least_depth,
        }
        .catalogue()
    }

    /// The kinds of states, in the order of the states.
    pub fn kinds(&self) -> impl Iterator<Item = Kind<'_>> {
        let kinds = self.states.chunk_by(|a, b| a.class == b.class);
        kinds.map(|states| Kind { states })
    }

    /// The names of the states: `A` for the bond, `B` for the deepest trap and so on, mirror twins
    /// `B` and `B'`; copies of the first state of a kind have a number: `B.2`.
    pub fn names(&self) -> Vec<String> {
        let kinds: Vec<Kind> = self.kinds().collect();
        let of_kind = |(kind, name): (&Kind, String)| {
            let copies = 2..=kind.copies();
            let copies: Vec<String> = copies.map(|copy| format!("{name}.{copy}")).collect();
            [vec![name], copies].concat()
        };
        let names = kind::names(&kinds);
        kinds.iter().zip(names).flat_map(of_kind).collect()
    }

    /// The name of a place: `bond A`, `trap B.2`, `free`.
    pub fn name_of(&self, place: Place) -> String {
        let Place::State(id) = place else {
            return "free".to_owned();
        };
        let kind = match self.states[id].kind {
            StateKind::Bond => "bond",
            StateKind::Trap => "trap",
        };
        format!("{kind} {}", self.names()[id])
    }

    /// The first state that is the bond, or the deepest trap.
    pub fn first(&self, kind: StateKind) -> Option<&State> {
        self.states.iter().find(|state| state.kind == kind)
    }

    /// The barrier from a state to the nearest lower one or to `free`: the lowest known one, or one
    /// without a known path. `None` if nothing is known of its exits.
    pub fn escape(&self, problem: &Problem, id: usize) -> Option<Barrier> {
        let class = self.states[id].class;
        let escape = self.escape_of_kind(problem, class)?;
        if id == class {
            return Some(escape.clone());
        }
        let first = self.states[class].configuration;
        let images = Image::all(problem);
        let own = self.states[id].configuration;
        // The distance to the state itself first: there are as many images as states of the kind.
        let leads_there = |image: &&Image| {
            let there = image.apply(&first);
            problem.space.distance(&own, &there) < problem.scaled(SAME)
                && self.state_at(problem, &there) == Some(id)
        };
        let image = images.iter().find(leads_there)?;
        Some(self.image(problem, escape, id, image))
    }

    /// The escape of the first state of a kind. The roadmap's barrier comes first; another one
    /// replaces it only if it is clearly lower.
    pub fn escape_of_kind(&self, problem: &Problem, class: usize) -> Option<&Barrier> {
        let from = &self.states[class];
        let below = from.energy - SAME_ENERGY * from.energy.abs();
        let leads_down = |barrier: &&Barrier| {
            let is_lower = barrier.to == Place::Free || barrier.to_energy < below;
            barrier.from == Place::State(class) && is_lower
        };
        let mut ways = self.barriers.iter().filter(leads_down);
        let known = ways.next()?;
        let lowest = ways.min_by_key(|way| OrderedFloat(way.saddle_energy));
        let gain = LEAST_GAIN * problem.depth();
        let is_lower = |way: &&Barrier| way.saddle_energy < known.saddle_energy - gain;
        lowest.filter(is_lower).or(Some(known))
    }

    /// The barrier from the bond to `free`, if the bond is stable.
    pub fn way_out_of_the_bond(&self) -> Option<&Barrier> {
        let from = Place::State(self.bound_state?);
        let mut barriers = self.barriers.iter();
        barriers.find(|barrier| barrier.from == from && barrier.to == Place::Free)
    }

    /// A barrier as its image starts from state `from`.
    fn image(&self, problem: &Problem, barrier: &Barrier, from: usize, map: &Image) -> Barrier {
        let to = match barrier.to {
            Place::Free => Place::Free,
            Place::State(id) => self
                .state_at(problem, &map.apply(&self.states[id].configuration))
                .map_or(barrier.to, Place::State),
        };
        Barrier {
            from: Place::State(from),
            to,
            saddle: map.apply(&barrier.saddle),
            pathway: map.pathway(problem, &barrier.pathway),
            ..barrier.clone()
        }
    }

    /// Removes traps with a known exit below `least_depth`, a fraction of the deepest energy: if
    /// the certificate found such an exit they are not traps, whatever the roadmap's estimate.
    pub fn leave_out_shallow(&mut self, problem: &Problem, least_depth: f64) {
        let deepest = self.states.iter().map(|state| state.energy.abs());
        let least = least_depth * deepest.fold(0.0, f64::max);
        let holds = |kind: &Kind| {
            let escape = self.escape_of_kind(problem, kind.first().class);
            kind.is_bond() || escape.is_none_or(|way| way.forward() >= least)
        };
        let kept: Vec<usize> = self
            .kinds()
            .filter(holds)
            .flat_map(|kind| kind.states.iter().map(|state| state.id))
            .collect();
        if kept.len() < self.states.len() {
            self.keep(&kept);
        }
    }

    /// Keeps the states with these ids (ascending), renumbered, and the barriers between them.
    fn keep(&mut self, kept: &[usize]) {
        let new_id = |id: usize| kept.binary_search(&id).ok();
        let place = |place: Place| match place {
            Place::State(id) => new_id(id).map(Place::State),
            Place::Free => Some(Place::Free),
        };
        let renamed = |from: &mut Place, to: &mut Place| {
            let ends = place(*from).zip(place(*to));
            ends.map(|ends| (*from, *to) = ends).is_some()
        };
        self.shallow += self.states.len() - kept.len();
        self.states.retain(|state| new_id(state.id).is_some());
        for state in &mut self.states {
            state.id = new_id(state.id).unwrap_or(state.id);
            state.class = new_id(state.class).unwrap_or(state.class);
        }
        self.barriers
            .retain_mut(|barrier| renamed(&mut barrier.from, &mut barrier.to));
        self.alternatives
            .retain_mut(|way| renamed(&mut way.from, &mut way.to));
    }

    /// Counts the ends of far starts by state and sets the capture shares; returns the other ends.
    pub fn count_captures(
        &mut self,
        problem: &Problem,
        ends: &[Option<Configuration>],
    ) -> Uncaptured {
        let share = |count| Proportion::new(count, ends.len());
        let mut counts = vec![0; self.states.len()];
        let [mut at_rest, mut gone] = [0, 0];
        for end in ends {
            let state = end.and_then(|q| self.state_at(problem, &q));
            match (state, end) {
                (Some(id), _) => counts[id] += 1,
                (None, Some(_)) => at_rest += 1,
                (None, None) => gone += 1,
            }
        }
        for (state, count) in self.states.iter_mut().zip(counts) {
            state.capture = Some(share(count));
        }
        Uncaptured {
            at_rest: share(at_rest),
            gone: share(gone),
        }
    }

    /// Estimate of the share of far starts that would end in a kind of state that none has ended in
    /// yet: n1 / n, n1 the number of kinds in which just one of n starts ended (Turing's formula,
    /// Good 1953, doi:10.1093/biomet/40.3-4.237), with the interval of a proportion. It does not
    /// cover states that capture almost nothing. Needs [`count_captures`](Self::count_captures).
    pub fn unseen(&self) -> Proportion {
        let captured: Vec<Proportion> = self.kinds().map(|kind| kind.captured()).collect();
        let single = captured.iter().filter(|share| share.count == 1).count();
        Proportion::new(single, captured.first().map_or(0, |share| share.of))
    }

    /// Whether a configuration, or one of its images, is that of a state.
    pub fn holds(&self, problem: &Problem, q: &Configuration) -> bool {
        let images = Image::all(problem);
        let mut images = images.iter().map(|image| image.apply(q));
        images.any(|image| self.state_at(problem, &image).is_some())
    }

    /// Adds a barrier, or merges it with an existing one; returns whether it was added.
    pub(super) fn add_way(&mut self, way: Barrier) -> bool {
        let is_there = |b: &&mut Barrier| (b.from, b.to) == (way.from, way.to);
        match self.barriers.iter_mut().find(is_there) {
            Some(known) => {
                known.bounds.tighten(way.bounds);
                known.lead_lower(way.pathway);
                false
            }
            None => {
                self.barriers.push(way);
                true
            }
        }
    }

    /// The state at a configuration.
    pub(super) fn state_at(&self, problem: &Problem, q: &Configuration) -> Option<usize> {
        self.states
            .iter()
            .map(|s| (problem.space.distance(&s.configuration, q), s.id))
            .filter(|(distance, _)| *distance < problem.scaled(SAME))
            .min_by_key(|(distance, _)| OrderedFloat(*distance))
            .map(|(_, id)| id)
    }

    /// Widens the spread of each barrier by the result of another run.
    pub fn widen_spread(&mut self, problem: &Problem, other: &Self) {
        let same_place = |a: Place, b: Place| match (a, b) {
            (Place::Free, Place::Free) => true,
            (Place::State(a), Place::State(b)) => {
                let (a, b) = (&self.states[a], &other.states[b]);
                problem.space.distance(&a.configuration, &b.configuration) < problem.scaled(SAME)
            }
            _ => false,
        };
        for barrier in &mut self.barriers {
            let found = other
                .barriers
                .iter()
                .find(|b| same_place(barrier.from, b.from) && same_place(barrier.to, b.to));
            if let Some(found) = found {
                let own = barrier.saddle_energy;
                let (low, high) = barrier.spread.unwrap_or((own, own));
                let energy = found.saddle_energy;
                barrier.spread = Some((low.min(energy), high.max(energy)));
            }
        }
    }
}
