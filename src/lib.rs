//! How two magnetic tiles bind.
//!
//! Flat tiles float on an air table and are shaken about; each face carries a barcode of bar
//! magnets and may carry a complementary shape. For a pair of tiles this crate answers how deep the
//! wanted bond is, which wrong bonds trap the tiles, how high the energy barrier is between each of
//! these states and freedom, and by which motion it is crossed. It follows Majumder and Reif,
//! *Barcoded Magnetic Tiles for Programmable Assemblies*: probabilistic roadmaps over
//! (x, y, theta) (section 4.4) and the physics of section 5. SI units everywhere.
//!
//! # What flows where
//!
//! ```text
//! design file -> tiles -> potential -> roadmap -> landscape (states, barriers, pathways) -> report
//!                              \-> dynamics (a check from outside the roadmap) --------------^
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | [`design`] | the design file: keys, defaults, checks with line and column |
//! | [`tile`] | outlines, faces, profiles, barcodes, magnets, symmetries |
//! | [`configuration`], [`cell`] | (x, y, theta), its space and metric; boxes of configurations |
//! | [`contact`] | overlap, clearance, free motions, the constraints of touching |
//! | [`potential`] | U(x, y, theta) of point dipoles and of blocks, gradients, bounds |
//! | [`problem`] | the three above, put together |
//! | [`roadmap`] | milestones, neighbours, motions and their costs |
//! | [`landscape`] | minima, transition states, barriers, pathways, captures, certificates |
//! | [`calibration`] | shields fitted to measurements |
//! | [`dynamics`] | tiles that really move: docking runs |
//! | [`pipeline`] | the main job in one page; [`certification`] and [`query`] beside it |
//! | [`comparison`], [`sweep`] | what the main job says of many designs, set side by side |
//! | [`report`] | JSON, CSV, the summary, pictures |
//!
//! # The library in ten lines
//!
//! ```no_run
//! use tilebind::{analysis::Settings, design::Design, pipeline, units::si};
//! let design = Design::load("shapes/paper-tile.toml".as_ref())?;
//! let analysis = pipeline::analyse(&design, &Settings::default(), &pipeline::Silent);
//! println!("bond {}", si(analysis.bound.1, "J", 4));
//! for (state, escape) in analysis.states.iter().zip(&analysis.escapes) {
//!     let escape = escape.as_ref().map(|barrier| si(barrier.forward(), "J", 4));
//!     println!("{:?} {}: {escape:?}", state.kind, si(state.energy, "J", 4));
//! }
//! # Ok::<(), tilebind::design::DesignError>(())
//! ```

pub mod calibration;
pub mod cell;
mod checksum;
pub mod comparison;
pub mod configuration;
pub mod contact;
pub mod design;
pub mod dynamics;
pub mod landscape;
pub mod observer;
pub mod pipeline;
pub mod potential;
pub mod problem;
pub mod query;
pub mod report;
pub mod roadmap;
pub mod sweep;
pub mod tile;
pub mod units;

pub use configuration::{Configuration, ConfigurationSpace};
pub use design::Design;
pub use pipeline::{Analysis, Settings};
pub use problem::Problem;
