//! Presents results: documents, tables, pictures and pages.
//!
//! Most modules make the [`document`] of one job's result, which the terminal, JSON, CSV, the page and
//! pictures are made from:
//!
//! - [`analysis`] - analyses, with [`states`] (and barriers), [`summary`], [`dynamics`] (the check
//!   by moving tiles) and [`topsearch`] (files for programs that draw disconnectivity graphs);
//! - [`comparison`], [`sweep`] - comparisons and variations of designs;
//! - [`docking`], [`release`] - docking experiments, and bound tiles that are shaken loose;
//! - [`bond`], [`rates`], [`yields`] - strength, rates and yield of bonds of shaken tiles;
//! - [`tolerance`] - what errors of making do to a design;
//! - [`table`], [`gsd`], [`hoomd`] - many tiles on one table, their trajectory for OVITO, and a script
//!   that continues it in HOOMD-blue;
//! - [`words`], [`crosstalk`], [`assembly`] - sets of barcodes, and tile sets whose glues are words;
//! - [`barrier`], [`energies`] - one barrier between two poses, energies and forces at given poses;
//! - [`matching`] - how two outlines fit; [`calibration`] - fits to measurements;
//! - [`verification`] - checks of analyses by a second reader;
//! - [`inspection`] - the bond of a design without a search; [`workshop`] - workshop files.
//!
//! Below these: [`document`], whose tables are made in `columns`; [`plots`] (pictures) and [`page`] (`report.html`); [`names`],
//! [`figures`], [`json`], [`csv`] (names and number formats); `points` (those of sweeps); [`files`] (names of files that
//! commands share).

pub mod analysis;
pub mod assembly;
mod assessments;
pub mod barrier;
pub mod bond;
mod braille;
pub mod calibration;
mod chains;
mod columns;
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
mod geometry;
pub mod gsd;
pub mod hoomd;
pub mod inspection;
pub mod json;
mod markdown;
pub mod matching;
pub mod names;
mod packing;
pub mod page;
pub mod plots;
mod points;
pub mod rates;
pub mod release;
mod sold;
pub mod states;
pub mod summary;
pub mod sweep;
pub mod table;
mod terminal;
mod tiles;
pub mod tolerance;
pub mod topsearch;
mod values;
pub mod verification;
pub mod words;
pub mod workshop;
pub mod yields;
