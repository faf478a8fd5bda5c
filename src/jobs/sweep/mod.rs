//! Sweeps: keys of a design are varied, and every resulting design is assessed.
//!
//! A [`Plan`] contains all inputs of a sweep: the text of the designs, the varied keys with their
//! values, the settings and the seed. Each of its [`SweepPoint`]s is a design of its own. A point's name
//! is a hash of the design as assessed, with its drawings, of the settings, of the seed and of the
//! version of tilebind. So a point's result does not depend on the other points, or on when and
//! where it is computed. [`Request::refined`] adds points where the curves bend.
//!
//! All points have the same seed. Their far starts have the same directions and angles, and the same
//! places in the ring, whose inner radius depends on the tiles (common random numbers): shares of
//! neighbouring points differ by their designs, and much less by chance than their intervals say.
//! `analyse` and `compare` with this seed and these settings give the same figures.
//!
//! Points share no results, although neighbouring points are similar. Known pathways could only
//! save the bounds of barriers, which take a twentieth of the time in the study in
//! `results/README.md`, even without the proof of completeness. States must be searched at each
//! point, as they appear and vanish along a sweep; captures and the proof of completeness depend on
//! every outline and moment. And a point that depends on another could not be computed elsewhere.
//!
//! A [`Store`] keeps one file per point. It is written under a temporary name, synced and renamed:
//! whenever and however the work is stopped, a point's file is complete or absent, and the work
//! resumes with the points without a file. [`run`] computes points. The merged tables are made only
//! from the files and contain no times, so they are the same bytes however the work was divided.
//!
//! A design that is impossible at some value is an [`Outcome`] like any other, with the reason.
//!
//! # On a cluster
//!
//! A sweep can be divided into independent parts: plan it, compute its parts on any cores, merge.
//!
//! ```sh
//! tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0:0.046:24 \
//!     --plan target/depths/plan.json
//! sbatch --array=1-8 tests/slurm/sweep.sbatch target/depths/plan.json
//! tilebind sweep --status target/depths/plan.json
//! tilebind sweep --merge target/depths/plan.json
//! ```
//!
//! `tests/slurm/sweep.sbatch` computes one part per task. `tilebind` must be on the `PATH`, and the
//! sweep's folder on a file system shared by all nodes. Array indices start at 1; submit the whole
//! array from the folder in which the sweep was planned. If an array was cancelled or ran out of
//! time, submit it again, with the same or another number of tasks: finished points are kept.
//! `--merge` writes the same bytes as the sweep in one process.
//!
//! The same with GNU parallel, on one machine:
//!
//! ```sh
//! parallel -j 2 tilebind sweep --run target/depths/plan.json --shard {}/8 --threads 1 ::: $(seq 8)
//! tilebind sweep --merge target/depths/plan.json
//! ```
//!
//! `tests/slurm/run.sh target/release/tilebind` (as root) tests the job array on a real Slurm with
//! two nodes on this machine: it is cancelled half-way, submitted again, merged and compared byte
//! for byte with the sweep in one process. If Slurm cannot be installed, the test says so and is
//! skipped.

mod document;
mod drawings;
mod error;
mod plan;
mod point;
mod refine;
mod request;
mod run;
mod source;
mod store;
mod vary;

pub use crate::request::Shard;
pub use error::PlanError;
pub use plan::Plan;
pub use point::SweepPoint;
pub use request::Request;
pub use run::run;
pub use source::DesignSource;
pub use store::{Outcome, Progress, Store};
pub(crate) use vary::rounded;
pub use vary::{Axis, Value};
