//! How coupled solvers share a step: a tank that leaks into a bucket.

mod chain;
mod device;
mod free;
mod limits;
mod stations;
mod vessel;

use super::*;
use crate::field::{FieldRef, FieldSink, Numbers};
use crate::observer::{Flow, ObserverError, Scheduled};
use crate::solver::StepRule;
use std::sync::atomic::{AtomicBool, Ordering};
use vessel::{Pipe, Vessel};

const FAST: Option<(f64, StepRule)> = Some((0.03, StepRule::AtMost));

type Pair = (Simulation, NodeKey<Vessel>, NodeKey<Vessel>);

fn pair(slow: Option<(f64, StepRule)>, fast: Option<(f64, StepRule)>) -> Pair {
    let mut simulation = Simulation::named("tank", Box::new(Vessel::new(1.0, slow)));
    let tank = simulation.find::<Vessel>("tank").expect("it was named");
    let bucket = simulation.add("bucket", Vessel::new(0.5, fast)).unwrap();
    simulation.couple(tank, bucket, Pipe::default()).unwrap();
    (simulation, tank, bucket)
}

#[test]
fn the_fast_solver_takes_equal_steps_within_the_slow_one() {
    let (mut simulation, tank, bucket) = pair(Some((0.1, StepRule::AtMost)), FAST);
    simulation.begin_segment(0.1).unwrap();
    simulation.advance(1).unwrap();
    assert_eq!(simulation.get(tank).taken, [0.1]);
    assert_eq!(simulation.get(bucket).taken, [0.025; 4]);
    // The tank saw the bucket before its step, the bucket saw the tank after it.
    let level = 1.0 + 0.1 * (0.5 - 1.0);
    assert_eq!(simulation.get(tank).level, level);
    assert_eq!(simulation.get(bucket).input, level);
    assert_eq!(simulation.clock().step(), 1);
    simulation.choose_step(bucket, 0.01);
    simulation.begin_segment(0.1).unwrap();
    simulation.advance(1).unwrap();
    assert_eq!(simulation.get(bucket).taken[4..], [0.01; 10]);
}

#[test]
fn laws_add_to_inputs_that_are_cleared_before() {
    let (mut simulation, tank, bucket) = pair(None, FAST);
    simulation.couple(tank, bucket, Pipe::default()).unwrap();
    simulation.begin_segment(0.06).unwrap();
    simulation.advance(3).unwrap();
    let before = simulation.get(bucket).level;
    simulation.advance(1).unwrap();
    assert_eq!(simulation.get(tank).input, 2.0 * before);
}

#[test]
fn steps_that_do_not_fit_are_refused_with_both_named() {
    let exactly = |dt| Some((dt, StepRule::Exactly));
    let (mut simulation, ..) = pair(exactly(0.1), exactly(0.03));
    let error = simulation.begin_segment(0.1).unwrap_err().to_string();
    assert!(error.contains("`bucket`") && error.contains("3e-2"), "{error}");
    let error = simulation.begin_segment(0.06).unwrap_err().to_string();
    assert!(error.contains("`tank`") && error.contains("leak"), "{error}");
    let (mut simulation, _, bucket) = pair(exactly(0.09), exactly(0.03));
    simulation.begin_segment(0.09).unwrap();
    simulation.advance(1).unwrap();
    assert_eq!(simulation.get(bucket).taken, [0.03; 3]);
    let (mut simulation, ..) = pair(None, Some((1e-9, StepRule::AtMost)));
    let error = simulation.begin_segment(0.1).unwrap_err().to_string();
    assert!(error.contains("`bucket`") && error.contains("leak"), "{error}");
}

#[test]
fn what_is_refused_leaves_all_as_it_was() {
    let (mut simulation, tank, bucket) = pair(None, FAST);
    let error = simulation.couple(bucket, tank, Pipe::default()).unwrap_err();
    assert!(error.reason.contains("ring `tank` - `bucket` - `tank`"), "{error}");
    let error = simulation.couple(tank, tank, Pipe::default()).unwrap_err();
    assert_eq!(error.reason, "both ends are one solver");
    let full = simulation.add("full", Vessel::new(200.0, None)).unwrap();
    let error = simulation.couple(tank, full, Pipe::default()).unwrap_err();
    assert_eq!(error.reason, "the vessel is full");
    // What was refused is as free as before.
    assert!(simulation.couple(full, bucket, Pipe::default()).is_ok());
    assert!(simulation.add("full", Vessel::new(0.0, None)).is_err());
    assert!(simulation.find::<Vessel>("none").is_none());
}

