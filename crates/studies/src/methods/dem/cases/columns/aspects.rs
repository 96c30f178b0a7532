//! Run-out and height over the aspect ratio, random and hexagonal \[Kumar2014, figures 4.6 and 4.7\].

use super::{Column, NEAR, RESIDUAL, listed};
use crate::methods::dem::cases::recorded::Recorded;
use crate::validate::reference::columns as reference;
use crate::validate::{Measure, Rows, Tier};
use granular_driver::statistics::PowerLaw;
use granular_validation_data::COLUMN_STUDIES;

/// Aspect ratio at which the run-out turns from a line to a power \[Kumar2014, eq. 4.6\].
const SWITCH: f64 = 2.7;
/// Up to here the height is that of the column, and from here on a power.
const UNTOUCHED: f64 = 0.65;
const HEAP: f64 = 0.95;
/// Mean diameter of the disks \[m\].
const MEAN_DIAMETER: f64 = 1.15e-3;

/// A column and what came of it.
type Pair<'a> = (&'a Column, &'a Recorded);

pub(super) fn rows(rows: &mut Rows, of: &str, columns: &[Column], recorded: &[Recorded]) {
    let pairs = || columns.iter().zip(recorded);
    let random: Vec<Pair<'_>> = pairs().filter(|(column, _)| !column.hexagonal).collect();
    let hexagonal: Vec<Pair<'_>> = pairs().filter(|(column, _)| column.hexagonal).collect();
    let residual = recorded.iter().map(Recorded::residual).fold(0.0, f64::max);
    let unsettled = recorded.iter().filter(|one| !one.settled).count();
    let metric = format!("{of}: energy missing in the balance since the release, over the potential energy");
    rows.add(Measure::absolute(Tier::Conservation, metric, residual, 0.0, RESIDUAL).note(format!(
        "largest of {} columns, {unsettled} of them not at rest at the release",
        recorded.len()
    )));
    run_outs(rows, of, &random);
    shortest(rows, of, &random, &hexagonal);
    heights(rows, of, &random);
}

