//! Dense and loose columns \[Kumar2014, section 4.3\].

use super::listed;
use crate::methods::dem::cases::recorded::{Recorded, record};
use crate::validate::reference::named;
use crate::validate::{Effort, stages};
use crate::validate::{Measure, Rows, Tier};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_driver::statistics::mean_and_error;
use granular_validation_data::COLUMN_DENSITY;

/// A sample: its solid fraction, and the height over width to ask for so that it is the one wanted at the release. A column is
/// planned for the density of a deposit, 0.815.
const SAMPLES: [(&str, f64); 2] = [("dense", 0.83), ("loose", 0.79)];
const PLANNED: f64 = 0.815;
/// What is recorded of a column.
const NUMBERS: [&str; 6] =
    ["front", "height", "potential_energy", "bulk_density", "solid_fraction", "energy_residual"];
/// Share of the potential energy at the release that may be missing in the balance.
const RESIDUAL: f64 = 1e-3;
/// Disks with which densities and run-outs of dense and loose columns can be told apart.
const BEARS: usize = 500;
/// Distances of final densities, and of densities from those of the thesis, over them.
const EQUAL: f64 = 0.005;
const NEAR: f64 = 0.01;

/// A column of the study.
#[derive(Clone, Copy, Debug)]
struct Column {
    solid_fraction: f64,
    aspect_ratio: f64,
    seed: u64,
}

/// Dense against loose: run-out, and density over time.
pub(in super::super) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let (grains, seeds): (usize, &[u64]) =
        if effort == Effort::Full { (500, &[1, 2, 3]) } else { (150, &[1]) };
    rows.claims_need(grains, BEARS);
    let aspect_ratios: &[f64] = if effort == Effort::Full { &[0.8, 6.0] } else { &[0.8] };
    let mut columns = Vec::new();
    for &aspect_ratio in aspect_ratios {
        for (_, solid_fraction) in SAMPLES {
            columns.extend(seeds.iter().map(|&seed| Column { solid_fraction, aspect_ratio, seed }));
        }
    }
    let recorded = parallel::each(&columns, |column| collapse(grains, *column, effort))?;
    let residual = recorded.iter().map(Recorded::residual).fold(0.0, f64::max);
    let metric =
        format!("{grains} disks: energy missing in the balance since the release, over the potential energy");
    rows.add(
        Measure::absolute(Tier::Conservation, metric, residual, 0.0, RESIDUAL)
            .note(format!("largest of {} columns", recorded.len())),
    );
    let mut groups = recorded.chunks(seeds.len());
    for &aspect_ratio in aspect_ratios {
        let [Some(dense), Some(loose)] = [groups.next(), groups.next()] else { break };
        let count = if seeds.len() == 1 { "one seed".to_owned() } else { format!("{} seeds", seeds.len()) };
        let of = format!("{grains} disks, {count}, a = {aspect_ratio}");
        spread(rows, &of, aspect_ratio, [dense, loose]);
        if aspect_ratio < 1.0 {
            densities(rows, &of, [dense, loose]);
        }
    }
    Ok(())
}

/// The template of a sample with a gate, and a stage in which it opens and the walls are as rough as in the thesis.
fn collapse(grains: usize, column: Column, effort: Effort) -> Result<Recorded, Failure> {
    let Column { solid_fraction, aspect_ratio, seed } = column;
    let quick = effort == Effort::Quick;
    let [deposit, ease, rest] = if quick { [0.3, 0.06, 0.3] } else { [0.5, 0.1, 0.5] };
    let eased = |friction: f64| {
        format!(
            "(name: \"ease to {friction}\", changes: [Friction(material: \"glass\", value: {friction})], \
             end: Packed(solid_fraction: {solid_fraction}, within: \"{ease} s\"))"
        )
    };
    let quiet = |within: f64| format!("Quiet(kinetic_over_potential: 1e-6, within: \"{within} s\")");
    let stages = [
        format!("(name: \"deposit\", end: {})", quiet(deposit)),
        eased(0.15),
        eased(0.05),
        eased(0.0),
        format!(
            "(name: \"rest\", changes: [StopMotion, Friction(material: \"glass\", value: 0.53)], end: {})",
            quiet(rest)
        ),
        "(name: \"collapse\", changes: [Friction(material: \"wall\", value: 0.466)], end: For(\"1 s\"))"
            .to_owned(),
    ];
    let mut edits = vec![
        format!("sample.extent=Grains({grains})"),
        format!("sample.aspect_ratio={}", aspect_ratio * solid_fraction / PLANNED),
        format!("sample.seed={seed}"),
        "sample.grading.min=0.82 mm".to_owned(),
        "sample.grading.max=1.48 mm".to_owned(),
        "materials.wall.rolling_friction=0.1".to_owned(),
        "walls.2=Gate(material: \"wall\", opens: \"collapse\")".to_owned(),
        format!("stages=[{}]", stages.join(", ")),
    ];
    if quick {
        edits.push("materials.glass.normal_stiffness=4e5".to_owned());
        edits.push("materials.wall.normal_stiffness=4e5".to_owned());
    }
    record(&stages::template("sample", &edits)?, &NUMBERS, if quick { 5.0 } else { 8.0 })
}

