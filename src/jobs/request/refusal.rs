//! Why there is no answer: what was asked for has none, or the work failed.

use std::fmt::Display;

use crate::query::QueryError;
use crate::workshop::PartError;
use physics::dynamics::SettingsError;
use physics::dynamics::docking::DockingError;
use physics::kinetics::bond::BondError;
use physics::kinetics::exit::ExitError;
use physics::kinetics::rates::RatesError;

/// Why there is no answer.
pub trait Refusal: Display {
    /// Whether it is what was asked for that has none; else the work failed.
    fn is_of_the_question(&self) -> bool;
}

/// Of what was typed.
impl Refusal for String {
    fn is_of_the_question(&self) -> bool {
        true
    }
}

impl Refusal for BondError {
    fn is_of_the_question(&self) -> bool {
        false
    }
}

impl Refusal for QueryError {
    fn is_of_the_question(&self) -> bool {
        *self != Self::NoWay
    }
}

impl Refusal for RatesError {
    fn is_of_the_question(&self) -> bool {
        !matches!(self, Self::Unsolved(_))
    }
}

impl Refusal for ExitError {
    fn is_of_the_question(&self) -> bool {
        !matches!(self, Self::Unsolved(_))
    }
}

impl Refusal for DockingError {
    fn is_of_the_question(&self) -> bool {
        true
    }
}

impl Refusal for PartError {
    fn is_of_the_question(&self) -> bool {
        true
    }
}

impl Refusal for SettingsError {
    fn is_of_the_question(&self) -> bool {
        true
    }
}
