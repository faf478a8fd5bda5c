//! `tilebind barrier`.

use std::path::PathBuf;

use clap::Args;
use tilebind::landscape::minimax::End;
use tilebind::query::{self, Request};
use tilebind::report::barrier::{FILES, PATHWAY, document};
use tilebind::report::csv;

use super::options::{DesignOptions, ThreadOption};
use super::progress::Progress;
use super::results::NumberOptions;
use super::{Asked, Failure, input, interrupt, workload};

/// Print the energy barrier between two poses with certified bounds, as JSON
#[derive(Args)]
#[command(after_help = "\
The barrier is the lowest maximum energy over all collision-free paths between the two poses.

Examples:
  tilebind barrier shapes/paper-tile.toml --from 0.43,0.04,0 --to 0.43,0,0
  tilebind barrier shapes/paper-tile.toml --from 0.43,0,0 --to free --pathway way.csv
  tilebind barrier shapes/paper-tile.toml --from 0.43,0,0 --to free --text --out target/barrier")]
pub struct Barrier {
    #[command(flatten)]
    design: DesignOptions,

    #[command(flatten)]
    request: Asked<Request>,

    /// File for the pathway (CSV)
    ///
    /// Between lines the motion is linear in x, y and theta; theta takes the shorter way round.
    /// Tiles that turn in contact overlap there by up to a millionth of their size.
    #[arg(long, value_name = "FILE")]
    pathway: Option<PathBuf>,

    #[command(flatten)]
    threads: ThreadOption,

    /// Do not print progress
    #[arg(long)]
    quiet: bool,

    #[command(flatten)]
    results: NumberOptions,
}

impl Barrier {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        input::doubt_pose(&design, &self.request.from);
        if let End::At(to) = &self.request.to {
            input::doubt_pose(&design, to);
        }
        let inputs = self.design.inputs(&design);
        let pathway = self.pathway.as_ref();
        let pathway =
            pathway.map(|file| self.results.folder.force.file(&FILES, file, inputs.clone()));
        let pathway = pathway.transpose()?;
        let output = self.results.folder.output(&FILES, inputs)?;
        if let (Some(file), Some(output)) = (&self.pathway, &output)
            && output.may_write(file)
        {
            return Err(Failure::Usage(format!(
                "--pathway {}: --out writes a file of this name: give another name",
                file.display()
            )));
        }
        let progress = Progress::new(self.quiet);
        let query = self.request.seated(&design, &progress);
        let analysis = query.analysis(&design);
        workload::tell_memory(analysis.check_memory())?;
        self.threads.use_threads()?;
        workload::tell_of(&design, &analysis);
        let answer = query::barrier(&design, &query, &progress).map_err(Failure::of)?;
        progress.finish();
        if let Some(pathway) = pathway {
            let table = csv::pathway(&answer.barrier.pathway);
            interrupt::without(|| pathway.write_file(table))?;
        }
        let named = self.pathway.map(|file| file.to_string_lossy().into_owned());
        let inside = output.as_ref().map(|_| PATHWAY.to_owned());
        let file = named.or(inside);
        let document = document(&design, &query, &answer, file.as_deref());
        self.results.deliver(&document, output)
    }
}
