//! Results for people and programs to read.

pub mod plots;
