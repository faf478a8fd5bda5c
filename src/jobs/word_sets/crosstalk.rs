//! The request of the crosstalk of a set of words.

use clap::Args;

use crate::Refused;
use crate::design::{MagnetModel, WordSet};
use crate::request;
use physics::observer::Observer;
use physics::units::si;
use physics::words::crosstalk::{Crosstalk, Proof, TOLERANCE};

/// The options of the attraction of every two words over all poses.
#[derive(Clone, Debug, Args)]
pub struct CrosstalkRequest {
    /// Prove that no attraction is stronger, to within E_J [default: 1/4 of a contact]
    #[arg(long, value_name = "E_J", num_args = 0..=1, require_equals = true,
          value_parser = request::energy)]
    pub certify: Option<Option<f64>>,

    /// Most cells for the proof
    #[arg(long, alias = "cells", value_name = "N", default_value_t = 8_000_000, value_parser = request::count)]
    pub certify_cells: usize,

    /// Magnet model, dipole or cuboid [default: the set's]
    #[arg(long, value_name = "MODEL", value_parser = request::model(),
          hide_possible_values = true)]
    pub model: Option<MagnetModel>,
}

impl CrosstalkRequest {
    /// The crosstalk of a set that was read with the requested model.
    ///
    /// # Errors
    /// If bounds are requested and its magnets have none.
    pub fn crosstalk(&self, set: &WordSet, observer: &dyn Observer) -> Result<Crosstalk, Refused> {
        let stage = set.carriers();
        if self.certify.is_some()
            && let Err(why) = stage.certifiable()
        {
            return Err(format!("--certify: {why}; leave it out").into());
        }
        let certify = self.certify.map(|tolerance| {
            let tolerance = tolerance.unwrap_or_else(|| TOLERANCE * stage.contact_energy());
            (tolerance, self.certify_cells)
        });
        observer.stage("poses", 0.0);
        let proving = |proof: Proof| {
            observer.stage("proof", proof.cells as f64 / self.certify_cells as f64);
            if proof.within.is_finite() {
                let within = si(proof.within, "J", 3);
                observer.known(&format!(
                    "proved so far: no attraction is stronger than found by more than {within}"
                ));
            }
        };
        Ok(stage.crosstalk(&set.words, certify, &proving))
    }
}
