//! Coarse graining in a periodic cell: it goes on across the faces, and flows as the cell does.

use crate::sample::free;
use granular_core::glam::DVec2;
use granular_core::{D2, D3, Dim, FieldRef, FieldSink, Linear, Solver, SymmetricTensor, Vector};
use granular_dem::{
    CellControl, CoarseGrid, Control, Dem, Grain, Material, MaterialId, Materials, Options, PeriodicCell,
};

const SPACING: f64 = 0.01;
const SHEAR: f64 = 5.0;

/// A square or cubic lattice of equal grains that fills a cell; it overlaps where the radius is above half the spacing.
fn lattice<D: Dim>(side: usize, radius: f64) -> Dem<D> {
    let mut materials = Materials::new();
    let material = Material { density: 2500.0, normal_stiffness: 1e6, friction: 0.5, ..Material::default() };
    let id = materials.add(material).unwrap();
    let grain = |index: usize, id: MaterialId| {
        let place = |axis: usize| (index / side.pow(axis as u32) % side) as f64 * SPACING;
        let position =
            (0..D::N).fold(D::Vec::splat(0.5 * SPACING), |sum, axis| sum + D::Vec::along(axis, place(axis)));
        Grain::at(position, radius, id)
    };
    let grains = (0..side.pow(D::N as u32)).map(|index| grain(index, id)).collect();
    let mut dem = free::<D>(materials, grains, Options::default());
    let size = D::Vec::splat(SPACING * side as f64);
    dem.set_cell(PeriodicCell::new(D::Vec::ZERO, size, &vec![true; D::N]).unwrap()).unwrap();
    dem
}

fn over_the_cell<D: Dim>(side: usize, width: usize) -> CoarseGrid<D> {
    CoarseGrid::new(D::Vec::ZERO, D::Vec::splat(SPACING * side as f64), SPACING, width).unwrap()
}

fn sheared<D: Dim>(side: usize) -> Dem<D> {
    let mut dem = lattice::<D>(side, 4.5e-3);
    dem.control_cell(CellControl::default().with(0, 1, Control::Rate(SHEAR))).unwrap();
    dem
}

fn spread(values: &[f64], expected: f64) -> f64 {
    values.iter().map(|value| (value / expected - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn a_sheared_lattice_has_its_mass_density_and_shear_rate_everywhere() {
    fn check<D: Dim>(side: usize, steps: u64) {
        let mut dem = sheared::<D>(side);
        let ball = D::ball_volume(4.5e-3);
        let (mass, volume) = (2500.0 * ball * dem.len() as f64, (SPACING * side as f64).powi(D::N as i32));
        // At the start, and where the cell leans.
        for steps in [0, steps] {
            if steps > 0 {
                dem.advance(1e-5, steps).unwrap();
            }
            for width in [1, 2] {
                let grid = over_the_cell::<D>(side, width);
                let fields = dem.coarse_fields(&grid);
                let density = fields.density();
                let held: f64 = density.iter().sum::<f64>() * grid.cell_volume();
                assert!((held / mass - 1.0).abs() < 1e-12, "{held} kg of {mass} kg");
                assert!(fields.mass_outside() < 1e-12 * mass);
                let missed = spread(&density, mass / volume);
                assert!(missed < if steps == 0 { 1e-13 } else { 1e-10 }, "{missed:e} after {steps} steps");
                assert!(spread(&fields.shear_rate(), SHEAR) < 1e-9, "{:?}", fields.shear_rate());
                assert!(fields.inertial_number().iter().all(|number| number.is_finite()));
                for (cell, velocity) in fields.velocity().iter().enumerate() {
                    let height = (cell / side % side) as f64 * SPACING + 0.5 * SPACING;
                    assert!((*velocity - D::Vec::along(0, SHEAR * height)).length() < 1e-12);
                }
            }
        }
    }
    check::<D2>(10, 2000);
    check::<D3>(6, 2000);
}

#[test]
fn stress_across_the_faces_is_that_within() {
    fn check<D: Dim>(side: usize) {
        let dem = lattice::<D>(side, 5.05e-3);
        let stress = dem.cell_stress().unwrap();
        let fields = dem.coarse_fields(&over_the_cell::<D>(side, 1));
        for found in fields.contact_stress() {
            let expected = SymmetricTensor {
                xx: stress.at(0, 0),
                yy: stress.at(1, 1),
                zz: if D::N == 3 { stress.at(2, 2) } else { 0.0 },
                ..SymmetricTensor::ZERO
            };
            let missed = found + expected * -1.0;
            assert!(missed.contract(missed).sqrt() < 1e-12 * expected.xx, "{found:?} of {expected:?}");
        }
        assert!(spread(&fields.coordination(), 2.0 * D::N as f64) < 1e-12);
    }
    check::<D2>(6);
    check::<D3>(5);
}

/// A grid that is larger than the cell shows its images; one in a corner holds its share.
#[test]
fn a_grid_of_any_size_sees_the_same_fields() {
    let dem = sheared::<D2>(10);
    let corner = |low: f64, high: f64| CoarseGrid::new(DVec2::splat(low), DVec2::splat(high), SPACING, 1);
    for grid in [corner(-0.13, 0.27).unwrap(), corner(0.07, 0.12).unwrap()] {
        let fields = dem.coarse_fields(&grid);
        assert!(spread(&fields.density(), 2500.0 * D2::ball_volume(4.5e-3) / 1e-4) < 1e-12);
        assert!(spread(&fields.shear_rate(), SHEAR) < 1e-9);
    }
}

/// Takes the velocities that are shown.
#[derive(Default)]
struct Shown {
    x: Vec<f64>,
    speed: Vec<f64>,
}

impl FieldSink for Shown {
    fn wants(&self, name: &str) -> bool {
        ["velocity", "speed"].contains(&name)
    }
    fn field(&mut self, name: &str, _: &str, values: FieldRef<'_>) {
        match (name, values) {
            ("velocity", FieldRef::Vector2(values)) => self.x = values.iter().map(|v| v[0]).collect(),
            ("velocity", FieldRef::Vector3(values)) => self.x = values.iter().map(|v| v[0]).collect(),
            ("speed", FieldRef::Scalar(values)) => self.speed = values.to_vec(),
            _ => {}
        }
    }
    fn number(&mut self, _: &str, _: &str, _: f64) {}
}

#[test]
fn velocities_that_are_shown_are_those_at_which_grains_move() {
    fn check<D: Dim>(side: usize) {
        let mut dem = sheared::<D>(side);
        let mut shown = Shown::default();
        dem.show(&mut shown);
        let before: Vec<D::Vec> = dem.grains().map(|(_, grain)| grain.position).collect();
        let dt = 1e-6;
        dem.advance(dt, 1).unwrap();
        for (k, ((_, grain), before)) in dem.grains().zip(before).enumerate() {
            let moved = (grain.position - before).component(0) / dt;
            let height = before.component(1);
            assert!((shown.x[k] - SHEAR * height).abs() < 1e-12, "{} at {height}", shown.x[k]);
            assert!((moved - shown.x[k]).abs() < 1e-6, "{moved} against {}", shown.x[k]);
            assert!((shown.speed[k] - shown.x[k].abs()).abs() < 1e-12);
        }
    }
    check::<D2>(10);
    check::<D3>(5);
}
