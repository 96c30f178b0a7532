//! Waves on a chain of grains.

use super::{DENSITY, Touching, box_of, name};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, Solver, Vector};
use granular_dem::{ContactModel, Dem};
use granular_driver::failure::Failure;
use std::f64::consts::{PI, TAU};

/// Speed of the grains \[m/s\]: overlaps change by less than a thousandth.
const SPEED: f64 = 1e-5;

/// A ring of grains, pressed together, that lose no energy.
struct Ring {
    grains: Touching,
    count: usize,
}

impl Ring {
    fn new(contact: ContactModel, count: usize) -> Self {
        let grains =
            Touching { contact, friction: 0.0, restitution: 1.0, overlap: 1e-3, ..Touching::default() };
        Self { grains, count }
    }

    /// `sqrt(k / m)` with the stiffness at this overlap \[rad/s\].
    fn natural<D: Dim>(&self) -> f64 {
        (self.grains.contact().1 / (DENSITY * D::ball_volume(0.5))).sqrt()
    }

    /// Angular frequency \[rad/s\] of the standing wave with `mode` waves on the ring.
    fn expected<D: Dim>(&self, mode: usize) -> f64 {
        2.0 * self.natural::<D>() * (PI * mode as f64 / self.count as f64).sin()
    }

    /// The same from the times at which the wave passes its rest.
    fn measured<D: Dim>(&self, mode: usize) -> Result<f64, Failure> {
        const PERIODS: usize = 4;
        let phase = |k: usize| (TAU * (mode * k) as f64 / self.count as f64).cos();
        let mut dem = self.standing::<D>(&phase)?;
        // Steps of a fiftieth of the shortest period over 2 pi: the scheme adds (w dt)^2 / 24 to a frequency.
        let dt = 0.02 / self.natural::<D>();
        let (mut last, mut time, mut first, mut crossings) = (f64::NAN, 0.0, f64::NAN, 0);
        let end = 1.5 * TAU * PERIODS as f64 / self.expected::<D>(mode);
        while time < end {
            let moving =
                |(id, grain): (u32, granular_dem::Grain<D>)| grain.velocity.component(0) * phase(id as usize);
            let now: f64 = dem.grains().map(moving).sum();
            if last * now < 0.0 {
                let at = time - dt * now / (now - last);
                if crossings == 0 {
                    first = at;
                }
                if crossings == 2 * PERIODS {
                    return Ok(TAU * PERIODS as f64 / (at - first));
                }
                crossings += 1;
            }
            last = now;
            dem.advance(dt, 1)?;
            time += dt;
        }
        Ok(f64::NAN)
    }

    fn standing<D: Dim>(&self, phase: &dyn Fn(usize) -> f64) -> Result<Dem<D>, Failure> {
        let d = self.grains.spacing();
        let moving = |k: usize| (D::Vec::along(0, (k as f64 + 0.5) * d), D::Vec::along(0, SPEED * phase(k)));
        let mut edges = [1.0; 3];
        edges[0] = self.count as f64 * d;
        let periodic: Vec<bool> = (0..D::N).map(|axis| axis == 0).collect();
        self.grains.moving_in_cell((0..self.count).map(moving), box_of(&edges), &periodic)
    }
}

fn dispersion<D: Dim>(rows: &mut Rows, contact: ContactModel) -> Result<(), Failure> {
    let ring = Ring::new(contact, 40);
    let law = format!("{} {}s", name(contact), D::BALL);
    for mode in [2, 5, 10, 15, 20] {
        let length = ring.count as f64 / mode as f64;
        let metric = format!("chain of {law}: frequency at a wave length of {length:.3} d [rad/s]");
        let (found, expected) = (ring.measured::<D>(mode)?, ring.expected::<D>(mode));
        rows.add(Measure::relative(Tier::ClosedForm, metric, found, expected, 2e-4));
    }
    let ring = Ring::new(contact, 100);
    let d = ring.grains.spacing();
    let speed = ring.measured::<D>(1)? * ring.count as f64 * d / TAU;
    let metric = format!("chain of {law}: speed of long waves [m/s]");
    let measure = Measure::relative(Tier::ClosedForm, metric, speed, d * ring.natural::<D>(), 5e-4);
    rows.add(measure.note("a wave of 100 d is slower by 1.6e-4"));
    Ok(())
}

pub(in super::super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    dispersion::<D2>(rows, ContactModel::Linear)?;
    dispersion::<D3>(rows, ContactModel::Hertz)
}
