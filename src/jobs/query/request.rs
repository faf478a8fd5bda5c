//! The request of a barrier.

use clap::Args;

use super::Query;
use crate::design::Design;
use crate::pipeline::{Certify, Settings};
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
#[derive(Clone, Debug, Args)]
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
    #[arg(long, value_name = "N", default_value_t = Settings::default().seed,
          value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// The query about a design. Ends at which the tiles overlap slightly are moved out to contact;
    /// the observer is warned.
    pub fn query(&self, design: &Design, observer: &dyn Observer) -> Query {
        let default = Settings::of([design]);
        let problem = design.problem();
        Query {
            from: seated(&problem, &self.from, observer),
            to: match &self.to {
                End::At(to) => End::At(seated(&problem, to, observer)),
                End::Free => End::Free,
            },
            settings: Settings {
                seed: self.seed,
                milestones: self.milestones.unwrap_or(default.milestones),
                far_starts: 0,
                most_kinds: None,
                certify: self.certify.allowed(Settings::default().certify),
                ..default
            },
            tolerance: self.tolerance,
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
