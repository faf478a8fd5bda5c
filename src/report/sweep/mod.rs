//! Sweeps: the designs, and the result of each.
//!
//! `points` has the points and their names; `document` the document, with `answer` (a sentence and
//! a table) and `pictures` (curves and maps).

mod answer;
mod document;
mod pictures;
pub(crate) mod points;

pub use document::counts;
pub use points::{DESIGNS, Sweep};
