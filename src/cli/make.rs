//! `tilebind make`.

use std::path::PathBuf;

use clap::Args;
use tilebind::report::workshop::{FILES, document};
use tilebind::workshop::{Made, Making};

use super::results::ResultOptions;
use super::{Failure, input};

/// Write workshop files for both tiles: DXF and SVG to scale, and a magnet sheet
#[derive(Args)]
#[command(
    mut_arg("out", |out| out.required(true).help("Folder for the files, created if missing")),
    after_help = "\
The command writes fixed.dxf, fixed.svg, moving.dxf and moving.svg (outlines with pockets and marks, in
mm), check.svg (to print at full size and lay the glued tiles on) and sheet.md: which magnets to buy,
which pole goes where, and in which order to insert them. Layers of the drawings, in the order of work:
ENGRAVE, CUT_INSIDE, CUT_OUTSIDE. A pocket without a wall to the rim becomes a notch of the outline.

With --copies, --count or --sheet all parts are also nested on sheets: nested-1.dxf, nested-1.svg and so
on. With --layers there is also a part for each layer, such as fixed-layer-1.dxf, and glue-up.svg.

Examples:
  tilebind make shapes/tab-20mm.toml --out workshop
  tilebind make my.toml --out workshop --kerf \"0.15 mm\" --clearance \"0.1 mm\"
  tilebind make my.toml --out workshop --copies 6 --sheet \"600x400 mm\" --layers \"4 mm,4 mm\"")]
pub struct Make {
    /// The design file
    design: PathBuf,

    #[command(flatten)]
    making: Making,

    #[command(flatten)]
    results: ResultOptions,
}

impl Make {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::load(&self.design)?;
        let inputs = input::files_of(&self.design, &design);
        let output = self.results.output(&FILES, inputs)?;
        let made = Made::new(&design, &self.making).map_err(Failure::of)?;
        let progress = self.results.progress();
        self.results
            .deliver(&document(&design, &made), output, &progress)
    }
}
