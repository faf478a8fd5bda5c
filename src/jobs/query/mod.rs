//! Queries for one barrier: from a pose of the moving tile to another, or to anywhere far apart.

pub mod poses;
mod request;
mod ways;

pub use request::Request;

use crate::design::Design;
use crate::pipeline;
use crate::request::Unanswered;
use physics::budget::Ended;
use physics::configuration::Configuration;
use physics::landscape::minimax::{Certifier, Effort, End};
use physics::landscape::{Barrier, Place, Uncertified, barrier_bounds, pathway};
use physics::observer::Observer;
use physics::problem::Problem;
use ways::PathSearch;

/// Number of cells of the certificate before a roadmap is built: they take about as long as a
/// roadmap.
const CELLS_BEFORE_ROADMAP: usize = 100_000;

/// The answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// From the start, as state 0, to the end, as state 1 or `free`.
    pub barrier: Barrier,
    /// Why there are no bounds, if there are none.
    pub uncertified: Option<Uncertified>,
    /// What ended the certification before the bounds were as narrow as requested.
    pub ended: Option<Ended>,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum QueryError {
    #[error(
        "the tiles overlap by {:.4} mm at the pose {},{},{}: choose a pose whose clearance is not \
         negative (`tilebind energy` prints it)", -1e3 * .1, .0.x, .0.y, .0.theta
    )]
    /// The tiles overlap at an end, with this clearance (m).
    Overlap(Configuration, f64),
    #[error(
        "the pose {},{},{} is off the table, which extends to x = +-{} m and y = +-{} m",
        .0.x, .0.y, .0.theta, .1[0], .1[1]
    )]
    /// An end lies off the table of this half size (m).
    OffTheTable(Configuration, [f64; 2]),
    /// Neither a path nor a proof that there is none was found.
    #[error("no path was found or excluded: use more milestones")]
    NoWay,
}

impl Unanswered for QueryError {
    fn is_of_the_question(&self) -> bool {
        *self != Self::NoWay
    }
}

/// The barrier between two poses, or between a pose and far apart.
///
/// If the energy can be bounded, the certificate comes first: it finds a path by itself, usually
/// faster than a roadmap, and the transition states near the path's peaks give the saddle to full
/// accuracy. If its bounds are not narrow enough after a while, or if nothing can be certified, a
/// roadmap as in an analysis is surveyed with the two poses as additional nodes, and the
/// certification continues from its minimax pathway.
///
/// # Errors
/// If an end is off the table or the tiles overlap there, or if no path is found although none is
/// disproved.
pub fn barrier(
    design: &Design,
    query: &Request,
    observer: &dyn Observer,
) -> Result<Answer, QueryError> {
    let problem = design.problem();
    check(&problem, &query.from)?;
    if let Some(to) = query.to.configuration() {
        check(&problem, to)?;
    }
    let mut barrier = unknown_barrier(&problem, query);
    if query.to == End::Free && problem.space.is_far(&query.from) {
        barrier.lead_along(pathway::of_configurations(&problem, &[query.from], 0.0));
    }
    let analysis = query.analysis(design);
    let search = PathSearch::new(&problem, query, &analysis);
    let certificate = Certificate::new(&problem, query, &search, &analysis);
    let uncertified = certificate.as_ref().err().copied();
    let mut ended = None;
    match certificate {
        Ok(mut certificate) => {
            observer.stage("certificate", 0.0);
            let mut is_searched = false;
            for width in barrier_bounds::widths(problem.depth(), certificate.tolerance) {
                if !is_searched {
                    certificate.narrow(&mut barrier, width, CELLS_BEFORE_ROADMAP);
                }
                if barrier.bounds.width() <= width {
                    continue;
                }
                if !is_searched {
                    is_searched = true;
                    barrier.lead_lower(search.through_roadmap(observer));
                    observer.stage("certificate", 0.8);
                }
                certificate.narrow(&mut barrier, width, usize::MAX);
                if barrier.bounds.width() > width {
                    ended = certificate.certifier.ended();
                    break;
                }
            }
        }
        Err(_) if barrier.has_way() => (),
        Err(_) => barrier.lead_lower(search.through_roadmap(observer)),
    }
    if !barrier.has_way() && !barrier.bounds.caged {
        return Err(QueryError::NoWay);
    }
    Ok(Answer {
        barrier,
        uncertified,
        ended,
    })
}

/// The requested barrier, with nothing known yet.
fn unknown_barrier(problem: &Problem, query: &Request) -> Barrier {
    let from = (Place::State(0), problem.energy(&query.from));
    let to = match &query.to {
        End::At(to) => (Place::State(1), problem.energy(to)),
        End::Free => (Place::Free, 0.0),
    };
    Barrier::without_a_way(from, query.from, to)
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

/// The certification of one query.
struct Certificate<'a> {
    certifier: Certifier<'a>,
    query: &'a Request,
    search: &'a PathSearch<'a>,
    tolerance: f64,
}

impl<'a> Certificate<'a> {
    fn new(
        problem: &'a Problem,
        query: &'a Request,
        search: &'a PathSearch<'a>,
        analysis: &pipeline::Request,
    ) -> Result<Self, Uncertified> {
        let allowed = analysis.certify.allowed();
        let (contact, space) = (problem.contact.as_ref(), &problem.space);
        Ok(Self {
            certifier: Certifier::within(problem.bounds()?, contact, space, allowed)?,
            query,
            search,
            tolerance: query.tolerance.unwrap_or(0.01 * problem.depth()),
        })
    }

    /// Narrows the bounds to a width (J), until about the given total number of cells has been
    /// assessed, and takes over the certificate's pathway, refined, if it is lower.
    fn narrow(&mut self, barrier: &mut Barrier, width: f64, cells: usize) {
        let known: Vec<Configuration> = barrier.pathway.iter().map(|p| p.configuration).collect();
        let effort = Effort {
            tolerance: width,
            cells: cells.saturating_sub(self.certifier.assessed()),
        };
        let Request { from, to, .. } = self.query;
        let bracket = self
            .certifier
            .bracket(from, to, &known, &effort)
            .expect("both ends have been checked");
        barrier.bounds.tighten(bracket.bounds);
        let lower = |upper: f64| upper < barrier.saddle_energy;
        if bracket.improved && bracket.bounds.upper.is_some_and(lower) {
            barrier.lead_lower(self.search.near(&bracket.pathway));
        }
    }
}
