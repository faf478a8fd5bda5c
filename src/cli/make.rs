//! `tilebind make`.

use std::path::PathBuf;

use clap::Args;
use tilebind::report::files::MAKE;
use tilebind::report::workshop;
use tilebind::request;
use tilebind::workshop::Making;

use super::options::ForceOption;
use super::{Failure, input, interrupt, print};

/// Write both tiles for the workshop: DXF and SVG to scale, and a sheet for the magnets
#[derive(Args)]
#[command(after_help = "\
Writes fixed.dxf, fixed.svg, moving.dxf and moving.svg (outlines with pockets, in mm) and sheet.md:
which magnets to buy, which pole goes where, and in which order to put them in.

Examples:
  tilebind make shapes/tab-20mm.toml --out workshop
  tilebind make my.toml --out workshop --kerf \"0.15 mm\" --clearance \"0.1 mm\"")]
pub struct Make {
    /// The design file
    design: PathBuf,

    /// Folder for the files; made if need be
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,

    #[command(flatten)]
    force: ForceOption,

    /// Width of the cut (m), or with a unit: lines run half of it outside the parts
    #[arg(long, value_name = "M", default_value = "0", value_parser = request::length_or_none)]
    kerf: f64,

    /// By how much pockets are larger than their magnets on every side (m)
    #[arg(long, value_name = "M", default_value = "0.1 mm", value_parser = request::length_or_none)]
    clearance: f64,
}

impl Make {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        for (name, length) in [("--kerf", self.kerf), ("--clearance", self.clearance)] {
            if length > 0.01 {
                return Err(Failure::Usage(format!(
                    "{name} is {length} m: lengths are in m; in millimetres write \"{length} mm\""
                )));
            }
        }
        let design = input::load(&self.design)?;
        let inputs = input::files_of(&self.design, &design);
        let output = self.force.folder(&MAKE, &self.out, inputs)?;
        let making = Making {
            kerf: self.kerf,
            clearance: self.clearance,
        };
        let files = workshop::files(&design, &making);
        let files = files.map_err(|error| Failure::Usage(error.to_string()))?;
        interrupt::without(|| output.write(&files))?;
        let magnets = design.pair.fixed.magnets.len() + design.pair.moving.magnets.len();
        let counted = match magnets {
            1 => "1 magnet".to_owned(),
            many => format!("{many} magnets"),
        };
        print(&format!(
            "two tiles with {counted} in {}: fixed.dxf, moving.dxf, the same as .svg, and sheet.md \
             to work by\n",
            self.out.display()
        ))
    }
}
