//! The request of a sweep.

use super::error::PlanError;
use super::plan::Plan;
use super::refine::refined;
use super::source::DesignSource;
use super::store::Outcome;
use super::vary::Axis;
use crate::comparison;
use crate::design::Design;
use crate::request::{self, options};

/// Number of rounds in which points are added.
const ROUNDS: usize = 3;

options! {
    /// The options of a sweep, besides the designs and the varied keys.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// Add N points where the curves bend most (one varied number)
        pub refine: Option<usize> = value("N", request::count),

        /// Point to compare all points with: varied values (depth=0) or a design's name
        pub baseline: Option<String> = value("POINT", |text: &str| Ok(text.to_owned())),

        /// The options of the assessments.
        pub assessments: comparison::Request = group(),
    }
}

impl Request {
    /// Plans the sweep over designs.
    ///
    /// # Errors
    /// As [`Plan::of`] and [`Plan::against`], and if points are to be added to a sweep that is not
    /// a curve over one number.
    pub fn plan(
        &self,
        designs: Vec<(DesignSource, Design)>,
        axes: Vec<Axis>,
    ) -> Result<Plan, PlanError> {
        let (sources, designs): (Vec<DesignSource>, Vec<Design>) = designs.into_iter().unzip();
        let settings = self.assessments.thoroughness.of(&designs);
        let mut plan = Plan::of(sources, axes, settings, self.assessments.seed)?;
        if let Some(point) = &self.baseline {
            plan = plan.against(point)?;
        }
        let numbers = plan.axes.iter().filter_map(Axis::numbers);
        let varied: Vec<usize> = numbers.map(|n| n.len()).filter(|&n| n > 1).collect();
        match (self.refine, &varied[..]) {
            (Some(_), [(..=2)] | [] | [_, _, ..]) => Err(PlanError::NoCurve),
            _ => Ok(plan),
        }
    }

    /// Computes points where the figures bend, in rounds that each use all results so far. Returns
    /// how many of the requested points were not added because nothing else bends.
    ///
    /// # Errors
    /// The first error of `work`, which computes all points of a plan.
    pub fn refined<E>(
        &self,
        mut plan: Plan,
        known: impl Fn(&Plan) -> Option<Vec<Outcome>>,
        mut work: impl FnMut(&Plan) -> Result<(), E>,
    ) -> Result<(Plan, usize), E> {
        let asked = self.refine.unwrap_or(0);
        let mut left = asked;
        let count = |plan: &Plan| {
            plan.axes
                .iter()
                .map(|axis| axis.values.len())
                .sum::<usize>()
        };
        while left > 0 {
            // A third at a time, so that later points use the results of earlier ones.
            let round = asked.div_ceil(ROUNDS).min(left);
            let finer = known(&plan).and_then(|outcomes| refined(&plan, &outcomes, round));
            let Some(finer) = finer else { break };
            left -= count(&finer) - count(&plan);
            plan = finer;
            work(&plan)?;
        }
        Ok((plan, left))
    }
}
