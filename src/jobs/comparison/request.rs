//! What is asked of an assessment.

use clap::Args;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::design::Design;
use crate::pipeline::{Check, Settings, Survey};
use crate::request::{self, Misused, of_keywords};
use physics::budget::Allowance;
use physics::landscape::{Claims, CompletenessSettings};

const DYNAMICS: &str = "\
Check the way out of the bond and the deepest trap's escape by moving tiles, with RUNS \
trajectories below each [default: 1000]; a contradiction ends the command with status 1 after all \
results are written. 1000 take a second of a core and, for curved shapes, up to five";

/// How much work a design is worth: all that decides an assessment besides the design and the seed.
///
/// Work is counted, so that every machine finds the same.
#[derive(Clone, Debug, Default, PartialEq, Args, Serialize, Deserialize)]
#[command(mut_arg("dynamics", |dynamics| dynamics.help(DYNAMICS)))]
pub struct Request {
    /// How thoroughly landscapes are surveyed.
    #[command(flatten)]
    #[serde(flatten)]
    pub survey: Survey,

    /// Width (J) to which the certified bounds are narrowed [default: a hundredth of the
    /// bond or a twentieth of the barrier, whichever is less]
    #[arg(long, value_name = "E_J", value_parser = request::energy)]
    #[serde(rename = "tolerance_J")]
    pub tolerance: Option<f64>,

    /// Cells spent on the certified bounds of a barrier at most; 0 for no bounds [default: 200000; of
    /// very many magnets 0]
    #[arg(long, value_name = "N", value_parser = request::count_or_none)]
    pub certify_cells: Option<usize>,

    /// Cells spent on the search for states that the survey missed, at most; 0 for no search
    /// [default: 300000; of very many magnets 0]
    // Of blocks it is a thirtieth, which takes about as long.
    #[arg(long, value_name = "N", value_parser = request::count_or_none)]
    pub complete_cells: Option<usize>,

    /// Whether moving tiles check the barriers.
    #[command(flatten)]
    #[serde(flatten)]
    pub check: Check,
}

/// How designs are assessed, and with which seed.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Question {
    /// How much work a design is worth.
    #[command(flatten)]
    pub request: Request,

    /// Seed of all random numbers: the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = Settings::default().seed,
          value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// With nothing left open, the same for all designs: see [`Settings::of`].
    #[must_use]
    pub fn of<'a>(&self, designs: impl IntoIterator<Item = &'a Design>) -> Self {
        let usual = Settings::of(designs);
        let cells = |allowed: Allowance, usual: usize| if allowed.is_none() { 0 } else { usual };
        let certify = cells(usual.certify, 200_000);
        let complete = cells(usual.completeness.allowed, 300_000);
        Self {
            survey: self.survey.of(&usual),
            certify_cells: self.certify_cells.or(Some(certify)),
            complete_cells: self.complete_cells.or(Some(complete)),
            ..self.clone()
        }
    }

    /// Refuses what no command line could ask for: it may have been read from a file.
    ///
    /// # Errors
    /// Which setting has a value that it cannot have.
    pub fn check(&self) -> Result<(), Misused> {
        let Value::Object(settings) = json!(self) else {
            return Ok(());
        };
        let given = settings.into_iter().filter(|(_, value)| !value.is_null());
        let option = |(key, value): (String, Value)| {
            let option = match &key[..] {
                "tolerance_J" => "tolerance",
                "most_kinds" => "kinds",
                other => other,
            };
            (option.to_owned(), vec![value.to_string()])
        };
        of_keywords::<Self>(given.map(option)).map(drop)
    }

    /// The settings of the main job.
    pub fn settings(&self, seed: u64) -> Settings {
        let worth = |cells: usize| match cells {
            0 => Allowance::NONE,
            _ => Allowance::UNLIMITED,
        };
        let [certify_cells, complete_cells] =
            [self.certify_cells, self.complete_cells].map(Option::unwrap_or_default);
        let usual = Settings::default();
        self.survey.settings(Settings {
            seed,
            tolerance: self.tolerance,
            certify_cells,
            certify: worth(certify_cells),
            completeness: CompletenessSettings {
                cells: complete_cells,
                allowed: worth(complete_cells),
                ..usual.completeness
            },
            claims: Claims::BondAndDeepestTrap,
            dynamics_runs: self.check.dynamics_runs,
            ..usual
        })
    }
}
