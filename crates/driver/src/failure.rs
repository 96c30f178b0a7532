//! Why a command failed, and the exit code that says so.

use crate::scene_file::SceneProblem;
use granular_core::{RunError, SnapshotError, StepError};
use granular_io::IoError;
use granular_tessellate::TessellationError;
use std::fmt;

/// Why a command failed.
#[derive(Debug)]
#[non_exhaustive]
pub enum Failure {
    /// The scene is wrong: exit code 2.
    Scene(Vec<SceneProblem>),
    /// The stability check refuses the scene: exit code 3.
    Refused(Vec<String>),
    /// A guard stopped the run: exit code 4.
    Stopped {
        /// What the guard met.
        reason: String,
        /// How to look at it or go on.
        hint: String,
    },
    /// Something could not be read or written: exit code 5.
    Io(String),
    /// The user or the system interrupted the run, which can be resumed: 128 plus the signal.
    Interrupted {
        /// Signal number.
        signal: usize,
        /// How to resume.
        hint: String,
    },
    /// The user or the system interrupted a command before it had anything to save: 128 plus the signal.
    NotBegun {
        /// Signal number.
        signal: usize,
    },
    /// Runs of a sweep failed: the exit code is that of the first of them.
    Runs {
        /// That exit code.
        code: u8,
        /// Which runs, and why.
        reason: String,
    },
    /// A gating row of a validation failed: exit code 1.
    Invalid(String),
}

impl Failure {
    /// Exit code of the command.
    pub fn code(&self) -> u8 {
        match self {
            Self::Invalid(_) => 1,
            Self::Scene(_) => 2,
            Self::Refused(_) => 3,
            Self::Stopped { .. } => 4,
            Self::Io(_) => 5,
            Self::Runs { code, .. } => *code,
            Self::Interrupted { signal, .. } | Self::NotBegun { signal } => 128 + (*signal as u8 & 0x7f),
        }
    }

    /// The failure as text, as it is displayed, but in colour for a terminal.
    pub fn in_colour(&self) -> String {
        match self {
            Self::Scene(problems) => {
                problems.iter().map(SceneProblem::in_colour).collect::<Vec<_>>().join("\n\n")
            }
            other => other.to_string(),
        }
    }

    /// A failure of the file system.
    pub fn io(place: impl fmt::Display, reason: impl fmt::Display) -> Self {
        Self::Io(format!("{place}: {reason}"))
    }

    /// The same failure, told what was tried.
    #[must_use]
    pub(crate) fn with_context(self, what: impl fmt::Display) -> Self {
        match self {
            Self::Io(reason) => Self::Io(format!("{what}: {reason}")),
            other => other,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(problems) => {
                let texts: Vec<String> = problems.iter().map(SceneProblem::to_string).collect();
                f.write_str(&texts.join("\n\n"))
            }
            Self::Refused(reasons) => write!(f, "refused: {}", reasons.join("\nrefused: ")),
            Self::Stopped { reason, hint } => write!(f, "stopped: {reason}\n  = help: {hint}"),
            Self::Runs { reason, .. } => f.write_str(reason),
            Self::Io(reason) => write!(f, "error: {reason}"),
            Self::Interrupted { hint, .. } => write!(f, "interrupted: the state is saved\n  = help: {hint}"),
            Self::NotBegun { .. } => {
                f.write_str("interrupted: there was nothing to save\n  = help: give the same command again")
            }
            Self::Invalid(reason) => write!(f, "invalid: {reason}"),
        }
    }
}

impl std::error::Error for Failure {}

impl From<SceneProblem> for Failure {
    fn from(problem: SceneProblem) -> Self {
        Self::Scene(vec![problem])
    }
}

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        Self::Io(error.to_string())
    }
}

impl From<SnapshotError> for Failure {
    fn from(error: SnapshotError) -> Self {
        Self::Io(error.to_string())
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        let hint = "`granular check` shows the limits of the scene".to_owned();
        Self::Stopped { reason: error.to_string(), hint }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Step(error) => error.into(),
            other => Self::Io(other.to_string()),
        }
    }
}

impl From<TessellationError> for Failure {
    fn from(error: TessellationError) -> Self {
        Self::Io(error.to_string())
    }
}
