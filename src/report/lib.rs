//! Presents results: documents, tables, pictures and pages.
//!
//! Most modules make the [`document`] of one job's result, which the terminal, JSON, CSV, the page and
//! pictures are made from:
//!
//! - [`analysis`] - of the main job, with [`states`] (and barriers), [`summary`], [`dynamics`] (the check
//!   by moving tiles) and [`topsearch`] (files for programs that draw disconnectivity graphs);
//! - [`comparison`], [`sweep`] - designs side by side, many designs from one;
//! - [`docking`], [`release`] - tiles sent towards each other, and shaken loose;
//! - [`bond`], [`rates`], [`yields`] - how strongly, how soon and how many shaken tiles bind;
//! - [`table`], [`gsd`] - many tiles on one table, and their trajectory for OVITO;
//! - [`words`], [`crosstalk`], [`assembly`] - sets of barcodes, and tile sets whose glues are words;
//! - [`barrier`], [`energies`] - one barrier between two poses, what is felt at given poses;
//! - [`matching`] - how two outlines fit; [`calibration`] - what is fitted to measurements;
//! - [`inspection`] - a design at a glance; [`workshop`] - what it takes to make one.
//!
//! Below these:
//! [`document`]; [`plots`] (pictures) and [`page`] (`report.html`); [`names`], [`figures`], [`json`],
//! [`csv`] (how things are called and numbers written); [`files`] (what each command writes).

pub mod analysis;
pub mod assembly;
mod assessments;
pub mod barrier;
pub mod bond;
mod braille;
pub mod calibration;
pub mod comparison;
pub mod crosstalk;
pub mod csv;
pub mod docking;
pub mod document;
mod dxf;
pub mod dynamics;
pub mod energies;
pub mod figures;
pub mod files;
pub mod gsd;
pub mod inspection;
pub mod json;
mod markdown;
pub mod matching;
pub mod names;
mod packing;
pub mod page;
pub mod plots;
pub mod rates;
pub mod release;
mod sold;
pub mod states;
pub mod summary;
pub mod sweep;
pub mod table;
mod terminal;
mod tiles;
pub mod topsearch;
mod values;
pub mod words;
pub mod workshop;
pub mod yields;
