//! Names and units of the fields.

use super::sums::Wanted;
use crate::field::{Shown, ShownAs};

/// Share of the mass that the kernel spreads beyond the grid.
pub(super) const OUTSIDE: &str = "mass_outside";

pub(super) const FIELDS: &[(&str, &str, &str)] = &[
    ("density", "kg/m^3", "mass of grains per volume"),
    ("solid_fraction", "1", "volume of grains per volume"),
    ("number_density", "1/m^3", "grains per volume; per area in the plane"),
    ("mean_diameter", "m", "diameter of grains, mean by mass"),
    ("momentum", "kg/(m^2 s)", "momentum of grains per volume"),
    ("velocity", "m/s", "momentum over density"),
    ("speed", "m/s", "magnitude of the velocity"),
    ("strain_rate", "1/s", "symmetric part of the gradient of the velocity"),
    ("vorticity", "1/s", "curl of the velocity"),
    ("shear_rate", "1/s", "sqrt(2 e:e) of the deviator e of the strain rate"),
    ("stress", "Pa", "contact and kinetic stress, positive in compression"),
    ("contact_stress", "Pa", "stress carried by contacts, its symmetric part"),
    ("kinetic_stress", "Pa", "stress carried by velocities about the mean"),
    ("pressure", "Pa", "mean of the normal stresses along the axes"),
    ("granular_temperature", "m^2/s^2", "mean square of velocities about the mean, per axis"),
    ("wall_force", "N/m^3", "force of walls on grains per volume"),
    ("coordination", "1", "contacts per grain, walls included"),
    ("fabric", "1", "mean of n n over the contacts of grains"),
    ("inertial_number", "1", "shear rate times diameter times sqrt(density of grains / pressure)"),
];

/// What the fields of these names need.
pub(super) fn needs(wants: impl Fn(&str) -> bool) -> Option<Wanted> {
    let any = |names: &[&str]| names.iter().any(|name| wants(name));
    let known = FIELDS.iter().any(|(name, ..)| wants(name)) || wants(OUTSIDE);
    known.then(|| Wanted {
        slopes: any(&["strain_rate", "vorticity", "shear_rate", "inertial_number"]),
        kinetic: any(&["stress", "kinetic_stress", "pressure", "granular_temperature", "inertial_number"]),
        contacts: any(&["stress", "contact_stress", "pressure", "wall_force", "inertial_number"]),
        fabric: any(&["coordination", "fabric"]),
    })
}

/// All that can be shown on a grid.
pub(super) fn shown() -> Vec<Shown> {
    let field = |&(name, unit, meaning): &(&str, _, _)| Shown::new(name, unit, meaning, ShownAs::Field);
    FIELDS.iter().map(field).collect()
}
