//! Packing density of the bulk of a column from Voronoi cells, over the threshold of the free surface.

use super::collapse::Collapse;
use crate::validate::Effort;
use crate::validate::reference::named;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, Dim, GrainMotion, Numbers, Provides};
use granular_dem::{Dem, Partner};
use granular_driver::failure::Failure;
use granular_driver::model::Model;
use granular_driver::parallel;
use granular_tessellate::FREE_SURFACE;
use granular_validation_data::PACKING_DENSITY;
use std::any::Any;

/// Cells larger than this many times the mean are free surface.
const THRESHOLDS: [f64; 8] = [1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 6.0];
/// Between these the density should not depend on the threshold.
const STEADY: [f64; 2] = [1.5, 3.0];
/// Height over width of the column, and when it is looked at in units of sqrt(H/g).
const ASPECT_RATIO: f64 = 6.0;
const TIME: f64 = 3.0;

/// What is seen of a state.
#[derive(Clone, Debug)]
struct Seen {
    densities: [f64; THRESHOLDS.len()],
    /// Share of the grains that count at the default threshold.
    counted: f64,
    /// Vertical stress of all cells times their area, over what it should be.
    virial: f64,
}

impl Seen {
    fn at(&self, threshold: f64) -> f64 {
        let index = THRESHOLDS.iter().position(|&other| other == threshold);
        index.map_or(f64::NAN, |index| self.densities[index])
    }

    /// Largest change of the density where it should be steady, over the density at the default.
    fn change(&self) -> f64 {
        let within = THRESHOLDS.iter().filter(|t| (STEADY[0]..=STEADY[1]).contains(*t)).map(|&t| self.at(t));
        let (low, high) = within.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        (high - low) / self.at(FREE_SURFACE)
    }

    fn curve(&self) -> String {
        let points = THRESHOLDS.iter().zip(&self.densities);
        let points: Vec<String> = points.map(|(t, density)| format!("{t}: {:.2}", 100.0 * density)).collect();
        points.join(", ")
    }
}

/// Disks with which the density of a flow can be judged.
const BEARS: usize = 1000;

pub(super) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let (grains, seeds): (usize, &[u64]) =
        if effort == Effort::Full { (3000, &[1, 2, 3, 4]) } else { (300, &[1]) };
    rows.claims_need(grains, BEARS);
    let seen = parallel::each(seeds, |&seed| {
        let column = Collapse::of(grains).seed(seed).set(format!("sample.aspect_ratio={ASPECT_RATIO}"));
        column.watch(TIME, look)
    })?;
    let mean = |of: &dyn Fn(&[Seen; 2]) -> f64| seen.iter().map(of).sum::<f64>() / seen.len() as f64;
    for (state, name) in [(0, "at rest"), (1, "at 3 sqrt(H/g)")] {
        let metric = format!("{grains} disks {name}: stress of cells times area, over forces times heights");
        let virials = seen.iter().map(|seen| seen[state].virial);
        let worst = virials.max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())).unwrap_or(f64::NAN);
        rows.add(Measure::absolute(Tier::Identity, metric, worst, 1.0, 1e-9).note("worst of the seeds"));
        let metric = format!("{grains} disks {name}: change of the density for thresholds from 1.5 to 3");
        let change = mean(&|seen| seen[state].change());
        let curves: Vec<String> = seen.iter().map(|seen| seen[state].curve()).collect();
        let measure = Measure::absolute(Tier::Thesis, metric, change, 0.0, 0.005).claim();
        let counted = mean(&|seen| seen[state].counted);
        rows.add(measure.note(format!(
            "threshold: density in % by seed: {}; {:.1} % of the disks count at {FREE_SURFACE}",
            curves.join(" | "),
            100.0 * counted
        )));
    }
    let reference = named(PACKING_DENSITY, "thesis", "density");
    let metric = format!("{grains} disks: bulk density at 3 sqrt(H/g)");
    let density = mean(&|seen| seen[1].at(FREE_SURFACE));
    let settled = mean(&|seen| seen[0].at(FREE_SURFACE));
    let measure = Measure::relative(Tier::Thesis, metric, density, reference, 0.01).claim();
    rows.add(measure.note(format!(
        "threshold {FREE_SURFACE}, {settled:.4} at rest before; the thesis gives neither its threshold nor the number of \
         grains, nor the density before the collapse"
    )));
    Ok(())
}

fn look(model: &Model) -> Result<Seen, Failure> {
    let any: &dyn Any = model.simulation.solver();
    let dem = any.downcast_ref::<Dem<D2>>().expect("the template is of disks");
    let densities = THRESHOLDS.map(|threshold| number(model, threshold, "bulk_density"));
    // No threshold: all cells.
    let names = ["bulk_stress_yy", "bulk_density"];
    let [stress, density] = names.map(|name| number(model, f64::MAX, name));
    let grains = Provides::<GrainMotion<D2>>::view(dem);
    let disks: f64 = grains.iter().map(|(_, _, radius)| D2::ball_volume(radius)).sum();
    Ok(Seen {
        densities,
        counted: number(model, FREE_SURFACE, "bulk_grains") / dem.len() as f64,
        virial: stress * disks / density / expected(dem),
    })
}

/// What the vertical stress of all cells times their area is \[N m/m\]: forces of contacts on grains times the heights of their
/// centres, less the forces of walls times the heights at which they act.
fn expected(dem: &Dem<D2>) -> f64 {
    let grains = Provides::<GrainMotion<D2>>::view(dem);
    let forces = dem.contact_forces();
    let mut sum: f64 =
        grains.iter().zip(&forces).map(|((_, motion, _), force)| force.y * motion.position.y).sum();
    dem.visit_contacts(&mut |contact| {
        if let Partner::Wall(_) = contact.partner {
            let arm = contact.normal * (grains.radius(contact.first) - 0.5 * contact.overlap);
            sum -= contact.force.y * (grains.motion(contact.first).position - arm).y;
        }
    });
    sum
}

fn number(model: &Model, threshold: f64, name: &str) -> f64 {
    let mut numbers = Numbers::wanting([name]);
    model.member(None).show(&model.simulation, threshold, &mut numbers);
    numbers.get(name).unwrap_or(f64::NAN)
}
