//! The contract holds for a toy solver, and is seen to break for toys that break one promise.

mod toy;

use super::{Breach, Contract, CountingAllocator};
use toy::{Fault, Toy};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator::new();

crate::contract_tests!(a_sound_toy, || Toy::new(None), 0.01, steps = 20);

type Test = fn(&Contract) -> Result<(), Breach>;

const TESTS: &[Test] = &[
    Contract::threads,
    Contract::split,
    Contract::restart,
    Contract::damage,
    Contract::bad_steps,
    Contract::not_finite,
    Contract::allocations,
    Contract::limits,
    Contract::show,
];

/// Tests that the toy with this fault does not pass, by their place in [`TESTS`].
fn caught(fault: Fault) -> Vec<usize> {
    let contract = Contract::new(move || Toy::new(Some(fault)), 0.01).steps(20);
    (0..TESTS.len()).filter(|&k| TESTS[k](&contract).is_err()).collect()
}

#[test]
fn every_fault_is_caught_by_the_test_of_its_promise_and_no_other() {
    let expected = [
        (Fault::FeelsThreads, 0),
        (Fault::FeelsCalls, 1),
        (Fault::ForgetsState, 2),
        (Fault::AcceptsMissing, 3),
        (Fault::AcceptsAnyLength, 3),
        (Fault::PanicsOnDamage, 3),
        (Fault::NamesTheWrongEntry, 3),
        (Fault::AcceptsBadSteps, 4),
        (Fault::ChangesBeforeRefusing, 4),
        (Fault::HidesNan, 5),
        (Fault::Allocates, 6),
        (Fault::AllocatesPerCall, 6),
        (Fault::ZeroLimit, 7),
        (Fault::InfiniteLimit, 7),
        (Fault::SameLimitTwice, 7),
        (Fault::LimitBelowTheStep, 7),
        (Fault::ForgetsToShow, 8),
        (Fault::ShowsTwice, 8),
        (Fault::ShowsUnasked, 8),
        (Fault::ShowsAnotherKind, 8),
        (Fault::ShowsAnotherUnit, 8),
        (Fault::ShowsTooFew, 8),
        (Fault::SameNameTwice, 8),
        (Fault::LinksToNowhere, 8),
    ];
    for (fault, test) in expected {
        assert_eq!(caught(fault), [test], "{fault:?}");
    }
}

#[test]
fn a_solver_that_stands_still_or_fails_is_no_evidence() {
    let still = Contract::new(|| Toy::new(Some(Fault::StandsStill)), 0.01);
    assert!(still.threads().unwrap_err().found.contains("nothing changes"));
    let failing = Contract::new(|| Toy::new(Some(Fault::Fails)), 0.01);
    for test in TESTS {
        assert!(test(&failing).unwrap_err().found.contains("a step failed"));
    }
}

#[test]
fn a_breach_says_where() {
    let contract = Contract::new(|| Toy::new(Some(Fault::FeelsThreads)), 0.01);
    let breach = contract.threads().unwrap_err();
    assert!(breach.to_string().contains("2 threads and one differ in `velocity` from byte"), "{breach}");
}

#[test]
fn allocations_are_counted_on_their_own_thread() {
    assert!(CountingAllocator::is_installed());
    let before = CountingAllocator::on_this_thread();
    let elsewhere = std::thread::spawn(|| {
        let before = CountingAllocator::on_this_thread();
        let mut grown: Vec<u64> = Vec::with_capacity(1);
        grown.extend([1, 2, 3]);
        std::hint::black_box(&grown);
        CountingAllocator::on_this_thread() - before
    });
    // Waiting may allocate here; the allocations of the other thread may not be among them.
    assert_eq!(elsewhere.join().unwrap(), 2);
    let zeroed = std::hint::black_box(vec![0_u64; 1000]);
    assert!(CountingAllocator::on_this_thread() > before);
    drop(zeroed);
}