/// Means over seeds of a number of each column.
fn means(columns: &[Recorded], of: impl Fn(&Recorded) -> f64) -> f64 {
    columns.iter().map(of).sum::<f64>() / columns.len() as f64
}

fn spread(rows: &mut Rows, of: &str, aspect_ratio: f64, [dense, loose]: [&[Recorded]; 2]) {
    let over = |columns: &[Recorded]| {
        columns.iter().map(|one| one.run_out() / one.aspect_ratio()).collect::<Vec<_>>()
    };
    let (dense_over, loose_over) = (over(dense), over(loose));
    let [(dense_mean, dense_error), (loose_mean, loose_error)] =
        [&dense_over, &loose_over].map(|values| mean_and_error(values));
    let ratio = dense_mean / loose_mean;
    let error = ratio * (dense_error / dense_mean).hypot(loose_error / loose_mean);
    let name =
        |sample: &str| named(COLUMN_DENSITY, &format!("{sample} run-out at a = {aspect_ratio}"), "value");
    let thesis = name("dense") / name("loose");
    let metric = format!("{of}: run-out of dense over loose columns");
    // The text: farther by 15 to 35 % at a = 0.8, about twice as far at a = 6.
    let near = if aspect_ratio < 1.0 { (1.25, 0.1) } else { (thesis, 0.2 * thesis) };
    let scatter = match dense.len() {
        1 => "one seed of each".to_owned(),
        _ => format!("standard error {error:.2}"),
    };
    let elsewhere =
        if aspect_ratio < 1.0 { "; its figure 6.39 has 1.05 for dry columns on the level" } else { "" };
    let starts = [dense, loose].map(|columns| means(columns, |one| one.column("bulk_density")[0]));
    rows.add(Measure::absolute(Tier::Thesis, metric, ratio, near.0, near.1).claim().note(format!(
        "{scatter}; figures of the thesis {thesis:.2}{elsewhere}; run-out over a by seed: dense {}, loose {}; mean a at the \
         release {:.3}, {:.3}; bulk density there {:.4}, {:.4}",
        listed(&dense_over),
        listed(&loose_over),
        means(dense, Recorded::aspect_ratio),
        means(loose, Recorded::aspect_ratio),
        starts[0],
        starts[1]
    )));
}

fn densities(rows: &mut Rows, of: &str, samples: [&[Recorded]; 2]) {
    let last = |name: &str| samples.map(|columns| means(columns, |one| one.last(name)));
    let [dense, loose] = last("bulk_density");
    let interior = last("solid_fraction");
    let metric = format!("{of}: bulk density at the end, dense against loose");
    rows.add(
        Measure::relative(Tier::Thesis, metric, dense, loose, EQUAL)
            .claim()
            .note(format!("solid fraction of the interior {:.4} and {:.4}", interior[0], interior[1])),
    );
    for ((name, _), columns) in SAMPLES.into_iter().zip(samples) {
        let least = |one: &Recorded| one.column("bulk_density").into_iter().fold(f64::INFINITY, f64::min);
        let values = [
            ("at the release", means(columns, |one| one.column("bulk_density")[0])),
            ("least", means(columns, least)),
            ("at the end", means(columns, |one| one.last("bulk_density"))),
        ];
        for (when, value) in values {
            let metric = format!("{of}, {name}: bulk density {when}");
            let reference = named(COLUMN_DENSITY, &format!("{name} density {when}"), "value");
            rows.add(Measure::relative(Tier::Thesis, metric, value, reference, NEAR).claim().note(
                "Voronoi cells up to twice the mean one; in a flow the density depends on that threshold, of which the thesis says \
                 nothing",
            ));
        }
    }
}
