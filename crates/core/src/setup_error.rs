//! Why what a solver is made of is refused.

/// Why a set-up is refused.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupError {
    /// What is wrong.
    pub what: String,
    /// The value given.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

impl SetupError {
    /// That `what` is `value`, but must be `allowed`.
    pub fn new(what: impl Into<String>, value: f64, allowed: &'static str) -> Self {
        Self { what: what.into(), value, allowed }
    }

    /// The same, said of something: "radius" becomes "radius of wall `floor`".
    pub fn of(self, owner: impl std::fmt::Display) -> Self {
        Self { what: format!("{} of {owner}", self.what), ..self }
    }
}

impl std::fmt::Display for SetupError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { what, value, allowed } = self;
        // No rows of zeros.
        if value.is_normal() && (1e-9..1e12).contains(&value.abs()) || *value == 0.0 || !value.is_finite() {
            write!(f, "{what} is {value}, but must be {allowed}")
        } else {
            write!(f, "{what} is {value:e}, but must be {allowed}")
        }
    }
}

impl std::error::Error for SetupError {}
