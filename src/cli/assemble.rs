//! `tilebind assemble`.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::assembly::Request;
use tilebind::report::assembly::{FILES, document};

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Asked, Failure, input};

/// Realise a tile set with magnets: one barcode per glue, and input files for xgrow and rgrow
#[derive(Args)]
#[command(after_help = EXAMPLES, after_long_help = format!("{NOTES}\n\n{EXAMPLES}"))]
pub struct Assemble {
    /// Tile set: a file (rgrow or xgrow), or lattice, homogeneous or square
    #[arg(value_name = "TILESET", required_unless_present = "lattice")]
    tileset: Option<PathBuf>,

    /// Design whose target face gives magnets, pitch and side [default: the paper's magnets]
    ///
    /// By default the face is as long as the words need.
    design: Option<PathBuf>,

    /// Use these words instead of searching: a file written by `tilebind words --out`
    #[arg(long, value_name = "SET.toml")]
    words: Option<PathBuf>,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

const NOTES: &str = "\
TILESET is a file for rgrow (YAML or JSON) or xgrow (.tiles), or one of three built-in sets:
  lattice      every tile has its own place; size from --lattice
  homogeneous  all tiles are the same; size from --lattice
  square       a counted square; size from --side

Every glue becomes a word on each axis that uses it. A bond of half the strength has half the magnets.
Words come from --words or from a search. The search finds the widest gap on a face of --length
positions, or with --gap the shortest face that carries enough words.

Without --kt the tiles are laid by hand: words, sheet and designs for one of each tile, or for the
shares of the file if these are whole numbers. With --words the letters and orientations of the file
stay, and with a DESIGN its side.

With --kt growth is simulated, too, and the command writes assembly.yaml (rgrow) and assembly.tiles
(xgrow) with all energies, including those of aligned mismatches. It always writes a design for every
two tiles that can meet, the workshop sheet, and the slid contacts, which the engines ignore.";

const EXAMPLES: &str = "\
Examples:
  tilebind assemble shapes/assemblies/binary-counter.yaml --kt 5e-3 --coverage 0.1 --out target/counter
  tilebind assemble lattice --lattice 3x3 --kt 4e-3 --coverage 0.1 --out target/lattice
  tilebind assemble square --side 16 --kt 5e-3 --coverage 0.1 --length 16 --out target/square
  tilebind assemble shapes/assemblies/sierpinski.yaml shapes/paper-tile.toml --kt 5e-3 \\
    --coverage 0.1 --length 10 --proofread 2 --out target/proofread";

impl Assemble {
    pub fn run(self) -> Result<(), Failure> {
        let (name, design) = self.named();
        let tiles = self.request.tile_set(name)?;
        let design = input::if_given(design)?;
        let files = design.iter().flat_map(|(_, files)| files);
        let named = [&self.tileset, &self.design, &self.words];
        let inputs = named.into_iter().flatten().chain(files).cloned();
        let output = self.results.output(&FILES, inputs.collect())?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let words = input::words(self.words.as_deref(), self.request.model)?;
        let design = design.as_ref().map(|it| &it.0);
        let assembly = self.request.build(&tiles, words, design, &progress)?;
        self.results
            .deliver(&document(&assembly), output, &progress)
    }

    /// The tile set and the design; with a lattice the first file can be the design.
    fn named(&self) -> (&Path, Option<&Path>) {
        let lattice = Path::new("lattice");
        let is_design = |path: &&Path| path.extension().is_some_and(|it| it == "toml");
        match (self.tileset.as_deref(), self.design.as_deref()) {
            (Some(first), None) if self.request.lattice.is_some() && is_design(&first) => {
                (lattice, Some(first))
            }
            (name, design) => (name.unwrap_or(lattice), design),
        }
    }
}
