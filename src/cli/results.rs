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

/// What is kept.
#[derive(Args)]
pub struct FolderOptions {
    /// Folder for report.html, report.json, tables and pictures
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    #[command(flatten)]
    figures: FigureOptions,
}

impl FolderOptions {
    /// The folder for results of a command that reads `inputs`, if any is asked for. What is in the way
    /// is refused.
    fn output(
        &self,
        command: &'static Command,
        inputs: Vec<PathBuf>,
    ) -> Result<Option<Output>, Failure> {
        self.figures.sheet()?;
        let folder = self.out.as_ref();
        let folder = folder.map(|it| self.force.folder(command, it, inputs));
        folder.transpose()
    }

    /// Writes what is found; whether all pictures could be drawn is told last.
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

    /// What people read on a terminal.
    fn told(&self, document: &Document) -> String {
        match &self.out {
            Some(folder) => told_of(document, folder),
            None => format!(
                "{}nothing was written: add --out DIR for a report and tables\n",
                document.text(style::columns())
            ),
        }
    }
}

/// What people read on a terminal of results in a folder.
pub fn told_of(document: &Document, folder: &Path) -> String {
    format!(
        "{}results in {}: open report.html; also {}report.json, tables, pictures\n",
        document.text(style::columns()),
        folder.display(),
        beside(document)
    )
}

/// What is kept and what is printed.
#[derive(Args)]
pub struct ResultOptions {
    #[command(flatten)]
    folder: FolderOptions,

    #[command(flatten)]
    print: PrintOptions,
}

impl ResultOptions {
    /// The folder for results of a command that reads `inputs`, if any is asked for. What is in the way
    /// is refused.
    pub fn output(
        &self,
        command: &'static Command,
        inputs: Vec<PathBuf>,
    ) -> Result<Option<Output>, Failure> {
        self.folder.output(command, inputs)
    }

    /// The bar that shows progress, unless all is to be quiet.
    pub fn progress(&self) -> Progress {
        self.print.progress()
    }

    /// Writes what is found to its folder, and prints it.
    pub fn deliver(
        &self,
        document: &Document,
        output: Option<Output>,
        progress: &Progress,
    ) -> Result<(), Failure> {
        let drawn = self.folder.write(document, output)?;
        progress.finish();
        self.print
            .results(&document.printed(), || self.folder.told(document))?;
        Ok(drawn?)
    }
}

/// The same of commands that print numbers for programs.
#[derive(Args)]
pub struct NumberOptions {
    #[command(flatten)]
    folder: FolderOptions,

    /// Print text instead of JSON
    #[arg(long)]
    text: bool,
}

impl NumberOptions {
    /// See [`ResultOptions::output`].
    pub fn output(
        &self,
        command: &'static Command,
        inputs: Vec<PathBuf>,
    ) -> Result<Option<Output>, Failure> {
        self.folder.output(command, inputs)
    }

    /// A single file of the command. What is in the way is refused.
    pub fn file(
        &self,
        command: &'static Command,
        file: &Path,
        inputs: Vec<PathBuf>,
    ) -> Result<Output, Failure> {
        self.folder.force.file(command, file, inputs)
    }

    /// See [`ResultOptions::deliver`].
    pub fn deliver(&self, document: &Document, output: Option<Output>) -> Result<(), Failure> {
        let drawn = self.folder.write(document, output)?;
        print(&match self.text {
            true => self.folder.told(document),
            false => document.printed(),
        })?;
        Ok(drawn?)
    }
}

/// What else is in the folder: `words.toml, designs/, `.
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
