//! The request of an assessment.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::Quantity;
use crate::design::Design;
use crate::pipeline::{self, Certify, Check, Survey};
use crate::request::{self, Misused, of_keywords, options};
use crate::tolerance::{MakingErrors, NO_ERRORS};
use physics::landscape::Claims;

const DYNAMICS: &str = "\
Check the barriers of bond and deepest trap with RUNS trajectories each [default: 1000]

1000 trajectories take one core-second, up to five for curved shapes. If a trajectory contradicts a \
barrier, all results are still written and the exit status is 1.";

options! {
    /// The effort spent on a design: everything that determines an assessment besides the design and
    /// the seed.
    ///
    /// Work is counted, so that results are the same on every machine.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Thoroughness {
        /// How thoroughly landscapes are surveyed.
        #[serde(flatten)]
        pub survey: Survey = group(),

        /// Target width (J) of the certified bounds [default: 1/100 of the bond, or less]
        ///
        /// The default is 1/100 of the bond's depth or 1/20 of the barrier, whichever is smaller.
        #[serde(rename = "tolerance_J")]
        pub tolerance: Option<f64> = value("E_J", request::energy).alias("tolerance_J"),

        /// Most cells for the bounds of one barrier; 0: no bounds [default: 200000]
        ///
        /// The default is 0 for very many magnets.
        pub certify_cells: Option<usize> = value("N", request::count_or_none),

        /// Most cells for the search for missed states; 0: no search [default: 300000]
        ///
        /// The default is 0 for very many magnets.
        // For blocks one thirtieth, which takes about as long.
        pub complete_cells: Option<usize> = value("N", request::count_or_none),

        /// Whether moving tiles check the barriers.
        #[serde(flatten)]
        pub check: Check = group().helped("dynamics", DYNAMICS),

        /// The errors of making, for the share of pairs that work with them.
        #[serde(flatten)]
        pub making: MakingErrors = group(),
    }
}

options! {
    /// The options of assessments, with the seed.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// How much work a design is worth.
        pub thoroughness: Thoroughness = group(),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(pipeline::Request::default().seed),
    }
}

impl Thoroughness {
    /// With all defaults filled in, the same for all designs: see [`pipeline::Request::usual`].
    #[must_use]
    pub fn of<'a>(&self, designs: impl IntoIterator<Item = &'a Design>) -> Self {
        let usual = pipeline::Request::usual(designs);
        // Very many magnets are not proved.
        let cells = |cells: usize| if usual.has_proofs() { cells } else { 0 };
        Self {
            survey: self.survey.of(&usual),
            certify_cells: self.certify_cells.or(Some(cells(200_000))),
            complete_cells: self.complete_cells.or(Some(cells(300_000))),
            ..self.clone()
        }
    }

    /// Checks that what designs are ranked by is computed.
    ///
    /// # Errors
    /// If it needs errors of making, and none is stated.
    pub fn check_ranking(&self, by: &Quantity) -> Result<(), Misused> {
        match by.is_asked_for && !self.making.is_stated() {
            false => Ok(()),
            true => Err(Misused::Wrong(format!(
                "{} cannot be computed: {NO_ERRORS}",
                by.key
            ))),
        }
    }

    /// Checks the limits of the command line, since the request may come from a file.
    ///
    /// # Errors
    /// If a setting is outside its limits.
    pub fn check(&self) -> Result<(), Misused> {
        let Value::Object(settings) = json!(self) else {
            return Ok(());
        };
        let given = settings.into_iter().filter(|(_, value)| !value.is_null());
        // Keys that are not the options' names are aliases of theirs.
        let given = given.map(|(key, value)| (key, vec![value.to_string()]));
        of_keywords::<Self>(given).map(drop)
    }

    /// The request of an analysis.
    pub fn analysis(&self, seed: u64) -> pipeline::Request {
        // Cells are the only limit.
        let work = |cells: usize| if cells == 0 { 0.0 } else { f64::INFINITY };
        let [certify_cells, complete_cells] =
            [self.certify_cells, self.complete_cells].map(Option::unwrap_or_default);
        pipeline::Request {
            survey: self.survey.clone(),
            check: self.check,
            tolerance: self.tolerance,
            certify: Certify::of(work(certify_cells)),
            certify_cells,
            complete_work: Some(work(complete_cells)),
            complete_cells,
            seed,
            claims: Claims::BondAndDeepestTrap,
            ..pipeline::Request::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_of_a_file_are_named_as_options() {
        let wrong = [
            ("kinds = 0: ", r#""most_kinds": 0"#),
            ("tolerance = 0.0: ", r#""tolerance_J": 0.0"#),
            ("place = 1.0: ", r#""place_m": 1.0"#),
            ("turn = 3.0: ", r#""turn_rad": 3.0"#),
            ("gap = 1.0: ", r#""gap_m": 1.0"#),
            ("selectivity = 0.0: ", r#""least_selectivity": 0.0"#),
            ("settled = 2.0: ", r#""settled": 2.0"#),
        ];
        for (told, setting) in wrong {
            let mut settings = json!(Thoroughness::default());
            let given: Value = serde_json::from_str(&format!("{{{setting}}}")).unwrap();
            for (key, value) in given.as_object().unwrap() {
                settings[key] = value.clone();
            }
            let settings: Thoroughness = serde_json::from_value(settings).unwrap();
            let error = settings.check().unwrap_err().to_string();
            assert!(error.starts_with(told), "{error}");
        }
        Thoroughness::default().check().unwrap();
    }
}
