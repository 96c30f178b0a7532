//! What can be wrong with the sites or the domain.

use std::fmt;

/// A diagram that cannot be made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TessellationError {
    /// No site at all, or more than numbers of 31 bits count.
    Count {
        /// Their number.
        sites: usize,
    },
    /// As many radii as centres are needed.
    Radii {
        /// Number of centres.
        sites: usize,
        /// Number of radii.
        radii: usize,
    },
    /// A coordinate or radius that is no number, or too large to be squared twice.
    Site {
        /// Number of the site.
        index: usize,
        /// What is refused.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A domain that is not convex, or empty, or run through clockwise.
    Domain {
        /// Number of the corner at which it turns the wrong way.
        corner: usize,
        /// Coordinates of the corner.
        position: Vec<f64>,
    },
}

impl fmt::Display for TessellationError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { sites } => {
                write!(formatter, "number of sites is {sites}, allowed is 1 to 500000000")
            }
            Self::Radii { sites, radii } => {
                write!(formatter, "number of radii is {radii}, allowed is the number of centres, {sites}")
            }
            Self::Site { index, what, value } => {
                write!(formatter, "{what} of site {index} is {value}, allowed is -1e150 to 1e150")
            }
            Self::Domain { corner, position } => write!(
                formatter,
                "the domain does not turn left at corner {corner}, {position:?}; \
                 allowed is a convex polygon of three corners or more, counter-clockwise"
            ),
        }
    }
}

impl std::error::Error for TessellationError {}
