//! What making does to a design: tiles drawn about their nominal values, and how many of them work.
//!
//! `made` says what is drawn. A draw *works* if its bond is its deepest state and at least
//! [`MakingErrors::least_selectivity`] times as deep as its deepest trap. The bond is the stated contact;
//! contacts that are equal to it in the nominal design, by symmetry or because other faces carry the
//! same magnets, count neither as bond nor as trap.
//!
//! The states of the nominal design are found by a search; those of a draw are followed from them
//! (`well`). The energy near a state is a sum over pairs of magnets (`expansion`): exact in the
//! magnets' strengths and poles, of second order in their places, their turns and the moving tile's
//! motion. Two things are not followed: states that only a draw has, and states that a draw does not
//! have any more, which count with the energy at their nominal place. Both are checked: some draws
//! are minimised with their exact energy ([`Exact`]), and some are analysed anew, with a full search
//! of states ([`Anew`]).

mod anew;
mod expansion;
mod made;
mod request;
mod safer;
mod well;

pub use anew::{Anew, Exact};
pub use request::{MakingErrors, Request};
pub use safer::Safer;

use crate::design::Design;
use crate::memory;
use crate::pipeline;
use crate::request::Unanswered;
use expansion::{ERRORS, Pairs, Placed};
use made::{Draw, Maker};
use ordered_float::OrderedFloat;
use physics::landscape::{Catalogue, Proportion, StateKind};
use physics::observer::Observer;
use physics::order::Order;
use physics::parallel;
use physics::problem::Problem;
use serde::Serialize;
use well::Well;

/// Traps are followed that are at least this share of the deepest one's depth deep, or all that attract if
/// magnets may be flipped, which can make any of them deep, ...
const FOLLOWED: f64 = 0.3;
/// ... as long as this many pairs of magnets and states are expanded.
const MOST_TERMS: usize = 1_000_000;
/// A draw's traps are minimised if, unmoved, they are at least this share of its deepest one's depth
/// deep.
const MOVED: f64 = 0.85;
/// Memory (bytes) of a draw, and of each magnet of it.
const OF_A_DRAW: f64 = 1000.0;
const OF_A_MAGNET: f64 = 200.0;
/// Number of draws after which those done are told.
const BATCH: usize = 4096;
/// A flipped magnet is noticed if the bond is weaker than all but this share of the draws without
/// flips.
const ORDINARY: f64 = 0.05;

/// What to do where no error of making is stated.
pub const NO_ERRORS: &str = "no error of making is stated: add at least one of --strength 5%, --place \"0.3 mm\", \
    --turn \"3 deg\", --gap \"0.1 mm\", --flip 0.01";

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ToleranceError {
    /// No error of making is stated.
    #[error("{NO_ERRORS}")]
    NoErrors,
    /// There is no state where the target faces meet.
    #[error(
        "the tiles do not hold where the target faces meet, so there is no bond (see `tilebind \
         show`)"
    )]
    NoBond,
    /// The machine cannot hold the draws.
    #[error("{0}")]
    Memory(String),
}

impl Unanswered for ToleranceError {}

/// A drawn pair of tiles. Energies in J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// Energy of the bond.
    pub bond: f64,
    /// Energy of the deepest trap; `None` if there is none.
    pub trap: Option<f64>,
    /// Which of the followed traps it is.
    pub which: Option<usize>,
    /// Whether a magnet of the draw is flipped.
    pub is_flipped: bool,
}

impl Drawn {
    /// Whether the bond is lost: no energy is gained there.
    pub fn is_lost(&self) -> bool {
        self.bond >= 0.0
    }

    /// Whether a trap is deeper than the bond.
    pub fn is_beaten(&self) -> bool {
        self.is_lost() || self.trap.is_some_and(|trap| trap < self.bond)
    }

    /// The bond's depth over the deepest trap's; infinite without traps.
    pub fn selectivity(&self) -> f64 {
        match self.trap {
            _ if self.is_lost() => 0.0,
            Some(trap) if trap < 0.0 => self.bond / trap,
            _ => f64::INFINITY,
        }
    }

    /// Whether the pair works.
    pub fn works(&self, least_selectivity: f64) -> bool {
        !self.is_beaten() && self.selectivity() >= least_selectivity
    }
}

/// The spread of a figure over the draws.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Without errors.
    pub nominal: f64,
    /// The mean, and the standard deviation.
    pub mean: f64,
    /// The standard deviation.
    pub sd: f64,
    /// 5 % of the draws lie below.
    pub p05: f64,
    /// Half of the draws lie below.
    pub median: f64,
    /// 5 % of the draws lie above.
    pub p95: f64,
}

