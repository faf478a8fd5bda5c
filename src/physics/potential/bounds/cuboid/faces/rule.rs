//! Gauss rules for panels.

use crate::potential::cuboid::quadrature::Rules;

/// Panels take a Gauss rule of 4, 8 or 16 nodes from these distances on, in halves of the panel's
/// width: each leaves about 1e-7 of the integrand's bound.
const RULES: [(f64, Rule); 3] = [(4.9, Rule::Four), (1.6, Rule::Eight), (0.7, Rule::Sixteen)];

/// A Gauss rule.
#[derive(Clone, Copy)]
pub(super) enum Rule {
    Four,
    Eight,
    Sixteen,
}

impl Rule {
    /// The rule for a panel that many halves of its width from what its integrand is singular at.
    pub(super) fn at(ratio: f64) -> Option<Self> {
        let rule = RULES.iter().find(|(least, _)| ratio >= *least);
        rule.map(|(_, rule)| *rule)
    }

    /// Places between -1 and 1, and weights.
    pub(super) fn nodes(self) -> (&'static [f64], &'static [f64]) {
        let rules = Rules::get();
        match self {
            Self::Four => (&rules.four[0], &rules.four[1]),
            Self::Eight => (&rules.eight[0], &rules.eight[1]),
            Self::Sixteen => (&rules.sixteen[0], &rules.sixteen[1]),
        }
    }

    /// The error of an average by the rule, in units of the integrand's bound on an ellipse about
    /// the panel whose short half axis is so many halves of the panel's width.
    pub(super) fn error(self, short: f64) -> f64 {
        let rho = short + (1.0 + short * short).sqrt();
        let power = rho.powi(-2 * self.nodes().0.len() as i32);
        64.0 / 15.0 * power / (1.0 - 1.0 / (rho * rho)) / 2.0
    }
}
