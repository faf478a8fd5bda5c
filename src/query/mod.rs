//! One barrier, asked for: from a pose of the moving tile to another, or to anywhere far apart.

mod ways;

use std::time::{Duration, Instant};

use crate::analysis::Settings;
use crate::certification::{self, Uncertified, either};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::certificate::{Certifier, Effort, End};
use crate::landscape::{Pathway, pathway};
use crate::pipeline::{self, Observer};
use crate::potential::CellBounds;
use crate::problem::Problem;
use ways::Search;

/// Cells that the certificate may spend before a roadmap is asked for a way: worth about as much
/// time as a roadmap.
const CELLS_BEFORE_ROADMAP: usize = 100_000;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    pub from: Configuration,
    pub to: End,
    /// Settings of the roadmap from which the way is found.
    pub settings: Settings,
    /// The certificate's bounds are narrowed to this width (J); a hundredth of the bond's depth
    /// where `None`.
    pub tolerance: Option<f64>,
    /// Time after which the certificate stops with the bounds it has; none is made for zero.
    pub certify: Duration,
}

/// The answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The least possible highest energy of a free way, as found (J): infinite where there is no
    /// way.
    pub saddle_energy: f64,
    /// Where the pathway is highest; `None` where there is no way.
    pub saddle: Option<Configuration>,
    /// Certified bounds of the saddle energy (J), where certified.
    pub lower: Option<f64>,
    pub upper: Option<f64>,
    /// Why there are no bounds, where there are none.
    pub uncertified: Option<Uncertified>,
    /// Proved that there is no way.
    pub caged: bool,
    /// Energies (J) of the two ends; 0 for far apart.
    pub from_energy: f64,
    pub to_energy: f64,
    pub pathway: Pathway,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum QueryError {
    #[error(
        "the tiles overlap by {:.4} mm at the pose {},{},{}: choose a pose whose clearance is not \
         negative (`tilebind energy` prints it)", -1e3 * .1, .0.x, .0.y, .0.theta
    )]
    Overlap(Configuration, f64),
    #[error(
        "the pose {},{},{} lies off the table, which reaches to x = +-{} m and y = +-{} m",
        .0.x, .0.y, .0.theta, .1[0], .1[1]
    )]
    OffTheTable(Configuration, [f64; 2]),
    #[error("no way was found, and none disproved: try more milestones")]
    NoWay,
}

/// The barrier between two poses, or between a pose and far apart.
///
/// Where the energy can be bounded, the certificate comes first: it finds a way by itself, most
/// often faster than a roadmap does, and the transition states near the way's peaks give the saddle
/// to full accuracy. Where it is not narrow enough after a while, or where nothing can be certified,
/// a roadmap as for the main job is surveyed with the two poses as further nodes, and its minimax
/// pathway is the start from which the certificate goes on.
///
/// # Errors
/// Where an end is off the table or the tiles overlap there, and where no way is found though none
/// is disproved.
pub fn barrier(
    design: &Design,
    query: &Query,
    observer: &dyn Observer,
) -> Result<Answer, QueryError> {
    let problem = pipeline::problem(design);
    check(&problem, &query.from)?;
    if let Some(to) = query.to.configuration() {
        check(&problem, to)?;
    }
    let mut answer = Answer::without_a_way(&problem, query);
    let search = Search::new(design, &problem, query);
    match bounds(design, query) {
        Ok(bounds) => {
            let mut certificate = Certificate::new(&problem, bounds.as_ref(), query, &search);
            observer.stage("certificate", 0.0);
            certificate.narrow(&mut answer, CELLS_BEFORE_ROADMAP);
            if !certificate.is_done(&answer) {
                answer.take(search.through_roadmap(observer));
                observer.stage("certificate", 0.8);
                certificate.narrow(&mut answer, usize::MAX);
            }
        }
        Err(why) => {
            answer.uncertified = Some(why);
            answer.take(search.through_roadmap(observer));
        }
    }
    if answer.pathway.is_empty() && !answer.caged {
        return Err(QueryError::NoWay);
    }
    Ok(answer)
}

