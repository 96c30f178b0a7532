//! Calibration: what a continuum of the grains of a scene is like.
//!
//! [`friction`] shears samples of the grains of a scene in a periodic cell at constant normal stress, at several
//! stresses, inertial numbers and seeds. Friction is the shear stress over the normal stress on the plane of shear, and
//!
//! ```text
//! I = rate d sqrt(density / stress)          mu = mu_s + b I           [DaCruz2005]
//! mu = mu_s + (mu_2 - mu_s) / (1 + I_0 / I)                            [Jop2006]
//! ```
//!
//! with the mean diameter `d` and the density of the grains. Every fit is made for each seed; errors are standard
//! errors of the means over seeds.

mod figure;
mod fit;
pub(crate) mod plan;
mod table;

pub use crate::material_file::{Estimate, Jop, Linear, MaterialFile, Point};
pub use figure::{figure, plot};
pub use plan::Plan;
pub use table::table;

use crate::failure::Failure;
use crate::methods::dem::sheared::{self, Flow, Stiffness};
use crate::parallel;
use crate::scene::{Dimension, Scene};
use crate::statistics::Line;
use granular_core::{D2, D3, Dim};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest inertial number that counts as slow: the critical state.
const SLOW: f64 = 0.02;

/// Told after each run how many are done, and of how many.
pub type Told<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Shears samples of the grains of a scene.
///
/// # Errors
/// When the scene has no grading, or a run stops.
pub fn friction(scene: &Scene, plan: &Plan, told: Told<'_>) -> Result<MaterialFile, Failure> {
    let scene = &with_own_contacts(scene);
    match scene.dimension {
        Dimension::Plane => calibrate::<D2>(scene, plan, told),
        Dimension::Space => calibrate::<D3>(scene, plan, told),
    }
}

/// What pairs state of contacts within one material becomes part of that material, all but constant dashpots. Other pairs do
/// not matter where one material is alone; those of unknown ones stay, to be refused.
fn with_own_contacts(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let materials = &mut scene.materials;
    let pairs = std::mem::take(&mut scene.pairs).into_iter();
    let kept = pairs.filter_map(|pair| {
        if let [one, other] = pair.between.as_slice()
            && one == other
            && let Some(material) = materials.get_mut(one)
        {
            *material = pair.applied_to(*material);
            return pair.dashpots();
        }
        pair.between.iter().any(|name| !materials.contains_key(name)).then_some(pair)
    });
    scene.pairs = kept.collect();
    scene
}

/// One run: a seed, a stress over the modulus of the packing, and an inertial number; none to compress.
#[derive(Clone, Copy, Debug)]
struct Task {
    seed: u64,
    level: f64,
    inertial_number: Option<f64>,
}

enum Outcome {
    Flow(Flow),
    Stiffness(Stiffness),
}

fn calibrate<D: Dim>(scene: &Scene, plan: &Plan, told: Told<'_>) -> Result<MaterialFile, Failure> {
    let tasks = plan.tasks();
    let done = AtomicUsize::new(0);
    let outcomes = parallel::each(&tasks, |task| {
        let outcome = match task.inertial_number {
            Some(number) => Outcome::Flow(sheared::shear::<D>(scene, plan, task.seed, task.level, number)?),
            None => Outcome::Stiffness(sheared::compress::<D>(scene, plan, task.seed, task.level)?),
        };
        told(done.fetch_add(1, Ordering::Relaxed) + 1, tasks.len());
        Ok(outcome)
    })?;
    let mut flows = Vec::new();
    let mut stiffness = Vec::new();
    for (task, outcome) in tasks.iter().zip(outcomes) {
        match outcome {
            Outcome::Flow(flow) => flows.push((*task, flow)),
            Outcome::Stiffness(one) => stiffness.push(one),
        }
    }
    Ok(summary(scene, plan, &flows, &stiffness))
}

/// A number from the points of one seed: inertial number and what was measured there.
type Measure<'a> = &'a dyn Fn(&[(f64, f64)]) -> f64;

