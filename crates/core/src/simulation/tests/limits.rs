//! Limits are asked for again while a run goes on.

use super::stations::{Line, Log, Station};
use super::*;
use crate::exchange::Coupling;
use crate::field::{Location, Shown};
use crate::solver::{Memory, StepLimit};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

/// Its limit falls with its own time.
struct Tiring {
    rule: StepRule,
    comfort: f64,
    may_change: bool,
    time: f64,
    steps: u64,
    /// Its steps \[s\], with their numbers.
    taken: Vec<(f64, u64)>,
    asked: Arc<AtomicU64>,
}

impl Tiring {
    fn new(rule: StepRule) -> Self {
        Self {
            rule,
            comfort: 1.0,
            may_change: true,
            time: 0.0,
            steps: 0,
            taken: Vec::new(),
            asked: Arc::default(),
        }
    }

    /// From 0.01 s at the start to a third of it after 20 s.
    fn limit(&self) -> f64 {
        0.01 / (1.0 + 0.1 * self.time)
    }
}

impl Solver for Tiring {
    fn name(&self) -> &'static str {
        "tiring"
    }
    fn size(&self) -> (usize, &'static str) {
        (1, "thing")
    }
    fn limits(&self, report: &mut Limits) {
        report.advice.push("rest".to_owned());
        report.steps.push(StepLimit::recommended("comfort", self.comfort, "of the test"));
        self.hard_limits(report);
    }
    fn hard_limits(&self, report: &mut Limits) {
        self.asked.fetch_add(1, Ordering::Relaxed);
        let limit = StepLimit::at_most("endurance", self.limit(), format!("after {:.1} s", self.time));
        report.steps.push(StepLimit { rule: self.rule, ..limit });
    }
    fn hard_limits_may_change(&self) -> bool {
        self.may_change
    }
    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        for _ in 0..steps {
            self.time += dt;
        }
        self.steps += steps;
        match self.taken.last_mut() {
            Some((same, count)) if *same == dt => *count += steps,
            _ => self.taken.push((dt, steps)),
        }
        Ok(())
    }
    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("thing", Location::Points(FieldRef::Vector2(&[glam::DVec2::ZERO])))]
    }
    fn shown(&self) -> Vec<Shown> {
        Vec::new()
    }
    fn show(&self, _: &mut dyn FieldSink) {}
    fn save(&self, to: &mut Section) {
        to.put_one("time", self.time);
        to.put_one("steps", self.steps);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.time = from.one("time")?;
        self.steps = from.one("steps")?;
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}

/// Nothing is exchanged.
struct Beside;

impl<A: Solver, B: Solver> Coupling<A, B> for Beside {
    fn name(&self) -> &'static str {
        "beside"
    }
    fn attach(&mut self, _: &mut A, _: &mut B) -> Result<(), CouplingError> {
        Ok(())
    }
    fn forward(&mut self, _: &B, _: &mut A) -> Result<(), StepError> {
        Ok(())
    }
}

#[derive(Clone, Copy, Debug)]
enum Tired {
    Fast,
    Free,
    SlowOfAGroup,
}

/// A station with steps of 0.02 s and a solver that tires.
fn pair(tired: Tired) -> (Simulation, NodeKey<Tiring>) {
    let log = Log::default();
    let mut simulation = Simulation::named("water", Box::new(Station::new("water", 0.02, &log)));
    let water = simulation.find::<Station>("water").unwrap();
    let grains = simulation.add("grains", Tiring::new(StepRule::AtMost)).unwrap();
    match tired {
        Tired::Fast => simulation.couple(water, grains, Beside).unwrap(),
        Tired::Free => {}
        Tired::SlowOfAGroup => {
            let body = simulation.add("body", Station::new("body", 0.002, &log)).unwrap();
            simulation.couple(grains, body, Beside).unwrap();
        }
    }
    simulation.begin_segment(0.02).unwrap();
    (simulation, grains)
}

