//! Damped oscillators that keep the contract, or break one promise of it.

use crate::solver::check_step;
use crate::{
    Blocks, FieldRef, FieldSink, Limits, Location, Memory, Section, Shown, ShownAs, SnapshotError, Solver,
    StepError, StepLimit,
};
use glam::DVec2;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    FeelsThreads,
    FeelsCalls,
    ForgetsState,
    AcceptsMissing,
    AcceptsAnyLength,
    PanicsOnDamage,
    NamesTheWrongEntry,
    AcceptsBadSteps,
    ChangesBeforeRefusing,
    HidesNan,
    Allocates,
    AllocatesPerCall,
    ZeroLimit,
    InfiniteLimit,
    SameLimitTwice,
    LimitBelowTheStep,
    HardLimitDiffers,
    ForgetsToShow,
    ShowsTwice,
    ShowsUnasked,
    ShowsAnotherKind,
    ShowsAnotherUnit,
    ShowsTooFew,
    SameNameTwice,
    LinksToNowhere,
    PlacesInAnotherOrder,
    SamePlaceTwice,
    UnknownPlace,
    AtAnotherPlace,
    CopiesToSave,
    StandsStill,
    Fails,
}

pub(super) struct Toy {
    fault: Option<Fault>,
    position: Vec<DVec2>,
    velocity: Vec<f64>,
    energy: f64,
    steps: u64,
    /// Nothing but a faulty toy uses it, and nothing saves it.
    hidden: f64,
}

const OSCILLATORS: usize = 2000;

impl Toy {
    pub(super) fn new(fault: Option<Fault>) -> Self {
        let position = (0..OSCILLATORS).map(|i| DVec2::new(i as f64, 1.0 + (i % 7) as f64)).collect();
        let velocity = vec![0.0; OSCILLATORS];
        Self { fault, position, velocity, energy: 1.0, steps: 0, hidden: 0.0 }
    }

    fn has(&self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }

    fn one_step(&mut self, dt: f64, extra: f64) -> Result<(), StepError> {
        let work = (&mut self.position[..], &mut self.velocity[..]);
        Blocks::new(OSCILLATORS, 64).for_each(work, |_, (position, velocity)| {
            for (x, v) in position.iter_mut().zip(velocity) {
                *v -= (x.y + 0.1 * *v + extra) * dt;
                x.y += *v * dt;
            }
        });
        self.steps += 1;
        let (x, v) = (&self.position, &self.velocity);
        self.energy = Blocks::new(OSCILLATORS, 64).total(|i| x[i].length_squared() + v[i] * v[i]);
        if self.energy.is_finite() || self.has(Fault::HidesNan) {
            return Ok(());
        }
        Err(StepError::NotFinite { solver: "toy", quantity: "energy", id: 0, step: self.steps })
    }

    fn entry(&self, from: &Section, name: &str) -> Result<Vec<f64>, SnapshotError> {
        let found = from.array::<f64>(name);
        if self.has(Fault::AcceptsMissing) && name == "velocity" && found.is_err() {
            return Ok(self.velocity.clone());
        }
        if self.has(Fault::PanicsOnDamage) {
            return Ok(found.expect("the entry is there"));
        }
        if self.has(Fault::AcceptsAnyLength) {
            let mut values = found?;
            values.resize(OSCILLATORS, 0.0);
            return Ok(values);
        }
        if self.has(Fault::NamesTheWrongEntry) && found.is_err() {
            return from.array("something");
        }
        from.array_of(name, OSCILLATORS)
    }
}

/// Like [`Blocks::sum`], without its list of sums: the toy must not allocate.
trait Total {
    fn total(self, value: impl Fn(usize) -> f64) -> f64;
}

impl Total for Blocks {
    fn total(self, value: impl Fn(usize) -> f64) -> f64 {
        (0..self.count()).map(|block| self.range(block).map(&value).sum::<f64>()).sum()
    }
}

