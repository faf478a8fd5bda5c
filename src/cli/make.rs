//! `tilebind make`.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::Args;
use tilebind::assembly;
use tilebind::design::Design;
use tilebind::output::Output;
use tilebind::report::workshop::{FILES, document};
use tilebind::request::Options;
use tilebind::workshop::{Made, Request, Subject};

use super::options::ThreadOption;

use super::results::ResultOptions;
use super::{Asked, Failure, input};

/// Write workshop files for tiles: DXF and SVG to scale, and a magnet sheet
#[derive(Args)]
#[command(
    mut_arg("out", |out| out.required(true).help("Folder for the files, created if missing")),
    after_help = "\
The command writes fixed.dxf, fixed.svg, moving.dxf and moving.svg (outlines with pockets and marks, in
mm), check.svg (to print at full size and lay the glued tiles on) and sheet.md: which magnets to buy,
which pole goes where, and in which order to insert them. Layers of the drawings, in the order of work:
ENGRAVE, CUT_INSIDE, CUT_OUTSIDE. A pocket without a wall to the rim becomes a notch of the outline.
Equal tiles are one kind: tile.dxf and tile.svg.

With several designs, or with a tile set and perhaps a design for its magnets (see `tilebind help
assemble`), each kind of tile has its files in tiles/.

With --copies, --count or --sheet all parts are also nested on sheets: nested-1.dxf, nested-1.svg and so
on. With --layers there is also a part for each layer, such as fixed-layer-1.dxf, and glue-up.svg.

Examples:
  tilebind make shapes/tab-20mm.toml --out workshop
  tilebind make my.toml --out workshop --kerf \"0.15 mm\" --clearance \"0.1 mm\"
  tilebind make my.toml --out workshop --copies 6 --sheet \"600x400 mm\" --layers \"4 mm,4 mm\"
  tilebind make puzzle.yaml my.toml --words results/words.toml --sheet \"600x400 mm\" --out workshop")]
pub struct Make {
    /// The design files, or a tile set (.yaml, .json, .tiles) and perhaps a design
    #[arg(value_name = "DESIGN", required = true)]
    designs: Vec<PathBuf>,

    /// Words of the tile set: a file written by `tilebind words` or `assemble` [default: searched]
    #[arg(long, value_name = "SET.toml")]
    words: Option<PathBuf>,

    #[command(flatten)]
    making: Asked<Request>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

/// Endings of the files of tile sets.
const TILE_SETS: [&str; 4] = ["yaml", "yml", "json", "tiles"];

impl Make {
    pub fn run(self) -> Result<(), Failure> {
        let ending = self.designs[0].extension().and_then(OsStr::to_str);
        let is_set = ending.is_some_and(|it| TILE_SETS.contains(&&*it.to_ascii_lowercase()));
        if !is_set && self.words.is_some() {
            return Err(Failure::usage(
                "--words is for a tile set: name its file first",
            ));
        }
        if is_set { self.set() } else { self.designs() }
    }

    fn designs(self) -> Result<(), Failure> {
        let mut inputs = Vec::new();
        let mut designs = Vec::new();
        for path in &self.designs {
            let design = input::load(path)?;
            inputs.extend(input::files_of(path, &design));
            designs.push(design);
        }
        let output = self.results.output(&FILES, inputs)?;
        let subject = Subject::of_designs(&designs);
        let only = match &designs[..] {
            [only] => Some(only),
            _ => None,
        };
        self.deliver(only, &subject, output)
    }

    fn set(self) -> Result<(), Failure> {
        let (set, design) = match &self.designs[..] {
            [set] => (set, None),
            [set, design] => (set, Some(&**design)),
            _ => {
                return Err(Failure::usage(
                    "a tile set takes one design, for its magnets and side",
                ));
            }
        };
        let request = assembly::Request::with_defaults();
        let tiles = request.tile_set(set)?;
        let design = input::if_given(design)?;
        let files = design.iter().flat_map(|(_, files)| files);
        let inputs = [set].into_iter().chain(&self.words).chain(files).cloned();
        let output = self.results.output(&FILES, inputs.collect())?;
        self.threads.use_threads()?;
        let words = input::words(self.words.as_deref(), request.model)?;
        let progress = self.results.progress();
        let design = design.as_ref().map(|it| &it.0);
        let assembly = request.build(&tiles, words, design, &progress)?;
        let subject = Subject::of_set(&assembly)?;
        self.deliver(None, &subject, output)
    }

    fn deliver(
        &self,
        design: Option<&Design>,
        subject: &Subject,
        output: Option<Output>,
    ) -> Result<(), Failure> {
        let made = Made::new(subject, &self.making).map_err(Failure::of)?;
        let progress = self.results.progress();
        self.results
            .deliver(&document(design, subject, &made), output, &progress)
    }
}
