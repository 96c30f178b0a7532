//! Solvers that are slow to one and fast to another, and laws that act within a long step.

use super::stations::{Line, Log, Station};
use super::*;

/// Water that is slow to grains, which are slow to a body.
fn chain(log: &Log) -> (Simulation, [NodeKey<Station>; 3]) {
    // The order in which they are added is not that of their steps.
    let mut simulation = Simulation::named("body", Box::new(Station::new("body", 0.25, log)));
    let body = simulation.find("body").expect("it was named");
    let water = simulation.add("water", Station::new("water", 1.0, log)).unwrap();
    let grains = simulation.add("grains", Station::new("grains", 0.5, log)).unwrap();
    simulation.couple(grains, body, Line::new("push", log)).unwrap();
    simulation.couple(water, grains, Line::new("drag", log)).unwrap();
    (simulation, [water, grains, body])
}

#[test]
fn a_chain_calls_in_the_order_worked_out_by_hand() {
    let log = Log::default();
    let (mut simulation, _) = chain(&log);
    let mut limits = Limits::default();
    simulation.limits(&mut limits);
    assert_eq!(limits.recommended().map(|limit| limit.dt), Some(1.0));
    simulation.begin_segment(1.0).unwrap();
    simulation.advance(1).unwrap();
    let around_a_step_of_grains = [
        "grains clears",
        "push forward, step 0.5",
        "drag backward",
        "grains steps 1 x 0.5",
        "body clears",
        "push backward",
        "body steps 2 x 0.25",
    ];
    let expected: Vec<&str> = ["water clears", "drag forward, step 1", "water steps 1 x 1"]
        .into_iter()
        .chain(around_a_step_of_grains)
        .chain(around_a_step_of_grains)
        .collect();
    assert_eq!(log.take(), expected);
}

#[test]
fn each_solver_sees_what_its_partners_have_published() {
    let log = Log::default();
    let (mut simulation, [water, grains, body]) = chain(&log);
    let [mut w, mut g, mut b] = [water, grains, body].map(|key| simulation.get(key).value);
    simulation.begin_segment(1.0).unwrap();
    simulation.advance(1).unwrap();
    w += g - w;
    for _ in 0..2 {
        g += 0.5 * (b + w - g);
        for _ in 0..2 {
            b += 0.25 * (g - b);
        }
    }
    assert_eq!([water, grains, body].map(|key| simulation.get(key).value), [w, g, b]);
}

#[test]
fn a_chain_has_the_same_bits_for_any_split_restart_and_number_of_threads() {
    let bits = |simulation: &Simulation| simulation.save();
    let start = || {
        let (mut simulation, _) = chain(&Log::default());
        simulation.begin_segment(0.9).unwrap();
        simulation
    };
    let whole = |threads| {
        crate::testing::in_pool(threads, || {
            let mut simulation = start();
            simulation.advance(12).unwrap();
            bits(&simulation)
        })
    };
    let alone = whole(1);
    assert_ne!(alone, bits(&start()));
    for threads in [2, 3, 8] {
        assert_eq!(whole(threads), alone);
    }
    let mut split = start();
    for steps in [1, 0, 4, 7] {
        split.advance(steps).unwrap();
        let mut resumed = start();
        resumed.restore(&split.save()).unwrap();
        split = resumed;
    }
    assert_eq!(bits(&split), alone);
}

#[test]
fn a_ring_is_refused_and_named() {
    let log = Log::default();
    let (mut simulation, [water, _, body]) = chain(&log);
    let error = simulation.couple(body, water, Line::new("wave", &log)).unwrap_err();
    assert_eq!(error.place, "wave");
    let told =
        "`body` is to be slow to `water`, which would close the ring `water` - `grains` - `body` - `water`";
    assert!(error.reason.starts_with(told), "{error}");
    // The other way round it is no ring: the body is then fast to both, within the steps of the grains.
    simulation.couple(water, body, Line::new("wave", &log)).unwrap();
    simulation.begin_segment(1.0).unwrap();
    simulation.advance(1).unwrap();
    let calls = log.take();
    let steps: Vec<&String> = calls.iter().filter(|call| call.contains("steps")).collect();
    let inner = ["grains steps 1 x 0.5", "body steps 2 x 0.25"];
    assert_eq!(steps, ["water steps 1 x 1", inner[0], inner[1], inner[0], inner[1]]);
    assert_eq!(calls.iter().filter(|call| *call == "wave backward").count(), 2);
    assert_eq!(calls.iter().filter(|call| call.starts_with("wave forward")).count(), 1);
}

