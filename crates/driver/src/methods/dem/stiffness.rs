//! What makes the contacts of a material stiff: a stiffness, or elastic constants.

use super::materials::NamedMaterials;
use crate::problems::{Problems, quoted};
use crate::scene::Scene;
use granular_core::Dim;
use granular_dem::spec::{ContactSpec, MaterialSpec};

/// Whether a material states what the contact model needs, and nothing that contradicts it.
pub(super) fn is_stated(
    path: &str,
    spec: &MaterialSpec,
    contact: ContactSpec,
    plane: bool,
    problems: &mut Problems,
) -> bool {
    let before = problems.0.len();
    let missing = "missing";
    match (spec.young_modulus, spec.poisson_ratio) {
        (Some(_), None) => {
            let allowed = "a number above -1 and at most 0.5, beside young_modulus";
            problems.add(format!("{path}.poisson_ratio"), missing, allowed, "");
        }
        (None, Some(_)) => {
            let allowed = "a positive pressure, beside poisson_ratio";
            problems.add(format!("{path}.young_modulus"), missing, allowed, "");
        }
        (None, None) if contact == ContactSpec::Hertz => {
            let allowed = "young_modulus and poisson_ratio, since contacts are Hertz";
            problems.add(format!("{path}.young_modulus"), missing, allowed, "");
        }
        _ => {}
    }
    if contact == ContactSpec::Linear {
        let load = format!("{path}.typical_load");
        match (spec.normal_stiffness, spec.young_modulus, spec.typical_load) {
            (None, None, _) if spec.poisson_ratio.is_none() => {
                let allowed = "a stiffness, or young_modulus and poisson_ratio from which one follows";
                problems.add(format!("{path}.normal_stiffness"), missing, allowed, "");
            }
            (None, Some(_), None) if plane => {
                let allowed = "a load per metre of depth, such as \"100 N/m\"";
                let hint = "the stiffness of cylinders follows from young_modulus and what a contact carries";
                problems.add(load, missing, allowed, hint);
            }
            (Some(_), _, Some(given)) => {
                let allowed = "nothing, since normal_stiffness is given";
                problems.add(load, given, allowed, "leave out one of both");
            }
            (_, _, Some(given)) if given.value() <= 0.0 => problems.add(load, given, "a positive load", ""),
            _ => {}
        }
    }
    problems.0.len() == before
}

/// Gives linear materials without a stiffness the one that follows from their elastic constants
/// and the mean radius \[m\] of the grains, those that come in later included.
pub(super) fn derive<D: Dim>(
    scene: &Scene,
    materials: &mut NamedMaterials,
    radius: f64,
    problems: &mut Problems,
) {
    for (name, spec) in &scene.materials {
        let id = materials.ids.get(name).copied().flatten();
        let (Some(id), None, Some(elastic)) = (id, spec.normal_stiffness, spec.elasticity()) else {
            continue;
        };
        let stiffness = match spec.typical_load {
            Some(load) if D::N == 2 => elastic.cylinder_stiffness(radius, load.value()),
            // A Hertz scene in the plane needs no linear stiffness and states no load.
            None if D::N == 2 => continue,
            _ => elastic.sphere_stiffness(radius),
        };
        if let Err(error) = materials.list.set_normal_stiffness(id, stiffness) {
            let path = format!("materials.{}.typical_load", quoted(name));
            let hint = "the load flattens the whole grain: the formula does not hold";
            problems.add(path, format!("a stiffness of {}", error.value), error.allowed, hint);
        }
    }
}
