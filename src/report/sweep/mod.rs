//! Sweeps: the designs, and the result of each.
//!
//! `document` is the document, with `answer` (a sentence and a table) and `pictures` (curves and
//! maps).

mod answer;
mod document;
mod pictures;

pub use crate::points::{DESIGNS, Sweep};
pub use document::counts;
