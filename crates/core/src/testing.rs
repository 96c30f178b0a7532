//! The contract of [`Solver`](crate::Solver) as tests that every solver runs (feature `testing`).
//!
//! [`contract_tests!`](crate::contract_tests) makes one test per promise for whatever a closure
//! builds; [`Contract`] is the same for callers who want the outcome instead of a test.
//!
//! | test | promise |
//! |---|---|
//! | `same_bits_for_any_number_of_threads` | 1, 2, 3 and 8 threads give the same state |
//! | `same_bits_for_any_split_into_calls` | steps may be fused, but not felt |
//! | `same_bits_after_a_restart` | what is not saved does not matter |
//! | `a_damaged_section_is_refused` | missing and wrong entries are errors, never panics |
//! | `a_step_that_makes_no_sense_is_refused` | and leaves the state alone |
//! | `what_is_not_finite_is_reported` | at once or within ten steps |
//! | `steps_do_not_allocate` | none at all after a warm-up |
//! | `limits_are_positive_finite_and_named_once` | the report can be used |
//! | `all_that_can_be_shown_is_shown_once` | with its kind, unit and length |
//! | `a_state_is_passed_on_without_a_copy` | to be hashed, with the bytes that are saved |
//!
//! A solver that takes loads on grains runs [`loads_follow_their_grains`] as well.

mod allocator;
mod contract;
mod damage;
mod limits;
mod loads;
mod passing;
#[cfg(test)]
mod tests;
mod watch;

pub use allocator::CountingAllocator;
#[cfg(test)]
pub(crate) use contract::in_pool;
pub use contract::{Breach, Contract};
pub use loads::loads_follow_their_grains;

/// Makes a module of contract tests for the solver that a closure builds.
///
/// The closure must build the same state each time; it should hold enough for several blocks,
/// and move. The step \[s\] must keep the limits of the solver. Options are methods of
/// [`Contract`](crate::testing::Contract) with one argument:
///
/// ```text
/// #[global_allocator]
/// static ALLOCATOR: CountingAllocator = CountingAllocator::new();
///
/// contract_tests!(frictional_disks, || column(2000), 1e-6, steps = 40, warm_up = 400);
/// ```
#[macro_export]
macro_rules! contract_tests {
    ($name:ident, $build:expr, $dt:expr $(, $option:ident = $value:expr)* $(,)?) => {
        mod $name {
            #[allow(unused_imports)]
            use super::*;
            use $crate::testing::{Breach, Contract};

            fn contract() -> Contract {
                Contract::new($build, $dt)$(.$option($value))*
            }

            #[test]
            fn same_bits_for_any_number_of_threads() -> Result<(), Breach> {
                contract().threads()
            }

            #[test]
            fn same_bits_for_any_split_into_calls() -> Result<(), Breach> {
                contract().split()
            }

            #[test]
            fn same_bits_after_a_restart() -> Result<(), Breach> {
                contract().restart()
            }

            #[test]
            fn a_damaged_section_is_refused() -> Result<(), Breach> {
                contract().damage()
            }

            #[test]
            fn a_step_that_makes_no_sense_is_refused() -> Result<(), Breach> {
                contract().bad_steps()
            }

            #[test]
            fn what_is_not_finite_is_reported() -> Result<(), Breach> {
                contract().not_finite()
            }

            #[test]
            fn steps_do_not_allocate() -> Result<(), Breach> {
                contract().allocations()
            }

            #[test]
            fn limits_are_positive_finite_and_named_once() -> Result<(), Breach> {
                contract().limits()
            }

            #[test]
            fn all_that_can_be_shown_is_shown_once() -> Result<(), Breach> {
                contract().show()
            }

            #[test]
            fn a_state_is_passed_on_without_a_copy() -> Result<(), Breach> {
                contract().passing_on()
            }
        }
    };
}
