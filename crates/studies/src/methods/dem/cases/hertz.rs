//! Impacts of elastic grains: closed form, restitution at every speed, order of the scheme.

use super::restitution::gaps;
use super::strike::{Outcome, Strike};
use crate::validate::Effort;
use crate::validate::reference::{columns, named_texts};
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim, StepError};
use granular_dem::{Elasticity, Tension};
use granular_driver::failure::Failure;
use granular_driver::statistics::{order, root_mean_square};
use granular_validation_data::{CHUNG_OOI, HERTZ_IMPACT};

/// Steps in an impact where none are studied.
const STEPS: f64 = 500.0;
/// Gap before it, in steps.
const GAP: f64 = 1.37;
/// Steps in the duration without damping; none divides it.
pub(crate) const RESOLUTIONS: [f64; 6] = [23.1, 47.3, 95.7, 193.1, 387.7, 777.9];
/// Random gaps that an order is taken over.
const GAPS: usize = 128;
const CUTS: [(Tension, &str); 2] = [(Tension::Cut, "tension cut"), (Tension::Kept, "tension kept")];

/// One line of the table of Chung and Ooi.
struct Test {
    number: f64,
    material: String,
    friction: f64,
    speed: f64,
    strike: Strike,
}

fn tests() -> Vec<Test> {
    let names =
        ["test", "young_modulus", "poisson_ratio", "density", "radius", "friction", "restitution", "speed"];
    let rows = columns(CHUNG_OOI, names).into_iter().zip(named_texts(CHUNG_OOI, "material"));
    rows.map(
        |([number, young_modulus, poisson_ratio, density, radius, friction, restitution, speed], name)| {
            let strike = Strike {
                elasticity: Elasticity { young_modulus, poisson_ratio },
                density,
                radius,
                restitution,
                friction,
                on_plane: number > 1.0 && number < 5.0,
                velocity: [0.0, speed],
                spin: 0.0,
                tension: Tension::Cut,
                steps: STEPS,
            };
            Test { number, material: name, friction, speed, strike }
        },
    )
    .collect()
}

pub(super) fn impact(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    closed_form(rows)?;
    for restitution in [0.9, 0.5, 0.2] {
        for (tension, name) in CUTS {
            for speed in [1e-3, 0.1, 3.0] {
                let found = Strike::of_glass(restitution, tension, speed, STEPS).measured::<D3>(GAP)?;
                let metric = format!("e at {speed} m/s, {name}, target {restitution}");
                rows.add(Measure::absolute(Tier::ClosedForm, metric, found, restitution, 1e-4));
            }
        }
    }
    orders::<D2>(rows)?;
    Ok(orders::<D3>(rows)?)
}

/// Tests 1 and 2 against the table.
fn closed_form(rows: &mut Rows) -> Result<(), StepError> {
    let table = columns(HERTZ_IMPACT, ["test", "delta_max_m", "F_max_N", "duration_s"]);
    for (test, [number, overlap, force, duration]) in tests().iter().zip(table) {
        let found = test.strike.outcome::<D3>(GAP)?;
        let name = format!("test {number}, {}", test.material);
        let mut add = |what: &str, unit: f64, value: f64, reference: f64| {
            let metric = format!("{name}: {what}");
            let measure = Measure::relative(Tier::ClosedForm, metric, unit * value, unit * reference, 1e-3);
            rows.add(measure);
        };
        add("largest overlap [um]", 1e6, found.overlap, overlap);
        add("largest force [N]", 1.0, found.force, force);
        add("duration [us]", 1e6, found.duration, duration);
    }
    Ok(())
}

/// Errors of the restitution over random gaps.
pub(crate) fn errors<D: Dim>(strike: Strike, count: usize) -> Result<Vec<f64>, StepError> {
    gaps(count).into_iter().map(|gap| Ok(strike.measured::<D>(gap)? - strike.restitution)).collect()
}

