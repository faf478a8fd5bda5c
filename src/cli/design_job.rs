//! Commands that answer a request about one design.

use clap::Args;
use tilebind::design::Design;
use tilebind::output::{Command, Output};
use tilebind::report::document::Document;
use tilebind::request::Options;

use super::options::{DesignOptions, ThreadOption};
use super::progress::Progress;
use super::results::ResultOptions;
use super::{Asked, Failure};

/// The options: a design and the request about it.
#[derive(Args)]
pub struct DesignJob<R: Options> {
    #[command(flatten)]
    design: DesignOptions,

    #[command(flatten)]
    request: Asked<R>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

/// Such a command once its inputs are read and its outputs are known to have room.
pub struct Begun {
    pub design: Design,
    pub progress: Progress,
    /// How many threads work.
    pub threads: usize,
    output: Option<Output>,
    results: ResultOptions,
}

impl<R: Options> DesignJob<R> {
    /// Reads the design and makes ready to write the files of the command.
    pub fn begin(self, files: &'static Command) -> Result<(R, Begun), Failure> {
        let design = self.design.load()?;
        let output = self.results.output(files, self.design.inputs(&design))?;
        self.threads.use_threads()?;
        let begun = Begun {
            design,
            progress: self.results.progress(),
            threads: self.threads.count(),
            output,
            results: self.results,
        };
        Ok((self.request.0, begun))
    }
}

impl Begun {
    /// Whether a report is written.
    pub fn is_written(&self) -> bool {
        self.output.is_some()
    }

    /// Writes the results, as a document of the design, and prints them.
    pub fn deliver<'a>(
        &'a mut self,
        document: impl FnOnce(&'a Design) -> Document<'a>,
    ) -> Result<(), Failure> {
        let output = self.output.take();
        let document = document(&self.design);
        self.results.deliver(&document, output, &self.progress)
    }
}
