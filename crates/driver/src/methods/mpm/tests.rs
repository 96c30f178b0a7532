//! Scenes of a continuum, right and wrong.

use crate::check;
use crate::failure::Failure;
use crate::scene_file::SceneText;

const SCENE: &str = r#"Scene(
    version: 1,
    dimension: Plane,
    gravity: [0.0, -9.81],
    continua: {
        "sand": (
            density: "1600 kg/m^3",
            law: MohrCoulomb(young_modulus: "1 MPa", poisson_ratio: 0.3, friction_angle: "30 deg"),
        ),
    },
    materials: { "rough": (friction: 0.5) },
    sample: Column(extent: Width("0.1 m"), aspect_ratio: 2, material: "sand"),
    walls: [Floor(material: "rough"), Left(material: "rough"), Gate(material: "rough", opens: "fall")],
    stages: [(name: "rest", end: For("1 ms")), (name: "fall", end: For("1 ms"))],
    solvers: { "soil": Mpm((cell: "10 mm", earth_pressure_at_rest: 0.5)) },
    outputs: [(every: Time("1 ms"), write: Table(path: "series.csv", probes: ["front", "height"]))],
)"#;

fn scene(edits: &[&str]) -> SceneText {
    let mut text = SceneText::new("scene.ron", SCENE);
    edits.iter().for_each(|edit| text.set(edit).unwrap());
    text
}

fn problems(edits: &[&str]) -> String {
    match check::check(&scene(edits)) {
        Err(Failure::Scene(problems)) => problems.iter().map(|problem| format!("{problem}\n")).collect(),
        Ok(report) => format!("{:?}", report.problems),
        Err(other) => format!("{other}"),
    }
}

#[test]
fn a_column_is_filled_as_it_is_described() {
    let (_, model) = check::read(&scene(&[])).unwrap();
    let number = |name: &str| model.number(name).unwrap();
    assert_eq!(model.members[0].solver(&model.simulation).size(), (10 * 20 * 16, "particle"));
    assert!((number("mass") - 1600.0 * 0.1 * 0.2).abs() < 1e-10);
    assert!((number("front") - 0.1).abs() < 1e-12 && (number("height") - 0.2).abs() < 1e-12);
    // Earth pressure at rest: half a weight stands on each level, and presses half as much to the sides.
    let (weight, height, shear) = (1600.0 * 9.81, 0.2_f64, 1e6 / 2.6);
    let (bulk, mean) = (1e6 / 1.2, 2.0 / 3.0);
    let square = (weight * height).powi(2) / 3.0;
    let deviator = 2.0 * (0.5 / 3.0_f64).powi(2) + (1.0 / 3.0_f64).powi(2);
    let energy = 0.1 * height * square * (deviator / (4.0 * shear) + mean * mean / (2.0 * bulk));
    assert!((number("elastic_energy") / energy - 1.0).abs() < 1e-3, "{} {energy}", number("elastic_energy"));
}

#[test]
fn what_cannot_be_is_refused_where_it_stands() {
    let law = "continua.sand.law=MohrCoulomb(young_modulus: 1e6, poisson_ratio: NU, friction_angle: \"PHI\", dilation_angle: \"PSI\")";
    let of = |nu: &str, phi: &str, psi: &str| law.replace("NU", nu).replace("PHI", phi).replace("PSI", psi);
    let cases: [(&[&str], &[&str]); 12] = [
        (&[&of("0.5", "30 deg", "0 deg")], &["continua.sand.law", "Poisson's ratio is 0.5", "0.5"]),
        (&[&of("0.3", "90 deg", "0 deg")], &["continua.sand.law", "angle of friction", "less than 90"]),
        (&[&of("0.3", "20 deg", "25 deg")], &["continua.sand.law", "dilation", "angle of friction"]),
        (&["sample.material=\"clay\""], &["sample.material", "`clay`", "sand"]),
        (&["continua={}"], &["sample.material", "`sand`", "continua"]),
        (&["solvers.soil.particles_per_cell=10"], &["solvers.soil.particles_per_cell", "square number"]),
        (&["solvers.soil.cell=\"0.15 m\""], &["solvers.soil.cell", "smaller than the sample"]),
        (&["solvers.soil.walls={ \"flor\": Slip }"], &["solvers.soil.walls", "`flor`", "floor"]),
        (&["walls.0=Floor(material: \"smooth\")"], &["walls.0.material", "`smooth`", "rough"]),
        (
            &["solvers.soil.contacts=[(between: (\"sand\", \"rock\"), friction: 0.1)]"],
            &["solvers.soil.contacts.0.between", "`rock`", "sand"],
        ),
        (
            &["solvers.soil.contacts=[(between: (\"sand\", \"sand\"), friction: 0.1)]"],
            &["solvers.soil.contacts.0.between", "twice", "two bodies"],
        ),
        (&["solvers.soil.courant=1.5"], &["solvers.soil", "Courant"]),
    ];
    for (edits, told) in cases {
        let found = problems(edits);
        assert!(told.iter().all(|words| found.contains(words)), "{edits:?}: {found}");
    }
}

