//! The request of the crosstalk of a set of words.

use crate::Refused;
use crate::design::{MagnetModel, WordSet};
use crate::request::{self, options};
use physics::observer::Observer;
use physics::units::si;
use physics::words::crosstalk::{Crosstalk, Proof, TOLERANCE};

options! {
    /// The options of the attraction of every two words over all poses.
    #[derive(Clone, Debug)]
    pub struct CrosstalkRequest {
        /// Prove that no attraction is stronger, to within E_J [default: 1/4 of a contact]
        pub certify: Option<Option<f64>> = value("E_J", request::energy).or_alone(),

        /// Most cells for the proof
        pub certify_cells: usize = value("N", request::count).alias("cells").or(8_000_000),

        /// Magnet model, dipole or cuboid [default: the set's]
        pub model: Option<MagnetModel> = value("MODEL", request::model()),
    }
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
