//! `tilebind init`.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::design::{STARTER, Shape, ShopMagnet, Start};
use tilebind::output::{Command, Output};
use tilebind::request;

use super::{Failure, print, tell};
use tilebind::request::Word;

/// Write a design to start from
#[derive(Args)]
#[command(after_help = "\
Without options: 43 cm squares that bind by a tab, with a remark on every key. With any of them: a
design to measure, magnets sized and spaced in proportion as on the paper's tile, with the code that
slides least into wrong places.

Examples:
  tilebind init
  tilebind init my-tile.toml
  tilebind init hexagon.toml --sides 6 --side 0.12 --magnets 3 --shape arc
  tilebind init small.toml --side \"10 cm\" --magnet \"10 x 5 x 2 mm N42\"
  tilebind init - --side \"20 cm\" --shape sine | less")]
pub struct Init {
    /// The file to write; - is standard output
    #[arg(default_value = "design.toml")]
    file: PathBuf,

    /// Replace the file if it exists
    #[arg(long)]
    force: bool,

    /// Sides of both tiles, 3 to 24 [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32))]
    sides: Option<u32>,

    /// Length of a side (m), or with a unit: \"12 cm\" [default: 0.43]
    #[arg(long, value_name = "M", value_parser = request::length)]
    side: Option<f64>,

    /// Magnets on each of the two faces that are to bind, 1 to 16 [default: 4]
    #[arg(long, value_name = "K", value_parser = request::count)]
    magnets: Option<usize>,

    /// Shape of those faces: flat, tab, arc, sine or triangle [default: tab]
    #[arg(long, value_parser = shape(), hide_possible_values = true)]
    shape: Option<Shape>,

    /// The magnets as a shop describes them, length x width x height, magnetised through the
    /// last: \"10 x 5 x 2 mm N42\" [default: those that fit]
    #[arg(long, value_name = "BLOCK", value_parser = ShopMagnet::parse)]
    magnet: Option<ShopMagnet>,
}

fn shape() -> Word<Shape> {
    let names = Shape::NAMES.map(|(name, _)| name).join(", ");
    Word::new(&Shape::NAMES, format!("a shape is one of {names}"))
}

const INIT: Command = Command::of_single_files("init");

impl Init {
    pub fn run(self) -> Result<(), Failure> {
        let text = self.text()?;
        if self.file == Path::new("-") {
            return print(&text);
        }
        let name = self.file.display();
        // The design is the user's from now on, changed or not.
        let output = Output::file(&INIT, &self.file)?.unrecorded();
        let folder = self.file.parent().filter(|it| !it.as_os_str().is_empty());
        if let Some(Err(error)) = folder.map(std::fs::metadata) {
            return Err(Failure::Run(format!("cannot write {name}: {error}")));
        }
        output.forced(self.force).write_file(text)?;
        tell(format!(
            "wrote {name}; next: tilebind show {name}, or tilebind analyse {name} --out results"
        ));
        Ok(())
    }

    /// The design asked for.
    fn text(&self) -> Result<String, Failure> {
        let asked = (self.sides, self.side, self.magnets, self.shape);
        if asked == (None, None, None, None) && self.magnet.is_none() {
            return Ok(STARTER.to_owned());
        }
        let usual = Start::default();
        let start = Start {
            sides: self.sides.unwrap_or(usual.sides),
            side: self.side.unwrap_or(usual.side),
            magnets: self.magnets.unwrap_or(usual.magnets),
            shape: self.shape.unwrap_or(usual.shape),
            magnet: self.magnet,
        };
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy();
        // A name that no quotes or control characters end.
        let plain = |c: &char| c.is_alphanumeric() || "-_. ".contains(*c);
        let name: String = stem.chars().filter(plain).collect();
        let name = name.trim_matches(|c| c == '-' || c == ' ');
        let name = if name.is_empty() { "starter" } else { name };
        let design = start.design(name);
        design.map_err(|error| Failure::Usage(error.to_string()))
    }
}