impl Spread {
    fn new(nominal: f64, values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.order_by_key(|value| OrderedFloat(*value));
        let n = values.len() as f64;
        // From the smallest: equal values have no spread.
        let low = values[0];
        let mean = low + values.iter().map(|it| it - low).sum::<f64>() / n;
        let square = values
            .iter()
            .map(|it| (it - mean) * (it - mean))
            .sum::<f64>();
        Self {
            nominal,
            mean,
            sd: (square / (n - 1.0).max(1.0)).sqrt(),
            p05: quantile(&values, 0.05),
            median: quantile(&values, 0.5),
            p95: quantile(&values, 0.95),
        }
    }
}

/// The value below which a share of sorted values lies, interpolated.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let (below, above) = (
        sorted[place.floor() as usize],
        sorted[place.ceil() as usize],
    );
    match below == above {
        true => below,
        false => below + (above - below) * place.fract(),
    }
}

/// A reason why draws do not work. A draw can have several.
#[derive(Clone, Debug, PartialEq)]
pub struct Reason {
    /// Its name in files.
    pub name: &'static str,
    /// Its name for people.
    pub label: String,
    /// The share of the draws.
    pub share: Proportion,
}

/// How much an error of a magnet matters.
#[derive(Clone, Debug, PartialEq)]
pub struct Matter {
    /// The magnet, such as `fixed east 1`; the face for gaps, `all` for the strength in common.
    pub magnet: String,
    /// The kind of error: `strength`, `place`, `turn`, `gap`, `flip`.
    pub error: &'static str,
    /// Its share of the variance of the bond's energy, to first order.
    pub of_bond: f64,
    /// Its share of the variance of the logarithm of the selectivity, to first order, with the trap
    /// that is deepest in the nominal design; `None` without traps.
    pub of_selectivity: Option<f64>,
    /// The standard deviation (J) of the bond's energy by it alone.
    pub sd: f64,
}

/// A magnet that is glued in with its poles exchanged, alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Flipped {
    /// The magnet.
    pub magnet: String,
    /// The energy (J) of the bond with it, without other errors.
    pub bond: f64,
    /// The share of draws in which the bond with it is weaker than in all but 5 % of the draws
    /// without flips.
    pub noticed: Proportion,
}

/// What making does to a design.
#[derive(Clone, Debug)]
pub struct Tolerance {
    /// The errors.
    pub making: MakingErrors,
    /// The seed.
    pub seed: u64,
    /// The draws, by number.
    pub outcomes: Vec<Drawn>,
    /// The nominal pair.
    pub nominal: Drawn,
    /// The bond's energy (J).
    pub bond: Spread,
    /// The bond's depth over the deepest trap's; `None` without traps.
    pub selectivity: Option<Spread>,
    /// The share of the draws that work.
    pub works: Proportion,
    /// Why draws do not work.
    pub reasons: Vec<Reason>,
    /// The share of the nominal bond that a trap beats, and in how many draws it does.
    pub beats: (f64, Proportion),
    /// What matters, most first.
    pub matters: Vec<Matter>,
    /// The share of the variance of the bond that the first order explains; `None` if there is none.
    pub explained: Option<f64>,
    /// Each magnet that takes part in the bond, flipped.
    pub flipped: Vec<Flipped>,
    /// The number of followed states, and of states of the nominal design.
    pub followed: [usize; 2],
    /// Share of draws with magnets that were kept from sticking out.
    pub held_back: Proportion,
    /// Draws with exactly computed energies.
    pub exact: Exact,
    /// Draws analysed anew; `None` if not requested.
    pub anew: Option<Anew>,
    /// Changed designs with the same errors.
    pub safer: Vec<Safer>,
}

impl Request {
    /// Draws pairs of tiles of a design.
    ///
    /// # Errors
    /// If no error of making is stated, there is no bond, or the machine cannot hold the draws.
    pub fn run(
        &self,
        design: &Design,
        observer: &dyn Observer,
    ) -> Result<Tolerance, ToleranceError> {
        if !self.making.is_stated() {
            return Err(ToleranceError::NoErrors);
        }
        let count = self.making.draws();
        let magnets = design.pair.fixed.magnets.len() + design.pair.moving.magnets.len();
        let bytes = count as f64 * (OF_A_DRAW + OF_A_MAGNET * magnets as f64);
        memory::check_bytes(bytes).map_err(|told| {
            let what = format!("{count} draws of {magnets} magnets: {told}: use fewer --draws");
            ToleranceError::Memory(what)
        })?;
        if self.checks > count {
            observer.warn(&format!(
                "--checks {}: there are {count} draws (--draws), which are all analysed anew",
                self.checks
            ));
        }
        let settings = pipeline::Request::without_proofs(self.seed);
        let found = pipeline::analyse(design, &settings, observer);
        observer.stage("draws", 0.8);
        let study = Study::new(design, &found.problem, &found.catalogue, &self.making)
            .ok_or(ToleranceError::NoBond)?;
        let made = Maker::new(&design.pair, &self.making, self.seed);
        let tell = |done| observer.part("draws (fewer: --draws)", done, count);
        let (draws, outcomes) = study.draw(&made, count, &tell);
        Ok(self.answer(&study, &made, (&draws, outcomes), observer))
    }

