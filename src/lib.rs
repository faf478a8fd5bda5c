//! How two magnetic tiles bind.
//!
//! Flat tiles float on an air table and are shaken about; each face carries a barcode of bar
//! magnets and may carry a complementary shape. For a pair of tiles this crate answers how deep the
//! wanted bond is, which wrong bonds trap the tiles, how high the energy barrier is between each of
//! these states and freedom, and by which motion it is crossed. It follows Majumder and Reif,
//! *Barcoded Magnetic Tiles for Programmable Assemblies*: probabilistic roadmaps over
//! (x, y, theta) (section 4.4) and the physics of section 5; `src/paper.md` has the command for each
//! section and figure. SI units everywhere.
//!
//! # What flows where
//!
//! ```text
//! design file -> problem (tiles, potential, contact) -> roadmap -> landscape (states, barriers, proofs)
//!                              \-> dynamics (a check from outside the roadmap)          |
//!                                                                          report <----/
//! ```
//!
//! Four crates stand on each other, so that the compiler holds the floors, and none is compiled anew
//! for an edit in one above it. This one names the public modules of all.
//!
//! | crate, from the ground up | what it holds |
//! |---|---|
//! | `src/physics` | what two tiles do: outlines, contact, energies, roadmaps, landscapes, kinetics, words |
//! | `src/jobs` | from a design file to what is asked of it: analyses, comparisons, sweeps, yields, tile sets |
//! | `src/report` | results as JSON, tables, pictures, pages and text |
//! | `src/main.rs`, `src/cli`; `src/python` | the command line; the Python package |
//!
//! Within a crate, too, imports point one way: a floor uses those below it, and siblings leave each
//! other alone. The front pages of `src/physics/lib.rs`, `src/jobs/lib.rs` and `src/report/lib.rs` list
//! their modules.
//!
//! # What to read first
//!
//! The main job from a file to its report, in ten files and 2,000 lines:
//!
//! 1. `src/cli/analyse.rs` - what a user asks, and where results go;
//! 2. `src/jobs/pipeline/mod.rs` - the whole job on a page;
//! 3. `src/physics/tile/mod.rs` - a tile: outline, faces, magnets;
//! 4. `src/physics/potential/mod.rs` - U(x, y, theta), its gradient and its bounds;
//! 5. `src/physics/roadmap/mod.rs` - milestones, neighbours, motions;
//! 6. `src/physics/landscape/exploration/mod.rs` - minima and the passes between their basins;
//! 7. `src/physics/landscape/catalogue/mod.rs` - the states and barriers that are listed;
//! 8. `src/physics/landscape/minimax/mod.rs` - bounds of barriers by subdivision;
//! 9. `src/physics/landscape/missing_states/mod.rs` - the proof that no state is missing;
//! 10. `src/report/analysis.rs` - what is told of it all.
//!
//! How a result becomes text, JSON, tables, pictures and a page is told in `src/report/document`, how
//! options of the command line are keywords of Python in `src/jobs/request`.
//!
//! The words are the same everywhere: the wanted meeting of the tiles is the *bond*, every other
//! held one a *trap*, far apart is *free*. What else may act between tiles than magnets, and which
//! files that takes, is told in [`potential::interaction`].
//!
//! # Examples and the paper
//!
//! [`examples`] has ten short programs, from loading a design to many tiles on a table; [`paper`]
//! the command for each section and figure of the paper.
//!
//! # Limits
//!
//! - Magnets are blocks where a design says nothing. Point dipoles, the paper's model, are faster and
//!   too weak near contact, or far too strong for thin magnets (see `results/README.md`): results with
//!   them say what blocks have.
//! - A roadmap finds what it samples. States and ways that need very narrow passages can be missed;
//!   the certificate then shows a wide bracket, and `--repeats` shows the spread over seeds.
//! - Work is counted, not timed (see [`budget`]): results are the same bytes on any number of threads,
//!   busy or idle, unless a clock is set (`--certify-seconds`, `--complete-seconds`) and ends a proof.
//! - Tiles of 128 magnets and more: far groups of point dipoles are replaced by fewer, with
//!   a proved error; those of blocks and of shielded magnets are not, and cost by the pair. From some
//!   64 magnets a face on surveys take long all the same, up to hours for hundreds: there are many
//!   states, and the motions that join each of them are followed to a fraction of the pitch.
//! - Curves are polygons: chords leave arcs and sine waves by up to a hundredth of their depth, drawn
//!   curves by up to 1/2150 of the drawn shape, 0.2 mm of a tile of 43 cm. Shallow states where two
//!   curved faces touch beside their bond are off by some per cent for it.
//! - Drawings: style sheets, clip paths, `<use>` and nested `<svg>` are named, not read; a tile has
//!   one outline without holes and at most 64 faces.
//! - TopSearch's files have one transition state between two kinds of state, the lowest.
//! - Barriers of discs, of magnets that stand and of the nearest-face rule, whose energy jumps, are
//!   not certified.
//! - Overdamped capture is not tossing and turning: no inertia and no shaking. `tilebind dock`
//!   moves tiles with inertia, contact and drag.
//! - Magnets and tiles stay in one plane; no tilting, no lifting, no iron in `analyse`.
//! - Bounds of very small barriers, and of barriers that took more than 20 000 further cells, stay
//!   wider than a twentieth of the barrier; `tilebind barrier --tolerance` narrows a single one.
//! - Edges of blocks in contact are checked in their middle, not bounded: their guarantee is the
//!   certificate's.
//! - Barriers that are not certified (minor traps in `compare` and `sweep`, shielded blocks) are
//!   upper estimates; moving tiles found some of them too high. An escape is the lowest certified
//!   way to the bond, to `free` or to the lower state that the roadmap found nearest; of other
//!   lower states nothing is proved.
//! - Docking shares depend on the restitution more than on anything else: 9.7 % at 0.01, 6.9 % at
//!   0.1, and no bounce of real tiles has been measured.
//!
//! # Working on it
//!
//! `cargo check --all-targets` tells of mistakes within seconds; `cargo run --profile quick --
//! analyse ...` and `cargo test --profile quick --test landscape -- seam` build incrementally (into
//! `target/quick`).
//! A release build takes 8 s after an edit in `src/cli`, 26 s after one in `src/report` and 75 s after
//! one in `src/physics` (two cores).
//! The program is then half as fast as a release build, which is the one to measure.
//!
//! What the program gives differs after a change that is meant to change it: `results/make.py PART`
//! makes that part of `results` anew, and the tables and the block of output in the READMEs with it.
//!
//! `tests/fuzz/run.sh 3600 design` fuzzes the reader of designs for an hour, `drawing`, `tileset`,
//! `words`, `plan` and `table` those of drawings, tile sets, sets of words, manifests of sweeps and
//! tables, and `bounds` compares the energies' bounds over cells with interval arithmetic of
//! `inari`; it is built apart, with compiler flags of its own. `cargo mutants --file
//! 'src/physics/roadmap/**'` asks which changes of the code no test notices (`.cargo/mutants.toml`).
//! `.ci/deny` holds the dependencies to `.ci/deny.toml`. `rust-version` in `Cargo.toml` is what the
//! dependencies state; a compiler that old has not been tried.
//!
//! # Version, history and packages
//!
//! The version stands in `Cargo.toml` under `[workspace.package]`; the program, the results' files,
//! the crates and the Python package take it from there (the crates name it once more where they
//! depend on each other, and cargo refuses another one). A sweep goes on only with the version that
//! planned it. `tilebind --version --verbose` prints what to cite beside it.
//!
//! | version | what changed for users |
//! |---|---|
//! | 0.1.0, in work | Magnets are blocks unless the design says `[potential] model = "dipole"` (before: dipoles). `dock`, `compare` and `sweep` write `report.json`, as all commands do (before: `dock.json`, `compare.json`, `sweep.json`). `analyse --arrays` is gone: Python has the same as arrays |
//!
//! `results/bench.csv` is the history of the benches. All else is in the log of the repository.
//!
//! `cargo package --workspace --exclude tilebind-python` packs the four crates, which belong
//! together, without results, tests and benches; `maturin sdist` the Python package.
//! `tests/package/run.sh` does both and checks what is in them and that either is below 2 MB;
//! `tests/package/run.sh install` also installs the program with cargo and the Python package with
//! pip from what was packed, and runs them. From a checkout: `cargo install --path .` and
//! `pip install .`.

pub use jobs::{
    Analysis, Design, Refused, Settings, assembly, bond, calibration, checksum, comparison, design,
    docking, inspection, matching, memory, output, pipeline, query, rates, request, start, sweep,
    table, text, word_sets, workshop, yields,
};
pub use physics::table as many_bodies;
pub use physics::{
    Configuration, ConfigurationSpace, Problem, budget, cell, configuration, contact, dynamics,
    interruption, kinetics, landscape, observer, potential, problem, roadmap, tile, units, words,
};
pub use report;

#[doc = include_str!("examples.md")]
pub mod examples {}

#[doc = include_str!("paper.md")]
pub mod paper {}
