//! Restitution, its order of convergence, contact time and largest overlap.

use super::impact::{Impact, SPEED};
use crate::validate::Effort;
use crate::validate::reference::columns;
use crate::validate::{Measure, Rows, Tier};
use granular_core::StepError;
use granular_core::random::Chance;
use granular_dem::Tension;
use granular_dem::material::damping_for_restitution;
use granular_driver::failure::Failure;
use granular_driver::statistics::{order, root_mean_square};
use granular_validation_data::RESTITUTION;

/// Random gaps that a root mean square is taken over.
const GAPS: usize = 64;
/// The same for an order: scatter of the mean square is scatter of the order.
const GAPS_OF_ORDER: usize = 512;
/// Steps times the natural frequency, from 10 to 630 in a contact; none divides a contact time.
pub(crate) const PHASE_STEPS: [f64; 7] = [0.3109, 0.1571, 0.0771, 0.0383, 0.0193, 0.00967, 0.00483];
/// The first step that an order is fitted from: about 20 in a contact.
const ASYMPTOTIC: usize = 1;
/// The step at which the error is required, times the natural frequency.
const PHASE_STEP: f64 = 0.01;

/// Gaps in steps, from one to two.
pub(crate) fn gaps(count: usize) -> Vec<f64> {
    let mut chance = Chance::new(1);
    (0..count).map(|_| 1.0 + chance.uniform()).collect()
}

/// Errors of the restitution over random gaps.
pub(crate) fn errors(impact: Impact, count: usize) -> Result<Vec<f64>, StepError> {
    gaps(count).into_iter().map(|gap| Ok(impact.measured(gap)? - impact.restitution)).collect()
}

pub(super) fn error(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let data = columns(RESTITUTION, ["restitution_kept", "restitution_cut", "damping_ratio"]);
    for (tension, name) in [(Tension::Cut, "tension cut"), (Tension::Kept, "tension kept")] {
        for &[kept, cut, _] in &data {
            let restitution = if tension == Tension::Cut { cut } else { kept };
            let errors = errors(Impact { restitution, tension, phase_step: PHASE_STEP }, GAPS)?;
            let value = restitution + errors.iter().sum::<f64>() / errors.len() as f64;
            let metric = format!("e, {name}, target {restitution:.4}");
            let error = root_mean_square(&errors);
            rows.add(Measure::judged(Tier::ClosedForm, metric, [value, restitution], error, 1e-4));
        }
        let worst = data.iter().map(|&[kept, cut, zeta]| {
            let restitution = if tension == Tension::Cut { cut } else { kept };
            (damping_for_restitution(restitution, tension) - zeta).abs()
        });
        let metric = format!("largest error of the damping ratio, {name}");
        rows.add(Measure::absolute(Tier::ClosedForm, metric, worst.fold(0.0, f64::max), 0.0, 1e-7));
    }
    for (tension, name) in [(Tension::Cut, "tension cut"), (Tension::Kept, "tension kept")] {
        for restitution in [0.9, 0.75, 0.5, 0.3] {
            let order = fitted(restitution, tension)?;
            let metric = format!("order of the error of e = {restitution}, {name}");
            let short = (2.0 - order).max(0.0);
            rows.add(
                Measure::judged(Tier::Order, metric, [order, 2.0], short, 0.1)
                    .note("at least 1.9; from 20 steps a contact on"),
            );
        }
    }
    Ok(())
}

fn fitted(restitution: f64, tension: Tension) -> Result<f64, StepError> {
    let point = |&phase_step: &f64| {
        let errors = errors(Impact { restitution, tension, phase_step }, GAPS_OF_ORDER)?;
        Ok((phase_step, root_mean_square(&errors)))
    };
    Ok(order(&PHASE_STEPS[ASYMPTOTIC..].iter().map(point).collect::<Result<Vec<_>, StepError>>()?))
}

pub(super) fn contact(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let names = ["restitution_kept", "restitution_cut", "damping_ratio", "contact_phase_cut"];
    let data = columns(RESTITUTION, names);
    for (tension, name) in [(Tension::Cut, "tension cut"), (Tension::Kept, "tension kept")] {
        for &[kept, cut, zeta, cut_phase] in data.iter().step_by(4) {
            let restitution = if tension == Tension::Cut { cut } else { kept };
            let impact = Impact { restitution, tension, phase_step: PHASE_STEP };
            let course = impact.course(gaps(1)[0])?;
            let (frequency, w) = (Impact::frequency(), (1.0 - zeta * zeta).sqrt());
            let phase = if tension == Tension::Cut { cut_phase } else { std::f64::consts::PI / w };
            let metric = format!("contact time, {name}, e = {restitution:.4} [us]");
            let (value, reference) = (1e6 * course.time, 1e6 * phase / frequency);
            rows.add(Measure::relative(Tier::ClosedForm, metric, value, reference, 1e-3));
            let deepest = SPEED / frequency * (-zeta / w * zeta.acos()).exp();
            let metric = format!("largest overlap, {name}, e = {restitution:.4} [um]");
            let (value, reference) = (1e6 * course.overlap, 1e6 * deepest);
            rows.add(Measure::relative(Tier::ClosedForm, metric, value, reference, 1e-3));
        }
    }
    Ok(())
}
