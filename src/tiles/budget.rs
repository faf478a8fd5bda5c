//! Work limits that are counted rather than timed: a computation ends at the same place on every
//! machine, busy or idle, and on any number of threads.
//!
//! Work is counted in units of about 4 ns of a core; each module states what a unit is where it
//! spends them. A time limit can be set as well; the clock is read only where the work of all
//! threads is collected.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::interruption;

/// Units of work per core-second: operations on 64 vertices of a graph.
pub const UNITS_A_SECOND: f64 = 2.5e8;

/// A limit of work: nothing may be done if one of the two is 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Allowance {
    /// Work in core-seconds; unlimited if `None`.
    pub work: Option<f64>,
    /// Wall-clock time limit (s), if any; where the work then ends depends on the machine.
    pub seconds: Option<f64>,
}

impl Allowance {
    /// No work.
    pub const NONE: Self = Self {
        work: Some(0.0),
        seconds: None,
    };
    /// Unlimited work.
    pub const UNLIMITED: Self = Self {
        work: None,
        seconds: None,
    };

    /// A limit of work (core-seconds).
    pub const fn of(work: f64) -> Self {
        Self {
            work: Some(work),
            seconds: None,
        }
    }

    /// The limit with requested work, time or both in place of this one. A time limit for work that
    /// would not be done allows the `usual` work.
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

    /// What is left of it after this work (core-seconds) and time.
    pub fn after(self, work: f64, time: Duration) -> Self {
        let left = |all: f64, spent: f64| (all - spent).max(0.0);
        Self {
            work: self.work.map(|all| left(all, work)),
            seconds: self.seconds.map(|all| left(all, time.as_secs_f64())),
        }
    }

    /// Whether no work is allowed.
    pub fn is_none(&self) -> bool {
        [self.work, self.seconds].contains(&Some(0.0))
    }
}

/// What ended work before it was complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ended {
    /// The limit of work: another run ends at the same place.
    Work,
    /// The time limit: another run may end elsewhere.
    Clock,
}

impl Ended {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Work => "work",
            Self::Clock => "clock",
        }
    }

    /// The beginning of a sentence that says so.
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
/// use tilebind_tiles::budget::{Allowance, Budget, Ended};
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
    /// The time limit, if any.
    end: Option<Instant>,
    is_late: bool,
    /// Units until the next check for interruption.
    unasked: i64,
}

/// Units between two checks for interruption.
const BETWEEN_LOOKS: i64 = 1 << 22;

impl Budget {
    /// Starts with what is allowed from now on.
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

    /// A budget in core-seconds.
    pub fn seconds(seconds: f64) -> Self {
        Self::new(Allowance::of(seconds))
    }

    /// Takes a share of the remaining budget for a part of the work.
    pub fn share(&mut self, share: f64) -> Self {
        self.taken((self.left.max(0) as f64 * share) as i64)
    }

    /// Takes a number of core-seconds, or all that is left.
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

    /// Returns what a part did not spend, or deducts what it overspent.
    pub fn give_back(&mut self, part: &Self) {
        self.left += part.left;
    }

    /// Core-seconds spent of what was allowed at first, and beyond it.
    pub fn spent_of(&self, allowed: Allowance) -> f64 {
        let all = allowed.work.map_or(i64::MAX, units);
        (all - self.left) as f64 / UNITS_A_SECOND
    }

    /// Units left.
    pub fn left(&self) -> u64 {
        self.left.max(0) as u64
    }

    /// An equal share of what is left for each of some parts that are done at the same time, by work
    /// or, if there is a time limit, by the time left if that is less.
    pub fn part_of(&self, parts: usize) -> u64 {
        let left = self
            .end
            .map(|end| end.saturating_duration_since(Instant::now()));
        let left = left.map_or(u64::MAX, |time| {
            (time.as_secs_f64() * UNITS_A_SECOND) as u64
        });
        self.left().min(left) / parts.max(1) as u64
    }

    /// Counts work done.
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
    pub fn is_spent(&self) -> bool {
        self.left <= 0
    }

    /// The reason to end the work at this point, if there is one; reads the clock if there is a
    /// time limit.
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
    // Numbers too large to represent count as unlimited.
    (seconds * UNITS_A_SECOND) as i64
}
