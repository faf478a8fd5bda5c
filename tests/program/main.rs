//! The program as its users see it: what it prints, writes, draws and answers.

mod cli;
mod compare;
#[path = "../shared/designs.rs"]
mod designs;
mod faults;
#[path = "../shared/folder.rs"]
mod folder;
mod pictures;
#[path = "../shared/program.rs"]
mod program;
mod readme;
mod sweep;
