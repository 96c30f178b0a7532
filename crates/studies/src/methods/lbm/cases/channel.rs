//! Flow between plates: steady, started, and oscillating.

use super::{FITS, OPERATORS, advance, fluid, on_both};
use crate::validate::Effort;
use crate::validate::reference::columns;
use crate::validate::{Measure, Rows, Tier};
use granular_core::glam::DVec2;
use granular_core::{D2, Dim, Vector};
use granular_driver::failure::Failure;
use granular_lbm::{D2Q9, D3Q19, Face, Lattice, Lbm, Lbm2, Operator, Setup};
use granular_validation_data::{COUETTE, POISEUILLE};
use std::f64::consts::TAU;

/// Cells between the plates of the steady cases.
const HEIGHT: usize = 9;
/// So small that the square of the Mach number is round-off.
const ACCELERATION: f64 = 1e-6;
/// Cells between the plates of the cases in time.
const FINE: usize = 40;

pub(crate) fn poiseuille(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let times: &[f64] = if effort == Effort::Full { &[0.505, 0.6, 0.933, 1.7] } else { &[0.6, 1.7] };
    for (name, operator) in OPERATORS {
        let mut worst = [("", 0.0_f64); 2];
        for &tau in times {
            for (worst, (lattice, error)) in worst.iter_mut().zip(on_both!(steady(operator, tau))) {
                *worst = (lattice, worst.1.max(error));
            }
        }
        for (lattice, error) in worst {
            let metric = format!("{lattice}, {name}: distance from the parabola with the slip of Lambda");
            let measure = Measure::absolute(Tier::ClosedForm, metric, error, 0.0, 1e-10);
            rows.add(measure.note(format!("over the largest speed; relaxation times {times:?}")));
        }
    }
    let (_, error) = on_both!(steady(Operator::DEFAULT, 0.51))[0];
    let metric = "largest speed of a steady channel, relaxation time 0.51: error, table 5.1";
    rows.add(Measure::absolute(Tier::Thesis, metric, error, 0.0, 9e-5).claim());
    rows.add(started(POISEUILLE, "y_over_H_from_wall", "u_over_Umax", false)?);
    Ok(())
}

pub(crate) fn couette(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    rows.add(started(COUETTE, "y_over_H_moving_wall_at_1", "u_over_Uwall", true)?);
    Ok(())
}

/// Largest distance of a steady channel from the parabola plus slip, over the largest speed.
fn steady<L: Lattice<Q>, const Q: usize>(operator: Operator, tau: f64) -> Result<f64, Failure> {
    let across = L::Dim::N - 1;
    let mut cells = [3, 3, if L::Dim::N == 3 { 3 } else { 1 }];
    cells[across] = HEIGHT;
    let mut setup = Setup::<L::Dim>::new(cells, 1.0, 1.0, tau);
    setup.operator = operator;
    setup.faces[across] = [Face::REST, Face::REST];
    setup.acceleration = Vector::along(0, ACCELERATION);
    let mut lbm = Lbm::<L, Q>::new(setup).expect(FITS);
    let h = HEIGHT as f64;
    let peak = ACCELERATION * h * h / 8.0;
    let slip = (16.0 * operator.magic(tau) - 3.0) / (3.0 * h * h);
    // From the parabola on, what is wrong decays as exp(-pi^2 nu t / H^2).
    lbm.set_flow(|point| {
        let y = point.component(across) / h;
        granular_lbm::Flow { pressure: 0.0, velocity: Vector::along(0, peak * 4.0 * y * (1.0 - y)) }
    });
    let steps = (3.0 * h * h / lbm.setup().time_step).ceil() as u64;
    advance(&mut lbm, steps)?;
    let error = |k: usize| {
        let mut cell = [1, 1, 0];
        cell[across] = k;
        let y = (k as f64 + 0.5) / h;
        let speed = lbm.flow(cell).map_or(f64::NAN, |flow| flow.velocity.component(0));
        (speed / peak - 4.0 * y * (1.0 - y) - slip).abs()
    };
    Ok((0..HEIGHT).map(error).fold(0.0, f64::max))
}

