//! A solver whose state is elsewhere is never seen stale.

use super::*;
use crate::exchange::Coupling;
use crate::field::{Location, Shown, ShownAs};
use crate::observer::{Every, Observer};
use crate::solver::Memory;
use std::sync::{Arc, Mutex};

/// Counts its steps on a device; the host knows what was last published.
#[derive(Default)]
struct Device {
    on_device: u64,
    on_host: u64,
    published: u64,
}

impl Solver for Device {
    fn name(&self) -> &'static str {
        "device"
    }
    fn size(&self) -> (usize, &'static str) {
        (1, "counter")
    }
    fn limits(&self, _: &mut Limits) {}
    fn advance(&mut self, _: f64, steps: u64) -> Result<(), StepError> {
        self.on_device += steps;
        if self.on_device > 1000 {
            return Err(StepError::Step { dt: 0.1, why: "it has counted enough".to_owned() });
        }
        Ok(())
    }
    fn publish(&mut self) {
        self.published += u64::from(self.on_host != self.on_device);
        self.on_host = self.on_device;
    }
    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("counter", Location::Points(FieldRef::Vector2(&[glam::DVec2::ZERO])))]
    }
    fn shown(&self) -> Vec<Shown> {
        vec![Shown::new("count", "1", "steps", ShownAs::Number)]
    }
    fn show(&self, sink: &mut dyn FieldSink) {
        sink.number("count", "1", self.on_host as f64);
    }
    fn save(&self, to: &mut Section) {
        to.put_one("count", self.on_host);
    }
    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.on_device = from.one("count")?;
        Ok(())
    }
    fn memory(&self) -> Memory {
        Memory::default()
    }
}

fn shown(solver: &dyn Solver) -> f64 {
    let mut numbers = Numbers::wanting(["count"]);
    solver.show(&mut numbers);
    numbers.get("count").expect("it is shown")
}

fn saved(simulation: &Simulation) -> u64 {
    find_section(&simulation.save(), "solver").unwrap().one("count").unwrap()
}

/// Keeps the step and what every solver shows.
struct Look(Arc<Mutex<Vec<(u64, f64)>>>);

impl Observer for Look {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let mut seen = self.0.lock().expect("no panic");
        seen.extend(simulation.solvers().map(|(_, solver)| (simulation.clock().step(), shown(solver))));
        Ok(if simulation.clock().step() == 700 { Flow::Stop } else { Flow::Continue })
    }
}

#[test]
fn observers_and_saves_see_what_is_on_the_device_now() {
    let seen = Arc::default();
    let mut simulation = Simulation::named("device", Box::new(Device::default()));
    let key = simulation.find::<Device>("device").unwrap();
    let mut observers = [Scheduled::new("look", Every::Steps(350), Box::new(Look(Arc::clone(&seen))))];
    simulation.begin_segment(0.1).unwrap();
    let flag = AtomicBool::new(false);
    let mut run = |simulation: &mut Simulation, time: f64| simulation.run(time, &mut observers, &flag);
    run(&mut simulation, 40.0).unwrap();
    assert_eq!(saved(&simulation), 400);
    assert_eq!(run(&mut simulation, 80.0).unwrap(), Ending::Stopped);
    assert_eq!(saved(&simulation), 700);
    assert_eq!(*seen.lock().unwrap(), [(0, 0.0), (350, 350.0), (700, 700.0)]);
    // Once for each look and each end, whatever the number of steps and bursts.
    assert_eq!(simulation.get(key).published, 3);
    simulation.advance(1).unwrap();
    assert_eq!((saved(&simulation), shown(simulation.solver())), (701, 701.0));
    // Also when a step fails: the state is there for inspection.
    assert!(run(&mut simulation, 500.0).is_err());
    assert_eq!(saved(&simulation), simulation.get(key).on_device);
}

#[test]
fn what_is_restored_or_changed_between_segments_is_seen() {
    let build = || Simulation::named("device", Box::new(Device::default()));
    let mut simulation = build();
    let key = simulation.find::<Device>("device").unwrap();
    simulation.get_mut(key).on_device = 5;
    simulation.begin_segment(0.1).unwrap();
    assert_eq!((saved(&simulation), shown(simulation.solver())), (5, 5.0));
    let mut other = build();
    other.restore(&simulation.save()).unwrap();
    assert_eq!((saved(&other), shown(other.solver())), (5, 5.0));
}

/// Keeps the counts of both ends whenever it sees them.
struct Watch(Arc<Mutex<Vec<[u64; 2]>>>);

impl Coupling<Device, Device> for Watch {
    fn name(&self) -> &'static str {
        "watch"
    }
    fn attach(&mut self, _: &mut Device, _: &mut Device) -> Result<(), CouplingError> {
        Ok(())
    }
    fn forward(&mut self, fast: &Device, slow: &mut Device) -> Result<(), StepError> {
        self.0.lock().expect("no panic").push([slow.on_host, fast.on_host]);
        Ok(())
    }
    fn backward(&mut self, slow: &Device, fast: &mut Device) -> Result<(), StepError> {
        self.0.lock().expect("no panic").push([slow.on_host, fast.on_host]);
        Ok(())
    }
    fn acts_within(&self) -> bool {
        true
    }
    fn during(&mut self, _: u64, _: u64, slow: &Device, fast: &mut Device) -> Result<(), StepError> {
        self.0.lock().expect("no panic").push([slow.on_host, fast.on_host]);
        Ok(())
    }
}

#[test]
fn laws_see_what_is_on_the_device_now() {
    let seen = Arc::<Mutex<_>>::default();
    let mut simulation = Simulation::named("slow", Box::new(Device::default()));
    let slow = simulation.find::<Device>("slow").unwrap();
    let fast = simulation.add("fast", Device::default()).unwrap();
    simulation.couple(slow, fast, Watch(Arc::clone(&seen))).unwrap();
    simulation.choose_step(fast, 0.05);
    simulation.begin_segment(0.1).unwrap();
    simulation.advance(2).unwrap();
    let expected = [[0, 0], [1, 0], [1, 0], [1, 1], [1, 1], [1, 2], [2, 2], [2, 2], [2, 3], [2, 3]];
    assert_eq!(*seen.lock().unwrap(), expected);
    // What is changed by hand between two calls is seen as well.
    simulation.get_mut(fast).on_device = 9;
    simulation.advance(1).unwrap();
    assert_eq!(seen.lock().unwrap()[10], [2, 9]);
}
