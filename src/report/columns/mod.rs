//! Tables whose columns are declared once each, and how people and programs read them.

pub mod numbers;
mod rows;
mod table;
mod unit;

pub use rows::{Rows, rows};
pub use table::{Cell, Head, Link, Table};
pub use unit::{Unit, describe};
