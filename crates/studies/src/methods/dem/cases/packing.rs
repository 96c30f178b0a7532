//! Samples of a wanted density: dense, loose and between \[Kumar2014, chapter 4\].

use crate::validate::Effort;
use crate::validate::stages;
use crate::validate::{Measure, Rows, Tier};
use core::f64::consts::PI;
use granular_driver::failure::Failure;
use granular_driver::parallel;

/// Solid fractions of the samples of the thesis: dense and loose columns, and the pile of the slope.
const TARGETS: [(&str, f64); 3] = [("dense", 0.83), ("loose", 0.79), ("slope pile", 0.82)];
/// Allowed distance from the target, over the target.
const NEAR: f64 = 0.005;
/// Bound on the homogeneity \[Kumar2014, eq. 3.61\].
const EVEN: f64 = 0.05;
/// Bound on what the cut cells of the bulk make of a lattice.
const LATTICE: f64 = 0.01;

/// What came of a preparation.
struct Prepared {
    solid_fraction: f64,
    homogeneity: f64,
    coordination: f64,
    /// Whether it came to rest in the end.
    rests: bool,
}

pub(super) fn densities(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let (grains, seeds) = if effort == Effort::Full { (3000, 1..=3) } else { (300, 1..=1) };
    let runs: Vec<(f64, u64)> =
        TARGETS.iter().flat_map(|&(_, target)| seeds.clone().map(move |seed| (target, seed))).collect();
    let mut prepared =
        parallel::each(&runs, |&(target, seed)| prepare(grains, seed, target, effort))?.into_iter();
    for (name, target) in TARGETS {
        for seed in seeds.clone() {
            let found = prepared.next().expect("one result for each run");
            let of = format!("{name} sample of {grains} disks, seed {seed}");
            let note = format!(
                "coordination {:.2}, {} at the end",
                found.coordination,
                if found.rests { "at rest" } else { "not at rest" }
            );
            let (metric, value) = (format!("{of}: solid fraction of the bulk"), found.solid_fraction);
            // What still moves has no density yet.
            let value = if found.rests { value } else { f64::NAN };
            rows.add(Measure::relative(Tier::Thesis, metric, value, target, NEAR).note(note));
            let (metric, value) = (format!("{of}: variance of the void ratio"), found.homogeneity);
            rows.add(Measure::absolute(Tier::Thesis, metric, value, 0.0, EVEN));
        }
    }
    hexagonal(rows, grains)
}

/// The template, with springs soft enough for a quick test: overlaps stay near a thousandth of a radius.
fn prepare(grains: usize, seed: u64, target: f64, effort: Effort) -> Result<Prepared, Failure> {
    let mut edits = vec![format!("sample.extent=Grains({grains})"), format!("sample.seed={seed}")];
    edits.extend((1..=3).map(|stage| format!("stages.{stage}.end.solid_fraction={target}")));
    if effort == Effort::Quick {
        edits.push("materials.glass.normal_stiffness=4e5".to_owned());
        edits.push("materials.wall.normal_stiffness=4e5".to_owned());
        edits.push("materials.glass.restitution=0.1".to_owned());
        edits.push("stages.0.end.within=0.3 s".to_owned());
        edits.extend((1..=3).map(|stage| format!("stages.{stage}.end.within=0.06 s")));
        edits.push("stages.4.end.within=0.3 s".to_owned());
    }
    let (model, reached) = stages::run(&stages::template("sample", &edits)?)?;
    let number = |name| model.number(name).unwrap_or(f64::NAN);
    Ok(Prepared {
        solid_fraction: number("solid_fraction"),
        homogeneity: number("homogeneity"),
        coordination: number("coordination"),
        rests: reached.last() == Some(&true),
    })
}

/// A hexagonal column, whose density is known.
fn hexagonal(rows: &mut Rows, grains: usize) -> Result<(), Failure> {
    let edits = [
        format!("sample.extent=Grains({grains})"),
        "sample.packing=Hexagonal".to_owned(),
        "sample.grading=Single(\"1 mm\")".to_owned(),
        "stages=[(name: \"rest\", end: For(\"1 ms\"))]".to_owned(),
    ];
    let (model, _) = stages::run(&stages::template("sample", &edits)?)?;
    let value = model.number("solid_fraction").unwrap_or(f64::NAN);
    let (metric, exact) = ("hexagonal column: solid fraction of the bulk", PI / (2.0 * 3.0_f64.sqrt()));
    rows.add(Measure::relative(Tier::ClosedForm, metric, value, exact, LATTICE));
    Ok(())
}
