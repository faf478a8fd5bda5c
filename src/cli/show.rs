//! `tilebind show`.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use clap::Args;
use clap::builder::{PathBufValueParser, TypedValueParser};
use tilebind::design::Design;
use tilebind::inspection::Inspection;
use tilebind::report::document::Document;
use tilebind::report::inspection::{FILES, document};
use tilebind::report::plots::Sheet;

use super::figures::{FigureOptions, command_line};
use super::options::{DesignOptions, ForceOption};
use super::{Failure, interrupt, print, style, tell};

/// Size of a pixel in a PDF (mm): a thousand pixels are the text width of A4.
const PIXEL: f64 = 0.17;
/// Interval of checking a watched file.
const BLINK: Duration = Duration::from_millis(300);

/// Draw a design: both tiles, the bond, forces, and what is wrong
#[derive(Args)]
#[command(after_help = "\
The tiles are drawn with their target faces in contact. Nothing is searched, so this is immediate.

Examples:
  tilebind show shapes/paper-tile.toml
  tilebind show my.toml --out my.svg
  tilebind show my.toml --out target/my
  tilebind show my.toml --watch
  tilebind show my.toml --json | jq .pull_off_N")]
pub struct Show {
    #[command(flatten)]
    design: DesignOptions,

    /// Picture to write (.svg, .png or .pdf), or folder for report.html, tables and pictures
    #[arg(long, short, value_name = "FILE|DIR", value_parser = PathBufValueParser::new().try_map(place))]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    #[command(flatten)]
    figures: FigureOptions,

    /// Print JSON instead of text
    #[arg(long)]
    json: bool,

    /// Redraw whenever the design file or its drawings change, until interrupted
    #[arg(long, conflicts_with = "json")]
    watch: bool,
}

impl Show {
    pub fn run(self) -> Result<(), Failure> {
        if !self.watch {
            return self.show();
        }
        loop {
            let seen = self.changes();
            if style::is_terminal() {
                // Clears the screen.
                print("\u{1b}[2J\u{1b}[H")?;
            }
            match self.show() {
                Err(Failure::OutputClosed) => return Ok(()),
                Err(failure) => {
                    let _ = failure.report();
                }
                Ok(()) => {}
            }
            while self.changes() == seen {
                std::thread::sleep(BLINK);
            }
        }
    }

    fn show(&self) -> Result<(), Failure> {
        let design = self.design.load_silently()?;
        let found = Inspection::new(&design);
        let document = document(&design, &found);
        if let Some(place) = &self.out {
            self.write(&document, place, self.design.inputs(&design))?;
            interrupt::is_written();
        }
        if self.json {
            return print(&document.report());
        }
        print(&document.text(style::columns()))?;
        match &self.out {
            Some(place) if ending(place).is_some() => {
                tell(format!("picture in {}", place.display()))
            }
            Some(place) => tell(format!("results in {}", place.display())),
            None => {}
        }
        Ok(())
    }

    fn write(
        &self,
        document: &Document,
        place: &Path,
        inputs: Vec<PathBuf>,
    ) -> Result<(), Failure> {
        let sheet = self.figures.sheet()?;
        let Some(ending) = ending(place) else {
            let output = self.force.folder(&FILES, place, inputs)?;
            let (files, drawn) = document.files(&sheet, &command_line());
            interrupt::without(|| output.write(&files))?;
            return Ok(drawn?);
        };
        let output = self.force.file(&FILES, place, inputs)?;
        let sheet = match ending == "pdf" && sheet == Sheet::SCREEN {
            true => Sheet::of_pixels(PIXEL),
            false => sheet,
        };
        let drawn = document.figures(&sheet)?.into_iter().flatten();
        let mut files = drawn.flat_map(|figure| figure.files());
        let picture = files.find(|(name, _)| name.ends_with(ending));
        let (_, bytes) = picture.ok_or_else(|| Failure::run("there is no such picture"))?;
        Ok(interrupt::without(|| output.write_file(bytes))?)
    }

    /// The modification times of the design file and its drawings.
    fn changes(&self) -> Vec<Option<SystemTime>> {
        let file = self.design.file();
        let drawings = Design::load(file).map(|design| design.drawings);
        let folder = file.parent().unwrap_or(Path::new(""));
        let drawings = drawings
            .into_iter()
            .flatten()
            .map(|one| folder.join(one.file));
        let time = |file: PathBuf| file.metadata().and_then(|found| found.modified()).ok();
        std::iter::once(file.to_owned())
            .chain(drawings)
            .map(time)
            .collect()
    }
}

/// The file name extension of a supported picture format.
fn ending(place: &Path) -> Option<&str> {
    let ending = place.extension()?.to_str()?;
    ["svg", "png", "pdf"].contains(&ending).then_some(ending)
}

/// Checks a file for a picture, or a folder.
fn place(place: PathBuf) -> Result<PathBuf, String> {
    match place.extension() {
        Some(_) if ending(&place).is_none() => Err(
            "a picture is a .svg, .png or .pdf file, such as design.svg; a name without an \
             extension is a folder"
                .to_owned(),
        ),
        _ => Ok(place),
    }
}
