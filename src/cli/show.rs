//! `tilebind show`.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use clap::Args;
use tilebind::design::Design;
use tilebind::inspection::Inspection;
use tilebind::output::Command;
use tilebind::report::plots::{PictureError, Sheet, glance};
use tilebind::report::{inspection, json};

use super::options::{DesignOptions, ForceOption};
use super::{Failure, interrupt, print, style, tell};

/// Of a PDF (mm): the width of a text on A4 in a thousand pixels.
const PIXEL: f64 = 0.17;
/// How often a watched file is looked at.
const BLINK: Duration = Duration::from_millis(300);

/// Show a design at a glance: both tiles, the bond, forces, what is wrong
#[derive(Args)]
#[command(after_help = "\
The tiles are drawn where their target faces meet; nothing is searched, so it takes no time.

Examples:
  tilebind show shapes/paper-tile.toml
  tilebind show my.toml --out my.svg
  tilebind show my.toml --watch
  tilebind show my.toml --json | jq .pull_off_N")]
pub struct Show {
    #[command(flatten)]
    design: DesignOptions,

    /// File for the picture: .svg, .png or .pdf by its ending
    #[arg(long, short, value_name = "FILE", value_parser = picture_file)]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    /// Print JSON instead of text
    #[arg(long)]
    json: bool,

    /// Show it again whenever the design file or its drawings change, until interrupted
    #[arg(long, conflicts_with = "json")]
    watch: bool,
}

const SHOW: Command = Command::of_single_files("show");

impl Show {
    pub fn run(self) -> Result<(), Failure> {
        if !self.watch {
            return self.show();
        }
        interrupt::prepare()?;
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
        if let Some(file) = &self.out {
            let output = self.force.file(&SHOW, file, self.design.inputs(&design))?;
            let bytes = picture(&design, &found, file)?;
            interrupt::without(|| output.write_file(bytes))?;
        }
        if self.json {
            return print(&json::text(&inspection::json(&design, &found)));
        }
        print(&inspection::text(
            &design,
            &found,
            style::columns().unwrap_or(80),
        ))?;
        if let Some(file) = &self.out {
            tell(format!("picture in {}", file.display()));
        }
        Ok(())
    }

    /// When the design file and its drawings were written last.
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

/// The picture of a design as the file's ending asks for it.
fn picture(design: &Design, found: &Inspection, file: &Path) -> Result<Vec<u8>, PictureError> {
    let ending = file.extension().unwrap_or_default();
    let sheet = match ending == "pdf" {
        true => Sheet::of_pixels(PIXEL),
        false => Sheet::SCREEN,
    };
    let picture = glance::draw(design, found, &sheet)?;
    let svg = picture.svg.into_bytes();
    Ok(match ending.to_str() {
        Some("pdf") => picture.pdf.unwrap_or(svg),
        Some("png") => picture.png.unwrap_or(svg),
        _ => svg,
    })
}

/// A file that a picture can be written to.
fn picture_file(text: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    let ending = file
        .extension()
        .map(|ending| ending.to_string_lossy().into_owned());
    match ending.as_deref() {
        Some("svg" | "png" | "pdf") => Ok(file),
        _ => Err("a picture is a .svg, .png or .pdf file, such as design.svg".to_owned()),
    }
}
