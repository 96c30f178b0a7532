//! A bar that is held at one end and swings along itself.

use crate::methods::mpm::names::{SHAPES, said};
use crate::validate::{Effort, Measure, Rows, Tier};
use granular_constitutive::LinearElastic;
use granular_core::glam::DVec2;
use granular_core::{D2, SetupError, Solver};
use granular_driver::failure::Failure;
use granular_mpm::{Condition, Mpm2, Options, Particle, Scheme, Setup, ShapeFunctions, Wall};
use std::f64::consts::PI;

/// Length \[m\], Young's modulus \[Pa\], density \[kg/m^3\]: waves of 10 m/s.
const LENGTH: f64 = 25.0;
const YOUNG: f64 = 100.0;
const DENSITY: f64 = 1.0;
const WAVE: f64 = 10.0;

/// A bar in plane strain without lateral strain, one cell thick.
#[derive(Clone, Copy, Debug)]
pub(in crate::methods::mpm) struct Bar {
    /// Number of the mode, from 1.
    pub(in crate::methods::mpm) mode: u32,
    pub(in crate::methods::mpm) shape: ShapeFunctions,
    pub(in crate::methods::mpm) scheme: Scheme,
    /// Cells along the bar.
    pub(in crate::methods::mpm) cells: usize,
    /// Particles along an edge of a cell.
    pub(in crate::methods::mpm) along: usize,
}

impl Bar {
    /// Largest speed at the start \[m/s\]: strains of 1e-4.
    pub(in crate::methods::mpm) const SPEED: f64 = 1e-3;

    /// Edge of a cell \[m\].
    pub(in crate::methods::mpm) fn cell(&self) -> f64 {
        LENGTH / self.cells as f64
    }

    /// Time in which a wave crosses a cell \[s\].
    pub(in crate::methods::mpm) fn crossing(&self) -> f64 {
        self.cell() / WAVE
    }

    /// Wave number of the mode \[1/m\].
    fn number(&self) -> f64 {
        f64::from(2 * self.mode - 1) * PI / (2.0 * LENGTH)
    }

    /// Period \[s\].
    pub(in crate::methods::mpm) fn period(&self) -> f64 {
        2.0 * PI / (self.number() * WAVE)
    }

    /// Velocity \[m/s\] at a time \[s\] of what was at a place \[m\].
    pub(in crate::methods::mpm) fn velocity(&self, place: f64, time: f64) -> f64 {
        Self::SPEED * (self.number() * place).sin() * (self.number() * WAVE * time).cos()
    }

    /// Its particles where they are at the start, in the order of their identifiers.
    pub(in crate::methods::mpm) fn particles(&self) -> Vec<Particle<D2>> {
        let size = DVec2::new(LENGTH, self.cell());
        let particles = Particle::<D2>::filling(DVec2::ZERO, size, self.cell() / self.along as f64);
        let moving = |particle: Particle<D2>| {
            particle.moving(DVec2::new(self.velocity(particle.position.x, 0.0), 0.0))
        };
        particles.into_iter().map(moving).collect()
    }

    pub(in crate::methods::mpm) fn build(&self) -> Result<Mpm2, SetupError> {
        let walls = vec![
            Wall::plane("end", DVec2::ZERO, DVec2::X, Condition::Slip)?,
            Wall::plane("side", DVec2::ZERO, DVec2::Y, Condition::Slip)?,
            Wall::plane("other side", DVec2::Y * self.cell(), -DVec2::Y, Condition::Slip)?,
        ];
        let options = Options { shape: self.shape, scheme: self.scheme, ..Options::default() };
        let mut mpm = Mpm2::new(Setup { walls, options, ..Setup::new(self.cell()) })?;
        mpm.body(LinearElastic::new(YOUNG, 0.0)?, DENSITY, &self.particles())?;
        Ok(mpm)
    }
}

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for (name, shape) in SHAPES {
        let scheme = Scheme::ModifiedStressLast;
        let bar = Bar { mode: 1, shape, scheme, cells: 13, along: 1 };
        let found = swing(&bar, 10)?;
        let metric = format!("period of the first mode, {name} [s]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.period, bar.period(), 0.01));
        // Of half of the bar by its middle particles: v0 / (b L).
        let mean = Bar::SPEED * 2.0 / PI;
        let metric = format!("velocity of the centre of mass at the start, {name} [m/s]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.mean, mean, 0.01));
        let energy = 0.25 * DENSITY * Bar::SPEED.powi(2) * LENGTH * bar.cell();
        let metric = format!("energy at the start, {name} [J/m]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.start, energy, 0.01));
        let metric = format!("energy after ten periods over that at the start, {name}");
        rows.add(Measure::relative(Tier::Conservation, metric, found.kept, 1.0, 1e-3));
        // Masses lumped at nodes make waves slow: 104 cells would be off by 1.4 %, 208 by 0.34 %.
        let bar = Bar { mode: 10, shape, scheme, cells: 208, along: 1 };
        let found = swing(&bar, 10)?;
        let metric = format!("period of the tenth mode, 44 cells in a wave, {name} [s]");
        rows.add(Measure::relative(Tier::ClosedForm, metric, found.period, bar.period(), 0.01));
    }
    Ok(())
}

struct Swung {
    period: f64,
    /// Velocity of the centre of mass at the start \[m/s\].
    mean: f64,
    /// Energy at the start \[J/m\].
    start: f64,
    /// Energy at the end over that at the start.
    kept: f64,
}

/// Lets a bar swing for so many periods.
fn swing(bar: &Bar, periods: u32) -> Result<Swung, Failure> {
    let mut mpm = bar.build().map_err(said)?;
    // Looked at a hundred times in a period; a call for one step would cost more than the step.
    let look = 0.01 * bar.period();
    let steps = (look / (0.05 * bar.crossing())).ceil();
    let dt = look / steps;
    let (start, mean) = (mpm.energies().mechanical(), mpm.momentum().x / mpm.mass());
    let (mut last, mut crossings) = (mpm.momentum().x, Vec::new());
    for _ in 0..100 * periods {
        mpm.advance(dt, steps as u64)?;
        let now = mpm.momentum().x;
        if last * now < 0.0 {
            crossings.push(mpm.time() - look * now / (now - last));
        }
        last = now;
    }
    let count = crossings.len();
    let period = 2.0 * (crossings[count - 1] - crossings[0]) / (count - 1) as f64;
    Ok(Swung { period, mean, start, kept: mpm.energies().mechanical() / start })
}
