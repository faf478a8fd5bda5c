//! `tilebind assemble`.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::assembly::{
    Assembly, Built, TileSet, Wiring, WordSearch, lattice, proofread, square,
};
use tilebind::design::{Design, MagnetModel, WordSet};
use tilebind::kinetics::bond::Shaking;
use tilebind::report::assembly::document;
use tilebind::report::files::ASSEMBLE;
use tilebind::request;
use tilebind::words::{Rules, Shape};

use super::options::WorkOptions;
use super::results::ResultOptions;
use super::words::values;
use super::{Failure, input, interrupt};

/// Build a tile set of magnets: a word for every glue, and files for the engines of tile assembly
#[derive(Args)]
#[command(after_help = "\
TILESET is a file of rgrow (YAML or JSON) or xgrow (.tiles), or one of lattice (every tile its own
place, with --lattice), homogeneous (all the same tile, with --lattice) and square (counted, with
--side). Every glue becomes a word on each axis it is used on; a bond of half the strength has half
the magnets. Words come from --words, or are searched: on a face of --length places with the widest
gap, or with --gap on the shortest face that carries them. Written are assembly.yaml (rgrow) and
assembly.tiles (xgrow) with all energies, aligned mismatches included, a design of every two tiles
that meet, the sheet for the workshop, and what engines leave out: faces that hold slid.

Examples:
  tilebind assemble shapes/assemblies/binary-counter.yaml --kt 5e-3 --coverage 0.1 --out target/counter
  tilebind assemble lattice --lattice 3x3 --kt 4e-3 --coverage 0.1 --out target/lattice
  tilebind assemble square --side 16 --kt 5e-3 --coverage 0.1 --length 16 --out target/square
  tilebind assemble shapes/assemblies/sierpinski.yaml shapes/paper-tile.toml --kt 5e-3 \\
    --coverage 0.1 --length 10 --proofread 2 --out target/proofread")]
pub struct Assemble {
    /// The tile set: a file, or lattice, homogeneous or square
    #[arg(value_name = "TILESET", required_unless_present = "lattice")]
    tileset: Option<PathBuf>,

    /// The design file from whose target face magnets, pitch and side are taken [default: the
    /// paper's magnets, on a face as long as the words]
    design: Option<PathBuf>,

    /// Effective energy kT of the shaking (J)
    #[arg(long, value_name = "E", value_parser = request::shaking)]
    kt: f64,

    /// Share of the table that loose tiles cover, all kinds together
    #[arg(long, value_name = "F", value_parser = share)]
    coverage: f64,

    /// Words to take, in place of a search: a set as `tilebind words --out` writes it
    #[arg(long, value_name = "SET.toml")]
    words: Option<PathBuf>,

    /// Rows and columns of a lattice
    #[arg(long, value_name = "MxN", value_parser = rows_and_columns)]
    lattice: Option<[usize; 2]>,

    /// Side of a counted square (tiles)
    #[arg(long, value_name = "N", value_parser = request::count)]
    side: Option<usize>,

    /// Blocks of K x K tiles in place of tiles, against errors
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = request::whole(1, 6))]
    proofread: u16,

    /// Places of a face [default: the fewest that carry the words]
    #[arg(long, value_name = "L", value_parser = request::count)]
    length: Option<usize>,

    /// Magnets of the strongest bonds' words, where spacing is code too [default: one a place]
    #[arg(long, value_name = "K", value_parser = request::count)]
    magnets: Option<usize>,

    /// Least gap of the words, from 0 to 1 [default: 0.5; with --length the widest there is]
    #[arg(long, value_name = "G", value_parser = values::gap)]
    gap: Option<f64>,

    /// Complementary shapes of the faces: none; shared, one that any two have and that forbids
    /// slides; polar, knobs on words and slots on mates. Designs are written flat all the same
    #[arg(long, value_name = "KIND", default_value = "none", value_parser = values::shape(),
          hide_possible_values = true)]
    shape: Shape,

    /// From place to place (m) [default: the design's, or 0.04]
    #[arg(long, value_name = "M", value_parser = request::length)]
    pitch: Option<f64>,

    /// Model of the magnets, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = input::model(), hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Work to spend on words, as what takes about so many seconds of a core; it is counted, so
    /// that the same work gives the same words everywhere
    #[arg(long, value_name = "S", default_value_t = 20.0, value_parser = request::positive)]
    seconds: f64,

    #[command(flatten)]
    work: WorkOptions,

    #[command(flatten)]
    results: ResultOptions,
}

/// Tiles cannot cover more than the table.
fn share(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|share: &f64| *share > 0.0 && *share < 1.0)
        .ok_or_else(|| "a share of the table lies between 0 and 1, such as 0.1".to_owned())
}

