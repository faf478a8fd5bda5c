//! Errors of sweeps that cannot be planned.

use crate::design::DesignError;
use crate::request::{Misused, Unanswered};

/// Largest number of points of a sweep.
pub(super) const MOST_POINTS: usize = 1_000_000;

/// Why a sweep cannot be planned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A point is not a valid design.
    #[error(transparent)]
    Design(#[from] Box<DesignError>),
    /// A key is varied by two axes.
    #[error("`{0}` is varied twice")]
    Twice(String),
    /// There are too many points.
    #[error("the sweep has {0} points, more than {MOST_POINTS}")]
    TooMany(u128),
    /// Two designs have the same name.
    #[error("two designs are called `{0}`: give them different names")]
    SameName(String),
    /// There is no point with this name.
    #[error("there is no point `{0}`: give varied values, such as `{1}`, or a design's name")]
    NoBaseline(String, String),
    /// The sweep is not a curve to which points can be added.
    #[error(
        "--refine adds points to one varied number of three values or more\n  help: vary one \
         number, such as --vary fixed.faces.east.profile.depth=0:0.04:5"
    )]
    NoCurve,
    /// A range has no number of values.
    #[error(
        "`{0}={1}` does not give the number of values: write {0}={1}:11 for 11 of them, or search \
         all of it with --maximise FIGURE"
    )]
    NoCount(String, String),
    /// A key cannot be varied.
    #[error("`{path}` cannot be varied: {reason}")]
    Unknown {
        /// Its path in the design.
        path: String,
        /// Why not.
        reason: String,
    },
    /// No point is a valid design.
    #[error("none of the {0} points is possible; the first: {1}")]
    NonePossible(usize, String),
    /// No point satisfies the conditions of a search, by energies alone.
    #[error("none of the {0} points satisfies the conditions; the nearest: {1}")]
    NoneFit(usize, String),
    /// A figure that the search needs is not computed.
    #[error(transparent)]
    Unasked(#[from] Misused),
    /// The text is not a manifest.
    #[error("not a manifest of a sweep: {0}")]
    Malformed(String),
    /// The manifest was written by another version.
    #[error("the manifest is from tilebind {0}, this is {here}: plan the sweep again", here = env!("CARGO_PKG_VERSION"))]
    Version(String),
}

impl Unanswered for PlanError {}
