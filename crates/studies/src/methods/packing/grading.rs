//! Sizes follow the cumulative beta curve \[Kumar2014, eq. 3.53-3.57\].

use crate::validate::Effort;
use crate::validate::reference::columns;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, D3, Dim};
use granular_driver::failure::Failure;
use granular_packing::{Grading, finer_by_volume};
use granular_validation_data::GRADING;

const GRAINS: usize = 3000;

pub(super) fn run(rows: &mut Rows, _: Effort) -> Result<(), Failure> {
    let (min, max) = (0.92e-3, 1.38e-3);
    let grading = Grading::Beta { min, max, a: 4.0, b: 4.0 };
    let data = columns(GRADING, ["reduced_diameter", "finer"]);
    let at = |reduced: f64| min + reduced * (max - min);
    let curve = data.iter().map(|&[reduced, finer]| (grading.cumulative(at(reduced)) - finer).abs());
    let (metric, worst) = ("largest distance of the curve asked for", curve.fold(0.0, f64::max));
    rows.add(Measure::absolute(Tier::ClosedForm, metric, worst, 0.0, 1e-7));
    let [plane, space] = [distance::<D2>(&grading, &data)?, distance::<D3>(&grading, &data)?];
    for (worst, what) in [(plane, "area, disks"), (space, "volume, spheres")] {
        let metric = format!("largest distance of {GRAINS} grains by {what}");
        rows.add(Measure::absolute(Tier::ClosedForm, metric, worst, 0.0, 0.01));
    }
    Ok(())
}

/// Largest distance of the grading of a sample from reference points.
fn distance<D: Dim>(grading: &Grading, data: &[[f64; 2]]) -> Result<f64, Failure> {
    let radii = grading.sample::<D>(GRAINS, 1).map_err(|error| Failure::Io(error.to_string()))?;
    let (min, max) = (grading.smallest(), grading.largest());
    let at = |reduced: f64| min + reduced * (max - min);
    let gaps = data.iter().map(|&[reduced, finer]| (finer_by_volume::<D>(&radii, at(reduced)) - finer).abs());
    Ok(gaps.fold(0.0, f64::max))
}
