//! Why a text is not a value of the dimension that is expected.

use super::dimension::{Dimension, base_units};
use std::fmt;

/// Why a text is not a value of the expected dimension.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnitError {
    /// The text does not begin with a number.
    NoNumber {
        /// The text.
        text: String,
        /// What is expected.
        expected: Dimension,
    },
    /// The number is not finite, or too large or too small for a double in SI units.
    OutOfRange {
        /// The text.
        text: String,
        /// What is expected.
        expected: Dimension,
    },
    /// No unit has this name.
    UnknownUnit {
        /// The name.
        unit: String,
        /// The unit that was perhaps meant.
        nearest: Option<String>,
        /// What is expected.
        expected: Dimension,
    },
    /// The unit is not written as units are.
    Syntax {
        /// The text.
        text: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The unit measures something else.
    WrongDimension {
        /// The text.
        text: String,
        /// Powers of kg, m, s and rad that were found.
        found: [i8; 4],
        /// What is expected.
        expected: Dimension,
    },
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNumber { text, expected } => {
                write!(f, "`{text}` does not begin with a number; {}", wanted(expected))
            }
            Self::OutOfRange { text, expected } => write!(
                f,
                "`{text}` is not finite, or too large or too small for a computer's number; {}",
                wanted(expected)
            ),
            Self::UnknownUnit { unit, nearest, expected } => match nearest {
                Some(nearest) => write!(f, "unknown unit `{unit}`; did you mean `{nearest}`?"),
                None => write!(f, "unknown unit `{unit}`; {}", wanted(expected)),
            },
            Self::Syntax { text, problem } => write!(f, "`{text}`: {problem}"),
            Self::WrongDimension { text, found, expected } => {
                write!(f, "`{text}` {}, but {}", measures(*found), wanted(expected))
            }
        }
    }
}

impl std::error::Error for UnitError {}

fn wanted(expected: &Dimension) -> String {
    format!("{} such as `{}` is expected", expected.with_article(), expected.example)
}

fn measures(found: [i8; 4]) -> String {
    match Dimension::named(found) {
        Some(found) if found.is_number() => "has no unit".to_owned(),
        Some(found) => format!("is {}", found.with_article()),
        None => format!("is measured in {}", base_units(found)),
    }
}
