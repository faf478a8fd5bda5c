//! The destination of results.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::output::{Command, Output};
use tilebind::report::document::Document;
use tilebind::report::plots::PictureError;

use super::figures::{FigureOptions, command_line};
use super::options::{ForceOption, PrintOptions};
use super::progress::Progress;
use super::{Failure, interrupt, print, style};

/// Options of the results folder.
#[derive(Args)]
pub struct FolderOptions {
    /// Folder for report.html, report.json, tables and pictures
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    pub force: ForceOption,

    #[command(flatten)]
    figures: FigureOptions,
}

impl FolderOptions {
    /// The results folder of a command that reads `inputs`, if requested; an error if files are in
    /// the way.
    pub fn output(
        &self,
        command: &'static Command,
        inputs: Vec<PathBuf>,
    ) -> Result<Option<Output>, Failure> {
        self.figures.sheet()?;
        let folder = self.out.as_ref();
        let folder = folder.map(|it| self.force.folder(command, it, inputs));
        folder.transpose()
    }

    /// Writes the results; reports at the end whether all pictures could be drawn.
    fn write(
        &self,
        document: &Document,
        output: Option<Output>,
    ) -> Result<Result<(), PictureError>, Failure> {
        let Some(output) = output else {
            return Ok(Ok(()));
        };
        let (files, drawn) = document.files(&self.figures.sheet()?, &command_line());
        interrupt::without(|| output.write(&files))?;
        Ok(drawn)
    }

    /// The text for the terminal.
    fn describe(&self, document: &Document) -> String {
        match &self.out {
            Some(folder) => describe_of(document, folder),
            None => format!(
                "{}nothing was written: add --out DIR for a report and tables\n",
                document.text(style::columns())
            ),
        }
    }
}

/// The text for the terminal for results in a folder.
pub fn describe_of(document: &Document, folder: &Path) -> String {
    format!(
        "{}results in {}: open report.html; also {}report.json, tables, pictures\n",
        document.text(style::columns()),
        folder.display(),
        beside(document)
    )
}

/// Options of the results folder and of the printed output.
#[derive(Args)]
pub struct ResultOptions {
    #[command(flatten)]
    folder: FolderOptions,

    #[command(flatten)]
    print: PrintOptions,
}

impl ResultOptions {
    /// The results folder of a command that reads `inputs`, if requested; an error if files are in
    /// the way.
    pub fn output(
        &self,
        command: &'static Command,
        inputs: Vec<PathBuf>,
    ) -> Result<Option<Output>, Failure> {
        self.folder.output(command, inputs)
    }

    /// The progress bar, unless `--quiet` is given.
    pub fn progress(&self) -> Progress {
        self.print.progress()
    }

    /// Writes the results to their folder, and prints them.
    pub fn deliver(
        &self,
        document: &Document,
        output: Option<Output>,
        progress: &Progress,
    ) -> Result<(), Failure> {
        let drawn = self.folder.write(document, output)?;
        progress.finish();
        self.print
            .results(&document.printed(), || self.folder.describe(document))?;
        Ok(drawn?)
    }
}

/// The same for commands that print JSON by default.
#[derive(Args)]
pub struct NumberOptions {
    #[command(flatten)]
    pub folder: FolderOptions,

    /// Print text instead of JSON
    #[arg(long)]
    text: bool,
}

impl NumberOptions {
    /// See [`ResultOptions::deliver`].
    pub fn deliver(&self, document: &Document, output: Option<Output>) -> Result<(), Failure> {
        let drawn = self.folder.write(document, output)?;
        print(&match self.text {
            true => self.folder.describe(document),
            false => document.printed(),
        })?;
        Ok(drawn?)
    }
}

/// The additional files in the folder: `words.toml, designs/, `.
fn beside(document: &Document) -> String {
    let mut names: Vec<String> = Vec::new();
    for name in document.beside.keys() {
        let name = match name.split_once('/') {
            Some((folder, _)) => format!("{folder}/, "),
            None => format!("{name}, "),
        };
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.concat()
}
