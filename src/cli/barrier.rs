//! `tilebind barrier`.

use std::path::PathBuf;

use clap::Args;
use tilebind::Configuration;

use super::{Failure, input};

/// Print the barrier between two poses, as JSON
#[derive(Args)]
pub struct Barrier {
    /// The design file
    design: PathBuf,

    /// Pose at which the way starts (m, m, rad)
    #[arg(long, value_name = "X,Y,THETA", allow_hyphen_values = true, value_parser = input::pose)]
    from: Configuration,
}

impl Barrier {
    pub fn run(self) -> Result<(), Failure> {
        let _ = (self.design, self.from);
        Ok(())
    }
}
