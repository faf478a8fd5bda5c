//! Points that are added where the figures of a sweep bend.

use std::path::Path;

use tilebind::output::Output;
use tilebind::sweep::{self, Axis, Outcome, Plan, Shard, Store};

use super::{Sweep, begin};
use crate::cli::{Failure, tell};

/// Rounds in which points are added.
const ROUNDS: usize = 3;

impl Sweep {
    /// Refuses to refine what is not a curve over one number.
    pub(super) fn check_refinement(&self, plan: &Plan) -> Result<(), Failure> {
        let numbers = plan.axes.iter().filter_map(Axis::numbers);
        let varied: Vec<usize> = numbers.map(|n| n.len()).filter(|&n| n > 1).collect();
        match (self.refine, &varied[..]) {
            (None, _) => Ok(()),
            (Some(_), [count]) if *count > 2 => Ok(()),
            _ => Err(Failure::Usage(
                "--refine adds points to one varied number of three values or more\n  help: vary one \
                 number, such as --vary fixed.faces.east.profile.depth=0:0.04:5"
                    .to_owned(),
            )),
        }
    }

    /// Works on points where the figures bend, in rounds that each look at what is known by then.
    pub(super) fn refine(
        &self,
        mut plan: Plan,
        folder: &Path,
        manifest: &Output,
    ) -> Result<Plan, Failure> {
        let store = Store::new(folder);
        let asked = self.refine.unwrap_or(0);
        let mut left = asked;
        while left > 0 {
            let points = plan.points();
            let outcomes: Vec<Outcome> = points.iter().filter_map(|p| store.load(p)).collect();
            // A third at a time: enough to see what the first ones show.
            let round = asked.div_ceil(ROUNDS).min(left);
            let finer = (outcomes.len() == points.len())
                .then(|| sweep::refined(&plan, &outcomes, round))
                .flatten();
            let Some(finer) = finer else { break };
            let added = |plan: &Plan| {
                plan.axes
                    .iter()
                    .map(|axis| axis.values.len())
                    .sum::<usize>()
            };
            left -= added(&finer) - added(&plan);
            plan = finer;
            begin(&plan, manifest, folder)?;
            self.work(&plan, folder, Shard::WHOLE)?;
        }
        if left > 0 && !self.print.quiet {
            tell(format!(
                "{} of {asked} points added: nothing else bends by a twentieth",
                asked - left
            ));
        }
        Ok(plan)
    }
}
