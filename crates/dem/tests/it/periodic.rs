//! The periodic cell: contract, invariance, conservation, energy, and agreement with free space.

use crate::sample::{Lattice, Random, free};
use granular_core::glam::DVec2;
use granular_core::{D2, D3, Dim, Linear, Section, Solver, Vector, contract_tests};
use granular_dem::{
    CellControl, Control, Dem, Dem2, Grain, Material, Materials, Matrix, Options, PeriodicCell, SetupError,
};

fn short_lists() -> Options {
    Options { skin: 0.02, ledger: true, ..Options::default() }
}

/// A cell full of moving grains in touch.
fn filled<D: Dim>(lattice: Lattice, material: Material, options: Options) -> Dem<D> {
    let mut materials = Materials::new();
    let glass = materials.add(material).unwrap();
    let mut dem = free::<D>(materials, lattice.grains::<D>(&[glass]), options);
    let side = lattice.spacing * lattice.side as f64;
    let size = (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, side));
    dem.set_cell(PeriodicCell::new(D::Vec::ZERO, size, &vec![true; D::N]).unwrap()).unwrap();
    dem
}

fn shear(rate: f64) -> CellControl {
    CellControl::default().with(0, 1, Control::Rate(rate))
}

/// Changes numbers of a saved state: to bring a cell near an event that takes many steps.
fn with_entry<D: Dim>(mut dem: Dem<D>, entry: &str, change: impl Fn(usize, f64) -> f64) -> Dem<D> {
    let mut section = Section::new("solver");
    dem.save(&mut section);
    let mut later = Section::new("solver");
    for (name, bytes) in section.entries() {
        let mut bytes = bytes.to_vec();
        if name == entry {
            for (k, number) in bytes.chunks_exact_mut(8).enumerate() {
                let value = f64::from_le_bytes((&*number).try_into().unwrap());
                number.copy_from_slice(&change(k, value).to_le_bytes());
            }
        }
        later.put_bytes(name, bytes);
    }
    dem.restore(&later).unwrap();
    dem
}

/// Disks in shear under a pressure, whose cell flips in about ten steps and wraps again soon after.
fn sheared_disks() -> Dem2 {
    let mut dem = filled::<D2>(Lattice::default(), Material::default(), short_lists());
    dem.control_cell(shear(1000.0).with(1, 1, Control::Stress(1e4))).unwrap();
    let dem = with_entry(dem, "cell edges", |k, value| if k == 2 { 0.536 * 48e-3 } else { value });
    with_entry(dem, "cell work and drift", |k, value| if k == 1 { 5.98e-3 } else { value })
}

/// Spheres under a pressure on all sides.
fn pressed_spheres() -> Dem<D3> {
    let lattice = Lattice { side: 14, speed: 10.0, ..Lattice::default() };
    let mut dem =
        filled::<D3>(lattice, Material { rolling_friction: 0.1, ..Material::default() }, short_lists());
    dem.control_cell(CellControl::isotropic::<D3>(1e6).with(0, 2, Control::Rate(1e4))).unwrap();
    with_entry(dem, "cell work and drift", |k, value| if k == 1 { 1.745e-3 } else { value })
}

contract_tests!(disks_in_a_sheared_cell, sheared_disks, 1.5e-6, warm_up = 600);
contract_tests!(
    disks_without_friction_in_a_cell,
    || filled::<D2>(Lattice::default(), Material { friction: 0.0, ..Material::default() }, short_lists()),
    1.5e-6,
    warm_up = 600
);
contract_tests!(spheres_in_a_pressed_cell, pressed_spheres, 4e-8, warm_up = 600);

#[test]
fn the_samples_flip_wrap_and_remember_contacts_across_faces() {
    let mut dem = sheared_disks();
    let tilt = dem.cell().unwrap().edges().at(0, 1);
    dem.advance(1.5e-6, 20).unwrap();
    assert!(tilt > 0.024 && dem.cell().unwrap().edges().at(0, 1) < -0.018, "it did not flip");
    let mut section = Section::new("solver");
    dem.save(&mut section);
    let remembered = section.array::<[u32; 2]>("image contacts").unwrap().len();
    // The rows do not match across the tilted faces: there are contacts across the others only.
    assert!(remembered > 5, "{remembered}");
    let drift = section.array::<f64>("cell work and drift").unwrap()[1];
    assert!(drift < 1e-3, "grains were not put back inside: {drift}");
    assert!(dem.losses().sliding > 0.0);
}