    fn answer(
        &self,
        study: &Study,
        maker: &Maker,
        (draws, outcomes): (&[Draw], Vec<Drawn>),
        observer: &dyn Observer,
    ) -> Tolerance {
        let least = self.making.least_selectivity();
        let nominal = study.outcome(&expansion::unchanged(&study.design.pair));
        let n = outcomes.len();
        let share = |holds: &dyn Fn(&Drawn) -> bool| {
            Proportion::new(outcomes.iter().filter(|it| holds(it)).count(), n)
        };
        let bond = Spread::new(nominal.bond, outcomes.iter().map(|it| it.bond));
        let reasons = [
            (
                "no_bond",
                "the bond does not attract".to_owned(),
                share(&Drawn::is_lost),
            ),
            (
                "not_deepest",
                "a trap is deeper than the bond".to_owned(),
                share(&Drawn::is_beaten),
            ),
            (
                "selectivity",
                format!("the bond is less than {least} times as deep as the deepest trap"),
                share(&|it| it.selectivity() < least),
            ),
        ];
        let beats = self.beats.unwrap_or(1.0 / least);
        let beaten = |it: &Drawn| it.trap.is_some_and(|trap| trap < beats * nominal.bond);
        let held_back = |draw: &&Draw| draw.iter().flatten().any(|it| it.pushed.norm() > 0.0);
        let (matters, variance) = study.matters(draws);
        observer.stage("exact energies", 0.85);
        let exact = anew::exact(study, maker, draws, &outcomes);
        let anew = anew::anew(study, maker, draws, &outcomes, (self, least), observer);
        let safer = safer::safer(study, (&self.making, self.seed), &outcomes);
        Tolerance {
            making: self.making,
            seed: self.seed,
            selectivity: nominal.trap.is_some().then(|| {
                Spread::new(
                    nominal.selectivity(),
                    outcomes.iter().map(Drawn::selectivity),
                )
            }),
            works: working(&outcomes, least),
            reasons: reasons
                .into_iter()
                .map(|(name, label, share)| Reason { name, label, share })
                .collect(),
            beats: (beats, share(&beaten)),
            explained: (bond.sd > 0.0).then(|| variance / (bond.sd * bond.sd)),
            flipped: study.flipped(draws, &outcomes),
            followed: [1 + study.traps.len(), study.catalogue.states.len()],
            held_back: Proportion::new(draws.iter().filter(held_back).count(), n),
            nominal,
            bond,
            matters,
            exact,
            anew,
            safer,
            outcomes,
        }
    }
}

/// The share of draws in which a design works, given its states; `None` if no error is stated or
/// there is no bond.
pub fn robust(
    design: &Design,
    (problem, catalogue): (&Problem, &Catalogue),
    making: &MakingErrors,
    seed: u64,
) -> Option<Proportion> {
    let study = Study::new(design, problem, catalogue, making).filter(|_| making.is_stated())?;
    let maker = Maker::new(&design.pair, making, seed);
    let (_, outcomes) = study.draw(&maker, making.draws(), &|_| ());
    Some(working(&outcomes, making.least_selectivity()))
}

/// The share of draws that work.
fn working(outcomes: &[Drawn], least_selectivity: f64) -> Proportion {
    let working = outcomes.iter().filter(|it| it.works(least_selectivity));
    Proportion::new(working.count(), outcomes.len())
}

/// The kinds of errors, as [`expansion::Gradients::effects`] has them.
const NAMES: [&str; ERRORS] = ["strength", "strength", "place", "turn", "gap", "flip"];

/// The independent sources of errors: the strength in common, a face's gap, a magnet's other errors.
struct Sources {
    /// The magnet or face, and the kind of error.
    names: Vec<(String, usize)>,
    /// The source of each kind of error of each magnet of either tile.
    of: [Vec<[usize; ERRORS]>; 2],
}

