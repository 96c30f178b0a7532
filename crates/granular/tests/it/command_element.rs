//! `granular element`: laws along paths.

use crate::support::{Scratch, files};
use granular_io::read_table;
use std::fs;

/// A material alone.
const SAND: &str = r#"// Sand.
(
    density: "1925 kg/m^3",
    law: MohrCoulomb(young_modulus: "1.98 MPa", poisson_ratio: 0.23, friction_angle: "23.2 deg"),
)"#;

/// The same in a scene.
fn scene() -> String {
    format!(
        "Scene(version: 1, dimension: Plane, gravity: [0, -9.81],
    continua: {{ \"sand\": {SAND}, \"clay\": (density: 1800, law: LinearElastic(young_modulus: 1e6, poisson_ratio: 0.3)) }},
    sample: Column(extent: Width(\"0.1 m\"), aspect_ratio: 1, material: \"sand\"),
    stages: [(name: \"rest\", end: For(\"1 ms\"))],
    solvers: {{ \"soil\": Mpm((cell: \"10 mm\")) }},
)"
    )
}

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    fs::write(scratch.path("sand.ron"), SAND).unwrap();
    fs::write(scratch.path("scene.ron"), scene()).unwrap();
    scratch
}

#[test]
fn a_triaxial_test_leaves_its_table_and_its_figure() {
    let scratch = scratch("element");
    let arguments = ["element", "sand.ron", "triaxial", "--pressure", "50 kPa", "--steps", "200", "-o", "a"];
    let told = scratch.granular(&[&arguments[..], &["--json"]].concat()).expect(0).json();
    let keys: Vec<&str> = told.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(keys, ["material", "law", "path", "plan", "peak", "end", "files"]);
    assert_eq!((&told["law"], &told["plan"]["pressure"]), (&"Mohr-Coulomb".into(), &50e3.into()));
    // k - 1 times the pressure.
    let strength = 1.300_008_6 * 50e3;
    assert!((told["end"]["stress"].as_f64().unwrap() / strength - 1.0).abs() < 1e-4, "{told}");
    let names: Vec<String> = files(&scratch.path("a")).into_keys().collect();
    assert_eq!(names, ["element.csv", "element.png", "element.svg"]);
    let table = read_table(&scratch.path("a/element.csv")).unwrap();
    assert_eq!(table.rows.len(), 201, "one for the start");
    let last = |name: &str| *table.column(name).unwrap().last().unwrap();
    assert!((last("strain_yy") + 0.1).abs() < 1e-12 && (last("stress_xx") + 50e3).abs() < 1e-6);
    assert_eq!(last("deviator_stress"), told["end"]["deviator_stress"].as_f64().unwrap());
    assert_eq!(table.unit("work"), Some("J/m^3"));
    let text = scratch.granular(&arguments).expect(0).out;
    for part in
        ["sand: Mohr-Coulomb, triaxial from 50 kPa", "23.2", "lost to plastic strain", "a/element.csv"]
    {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

#[test]
fn a_continuum_of_a_scene_goes_all_ways() {
    let scratch = scratch("element-scene");
    for path in ["triaxial", "plane-strain", "oedometer", "simple-shear"] {
        scratch.granular(&["element", "scene.ron:sand", path, "--steps", "50", "-q"]).expect(0);
        assert!(scratch.path(&format!("element/sand-{path}/element.svg")).is_file());
    }
    // The same material, edited, and another one.
    let softer = ["element", "scene.ron:sand", "oedometer", "--set", "continua.sand.law.young_modulus=1 MPa"];
    let end = |arguments: &[&str]| {
        scratch.granular(&[arguments, &["--json"]].concat()).expect(0).json()["end"]["stress"]
            .as_f64()
            .unwrap()
    };
    let ratio = end(&["element", "sand.ron", "oedometer"]) / end(&softer);
    assert!((ratio / 1.98 - 1.0).abs() < 1e-9, "{ratio}");
    assert!(end(&["element", "scene.ron:clay", "oedometer"]) > 0.0);
}

#[test]
fn what_is_wrong_is_told_with_its_place() {
    let scratch = scratch("element-wrong");
    let cases: [(&[&str], i32, &[&str]); 12] = [
        (&["missing.ron", "triaxial"], 2, &["there is no such file", "missing.ron"]),
        (
            &["scene.ron:snad", "triaxial"],
            2,
            &["without `snad`", "scene.ron:2:", "clay, sand", "did you mean `sand`?"],
        ),
        (&["scene.ron", "triaxial"], 2, &["this is a scene", "scene.ron:sand"]),
        (
            &["sand.ron", "triaxial", "--set", "law=MohrColomb()"],
            2,
            &["`MohrColomb`", "sand.ron:4:", "did you mean `MohrCoulomb`?"],
        ),
        (
            &["sand.ron", "triaxial", "--set", "law.poisson_ratio=0.5"],
            2,
            &["Poisson's ratio is 0.5", "sand.ron:4:10"],
        ),
        (
            &["sand.ron", "triaxial", "--set", "law.friction_angle=90 deg"],
            2,
            &["angle of friction", "less than 90", "sand.ron:4:10"],
        ),
        (&["sand.ron", "triaxial", "--set", "law.dilation_angle=30 deg"], 2, &["dilation", "sand.ron:4:10"]),
        (&["sand.ron", "triaxial", "--set", "law.freedom=1"], 2, &["unknown key `freedom`", "sand.ron:4:"]),
        (
            &["scene.ron:sand", "triaxial", "--set", "continua.sand.law.poisson_ratio=0.5"],
            2,
            &["Poisson's ratio is 0.5", "scene.ron:5:10"],
        ),
        (&["sand.ron", "torsion"], 2, &["torsion", "simple-shear"]),
        (&["sand.ron", "triaxial", "--pressure", "5 mm"], 2, &["is a length, but a pressure"]),
        (&["sand.ron", "triaxial", "--steps", "0"], 5, &["--steps: 0", "from 1 to 100000"]),
    ];
    for (arguments, code, told) in cases {
        scratch.granular(&[&["element"], arguments].concat()).expect(code).says(told);
    }
    let json =
        scratch.granular(&["element", "sand.ron", "triaxial", "--json", "--set", "law.poisson_ratio=0.5"]);
    let problem = &json.expect(2).json()["problems"][0];
    assert_eq!((&problem["place"]["line"], &problem["place"]["column"]), (&4.into(), &10.into()));
    assert_eq!(files(&scratch.path("")).len(), 2, "nothing was written");
}