/// Greatest difference of velocities over the greatest velocity.
fn difference<D: Dim>(a: &Dem<D>, b: &Dem<D>) -> f64 {
    let mut largest = (0.0_f64, 0.0_f64);
    for id in 0..a.len() as u32 {
        let (a, b) = (a.grain(id), b.grain(id));
        largest.0 = largest.0.max((a.velocity - b.velocity).length());
        largest.1 = largest.1.max(a.velocity.length());
    }
    largest.0 / largest.1
}

/// The same grains in another place and another cell of the same lattice of images.
fn shifted(offset: DVec2, tilt: f64) -> Dem2 {
    let lattice = Lattice { side: 12, ..Lattice::default() };
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let mut grains = lattice.grains::<D2>(&[glass]);
    grains.iter_mut().for_each(|grain| grain.position += offset);
    let mut dem = free::<D2>(materials, grains, Options { ledger: true, ..Options::default() });
    let edges = Matrix::<D2>::from_fn(|row, column| match (row, column) {
        (0, 1) => 12e-3 * tilt,
        (a, b) if a == b => 12e-3,
        _ => 0.0,
    });
    dem.set_cell(PeriodicCell::with_edges(DVec2::ZERO, edges, &[true, true]).unwrap()).unwrap();
    dem.control_cell(shear(500.0).with(1, 1, Control::Stress(2e4))).unwrap();
    dem
}

#[test]
fn no_shift_and_no_choice_of_the_cell_changes_forces() {
    let mut here = shifted(DVec2::ZERO, 0.0);
    let mut random = Random::new(4);
    let others = (0..4).map(|k| shifted(random.vector::<D2>(0.1), [0.0, 1.0, -1.0, 2.0][k]));
    let mut others: Vec<Dem2> = others.collect();
    here.advance(2e-6, 150).unwrap();
    for other in &mut others {
        other.advance(2e-6, 150).unwrap();
        let error = difference(&here, other);
        assert!(error < 1e-10, "{error}");
        let stress = here.cell_stress().unwrap();
        let off = stress.plus(&other.cell_stress().unwrap(), -1.0).norm() / stress.norm();
        assert!(off < 1e-10, "{off}");
    }
}

#[test]
fn momentum_relative_to_the_flow_stays_zero() {
    let mut dem = sheared_disks();
    let mass = 48.0 * 48.0 * 2650.0 * std::f64::consts::PI * 0.25e-6;
    let start = dem.momentum();
    dem.advance(1.5e-6, 400).unwrap();
    // The mean flow obeys p' = -L p: with L = [[0, g], [0, h]] it follows from the strain.
    let strain = *dem.cell().unwrap().strain();
    let off = (dem.momentum().y - start.y * (-strain.at(1, 1)).exp()).abs();
    assert!(off < 1e-6 * mass && start.y.abs() > 1e-4 * mass, "{off} {}", start.y);
}

/// Two grains that meet across a face of a cell in shear, and the same two in free space with
/// velocities of the laboratory.
fn meeting_in_shear(dt: f64, time: f64) -> f64 {
    let rate = 400.0;
    let mut materials = Materials::new();
    let glass = materials.add(Material::default()).unwrap();
    let edge = 10e-3;
    let (a, b) = (DVec2::new(4.0e-3, 9.6e-3), DVec2::new(4.9e-3, 10.3e-3));
    let (ua, ub) = (DVec2::new(0.3, 0.2), DVec2::new(-0.2, -0.3));
    let lab = |x: DVec2| DVec2::new(rate * x.y, 0.0);
    let free_pair = vec![
        Grain::at(a, 0.5e-3, glass).moving(ua + lab(a)),
        Grain::at(b, 0.5e-3, glass).moving(ub + lab(b)),
    ];
    let in_cell = vec![Grain::at(a, 0.5e-3, glass).moving(ua), Grain::at(b, 0.5e-3, glass).moving(ub)];
    let mut outside = free::<D2>(materials.clone(), free_pair, Options::default());
    let mut inside = free::<D2>(materials, in_cell, Options::default());
    inside.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::splat(edge), &[true, true]).unwrap()).unwrap();
    inside.control_cell(shear(rate)).unwrap();
    let steps = (time / dt).round() as u64;
    outside.advance(dt, steps).unwrap();
    inside.advance(dt, steps).unwrap();
    let mut off = 0.0_f64;
    for id in 0..2 {
        let (x, out) = (inside.grain(id), outside.grain(id));
        // Relative velocities: those of the laboratory less the flow where the grain is in free space.
        off = off.max((x.velocity - (out.velocity - lab(out.position))).length() / ua.length());
        off = off.max((x.spin - out.spin).abs() * 0.5e-3 / ua.length());
    }
    assert!(outside.grain(0).spin != 0.0, "they never met");
    off
}