impl Sources {
    /// The sources of magnets, given by their names and those of their faces.
    fn new(magnets: &[Vec<[String; 2]>; 2]) -> Self {
        let mut names: Vec<(String, usize)> = Vec::new();
        let mut source = |name: &str, error: usize| {
            let known = names
                .iter()
                .position(|it| (&it.0[..], it.1) == (name, error));
            known.unwrap_or_else(|| {
                names.push((name.to_owned(), error));
                names.len() - 1
            })
        };
        let of = [0, 1].map(|tile: usize| {
            let named = magnets[tile].iter();
            let sources = named.map(|[name, face]| {
                std::array::from_fn(|error| match error {
                    0 => source("all", error),
                    _ if NAMES[error] == "gap" => source(face, error),
                    _ => source(name, error),
                })
            });
            sources.collect()
        });
        Self { names, of }
    }

    /// The sum of the effects of each source.
    fn summed(&self, effects: &[Vec<[f64; ERRORS]>; 2]) -> Vec<f64> {
        let mut sums = vec![0.0; self.names.len()];
        for (effects, of) in effects.iter().flatten().zip(self.of.iter().flatten()) {
            for (effect, source) in effects.iter().zip(of) {
                sums[*source] += effect;
            }
        }
        sums
    }
}

/// The followed states of a design.
struct Study<'a> {
    design: &'a Design,
    problem: &'a Problem,
    catalogue: &'a Catalogue,
    bond: Well<'a>,
    /// Deepest first.
    traps: Vec<Well<'a>>,
}

impl<'a> Study<'a> {
    /// `None` if there is no bond.
    fn new(
        design: &'a Design,
        problem: &'a Problem,
        catalogue: &'a Catalogue,
        making: &MakingErrors,
    ) -> Option<Self> {
        let bond = &catalogue.states[catalogue.bound_state?];
        let traps = catalogue.states.iter();
        let mut traps: Vec<_> = traps.filter(|it| it.kind == StateKind::Trap).collect();
        traps.order_by_key(|state| OrderedFloat(state.energy));
        let tiles = [&design.pair.fixed, &design.pair.moving];
        let terms: usize = tiles.map(|tile| tile.magnets.len()).iter().product();
        let deepest = traps.first().map_or(0.0, |state| state.energy);
        let share = match making.flip {
            Some(flip) if flip > 0.0 => 0.0,
            _ => FOLLOWED,
        };
        let is_deep = |state: &&_| {
            let state: &physics::landscape::State = state;
            state.energy <= share * deepest && state.energy < 0.0
        };
        let followed = traps.into_iter().filter(|it| is_deep(it));
        let followed: Vec<_> = followed.take((MOST_TERMS / terms.max(1)).max(1)).collect();
        let pairs = Pairs::new(design, making);
        Some(Self {
            design,
            problem,
            catalogue,
            bond: Well::new(problem, &pairs, bond),
            traps: parallel::map(&followed, |state| Well::new(problem, &pairs, state)),
        })
    }

    /// Draws pairs of tiles; how many are done is told.
    fn draw(&self, maker: &Maker, count: usize, tell: &dyn Fn(usize)) -> (Vec<Draw>, Vec<Drawn>) {
        let all = parallel::map_in_batches(0..count, BATCH, tell, |number| {
            let draw = maker.draw(number);
            let outcome = self.outcome(&draw);
            (draw, outcome)
        });
        all.into_iter().unzip()
    }

    fn outcome(&self, draw: &Draw) -> Drawn {
        let placed = Placed::of(&self.design.pair, draw);
        let unmoved: Vec<f64> = self.traps.iter().map(|it| it.unmoved(&placed)).collect();
        let deepest = unmoved.iter().copied().fold(0.0, f64::min);
        let close = (0..unmoved.len()).filter(|&k| unmoved[k] <= MOVED * deepest);
        let moved = close.map(|k| (self.traps[k].energy(&placed).0, k));
        let trap = moved.min_by_key(|(energy, k)| (OrderedFloat(*energy), *k));
        Drawn {
            bond: self.bond.energy(&placed).0,
            trap: trap.map(|(energy, _)| energy),
            which: trap.map(|(_, k)| k),
            is_flipped: draw.iter().flatten().any(|it| it.is_flipped),
        }
    }

    /// The names of the magnets of either tile: `fixed east 1`.
    fn names(&self) -> [Vec<[String; 2]>; 2] {
        let Self { design, .. } = self;
        let tiles = [
            ("fixed", &design.pair.fixed),
            ("moving", &design.pair.moving),
        ];
        tiles.map(|(tile, content)| {
            let mut counts = vec![0; content.faces.len()];
            let name = |face: usize| {
                counts[face] += 1;
                let face_name = format!("{tile} {}", content.faces[face].name);
                [format!("{face_name} {}", counts[face]), face_name]
            };
            content.magnets.iter().map(|it| it.face).map(name).collect()
        })
    }

