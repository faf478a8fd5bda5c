//! The manifest of a search: all its inputs.

use serde::{Deserialize, Serialize};

use super::aim::Aim;
use crate::comparison::{Request, Thoroughness};
use crate::design::Design;
use crate::sweep::{Axis, DesignSource, Plan, PlanError};

/// The manifest of a search: all its inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Search {
    /// What is sought.
    #[serde(rename = "search")]
    pub aim: Aim,
    /// The designs, keys and settings.
    #[serde(flatten)]
    pub plan: Plan,
}

/// How thoroughly a point is analysed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// States, captures, and the paths that bound barriers from above.
    States,
    /// All that the settings ask for.
    Proofs,
}

impl Search {
    /// A search over designs.
    ///
    /// # Errors
    /// As [`Plan::of`]; whether any point is possible is found out by the search.
    pub fn of(
        designs: Vec<DesignSource>,
        axes: Vec<Axis>,
        settings: Thoroughness,
        seed: u64,
        aim: Aim,
    ) -> Result<Self, PlanError> {
        let plan = Plan::between(designs, axes, settings, seed)?;
        Ok(Self { aim, plan })
    }

    /// A search over designs with the settings of assessments.
    ///
    /// # Errors
    /// As [`Search::of`], and if errors of making are needed and none is stated.
    pub fn asked(
        request: &Request,
        designs: Vec<(DesignSource, Design)>,
        axes: Vec<Axis>,
        aim: Aim,
    ) -> Result<Self, PlanError> {
        let sought = aim.objectives.iter().map(|it| it.quantity());
        for quantity in sought.chain(aim.subject.iter().map(|it| it.quantity())) {
            request.thoroughness.check_ranking(quantity)?;
        }
        let (sources, designs): (Vec<DesignSource>, Vec<Design>) = designs.into_iter().unzip();
        let settings = request.thoroughness.of(&designs);
        Self::of(sources, axes, settings, request.seed, aim)
    }

    /// The manifest's text.
    pub fn to_text(&self) -> String {
        // Plain values with string keys can always be serialised.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Reads a manifest; `None` if it is that of a sweep.
    ///
    /// # Errors
    /// If the text is not a manifest, or is from another version.
    pub fn parse(text: &str) -> Result<Option<Self>, PlanError> {
        let malformed = |error: serde_json::Error| PlanError::Malformed(error.to_string());
        let value: serde_json::Value = serde_json::from_str(text).map_err(malformed)?;
        if value.get("search").is_none() {
            return Ok(None);
        }
        let search: Self = serde_json::from_value(value).map_err(malformed)?;
        search.plan.check_version()?;
        search.plan.check()?;
        search.aim.check().map_err(PlanError::Malformed)?;
        Ok(Some(search))
    }

    /// The plan of a stage. A single cell costs nothing, and with it the best path found bounds a
    /// barrier from above, proved.
    pub fn stage(&self, stage: Stage) -> Plan {
        let mut plan = self.plan.clone();
        if stage == Stage::States {
            let settings = &mut plan.settings;
            settings.certify_cells = settings.certify_cells.map(|cells| cells.min(1));
            settings.complete_cells = Some(0);
            settings.check.dynamics_runs = 0;
        }
        plan
    }

    /// The largest number of analyses with proofs.
    pub fn most_proofs(&self) -> usize {
        let share = match self.aim.objectives.len() {
            1 => 10,
            _ => 5,
        };
        self.aim.points.div_ceil(share).max(3)
    }
}