fn orders<D: Dim>(rows: &mut Rows) -> Result<(), StepError> {
    for (tension, name) in CUTS {
        for restitution in [0.9, 0.75, 0.5, 0.3] {
            let point = |&steps: &f64| {
                let strike = Strike::of_glass(restitution, tension, 0.1, steps);
                Ok((1.0 / steps, root_mean_square(&errors::<D>(strike, GAPS)?)))
            };
            let found = order(&RESOLUTIONS.iter().map(point).collect::<Result<Vec<_>, StepError>>()?);
            let metric = format!("{}s: order of the error of e = {restitution}, {name}", D::BALL);
            let measure = Measure::judged(Tier::Order, metric, [found, 2.0], (2.0 - found).max(0.0), 0.1);
            rows.add(measure.note("at least 1.9"));
        }
    }
    Ok(())
}

/// The benchmark impacts of Chung and Ooi.
pub(super) fn chung_ooi(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    for test in tests() {
        let name = format!("test {}, {}", test.number, test.material);
        match test.number as u32 {
            1 | 2 => hertz(rows, &name, &test.strike)?,
            3 => restitutions(rows, &name, &test.strike)?,
            4 => oblique(rows, &name, &test)?,
            _ => spinning(rows, &name, &test)?,
        }
    }
    Ok(())
}

fn hertz(rows: &mut Rows, name: &str, strike: &Strike) -> Result<(), StepError> {
    let (found, exact) = (strike.outcome::<D3>(GAP)?, strike.elastic::<D3>());
    let metric = format!("{name}: largest force [N]");
    rows.add(Measure::relative(Tier::ClosedForm, metric, found.force, exact.largest_force(), 1e-2));
    let metric = format!("{name}: largest overlap [um]");
    let (value, reference) = (1e6 * found.overlap, 1e6 * exact.largest_overlap());
    rows.add(Measure::relative(Tier::ClosedForm, metric, value, reference, 1e-2));
    Ok(())
}

fn restitutions(rows: &mut Rows, name: &str, strike: &Strike) -> Result<(), StepError> {
    for restitution in [0.2, 0.4, 0.6, 0.8, 1.0] {
        let found = Strike { restitution, ..*strike }.measured::<D3>(GAP)?;
        let metric = format!("{name}: speed after over speed before, e = {restitution}");
        rows.add(Measure::absolute(Tier::ClosedForm, metric, found, restitution, 1e-3));
    }
    Ok(())
}

fn oblique(rows: &mut Rows, name: &str, test: &Test) -> Result<(), StepError> {
    for degrees in [40.0_f64, 55.0, 70.0, 85.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let strike = Strike { velocity: [test.speed * sin, test.speed * cos], ..test.strike };
        let lost = test.friction * (1.0 + strike.restitution) * strike.velocity[1];
        let found = strike.outcome::<D3>(GAP)?;
        let name = format!("{name}, {degrees} deg");
        slid(rows, &name, &strike, &found, lost);
    }
    Ok(())
}

/// The surfaces slide throughout: speed along the surface and spin after the impact.
fn slid(rows: &mut Rows, name: &str, strike: &Strike, found: &Outcome, lost: f64) {
    let (metric, reference) = (format!("{name}: v_t' [m/s]"), strike.velocity[0] - lost);
    rows.add(Measure::relative(Tier::ClosedForm, metric, found.velocity[0], reference, 1e-2));
    let (metric, reference) = (format!("{name}: spin' [rad/s]"), strike.spin + 2.5 * lost / strike.radius);
    rows.add(Measure::relative(Tier::ClosedForm, metric, found.spin, reference, 1e-2));
}

fn spinning(rows: &mut Rows, name: &str, test: &Test) -> Result<(), StepError> {
    for spin in [6.0, 12.0, 22.0] {
        // The lowest point of the first sphere moves forward: friction pushes it back.
        let strike = Strike { spin: -spin, ..test.strike };
        // Half of the change that the relative speed makes, which is twice that of each.
        let lost = test.friction * (1.0 + strike.restitution) * strike.velocity[1];
        let found = strike.outcome::<D3>(GAP)?;
        slid(rows, &format!("{name}, {spin} rad/s"), &strike, &found, lost);
    }
    Ok(())
}
