//! Sweeps: the designs, and the result of each.
//!
//! `points` are its points and what they are called; `document` is what there is to know of it,
//! with `answer` (a sentence and a table) and `pictures` (curves and maps).

mod answer;
mod document;
mod pictures;
pub(crate) mod points;

pub use document::counts;
pub use points::{DESIGNS, Sweep};