#[test]
fn grains_need_what_a_continuum_does_not() {
    let rough = "materials={ \"rough\": (friction: 0.5, normal_stiffness: 1e6) }";
    let found = problems(&["solvers={ \"grains\": Dem(()) }", "continua={}", rough]);
    for words in
        ["sample.grading", "sample.packing", "materials.rough.restitution", "only a continuum needs none"]
    {
        assert!(found.contains(words), "{words}: {found}");
    }
    let found = problems(&["solvers={ \"grains\": Dem(()) }", rough]);
    assert!(found.contains("`continua`") && found.contains("Mpm does"), "{found}");
}

#[test]
fn bodies_that_touch_share_no_particle_and_miss_none() {
    let halves = "sample=Bodies([
        (shape: Polygon([[\"0 m\", \"0 m\"], [\"0.2 m\", \"0 m\"], [\"0 m\", \"0.2 m\"]]), material: \"sand\"),
        (shape: Polygon([[\"0.2 m\", \"0 m\"], [\"0.2 m\", \"0.2 m\"], [\"0 m\", \"0.2 m\"]]), material: \"sand\", velocity: [\"1 m/s\", 0]),
    ])";
    let (_, model) = check::read(&scene(&[halves, "walls=[Floor(material: \"rough\")]"])).unwrap();
    let count = model.members[0].solver(&model.simulation).size().0;
    assert_eq!(count, 80 * 80);
    let momentum = model.number("momentum_x").unwrap();
    assert!((momentum / (1600.0 * 0.02) - 1.0).abs() < 0.02, "{momentum}");
}

#[test]
fn a_push_gives_its_energy_and_needs_to_know_grains_for_units_of_theirs() {
    let push = |text: &str| format!("stages.0.changes=[Push({text})]");
    let (_, mut model) = check::read(&scene(&[&push("energy: 3, profile: Gradient")])).unwrap();
    let member = model.members[0].clone();
    assert!(member.announced(&model.simulation, 0)[0].contains("3.0000 J in all"));
    let pushed = member.begin(&mut model.simulation, 0).push.unwrap();
    assert!((pushed.energy - 3.0).abs() < 1e-12);
    assert!((model.number("kinetic_energy").unwrap() - 3.0).abs() < 1e-12);
    assert!((model.number("momentum_x").unwrap() - pushed.momentum).abs() < 1e-12 * pushed.momentum);
    let found = problems(&[&push("energy_per_grain: 8")]);
    for words in ["stages.0.changes.0.energy_per_grain", "nobody names", "grading"] {
        assert!(found.contains(words), "{words}: {found}");
    }
    // Of 1 mm and 2600 kg/m^3 the unit is the weight of all times 1 mm.
    let grains =
        ["sample.grading=Single(\"1 mm\")", "materials.sand=(density: \"2600 kg/m^3\", friction: 0.5)"];
    let (_, mut model) = check::read(&scene(&[&push("energy_per_grain: 8"), grains[0], grains[1]])).unwrap();
    let pushed = model.members[0].clone().begin(&mut model.simulation, 0).push.unwrap();
    assert!((pushed.energy / (8.0 * 32.0 * 9.81 * 1e-3) - 1.0).abs() < 1e-12, "{}", pushed.energy);
}

#[test]
fn grids_show_the_solid_fraction_only_of_known_grains() {
    let output = |field: &str| {
        format!(
            "outputs.0=(every: Time(\"1 ms\"), write: Fields(path: \"means\", fields: [\"{field}\"],
                grid: (from: [0, 0], to: [\"0.1 m\", \"0.2 m\"], spacing: \"10 mm\")))"
        )
    };
    assert_eq!(problems(&[&output("inertial_number")]).matches("`inertial_number`").count(), 1);
    assert_eq!(problems(&[&output("shear_rate")]), "[]");
    let grains =
        ["sample.grading=Single(\"1 mm\")", "materials.sand=(density: \"2600 kg/m^3\", friction: 0.5)"];
    assert_eq!(problems(&[&output("inertial_number"), grains[0], grains[1]]), "[]");
    assert!(problems(&[&output("coordination"), grains[0], grains[1]]).contains("`coordination`"));
}

#[test]
fn a_scene_that_leaves_choices_out_has_those_of_the_library() {
    let spec: granular_mpm::spec::MpmSpec = SceneText::new("", "(cell: 1)").parse().unwrap();
    assert_eq!(spec.options(false), granular_mpm::Options::default());
}

#[test]
fn the_pair_of_choices_that_has_no_safe_step_is_warned_of() {
    let warned = |edits: &[&str]| {
        let report = check::check(&scene(edits)).unwrap();
        report.warnings.iter().any(|warning| warning.contains("no step that is safe everywhere"))
    };
    assert!(!warned(&[]));
    assert!(!warned(&["solvers.soil.scheme=StressLast"]));
    assert!(!warned(&["solvers.soil.shape=Linear"]));
    assert!(warned(&["solvers.soil.scheme=StressLast", "solvers.soil.shape=Linear"]));
}
