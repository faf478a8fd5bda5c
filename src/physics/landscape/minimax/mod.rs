//! Certified barriers: proved lower and upper bounds of the minimax energy between two
//! configurations.
//!
//! ```text
//! lower <= least possible highest energy of a free path <= upper
//! ```
//!
//! **Upper bound.** A pathway is lifted off contact and cut into straight stretches. Each stretch
//! is proved free by separating lines of convex parts that hold all along it, and its energy is
//! bounded by the enclosure of a cell around it; nothing is sampled.
//!
//! **Lower bound.** The configuration space is covered by closed cells. For each cell either no
//! configuration of it is free, or a number is known that the energy of no free configuration of it
//! falls below: a Taylor form with a bound of its remainder, minimised over the part of the cell
//! that contact leaves. A path is covered by a chain of touching cells, so if every chain of cells
//! from end to end has one with a lower bound above E, the barrier is above E.
//!
//! **Search.** A flood rises from one end over the cells with lower bounds of at most E, the target
//! just below the best upper bound. Where it would spill over to the other end is a divide, and
//! only its cells are subdivided (see `flood`): wrong guesses cost time, never the proof. The lowest
//! pass suggests a pathway; where one along it can be proved, the upper bound falls.
//! Where no chain is left at E = infinity the start is caged.
//!
//! # What is proved, and what is assumed
//!
//! For the model potential and the two outlines as given, with the reference point on the table:
//!
//! - `lower` holds for every path on which no point of a tile gets deeper than
//!   [`relaxed`](crate::contact::cells::ContactCells::relaxed) (2e-9 m of the paper's tile) into the other, more than every free one;
//! - `upper` is that of the returned pathway, on no stretch of which the tiles overlap by more than
//!   [`touch`](crate::contact::Contact::touch) (1e-9 m of the paper's tile), which counts as touching;
//! - rounding errors are included, see [`crate::potential::bounds`], [`crate::cell`] and
//!   [`crate::contact::cells`]. Assumed is that f64 arithmetic is IEEE 754's, and that the
//!   platform's sine, cosine, arc and exponential functions are right to 8 units in the last place.
//!
//! The same query to the same certifier gives the same bracket on any number of threads, unless
//! a clock cuts it short. A bracket that was cut short is as true, only wider.

mod certifier;
mod ends;
mod flood;
mod level;
pub(crate) mod lower;
mod proved;
mod query;
mod store;
mod upper;
mod ways;

use crate::configuration::Configuration;
use crate::landscape::results::SaddleBounds;

pub use certifier::Certifier;

/// Where a certified path ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// This configuration.
    At(Configuration),
    /// Any configuration with the tiles far apart, as the configuration space has it.
    Free,
}

impl End {
    /// The configuration, where it is a single one.
    pub fn configuration(&self) -> Option<&Configuration> {
        match self {
            Self::At(q) => Some(q),
            Self::Free => None,
        }
    }
}

/// How narrow a bracket is wanted, and how much work it is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Width (J) at which to stop.
    pub tolerance: f64,
    /// Cells assessed in this query, about, at which to stop with what is known.
    pub cells: usize,
}

/// Bounds of a barrier's highest energy, and the pathway that proves the upper one.
#[derive(Clone, Debug, PartialEq)]
pub struct Bracket {
    /// What is proved.
    pub bounds: SaddleBounds,
    /// The proved pathway, from end to end; empty where none is known. Straight in x, y and theta
    /// between its points.
    pub pathway: Vec<Configuration>,
    /// The highest point met on the pathway.
    pub saddle: Option<Configuration>,
    /// Whether the pathway is the certificate's own, lower than the one it was given or in place
    /// of one that could not be proved.
    pub improved: bool,
    /// Cells assessed for this query.
    pub cells: usize,
    /// Rounds of subdivision.
    pub rounds: usize,
}

/// Which of two barriers is proved the higher one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ordering {
    /// The first one.
    Higher,
    /// The second one.
    Lower,
    /// Neither is proved.
    Undecided,
}

impl SaddleBounds {
    /// Whether this barrier's highest energy is proved higher or lower than the other's. A barrier
    /// with no way over it is higher than one with a way.
    ///
    /// ```
    /// use tilebind_physics::landscape::SaddleBounds;
    /// use tilebind_physics::landscape::minimax::Ordering;
    /// let bounds = |lower: f64, upper: f64| SaddleBounds {
    ///     lower: Some(lower),
    ///     upper: Some(upper),
    ///     caged: false,
    /// };
    /// assert_eq!(bounds(2.0, 3.0).compare(&bounds(0.0, 1.0)), Ordering::Higher);
    /// assert_eq!(bounds(0.0, 1.0).compare(&bounds(2.0, 3.0)), Ordering::Lower);
    /// assert_eq!(bounds(0.0, 2.5).compare(&bounds(2.0, 3.0)), Ordering::Undecided);
    /// ```
    pub fn compare(&self, other: &Self) -> Ordering {
        order((self.least(), self.upper), (other.least(), other.upper))
    }
}

/// Which of two numbers, each known by a proved lower bound and, where there is one, a proved upper
/// bound, is the higher one; decided only where the bounds do not overlap.
///
/// ```
/// use tilebind_physics::landscape::minimax::{Ordering, order};
/// assert_eq!(order((2.0, None), (0.0, Some(1.0))), Ordering::Higher);
/// assert_eq!(order((0.0, Some(2.0)), (2.0, None)), Ordering::Undecided);
/// ```
pub fn order(a: (f64, Option<f64>), b: (f64, Option<f64>)) -> Ordering {
    if b.1.is_some_and(|upper| a.0 > upper) {
        Ordering::Higher
    } else if a.1.is_some_and(|upper| upper < b.0) {
        Ordering::Lower
    } else {
        Ordering::Undecided
    }
}

/// Why nothing could be certified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CertifyError {
    /// An end of the path is no free configuration.
    #[error("the tiles overlap at ({}, {}, {})", .0.x, .0.y, .0.theta)]
    NotFree(Configuration),
    /// An end of the path is off the table.
    #[error("({}, {}) lies off the table", .0.x, .0.y)]
    OffTheTable(Configuration),
}
