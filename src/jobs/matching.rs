//! The ways in which the two outlines of a design fit together.

use crate::design::Design;
use crate::request::{self, options};
use physics::contact::Contact;
use physics::contact::matching::{Match, matches};

options! {
    /// The options of a search for fits.
    #[derive(Clone, Debug)]
    pub struct Request {
        /// Largest number of fits to list
        pub most: usize = value("N", request::count).or(100),
    }
}

impl Request {
    /// The fits, longest contact first.
    pub fn matches(&self, design: &Design) -> Vec<Match> {
        let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
        matches(&Contact::new(&fixed.outline, &moving.outline), self.most)
    }
}
