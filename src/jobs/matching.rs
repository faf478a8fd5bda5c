//! The ways in which the two outlines of a design fit together.

use clap::Args;

use crate::design::Design;
use crate::request;
use physics::contact::Contact;
use physics::contact::matching::{Match, matches};

/// The options of a search for fits.
#[derive(Clone, Debug, Args)]
pub struct Request {
    /// Largest number of fits to list
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = request::count)]
    pub most: usize,
}

impl Request {
    /// The fits, longest contact first.
    pub fn matches(&self, design: &Design) -> Vec<Match> {
        let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
        matches(&Contact::new(&fixed.outline, &moving.outline), self.most)
    }
}
