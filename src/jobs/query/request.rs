//! The request of a barrier.

use crate::design::Design;
use crate::pipeline::{self, Certify, Survey};
use crate::request::{self, options};
use crate::seated::seated;
use physics::configuration::Configuration;
use physics::landscape::minimax::End;
use physics::observer::Observer;

const WORK: &str = "\
Effort of the certified bounds, in core-seconds; 0: no bounds [default: 180]

Counted in steps, not timed.";

options! {
    /// The options of a query for one barrier.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// Initial pose (m, m, rad)
        pub from: Configuration = value("X,Y,THETA", request::pose).signed(),

        /// Final pose, or `free`: anywhere with the tiles far apart
        pub to: End = value("X,Y,THETA", end).signed(),

        /// Target width (J) of the bounds [default: 1/100 of the bond's depth]
        pub tolerance: Option<f64> = value("E_J", request::energy),

        /// The effort of its bounds.
        pub certify: Certify = group().helped("certify_work", WORK),

        /// Milestones of the roadmap [default: 8000; fewer for very many magnets]
        pub milestones: Option<usize> = value("N", request::count),

        /// Random seed
        pub seed: u64 = value("N", request::seed).or(pipeline::Request::default().seed),
    }
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
