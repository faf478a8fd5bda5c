//! `tilebind init`.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::output::{Command, Output};
use tilebind::start::Request;

use super::{Asked, Failure, print, tell};

/// Write a commented design file to start from
#[derive(Args)]
#[command(after_help = "\
Without options the design is a pair of 43 cm squares that bind by a tab, with a comment on every key.
With options it is made to measure: magnets are sized and spaced in proportion to the paper's tile,
and the code is the one with the weakest attraction in slid positions.

Examples:
  tilebind init
  tilebind init my-tile.toml
  tilebind init hexagon.toml --sides 6 --side 0.12 --magnets 3 --shape arc
  tilebind init small.toml --side \"10 cm\" --magnet \"10 x 5 x 2 mm N42\"
  tilebind init tray.toml --side \"60 mm\" --thickness \"6 mm\" --material acrylic --magnet \"6 x 3 mm disc N42 up\"
  tilebind init - --side \"20 cm\" --shape sine | less")]
pub struct Init {
    /// File to write; - for standard output
    #[arg(default_value = "design.toml")]
    file: PathBuf,

    /// Replace the file if it exists
    #[arg(long)]
    force: bool,

    #[command(flatten)]
    request: Asked<Request>,
}

const INIT: Command = Command::of_single_files("init");

impl Init {
    pub fn run(self) -> Result<(), Failure> {
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy();
        let text = self.request.text(&stem).map_err(Failure::usage)?;
        if self.file == Path::new("-") {
            return print(&text);
        }
        let name = self.file.display();
        // The design belongs to the user from now on.
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
}
