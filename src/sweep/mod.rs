//! Many designs from one: keys of the design are varied, and every design that comes of it is
//! assessed.
//!
//! A [`Plan`] holds all that decides a sweep: the text of the designs, the varied keys with their
//! values, the settings and the seed. Each of its [`Point`]s is a design of its own and is named
//! after it: the name is a hash of the design as it is assessed, with its drawings, of the settings
//! and of the version of tilebind; the seed of its random numbers comes from the name. So a point's result depends
//! neither on the other points nor on when, where and beside which others it is worked on.
//!
//! A [`Store`] keeps one file a point. It is written under a temporary name, synced and renamed:
//! whenever the work is stopped, by whatever means, a point's file is there as a whole or not at
//! all, and the work goes on with the points that have none. [`run`] works on points; the merged
//! tables ([`crate::report::sweep`]) are made from the files alone and hold no times, so that they
//! are the same bytes however the work was divided.
//!
//! A design that is impossible at some value is an [`Outcome`] like any other, with the reason.

mod document;
mod drawings;
mod plan;
mod run;
mod store;
mod vary;

pub use plan::{Plan, PlanError, Point, Shard};
pub use run::run;
pub use store::{Outcome, Progress, Store};
pub use vary::{Axis, Value};
