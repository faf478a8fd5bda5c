//! Errors of requests that cannot be carried out: in the request itself or in a file it names.

use crate::design::DesignError;

/// Why a job cannot be carried out.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Refused {
    /// A file is at fault.
    #[error(transparent)]
    File(#[from] DesignError),
    /// The request is impossible, with the reason.
    #[error("{0}")]
    Asked(String),
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self::Asked(message)
    }
}
