use super::*;
use crate::AnyLaw;
use crate::{Bingham, LinearElastic, MohrCoulomb, Strength, Tait};

fn law(json: &str) -> Result<AnyLaw, String> {
    let spec: ConstitutiveLawSpec = serde_json::from_str(json).map_err(|error| error.to_string())?;
    AnyLaw::from_spec(&spec, 1500.0).map_err(|error| error.to_string())
}

#[test]
fn values_have_units_and_defaults() {
    let sand = law(
        r#"{"MohrCoulomb": {"young_modulus": "1.98 MPa", "poisson_ratio": 0.23, "friction_angle": "23.2 deg"}}"#,
    );
    let elastic = LinearElastic::new(1.98e6, 0.23).unwrap();
    let strength = Strength::of_friction(23.2 * (std::f64::consts::PI / 180.0));
    assert_eq!(sand, Ok(MohrCoulomb::new(elastic, strength).unwrap().into()));
    let mud = law(
        r#"{"Bingham": {"viscosity": "2 Pa s", "yield_stress": 50, "smoothing_time": "0.1 s", "sound_speed": "30 m/s"}}"#,
    );
    let state = Tait::new(1500.0, 30.0).unwrap().without_tension();
    assert_eq!(mud, Ok(Bingham::new(2.0, 50.0, 0.1, state).unwrap().into()));
}

#[test]
fn every_law_can_be_asked_for() {
    let elastic = r#""young_modulus": 1e6, "poisson_ratio": 0.3"#;
    let dry = r#""grains": {"Dry": {"diameter": "1 mm", "density": 2500}}"#;
    let wet = r#""grains": {"InLiquid": {"viscosity": "1 mPa s"}}"#;
    let linear = r#""friction": {"Linear": {"at_rest": 0.22, "growth": 1.0}}"#;
    let saturating = r#""friction": {"Saturating": {"at_rest": 0.38, "greatest": 0.64, "number": 0.28}}"#;
    for (name, text) in [
        ("linear elastic", format!(r#"{{"LinearElastic": {{{elastic}}}}}"#)),
        (
            "Mohr-Coulomb with a tensile strength",
            format!(r#"{{"MohrCoulomb": {{{elastic}, "friction_angle": 0.5, "cohesion": "1 kPa", "tensile_strength": 10}}}}"#),
        ),
        ("Mohr-Coulomb", format!(r#"{{"MohrCoulomb": {{{elastic}, "friction_angle": 0.5, "tensile_strength": 0}}}}"#)),
        ("Drucker-Prager", format!(r#"{{"DruckerPrager": {{{elastic}, "friction_angle": 0.5, "cone": "Compression"}}}}"#)),
        ("linear mu(I)", format!(r#"{{"MuI": {{{elastic}, {linear}, {dry}}}}}"#)),
        ("mu(I)", format!(r#"{{"MuI": {{{elastic}, {saturating}, {wet}}}}}"#)),
        (
            "NorSand",
            r#"{"NorSand": {"shear_modulus": "30 MPa", "poisson_ratio": 0.2, "greatest_pressure": "1 MPa", "critical_ratio": 1.25,
                "critical_void_ratio": 0.82, "critical_slope": 0.015, "hardening": 150, "void_ratio": 0.6,
                "preconsolidation_pressure": "100 kPa"}}"#
                .to_owned(),
        ),
        ("Newtonian", r#"{"Newtonian": {"viscosity": 1e-3, "sound_speed": 30, "tension": true}}"#.to_owned()),
    ] {
        assert_eq!(law(&text).unwrap().name(), name, "{text}");
    }
}

#[test]
fn mistakes_are_said() {
    let unknown = law(r#"{"LinearElastic": {"young_modulus": 1e6, "poisson": 0.3}}"#).unwrap_err();
    assert!(unknown.contains("unknown field `poisson`"), "{unknown}");
    let unit = law(r#"{"LinearElastic": {"young_modulus": "1 kg", "poisson_ratio": 0.3}}"#).unwrap_err();
    assert!(unit.contains("`1 kg` is a mass, but a pressure"), "{unit}");
    let value = law(r#"{"LinearElastic": {"young_modulus": 1e6, "poisson_ratio": 0.5}}"#).unwrap_err();
    assert_eq!(value, "Poisson's ratio is 0.5, but must be between -1 and 0.5, both excluded");
    let angle =
        law(r#"{"MohrCoulomb": {"young_modulus": 1e6, "poisson_ratio": 0.3, "friction_angle": "95 deg"}}"#);
    assert!(angle.unwrap_err().contains("angle of friction in degrees is 95"));
    let inside = law(
        r#"{"MuI": {"young_modulus": 1e6, "poisson_ratio": 0.3, "friction": {"Linear": {"at_rest": 0.2, "grows": 1}}, "grains": {"InLiquid": {"viscosity": 1}}}}"#,
    );
    assert!(inside.unwrap_err().contains("unknown field `grows`"));
}
