//! How two magnetic tiles bind.
//!
//! Flat tiles float on an air table and are shaken; each face has a barcode of bar magnets and may
//! have a complementary shape. For a pair of tiles this crate computes the depth of the intended
//! bond, the wrong contacts that trap the tiles, and the energy barrier and pathway between each of
//! these states and free tiles. It follows Majumder and Reif, *Barcoded Magnetic Tiles for
//! Programmable Assemblies*: probabilistic roadmaps over (x, y, theta) (section 4.4) and the
//! physics of section 5. All quantities are in SI units.
//!
//! # Data flow
//!
//! ```text
//! design file -> problem (tiles, potential, contact) -> roadmap -> landscape (states, barriers, proofs)
//!                              \-> dynamics (an independent check of the roadmap)       |
//!                                                                          report <----/
//! ```
//!
//! Each crate uses only those above it in this table (`shaken` and `words` not each other), which the
//! compiler enforces, and an edit recompiles only the crates below it. This crate re-exports the public
//! modules of all of them.
//!
//! | crate | contents |
//! |---|---|
//! | `src/tiles` | two tiles: outlines, magnets, contact, energies, and bounds of both |
//! | `src/landscape` | their energy landscape: roadmaps, states, barriers, captures, and proofs of them |
//! | `src/shaken` | tiles in motion: rigid bodies, docking, tables of many tiles, rates |
//! | `src/words` | sets of barcodes |
//! | `src/physics` | these four under one name |
//! | `src/jobs` | the jobs, from a design file to a result: analyses, comparisons, sweeps, yields, tile sets |
//! | `src/report` | results as JSON, tables, pictures, pages and text |
//! | `src/main.rs`, `src/cli`; `src/python` | the command line; the Python package |
//!
//! Imports within a crate are layered in the same way: a module uses only those in lower layers,
//! never one in its own layer. The file `lib.rs` of each crate lists
//! its modules.
//!
//! # What to read first
//!
//! An analysis from the design file to the report, in ten files and 2,000 lines:
//!
//! 1. `src/cli/analyse.rs` - the options, and where results are written;
//! 2. `src/jobs/pipeline/mod.rs` - the whole analysis on one page;
//! 3. `src/tiles/tile/mod.rs` - a tile: outline, faces, magnets;
//! 4. `src/tiles/potential/mod.rs` - U(x, y, theta), its gradient and its bounds;
//! 5. `src/landscape/roadmap/mod.rs` - milestones, neighbours, motions;
//! 6. `src/landscape/exploration/mod.rs` - minima and the passes between their basins;
//! 7. `src/landscape/catalogue/mod.rs` - the listed states and barriers;
//! 8. `src/landscape/minimax/mod.rs` - bounds of barriers by subdivision;
//! 9. `src/landscape/missing_states/mod.rs` - the proof that no state is missing;
//! 10. `src/report/analysis.rs` - the report.
//!
//! `src/report/document` describes how a result becomes text, JSON, tables, pictures and a page;
//! `src/jobs/request` how options of the command line become keyword arguments in Python; an option is
//! declared in its request alone, and `tests/program/keywords.rs` writes what Python says of it.
//!
//! The terms are the same everywhere: the intended contact of the tiles is the *bond*, any other
//! stable contact is a *trap*, and tiles far apart are *free*. [`potential::interaction`] describes
//! how to add interactions other than magnets, and which files that touches.
//!
//! # Examples and the paper
//!
//! [`examples`] has ten short programs, from loading a design to many tiles on a table. [`paper`]
//! has the command for each section and figure of the paper.
//!
//! # Limits
//!
//! - Magnets are blocks unless the design says otherwise. Point dipoles, the paper's model, are
//!   faster, but too weak near contact, or far too strong for thin magnets (see
//!   `results/README.md`); results with dipoles also give the values of blocks.
//! - A roadmap finds only what it samples. It can miss states and paths behind very narrow
//!   passages; the certificate's bounds are then far apart, and `--repeats` shows the spread over
//!   seeds.
//! - Effort is counted, not timed (see [`budget`]): results are the same bytes on any number of
//!   threads, on an idle or a busy machine, unless a time limit (`--certify-seconds`,
//!   `--complete-seconds`) ends a proof.
//! - For two tiles with 16,384 pairs of magnets and more (128 each), distant groups of point dipoles
//!   are replaced by fewer dipoles, with a proved error, and the field of one tile's blocks is
//!   tabulated, with an error measured in tests. Discs, upright and shielded magnets are neither
//!   grouped nor tabulated; their cost is proportional to the number of pairs. From about 64 magnets per
//!   face on, surveys take long in any case, up to hours for hundreds of magnets: there are many
//!   states, and the motions that join them are followed to a fraction of the pitch.
//! - Curves are polygons: chords deviate from arcs and sine waves by up to a hundredth of their
//!   depth, and from drawn curves by up to 1/2150 of the drawn shape (0.2 mm for a tile of 43 cm).
//!   This changes the energy of shallow states, where two curved faces touch beside their bond, by
//!   some per cent.
//! - Drawings: clip paths, masks, and style sheets that move or hide shapes are reported, not read
//!   (`<use>`, `<symbol>` and nested `<svg>` are read); a tile has one outline without holes and at
//!   most 64 faces.
//! - TopSearch's files have one transition state between two kinds of state, the lowest.
//! - Barriers and lists of states are not certified for the nearest-face rule, whose energy is
//!   discontinuous. `words` and `crosstalk` take all magnets, but no shields.
//! - Overdamped capture has neither inertia nor shaking. `tilebind dock` moves tiles with inertia,
//!   contact and drag.
//! - Magnets and tiles stay in one plane: there is no tilting and no lifting. Iron is a shield behind
//!   a face's magnets, a factor of their energy that is to be calibrated; it is not magnetised
//!   itself.
//! - Bounds of very small barriers, and of barriers that took more than 20 000 additional cells,
//!   stay wider than a twentieth of the barrier; `tilebind barrier --tolerance` narrows a single
//!   one.
//! - Edges of blocks in contact are checked at their midpoints, not bounded: the guarantee for them
//!   is the certificate.
//! - Uncertified barriers (minor traps in `compare` and `sweep`) are upper estimates; moving tiles
//!   found some of them too high. Bounds behind shields are wider for blocks than for dipoles. An
//!   escape is the lowest certified path to the bond, to `free` or to the lower state that is
//!   nearest in the roadmap; nothing is proved about other lower states.
//! - Docking shares depend on the restitution more than on anything else: of the paper's tile 8.0 %
//!   of 20,000 runs of `tilebind dock` bind at 0.01 and 5.5 % at 0.1 (both within 0.4 %). The
//!   restitution of real tiles has not been measured.
//!
//! # Working on it
//!
//! `cargo check --all-targets` reports mistakes within seconds. `cargo run --profile quick --
//! analyse ...` and `cargo test --profile quick --test landscape -- seam` build incrementally (into
//! `target/quick`); the program is then half as fast as a release build, so measure the latter. A
//! release build takes 8 s after an edit in `src/cli`, 26 s after one in `src/report` and 88 s
//! after one in `src/landscape` (two cores).
//!
//! `cargo test --release -- --ignored` runs the tests that take minutes; `.ci/run` does so as well.
//!
//! After a change that is meant to change results, `results/make.py PART` rebuilds that part of
//! `results`, together with the tables and the block of output in the READMEs.
//!
//! `tests/fuzz/run.sh 3600 design` fuzzes the reader of designs for an hour; `drawing`, `tileset`,
//! `words`, `plan` and `table` fuzz those of drawings, tile sets, sets of words, manifests of
//! sweeps and tables, `start` and `part` those of starts and parts of tables, `gaps` fits of magnets,
//! `analyse` whole analyses of small designs, and `bounds` compares the bounds of energies over cells
//! with plain interval arithmetic. It is built separately, with its own compiler flags. `cargo mutants
//! --file 'src/landscape/roadmap/**'` finds changes of the code that no test notices
//! (`.cargo/mutants.toml`). `.ci/deny` checks the dependencies against `.ci/deny.toml`.
//! `rust-version` in `Cargo.toml` is what the dependencies state; a compiler that old has not been
//! tried.
//!
//! # Version, history and packages
//!
//! The version is in `Cargo.toml` under `[workspace.package]`; the program, the results' files, the
//! crates and the Python package take it from there (the crates repeat it where they depend on each
//! other, and cargo refuses a different one). A sweep can be continued only with the version that
//! planned it. `tilebind --version --verbose` also prints what to cite.
//!
//! | version | changes for users |
//! |---|---|
//! | 0.1.0, in work | Magnets are blocks unless the design says `[potential] model = "dipole"` (before: dipoles). `dock`, `compare` and `sweep` write `report.json`, as all commands do (before: `dock.json`, `compare.json`, `sweep.json`). `analyse --arrays` is gone: Python has the same as arrays. All points of a sweep have the sweep's seed (before: seeds derived from their names); start sweeps from before anew; contacts equal to the target are the bond (before: traps), `[target] only = true` restores the stated contact alone; two equal tiles are one kind on a table, called `tile` (before: `fixed` and `moving`); rates and exits have estimated errors in place of bounds, which excluded the error of the mesh: `rates --certify`, `lower_per_s`, `upper_per_s`, `leaving_bounds_per_s` and `mean_exit_midway` are gone, `mean_exit_bounds_s` is null; on x86-64 a processor needs AVX2 (before: any), and `TILEBIND_KERNEL=portable` the feature `portable` |
//!
//! `results/bench.csv` is the history of the benches; everything else is in the log of the
//! repository.
//!
//! `cargo package --workspace --exclude tilebind-python` packs the crates, which belong
//! together, without results, tests and benches; `maturin sdist` packs the Python package.
//! `tests/package/run.sh` does both and checks their contents and that each is below 2 MB;
//! `tests/package/run.sh install` also installs the program with cargo and the Python package with
//! pip from these packages, and runs them. From a checkout: `cargo install --path .` and `pip
//! install .`.

pub use jobs::{
    Analysis, Design, Refused, assembly, bond, calibration, checksum, comparison, design, docking,
    inspection, matching, memory, output, pipeline, query, rates, request, search, start, sweep,
    table, text, tolerance, verification, word_sets, workshop, yields,
};
pub use physics::table as many_bodies;
pub use physics::{
    Configuration, ConfigurationSpace, Problem, budget, cell, configuration, contact, dynamics,
    interruption, kinetics, landscape, observer, parallel, potential, problem, roadmap, tile,
    units, words,
};
pub use report;

#[doc = include_str!("examples.md")]
pub mod examples {}

#[doc = include_str!("paper.md")]
pub mod paper {}
