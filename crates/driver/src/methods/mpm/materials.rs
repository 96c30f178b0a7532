//! What a continuum reads of the materials of a scene: its laws are in `continua`.

use crate::problems::{Problems, nearest};
use crate::scene::Scene;
use granular_constitutive::AnyLaw;
use granular_constitutive::spec::ContinuumSpec;

/// The law of a continuum with a density \[kg/m^3\], or what is wrong with its values, told at a path.
pub(super) fn law(spec: &ContinuumSpec, density: f64, path: &str, problems: &mut Problems) -> Option<AnyLaw> {
    let law = AnyLaw::from_spec(&spec.law, density);
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
