//! Work limits that are counted rather than timed: a computation ends at the same place on every
//! machine, busy or idle, and on any number of threads.
//!
//! Work is counted in units that take about 4 ns of a core; what they stand for is counted out where
//! they are spent. A clock may be set as well, and is asked only where work done on all threads has
//! come together.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::interruption;

/// Units of work that count as a second of a core: operations on 64 vertices of a graph.
pub const UNITS_A_SECOND: f64 = 2.5e8;

/// How much may be spent on something: nothing where one of the two is 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Allowance {
    /// Work, as what takes about so many seconds of a core; without end where `None`.
    pub work: Option<f64>,
    /// Time (s) by the clock after which it ends as well, if any: where it does depends on the
    /// machine.
    pub seconds: Option<f64>,
}

impl Allowance {
    /// Nothing.
    pub const NONE: Self = Self {
        work: Some(0.0),
        seconds: None,
    };
    /// All that it takes.
    pub const UNLIMITED: Self = Self {
        work: None,
        seconds: None,
    };

    /// So much work.
    pub const fn of(work: f64) -> Self {
        Self {
            work: Some(work),
            seconds: None,
        }
    }

    /// What is asked for in place of this: work, time or both. Time for what would not be done brings
    /// the `usual` work.
    pub fn or(self, work: Option<f64>, seconds: Option<f64>, usual: Self) -> Self {
        let untold = if self.is_none() && seconds.is_some() {
            usual.work
        } else {
            self.work
        };
        Self {
            work: work.or(untold),
            seconds: seconds.or(self.seconds),
        }
    }

    /// Whether nothing may be spent.
    pub fn is_none(&self) -> bool {
        [self.work, self.seconds].contains(&Some(0.0))
    }
}

/// What ended work before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ended {
    /// All that was allowed had been done: another run ends at the same place.
    Work,
    /// The clock: another run may end elsewhere.
    Clock,
}

impl Ended {
    /// As reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Work => "work",
            Self::Clock => "clock",
        }
    }

    /// As a sentence begins that says so.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Work => "the proof used up its work",
            Self::Clock => "the proof reached its time limit",
        }
    }
}

/// Work left to do.
///
/// ```
/// use tilebind_physics::budget::{Allowance, Budget, Ended};
/// let mut budget = Budget::new(Allowance::of(1.0));
/// let part = budget.share(0.25);
/// budget.spend(budget.left());
/// assert_eq!(budget.ended(), Some(Ended::Work));
/// budget.give_back(&part);
/// assert_eq!(budget.ended(), None);
/// ```
#[derive(Clone, Debug)]
pub struct Budget {
    left: i64,
    /// The end by the clock, if there is one.
    end: Option<Instant>,
    is_late: bool,
    /// Until it is asked whether the work is still wanted.
    unasked: i64,
}

/// Units between two looks at whether the work is still wanted.
const BETWEEN_LOOKS: i64 = 1 << 22;

impl Budget {
    /// What is allowed from now on.
    pub fn new(allowed: Allowance) -> Self {
        let end = |seconds: f64| {
            let time = Duration::try_from_secs_f64(seconds).ok()?;
            Instant::now().checked_add(time)
        };
        Self {
            left: allowed.work.map_or(i64::MAX, units),
            end: allowed.seconds.and_then(end),
            is_late: false,
            unasked: BETWEEN_LOOKS,
        }
    }

    /// As much as takes about so many seconds (s) of a core.
    pub fn seconds(seconds: f64) -> Self {
        Self::new(Allowance::of(seconds))
    }

    /// Takes a share of what is left for a part of the work.
    pub fn share(&mut self, share: f64) -> Self {
        self.taken((self.left.max(0) as f64 * share) as i64)
    }

    /// Takes what about so many seconds (s) take, or all that is left.
    pub fn part(&mut self, seconds: f64) -> Self {
        self.taken(units(seconds).min(self.left))
    }

    fn taken(&mut self, part: i64) -> Self {
        self.left -= part;
        Self {
            left: part,
            ..self.clone()
        }
    }

    /// Gives back what a part did not spend, or takes what it spent too much.
    pub fn give_back(&mut self, part: &Self) {
        self.left += part.left;
    }

    /// Units left.
    pub fn left(&self) -> u64 {
        self.left.max(0) as u64
    }

    /// Counts work done.
    #[inline]
    pub fn spend(&mut self, units: u64) {
        let units = units.min(i64::MAX as u64) as i64;
        self.left = self.left.saturating_sub(units);
        self.unasked = self.unasked.saturating_sub(units);
        if self.unasked <= 0 {
            interruption::check();
            self.unasked = BETWEEN_LOOKS;
        }
    }

    /// Whether nothing is left.
    #[inline]
    pub fn is_spent(&self) -> bool {
        self.left <= 0
    }

    /// What ends the work here, if anything does; asks the clock, if there is one.
    pub fn ended(&mut self) -> Option<Ended> {
        self.is_late |= self.end.is_some_and(|end| Instant::now() >= end);
        match (self.is_spent(), self.is_late) {
            (true, _) => Some(Ended::Work),
            (_, true) => Some(Ended::Clock),
            _ => None,
        }
    }
}

fn units(seconds: f64) -> i64 {
    // More than there is no number for is without end.
    (seconds * UNITS_A_SECOND) as i64
}
