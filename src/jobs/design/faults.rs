//! The faults of a design, collected as compilers do: reading continues after a fault.

use physics::order::Order;
use std::cell::{Cell, RefCell};

use super::error::{DesignError, Result};

/// The faults found so far.
#[derive(Debug, Default)]
pub(super) struct Faults {
    found: RefCell<Vec<DesignError>>,
    guessed: Cell<bool>,
}

impl Faults {
    /// Adds a fault, once per place and fix: a fault in `all` applies to every face.
    pub fn add(&self, fault: DesignError) {
        let mut found = self.found.borrow_mut();
        let same = |one: &DesignError| {
            (&one.file, &one.place, &one.help) == (&fault.file, &fault.place, &fault.help)
        };
        if !found.iter().any(same) {
            found.push(fault);
        }
    }

    /// The fault with this message, if it has been found.
    pub fn named(&self, message: &str) -> Option<DesignError> {
        let found = self.found.borrow();
        found.iter().find(|fault| fault.message == message).cloned()
    }

    /// Notes that reading continues with a guess in place of a number.
    pub fn guess(&self) {
        self.guessed.set(true);
    }

    /// Stops if some number is a guess: further faults may be due to the guess.
    pub fn check_guesses(&self) -> Result<()> {
        match self.guessed.get() {
            true => self.check(),
            false => Ok(()),
        }
    }

    /// Stops if there is any fault.
    pub fn check(&self) -> Result<()> {
        self.found.borrow().first().cloned().map_or(Ok(()), Err)
    }

    /// Ends the reading: returns all faults in the order of the file, or the result.
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
