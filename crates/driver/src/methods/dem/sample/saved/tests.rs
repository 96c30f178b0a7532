use crate::check;
use crate::methods::dem::sample_file::SavedSample;
use crate::model::Model;
use crate::scene_file::SceneText;
use granular_core::D2;
use granular_core::glam::DVec2;
use granular_dem::{Dem, Grain};
use std::any::Any;
use std::path::{Path, PathBuf};

const SCENE: &str = r#"Scene(
    version: 1, dimension: Plane, gravity: [0, -9.81],
    materials: { "glass": (density: 2650, normal_stiffness: 1.6e6, restitution: 0.75, friction: 0.5) },
    sample: File(path: "sample.csv"),
    walls: [Floor(material: "glass")],
    stages: [(name: "rest", end: For("1 ms"))],
    solvers: { "grains": Dem(()) },
)"#;

/// A folder with a file of 10 x 10 grains on a square lattice, 1 mm in radius, with odd numbers and motion.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("granular-sample-{name}-{}", std::process::id()));
    let grain = |k: u32| {
        let place = 2e-3 * DVec2::new(f64::from(k % 10) + 0.5, f64::from(k / 10) + 0.5);
        let odd = 1.0 / (3.0 + f64::from(k));
        Grain::at(place, 1e-3 * (1.0 - 1e-16 * odd), granular_dem::MaterialId::of_index(0))
            .moving(DVec2::new(odd, -odd))
            .turning(1e5 * odd)
    };
    let (grains, materials) = ((0..100).map(grain).collect(), vec!["glass".to_owned()]);
    SavedSample::<D2> { grains, materials, column: None }.write(&folder.join("sample.csv")).unwrap();
    folder
}

fn built(folder: &Path, edits: &[&str]) -> Result<Model, String> {
    let path = folder.join(format!("scene-{}.ron", edits.len()));
    std::fs::write(&path, SCENE).unwrap();
    let mut text = SceneText::read(&path).unwrap();
    edits.iter().try_for_each(|edit| text.set(edit)).map_err(|problem| problem.to_string())?;
    check::read(&text).map(|(_, model)| model).map_err(|failure| failure.to_string())
}

fn dem(model: &Model) -> &Dem<D2> {
    let solver: &dyn Any = model.simulation.solver();
    solver.downcast_ref().unwrap()
}

#[test]
fn a_scene_takes_a_sample_to_the_same_bits() {
    let folder = folder("bits");
    let model = built(&folder, &["sample.moving=true"]).unwrap();
    let text = std::fs::read_to_string(folder.join("sample.csv")).unwrap();
    assert_eq!(SavedSample::of(dem(&model), vec!["glass".to_owned()], None).text(), text);
    let rests = built(&folder, &[]).unwrap();
    assert!(dem(&rests).grains().all(|(_, grain)| grain.velocity == DVec2::ZERO && grain.spin == 0.0));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_cut_box_that_is_shifted_to_the_origin_is_a_column() {
    let folder = folder("cut");
    let cut = "sample.cut=[Box(low: [\"3.9 mm\", \"-1 mm\"], high: [\"12.1 mm\", \"10.1 mm\"])]";
    let model = built(&folder, &[cut, "sample.shift=[\"-3.9 mm\", \"1 mm\"]"]).unwrap();
    // Columns 2 to 5 of the lattice, rows 0 to 4.
    assert_eq!(dem(&model).len(), 20);
    let column = model.column().unwrap();
    assert!((column.width - 8.2e-3).abs() < 1e-12 && (column.height - 11.1e-3).abs() < 1e-12, "{column:?}");
    let shifted = dem(&model).grains().map(|(_, grain)| grain.position.x).fold(f64::INFINITY, f64::min);
    assert!((shifted - 1.1e-3).abs() < 1e-12);
    // Elsewhere it is no column, and a gate has no place.
    assert_eq!(built(&folder, &[cut]).unwrap().column(), None);
    let gate = "walls=[Gate(material: \"glass\", opens: \"rest\")]";
    let said = built(&folder, &[cut, gate]).unwrap_err();
    assert!(said.contains("only with a sample that is a Column"), "{said}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_cannot_be_taken_is_told() {
    let folder = folder("told");
    for (edits, expected) in [
        (&["sample.path=\"nothing.csv\""][..], "nothing.csv`, which cannot be read"),
        (&["materials={ \"steel\": (normal_stiffness: 1, restitution: 0.5, friction: 0) }"], "`glass`"),
        (&["sample.cut=[Box(low: [1, 1], high: [2, 2])]"], "regions without a grain"),
        (&["sample.cut=[Box(low: [1, 1], high: [2, 0])]"], "low below high"),
        (&["sample.cut=[HalfSpace(point: [0, 0], normal: [0, 0])]"], "a direction"),
        (&["sample.cut=[Cylinder(from: [0, 0], to: [0, 1], radius: 1)]"], "in the plane a Box does the same"),
        (&["sample.shift=[1]"], "sample.shift"),
        (&["dimension=Space", "gravity=[0, 0, -9.81]"], "line 2: grains in the plane"),
    ] {
        let said = built(&folder, edits).unwrap_err();
        assert!(said.contains(expected), "{edits:?}: {said}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}
