//! Certified barriers: proved lower and upper bounds of the minimax energy between two
//! configurations.
//!
//! ```text
//! lower <= lowest maximum energy over all free paths <= upper
//! ```
//!
//! **Upper bound.** A pathway is lifted off contact and cut into straight stretches. Each stretch
//! is proved free by lines that separate convex parts along all of it, and its energy is bounded by
//! the enclosure of a cell around it; nothing is sampled.
//!
//! **Lower bound.** The configuration space is covered by closed cells. Each cell either has no
//! free configuration, or a lower bound of the energy of its free configurations is known: a Taylor
//! form with a bounded remainder, minimised over the part of the cell that contact allows. A path
//! is covered by a chain of cells that meet in faces (see `store`), so if every such chain from end
//! to end has a cell with a lower bound above E, the barrier is above E.
//!
//! **Search.** A flood rises from one end over the cells with lower bounds of at most E, the target
//! just below the best upper bound. The cells where it would spill over to the other end form a
//! divide, and only its cells are subdivided (see `flood`), or the largest cells on its way if all of
//! it seems passable: wrong guesses cost time, never the proof. The lowest pass suggests a pathway;
//! if one along it can be proved, the upper bound decreases. If no chain is left at E = infinity,
//! the start is caged. Several queries share one subdivision and advance together, one flood of each
//! at a time.
//!
//! # What is proved, and what is assumed
//!
//! For the model potential and the two outlines as given, with the reference point on the table:
//!
//! - `lower` holds for every path on which no point of a tile enters the other deeper than
//!   [`relaxed`](tiles::contact::cells::ContactCells::relaxed) (2e-9 m for the paper's tile), which
//!   includes every free path;
//! - `upper` holds for the returned pathway, on which the tiles nowhere overlap by more than
//!   [`touch`](tiles::contact::Contact::touch) (1e-9 m for the paper's tile), which counts as
//!   touching;
//! - rounding errors are included, see [`tiles::potential::bounds`], [`tiles::cell`] and
//!   [`tiles::contact::cells`]. It is assumed that f64 arithmetic follows IEEE 754, and that the
//!   platform's sine, cosine, arc and exponential functions are accurate to 8 units in the last
//!   place.
//!
//! The same queries to the same certifier give the same brackets on any number of threads, unless a
//! time limit ends them early. A bracket that ended early is also valid, only wider.

mod adjacency;
mod certifier;
mod ends;
mod flood;
mod level;
mod proved;
mod query;
mod question;
mod store;
mod together;
pub(super) mod upper;
mod ways;

use crate::results::SaddleBounds;
use tiles::configuration::Configuration;

pub use certifier::Certifier;
pub use question::{Goal, Question};

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

/// The desired width of a bracket, and the effort allowed for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Width (J) at which to stop.
    pub tolerance: f64,
    /// Approximate number of cells assessed in this query at which to stop with the current
    /// bracket.
    pub cells: usize,
}

/// Bounds of a barrier's highest energy, and the pathway that proves the upper one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bracket {
    /// The proved bounds.
    pub bounds: SaddleBounds,
    /// The proved pathway, from end to end; empty where none is known. Straight in x, y and theta
    /// between its points.
    pub pathway: Vec<Configuration>,
    /// The highest point met on the pathway.
    pub saddle: Option<Configuration>,
    /// Whether the pathway was found by the certificate: lower than the given one, or instead of
    /// one that could not be proved.
    pub improved: bool,
    /// Cells assessed at the expense of this query.
    pub cells: usize,
    /// Rounds of subdivision.
    pub rounds: usize,
}

/// Which of two barriers is proved to be higher.
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
    /// that no path crosses is higher than one that a path crosses.
    ///
    /// ```
    /// use tilebind_landscape::SaddleBounds;
    /// use tilebind_landscape::minimax::Ordering;
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
/// bound, is higher; decided only if the bounds do not overlap.
///
/// ```
/// use tilebind_landscape::minimax::{Ordering, order};
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
    /// An end of the path is not a free configuration.
    #[error("the tiles overlap at ({}, {}, {})", .0.x, .0.y, .0.theta)]
    NotFree(Configuration),
    /// An end of the path is off the table.
    #[error("({}, {}) lies off the table", .0.x, .0.y)]
    OffTheTable(Configuration),
}
