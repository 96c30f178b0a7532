//! Grains that come and go.

use crate::column::grading_of;
use crate::problems::Problems;
use crate::scene::Scene;
use crate::scene::boundaries::{InletSpec, OutletSpec};
use crate::walls::waits;
use granular_core::units::Length;
use granular_core::{Dim, Linear};
use granular_dem::{Dem, Inlet, Outlet};

/// Steps between two looks at what is due at inlets.
const STEPS_PER_LOOK: u64 = granular_dem::STEPS_PER_LOOK;
/// Most grains that may be due at one look; each tries up to a hundred places.
const MOST_DUE: f64 = 1e4;
/// Radii that stand for a grading at an inlet.
const SIZES: usize = 1000;

/// Adds the inlets and outlets of a scene to a solver.
pub(super) fn traffic<D: Dim>(
    scene: &Scene,
    dem: &mut Dem<D>,
    materials: &[(String, granular_dem::MaterialId)],
    problems: &mut Problems,
) {
    for (k, spec) in scene.inlets.iter().enumerate() {
        let path = format!("inlets.{k}");
        let material = materials.iter().find(|(name, _)| *name == spec.material).map(|(_, id)| *id);
        let Some(inlet) = material.and_then(|id| inlet::<D>(&path, spec, id, scene, problems)) else {
            continue;
        };
        if let Err(error) = dem.add_inlet(inlet) {
            let value = format!("an inlet that cannot be: {} is {}", error.what, error.value);
            problems.add(path, value, error.allowed, "");
        }
    }
    for (k, spec) in scene.outlets.iter().enumerate() {
        let path = format!("outlets.{k}");
        let Some(outlet) = outlet::<D>(&path, spec, problems) else { continue };
        if let Err(error) = dem.add_outlet(outlet) {
            problems.add(path, "an outlet that cannot be", error.allowed, "");
        }
    }
}

fn inlet<D: Dim>(
    path: &str,
    spec: &InletSpec,
    material: granular_dem::MaterialId,
    scene: &Scene,
    problems: &mut Problems,
) -> Option<Inlet<D>> {
    let radii = grading_of(&spec.grading).sample::<D>(SIZES, spec.seed).map_err(|error| {
        let value = format!("a grading whose {} is {}", error.what, error.value);
        problems.add(format!("{path}.grading"), value, error.allowed, "");
    });
    let velocity = if spec.velocity.is_empty() {
        Some(D::Vec::ZERO)
    } else {
        problems.vector::<D, _>(&format!("{path}.velocity"), &spec.velocity)
    };
    let low = problems.vector::<D, _>(&format!("{path}.low"), &spec.low);
    let high = problems.vector::<D, _>(&format!("{path}.high"), &spec.high);
    Some(Inlet {
        name: spec.name.clone(),
        low: low?,
        high: high?,
        rate: spec.rate,
        number: spec.number.unwrap_or(u64::MAX),
        radii: radii.ok()?,
        velocity: velocity?,
        material,
        seed: spec.seed,
        runs: !waits(scene, &spec.name),
    })
}

/// Why inlets cannot run with these steps of the stages \[s\]: so many grains would be due at once that looking for their
/// places would take all the time.
pub(super) fn crowded_inlets(scene: &Scene, steps: &[f64]) -> Vec<String> {
    let longest = steps.iter().copied().fold(0.0, f64::max);
    let look = STEPS_PER_LOOK as f64 * longest;
    let crowded = scene.inlets.iter().enumerate().filter(|(_, inlet)| {
        let due = inlet.rate * look;
        due.min(inlet.number.map_or(f64::INFINITY, |number| number as f64)) > MOST_DUE
    });
    crowded
        .map(|(k, inlet)| {
            format!(
                "`inlets.{k}.rate` is {} 1/s: {:.3e} grains would be due in {STEPS_PER_LOOK} steps of {longest:.3e} s; \
                 allowed: at most {:.3e} 1/s, {MOST_DUE:e} grains at once",
                inlet.rate,
                inlet.rate * look,
                MOST_DUE / look
            )
        })
        .collect()
}

fn outlet<D: Dim>(path: &str, spec: &OutletSpec, problems: &mut Problems) -> Option<Outlet<D>> {
    match spec {
        OutletSpec::Beyond { point, normal } => {
            let numbers: Vec<Length> = normal.iter().map(|&number| number.into()).collect();
            let point = problems.vector::<D, _>(&format!("{path}.point"), point);
            let normal = problems.vector::<D, _>(&format!("{path}.normal"), &numbers);
            Some(Outlet::Beyond { point: point?, normal: normal? })
        }
        OutletSpec::Outside { low, high } => {
            let low = problems.vector::<D, _>(&format!("{path}.low"), low);
            let high = problems.vector::<D, _>(&format!("{path}.high"), high);
            Some(Outlet::Outside { low: low?, high: high? })
        }
    }
}
