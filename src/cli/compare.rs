//! `tilebind compare`: designs side by side.

use std::collections::HashSet;
use std::path::PathBuf;

use clap::Args;
use tilebind::comparison::quantity::QUANTITIES;
use tilebind::comparison::{Quantity, Request, assess_all};
use tilebind::design::{Design, MagnetModel};
use tilebind::report::comparison::{Comparison, FILES};

use super::failure::tell_refuted;
use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Asked, By, Failure, input, workload};
use tilebind::request::{self, Word};

/// Compare designs: bond, traps, barriers with bounds, capture range
#[derive(Args)]
#[command(after_help = "\
Example:
  tilebind compare shapes/tab-10mm.toml shapes/tab-20mm.toml shapes/paper-tile.toml \\
      --out target/compare")]
pub struct Compare {
    /// The design files
    #[arg(required = true)]
    designs: Vec<PathBuf>,

    /// Magnet model, dipole or cuboid [default: each design's own]
    #[arg(long, value_name = "MODEL", value_parser = By(request::model()),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Rank by selectivity, bond_depth, unbinding, captured, robust, ...; largest first
    #[arg(long, value_name = "WHAT", default_value = "selectivity", value_parser = By(quantity()),
          hide_possible_values = true)]
    by: &'static Quantity,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl Compare {
    pub fn run(self) -> Result<(), Failure> {
        let designs = self.load()?;
        let inputs = self.designs.iter().zip(&designs);
        let inputs = inputs.flat_map(|(path, design)| input::files_of(path, design));
        let output = self.results.output(&FILES, inputs.collect())?;
        let request = Request {
            thoroughness: self.request.thoroughness.of(&designs),
            ..self.request.0
        };
        request
            .thoroughness
            .check_ranking(self.by)
            .map_err(Failure::usage)?;
        let analysis = request.thoroughness.analysis(request.seed);
        workload::tell_memory(analysis.check_memory())?;
        self.threads.use_threads()?;
        designs
            .iter()
            .for_each(|design| workload::tell_of(design, &analysis));

        let progress = self.results.progress();
        let assessments = assess_all(&designs, &request, &progress);
        let comparison = Comparison::new(&assessments, self.by, request.thoroughness);
        self.results
            .deliver(&comparison.document(), output, &progress)?;
        let named = assessments.iter().map(|one| (one.name.clone(), one));
        tell_refuted(&named.collect::<Vec<_>>())
    }

    /// The designs; those with the same name and model are distinguished by their files.
    fn load(&self) -> Result<Vec<Design>, Failure> {
        let mut designs = Vec::new();
        for path in &self.designs {
            designs.push(input::load_as(path, self.model)?);
        }
        let mut seen = HashSet::new();
        let repeated: HashSet<String> = designs
            .iter()
            .filter(|design| !seen.insert((design.name.clone(), design.interaction.model.name())))
            .map(|design| design.name.clone())
            .collect();
        for (design, path) in designs.iter_mut().zip(&self.designs) {
            if repeated.contains(&design.name) {
                design.name = format!("{} ({})", design.name, path.display());
            }
        }
        Ok(designs)
    }
}

/// A figure by its name in the tables.
fn quantity() -> Word<&'static Quantity> {
    let names: Vec<_> = QUANTITIES.iter().map(|one| (one.key, one)).collect();
    let known: Vec<_> = QUANTITIES.iter().map(|one| one.key).collect();
    Word::new(&names, format!("known: {}", known.join(", ")))
}
