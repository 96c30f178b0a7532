//! How a run goes on.

use super::run::{Ending, RunError};
use crate::observer::Flow;

/// What to do after a burst of steps. All that depends on the wall clock, on signals and on the outcome of steps and observers
/// comes together here, and nowhere else in the loop: processes that share a run must decide alike, which they do when each
/// combines the decisions of all by [`Decision::agree`], in any order. Whoever runs the loop saves the state at its end, so that the decision to end
/// it is the decision to save.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decision {
    /// Take so many steps, at least one.
    GoOn {
        /// Number of steps.
        steps: u64,
    },
    /// The segment ends here.
    End(Ending),
    /// A solver or an observer failed.
    Fail,
}

impl Decision {
    /// From what came of the last steps and of the observers after them, the steps to take at most, those that are left of
    /// the segment, and whether the run is interrupted.
    pub(super) fn of(seen: &Result<Flow, RunError>, steps: u64, left: u64, is_interrupted: bool) -> Self {
        let of_observers = match seen {
            Err(_) => Self::Fail,
            Ok(Flow::Stop) => Self::End(Ending::Stopped),
            Ok(Flow::Continue) => Self::GoOn { steps },
        };
        let of_segment = if left == 0 { Self::End(Ending::Finished) } else { Self::GoOn { steps: left } };
        let of_signal = if is_interrupted { Self::End(Ending::Interrupted) } else { of_segment };
        of_observers.agree(of_segment).agree(of_signal)
    }

    /// What is done when there is reason to do this and that: what weighs more, and the fewer steps.
    fn agree(self, other: Self) -> Self {
        match (self, other) {
            (Self::GoOn { steps }, Self::GoOn { steps: others }) => Self::GoOn { steps: steps.min(others) },
            _ if self.weight() >= other.weight() => self,
            _ => other,
        }
    }

    fn weight(self) -> u8 {
        match self {
            Self::GoOn { .. } => 0,
            Self::End(Ending::Interrupted) => 1,
            Self::End(Ending::Finished) => 2,
            Self::End(Ending::Stopped) => 3,
            Self::Fail => 4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::StepError;

    const ALL: [Decision; 6] = [
        Decision::GoOn { steps: 3 },
        Decision::GoOn { steps: 7 },
        Decision::End(Ending::Interrupted),
        Decision::End(Ending::Finished),
        Decision::End(Ending::Stopped),
        Decision::Fail,
    ];

    #[test]
    fn processes_agree_in_whatever_order_they_are_asked() {
        for a in ALL {
            assert_eq!(a.agree(a), a);
            for b in ALL {
                assert_eq!(a.agree(b), b.agree(a));
                for c in ALL {
                    assert_eq!(a.agree(b).agree(c), a.agree(b.agree(c)));
                }
            }
        }
        assert_eq!(ALL[0].agree(ALL[1]), ALL[0]);
        for pair in ALL[1..].windows(2) {
            assert_eq!(pair[0].agree(pair[1]), pair[1]);
        }
    }

    /// What a process would do that is told everything that several were told.
    #[test]
    fn the_agreement_is_what_one_process_would_do_that_knew_all() {
        let failed = || Err(RunError::Step(StepError::Step { dt: 1.0, why: "of the test".to_owned() }));
        let seen = [|| Ok(Flow::Continue), || Ok(Flow::Stop)];
        for (own, other) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            for [first, second] in [[false, false], [true, false], [false, true]] {
                let decide =
                    |which: usize, steps, interrupted| Decision::of(&seen[which](), steps, 5, interrupted);
                let agreed = decide(own, 4, first).agree(decide(other, 9, second));
                assert_eq!(agreed, decide(own.max(other), 4, first || second));
                assert_eq!(agreed.agree(Decision::of(&failed(), 4, 5, first)), Decision::Fail);
            }
        }
        assert_eq!(Decision::of(&Ok(Flow::Continue), 9, 5, false), Decision::GoOn { steps: 5 });
        // A segment that is over has not been interrupted.
        assert_eq!(Decision::of(&Ok(Flow::Continue), 9, 0, true), Decision::End(Ending::Finished));
    }
}
