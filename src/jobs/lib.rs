//! The jobs: each turns a design file or another input into a result, in one call, as plain data.
//!
//! | module | what it holds |
//! |---|---|
//! | [`design`], [`calibration`] | the design file: keys, defaults, checks with line and column; shields fitted to measurements |
//! | [`start`] | a design to start from |
//! | [`inspection`], [`matching`], [`workshop`] | a design at a glance; how the outlines fit; a design to be made: outlines with pockets, the order of the magnets |
//! | [`pipeline`], [`query`] | the main job in one page; one barrier, asked for |
//! | [`comparison`], [`sweep`] | what the main job says of many designs, set side by side |
//! | [`docking`], [`bond`], [`rates`], [`yields`] | tiles sent towards each other; how strongly shaken tiles hold; how fast shaken tiles bind and come off; what comes out of a shaken table |
//! | [`table`] | many tiles on one table |
//! | [`word_sets`] | sets of barcodes: what is asked, magnets anywhere, sets as files |
//! | [`assembly`] | tile sets whose glues are words: what engines of tile assembly read |
//! | [`memory`] | whether the machine has the memory that is needed |
//! | [`request`] | what is asked: options, with their limits and help, of the command line and of Python alike |
//! | [`output`] | files that are written: all of a set or none, in place of nothing but its like |

pub mod assembly;
pub mod bond;
pub mod calibration;
pub mod checksum;
pub mod comparison;
pub mod design;
pub mod docking;
pub mod inspection;
pub mod matching;
pub mod memory;
pub mod output;
pub mod pipeline;
pub mod query;
pub mod rates;
mod refused;
pub mod request;
pub mod start;
pub mod sweep;
pub mod table;
pub mod text;
pub mod word_sets;
pub mod workshop;
pub mod yields;

pub use design::Design;
pub use pipeline::{Analysis, Settings};
pub use refused::Refused;
