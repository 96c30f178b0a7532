//! Numbers that the driver works out from what a solver lends, beside those that the solver shows itself.

use crate::methods::fronts::{self, Piece};
use crate::methods::member::Number;
use granular_core::{Dim, FieldSink, GrainMotion, Provides, Shown, ShownAs, Solver};
use granular_dem::Dem;
use granular_packing::{Bulk, median_diameter};

/// Numbers of grains.
const PROBES: [Number; 3] = [
    Number(
        SOLID_FRACTION,
        "1",
        "share of the grains in the bulk: cells of 2.5 median diameters, as far from sides, bottom and surface",
    ),
    Number(
        "homogeneity",
        "1",
        "variance of the void ratio over horizontal bands of the bulk; below 0.05 it is even",
    ),
    Number("median_diameter", "m", "median diameter of the grains by area or volume"),
];
const SOLID_FRACTION: &str = "solid_fraction";

/// All that the solver shows, and these numbers. A periodic cell has a solid fraction of its own.
pub(super) fn shown<D: Dim>(dem: &Dem<D>) -> Vec<Shown> {
    let mut list = dem.shown();
    let probes = PROBES.iter().chain(fronts::numbers::<D>()).copied();
    let new: Vec<Number> = probes.filter(|Number(name, ..)| !shows(&list, name)).collect();
    list.extend(new.into_iter().map(|number| number.shown(ShownAs::Number)));
    list
}

fn shows(list: &[Shown], name: &str) -> bool {
    list.iter().any(|shown| shown.name == name)
}

/// Shows what a sink wants of the solver and of these numbers; works out only those.
pub(super) fn show<D: Dim>(dem: &Dem<D>, sink: &mut dyn FieldSink) {
    dem.show(sink);
    if PROBES.iter().any(|Number(name, ..)| sink.wants(name)) {
        of_grains(dem, sink);
    }
    fronts::show(|| pieces(dem), sink);
}

fn of_grains<D: Dim>(dem: &Dem<D>, sink: &mut dyn FieldSink) {
    let grains = Provides::<GrainMotion<D>>::view(dem);
    if sink.wants("median_diameter") {
        let radii: Vec<f64> = (0..grains.len()).map(|i| grains.radius(i)).collect();
        sink.number("median_diameter", "m", median_diameter::<D>(&radii).unwrap_or(f64::NAN));
    }
    let bulk_wanted = sink.wants(SOLID_FRACTION) && !shows(&dem.shown(), SOLID_FRACTION);
    if bulk_wanted || sink.wants("homogeneity") {
        // Grains in flight are no part of the bulk, and would lift its surface.
        let main = dem.main_mass();
        let chosen: Vec<usize> = (0..grains.len()).filter(|&i| main[i]).collect();
        let positions: Vec<D::Vec> = chosen.iter().map(|&i| grains.motion(i).position).collect();
        let radii: Vec<f64> = chosen.iter().map(|&i| grains.radius(i)).collect();
        let bulk = Bulk::of::<D>(&positions, &radii).ok();
        let number = |of: fn(&Bulk) -> Option<f64>| bulk.as_ref().and_then(of).unwrap_or(f64::NAN);
        if bulk_wanted {
            sink.number(SOLID_FRACTION, "1", number(Bulk::solid_fraction));
        }
        sink.number("homogeneity", "1", number(Bulk::homogeneity));
    }
}

/// Grains as fronts see them.
fn pieces<D: Dim>(dem: &Dem<D>) -> Vec<Piece<D>> {
    let grains = Provides::<GrainMotion<D>>::view(dem);
    let (main, masses) = (dem.main_mass(), dem.masses());
    let piece = |i: usize| Piece {
        position: grains.motion(i).position,
        reach: grains.radius(i),
        mass: masses[i],
        is_main: main[i],
    };
    (0..grains.len()).map(piece).collect()
}
