//! `tilebind energy`.

use std::path::PathBuf;

use clap::Args;
use tilebind::Configuration;
use tilebind::query::poses::{self, Felt};
use tilebind::report::energies::{FILES, document};
use tilebind::request;

use super::options::DesignOptions;
use super::results::NumberOptions;
use super::{Failure, input};

/// Print energy, force, torque and clearance at given poses, as JSON
#[derive(Args)]
#[command(after_help = "\
Examples:
  tilebind energy shapes/paper-tile.toml --pose 0.43,0,0 --pose 0.43,-0.04,0
  tilebind energy shapes/paper-tile.toml --pose \"43 cm,-4 cm,30 deg\" --text
  tilebind energy shapes/paper-tile.toml --poses results/pathways/0-free.csv")]
pub struct Energy {
    #[command(flatten)]
    design: DesignOptions,

    /// Pose of the moving tile in the fixed tile's frame (m, m, rad); repeatable
    #[arg(
        long = "pose",
        value_name = "X,Y,THETA",
        required_unless_present = "file",
        allow_hyphen_values = true,
        value_parser = request::pose
    )]
    poses: Vec<Configuration>,

    /// CSV file with one pose per line: columns x, y and theta; others are ignored
    #[arg(long = "poses", value_name = "FILE.csv")]
    file: Option<PathBuf>,

    #[command(flatten)]
    results: NumberOptions,
}

/// Largest number of poses checked for a wrong unit.
const MOST_DOUBTED: usize = 3;

impl Energy {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let inputs = self.design.inputs(&design).into_iter();
        let inputs = inputs.chain(self.file.clone()).collect();
        let output = self.results.folder.output(&FILES, inputs)?;
        let mut poses = self.poses;
        if let Some(file) = &self.file {
            poses.extend(input::table(file, poses::read)?);
        }
        for pose in poses.iter().take(MOST_DOUBTED) {
            input::doubt_pose(&design, pose);
        }
        let problem = design.problem();
        let found: Vec<Felt> = poses.iter().map(|q| Felt::new(&problem, q)).collect();
        self.results.deliver(&document(&design, &found), output)
    }
}
