//! `tilebind barrier`.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use tilebind::budget::Ended;
use tilebind::design::Design;
use tilebind::landscape::minimax::End;
use tilebind::output::Command;
use tilebind::query::{self, Answer, QueryError, Request};
use tilebind::report::states::barriers;
use tilebind::report::{csv, json};

use super::options::{DesignOptions, ForceOption, ThreadOption};
use super::progress::Progress;
use super::{Failure, input, interrupt, memory, print, workload};

/// Print the barrier between two poses, between certified bounds, as JSON
#[derive(Args)]
#[command(
    mut_arg("threads", |threads| threads.help("Threads [default: all cores]")),
    after_help = "\
The barrier is the lowest possible value of the highest energy on the way, over all ways.

Examples:
  tilebind barrier shapes/paper-tile.toml --from 0.43,0.04,0 --to 0.43,0,0
  tilebind barrier shapes/paper-tile.toml --from 0.43,0,0 --to free --pathway way.csv"
)]
pub struct Barrier {
    #[command(flatten)]
    design: DesignOptions,

    #[command(flatten)]
    request: Request,

    /// File for the pathway (CSV); from line to line the motion is straight in x, y and theta, the
    /// shorter way round
    #[arg(long, value_name = "FILE")]
    pathway: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    #[command(flatten)]
    threads: ThreadOption,

    /// Print no progress
    #[arg(long)]
    quiet: bool,
}

const BARRIER: Command = Command::of_single_files("barrier");

impl Barrier {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let design = self.design.load()?;
        input::doubt_pose(&design, &self.request.from);
        if let End::At(to) = &self.request.to {
            input::doubt_pose(&design, to);
        }
        let output = self.pathway.as_ref().map(|file| {
            let inputs = self.design.inputs(&design);
            self.force.file(&BARRIER, file, inputs)
        });
        let output = output.transpose()?;
        let query = self.request.query(&design);
        memory::check(query.settings.milestones, None, 1)?;
        self.threads.use_threads()?;
        workload::tell_of(&design, &query.settings);
        let progress = Progress::new(self.quiet);
        let answer = query::barrier(&design, &query, &progress).map_err(|error| {
            let message = error.to_string();
            match error {
                QueryError::NoWay => Failure::Run(message),
                _ => Failure::Usage(message),
            }
        })?;
        progress.finish();
        if let Some(output) = output {
            let table = csv::pathway(&answer.barrier.pathway);
            interrupt::without(|| output.write_file(table))?;
        }
        print(&json::text(&self.entry(&design, &answer)))
    }

    /// The barrier as in report.json, its ends given by their poses.
    fn entry(&self, design: &Design, answer: &Answer) -> Value {
        let mut entry = barriers([&answer.barrier]).json()[0].take();
        entry["from"] = json!(self.request.from.to_array());
        if let End::At(pose) = self.request.to {
            entry["to"] = json!(pose.to_array());
        }
        // Why the bounds are null, where they are.
        entry["uncertified"] = json!(answer.uncertified.map(|why| why.to_string()));
        entry["model"] = json!(design.interaction.model.name());
        // What ended the narrowing before it was done: "work" or "clock", of which only the latter
        // makes another run differ.
        entry["ended_by"] = json!(answer.ended.map(Ended::name));
        let pathway = self.pathway.as_ref();
        entry["pathway"] = json!(pathway.map(|file| file.to_string_lossy()));
        entry
    }
}