#[test]
fn a_solver_whose_limit_falls_takes_more_steps_within_the_longer_one() {
    for tired in [Tired::Fast, Tired::Free, Tired::SlowOfAGroup] {
        let (mut simulation, grains) = pair(tired);
        simulation.advance(1050).unwrap();
        let grains = simulation.get(grains);
        // Asked every 2 s, when the limit is 0.01 s, 0.01 s / 1.2, 0.01 s / 1.4 and so on.
        let mut counted: Vec<(f64, u64)> = Vec::new();
        for k in 0..11_u32 {
            let count = (2.0 * (1.0 + 0.2 * f64::from(k)) * (1.0 - 1e-9)).ceil() as u64;
            let steps = if k == 10 { 50 } else { 100 };
            match counted.last_mut() {
                Some((dt, all)) if *dt == 0.02 / count as f64 => *all += count * steps,
                _ => counted.push((0.02 / count as f64, count * steps)),
            }
        }
        assert_eq!(counted[..2], [(0.02 / 2.0, 200), (0.02 / 3.0, 3 * 200)]);
        assert_eq!(grains.taken, counted, "{tired:?}");
        assert!((grains.time - 21.0).abs() < 1e-9);
    }
}

#[test]
fn what_was_decided_survives_splits_and_restarts() {
    for tired in [Tired::Fast, Tired::Free, Tired::SlowOfAGroup] {
        let (mut whole, _) = pair(tired);
        whole.advance(450).unwrap();
        let (mut split, grains) = pair(tired);
        // At, before and after the steps at which limits are asked for.
        for steps in [1, 98, 1, 1, 49, 49, 1, 120, 130] {
            split.advance(steps).unwrap();
            let (mut resumed, _) = pair(tired);
            resumed.restore(&split.save()).unwrap();
            assert_eq!(resumed.save(), split.save());
            // One that has never been saved goes on like one that has just been restored.
            let (mut twin, _) = pair(tired);
            twin.restore(&split.save()).unwrap();
            twin.advance(60).unwrap();
            let (mut other, _) = pair(tired);
            other.advance(split.clock().step() + 60).unwrap();
            assert_eq!(twin.save(), other.save(), "{tired:?} after {} steps", split.clock().step());
            split = resumed;
        }
        assert_eq!(split.save(), whole.save(), "{tired:?}");
        assert_eq!(split.get(grains).steps, whole.get(grains).steps);
    }
}

#[test]
fn damaged_shares_are_refused() {
    let (mut simulation, _) = pair(Tired::Fast);
    let saved = simulation.save();
    for (bad, told) in [((0_u64, 0.01), "0 steps"), ((2, f64::NAN), "NaN")] {
        let mut clock = Section::new("clock");
        for (name, bytes) in saved[0].entries().filter(|(name, _)| *name != "steps of solvers") {
            clock.put_bytes(name, bytes.to_vec());
        }
        let lacking: Vec<Section> =
            std::iter::once(clock.clone()).chain(saved[1..].iter().cloned()).collect();
        // Without the entry every solver takes each step whole.
        simulation.restore(&lacking).unwrap();
        assert!(simulation.save()[0].entries().all(|(name, _)| name != "steps of solvers"));
        clock.put("steps of solvers", &[(1_u64, 0.02)]);
        let short: Vec<Section> = std::iter::once(clock.clone()).chain(saved[1..].iter().cloned()).collect();
        let error = simulation.restore(&short).unwrap_err().to_string();
        assert!(error.contains("clock/steps of solvers") && error.contains("1 values"), "{error}");
        let mut clock = lacking[0].clone();
        clock.put("steps of solvers", &[(1, 0.02), bad]);
        let damaged: Vec<Section> = std::iter::once(clock).chain(saved[1..].iter().cloned()).collect();
        let error = simulation.restore(&damaged).unwrap_err().to_string();
        assert!(error.contains("clock/steps of solvers") && error.contains(told), "{error}");
    }
}

fn alone(rule: StepRule) -> Simulation {
    Simulation::named("grains", Box::new(Tiring::new(rule)))
}

