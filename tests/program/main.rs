//! The program as its users see it: what it prints, writes and draws.

#![allow(clippy::disallowed_methods)]

mod cli;
mod compare;
#[path = "../shared/designs.rs"]
mod designs;
mod documents;
mod faults;
mod fits;
#[path = "../shared/folder.rs"]
mod folder;
mod keywords;
mod levels;
mod outputs;
mod pictures;
#[path = "../shared/program.rs"]
mod program;
mod readme;
mod results;
#[path = "../shared/small_design.rs"]
mod small_design;
mod snapshots;
mod structure;
mod sweep;
mod verification;
