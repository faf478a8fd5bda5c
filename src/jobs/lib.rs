//! The jobs: each turns a design file or another input into a result, in one call, as plain data.
//!
//! | module | contents |
//! |---|---|
//! | [`design`], [`calibration`] | the design file: keys, defaults, checks with line and column; shields fitted to measurements |
//! | [`start`] | a design to start from |
//! | [`inspection`], [`matching`], [`workshop`] | the bond and its forces without a search; how the outlines fit; workshop files: outlines with pockets, the order of the magnets |
//! | [`pipeline`], [`query`] | the analysis of a design; a single barrier |
//! | [`comparison`], [`sweep`], [`search`] | analyses of many designs, compared; the best of them |
//! | [`docking`], [`bond`], [`rates`], [`yields`] | docking experiments; the strength of bonds of shaken tiles; rates of binding and unbinding; the yield of a shaken table |
//! | [`table`] | many tiles on one table |
//! | [`tolerance`] | what errors of making do to a design |
//! | [`word_sets`] | sets of barcodes: searches, magnets anywhere along the face, files |
//! | [`assembly`] | tile sets whose glues are words, for tile assembly engines |
//! | [`verification`] | a second reader, which checks results folders with other code than made them |
//! | [`memory`] | checks that the machine has enough memory |
//! | [`request`] | options with their limits and help, for the command line and Python |
//! | [`output`] | output files: a set is written completely or not at all, and replaces only its own files |

pub mod assembly;
pub mod bond;
pub mod calibration;
pub mod checksum;
pub mod comparison;
pub mod design;
pub mod docking;
pub mod inspection;
pub mod matching;
mod mates;
mod measured;
pub mod memory;
pub mod output;
pub mod pipeline;
pub mod query;
pub mod rates;
mod refused;
pub mod request;
pub mod search;
mod seated;
pub mod start;
pub mod sweep;
pub mod table;
pub mod text;
pub mod tolerance;
pub mod verification;
pub mod word_sets;
pub mod workshop;
pub mod yields;

pub use design::Design;
pub use pipeline::Analysis;
pub use refused::Refused;