/// A channel at rest, driven by a body force or by its upper wall, against a series over time and height.
fn started(reference: &str, height: &str, speed: &str, by_wall: bool) -> Result<Measure, Failure> {
    let (h, tau) = (FINE as f64, 0.6);
    let mut setup = Setup::<D2>::new([3, FINE, 1], 1.0, 1.0, tau);
    // Slow, so that only the scheme and not compressibility counts.
    let top = 1e-4 * setup.lattice_speed();
    if by_wall {
        setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(top, 0.0))];
    } else {
        setup.faces[1] = [Face::REST, Face::REST];
        setup.acceleration = DVec2::new(8.0 * top / (h * h), 0.0);
    }
    let dt = setup.time_step;
    let mut lbm = fluid::<D2Q9, 9>(setup);
    let mut worst = 0.0_f64;
    let mut steps = 0;
    let mut count = 0;
    let points = columns(reference, ["nu_t_over_H2", height, speed]);
    for [time, y, expected] in points {
        let due = (time * h * h / dt).round() as u64;
        advance(&mut lbm, due.saturating_sub(steps))?;
        steps = steps.max(due);
        let wall = if by_wall { top } else { 0.0 };
        worst = worst.max((profile(&lbm, y * h, [0.0, wall]) / top - expected).abs());
        count += 1;
    }
    let metric = "largest distance from the series at any time and height, over the largest speed";
    let measure = Measure::absolute(Tier::ClosedForm, metric, worst, 0.0, 0.01);
    Ok(measure.note(format!("{count} points, {FINE} cells between the plates")))
}

/// Speed along x at a height in cells, by the parabola through three points, walls included.
fn profile(lbm: &Lbm2, y: f64, walls: [f64; 2]) -> f64 {
    let count = lbm.setup().cells[1] as i64;
    let point = |k: i64| match k {
        -1 => (0.0, walls[0]),
        k if k == count => (count as f64, walls[1]),
        k => (k as f64 + 0.5, lbm.flow([1, k as usize, 0]).map_or(f64::NAN, |flow| flow.velocity.x)),
    };
    let middle = ((y - 0.5).round() as i64).clamp(0, count - 1);
    let points = [point(middle - 1), point(middle), point(middle + 1)];
    (0..3)
        .map(|i| {
            let others = (0..3).filter(|j| *j != i);
            points[i].1 * others.map(|j| (y - points[j].0) / (points[i].0 - points[j].0)).product::<f64>()
        })
        .sum()
}

/// Plates with a body force that oscillates in time.
pub(crate) fn womersley(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let (h, tau, period, cycles) = (20.0, 0.8, 2000_u64, 4);
    let mut setup = Setup::<D2>::new([3, 20, 1], 1.0, 1.0, tau);
    setup.faces[1] = [Face::REST, Face::REST];
    let dt = setup.time_step;
    let mut lbm = fluid::<D2Q9, 9>(setup);
    let omega = TAU / (period as f64 * dt);
    let mut worst = 0.0_f64;
    let mut largest = 0.0_f64;
    for step in 0..=cycles * period {
        let time = step as f64 * dt;
        let acceleration = DVec2::new(ACCELERATION * (omega * time).cos(), 0.0);
        lbm.set_acceleration(acceleration).expect("it is finite");
        if step >= (cycles - 1) * period && step % (period / 20) == 0 {
            for k in 0..20 {
                let speed = lbm.flow([1, k, 0]).map_or(f64::NAN, |flow| flow.velocity.x);
                let expected = oscillating((k as f64 + 0.5) / h - 0.5, h, omega, time);
                worst = worst.max((speed - expected).abs());
                largest = largest.max(expected.abs());
            }
        }
        advance(&mut lbm, 1)?;
    }
    let metric = "largest distance from the solution over a period, over the largest speed";
    let womersley = 0.5 * h * omega.sqrt();
    let measure = Measure::absolute(Tier::ClosedForm, metric, worst / largest, 0.0, 0.01);
    rows.add(
        measure.note(format!(
            "half height times sqrt(omega / nu) is {womersley:.2}; 20 cells between the plates"
        )),
    );
    Ok(())
}

/// Real part of `G / (i w) (1 - cosh(q y) / cosh(q H / 2)) exp(i w t)` with `q = sqrt(i w / nu)` and unit viscosity; `y` from
/// the middle over the height.
fn oscillating(y: f64, height: f64, omega: f64, time: f64) -> f64 {
    // q = (1 + i) sqrt(w / 2): cosh of (1 + i) a is (cosh a cos a) + i (sinh a sin a).
    let root = (0.5 * omega).sqrt();
    let cosh = |a: f64| [a.cosh() * a.cos(), a.sinh() * a.sin()];
    let ([a, b], [c, d]) = (cosh(root * y * height), cosh(0.5 * root * height));
    let norm = c * c + d * d;
    let share = [1.0 - (a * c + b * d) / norm, -(b * c - a * d) / norm];
    // Divided by i: (x + i y) / i = y - i x.
    let (real, imaginary) = (share[1], -share[0]);
    let (sine, cosine) = (omega * time).sin_cos();
    ACCELERATION / omega * (real * cosine - imaginary * sine)
}
