//! `tilebind schema`.

use clap::Args;
use tilebind::design::SCHEMA;

use super::{Failure, print};

/// Print the JSON Schema of the design file, for editors
#[derive(Args)]
#[command(after_help = "\
An editor with a TOML language server completes and checks a design that begins with the line
  #:schema ./design.schema.json

Example:
  tilebind schema > design.schema.json")]
pub struct Schema {}

impl Schema {
    pub fn run(self) -> Result<(), Failure> {
        print(SCHEMA)
    }
}
