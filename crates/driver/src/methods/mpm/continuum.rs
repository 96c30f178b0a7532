//! What a scene says of a continuum: its law, or the file of a calibration that holds one.

use crate::material_file::MaterialFile;
use crate::problems::Problems;
use crate::scene::Dimension;
use granular_constitutive::spec::{ConstitutiveLawSpec, FrictionSpec, GrainsSpec};
use granular_core::units::Density;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::Path;

/// What a material is as a continuum: with `law`, or with `calibrated`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContinuumSpec {
    /// Density of the bulk at the start. Where the sample is a column of grains of this material it follows from theirs.
    #[serde(default)]
    pub density: Option<Density>,
    /// How it answers to strain.
    #[serde(default)]
    pub law: Option<ConstitutiveLawSpec>,
    /// The same from a file that `granular calibrate` has written of its grains.
    #[serde(default)]
    pub calibrated: Option<CalibratedSpec>,
}

/// A law whose constants were measured on grains.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CalibratedSpec {
    /// The file; its path counts from the folder of the scene.
    pub file: String,
    /// The law that takes its constants.
    #[serde(default)]
    pub model: CalibratedModel,
}

/// Laws that a calibration gives the constants of. Young's modulus and Poisson's ratio are those of the dense sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum CalibratedModel {
    /// Mohr-Coulomb without dilation. In simple shear that has a friction of `sin(friction_angle)`, which is set to the critical
    /// friction.
    #[default]
    MohrCoulomb,
    /// Friction that grows as a line over the inertial number.
    LinearMuI,
    /// Friction that grows over the inertial number up to a greatest one.
    SaturatingMuI,
}

impl ContinuumSpec {
    /// The law; `folder` is that from which files count, `place` where the spec stands. Blames what is missing or cannot be read.
    pub(crate) fn law(
        &self,
        (folder, dimension): (&Path, Option<Dimension>),
        place: &str,
        problems: &mut Problems,
    ) -> Option<ConstitutiveLawSpec> {
        match (&self.law, &self.calibrated) {
            (Some(law), None) => Some(law.clone()),
            (None, Some(calibrated)) => calibrated.law((folder, dimension), place, problems),
            (Some(_), Some(_)) => {
                problems.add(format!("{place}calibrated"), "given beside `law`", "one of the two", "");
                None
            }
            (None, None) => {
                let allowed = "a law, such as MohrCoulomb(..), or calibrated: (file: \"glass.ron\")";
                problems.add(format!("{place}law"), "missing", allowed, "");
                None
            }
        }
    }
}

impl CalibratedSpec {
    fn law(
        &self,
        (folder, dimension): (&Path, Option<Dimension>),
        place: &str,
        problems: &mut Problems,
    ) -> Option<ConstitutiveLawSpec> {
        let path = folder.join(&self.file);
        let mut refuse = |value: String, allowed: &str, hint: &str| {
            problems.add(format!("{place}calibrated.file"), value, allowed, hint);
        };
        let allowed = "a file that `granular calibrate friction SCENE --out FILE` has written";
        let text = std::fs::read_to_string(&path)
            .map_err(|error| refuse(format!("{}: {error}", path.display()), allowed, ""));
        let file = MaterialFile::from_ron(&text.ok()?)
            .map_err(|error| refuse(format!("{}: {error}", path.display()), allowed, ""))
            .ok()?;
        if dimension.is_some_and(|dimension| dimension != file.dimension) {
            let hint = "stresses of the plane are per metre of depth, and disks are not spheres";
            refuse(
                format!("{}, of grains in another dimension", path.display()),
                "one of the scene's own dimension",
                hint,
            );
            return None;
        }
        Some(self.model.law(&file))
    }
}

impl CalibratedModel {
    fn law(self, file: &MaterialFile) -> ConstitutiveLawSpec {
        let (young_modulus, poisson_ratio) = (file.young_modulus.value.into(), file.poisson_ratio.value);
        let grains = GrainsSpec::Dry { diameter: file.diameter.into(), density: file.density.into() };
        let mu_i = |friction| ConstitutiveLawSpec::MuI { young_modulus, poisson_ratio, friction, grains };
        match self {
            Self::MohrCoulomb => ConstitutiveLawSpec::MohrCoulomb {
                young_modulus,
                poisson_ratio,
                friction_angle: file.critical_friction.value.asin().into(),
                dilation_angle: None,
                cohesion: None,
                tensile_strength: None,
            },
            Self::LinearMuI => mu_i(FrictionSpec::Linear {
                at_rest: file.linear.static_friction.value,
                growth: file.linear.slope.value,
            }),
            Self::SaturatingMuI => mu_i(FrictionSpec::Saturating {
                at_rest: file.jop.static_friction.value,
                greatest: file.jop.dynamic_friction.value,
                number: file.jop.inertial_number.value,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material_file;
    use crate::methods::mpm::element::{Material, Plan, Test};
    use crate::scene_file::SceneText;

    /// Simple shear of the law that a calibration gives has the critical friction that was measured in simple shear.
    #[test]
    fn a_calibrated_law_has_the_friction_that_was_measured() {
        let folder = std::env::temp_dir().join(format!("granular-calibrated-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = material_file::example(Dimension::Plane);
        std::fs::write(folder.join("glass.ron"), file.to_ron().unwrap()).unwrap();
        let of = |spec: &str| {
            let text = SceneText::new(folder.join("sand.ron").to_string_lossy(), spec);
            Material::of_text("sand", &text)
        };
        let sand = of("(calibrated: (file: \"glass.ron\"))").unwrap();
        let plan = Plan { strain: 1.0, ..Plan::of(Test::SimpleShear) };
        let ratio = sand.test(plan).unwrap().end().ratio;
        assert!((ratio - file.critical_friction.value).abs() < 1e-3, "{ratio}");
        assert_eq!(of("(calibrated: (file: \"glass.ron\", model: SaturatingMuI))").unwrap().law(), "mu(I)");

        let told = |spec: &str| of(spec).unwrap_err().to_string();
        let missing = told("(calibrated: (file: \"none.ron\"))");
        assert!(missing.contains("none.ron") && missing.contains("granular calibrate"), "{missing}");
        assert!(told("(density: 1600)").contains("MohrCoulomb"));
        let twice =
            "(calibrated: (file: \"glass.ron\"), law: LinearElastic(young_modulus: 1e6, poisson_ratio: 0.2))";
        assert!(told(twice).contains("one of the two"));
        let spec: ContinuumSpec = SceneText::new("", "(calibrated: (file: \"glass.ron\"))").parse().unwrap();
        let mut problems = Problems::default();
        assert!(spec.law((&folder, Some(Dimension::Space)), "", &mut problems).is_none());
        assert!(problems.0[0].to_string().contains("another dimension"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
