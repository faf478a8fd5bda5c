//! Exits and rates of overdamped motion, as documents.

mod exit;
mod table;
mod told;

pub use exit::document as exit_document;
pub use table::document;
