//! Decaying vortices of Taylor and Green: viscosity, and order in space.

use super::{FITS, OPERATORS, advance, on_both};
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{Dim, Linear, Vector};
use granular_driver::failure::Failure;
use granular_driver::statistics::order;
use granular_lbm::{D2Q9, D3Q19, Flow, Lattice, Lbm, Operator, Real, Setup};
use std::f64::consts::TAU;

/// Speed in cells per step at 32 cells; less in proportion on finer ones. So small that sound, whose phase at the end
/// differs from one size to the other, does not count.
const SPEED: f64 = 0.002;
/// Decay times of velocity that are run: sound decays twice as fast, and is gone at the end.
const DECAY: f64 = 3.0;

/// Error of velocity and of viscosity.
pub(crate) struct Decayed {
    /// Over the velocity that is left.
    pub(crate) velocity: f64,
    viscosity: f64,
}

/// Vortices in a periodic square.
pub(crate) struct Vortices {
    pub(crate) operator: Operator,
    /// Cells across.
    pub(crate) side: usize,
    /// Relaxation time in steps.
    pub(crate) tau: f64,
    /// Largest speed at the start, in cells per step.
    pub(crate) speed: f64,
    /// Decay times of velocity that are run.
    pub(crate) decay: f64,
}

pub(crate) fn taylor_green(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for (name, operator) in OPERATORS {
        let mut found: Vec<(&str, Vec<(f64, Decayed)>)> = vec![("", Vec::new()), ("", Vec::new())];
        for side in [32, 48, 64] {
            for (entry, (lattice, decayed)) in found.iter_mut().zip(on_both!(decay(operator, side))) {
                entry.0 = lattice;
                entry.1.push((1.0 / side as f64, decayed));
            }
        }
        for (lattice, errors) in found {
            let last = errors.last().map_or(f64::NAN, |(_, decayed)| decayed.viscosity);
            let metric = format!("{lattice}, {name}: viscosity over that asked for, 64 cells");
            rows.add(Measure::absolute(Tier::ClosedForm, metric, last, 1.0, 1e-3));
            let points: Vec<(f64, f64)> = errors.iter().map(|(h, decayed)| (*h, decayed.velocity)).collect();
            let metric =
                format!("{lattice}, {name}: order in space, steps in proportion to the square of cells");
            let listed: Vec<String> = points.iter().map(|(_, error)| format!("{error:.2e}")).collect();
            let measure = Measure::absolute(Tier::Order, metric, order(&points), 2.0, 0.1);
            rows.add(measure.note(format!("errors at 32, 48 and 64 cells: {}", listed.join(" "))));
        }
    }
    Ok(())
}

fn decay<L: Lattice<Q>, const Q: usize>(operator: Operator, side: usize) -> Result<Decayed, Failure> {
    let speed = SPEED * 32.0 / side as f64;
    Vortices { operator, side, tau: 0.8, speed, decay: DECAY }.run::<L, Q, f64>()
}

impl Vortices {
    pub(crate) fn run<L: Lattice<Q>, const Q: usize, T: Real>(&self) -> Result<Decayed, Failure> {
        let Self { operator, side, tau, speed, decay } = *self;
        let depth = if L::Dim::N == 3 { 2 } else { 1 };
        let mut setup = Setup::<L::Dim>::new([side, side, depth], 1.0, 1.0, tau);
        setup.operator = operator;
        let density = setup.density;
        let dt = setup.time_step;
        let speed = speed * setup.lattice_speed();
        let k = TAU / side as f64;
        let steps = (decay / (2.0 * k * k * dt)).round() as u64;
        let time = steps as f64 * dt;
        let exact = move |point: <L::Dim as Dim>::Vec, time: f64| {
            let (x, y) = (k * point.component(0), k * point.component(1));
            let fade = (-2.0 * k * k * time).exp();
            let velocity = <L::Dim as Dim>::Vec::along(0, -speed * x.cos() * y.sin() * fade)
                + Vector::along(1, speed * x.sin() * y.cos() * fade);
            let pressure = -0.25 * density * (speed * fade).powi(2) * ((2.0 * x).cos() + (2.0 * y).cos());
            Flow { pressure, velocity }
        };
        let mut lbm = Lbm::<L, Q, T>::new(setup).expect(FITS);
        lbm.set_flow(|point| exact(point, 0.0));
        let before = sums(&lbm, |point| exact(point, 0.0).velocity);
        advance(&mut lbm, steps)?;
        let after = sums(&lbm, |point| exact(point, time).velocity);
        let viscosity = (before.energy / after.energy).ln() / (4.0 * k * k * time);
        Ok(Decayed { velocity: (after.difference / after.exact).sqrt(), viscosity })
    }
}

struct Sums {
    energy: f64,
    difference: f64,
    exact: f64,
}

fn sums<L: Lattice<Q>, const Q: usize, T: Real>(
    lbm: &Lbm<L, Q, T>,
    exact: impl Fn(<L::Dim as Dim>::Vec) -> <L::Dim as Dim>::Vec,
) -> Sums {
    let side = lbm.setup().cells[0];
    let mut sums = Sums { energy: 0.0, difference: 0.0, exact: 0.0 };
    for (x, y) in (0..side).flat_map(|x| (0..side).map(move |y| (x, y))) {
        let cell = [x, y, 0];
        let Some(flow) = lbm.flow(cell) else { continue };
        let expected = exact(lbm.centre(cell));
        sums.energy += flow.velocity.length_squared();
        sums.difference += (flow.velocity - expected).length_squared();
        sums.exact += expected.length_squared();
    }
    sums
}
