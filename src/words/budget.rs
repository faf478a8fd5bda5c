//! How much work a search may do, counted so that it ends at the same place on every machine.

use std::time::{Duration, Instant};

use crate::interruption;

/// Units of work that count as a second: operations on 64 vertices of a graph.
const UNITS_A_SECOND: f64 = 2.5e8;

/// Work left to do. It is counted; the clock only stops what takes longer than it should.
#[derive(Clone, Debug)]
pub struct Budget {
    left: i64,
    deadline: Option<Instant>,
    /// Until the clock is read again.
    unread: i64,
    late: bool,
}

/// Units between two looks at the clock.
const BETWEEN_LOOKS: i64 = 1 << 22;

impl Budget {
    /// Nothing at all, be it because it is late.
    pub fn none(late: bool) -> Self {
        Self {
            left: 0,
            deadline: None,
            unread: 0,
            late,
        }
    }

    /// As much as takes about so many seconds (s) of a core, and no more by the clock.
    pub fn seconds(seconds: f64, deadline: Option<Instant>) -> Self {
        Self {
            left: (seconds * UNITS_A_SECOND).min(9e18) as i64,
            deadline,
            unread: BETWEEN_LOOKS,
            late: false,
        }
    }

    /// The end by the clock of something that takes so many seconds from now.
    pub fn deadline(seconds: f64) -> Option<Instant> {
        Instant::now().checked_add(Duration::try_from_secs_f64(seconds).ok()?)
    }

    /// Takes a share of what is left for a part of the work.
    pub fn share(&mut self, share: f64) -> Self {
        let part = (self.left.max(0) as f64 * share) as i64;
        self.left -= part;
        Self {
            left: part,
            ..self.clone()
        }
    }

    /// Takes what about so many seconds (s) take, or all that is left.
    pub fn part(&mut self, seconds: f64) -> Self {
        let units = (seconds * UNITS_A_SECOND) as i64;
        let part = units.min(self.left);
        self.left -= part;
        Self {
            left: part,
            ..self.clone()
        }
    }

    /// Gives back what a part did not spend.
    pub fn give_back(&mut self, part: &Self) {
        self.left += part.left.max(0);
        self.late |= part.late;
    }

    /// Units left.
    pub fn left(&self) -> u64 {
        self.left.max(0) as u64
    }

    /// Counts work done.
    #[inline]
    pub fn spend(&mut self, units: u64) {
        let units = units as i64;
        self.left -= units;
        self.unread -= units;
        if self.unread <= 0 {
            interruption::check();
            self.unread = BETWEEN_LOOKS;
            self.late |= self.deadline.is_some_and(|end| Instant::now() >= end);
        }
    }

    /// Whether nothing is left.
    #[inline]
    pub fn is_spent(&self) -> bool {
        self.left <= 0 || self.late
    }

    /// Whether the clock ended the work: another run may end elsewhere.
    pub fn is_late(&self) -> bool {
        self.late
    }
}