impl Answer {
    /// Saddle minus the energy of the start (J).
    pub fn forward(&self) -> f64 {
        self.saddle_energy - self.from_energy
    }

    /// Saddle minus the energy of the end (J).
    pub fn reverse(&self) -> f64 {
        self.saddle_energy - self.to_energy
    }

    fn without_a_way(problem: &Problem, query: &Query) -> Self {
        Self {
            saddle_energy: f64::INFINITY,
            saddle: None,
            lower: None,
            upper: None,
            uncertified: None,
            caged: false,
            from_energy: problem.energy(&query.from),
            to_energy: query.to.configuration().map_or(0.0, |q| problem.energy(q)),
            pathway: Pathway::new(),
        }
    }

    /// Takes a pathway over if it is lower than the one known.
    fn take(&mut self, pathway: Pathway) {
        let highest = pathway::highest_point(&pathway).copied();
        if let Some(highest) = highest.filter(|point| point.energy < self.saddle_energy) {
            self.saddle_energy = highest.energy;
            self.saddle = Some(highest.configuration);
            self.pathway = pathway;
        }
    }
}

fn check(problem: &Problem, q: &Configuration) -> Result<(), QueryError> {
    if !problem.space.contains(q) {
        return Err(QueryError::OffTheTable(*q, problem.space.half_size));
    }
    if !problem.is_clear(q) {
        return Err(QueryError::Overlap(*q, problem.clearance(q)));
    }
    Ok(())
}

/// The bounds over cells for a query's certificate, if it is to have one.
fn bounds(design: &Design, query: &Query) -> Result<Box<dyn CellBounds>, Uncertified> {
    if query.certify.is_zero() {
        return Err(Uncertified::NoTime);
    }
    certification::bounds(design)
}

/// The certificate of one query.
struct Certificate<'a> {
    certifier: Certifier<'a>,
    query: &'a Query,
    search: &'a Search<'a>,
    tolerance: f64,
    since: Instant,
}

impl<'a> Certificate<'a> {
    fn new(
        problem: &'a Problem,
        bounds: &'a dyn CellBounds,
        query: &'a Query,
        search: &'a Search<'a>,
    ) -> Self {
        let since = Instant::now();
        Self {
            certifier: Certifier::new(bounds, problem.contact.as_ref(), &problem.space),
            query,
            search,
            tolerance: query.tolerance.unwrap_or(0.01 * search.depth()),
            since,
        }
    }

    /// Narrows the bounds with about so many cells, and takes over the certificate's pathway, made
    /// finer, where it is lower.
    fn narrow(&mut self, answer: &mut Answer, cells: usize) {
        let known: Vec<Configuration> = answer.pathway.iter().map(|p| p.configuration).collect();
        let effort = Effort {
            tolerance: self.tolerance,
            cells,
            time: Some(self.query.certify.saturating_sub(self.since.elapsed())),
        };
        let Query { from, to, .. } = self.query;
        let bracket = self
            .certifier
            .bracket(from, to, &known, &effort)
            .expect("both ends have been checked");
        answer.lower = either(answer.lower, Some(bracket.lower), f64::max);
        answer.upper = either(answer.upper, bracket.upper, f64::min);
        answer.caged = bracket.caged;
        let lower = |upper: f64| upper < answer.saddle_energy;
        if bracket.improved && bracket.upper.is_some_and(lower) {
            answer.take(self.search.near(&bracket.pathway));
        }
    }

    /// Whether the bounds are as narrow as asked for.
    fn is_done(&self, answer: &Answer) -> bool {
        let bounds = answer.lower.zip(answer.upper);
        answer.caged || bounds.is_some_and(|(lower, upper)| upper - lower <= self.tolerance)
    }
}