fn summary(scene: &Scene, plan: &Plan, flows: &[(Task, Flow)], stiffness: &[Stiffness]) -> MaterialFile {
    let per_seed = |value: Measure<'_>, of: &dyn Fn(&Flow) -> f64, only: &dyn Fn(&Flow) -> bool| {
        let values = plan.seeds().map(|seed| {
            let mine = flows.iter().filter(|(task, flow)| task.seed == seed && only(flow));
            let points: Vec<(f64, f64)> = mine.map(|(_, flow)| (flow.inertial_number, of(flow))).collect();
            value(&points)
        });
        Estimate::of(&values.collect::<Vec<_>>())
    };
    let friction = |flow: &Flow| flow.friction;
    let solid = |flow: &Flow| flow.solid_fraction;
    let all = |_: &Flow| true;
    let slow = |flow: &Flow| flow.inertial_number < SLOW;
    let slowest = plan.slowest();
    let peaks = flows.iter().filter(|(task, _)| task.inertial_number == Some(slowest));
    let peaks: Vec<&Flow> = peaks.map(|(_, flow)| flow).collect();
    let of_peaks =
        |value: fn(&Flow) -> f64| Estimate::of(&peaks.iter().map(|flow| value(flow)).collect::<Vec<_>>());
    let of_stiffness =
        |value: fn(&Stiffness) -> f64| Estimate::of(&stiffness.iter().map(value).collect::<Vec<_>>());
    MaterialFile {
        version: 1,
        title: scene.title.clone(),
        dimension: scene.dimension,
        grains: plan.grains,
        seeds: plan.seeds,
        density: flows.first().map_or(f64::NAN, |(_, flow)| flow.density),
        diameter: flows.first().map_or(f64::NAN, |(_, flow)| flow.diameter),
        contact_friction: flows.first().map_or(f64::NAN, |(_, flow)| flow.contact_friction),
        critical_friction: per_seed(&fit::mean, &friction, &slow),
        critical_angle: per_seed(&|points| fit::mean(points).atan().to_degrees(), &friction, &slow),
        peak_friction: of_peaks(|flow| flow.peak_friction),
        peak_dilation: of_peaks(|flow| flow.peak_dilation.atan().to_degrees()),
        linear: Linear {
            static_friction: per_seed(&|points| Line::through(points).intercept, &friction, &all),
            slope: per_seed(&|points| Line::through(points).slope, &friction, &all),
        },
        jop: Jop {
            static_friction: per_seed(&|points| fit::saturating(points)[0], &friction, &all),
            dynamic_friction: per_seed(&|points| fit::saturating(points)[1], &friction, &all),
            inertial_number: per_seed(&|points| fit::saturating(points)[2], &friction, &all),
        },
        solid_fraction: Linear {
            static_friction: per_seed(&|points| Line::through(points).intercept, &solid, &all),
            slope: per_seed(&|points| Line::through(points).slope, &solid, &all),
        },
        young_modulus: of_stiffness(|one| one.young),
        poisson_ratio: of_stiffness(|one| one.poisson),
        points: points(plan, flows),
    }
}

/// Means over seeds at each stress and inertial number.
fn points(plan: &Plan, flows: &[(Task, Flow)]) -> Vec<Point> {
    let mut points = Vec::new();
    for (level, number) in plan.runs() {
        let mine =
            flows.iter().filter(|(task, _)| task.level == level && task.inertial_number == Some(number));
        let mine: Vec<&Flow> = mine.map(|(_, flow)| flow).collect();
        let of =
            |value: fn(&Flow) -> f64| Estimate::of(&mine.iter().map(|flow| value(flow)).collect::<Vec<_>>());
        points.push(Point {
            stress_over_modulus: level,
            normal_stress: of(|flow| flow.normal_stress),
            held_stress: of(|flow| flow.held_stress),
            inertial_number: of(|flow| flow.inertial_number),
            friction: of(|flow| flow.friction),
            solid_fraction: of(|flow| flow.solid_fraction),
        });
    }
    points
}