#[test]
fn a_meeting_across_a_face_in_shear_is_that_in_free_space() {
    let time = 9e-4;
    // In simple shear the two schemes are one, not only to the order of the step.
    for dt in [2e-6, 0.5e-6] {
        let off = meeting_in_shear(dt, time);
        assert!(off < 1e-10, "{off}");
    }
}

#[test]
fn the_work_of_the_cell_closes_the_ledger() {
    for friction in [0.0, 0.5] {
        let material = Material { friction, ..Material::default() };
        let mut dem = filled::<D2>(Lattice { side: 16, ..Lattice::default() }, material, short_lists());
        dem.control_cell(shear(800.0).with(1, 1, Control::Stress(3e4)).with(0, 0, Control::Rate(-20.0)))
            .unwrap();
        let before = dem.energies().mechanical();
        dem.advance(1e-6, 2000).unwrap();
        let (work, residual) = (dem.cell().unwrap().work(), dem.energy_residual().unwrap());
        assert!(work > 0.2 * before, "{work} {before}");
        assert!(residual.abs() < 1e-3 * (before + work), "{residual} of {}", before + work);
    }
}

#[test]
fn gravity_along_a_periodic_axis_is_booked() {
    let mut dem =
        filled::<D2>(Lattice { side: 12, ..Lattice::default() }, Material::default(), short_lists());
    dem.set_gravity(DVec2::new(500.0, 0.0));
    let before = dem.energies().mechanical();
    dem.advance(1e-6, 6000).unwrap();
    let residual = dem.energy_residual().unwrap();
    let moved = 0.5 * 500.0 * 6e-3_f64.powi(2);
    assert!(moved > 5e-3 && residual.abs() < 1e-3 * before.abs().max(1.0), "{residual} {before}");
}

#[test]
fn a_cell_follows_its_stress() {
    let mut dem = filled::<D2>(
        Lattice { side: 16, speed: 0.05, radii: (0.4e-3, 0.5e-3), ..Lattice::default() },
        Material { friction: 0.0, restitution: 0.2, ..Material::default() },
        Options::default(),
    );
    dem.control_cell(CellControl::isotropic::<D2>(2000.0)).unwrap();
    let dt = dem.recommended_step();
    dem.advance(dt, 60_000).unwrap();
    let stress = dem.cell_stress().unwrap();
    for axis in 0..2 {
        assert!((stress.at(axis, axis) - 2000.0).abs() < 20.0, "{stress:?}");
    }
    assert!((stress.at(0, 1) - stress.at(1, 0)).abs() < 1e-3 * 2000.0, "{stress:?}");
    let dense = dem.solid_fraction().unwrap();
    assert!((0.80..0.86).contains(&dense), "{dense}");
}

#[test]
fn what_does_not_fit_is_refused() -> Result<(), SetupError> {
    let narrow = Lattice { side: 3, ..Lattice::default() };
    let mut materials = Materials::new();
    let glass = materials.add(Material::default())?;
    let mut dem = free::<D2>(materials, narrow.grains::<D2>(&[glass]), Options::default());
    let cell = |size: f64| PeriodicCell::<D2>::new(DVec2::ZERO, DVec2::splat(size), &[true, true]);
    assert!(dem.control_cell(shear(1.0)).unwrap_err().to_string().contains("periodic cells"));
    let error = dem.set_cell(cell(1.7e-3)?).unwrap_err().to_string();
    assert!(error.contains("width of the cell"), "{error}");
    assert!(PeriodicCell::<D2>::new(DVec2::ZERO, DVec2::ONE, &[false, false]).is_err());
    assert!(cell(-1.0).is_err() && cell(f64::NAN).is_err());
    dem.set_cell(cell(3e-3)?)?;
    dem.control_cell(CellControl::default().with(0, 0, Control::Rate(-4000.0)))?;
    let error = dem.advance(1e-6, 1000).unwrap_err().to_string();
    assert!(error.contains("width of the cell") || error.contains("overlap"), "{error}");
    let mut chute = free::<D2>(Materials::new(), vec![], Options::default());
    chute.set_cell(PeriodicCell::new(DVec2::ZERO, DVec2::ONE, &[true, false])?)?;
    assert!(chute.control_cell(CellControl::isotropic::<D2>(1.0)).is_err());
    Ok(())
}
