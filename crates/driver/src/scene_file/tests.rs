mod edits;
mod errors;
mod files;
mod property;
mod references;

use super::{SceneProblem, SceneText};
use granular_core::units::{Density, Length, Stiffness, Time};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

const SAMPLE: &str = r#"// A column of glass beads collapses.
Scene(version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "glass": (density: "2650 kg/m^3", friction: 0.53, restitution: 0.75, normal_stiffness: "1.6e6 N/m") },
    sample: Column(width: "68 mm", aspect_ratio: 0.8, grading: Beta(min: "0.92 mm", max: "1.38 mm", a: 4, b: 4), material: "glass", packing: Ballistic, seed: 1),
    walls: [Floor(material: "glass"), Left(material: "glass"), Gate(opens: "collapse")],
    stages: [("settle", UntilQuiet(kinetic_over_potential: 1e-6)), ("collapse", For("0.45 s"))],
    solvers: { "grains": Dem((contact: Linear)) },
    outputs: [(every: Time("0.01 s"), write: Table(path: "series.csv", probes: ["front", "height"]))])
"#;

/// A scene for tests.
#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Scene {
    /// Version of the format.
    version: u32,
    dimension: Dimension,
    /// Gravity, by component.
    gravity: Vec<f64>,
    materials: BTreeMap<String, Material>,
    sample: Sample,
    #[serde(default)]
    walls: Vec<Wall>,
    stages: Vec<(String, Ending)>,
    solvers: BTreeMap<String, SolverSpec>,
    #[serde(default)]
    outputs: Vec<Output>,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
enum Dimension {
    Plane,
    Space,
}

/// What grains are made of; see [`Sample`].
#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Material {
    density: Density,
    /// Coulomb's coefficient | between equal grains.
    friction: f64,
    #[serde(default = "one")]
    restitution: f64,
    normal_stiffness: Option<Stiffness>,
}

fn one() -> f64 {
    1.0
}

/// Where the grains are.
#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
enum Sample {
    /// A rectangle of grains.
    Column {
        /// Width at rest.
        width: Length,
        aspect_ratio: f64,
        grading: Grading,
        material: String,
        #[serde(default)]
        packing: Packing,
        seed: u64,
    },
    /// Grains one by one.
    Grains(Vec<(f64, f64)>),
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
enum Grading {
    Beta { min: Length, max: Length, a: u32, b: u32 },
}

#[derive(Debug, Default, PartialEq, Deserialize, serde::Serialize, JsonSchema)]
enum Packing {
    /// Dropped one after the other.
    #[default]
    Ballistic,
    Lattice,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
enum Wall {
    Floor { material: String },
    Left { material: String },
    Gate { opens: String },
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
enum Ending {
    UntilQuiet { kinetic_over_potential: f64 },
    For(Time),
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
enum SolverSpec {
    Dem(DemSpec),
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct DemSpec {
    #[serde(default)]
    contact: Contact,
    step: Option<Time>,
}

#[derive(Debug, Default, PartialEq, Deserialize, JsonSchema)]
enum Contact {
    #[default]
    Linear,
    Hertz,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Output {
    every: Every,
    write: Write,
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
enum Every {
    Time(Time),
    Steps(u64),
}

#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
enum Write {
    Table { path: String, probes: Vec<String> },
}

fn sample() -> SceneText {
    SceneText::new("examples/x/scene.ron", SAMPLE)
}

/// The problem of the sample after a replacement.
fn problem_with(from: &str, to: &str) -> SceneProblem {
    assert!(SAMPLE.contains(from), "{from}");
    SceneText::new("scene.ron", SAMPLE.replacen(from, to, 1)).parse::<Scene>().unwrap_err()
}

/// What the text says at a path.
fn written<'a>(scene: &'a SceneText, path: &str) -> Option<&'a str> {
    scene.locate(path).map(|span| &scene.text()[span])
}
