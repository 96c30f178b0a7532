//! The flow of a low and of a tall column over time, and where its energy goes \[Kumar2014, sections 4.2.3 and 4.2.4\].

use super::phases::Phases;
use super::{Column, NEAR};
use crate::methods::dem::cases::recorded::Recorded;
use crate::validate::reference::{columns as reference, named_texts};
use crate::validate::{Measure, Rows, Tier};
use core::f64::consts::PI;
use granular_validation_data::COLUMN_FLOW;

/// Aspect ratios of figures 4.8 to 4.14.
const LOW: f64 = 0.4;
const TALL: f64 = 6.0;
/// End of the main spreading in sqrt(H/g).
const SPREAD: f64 = 3.0;
/// Durations of the phases \[Kumar2014, section 4.2.3\], and how far from them is near.
const PHASES: [(&str, f64); 3] = [("gains speed", 0.8), ("keeps it", 2.0), ("loses it", 0.6)];
const NEAR_PHASE: f64 = 0.2;
/// Effective friction angle of the thesis for low columns.
const FRICTION: f64 = 21.0 * PI / 180.0;

pub(super) fn rows(rows: &mut Rows, of: &str, columns: &[Column], recorded: &[Recorded]) {
    for nominal in [LOW, TALL] {
        let found = columns.iter().position(|column| column.nominal == nominal && !column.hexagonal);
        if let Some(fallen) = found.map(|place| &recorded[place]) {
            let of = format!("{of}, a = {nominal}");
            spreading(rows, &of, nominal, fallen);
            energies(rows, &of, nominal, fallen);
        }
    }
}

/// A curve that the thesis draws, over sqrt(H/g).
struct Drawn {
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Drawn {
    fn of(quantity: &str, nominal: f64) -> Self {
        let wanted = format!("{quantity} at a = {nominal}");
        let names = named_texts(COLUMN_FLOW, "curve").into_iter();
        let points = names.zip(reference(COLUMN_FLOW, ["time", "value"])).filter(|(name, _)| *name == wanted);
        let (times, values) = points.map(|(_, [time, value])| (time, value)).unzip();
        Self { times, values }
    }

    fn last(&self) -> f64 {
        self.values.last().copied().unwrap_or(f64::NAN)
    }
}

/// The value of a curve at the first of its times that is not before this one.
fn at(times: &[f64], values: &[f64], time: f64) -> f64 {
    let place = times.iter().position(|t| *t >= time - 1e-9);
    place.map_or(f64::NAN, |place| values[place])
}

/// Largest value and its time.
fn peak(times: &[f64], values: &[f64]) -> (f64, f64) {
    let pairs = values.iter().copied().zip(times.iter().copied());
    pairs.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::NAN, f64::NAN))
}

fn spreading(rows: &mut Rows, of: &str, nominal: f64, fallen: &Recorded) {
    let (times, run_outs) = (fallen.times(), fallen.run_outs());
    let drawn = Drawn::of("run-out", nominal);
    if let (Some(found), Some(its)) = (Phases::of(&times, &run_outs), Phases::of(&drawn.times, &drawn.values))
    {
        let durations = |phases: Phases| [phases.gains, phases.keeps, phases.loses];
        for (((what, claim), value), its) in PHASES.into_iter().zip(durations(found)).zip(durations(its)) {
            let metric = format!("{of}: time in which the front {what}, over sqrt(H/g)");
            rows.add(Measure::absolute(Tier::Thesis, metric, value, claim, NEAR_PHASE).claim().note(format!(
                "least squares of constant acceleration, speed and deceleration, misfit {:.3}; the same fit to the curve that \
                 the thesis draws gives {its:.1}",
                found.misfit
            )));
        }
    }
    let last = fallen.run_out();
    let share = |time: f64| at(&times, &run_outs, time) / last;
    let metric = format!("{of}: share of the final run-out that is reached at {SPREAD} sqrt(H/g)");
    let its = at(&drawn.times, &drawn.values, SPREAD) / drawn.last();
    rows.add(Measure::relative(Tier::Thesis, metric, share(SPREAD), its, NEAR).claim().note(format!(
        "{:.3} at 2, {:.3} at 4, final run-out {last:.3} at {:.1}; reference: the curve that the thesis draws, whose last is {:.2}",
        share(2.0),
        share(4.0),
        times.last().copied().unwrap_or(f64::NAN),
        drawn.last()
    )));
}

fn energies(rows: &mut Rows, of: &str, nominal: f64, fallen: &Recorded) {
    let sum = |names: &[&str]| {
        let columns: Vec<Vec<f64>> = names.iter().map(|name| fallen.column(name)).collect();
        (0..columns[0].len()).map(|row| columns.iter().map(|column| column[row]).sum()).collect::<Vec<f64>>()
    };
    let scale = fallen.column("potential_energy").first().copied().unwrap_or(f64::NAN);
    let (largest, when) = peak(&fallen.times(), &sum(&["kinetic_energy", "rotational_energy"]));
    let largest = largest / scale;
    let lost = |names: &[&str]| {
        let loss = sum(names);
        (loss.last().copied().unwrap_or(f64::NAN) - loss[0]) / scale
    };
    let shares = format!(
        "of the energy at the release sliding between disks takes {:.3}, at walls {:.3}, dashpots {:.3}, rolling {:.3}",
        lost(&["loss_sliding"]),
        lost(&["loss_sliding_at_walls"]),
        lost(&["loss_normal_damping", "loss_tangential_damping"]),
        lost(&["loss_rolling"])
    );
    let left = fallen.last("potential_energy") / scale;
    let run_out = Drawn::of("run-out", nominal).last();
    if nominal == TALL {
        let its = Drawn::of("kinetic energy", nominal);
        let (its_largest, its_time) = peak(&its.times, &its.values);
        let metric = format!("{of}: largest kinetic energy over the potential energy at the release");
        rows.add(Measure::relative(Tier::Thesis, metric, largest, its_largest, NEAR).claim());
        let metric = format!("{of}: time of the largest kinetic energy, over sqrt(H/g)");
        rows.add(Measure::relative(Tier::Thesis, metric, when, its_time, NEAR).claim().note(
            "reference: the curve that the thesis draws for the same loose sample in figure 4.23; its text says 0.8",
        ));
        let metric = format!("{of}: potential energy that is left, over that at the release");
        let its = Drawn::of("potential energy", nominal).last();
        let flat = 1.0 / (1.0 + run_out);
        rows.add(Measure::relative(Tier::Thesis, metric, left, its, NEAR).claim().note(format!(
            "{shares}; a deposit as long as that of the thesis has at least {flat:.3} at the same density, which it has when it \
             is flat"
        )));
    } else {
        let metric = format!("{of}: effective friction, a over the run-out");
        let friction = fallen.aspect_ratio() / fallen.run_out();
        rows.add(Measure::relative(Tier::Thesis, metric, friction, FRICTION.tan(), NEAR).claim().note(format!(
            "21 degrees by equations 4.8 and 4.9, but the run-out that the thesis draws gives {:.2} by them; potential energy \
             left {left:.3}, largest kinetic energy {largest:.3} at {when:.2} sqrt(H/g); {shares}",
            nominal / run_out
        )));
    }
}
