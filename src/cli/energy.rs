//! `tilebind energy`.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use tilebind::design::Design;
use tilebind::query::poses;
use tilebind::report::json;
use tilebind::request;
use tilebind::{Configuration, Problem};

use super::options::DesignOptions;
use super::{Failure, input, print};

/// Print energy, force, torque and clearance at given poses, as JSON
#[derive(Args)]
#[command(after_help = "\
Examples:
  tilebind energy shapes/paper-tile.toml --pose 0.43,0,0 --pose 0.43,-0.04,0
  tilebind energy shapes/paper-tile.toml --pose \"43 cm,-4 cm,30 deg\"
  tilebind energy shapes/paper-tile.toml --poses results/pathways/0-free.csv")]
pub struct Energy {
    #[command(flatten)]
    design: DesignOptions,

    /// Pose of the moving tile in the fixed tile's frame (m, m, rad); may be repeated
    #[arg(
        long = "pose",
        value_name = "X,Y,THETA",
        required_unless_present = "file",
        allow_hyphen_values = true,
        value_parser = request::pose
    )]
    poses: Vec<Configuration>,

    /// CSV file of poses, one a line: columns x, y and theta (others are passed over)
    #[arg(long = "poses", value_name = "FILE.csv")]
    file: Option<PathBuf>,
}

/// Most poses that are looked at for another unit.
const MOST_DOUBTED: usize = 3;

/// What is known of a pose.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Entry {
    pose: [f64; 3],
    energy_J: f64,
    /// On the moving tile.
    force_N: [f64; 2],
    /// On the moving tile, about its reference point.
    torque_Nm: f64,
    /// Negative where the tiles overlap.
    clearance_m: f64,
    free: bool,
    /// How magnets are modelled.
    model: &'static str,
}

impl Energy {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let mut poses = self.poses;
        if let Some(file) = &self.file {
            poses.extend(read(file)?);
        }
        for pose in poses.iter().take(MOST_DOUBTED) {
            input::doubt_pose(&design, pose);
        }
        let problem = design.problem();
        let entries: Vec<Entry> = poses.iter().map(|q| entry(&problem, &design, q)).collect();
        print(&json::text(&entries))
    }
}

/// The poses of a file.
fn read(file: &Path) -> Result<Vec<Configuration>, Failure> {
    let wrong = |error: &dyn Display| Failure::Usage(format!("{}: {error}", file.display()));
    let text = input::text(file).map_err(|error| wrong(&error))?;
    poses::read(&text).map_err(|error| wrong(&error))
}

fn entry(problem: &Problem, design: &Design, q: &Configuration) -> Entry {
    let (energy, gradient) = problem.energy_and_gradient(q);
    let free = problem.is_clear(q);
    let clearance = problem.clearance(q);
    let [fx, fy, torque] = [-gradient.x, -gradient.y, -gradient.z].map(json::positive_zero);
    Entry {
        pose: q.to_array().map(json::positive_zero),
        energy_J: json::positive_zero(energy),
        force_N: [fx, fy],
        torque_Nm: torque,
        // Tiles that touch may overlap by a rounding error.
        clearance_m: json::positive_zero(if free { clearance.max(0.0) } else { clearance }),
        free,
        model: design.interaction.model.name(),
    }
}