#[test]
fn limits_of_the_long_step_leave_out_fast_solvers() {
    let (simulation, ..) = pair(Some((0.1, StepRule::AtMost)), FAST);
    let mut limits = Limits::default();
    simulation.limits(&mut limits);
    let found: Vec<(&str, f64)> = limits.steps.iter().map(|limit| (limit.name, limit.dt)).collect();
    assert_eq!(found, [("leak", 0.1), ("pipe", 0.5)]);
}

#[test]
fn a_restart_takes_up_solvers_and_couplings() {
    let build = || pair(Some((0.1, StepRule::AtMost)), FAST).0;
    let bytes = |simulation: &Simulation| {
        let entries = |section: &Section| {
            section.entries().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect::<Vec<_>>()
        };
        simulation
            .save()
            .iter()
            .map(|section| (section.name().to_owned(), entries(section)))
            .collect::<Vec<_>>()
    };
    let mut whole = build();
    whole.begin_segment(0.1).unwrap();
    whole.advance(3).unwrap();
    let saved = whole.save();
    let mut second = build();
    second.restore(&saved).unwrap();
    assert_eq!(bytes(&second), bytes(&whole));
    for simulation in [&mut whole, &mut second] {
        simulation.advance(4).unwrap();
    }
    assert_eq!(bytes(&second), bytes(&whole));
    let names: Vec<String> = bytes(&whole).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["clock", "solver tank", "solver bucket", "coupling 0 pipe"]);
    let missing = second.restore(&saved[..3]).unwrap_err().to_string();
    assert!(missing.contains("coupling 0 pipe"), "{missing}");
}

#[test]
fn couplings_show_numbers_and_fields_as_solvers_do() {
    struct Fields(Vec<(String, f64)>);
    impl FieldSink for Fields {
        fn wants(&self, name: &str) -> bool {
            name == "difference"
        }
        fn field(&mut self, name: &str, _: &str, values: FieldRef<'_>) {
            let FieldRef::Scalar([value]) = values else { panic!("one vessel, one value: {values:?}") };
            self.0.push((name.to_owned(), *value));
        }
        fn number(&mut self, name: &str, _: &str, _: f64) {
            panic!("`{name}` was not wanted");
        }
    }
    let (mut simulation, tank, bucket) = pair(Some((0.1, StepRule::AtMost)), FAST);
    simulation.begin_segment(0.1).unwrap();
    simulation.advance(3).unwrap();
    let view = simulation.couplings().next().expect("there is one");
    assert_eq!((view.name(), view.slow(), view.fast()), ("pipe", "tank", "bucket"));
    let names: Vec<String> = view.shown().into_iter().map(|shown| shown.name).collect();
    assert_eq!(names, ["moved", "difference"]);
    let mut numbers = Numbers::wanting(["moved"]);
    view.show(&mut numbers);
    let section = &simulation.save()[3];
    assert_eq!(numbers.get("moved"), Some(section.one::<f64>("moved").unwrap()));
    let mut fields = Fields(Vec::new());
    view.show(&mut fields);
    let difference = simulation.get(bucket).level - simulation.get(tank).level;
    assert_eq!(fields.0, [("difference".to_owned(), difference)]);
    // A law that shows nothing needs to say nothing.
    let log = stations::Log::default();
    let mut simulation = Simulation::named("a", Box::new(stations::Station::new("a", 1.0, &log)));
    let (a, b) =
        (simulation.find("a").unwrap(), simulation.add("b", stations::Station::new("b", 1.0, &log)).unwrap());
    simulation.couple(a, b, stations::Line::new("line", &log)).unwrap();
    assert!(simulation.couplings().all(|view| view.shown().is_empty()));
}