impl Solver for Toy {
    fn name(&self) -> &'static str {
        "toy"
    }

    fn size(&self) -> (usize, &'static str) {
        (OSCILLATORS, "oscillator")
    }

    fn limits(&self, report: &mut Limits) {
        let dt = match self.fault {
            Some(Fault::ZeroLimit) => 0.0,
            Some(Fault::InfiniteLimit) => f64::INFINITY,
            Some(Fault::LimitBelowTheStep) => 1e-3,
            _ => 2.0,
        };
        let limit = StepLimit::at_most("period", dt, "stability");
        report.steps.push(limit.clone());
        if self.has(Fault::SameLimitTwice) {
            report.steps.push(limit);
        }
    }

    fn hard_limits(&self, report: &mut Limits) {
        if !self.has(Fault::HardLimitDiffers) {
            self.limits(report);
        }
    }

    fn hard_limits_may_change(&self) -> bool {
        false
    }

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        if self.has(Fault::ChangesBeforeRefusing) {
            self.steps += u64::from(check_step(dt).is_err());
        }
        if self.has(Fault::AcceptsBadSteps) && dt == 0.0 {
            return Ok(());
        }
        check_step(dt)?;
        if self.has(Fault::Fails) {
            return Err(StepError::Step { dt, why: "it never works".to_owned() });
        }
        if self.has(Fault::StandsStill) {
            return Ok(());
        }
        if self.has(Fault::AllocatesPerCall) {
            drop(std::hint::black_box(Box::new(steps)));
        }
        for taken in 0..steps {
            let extra = match self.fault {
                Some(Fault::FeelsThreads) => 1e-15 * rayon::current_num_threads() as f64,
                Some(Fault::FeelsCalls) => 1e-13 * taken as f64,
                Some(Fault::ForgetsState) => self.hidden,
                _ => 0.0,
            };
            self.hidden += 1e-12;
            if self.has(Fault::Allocates) {
                drop(std::hint::black_box(Box::new(taken)));
            }
            self.one_step(dt, extra)?;
        }
        Ok(())
    }

    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        let cells = Location::Grid { origin: [0.0; 3], spacing: [1.0; 3], cells: [2, 3, 1] };
        let points = Location::Points(FieldRef::Vector2(&self.position));
        if self.has(Fault::PlacesInAnotherOrder) {
            return vec![("cells", cells), ("oscillators", points)];
        }
        vec![
            ("oscillators", points),
            (if self.has(Fault::SamePlaceTwice) { "oscillators" } else { "cells" }, cells),
        ]
    }

    fn shown(&self) -> Vec<Shown> {
        let shown = |name: &str, kind| Shown::new(name, "1", "a test", kind);
        let place = if self.has(Fault::UnknownPlace) { "nodes" } else { "cells" };
        let mut list = vec![
            shown("energy", ShownAs::Number),
            shown("velocity", ShownAs::Field),
            shown("stretch", ShownAs::Link),
            shown("height", ShownAs::Field).at(if self.has(Fault::AtAnotherPlace) {
                "oscillators"
            } else {
                place
            }),
        ];
        if self.has(Fault::SameNameTwice) {
            list.push(shown("energy", ShownAs::Number));
        }
        list
    }

    fn show(&self, sink: &mut dyn FieldSink) {
        if sink.wants("energy") && !self.has(Fault::ForgetsToShow) {
            sink.number("energy", if self.has(Fault::ShowsAnotherUnit) { "J" } else { "1" }, self.energy);
            if self.has(Fault::ShowsTwice) {
                sink.number("energy", "1", self.energy);
            }
        }
        if sink.wants("velocity") || self.has(Fault::ShowsUnasked) {
            let count = if self.has(Fault::ShowsTooFew) { 3 } else { OSCILLATORS };
            sink.field("velocity", "1", FieldRef::Scalar(&self.velocity[..count]));
        }
        if sink.wants("height") {
            sink.field("height", "1", FieldRef::Scalar(&[0.5; 6]));
        }
        if sink.wants("stretch") {
            sink.links(&[[0, 1], [1, if self.has(Fault::LinksToNowhere) { OSCILLATORS as u32 } else { 2 }]]);
            if self.has(Fault::ShowsAnotherKind) {
                sink.field("stretch", "1", FieldRef::Scalar(&self.velocity));
            } else {
                sink.link_field("stretch", "1", FieldRef::Scalar(&[0.5, 0.25]));
            }
        }
    }

    fn save(&self, to: &mut Section) {
        to.put("velocity", &self.velocity);
        if self.has(Fault::CopiesToSave) {
            to.put("position", &self.position.iter().map(|x| x.y).collect::<Vec<_>>());
        } else {
            to.put_each("position", OSCILLATORS, |put| self.position.iter().for_each(|x| put(x.y)));
        }
        to.put_one("steps", self.steps);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.velocity = self.entry(from, "velocity")?;
        let places = self.entry(from, "position")?;
        self.position.iter_mut().zip(places).for_each(|(x, y)| x.y = y);
        self.steps = from.one("steps")?;
        Ok(())
    }

    fn memory(&self) -> Memory {
        Memory::default()
    }
}
