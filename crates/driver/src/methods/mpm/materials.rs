//! What a continuum reads of the materials of a scene: its laws are in `continua`.

use crate::column::grading_of;
use crate::problems::{Problems, nearest};
use crate::scene::{Sample, Scene};
use granular_constitutive::AnyLaw;
use granular_constitutive::spec::{ConstitutiveLawSpec, GrainsSpec};
use granular_core::Dim;
use granular_core::coarse::Constituents;

/// Grains that are drawn for their mean diameter.
const DRAWN: usize = 10_000;

/// The law of a continuum with a density \[kg/m^3\], or what is wrong with its values, told at a path.
pub(super) fn law(
    spec: &ConstitutiveLawSpec,
    density: f64,
    path: &str,
    problems: &mut Problems,
) -> Option<AnyLaw> {
    let law = AnyLaw::from_spec(spec, density);
    law.map_err(|error| problems.add(path, format!("refused: {error}"), error.allowed, "")).ok()
}

/// Whether there is a material of this name.
pub(super) fn knows(scene: &Scene, path: &str, material: &str, problems: &mut Problems) -> bool {
    let is_known = scene.materials.contains_key(material);
    if !is_known {
        let known: Vec<&str> = scene.materials.keys().map(String::as_str).collect();
        let hint = nearest(material, known.iter().copied());
        let allowed = match known.as_slice() {
            [] => "a material of this scene, such as materials: { \"rough\": (friction: 0.5) }".to_owned(),
            _ => format!("a material of this scene: {}", known.join(", ")),
        };
        problems.add(path, format!("`{material}`, which is not a material of this scene"), allowed, hint);
    }
    is_known
}

/// Friction of a wall of a material.
pub(super) fn friction(scene: &Scene, material: &str) -> f64 {
    scene.materials.get(material).map_or(0.0, |material| material.friction)
}

/// Grains that a continuum stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KnownGrains {
    /// What grids need, with the mean diameter by mass.
    pub(super) constituents: Constituents,
    /// Mean diameter by number \[m\], in which pushes are measured.
    pub(super) mean_diameter: f64,
}

/// Grains that the continuum of a scene stands for: those that its sample would be filled with, or those of a law that grows with
/// the rate of shear; none where neither is given.
pub(super) fn grains<D: Dim>(scene: &Scene, law: &ConstitutiveLawSpec) -> Option<KnownGrains> {
    let (material, grading) = match scene.sample.as_ref()? {
        Sample::Column { material, grading, .. } | Sample::Cylinder { material, grading, .. } => {
            (material, grading.as_ref())
        }
        Sample::Bodies(list) => (&list.first()?.material, None),
        _ => return None,
    };
    let of_law = match law {
        ConstitutiveLawSpec::MuI { grains: GrainsSpec::Dry { diameter, density }, .. } => {
            let [density, diameter] = [density.value(), diameter.value()];
            Some(KnownGrains { constituents: Constituents { density, diameter }, mean_diameter: diameter })
        }
        _ => None,
    };
    of_law.or_else(|| {
        let radii = grading_of(grading?).sample::<D>(DRAWN, 1).ok()?;
        let weights = |power: i32| radii.iter().map(|radius| radius.powi(power)).sum::<f64>();
        // Mean by mass, as on grids of grains.
        let diameter = 2.0 * weights(D::N as i32 + 1) / weights(D::N as i32);
        let constituents = Constituents { density: density_of_grains(scene, material)?, diameter };
        Some(KnownGrains { constituents, mean_diameter: 2.0 * weights(1) / weights(0) })
    })
}

/// Density of the grains of a material \[kg/m^3\], where a scene has grains.
#[cfg(feature = "dem")]
pub(super) fn density_of_grains(scene: &Scene, material: &str) -> Option<f64> {
    scene.materials.get(material).map(|material| material.density.value())
}

/// None: this program has no grains.
#[cfg(not(feature = "dem"))]
pub(super) fn density_of_grains(_: &Scene, _: &str) -> Option<f64> {
    None
}
