//! The faults of a design, collected as compilers do: reading continues after a fault.

use physics::order::Order;
use std::cell::{Cell, RefCell};

use super::error::{DesignError, Result};

/// What is wrong so far.
#[derive(Debug, Default)]
pub(super) struct Faults {
    found: RefCell<Vec<DesignError>>,
    guessed: Cell<bool>,
}

impl Faults {
    /// Adds a fault, once for each place and fix: what `all` says wrongly is wrong for every face.
    pub fn add(&self, fault: DesignError) {
        let mut found = self.found.borrow_mut();
        let same = |one: &DesignError| {
            (&one.file, &one.place, &one.help) == (&fault.file, &fault.place, &fault.help)
        };
        if !found.iter().any(same) {
            found.push(fault);
        }
    }

    /// Notes that a number is read on with a guess in its place.
    pub fn guess(&self) {
        self.guessed.set(true);
    }

    /// Ends the reading here if some number is a guess: what does not fit it may be no fault.
    pub fn check_guesses(&self) -> Result<()> {
        match self.guessed.get() {
            true => self.check(),
            false => Ok(()),
        }
    }

    /// Ends the reading here if anything is wrong.
    pub fn check(&self) -> Result<()> {
        self.found.borrow().first().cloned().map_or(Ok(()), Err)
    }

    /// What comes of the reading: all that is wrong, in the order of the file, or its result.
    pub fn conclude<T>(self, result: Result<T>) -> Result<T> {
        if let Err(fault) = &result {
            self.add(fault.clone());
        }
        let mut found = self.found.into_inner();
        found.order_by_key(|fault| fault.place.as_ref().map(|place| (place.line, place.column)));
        let mut found = found.into_iter();
        match found.next() {
            None => result,
            Some(first) => Err(DesignError {
                also: found.collect(),
                ..first
            }),
        }
    }
}
