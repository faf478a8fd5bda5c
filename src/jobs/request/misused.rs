//! What is wrong with the options of a request.

/// An error in keyword arguments.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Misused {
    /// There is no such argument.
    #[error("there is no argument {0:?}; known: {known}", known = .1.join(", "))]
    Unknown(String, Vec<&'static str>),
    /// An argument has an invalid value, is missing, or is not allowed.
    #[error("{0}")]
    Wrong(String),
}

impl Misused {
    pub(super) fn value(name: &str, text: &str, why: &str) -> Self {
        Self::Wrong(format!("{name} = {text}: {why}"))
    }

    pub(super) fn missing(names: &[&str]) -> Self {
        Self::Wrong(format!("{} is needed", names.join(", ")))
    }
}
