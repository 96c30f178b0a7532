//! Materials from texts, and what element tests say of them.

use super::{Element, Material, Plan, Test};
use crate::failure::Failure;
use crate::scene_file::SceneText;

const SAND: &str = "(\n    law: MohrCoulomb(young_modulus: \"1.98 MPa\", poisson_ratio: 0.23,\n        friction_angle: \"23.2 deg\"),\n)";

fn material(text: &str) -> Result<Material, Failure> {
    Material::of_text("sand", &SceneText::new("sand.ron", text))
}

fn element(text: &str, plan: Plan) -> Element {
    material(text).and_then(|material| material.test(plan)).unwrap()
}

fn near(value: f64, expected: f64, what: &str) {
    assert!((value / expected - 1.0).abs() < 1e-8, "{what}: {value} where {expected} is expected");
}

#[test]
fn peaks_and_ends_are_those_of_closed_forms() {
    let sine = 23.2_f64.to_radians().sin();
    let k = (1.0 + sine) / (1.0 - sine);
    let found = |test| element(SAND, Plan::of(test));
    for test in [Test::Triaxial, Test::PlaneStrain] {
        for numbers in [found(test).peak(), found(test).end()] {
            near(numbers.stress, (k - 1.0) * 100e3, test.name());
            near(numbers.ratio, k, test.name());
            near(numbers.friction_angle, 23.2, test.name());
        }
    }
    // The peak of a plateau is where it begins: the first increment of 1e-4 beyond q / E.
    let yields = (k - 1.0) * 100e3 / 1.98e6;
    let peak = found(Test::Triaxial).peak().strain;
    assert!((yields..yields + 1.001e-4).contains(&peak), "{peak} {yields}");
    near(found(Test::Triaxial).end().strain, 0.1, "axial strain");
    near(found(Test::Oedometer).end().ratio, 1.0 / k, "oedometer");
    let sheared = element(SAND, Plan { strain: 0.5, ..Plan::of(Test::SimpleShear) });
    near(sheared.end().strain, 0.5, "shear strain");
    // Without dilation the angle of the plane of shear is the sine of the angle of friction.
    let ratio = sheared.end().ratio;
    assert!((ratio / sine - 1.0).abs() < 1e-3, "{ratio} {sine}");
}

#[test]
fn plans_that_make_no_sense_are_refused() {
    let sand = material(SAND).unwrap();
    let plan = Plan::of(Test::Triaxial);
    for (plan, told) in [
        (Plan { pressure: -1.0, ..plan }, "--pressure: -1 Pa"),
        (Plan { pressure: f64::INFINITY, ..plan }, "--pressure"),
        (Plan { strain: 0.0, ..plan }, "--strain: 0"),
        (Plan { strain: f64::NAN, ..plan }, "--strain: NaN"),
        (Plan { steps: 0, ..plan }, "--steps: 0"),
        (Plan { steps: 1_000_000, ..plan }, "--steps: 1000000"),
        (Plan { duration: 0.0, ..plan }, "--duration: 0 s"),
    ] {
        let failure = sand.test(plan).unwrap_err().to_string();
        assert!(failure.contains(told) && failure.contains("allowed"), "{failure}");
    }
}

#[test]
fn a_fluid_needs_its_density() {
    let water = "(law: Newtonian(viscosity: 1e-3, sound_speed: 30, tension: true))";
    let failure = material(water).unwrap_err().to_string();
    assert!(failure.contains("`density` is missing") && failure.contains("sand.ron:1:"), "{failure}");
    let water = water.replacen('(', "(density: 1000, ", 1);
    let confined = element(&water, Plan { strain: 1e-3, ..Plan::of(Test::Oedometer) }).end();
    // K = rho c^2 at first, and no shear stress worth the name.
    assert!((confined.stress / (1e-3 * 1000.0 * 900.0) - 1.0).abs() < 0.01, "{confined:?}");
    assert!((confined.ratio - 1.0).abs() < 1e-3, "{confined:?}");
}

/// All paths end, in a state or with a reason, also from no pressure.
#[test]
fn every_law_goes_every_way_or_says_why_not() {
    let elastic = "young_modulus: 1e6, poisson_ratio: 0.3";
    let laws = [
        format!("LinearElastic({elastic})"),
        format!("MohrCoulomb({elastic}, friction_angle: 0, cohesion: 1e3)"),
        format!("MohrCoulomb({elastic}, friction_angle: \"30 deg\", cohesion: 1e3, tensile_strength: 10)"),
        format!("DruckerPrager({elastic}, friction_angle: \"30 deg\")"),
        format!(
            "MuI({elastic}, friction: Linear(at_rest: 0.3, growth: 1), grains: Dry(diameter: 1e-3, density: 2500))"
        ),
        "Bingham(viscosity: 1, yield_stress: 50, smoothing_time: 0.1, sound_speed: 30)".to_owned(),
    ];
    for law in laws {
        let material = material(&format!("(density: 1500, law: {law})")).unwrap();
        for test in Test::ALL {
            for pressure in [0.0, 1e4] {
                match material.test(Plan { pressure, steps: 50, ..Plan::of(test) }) {
                    Ok(element) => assert!(element.end().stress.is_finite(), "{law} {element}"),
                    Err(failure) => {
                        let said = failure.to_string();
                        assert!(said.contains(test.name()) && said.contains("Pa"), "{law}: {said}");
                    }
                }
            }
        }
    }
}
