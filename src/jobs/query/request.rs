//! The request of a barrier.

use clap::Args;

use crate::design::Design;
use crate::pipeline::{self, Certify, Survey};
use crate::request;
use crate::seated::seated;
use physics::configuration::Configuration;
use physics::landscape::minimax::End;
use physics::observer::Observer;

const WORK: &str = "\
Effort of the certified bounds, in core-seconds; 0: no bounds [default: 180]";

const WORK_LONG: &str = "\
Effort of the certified bounds, in core-seconds; 0: no bounds [default: 180]

Counted in steps, not timed.";

/// The options of a query for one barrier.
#[derive(Clone, Debug, PartialEq, Args)]
#[command(mut_arg("certify_work", |work| work.help(WORK).long_help(WORK_LONG)))]
pub struct Request {
    /// Initial pose (m, m, rad)
    #[arg(long, value_name = "X,Y,THETA", allow_hyphen_values = true, value_parser = request::pose)]
    pub from: Configuration,

    /// Final pose, or `free`: anywhere with the tiles far apart
    #[arg(long, value_name = "X,Y,THETA", allow_hyphen_values = true, value_parser = end)]
    pub to: End,

    /// Target width (J) of the bounds [default: 1/100 of the bond's depth]
    #[arg(long, value_name = "E_J", value_parser = request::energy)]
    pub tolerance: Option<f64>,

    /// The effort of its bounds.
    #[command(flatten)]
    pub certify: Certify,

    /// Milestones of the roadmap [default: 8000; fewer for very many magnets]
    #[arg(long, value_name = "N", value_parser = request::count)]
    pub milestones: Option<usize>,

    /// Random seed
    #[arg(long, value_name = "N", default_value_t = pipeline::Request::default().seed,
          value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// With ends at which the tiles overlap slightly moved out to contact; the observer is warned.
    #[must_use]
    pub fn seated(&self, design: &Design, observer: &dyn Observer) -> Self {
        let problem = design.problem();
        Self {
            from: seated(&problem, &self.from, observer),
            to: match &self.to {
                End::At(to) => End::At(seated(&problem, to, observer)),
                End::Free => End::Free,
            },
            ..self.clone()
        }
    }

    /// The survey of the roadmap on which paths are searched, and the effort of the bounds.
    pub fn analysis(&self, design: &Design) -> pipeline::Request {
        let usual = pipeline::Request::usual([design]);
        pipeline::Request {
            survey: Survey {
                milestones: self.milestones.or(usual.survey.milestones),
                far_starts: Some(0),
                kinds: None,
                ..usual.survey
            },
            certify: self.certify.or(pipeline::Request::default().certify),
            seed: self.seed,
            ..usual
        }
    }
}

/// A pose or `free`.
fn end(text: &str) -> Result<End, String> {
    match text {
        "free" => Ok(End::Free),
        _ => request::pose(text)
            .map(End::At)
            .map_err(|error| format!("{error}; or `free`")),
    }
}