#[test]
fn a_solver_between_two_that_step_beside_each_other_is_refused() {
    let log = Log::default();
    let (mut simulation, [water, _, body]) = chain(&log);
    let sand = simulation.add("sand", Station::new("sand", 0.3, &log)).unwrap();
    simulation.couple(water, sand, Line::new("drag", &log)).unwrap();
    let error = simulation.couple(sand, body, Line::new("push", &log)).unwrap_err();
    assert_eq!(error.place, "body");
    assert!(error.reason.contains("`grains`") && error.reason.contains("`sand`"), "{error}");
    // Two solvers that take the long step whole may share a fast one.
    let air = simulation.add("air", Station::new("air", 2.0, &log)).unwrap();
    simulation.couple(air, sand, Line::new("drag", &log)).unwrap();
    simulation.begin_segment(0.6).unwrap();
    simulation.advance(1).unwrap();
    let steps: Vec<String> = log.take().into_iter().filter(|call| call.starts_with("air st")).collect();
    assert_eq!(steps, ["air steps 1 x 0.6"]);
}

#[test]
fn a_law_that_acts_within_is_called_before_each_step_of_the_fast_solver_and_others_are_not() {
    let log = Log::default();
    let pair = |within| {
        let mut simulation = Simulation::named("water", Box::new(Station::new("water", 1.0, &log)));
        let water = simulation.find("water").expect("it was named");
        let grains = simulation.add("grains", Station::new("grains", 0.34, &log)).unwrap();
        simulation.couple(water, grains, Line { within, ..Line::new("drag", &log) }).unwrap();
        simulation.begin_segment(0.75).unwrap();
        simulation.advance(1).unwrap();
        let inputs: Vec<f64> =
            simulation.get(grains).inputs.iter().map(|bits| f64::from_bits(*bits)).collect();
        (log.take(), inputs, simulation.get(water).value)
    };
    let (calls, inputs, water) = pair(false);
    let before = ["water clears", "drag forward, step 0.75", "water steps 1 x 0.75"];
    let expected = [&before[..], &["grains clears", "drag backward", "grains steps 3 x 0.25"]].concat();
    assert_eq!(calls, expected);
    assert_eq!(inputs, [water; 3]);
    let (calls, inputs, water) = pair(true);
    assert_eq!(calls[..3], before);
    let step = |k| ["grains clears".to_owned(), "drag backward".to_owned(), format!("drag during {k} of 3")];
    let steps: Vec<String> =
        (0..3).flat_map(|k| step(k).into_iter().chain(["grains steps 1 x 0.25".to_owned()])).collect();
    assert_eq!(calls[3..], steps);
    // What it added before one step is gone before the next.
    assert_eq!(inputs, [water, water + 1.0, water + 2.0]);
}

/// Gives the mean of the fast solver over its steps to the slow one.
struct Mean {
    sum: f64,
    mean: f64,
}

impl Coupling<Station, Station> for Mean {
    fn name(&self) -> &'static str {
        "mean"
    }
    fn attach(&mut self, _: &mut Station, fast: &mut Station) -> Result<(), CouplingError> {
        self.mean = fast.value;
        Ok(())
    }
    fn forward(&mut self, _: &Station, slow: &mut Station) -> Result<(), StepError> {
        slow.input += self.mean;
        Ok(())
    }
    fn acts_within(&self) -> bool {
        true
    }
    fn during(&mut self, k: u64, n: u64, _: &Station, fast: &mut Station) -> Result<(), StepError> {
        self.sum = if k == 0 { 0.0 } else { self.sum } + fast.shown;
        self.mean = self.sum / n as f64;
        Ok(())
    }
    fn save(&self, to: &mut Section) {
        to.put_one("mean", self.mean);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.mean = from.one("mean")?;
        Ok(())
    }
}

#[test]
fn a_law_can_hand_over_means_over_the_steps_of_the_fast_solver() {
    let build = || {
        let log = Log::default();
        let mut simulation = Simulation::named("water", Box::new(Station::new("water", 1.0, &log)));
        let water = simulation.find::<Station>("water").expect("it was named");
        let grains = simulation.add("grains", Station::new("grains", 0.25, &log)).unwrap();
        simulation.couple(water, grains, Mean { sum: 0.0, mean: 0.0 }).unwrap();
        simulation.begin_segment(1.0).unwrap();
        (simulation, water, grains)
    };
    let (mut simulation, water, grains) = build();
    let start = simulation.get(grains).value;
    simulation.advance(2).unwrap();
    // Nothing drives the grains: each step takes a quarter off.
    let mean = start * (1.0 + 0.75 + 0.75 * 0.75 + 0.75 * 0.75 * 0.75) / 4.0;
    assert!((simulation.get(water).value - mean).abs() < 1e-15 * start);
    // What a law sums up is part of the state.
    let (mut resumed, ..) = build();
    resumed.restore(&simulation.save()).unwrap();
    for simulation in [&mut simulation, &mut resumed] {
        simulation.advance(3).unwrap();
    }
    assert_eq!(resumed.save(), simulation.save());
}
