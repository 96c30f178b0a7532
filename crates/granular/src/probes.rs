//! Numbers that the driver works out from what a solver lends, beside those that the solver shows itself.

use core::f64::consts::TAU;
use granular_core::{D2, D3};
use granular_core::{Dim, FieldSink, GrainMotion, Numbers, Provides, Shown, ShownAs, Solver};
use granular_dem::Dem;
use granular_packing::{Bulk, median_diameter};
use std::any::Any;

/// Names, units and meanings.
const PROBES: &[(&str, &str, &str)] = &[
    (
        "solid_fraction",
        "1",
        "share of the grains in the bulk: cells of 2.5 median diameters, as far from sides, bottom and surface",
    ),
    (
        "homogeneity",
        "1",
        "variance of the void ratio over horizontal bands of the bulk; below 0.05 it is even",
    ),
    ("median_diameter", "m", "median diameter of the grains by area or volume"),
    (
        RADIAL_FRONT,
        "m",
        "distance of the front of the main mass from the z axis: mean over sectors of 10 degrees; in space",
    ),
];

const RADIAL_FRONT: &str = "radial_front";
/// Sectors about the z axis.
const SECTORS: usize = 36;

/// All that a solver shows, and the numbers of the driver. A periodic cell has a solid fraction of its own.
pub(crate) fn shown(solver: &dyn Solver) -> Vec<Shown> {
    let mut list = solver.shown();
    if has_grains(solver) {
        let any: &dyn Any = solver;
        let fits = |name: &str| name != RADIAL_FRONT || any.is::<Dem<D3>>();
        let new = |name: &str| fits(name) && !list.iter().any(|known| known.name == name);
        let more = PROBES.iter().filter(|(name, ..)| new(name));
        let number = |&(name, unit, meaning): &(&str, _, _)| Shown::new(name, unit, meaning, ShownAs::Number);
        let more: Vec<Shown> = more.map(number).collect();
        list.extend(more);
    }
    list
}

/// Collects the numbers that are wanted; works out only those.
pub(crate) fn show(solver: &dyn Solver, numbers: &mut Numbers) {
    solver.show(numbers);
    let missing = |name: &str| numbers.wants(name) && numbers.get(name).is_none();
    if PROBES.iter().any(|(name, ..)| missing(name)) {
        let any: &dyn Any = solver;
        if let Some(dem) = any.downcast_ref::<Dem<D2>>() {
            of_grains(dem, numbers);
        } else if let Some(dem) = any.downcast_ref::<Dem<D3>>() {
            of_grains(dem, numbers);
            if numbers.wants(RADIAL_FRONT) {
                numbers.number(RADIAL_FRONT, "m", radial_front(dem));
            }
        }
    }
}

fn has_grains(solver: &dyn Solver) -> bool {
    let any: &dyn Any = solver;
    any.is::<Dem<D2>>() || any.is::<Dem<D3>>()
}

fn of_grains<D: Dim>(dem: &Dem<D>, numbers: &mut Numbers) {
    let grains = Provides::<GrainMotion<D>>::view(dem);
    if numbers.wants("median_diameter") {
        let radii: Vec<f64> = (0..grains.len()).map(|i| grains.radius(i)).collect();
        numbers.number("median_diameter", "m", median_diameter::<D>(&radii).unwrap_or(f64::NAN));
    }
    let bulk_wanted = numbers.wants("solid_fraction") && numbers.get("solid_fraction").is_none();
    if bulk_wanted || numbers.wants("homogeneity") {
        // Grains in flight are no part of the bulk, and would lift its surface.
        let main = dem.main_mass();
        let chosen: Vec<usize> = (0..grains.len()).filter(|&i| main[i]).collect();
        let positions: Vec<D::Vec> = chosen.iter().map(|&i| grains.motion(i).position).collect();
        let radii: Vec<f64> = chosen.iter().map(|&i| grains.radius(i)).collect();
        let bulk = Bulk::of::<D>(&positions, &radii).ok();
        let number = |of: fn(&Bulk) -> Option<f64>| bulk.as_ref().and_then(of).unwrap_or(f64::NAN);
        if bulk_wanted {
            numbers.number("solid_fraction", "1", number(Bulk::solid_fraction));
        }
        numbers.number("homogeneity", "1", number(Bulk::homogeneity));
    }
}

/// Mean over the sectors that hold grains of the main mass of its farthest point in them \[m\].
fn radial_front(dem: &Dem<D3>) -> f64 {
    let grains = Provides::<GrainMotion<D3>>::view(dem);
    let mut farthest = [0.0_f64; SECTORS];
    for (i, _) in dem.main_mass().into_iter().enumerate().filter(|(_, main)| *main) {
        let position = grains.motion(i).position;
        let turn = position.y.atan2(position.x) / TAU + 0.5;
        let sector = &mut farthest[((turn * SECTORS as f64) as usize).min(SECTORS - 1)];
        *sector = sector.max(position.x.hypot(position.y) + grains.radius(i));
    }
    let met = farthest.iter().filter(|reach| **reach > 0.0);
    met.clone().sum::<f64>() / met.count() as f64
}
