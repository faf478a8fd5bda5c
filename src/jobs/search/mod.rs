//! Searches: the best design among those that varied keys give.
//!
//! An [`Aim`] names what is to be largest or smallest, and the conditions; a [`Space`] holds all
//! designs of a sweep's [`Plan`](crate::sweep::Plan), whose axes may also be ranges. A [`Search`] is both, and is all
//! that a manifest holds.
//!
//! # Method
//!
//! 1. A third of the points are spread over the space: the widest of several Latin hypercubes
//!    (McKay, Beckman and Conover 1979).
//! 2. The others follow in rounds. A Gaussian process (Jones, Schonlau and Welch 1998) is fitted to
//!    the *ranks* of the points so far, whether they satisfy the conditions or not, and another to
//!    the margins of the conditions, which are negative where they are violated, and where a design
//!    is impossible. The points with the largest expected improvement times the chance that they are
//!    fit are next (Gardner and others 2014): by turns from everywhere, and from a box about the
//!    best, which shrinks while nothing better is found. Ranks make no difference between a
//!    selectivity of 50 and an infinite one.
//! 3. The last points lie beside the best, one step along each number: they say which key matters.
//!    Where two keys matter, steps of both at once say whether they cancel each other: then the design
//!    can be changed along that line at no loss.
//! 4. Conditions on the bond's depth are settled by energies, before any analysis. All other points
//!    are analysed without proofs, except for the paths that bound barriers from above. Proofs are for contenders only: a race
//!    proves the best, drops the points whose upper bound lies below its lower bound, and goes on
//!    with the best of the rest.
//!
//! With two objectives each next point has weights of its own for them (Knowles 2006), and the
//! points that no other surpasses are the front.
//!
//! Own code instead of `cmaes`, `argmin` or `egobox`: the first two know neither listed values nor
//! failures and need hundreds of evaluations, the third compiles for minutes and multiplies matrices
//! in an order that depends on the processor.
//!
//! The size of rounds depends on the number of points only, and each round on the results of earlier
//! ones: the same search tries the same points on any number of threads, after an interruption, and
//! in parts.

mod aim;
mod energies;
mod interval;
mod manifest;
mod model;
mod race;
mod rank;
mod run;
mod sensitivity;
mod space;
#[cfg(test)]
mod tests;
mod tried;
mod verdict;

pub use aim::{Aim, Condition, Objective, Request};
pub use interval::FigureBounds;
pub use manifest::{Search, Stage};
pub use rank::{Figures, Standing};
pub use sensitivity::{Direction, Effect};
pub use space::{Dimension, Space};
pub use tried::{SearchError, SearchResult, Tried};
pub use verdict::Verdict;
