//! Gauss rules for panels.

use crate::potential::cuboid::quadrature::{self, FOUR_EIGHT_SIXTEEN, RULES};

/// Panels use a Gauss rule of 4, 8 or 16 nodes beyond these distances, in half widths of the panel:
/// the error is about 1e-7 of the integrand's bound.
const FROM: [f64; 3] = [4.9, 1.6, 0.7];

/// A Gauss rule.
#[derive(Clone, Copy)]
pub(super) struct Rule(&'static quadrature::Rule);

impl Rule {
    /// The rule for a panel that is this many half widths from the singularity of its integrand.
    pub(super) fn at(ratio: f64) -> Option<Self> {
        let which = FROM.iter().position(|least| ratio >= *least);
        which.map(|which| Self(&RULES[FOUR_EIGHT_SIXTEEN[which]]))
    }

    /// Places between -1 and 1, and weights.
    pub(super) fn nodes(self) -> impl Iterator<Item = (f64, f64)> {
        let Self(quadrature::Rule {
            count,
            nodes,
            weights,
        }) = self;
        nodes
            .iter()
            .copied()
            .zip(weights.iter().copied())
            .take(*count)
    }

    /// The error of an average by the rule, in units of the integrand's bound on an ellipse about
    /// the panel whose short half axis is this many half widths of the panel.
    pub(super) fn error(self, short: f64) -> f64 {
        let rho = short + (1.0 + short * short).sqrt();
        let power = rho.powi(-2 * self.0.count as i32);
        64.0 / 15.0 * power / (1.0 - 1.0 / (rho * rho)) / 2.0
    }
}
