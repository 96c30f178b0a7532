//! Run-out of a column: the band of the literature, and what single sources claim.

use super::collapse::{Collapse, Fallen};
use crate::validate::Effort;
use crate::validate::reference::named;
use crate::validate::{Measure, Rows, Tier};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_driver::statistics::mean_and_error;
use granular_validation_data::COLUMN_RUNOUT;

/// Run-out over aspect ratio in two dimensions: Lube et al. 2005, and the farthest simulations.
const BAND: [f64; 2] = [1.2, 2.8];
/// Rolling friction with which a deposit comes to rest within the run: a disk that rolls at
/// 0.3 m/s stops after 7 cm.
const ROLLING_FRICTION: f64 = 0.1;
/// Disks with which a run-out can be judged: in fewer the front is a few disks.
const BEARS: usize = 1000;
/// Share by which a claim may be missed.
const NEAR: f64 = 0.15;

pub(super) fn run_out(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let samples: &[(usize, u64)] =
        if effort == Effort::Full { &[(400, 8), (1000, 6), (3000, 4)] } else { &[(400, 3)] };
    for &(grains, seeds) in samples {
        rows.claims_need(grains, BEARS);
        let seeds: Vec<u64> = (1..=seeds).collect();
        let of = |seed: u64, rolling: f64| {
            let column = Collapse::of(grains).seed(seed);
            let set = |material: &str| format!("materials.{material}.rolling_friction={rolling}");
            column.set(set("glass")).set(set("wall")).run()
        };
        let resisting = parallel::each(&seeds, |&seed| of(seed, ROLLING_FRICTION))?;
        let free = parallel::each(&seeds, |&seed| of(seed, 0.0))?;
        let sample = |text: &str| format!("{grains} disks {text}: run-out over a, mean of {}", seeds.len());
        let resisting_at_rest = sample(&format!("with rolling friction {ROLLING_FRICTION}, at rest"));
        rows.add(band(resisting_at_rest, &resisting, Fallen::run_out));
        rows.add(band(sample("free to roll, at 3.54 sqrt(H/g)"), &free, Fallen::run_out_of_flow));
        rows.add(band(sample("free to roll, at 8 sqrt(H/g)"), &free, Fallen::run_out).claim());
        claims(rows, grains, &resisting);
    }
    Ok(())
}

fn listed(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.3}")).collect::<Vec<_>>().join(" ")
}

fn band(metric: String, fallen: &[Fallen], run_out: impl Fn(&Fallen) -> f64) -> Measure {
    let shares: Vec<f64> = fallen.iter().map(|one| run_out(one) / one.aspect_ratio()).collect();
    let mean_of = |value: fn(&Fallen) -> f64| mean_and_error(&fallen.iter().map(value).collect::<Vec<_>>()).0;
    let (mean, error) = mean_and_error(&shares);
    let middle = 0.5 * (BAND[0] + BAND[1]);
    Measure::absolute(Tier::OtherCode, metric, mean, middle, 0.5 * (BAND[1] - BAND[0])).note(format!(
        "the band is {} to {} (Lube et al. 2005; two-dimensional simulations); standard error {error:.3}; \
         by seed {}; mean a at the opening of the gate {:.3}; at 8 sqrt(H/g) {:.3} of the kinetic energy at the \
         end of the flow is left, rotation over translation {:.3} (1/2 for disks that roll)",
        BAND[0],
        BAND[1],
        listed(&shares),
        mean_of(Fallen::aspect_ratio),
        mean_of(|one| one.still_moving),
        mean_of(|one| one.rotation),
    ))
}

fn claims(rows: &mut Rows, grains: usize, fallen: &[Fallen]) {
    let run_outs: Vec<f64> = fallen.iter().map(Fallen::run_out).collect();
    let (mean, error) = mean_and_error(&run_outs);
    let (least, most) =
        run_outs.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &r| (low.min(r), high.max(r)));
    let reasons = [
        (
            "experiment",
            Tier::Experiment,
            "a channel with friction at its sides, thousands of beads; here a plane",
        ),
        (
            "thesis DEM",
            Tier::Thesis,
            "the text does not give density, stiffness as run, or seeds of this sample",
        ),
        ("thesis DEM loose", Tier::Thesis, "79 % solid and sizes over a range of 1.8; here a deposit of 1.5"),
        ("thesis DEM dense", Tier::Thesis, "83 % solid and sizes over a range of 1.8; here a deposit of 1.5"),
    ];
    for (name, tier, reason) in reasons {
        let reference = named(COLUMN_RUNOUT, name, "run_out");
        let metric = format!("{grains} disks: run-out against the {name}");
        let measure = Measure::relative(tier, metric, mean, reference, NEAR).claim();
        rows.add(measure.note(format!(
            "mean of {} seeds with standard error {error:.3}, from {least:.3} to {most:.3}; {reason}",
            fallen.len()
        )));
    }
}
