use super::*;
use crate::check;
use crate::observers;
use crate::scene_file::SceneText;
use granular_core::{Linear, Numbers, Vector};
use granular_dem::{CoarseGrid, Grain, Material, Materials, Options, PeriodicCell, Setup, Wall};
use granular_io::Frame;
use granular_io::frame::Values;
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

const RADIUS: f64 = 1e-3;
const STIFFNESS: f64 = 1e5;

/// A lattice along the axes in the corner of planes, its grains `pitch` apart.
fn lattice<D: Dim>(side: usize, pitch: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let soft = Material { normal_stiffness: STIFFNESS, friction: 0.0, ..Material::default() };
    let glass = materials.add(soft).unwrap();
    let place = |index: usize| {
        let along = |axis: usize| pitch * (index / side.pow(axis as u32) % side) as f64 + RADIUS;
        (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, along(axis)))
    };
    let grains = (0..side.pow(D::N as u32)).map(|k| Grain::at(place(k), RADIUS, glass)).collect();
    let plane = |axis: usize| Wall::plane(&format!("{axis}"), D::Vec::ZERO, D::Vec::along(axis, 1.0), glass);
    let walls = (0..D::N).map(|axis| plane(axis).unwrap()).collect();
    let (gravity, options) = (D::Vec::ZERO, Options::default());
    Dem::new(Setup { materials, grains, walls, gravity, options }).unwrap()
}

fn numbers<D: Dim>(dem: &Dem<D>, names: &[&str]) -> Vec<f64> {
    let mut numbers = Numbers::wanting(names.iter().copied());
    show(dem, 2.0, &mut numbers);
    names.iter().map(|name| numbers.get(name).unwrap()).collect()
}

