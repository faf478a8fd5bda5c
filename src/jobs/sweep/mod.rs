//! Sweeps: keys of a design are varied, and every resulting design is assessed.
//!
//! A [`Plan`] holds all that decides a sweep: the text of the designs, the varied keys with their
//! values, the settings and the seed. Each of its [`Point`]s is a design of its own and is named
//! after it: the name is a hash of the design as it is assessed, with its drawings, of the settings
//! and of the version of tilebind; the seed of its random numbers comes from the name. So a point's
//! result depends neither on the other points nor on when, where and beside which others it is
//! worked on. [`Request::refined`] adds points where the
//! figures bend.
//!
//! Points hand nothing on to each other, though neighbours are much alike: in the study in
//! `results/README.md` the bounds of barriers take a twentieth of the time, even without the proof of
//! completeness, which is all that known pathways could save. States would have to be looked for all
//! the same, as they come and go along a sweep; captures and the proof of completeness depend on
//! every outline and moment. A point that waited for another could not be worked on elsewhere.
//!
//! A [`Store`] keeps one file a point. It is written under a temporary name, synced and renamed:
//! whenever the work is stopped, by whatever means, a point's file is there as a whole or not at
//! all, and the work goes on with the points that have none. [`run`] works on points; the merged
//! tables are made from the files alone and hold no times, so that they
//! are the same bytes however the work was divided.
//!
//! A design that is impossible at some value is an [`Outcome`] like any other, with the reason.
//!
//! # On a cluster
//!
//! A sweep divides into parts that know nothing of each other: plan it, work on its parts wherever
//! there is a core, merge.
//!
//! ```sh
//! tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0:0.046:24 \
//!     --plan target/depths/plan.json
//! sbatch --array=1-8 tests/slurm/sweep.sbatch target/depths/plan.json
//! tilebind sweep --status target/depths/plan.json
//! tilebind sweep --merge target/depths/plan.json
//! ```
//!
//! `tests/slurm/sweep.sbatch` works on one part a task. `tilebind` must be on the `PATH` and the
//! sweep's folder on a file system that all nodes share. Array numbers start from 1; submit the
//! whole array, from the folder in which the sweep was planned. An array that was cancelled or ran
//! out of time is submitted again as it was, or with another number of tasks: finished points stay.
//! `--merge` writes the bytes that the same sweep in one process writes.
//!
//! The same with GNU parallel, on one machine:
//!
//! ```sh
//! parallel -j 2 tilebind sweep --run target/depths/plan.json --shard {}/8 --threads 1 ::: $(seq 8)
//! tilebind sweep --merge target/depths/plan.json
//! ```
//!
//! `tests/slurm/run.sh target/release/tilebind` (as root) tries the job array on a real Slurm with
//! two nodes on this machine: cancelled half-way, submitted again, merged and compared byte for byte
//! with the sweep in one process. Where Slurm cannot be installed it says so and skips.

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
pub use point::Point;
pub use request::Request;
pub use run::run;
pub use source::Source;
pub use store::{Outcome, Progress, Store};
pub use vary::{Axis, Value};
