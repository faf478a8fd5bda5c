//! Results for people and programs to read.
//!
//! - [`document`] - a result as one document that terminal, JSON, CSV, page and pictures are made from;
//! - [`json`] - `report.json`, everything that is known;
//! - [`states`] - tables of states and of barriers;
//! - [`names`] - what states, places, faces and files are called;
//! - [`csv`] - tables of states and barriers, and pathways;
//! - [`calibration`] - fitted shields;
//! - [`docking`] - docking experiments; [`dynamics`] - the check of barriers by moving tiles;
//! - [`comparison`] - designs side by side; [`sweep`] - many designs from one;
//! - [`assembly`] - tile sets whose glues are words;
//! - [`words`] - sets of barcodes; [`crosstalk`] - their attraction over all poses;
//! - [`matching`] - how two outlines fit together;
//! - [`rates`] - exits and rates of overdamped motion;
//! - [`figures`] - numbers with their bounds, for people;
//! - [`summary`] - ten lines for the terminal; [`inspection`] - a design at a glance;
//! - [`workshop`] - drawings and a sheet to make the tiles by;
//! - [`plots`] - pictures;
//! - [`page`] - `report.html`, all of it to look at and move about in;
//! - [`topsearch`] - minima and transition states for programs that draw disconnectivity graphs;
//! - [`analysis`] - all of it as files of one folder; [`files`] - what the files of all commands are
//!   called.

pub mod analysis;
pub mod assembly;
mod assessments;
pub mod bond;
mod braille;
pub mod calibration;
pub mod comparison;
pub mod crosstalk;
pub mod csv;
pub mod docking;
pub mod document;
pub mod dynamics;
pub mod figures;
pub mod files;
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
pub mod states;
pub mod summary;
pub mod sweep;
mod sweep_answer;
mod terminal;
pub mod topsearch;
mod values;
pub mod words;
pub mod workshop;
pub mod yields;
