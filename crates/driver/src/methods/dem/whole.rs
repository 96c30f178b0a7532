//! All grains that a scene will hold: those of its sample and those that inlets bring. What follows from a mean over the
//! grains must not follow from an empty sample.

use super::materials::NamedMaterials;
use crate::column::grading_of;
use crate::scene::Scene;
use crate::scene::boundaries::InletSpec;
use granular_core::Dim;
use granular_dem::Grain;

/// Sizes that stand for a grading.
const SIZES: usize = 1000;

/// Grains that come in through one inlet.
struct Coming {
    material: String,
    /// How many, if all find a place.
    number: f64,
    mean_radius: f64,
    /// Mean area or volume \[m^2, m^3\].
    mean_volume: f64,
}

/// Sums over all grains.
pub(super) struct Whole {
    here: f64,
    /// Sum of the radii of the sample \[m\].
    radii: f64,
    coming: Vec<Coming>,
}

impl Whole {
    /// Of a sample and the inlets of a scene; inlets with a grading that cannot be are left out, they are refused elsewhere.
    pub(super) fn of<'a, D: Dim>(scene: &Scene, sample: impl Iterator<Item = &'a Grain<D>>) -> Self {
        let (mut here, mut radii) = (0.0, 0.0);
        for grain in sample {
            here += 1.0;
            radii += grain.radius;
        }
        let longest: f64 = scene.stages.iter().map(|stage| stage.end.longest()).sum();
        let coming = scene.inlets.iter().filter_map(|inlet| coming::<D>(inlet, longest)).collect();
        Self { here, radii, coming }
    }

    /// Mean radius \[m\]; none without any grain.
    pub(super) fn mean_radius(&self) -> Option<f64> {
        let number = self.here + self.coming.iter().map(|coming| coming.number).sum::<f64>();
        let radii =
            self.radii + self.coming.iter().map(|coming| coming.number * coming.mean_radius).sum::<f64>();
        (number > 0.0).then_some(radii / number)
    }

    /// Mass \[kg; kg/m in the plane\] of the sample and all that comes.
    pub(super) fn mass<'a, D: Dim>(
        &self,
        sample: impl Iterator<Item = &'a Grain<D>>,
        materials: &NamedMaterials,
    ) -> f64 {
        let here: f64 = sample
            .map(|grain| materials.list.get(grain.material).density * D::ball_volume(grain.radius))
            .sum();
        let density = |name: &str| {
            let id = materials.ids.get(name).copied().flatten();
            id.map_or(0.0, |id| materials.list.get(id).density)
        };
        let coming = self.coming.iter();
        here + coming
            .map(|coming| density(&coming.material) * coming.number * coming.mean_volume)
            .sum::<f64>()
    }
}

fn coming<D: Dim>(inlet: &InletSpec, longest: f64) -> Option<Coming> {
    let radii = grading_of(&inlet.grading).sample::<D>(SIZES, inlet.seed).ok()?;
    let mean =
        |of: &dyn Fn(f64) -> f64| radii.iter().map(|&radius| of(radius)).sum::<f64>() / radii.len() as f64;
    let number = (inlet.rate * longest).min(inlet.number.map_or(f64::INFINITY, |number| number as f64));
    // A rate that makes no sense is refused with the inlet.
    (number.is_finite() && number >= 0.0).then(|| Coming {
        material: inlet.material.clone(),
        number,
        mean_radius: mean(&|radius| radius),
        mean_volume: mean(&|radius| D::ball_volume(radius)),
    })
}