fn run_outs(rows: &mut Rows, of: &str, random: &[Pair<'_>]) {
    let known = reference(COLUMN_STUDIES, ["aspect_ratio", "experiment", "thesis_dem"]);
    let [experiment, thesis] =
        [1, 2].map(|place| known.iter().map(|row| (row[0], row[place])).collect::<Vec<_>>());
    for (column, fallen) in random {
        let a = fallen.aspect_ratio();
        let metric = format!("{of}: run-out of the column of {}", column.nominal);
        let measured = fallen.run_out();
        let measure = Measure::relative(Tier::Experiment, metric, measured, at(&experiment, a), NEAR).claim();
        rows.add(measure.note(format!(
            "a = {a:.3} at the release; there the DEM of the thesis has {:.3}, both between its points; here a plane of disks \
             that resist rolling by 0.1, in the experiment a channel of glass beads with friction at its sides",
            at(&thesis, a)
        )));
    }
    let points: Vec<(f64, f64)> =
        random.iter().map(|(_, fallen)| (fallen.aspect_ratio(), fallen.run_out())).collect();
    let part = |from: f64, to: f64| {
        points.iter().copied().filter(|(a, _)| (from..to).contains(a)).collect::<Vec<_>>()
    };
    let line = part(0.3, SWITCH);
    let metric = format!("{of}: exponent of the run-out from a = 0.4 to {SWITCH}");
    let law = PowerLaw::through(&line);
    rows.add(Measure::absolute(Tier::Thesis, metric, law.exponent, 1.0, 0.1).claim().note(format!(
        "standard error of the fit {:.3}; linear; run-out over a {}; the column of 0.2 is left out: its front is a few disks",
        law.error,
        listed(&line.iter().map(|(a, run_out)| run_out / a).collect::<Vec<_>>())
    )));
    let power = part(3.0, f64::INFINITY);
    let metric = format!("{of}: exponent of the run-out from a = 4 on");
    let law = PowerLaw::through(&power);
    rows.add(Measure::absolute(Tier::Thesis, metric, law.exponent, 0.625, 0.125).claim().note(format!(
        "standard error of the fit {:.3}; claim 0.5 to 0.75; points of the thesis 0.54, experiment 0.62, laws 2/3 to 0.7; the \
         tip is a layer of a few disks, whose height is a smaller share of a low deposit when there are more of them",
        law.error,
    )));
}

/// Value at x of the power law through the two points about it, or the nearest two.
fn at(points: &[(f64, f64)], x: f64) -> f64 {
    let after = points.iter().position(|(other, _)| *other >= x).unwrap_or(points.len());
    let first = after.clamp(1, points.len() - 1) - 1;
    let [(x0, y0), (x1, y1)] = [points[first], points[first + 1]];
    y0 * (x / x0).powf((y1 / y0).ln() / (x1 / x0).ln())
}

/// How many hexagonal columns spread less than random ones of the same aspect ratio.
fn shortest(rows: &mut Rows, of: &str, random: &[Pair<'_>], hexagonal: &[Pair<'_>]) {
    let over = |(_, fallen): &Pair<'_>| fallen.run_out() / fallen.aspect_ratio();
    let beside = hexagonal.iter().filter_map(|one| {
        let other = random.iter().find(|other| other.0.nominal == one.0.nominal)?;
        Some((one.0.nominal, over(one) / over(other)))
    });
    let ratios: Vec<(f64, f64)> = beside.collect();
    let shorter = ratios.iter().filter(|(_, ratio)| *ratio < 1.0).count();
    let list: Vec<String> = ratios.iter().map(|(a, ratio)| format!("{a}: {ratio:.2}")).collect();
    let metric = format!("{of}: share of the hexagonal columns that spread least");
    let share = shorter as f64 / ratios.len() as f64;
    rows.add(Measure::absolute(Tier::Thesis, metric, share, 1.0, 0.0).claim().note(format!(
        "run-out over a, hexagonal over random, by a: {}; one seed of the random columns, whose scatter is about a tenth",
        list.join(", ")
    )));
}

fn heights(rows: &mut Rows, of: &str, random: &[Pair<'_>]) {
    let lost = |fallen: &Recorded| 1.0 - fallen.last("height") / fallen.height;
    let low = random.iter().filter(|(column, _)| column.nominal < UNTOUCHED);
    let losses: Vec<(f64, f64)> = low.map(|(_, fallen)| (fallen.aspect_ratio(), lost(fallen))).collect();
    let worst = losses.iter().map(|(_, loss)| loss.abs()).fold(0.0, f64::max);
    let list: Vec<String> = losses.iter().map(|(a, loss)| format!("{a:.2}: {:.1} %", 100.0 * loss)).collect();
    let lowest = random.iter().map(|(_, fallen)| fallen.height).fold(f64::INFINITY, f64::min);
    let metric = format!("{of}: height that columns up to a = 0.6 lose");
    rows.add(Measure::absolute(Tier::Thesis, metric, worst, 0.0, 0.03).claim().note(format!(
        "by a: {}; one mean disk is {:.1} % of the height of the lowest column",
        list.join(", "),
        100.0 * MEAN_DIAMETER / lowest
    )));
    let heaps = random.iter().filter(|(_, fallen)| fallen.aspect_ratio() > HEAP);
    let points: Vec<(f64, f64)> =
        heaps.map(|(_, fallen)| (fallen.aspect_ratio(), fallen.last("height") / fallen.width)).collect();
    let metric = format!("{of}: exponent of the height from a = 1 on");
    let law = PowerLaw::through(&points);
    rows.add(Measure::absolute(Tier::Thesis, metric, law.exponent, 0.33, 0.06).claim().note(format!(
        "standard error of the fit {:.3}; points of figure 4.7 give 0.30 to 0.38 (its equation 4.7 misprints 2/3)",
        law.error
    )));
}