#[test]
fn a_solver_alone_takes_more_steps_once_its_limit_is_below_the_step() {
    let mut simulation = alone(StepRule::AtMost);
    let error = simulation.begin_segment(0.011).unwrap_err().to_string();
    assert!(error.contains("`grains` allows at most 1e-2 s"), "{error}");
    simulation.begin_segment(0.009).unwrap();
    simulation.advance(2000).unwrap();
    // The limit is below the step from 1.11 s on and below its half from 12.2 s on; it is asked for after every 100 steps.
    let third = 0.009 / 3.0;
    let tiring = |simulation: &Simulation| {
        simulation.get::<Tiring>(simulation.find("grains").expect("it is alone")).taken.clone()
    };
    assert_eq!(tiring(&simulation), [(0.009, 200), (0.0045, 2400), (third, 1800)]);
    // A later segment begins with as many as it needs by now, and so does one that is taken up again.
    let mut other = alone(StepRule::AtMost);
    other.begin_segment(0.009).unwrap();
    other.restore(&simulation.save()).unwrap();
    for simulation in [&mut simulation, &mut other] {
        simulation.advance(100).unwrap();
        simulation.begin_segment(0.009).unwrap();
        simulation.advance(1).unwrap();
    }
    assert_eq!(tiring(&simulation).last(), Some(&(third, 2103)));
    assert_eq!(tiring(&other).last(), Some(&(third, 303)));
}

#[test]
fn a_segment_whose_step_has_become_too_long_stops_and_says_whose_limit_it_is() {
    // The slow end of a coupling cannot take more than its partners see.
    let (mut simulation, _) = {
        let mut simulation = alone(StepRule::AtMost);
        let grains = simulation.find::<Tiring>("grains").unwrap();
        let body = simulation.add("body", Station::new("body", 0.002, &Log::default())).unwrap();
        simulation.couple(grains, body, Beside).unwrap();
        (simulation, grains)
    };
    simulation.begin_segment(0.009).unwrap();
    let error = simulation.advance(1000).unwrap_err().to_string();
    assert!(error.contains("`grains`") && simulation.clock().step() == 200, "{error}");
}

#[test]
fn a_recommended_step_that_falls_changes_nothing_for_a_solver_alone() {
    let mut simulation = alone(StepRule::Recommended);
    let key = simulation.find::<Tiring>("grains").unwrap();
    simulation.begin_segment(0.02).unwrap();
    simulation.advance(1000).unwrap();
    assert_eq!(simulation.get(key).taken, [(0.02, 1000)]);
    // Nor for one that takes several within a longer step: its accuracy is chosen at the start of a segment.
    let mut simulation = Simulation::named("water", Box::new(Station::new("water", 0.02, &Log::default())));
    let key = simulation.add("grains", Tiring::new(StepRule::Recommended)).unwrap();
    simulation.begin_segment(0.02).unwrap();
    simulation.advance(1000).unwrap();
    assert_eq!(simulation.get(key).taken, [(0.01, 2000)]);
}

#[test]
fn a_solver_alone_that_refuses_steps_itself_is_not_asked() {
    for (may_change, times) in [(false, 0), (true, 10)] {
        let solver = Tiring { may_change, ..Tiring::new(StepRule::Recommended) };
        let asked = Arc::clone(&solver.asked);
        let mut simulation = Simulation::named("grains", Box::new(solver));
        simulation.begin_segment(0.01).unwrap();
        simulation.advance(1000).unwrap();
        assert_eq!(asked.load(Ordering::Relaxed), times);
    }
}

#[test]
fn limits_name_their_solver_or_law() {
    let (simulation, ..) = super::pair(Some((0.1, StepRule::AtMost)), FAST);
    let mut limits = Limits::default();
    simulation.limits(&mut limits);
    let names: Vec<(&str, &str)> =
        limits.steps.iter().map(|limit| (limit.solver.as_str(), limit.name)).collect();
    assert_eq!(names, [("tank", "leak"), ("pipe", "pipe")]);
    let log = Log::default();
    let mut simulation = Simulation::named("water", Box::new(Station::new("water", 1.0, &log)));
    let (water, grains) =
        (simulation.find("water").unwrap(), simulation.add("grains", Station::new("grains", 0.1, &log)));
    simulation.couple(water, grains.unwrap(), Line::new("drag", &log)).unwrap();
    let error = simulation.begin_segment(1.1).unwrap_err().to_string();
    assert!(error.contains("`water` allows at most 1e0 s now (pace: of the test)"), "{error}");
}
