//! `tilebind schema`.

use clap::Args;
use tilebind::design::SCHEMA;

use super::{Failure, print};

/// Print the JSON Schema of the design file, for editors
#[derive(Args)]
#[command(after_help = "\
An editor with a TOML language server completes keys in a design that begins with this line, and
checks them:
  #:schema ./design.schema.json

Example:
  tilebind schema > design.schema.json")]
pub struct Schema {}

impl Schema {
    pub fn run(self) -> Result<(), Failure> {
        print(SCHEMA)
    }
}
