//! One barrier, asked for: from a pose of the moving tile to another, or to anywhere far apart.

use std::collections::HashSet;
use std::time::Duration;

use crate::analysis::Settings;
use crate::certification::{self, Uncertified};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::certificate::{Certifier, CertifyError, Effort, End};
use crate::landscape::minimum::descend;
use crate::landscape::network::{Link, Way};
use crate::landscape::survey::{Survey, same_link};
use crate::landscape::symmetry::Symmetry;
use crate::landscape::{Pathway, pathway};
use crate::pipeline::{self, Clock, Observer};
use crate::problem::Problem;
use crate::roadmap::{EdgeSettings, Milestone, edge};

/// Nodes of the network to which an end is joined by straight motions, where these are free.
const JOINED: usize = 40;
/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;

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
/// A roadmap as for the main job is surveyed with the two poses as further nodes, each joined by
/// its descent and by straight motions; the minimax pathway found in it is the start of the
/// certificate, which may lower it.
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
    let ends: Vec<Configuration> = match query.to {
        End::At(to) => vec![query.from, to],
        End::Free => vec![query.from],
    };
    for end in &ends {
        check(&problem, end)?;
    }
    let mut answer = Answer {
        saddle_energy: f64::INFINITY,
        saddle: None,
        lower: None,
        upper: None,
        uncertified: None,
        caged: false,
        from_energy: problem.energy(&query.from),
        to_energy: match query.to {
            End::At(to) => problem.energy(&to),
            End::Free => 0.0,
        },
        pathway: find_way(design, &problem, query, &ends, observer),
    };
    answer.rate();
    observer.stage("certificate", 0.8);
    answer.uncertified = certify(design, &problem, query, &mut answer).err();
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

    /// Reads the saddle off the pathway.
    fn rate(&mut self) {
        if let Some(highest) = pathway::highest_point(&self.pathway) {
            self.saddle_energy = highest.energy;
            self.saddle = Some(highest.configuration);
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

/// The minimax pathway that a roadmap holds; empty where it holds none.
fn find_way(
    design: &Design,
    problem: &Problem,
    query: &Query,
    ends: &[Configuration],
    observer: &dyn Observer,
) -> Pathway {
    let symmetries = Symmetry::all(design);
    let mut clock = Clock::new(problem, observer);
    let seed = query.settings.seed;
    let mut survey = pipeline::survey(
        design,
        problem,
        &symmetries,
        &query.settings,
        seed,
        ends,
        &mut clock,
    )
    .survey;
    let depth = pipeline::energy_scale(design, problem);
    let settings = pipeline::edge_settings(&query.settings, depth);
    let nodes: Vec<usize> = ends
        .iter()
        .map(|end| attach(problem, &mut survey, end, &settings))
        .collect();
    let goal = HashSet::from([nodes.get(1).copied().unwrap_or(survey.free)]);
    pathway::lowest(
        problem,
        &survey.network,
        nodes[0],
        [&goal, &goal],
        [depth, BEND * depth],
    )
    .map_or_else(Pathway::new, |lowest| lowest.pathway)
}

/// Adds a configuration to the network, joined by its descent and by the straight motions to the
/// nearest nodes.
fn attach(
    problem: &Problem,
    survey: &mut Survey,
    q: &Configuration,
    settings: &EdgeSettings,
) -> usize {
    let node = survey.network.add_node(Some((*q, problem.energy(q))));
    let mut near: Vec<(f64, usize, Configuration)> = survey
        .network
        .nodes
        .iter()
        .enumerate()
        .filter(|(number, _)| *number != node)
        .filter_map(|(number, known)| {
            let other = (*known)?.0;
            Some((problem.space.distance(q, &other), number, other))
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.truncate(JOINED);
    let mut milestones = vec![Milestone::new(problem, *q)];
    milestones.extend(
        near.iter()
            .map(|(_, _, other)| Milestone::new(problem, *other)),
    );
    let pairs: Vec<(u32, u32)> = (1..milestones.len() as u32).map(|k| (0, k)).collect();
    for found in edge::edges(problem, &milestones, &pairs, settings) {
        survey.network.add_link(Link {
            from: node,
            to: near[found.to as usize - 1].1,
            costs: found.costs,
            way: Way::Straight,
        });
    }
    if problem.space.is_far(q) {
        let link = same_link(node, survey.free, problem.energy(q));
        survey.network.add_link(link);
        return node;
    }
    let descent = descend(problem, q);
    if let Some(end) = survey.arrive(problem, &descent) {
        survey
            .network
            .add_way(problem, node, end, descent.way, settings);
    }
    node
}

/// Brackets the saddle energy, and takes over the certificate's pathway where it is lower.
fn certify(
    design: &Design,
    problem: &Problem,
    query: &Query,
    answer: &mut Answer,
) -> Result<(), Uncertified> {
    let bounds = certification::bounds(design)?;
    if query.certify.is_zero() {
        return Err(Uncertified::NoTime);
    }
    let depth = pipeline::energy_scale(design, problem);
    let mut certifier = Certifier::new(bounds.as_ref(), problem.contact.as_ref(), &problem.space);
    let known: Vec<Configuration> = answer.pathway.iter().map(|p| p.configuration).collect();
    let effort = Effort {
        tolerance: query.tolerance.unwrap_or(0.01 * depth),
        cells: usize::MAX,
        time: Some(query.certify),
    };
    let bracket = match certifier.bracket(&query.from, &query.to, &known, &effort) {
        Ok(bracket) => bracket,
        // Both ends have been checked.
        Err(CertifyError::NotFree(_) | CertifyError::OffTheTable(_)) => return Ok(()),
    };
    answer.lower = Some(bracket.lower);
    answer.upper = bracket.upper;
    answer.caged = bracket.caged;
    if bracket.improved
        && bracket
            .upper
            .is_some_and(|upper| upper < answer.saddle_energy)
    {
        answer.pathway = pathway::of_configurations(problem, &bracket.pathway, BEND * depth);
        answer.rate();
    }
    Ok(())
}
