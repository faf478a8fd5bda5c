//! `tilebind init`.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::design::STARTER;

use super::{Failure, print, tell};

/// Write a design to start from, with remarks
#[derive(Args)]
#[command(after_help = "\
Examples:
  tilebind init
  tilebind init my-tile.toml
  tilebind init - | less")]
pub struct Init {
    /// The file to write, which must not exist; - is standard output
    #[arg(default_value = "design.toml")]
    file: PathBuf,
}

impl Init {
    pub fn run(self) -> Result<(), Failure> {
        if self.file == Path::new("-") {
            return print(STARTER);
        }
        let name = self.file.display();
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&self.file)
            .map_err(|error| match error.kind() {
                ErrorKind::AlreadyExists => Failure::Usage(format!(
                    "{name} exists and is left as it is\n  help: give another name: \
                     tilebind init other.toml, or - for standard output"
                )),
                _ => Failure::Run(format!("cannot write {name}: {error}")),
            })?;
        if let Err(error) = file.write_all(STARTER.as_bytes()) {
            let _ = std::fs::remove_file(&self.file);
            return Err(Failure::Run(format!("cannot write {name}: {error}")));
        }
        tell(format!(
            "wrote {name}; next: tilebind analyse {name} --out results"
        ));
        Ok(())
    }
}
