//! Options that several commands share, and their handling.
//!
//! A command for which one of them has a special meaning says so with `mut_arg`; not for a
//! positional argument, which `mut_arg` would move after the others.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::design::{Design, MagnetModel};
use tilebind::output::{Command, Output};
use tilebind::{memory, request};

use super::progress::Progress;
use super::{By, Failure, input, print, tell};

/// A design and its magnet model.
#[derive(Args)]
pub struct DesignOptions {
    /// The design file
    design: PathBuf,

    /// Magnet model, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = By(request::model()),
          hide_possible_values = true)]
    model: Option<MagnetModel>,
}

impl DesignOptions {
    /// Reads the design; its warnings go to standard error.
    pub fn load(&self) -> Result<Design, Failure> {
        input::load_as(&self.design, self.model)
    }

    /// Reads the design without printing warnings.
    pub fn load_silently(&self) -> Result<Design, Failure> {
        input::load_silently_as(&self.design, self.model)
    }

    /// The design file.
    pub fn file(&self) -> &Path {
        &self.design
    }

    /// The files of the design.
    pub fn inputs(&self, design: &Design) -> Vec<PathBuf> {
        input::files_of(&self.design, design)
    }
}

/// The treatment of files in the way.
#[derive(Args)]
pub struct ForceOption {
    /// Replace existing files, whoever wrote them
    ///
    /// Without it, only unchanged results of the same command are replaced. The files that the
    /// command reads are never replaced.
    #[arg(long)]
    pub force: bool,
}

impl ForceOption {
    /// A results folder of a command that reads `inputs`; an error if files are in the way.
    pub fn folder(
        &self,
        command: &'static Command,
        folder: &Path,
        inputs: Vec<PathBuf>,
    ) -> Result<Output, Failure> {
        let output = Output::folder(command, folder);
        let output = output.reading(inputs).forced(self.force);
        output.check(|_| true)?;
        Ok(output)
    }

    /// A file of a command that reads `inputs`; an error if files are in the way.
    pub fn file(
        &self,
        command: &'static Command,
        file: &Path,
        inputs: Vec<PathBuf>,
    ) -> Result<Output, Failure> {
        let output = Output::file(command, file)?;
        let output = output.reading(inputs).forced(self.force);
        output.check(|_| true)?;
        Ok(output)
    }
}

/// The number of threads.
#[derive(Args)]
pub struct ThreadOption {
    /// Number of threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = request::whole(1, u16::MAX))]
    threads: Option<u16>,
}

impl ThreadOption {
    /// The requested number of threads, by default that of cores.
    pub fn count(&self) -> usize {
        self.threads.map_or_else(cores, useful)
    }

    /// Makes the library use the requested number of threads, or all cores; an error if the
    /// process may not reserve their memory.
    pub fn use_threads(&self) -> Result<(), Failure> {
        memory::check_threads(self.count()).map_err(Failure::Usage)?;
        let Some(threads) = self.threads else {
            return Ok(());
        };
        let used = useful(threads);
        if used < usize::from(threads) {
            tell(format!(
                "note: using {used} threads: more would not help on {} cores",
                cores()
            ));
        }
        rayon::ThreadPoolBuilder::new()
            .num_threads(used)
            .build_global()
            .map_err(|error| Failure::Run(format!("cannot start {threads} threads: {error}")))
    }
}

/// Largest number of threads per core: thousands would wait for each other.
const MOST_FOR_A_CORE: usize = 8;

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The requested threads, limited to a useful number.
fn useful(threads: u16) -> usize {
    usize::from(threads).min(MOST_FOR_A_CORE * cores())
}

/// Options of the printed output.
#[derive(Args)]
pub struct PrintOptions {
    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    /// Do not print progress or the summary
    #[arg(long)]
    pub quiet: bool,
}

impl PrintOptions {
    /// The progress bar, unless `--quiet` is given.
    pub fn progress(&self) -> Progress {
        Progress::new(self.quiet)
    }

    /// Prints results in the requested form.
    pub fn results(&self, json: &str, summary: impl FnOnce() -> String) -> Result<(), Failure> {
        if self.json {
            print(json)
        } else if self.quiet {
            Ok(())
        } else {
            print(&summary())
        }
    }
}
