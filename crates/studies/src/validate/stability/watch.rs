//! Steps a flow and sees to it that the solver notices when it blows up.

use granular_core::StepError;

/// Steps between looks at the fields. Twice as many are the steps within which a blow-up must be noticed.
pub(crate) const BURST: u64 = 5;

/// Said of a blow-up that was noticed in time, but for which a cell is named whose density makes sense.
pub(crate) const MISNAMED: &str = ", so it is another cell that blew up";

/// What is stepped and looked at.
pub(crate) trait Watched {
    /// Advances by so many steps.
    fn advance(&mut self, steps: u64) -> Result<(), StepError>;
    /// What is wrong with the fields that are shown, if anything.
    fn nonsense(&self) -> Option<String>;
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum End {
    /// It took all its steps.
    Finished,
    /// The guard of the solver stopped it, and said why.
    Stopped(String),
    /// The fields made no sense and the solver went on, or gave up without naming what it met.
    Missed(String),
}

/// Takes so many steps, or as many as the guard lets pass.
pub(crate) fn watch(flow: &mut impl Watched, steps: u64) -> End {
    let mut taken = 0;
    while taken < steps {
        if let Err(error) = flow.advance(BURST) {
            return named(&error);
        }
        taken += BURST;
        if let Some(nonsense) = flow.nonsense() {
            // It began within the last burst: one more, and ten steps are over.
            return match flow.advance(BURST) {
                Err(error) => named(&error),
                Ok(()) => End::Missed(format!(
                    "{nonsense} at step {taken}, and the guard says nothing for {BURST} steps more"
                )),
            };
        }
    }
    End::Finished
}

/// A guard says what it met and where; anything else is a guard that failed.
fn named(error: &StepError) -> End {
    match error {
        StepError::TooStiff { what, value, allowed, .. } => {
            // What is no further off than is allowed is no reason to stop.
            let blame = if value < allowed { MISNAMED } else { "" };
            End::Stopped(format!("{what}: {value:.3} where {allowed} is allowed{blame}"))
        }
        StepError::NotFinite { .. } => End::Stopped(error.to_string()),
        other => End::Missed(format!("the guard names nothing: {other}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes no sense from a step on, and is noticed at another one.
    struct Synthetic {
        steps: u64,
        nonsense_from: u64,
        noticed_at: u64,
    }

    impl Watched for Synthetic {
        fn advance(&mut self, steps: u64) -> Result<(), StepError> {
            self.steps += steps;
            if self.steps < self.noticed_at {
                return Ok(());
            }
            Err(StepError::NotFinite {
                solver: "synthetic",
                quantity: "density",
                id: 7,
                step: self.noticed_at,
            })
        }

        fn nonsense(&self) -> Option<String> {
            (self.steps >= self.nonsense_from).then(|| "the density is not a number".to_owned())
        }
    }

    fn end(nonsense_from: u64, noticed_at: u64) -> End {
        watch(&mut Synthetic { steps: 0, nonsense_from, noticed_at }, 100)
    }

    #[test]
    fn a_guard_that_is_silent_for_ten_steps_is_told() {
        assert_eq!(end(u64::MAX, u64::MAX), End::Finished);
        assert!(matches!(end(33, 33), End::Stopped(_)));
        assert!(matches!(end(33, 40), End::Stopped(_)));
        assert!(matches!(end(33, 44), End::Missed(_)), "{:?}", end(33, 44));
        assert!(matches!(end(33, u64::MAX), End::Missed(_)));
        // Nonsense in the last steps counts too.
        assert!(matches!(end(100, u64::MAX), End::Missed(_)));
    }

    #[test]
    fn a_sane_cell_that_is_blamed_is_told() {
        let error = |value| StepError::TooStiff {
            what: "distance of the density from that at rest".to_owned(),
            value,
            allowed: 0.5,
            hint: String::new(),
        };
        let is_misnamed = |value| match named(&error(value)) {
            End::Stopped(why) => why.ends_with(MISNAMED),
            other => panic!("{other:?}"),
        };
        assert!(is_misnamed(0.002) && !is_misnamed(0.6) && !is_misnamed(0.5) && !is_misnamed(f64::NAN));
    }

    #[test]
    fn an_error_that_names_nothing_is_no_guard() {
        struct Refuses;
        impl Watched for Refuses {
            fn advance(&mut self, _: u64) -> Result<(), StepError> {
                Err(StepError::Step { dt: 1.0, why: "it is another one".to_owned() })
            }
            fn nonsense(&self) -> Option<String> {
                None
            }
        }
        assert!(matches!(watch(&mut Refuses, 10), End::Missed(_)));
    }
}