fn rows_and_columns(text: &str) -> Result<[usize; 2], String> {
    let parts = text.split_once(['x', 'X']).and_then(|(rows, columns)| {
        Some([
            rows.trim().parse::<usize>().ok()?,
            columns.trim().parse::<usize>().ok()?,
        ])
    });
    let most = lattice::MOST_TILES;
    let fits = |[rows, columns]: &[usize; 2]| {
        let tiles = rows.checked_mul(*columns);
        tiles.is_some_and(|tiles| (2..=most).contains(&tiles))
    };
    parts
        .filter(fits)
        .ok_or_else(|| format!("a lattice is ROWSxCOLUMNS, such as 3x3, of 2 to {most} tiles"))
}

impl Assemble {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let (tiles, design) = self.read()?;
        let set = proofread::blocks(&tiles, usize::from(self.proofread));
        let wiring = Wiring::new(&set).map_err(|error| Failure::Usage(error.to_string()))?;
        let inputs = self.inputs(design.as_ref());
        let output = self.results.output(&ASSEMBLE, inputs)?;
        self.work.use_threads()?;
        let progress = self.results.progress();
        let (text, tried) = match &self.words {
            Some(_) => (String::new(), Vec::new()),
            None => self
                .search()
                .run(&wiring, design.as_ref())
                .map_err(Failure::Usage)?,
        };
        let words = match &self.words {
            Some(path) => WordSet::load(path, self.model)?,
            None => WordSet::parse(&text, "the words found", self.model)?,
        };
        let shaking = Shaking {
            kt: self.kt,
            coverage: self.coverage,
        };
        let built =
            Built::new(&set, &words, shaking).map_err(|error| Failure::Usage(error.to_string()))?;
        let assembly = Assembly {
            words_toml: match &self.words {
                Some(path) => input::text(path).map_err(|error| Failure::Run(error.to_string()))?,
                None => text,
            },
            built: &built,
            words: &words,
            design: design.as_ref(),
            tried,
            lattice: self.lattice,
            rules: self.rules(),
            proofread: self.proofread.into(),
            seed: self.work.seed,
        };
        self.results
            .deliver(&document(&assembly), output, &progress)
    }

    /// The files that are read.
    fn inputs(&self, design: Option<&Design>) -> Vec<PathBuf> {
        let named = [&self.tileset, &self.design, &self.words];
        let named = named.into_iter().flatten().cloned();
        let path = self.design.as_ref().or(self.tileset.as_ref());
        let design = path
            .zip(design)
            .map(|(path, design)| input::files_of(path, design));
        named.chain(design.into_iter().flatten()).collect()
    }

    fn search(&self) -> WordSearch {
        WordSearch {
            pitch: self.pitch,
            model: self.model,
            length: self.length,
            magnets: self.magnets,
            gap: self.gap,
            rules: self.rules(),
            seed: self.work.seed,
            seconds: self.seconds,
        }
    }

    fn rules(&self) -> Rules {
        Rules {
            shape: self.shape,
            ..Rules::default()
        }
    }

    /// The tile set, and the design if there is one.
    fn read(&self) -> Result<(TileSet, Option<Design>), Failure> {
        let wrong = |message: &str| Err(Failure::Usage(message.to_owned()));
        let mut design = self.design.as_deref();
        let mut name = self.tileset.as_deref();
        // With a lattice the first file may be the design.
        let is_design = |path: &Path| path.extension().is_some_and(|it| it == "toml");
        if let (Some(_), Some(first), None) = (self.lattice, name, design)
            && is_design(first)
        {
            (name, design) = (None, Some(first));
        }
        let name = name.and_then(Path::to_str).unwrap_or("lattice");
        let set = match (name, self.lattice, self.side) {
            ("lattice", Some([rows, columns]), None) => lattice::unique(rows, columns),
            ("homogeneous", Some([rows, columns]), None) => lattice::homogeneous(rows, columns),
            ("lattice" | "homogeneous", None, _) => {
                return wrong("say how large the lattice is: --lattice 3x3");
            }
            ("square", None, Some(side)) => {
                let [least, most] = square::SIDES;
                if !(least..=most).contains(&side) {
                    let message = format!("a counted square has a side of {least} to {most} tiles");
                    return Err(Failure::Usage(message));
                }
                square::counted(side)
            }
            ("square", ..) => return wrong("say how large the square is: --side 16"),
            (_, Some(_), _) => {
                return wrong(
                    "--lattice makes a tile set of its own: write lattice or homogeneous in place \
                     of a file",
                );
            }
            (_, _, Some(_)) => return wrong("--side goes with square"),
            (file, None, None) => TileSet::load(Path::new(file))?,
        };
        let design = design
            .map(|path| input::load_as(path, self.model))
            .transpose()?;
        Ok((set, design))
    }
}
