//! Why a job is not done: what was asked for, or a file that is read for it.

use crate::design::DesignError;

/// Why a job is not done.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Refused {
    /// A file is at fault.
    #[error(transparent)]
    File(#[from] DesignError),
    /// What was asked for is impossible, and why.
    #[error("{0}")]
    Asked(String),
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self::Asked(message)
    }
}