    /// What matters to the bond and the selectivity, and the variance (J^2) of the bond to first
    /// order.
    fn matters(&self, draws: &[Draw]) -> (Vec<Matter>, f64) {
        let pair = &self.design.pair;
        let bond = self.bond.expansion.gradients(pair);
        let trap = self.traps.first().map(|it| it.expansion.gradients(pair));
        let sources = Sources::new(&self.names());
        // The variance of each source's effect, and that of their sum.
        let variances = |effect: &(dyn Fn(&Draw) -> Vec<f64> + Sync)| -> (Vec<f64>, f64) {
            let rows = parallel::map(draws, effect);
            let of = |values: &dyn Fn(&Vec<f64>) -> f64| {
                let sd = Spread::new(0.0, rows.iter().map(values)).sd;
                sd * sd
            };
            let each = (0..sources.names.len()).map(|k| of(&|row| row[k]));
            (each.collect(), of(&|row| row.iter().sum()))
        };
        let (of_bond, variance) = variances(&|draw| sources.summed(&bond.effects(draw)));
        let nominal = Placed::of(pair, &expansion::unchanged(pair));
        let depth = self.bond.unmoved(&nominal);
        let of_ratio = trap.map(|trap| {
            let trap_depth = self.traps[0].unmoved(&nominal);
            let effect = |draw: &Draw| {
                let bond = sources.summed(&bond.effects(draw));
                let trap = sources.summed(&trap.effects(draw));
                let both = bond.iter().zip(&trap);
                both.map(|(b, t)| b / depth - t / trap_depth).collect()
            };
            variances(&effect).0
        });
        let part = |all: &[f64], k: usize| match all.iter().sum::<f64>() {
            total if total > 0.0 => all[k] / total,
            _ => 0.0,
        };
        let matter = |(k, (magnet, error)): (usize, &(String, usize))| Matter {
            magnet: magnet.clone(),
            error: NAMES[*error],
            of_bond: part(&of_bond, k),
            of_selectivity: of_ratio.as_ref().map(|all| part(all, k)),
            sd: of_bond[k].sqrt(),
        };
        let matters = sources.names.iter().enumerate().map(matter);
        let counts =
            |it: &Matter| it.sd > 0.0 || it.of_selectivity.is_some_and(|share| share > 0.0);
        let mut matters: Vec<Matter> = matters.filter(counts).collect();
        matters.order_by_key(|it| (OrderedFloat(-it.of_bond), it.magnet.clone(), it.error));
        (matters, variance)
    }

    /// Each magnet that takes part in the bond, flipped.
    fn flipped(&self, draws: &[Draw], outcomes: &[Drawn]) -> Vec<Flipped> {
        let ordinary = outcomes.iter().filter(|it| !it.is_flipped);
        let mut ordinary: Vec<f64> = ordinary.map(|it| it.bond).collect();
        if ordinary.is_empty() {
            return Vec::new();
        }
        ordinary.order_by_key(|bond| OrderedFloat(*bond));
        let weakest = quantile(&ordinary, 1.0 - ORDINARY);
        let names = self.names();
        let pair = &self.design.pair;
        let target = [pair.target.0, pair.target.1];
        let tiles = [&pair.fixed, &pair.moving];
        let magnets = [0, 1].map(|tile| {
            let all = 0..tiles[tile].magnets.len();
            let of_target = all.filter(move |&k| tiles[tile].magnets[k].face == target[tile]);
            of_target
                .map(move |magnet| (tile, magnet))
                .collect::<Vec<_>>()
        });
        let bond = |draw: &Draw| self.bond.energy(&Placed::of(pair, draw)).0;
        let with = |draw: &Draw, (tile, magnet): (usize, usize)| {
            let mut draw = draw.clone();
            draw.iter_mut()
                .flatten()
                .for_each(|it| it.is_flipped = false);
            draw[tile][magnet].is_flipped = true;
            draw
        };
        let nominal = expansion::unchanged(pair);
        parallel::map(&magnets.concat(), |&(tile, magnet)| {
            let weaker = draws
                .iter()
                .filter(|draw| bond(&with(draw, (tile, magnet))) > weakest);
            Flipped {
                magnet: names[tile][magnet][0].clone(),
                bond: bond(&with(&nominal, (tile, magnet))),
                noticed: Proportion::new(weaker.count(), draws.len()),
            }
        })
    }
}
