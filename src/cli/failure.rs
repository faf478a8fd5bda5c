//! The errors that end a command, and their exit status.

use std::fmt::Display;
use std::io;
use std::process::ExitCode;

use tilebind::Refused;
use tilebind::comparison::Assessment;
use tilebind::design::DesignError;
use tilebind::output::OutputError;
use tilebind::report::plots::PictureError;
use tilebind::request::Unanswered;

use super::tell;

/// Exit status if the command line or a design file is wrong.
pub const WRONG: u8 = 2;
/// Exit status of an interrupted command (`EX_TEMPFAIL` of sysexits.h).
pub const INTERRUPTED: u8 = 75;

/// Why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The command line or a design file is wrong: status 2.
    Usage(String),
    /// The run failed: status 1.
    Run(String),
    /// The output was closed by its reader: not a failure, status 0.
    OutputClosed,
}

impl Failure {
    /// The command line or a design file is wrong.
    pub fn usage(error: impl Display) -> Self {
        Self::Usage(error.to_string())
    }

    /// The run failed.
    pub fn run(error: impl Display) -> Self {
        Self::Run(error.to_string())
    }

    /// From the error of a job.
    pub fn of(error: impl Unanswered) -> Self {
        match error.is_of_the_question() {
            true => Self::usage(error),
            false => Self::run(error),
        }
    }

    /// Prints the message and returns the exit status.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Usage(message) => {
                tell(format!("error: {message}"));
                ExitCode::from(WRONG)
            }
            Self::Run(message) => {
                tell(format!("error: {message}"));
                ExitCode::from(1)
            }
            Self::OutputClosed => ExitCode::SUCCESS,
        }
    }
}

/// Reports barriers of several named designs that moving tiles refute: contradictions fail the run,
/// overestimates are only noted.
pub fn tell_refuted(assessments: &[(String, &Assessment)]) -> Result<(), Failure> {
    let mut contradictions = Vec::new();
    for (name, one) in assessments {
        for description in &one.overestimates {
            tell(format!("note: {name}: {description}"));
        }
        let descriptions = one.contradictions.iter();
        contradictions.extend(descriptions.map(|description| format!("{name}: {description}")));
    }
    fail_if_contradicted(contradictions.into_iter())
}

/// Fails the run if moving tiles contradict barriers; its results are written nevertheless.
pub fn fail_if_contradicted(contradictions: impl Iterator<Item = String>) -> Result<(), Failure> {
    let all: Vec<String> = contradictions.collect();
    match all.is_empty() {
        true => Ok(()),
        false => Err(Failure::Run(all.join("\n"))),
    }
}

impl From<DesignError> for Failure {
    fn from(error: DesignError) -> Self {
        Self::Usage(error.to_string())
    }
}

impl From<Refused> for Failure {
    fn from(why: Refused) -> Self {
        Self::usage(why)
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        match error {
            OutputError::Refused(message) => Self::Usage(message),
            _ => Self::Run(error.to_string()),
        }
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        Self::Run(error.to_string())
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::OutputClosed,
            _ => Self::Run(format!("cannot write the results: {error}")),
        }
    }
}
