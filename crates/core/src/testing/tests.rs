//! The contract holds for a toy solver, and is seen to break for toys that break one promise.

mod sorter;
mod toy;

use super::{Breach, Contract, CountingAllocator, loads_follow_their_grains};
use crate::quantity::{HydroLoad, Load};
use crate::{Accepts, D2, Location, Solver};
use glam::DVec2;
use sorter::{Flaw, Sorter};
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
    Contract::passing_on,
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
        (Fault::HardLimitDiffers, 7),
        (Fault::ForgetsToShow, 8),
        (Fault::ShowsTwice, 8),
        (Fault::ShowsUnasked, 8),
        (Fault::ShowsAnotherKind, 8),
        (Fault::ShowsAnotherUnit, 8),
        (Fault::ShowsTooFew, 8),
        (Fault::SameNameTwice, 8),
        (Fault::LinksToNowhere, 8),
        (Fault::PlacesInAnotherOrder, 8),
        (Fault::SamePlaceTwice, 8),
        (Fault::UnknownPlace, 8),
        (Fault::AtAnotherPlace, 8),
        (Fault::CopiesToSave, 9),
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
fn a_place_has_the_fields_that_live_there_and_all_numbers() {
    let toy = Toy::new(None);
    let names = |place: &str| toy.shown_at(place).into_iter().map(|shown| shown.name).collect::<Vec<_>>();
    assert_eq!(names("oscillators"), ["energy", "velocity", "stretch"]);
    assert_eq!(names(""), names("oscillators"));
    assert_eq!(names("cells"), ["energy", "height"]);
    assert!(matches!(toy.location(), Location::Points(points) if points.len() == toy.size().0));
    assert!(matches!(toy.place("cells"), Some(Location::Grid { cells: [2, 3, 1], .. })));
    assert!(toy.place("nodes").is_none());
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

#[test]
fn loads_stay_with_grains_that_change_places() {
    let load = |id: u32| Load::<D2> { force: DVec2::new(f64::from(id), 1.0), torque: 0.5 * f64::from(id) };
    let test = |flaw| loads_follow_their_grains(|| Sorter::new(flaw), load, 0.01, 12);
    assert_eq!(test(Flaw::None), Ok(()));
    assert!(test(Flaw::LeavesLoadsBehind).unwrap_err().found.contains("held"));
    assert!(test(Flaw::IgnoresLoads).unwrap_err().found.contains("change nothing"));
    assert!(test(Flaw::AddsUpLoads).unwrap_err().found.contains("held"));
}

#[test]
fn room_for_an_input_is_made_when_a_law_asks() {
    let mut sorter = Sorter::new(Flaw::None);
    sorter.advance(0.1, 3).unwrap();
    assert_eq!(sorter.room(), 0);
    Accepts::<HydroLoad<D2>>::enable(&mut sorter);
    sorter.view_mut().add(2, Load { force: DVec2::X, torque: 0.5 });
    // After three steps grain 0 is where grain 2 was.
    let loads: Vec<(u32, f64)> = sorter.view_mut().iter_mut().map(|(id, load)| (id, load.force.x)).collect();
    assert_eq!(loads, [(3, 0.0), (4, 0.0), (0, 1.0), (1, 0.0), (2, 0.0)]);
    assert!(sorter.room() >= 5);
    // A second law that asks does not take away what the first wrote.
    Accepts::<HydroLoad<D2>>::enable(&mut sorter);
    assert_eq!(sorter.view_mut().iter_mut().filter(|(_, load)| **load != Load::ZERO).count(), 1);
}
