//! Requests: one struct per job, with the defaults, limits and help of its options.
//!
//! A request is plain data that declares its options, see [`option`]: the command line is made from
//! their table, and [`of_keywords`] takes the same options from Python's keyword arguments. Each
//! option is declared once, so both reject the same values.

mod keywords;
mod misused;
mod motion;
pub mod option;
mod shard;
mod unanswered;
mod values;
mod word;

pub use keywords::of_keywords;
pub use misused::Misused;
pub use motion::{ContactOptions, MotionOptions, fan};
pub(crate) use option::options;
pub use option::{Entry, Given, Options, Reader};
pub use shard::{Shard, shard};
pub use unanswered::Unanswered;
pub use values::{
    FARTHEST, MOST_FRICTION, MOST_TURNED, TIMES, any_energy, area, binding, coordinate, count,
    count_or_none, energy, fraction, length, length_or_none, not_negative, numbers, pose, positive,
    rate, runs, runs_of_a_mean, runs_or_none, seed, shaking, share, time, time_or_none, turn,
    up_to, whole,
};
pub use word::{Word, model};
