use super::*;
use crate::{Grains, LinearElastic, LinearFriction, MohrCoulomb, MuI, Newtonian, Strength, Tait};

fn elastic() -> LinearElastic {
    LinearElastic::new(1.98e6, 0.23).unwrap()
}

fn sand() -> MohrCoulomb {
    MohrCoulomb::new(elastic(), Strength::of_friction(23.2_f64.to_radians())).unwrap()
}

fn passive() -> f64 {
    let sine = 23.2_f64.to_radians().sin();
    (1.0 + sine) / (1.0 - sine)
}

fn close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{found} instead of {wanted}");
}

#[test]
fn an_elastic_material_has_the_constants_it_was_given() {
    let test = run(&elastic(), &Path::triaxial_compression(1e5, 0.01)).unwrap();
    let last = test.last();
    close(last.deviator_stress, 1.98e6 * 0.01, 1e-10);
    close(last.strain.xx, 0.23 * 0.01, 1e-10);
    // The stored energy counts from zero stress, the work from the start.
    close(last.stored_energy - test.states[0].stored_energy, last.work, 1e-10);
    let pressed = run(&elastic(), &Path::isotropic(1e3, 5e3)).unwrap();
    close(pressed.last().volumetric_strain, -4e3 / elastic().bulk(), 1e-10);
}

/// Mohr-Coulomb in triaxial compression: q at failure is (k - 1) times the cell pressure, reached at q/E; then the volume stays.
#[test]
fn sand_fails_in_triaxial_compression_at_its_strength() {
    let test = run(&sand(), &Path::triaxial_compression(1e5, 0.1)).unwrap();
    let failure = (passive() - 1.0) * 1e5;
    close(failure, 130.00e3, 4e-5);
    close(test.last().deviator_stress, failure, 1e-10);
    close(failure / 1.98e6, 0.065657, 1e-5);
    for state in &test.states {
        let axial = -state.strain.yy;
        close(state.deviator_stress, (1.98e6 * axial).min(failure), 1e-10);
        let volume = -(1.0 - 2.0 * 0.23) * axial.min(failure / 1.98e6);
        assert!((state.volumetric_strain - volume).abs() < 1e-10, "{} {volume}", state.volumetric_strain);
    }
    close(test.last().mobilised_friction, 23.2_f64.to_radians().sin(), 1e-10);
}

/// In plane strain the stress across the plane is the middle one: the return is to the plane of the pyramid.
#[test]
fn sand_fails_in_plane_strain_at_its_strength() {
    let test = run(&sand(), &Path::biaxial_compression(1e5, 0.1)).unwrap();
    let yield_strain = (1.0 - 0.23 * 0.23) * (passive() - 1.0) * 1e5 / 1.98e6;
    close(yield_strain, 0.062184, 1e-5);
    let mut at_yield = None;
    for state in &test.states {
        let axial = -state.strain.yy;
        let rise = axial.min(yield_strain) / yield_strain;
        close(-state.stress.yy, 1e5 * (1.0 + rise * (passive() - 1.0)), 1e-10);
        if axial >= yield_strain && at_yield.is_none() {
            at_yield = Some(-state.stress.zz);
        }
    }
    close(at_yield.unwrap(), 129.90e3, 1e-4);
    close(-test.last().stress.yy, 230.00e3, 2e-5);
}

/// The elastic ratio of lateral to axial stress is below the active one, so sand in an oedometer yields at once, on an edge.
#[test]
fn sand_in_an_oedometer_yields_on_an_edge() {
    let test = run(&sand(), &Path::oedometer(0.0, 0.01)).unwrap();
    let slope = 3.0 * elastic().bulk() / (1.0 + 2.0 / passive());
    close(slope, 1.96125e6, 1e-5);
    for state in &test.states[1..] {
        close(state.stress.xx / state.stress.yy, 1.0 / passive(), 1e-8);
        close(state.stress.zz / state.stress.yy, 1.0 / passive(), 1e-8);
        close(state.stress.yy, slope * state.strain.yy, 1e-8);
    }
}

/// With no dilation, simple shear ends where the ratio of shear to normal stress is the sine of the angle of friction, not its tangent.
#[test]
fn simple_shear_of_sand_ends_at_the_sine() {
    let test = run(&sand(), &Path::simple_shear(1e5, 0.6)).unwrap();
    let last = test.last();
    close(last.stress.yy, -1e5, 1e-10);
    close(last.stress.xy / 1e5, 23.2_f64.to_radians().sin(), 1e-6);
    let constant = run(&sand(), &Path::simple_shear_of_constant_volume(1e5, 0.6)).unwrap();
    close(constant.last().mean_pressure, 1e5, 1e-10);
}

/// Steady shear at a given I.
#[test]
fn a_flow_under_normal_stress_has_the_friction_of_its_rate() {
    let grains = Grains::Dry { diameter: 1e-3, density: 2500.0 };
    let law = MuI::new(elastic(), LinearFriction::new(0.22, 1.0).unwrap(), grains).unwrap();
    let rate = 0.05 / law.number(1.0, 1e3);
    let test = run(&law, &Path::simple_shear(1e3, 2.0).over(2.0 / rate)).unwrap();
    close(test.last().stress.xy / 1e3, 0.27, 1e-9);
}

#[test]
fn the_work_is_stored_or_lost() {
    let balance = |increments: usize| {
        let path = Path::triaxial_compression(1e5, 0.1).in_increments(increments);
        let test = run(&sand(), &path).unwrap();
        let (first, last) = (&test.states[0], test.last());
        let missing = last.work - (last.stored_energy - first.stored_energy) - last.plastic_work;
        missing.abs() / last.work
    };
    // Only the increment that meets the strength is off.
    assert!(balance(1000) < 1e-5, "{}", balance(1000));
    assert!(balance(10_000) < 1e-6, "{}", balance(10_000));
}

#[test]
fn a_fluid_is_pressed_by_its_volume() {
    let state = Tait::new(1000.0, 30.0).unwrap();
    let law = Newtonian::new(1e-3, state).unwrap();
    let test = run(&law, &Path::isotropic(0.0, 5e4)).unwrap();
    close(test.last().mean_pressure, 5e4, 1e-12);
    close(state.pressure(test.last().volumetric_strain.exp()), 5e4, 1e-10);
    close(test.last().work, test.last().stored_energy, 0.1);
}

#[test]
fn what_cannot_be_reached_is_said() {
    let controls = [Control::Strain(0.0); 6];
    let tension = Path::of(
        SymmetricTensor::ZERO,
        [Control::Stress(1e3), controls[1], controls[2], controls[3], controls[4], controls[5]],
    );
    let error = run(&sand(), &tension).unwrap_err();
    assert!(
        matches!(error, ElementError::Unreached { leg: 0, increment: 0, component: "xx", .. }),
        "{error:?}"
    );
    assert!(error.to_string().contains("comes no nearer than 0 Pa"), "{error}");
    let broken = Path::oedometer(f64::NAN, 0.1);
    assert_eq!(run(&sand(), &broken).unwrap_err(), ElementError::NotFinite { leg: 0, increment: 0 });
}

#[test]
fn rows_have_as_many_numbers_as_columns() {
    let test = run(&sand(), &Path::oedometer(0.0, 0.01).in_increments(3)).unwrap();
    assert_eq!(test.states.len(), 4);
    let columns = test.columns();
    assert!(test.states.iter().all(|state| test.row(state).len() == columns.len()));
    assert_eq!(columns.last().unwrap().0, "plastic_strain");
}
