//! Names and units of the fields.

use super::source::Kind;
use super::sums::Wanted;
use crate::field::{Shown, ShownAs};

/// Share of the mass that the kernel spreads beyond the grid.
pub(super) const OUTSIDE: &str = "mass_outside";

pub(super) const FIELDS: &[(&str, &str, &str)] = &[
    ("density", "kg/m^3", "mass per volume"),
    ("solid_fraction", "1", "volume of grains per volume"),
    ("number_density", "1/m^3", "grains per volume; per area in the plane"),
    ("mean_diameter", "m", "diameter of grains, mean by mass"),
    ("momentum", "kg/(m^2 s)", "momentum per volume"),
    ("velocity", "m/s", "momentum over density"),
    ("speed", "m/s", "magnitude of the velocity"),
    ("strain_rate", "1/s", "symmetric part of the gradient of the velocity"),
    ("vorticity", "1/s", "curl of the velocity"),
    ("shear_rate", "1/s", "sqrt(2 e:e) of the deviator e of the strain rate"),
    ("stress", "Pa", "stress of contacts, or of the material, and kinetic stress; positive in compression"),
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

/// What only grains have: contacts, and a number.
const OF_GRAINS: [&str; 5] = ["number_density", "contact_stress", "wall_force", "coordination", "fabric"];
/// What a continuum has only when its grains are known.
const OF_KNOWN_GRAINS: [&str; 3] = ["solid_fraction", "mean_diameter", "inertial_number"];

/// All that can be shown on a grid of particles of a kind.
pub(super) fn fields(
    kind: Kind,
) -> impl Iterator<Item = &'static (&'static str, &'static str, &'static str)> {
    FIELDS.iter().filter(move |(name, ..)| match kind {
        Kind::Grains => true,
        Kind::ContinuumOfGrains => !OF_GRAINS.contains(name),
        Kind::Continuum => !OF_GRAINS.contains(name) && !OF_KNOWN_GRAINS.contains(name),
    })
}

/// The same as a list.
pub(super) fn shown(kind: Kind) -> Vec<Shown> {
    let field = |&(name, unit, meaning): &(&str, _, _)| Shown::new(name, unit, meaning, ShownAs::Field);
    fields(kind).map(field).collect()
}
