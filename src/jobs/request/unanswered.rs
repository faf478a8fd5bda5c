//! Errors of jobs without a result: the request has no answer, or the work failed.

use std::fmt::Display;

use physics::dynamics::SettingsError;
use physics::dynamics::docking::DockingError;
use physics::kinetics::bond::BondError;
use physics::kinetics::rates::RatesError;
use physics::kinetics::rates::exit::ExitError;

/// An error of a job without a result.
pub trait Unanswered: Display {
    /// Whether the request has no answer; otherwise the work failed.
    fn is_of_the_question(&self) -> bool {
        true
    }
}

/// Errors in user input.
impl Unanswered for String {}

impl Unanswered for BondError {
    fn is_of_the_question(&self) -> bool {
        false
    }
}

impl Unanswered for RatesError {
    fn is_of_the_question(&self) -> bool {
        !matches!(self, Self::Unsolved(_))
    }
}

impl Unanswered for ExitError {
    fn is_of_the_question(&self) -> bool {
        !matches!(self, Self::Unsolved(_))
    }
}

impl Unanswered for DockingError {}

impl Unanswered for SettingsError {}