fn scalars(frame: &Frame, name: &str) -> Vec<f64> {
    match &frame.get(name).unwrap().values {
        Values::Scalar(values) => values.clone(),
        Values::Index(values) => values.iter().map(|&value| f64::from(value)).collect(),
        other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn grains_of_a_lattice_fill_their_cells_alike() {
    let disks = lattice::<D2>(10, 2.0 * RADIUS);
    assert_eq!(numbers(&disks, &["bulk_grains"]), [100.0]);
    assert!((numbers(&disks, &["bulk_density"])[0] - PI / 4.0).abs() < 1e-12);
    let mut frame = Frame::wanting(["local_density", "cell_volume", "in_bulk"]);
    show(&disks, 2.0, &mut frame);
    assert!(scalars(&frame, "local_density").iter().all(|density| (density - PI / 4.0).abs() < 1e-9));
    assert!(scalars(&frame, "cell_volume").iter().all(|area| (area / RADIUS.powi(2) - 4.0).abs() < 1e-9));
    assert!(scalars(&frame, "in_bulk").iter().all(|&inside| inside == 1.0));
    let spheres = lattice::<D3>(4, 2.0 * RADIUS);
    assert!((numbers(&spheres, &["bulk_density"])[0] - PI / 6.0).abs() < 1e-12);
}

#[test]
fn without_grains_there_are_fields_without_values() {
    let (materials, gravity, options) = (Materials::new(), DVec2::ZERO, Options::default());
    let dem =
        Dem::<D2>::new(Setup { materials, grains: Vec::new(), walls: Vec::new(), gravity, options }).unwrap();
    let mut frame = Frame::wanting(["local_density", "cell_stress", "in_bulk"]);
    show(&dem, 2.0, &mut frame);
    assert_eq!(frame.fields().len(), 3);
    let mut numbers = Numbers::wanting(["bulk_density", "bulk_grains"]);
    show(&dem, 2.0, &mut numbers);
    assert!(numbers.get("bulk_density").unwrap().is_nan());
    assert_eq!(numbers.get("bulk_grains"), Some(0.0));
}

#[test]
fn stress_of_cells_is_that_of_the_lattice() {
    let pitch = 1.99 * RADIUS;
    // Disks: a contact carries k d and stands for the pitch. The border has half cells and no outer contacts.
    let exact = STIFFNESS * (2.0 * RADIUS - pitch) / pitch;
    let disks = lattice::<D2>(10, pitch);
    let mut frame = Frame::wanting(["cell_stress"]);
    show(&disks, 2.0, &mut frame);
    let Values::Tensor(stress) = &frame.get("cell_stress").unwrap().values else { panic!() };
    let positions = grains(&disks).0;
    let inner =
        |p: &DVec2| p.cmpgt(DVec2::splat(2.5 * pitch)).all() && p.cmplt(DVec2::splat(7.5 * pitch)).all();
    let inside: Vec<usize> = (0..100).filter(|&k| inner(&positions[k])).collect();
    assert_eq!(inside.len(), 25);
    for k in inside {
        let [xx, yy, _, xy, ..] = stress[k];
        assert!((xx / exact - 1.0).abs() < 1e-9 && (yy / exact - 1.0).abs() < 1e-9, "{xx} {exact}");
        assert!(xy.abs() < 1e-9 * exact);
    }
    // The bulk: sum of force times branch over all contacts between grains, over all cells. At the border a grain has half of a branch.
    let [xx, xy] = numbers(&disks, &["bulk_stress_xx", "bulk_stress_xy"])[..] else { panic!() };
    let contacts = 10.0 * 9.0;
    let walls = 0.0;
    let side = 9.0 * pitch + 2.0 * RADIUS;
    let whole = (contacts * STIFFNESS * (2.0 * RADIUS - pitch) * pitch + walls) / (side * side);
    assert!((xx / whole - 1.0).abs() < 1e-9 && xy.abs() < 1e-9 * xx, "{xx} {whole}");
}

#[test]
fn a_periodic_packing_has_no_border() {
    let pitch = 2.0 * RADIUS;
    let mut dem = lattice::<D2>(6, pitch);
    assert!(shown(&dem).iter().any(|shown| shown.name == "bulk_density"));
    let grains: Vec<Grain<D2>> = dem.grains().map(|(_, grain)| grain).collect();
    let (materials, gravity) = (dem.materials().clone(), DVec2::ZERO);
    let setup = Setup { materials, grains, walls: Vec::new(), gravity, options: Options::default() };
    dem = Dem::new(setup).unwrap();
    let size = DVec2::splat(6.0 * pitch);
    dem.set_cell(PeriodicCell::new(DVec2::ZERO, size, &[true, true]).unwrap()).unwrap();
    let [density, count] = numbers(&dem, &["bulk_density", "bulk_grains"])[..] else { panic!() };
    assert!((density - PI / 4.0).abs() < 1e-12 && count == 36.0);
    dem.set_cell(PeriodicCell::new(DVec2::ZERO, size, &[true, false]).unwrap()).unwrap();
    assert!(shown(&dem).is_empty());
}

#[test]
fn cells_of_a_grid_share_voronoi_cells() {
    let disks = lattice::<D2>(10, 2.0 * RADIUS);
    let low = DVec2::splat(-3.0 * RADIUS);
    let grid = CoarseGrid::<D2>::new(low, -low + 20.0 * RADIUS, 1.3 * RADIUS, 1).unwrap();
    let mut frame = Frame::wanting(["local_density"]);
    show_on_grid(&grid, &disks, 2.0, &mut frame);
    let values = scalars(&frame, "local_density");
    let [columns, rows, _] = grid.cells();
    assert_eq!(values.len(), columns * rows);
    let known = values.iter().filter(|value| value.is_finite());
    assert!(known.clone().count() >= 15 * 15 && known.clone().count() <= 17 * 17);
    assert!(known.clone().all(|value| (value - PI / 4.0).abs() < 1e-9));
}

/// A short collapse with these outputs: how many tessellations it makes.
fn tessellations(outputs: &str) -> usize {
    let (name, text) = crate::TEMPLATES.iter().find(|(name, _)| *name == "column-collapse").unwrap();
    let mut text = SceneText::new(*name, *text);
    text.set("sample.extent=Grains(60)").unwrap();
    text.set("figures=[]").unwrap();
    text.set(&format!("outputs={outputs}")).unwrap();
    let (scene, mut model) = check::read(&text).unwrap();
    let folder = std::env::temp_dir().join(format!("granular-voronoi-{}", std::process::id()));
    let before = MADE.get();
    let mut observers: Vec<_> = scene
        .outputs
        .iter()
        .map(|output| observers::of_output(output, &folder, &model, true).unwrap())
        .collect();
    model.simulation.begin_segment(1e-6).unwrap();
    model.simulation.run(1e-4, &mut observers, &AtomicBool::new(false)).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    MADE.get() - before
}

#[test]
fn cells_are_made_at_output_times_and_only_if_asked_for() {
    let scene = |probe: &str, field: &str| {
        format!(
            "[(every: Steps(25), write: Table(path: \"a.csv\", probes: [\"front\"{probe}])), \
             (every: Steps(50), write: Fields(path: \"b\", fields: [\"radius\"{field}]))]"
        )
    };
    assert_eq!(tessellations(&scene("", "")), 0);
    // At steps 0, 25, 50, 75 and 100, whatever number of probes.
    assert_eq!(tessellations(&scene(", \"bulk_density\", \"bulk_grains\"", "")), 5);
    assert_eq!(tessellations(&scene("", ", \"local_density\", \"cell_stress\"")), 3);
    let tracks =
        "[(every: Steps(50), write: Tracks(path: \"c.csv\", grains: Every(9), fields: [\"local_density\"]))]";
    // One more for the head of the table.
    assert_eq!(tessellations(tracks), 4);
}
