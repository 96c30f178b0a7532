//! Lattices from what is known of a flow.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Limits, Solver};
use granular_lbm::*;

const CYLINDER: FlowScales = FlowScales { length: 0.1, speed: 1.5, viscosity: 1e-3, cells: 20, mach: 0.1 };

#[test]
fn a_lattice_keeps_the_mach_number_and_the_relaxation_time() {
    let setup = Setup::<D2>::for_flow(DVec2::new(2.2, 0.41), FlowScales { cells: 10, ..CYLINDER }).unwrap();
    assert_eq!(setup.cells, [220, 41, 1]);
    let mach = 3.0_f64.sqrt() * 1.5 / setup.lattice_speed();
    assert!((mach - 0.1).abs() < 1e-12 && setup.tau() < 1.0, "{mach} {}", setup.tau());
    assert_eq!(setup.expected_speed, 1.5);
    assert!((CYLINDER.reynolds_number() - 150.0).abs() < 1e-9);
    assert!((CYLINDER.grid_reynolds_number() - 7.5).abs() < 1e-9);
    // A slow flow is bound by the relaxation time.
    let slow = FlowScales { speed: 1e-5, ..CYLINDER };
    let setup = Setup::<D3>::for_flow(DVec3::splat(0.2), slow).unwrap();
    assert!((setup.tau() - 1.0).abs() < 1e-12, "{}", setup.tau());
    let lbm = Lbm3::new(setup).unwrap();
    let mut limits = Limits::default();
    lbm.limits(&mut limits);
    let mach = limits.bounds.iter().find(|bound| bound.name == "Mach number").unwrap();
    assert!(mach.value > 0.0 && mach.value < 1e-4, "{}", mach.value);
}

#[test]
fn what_cannot_be_used_is_refused_with_what_would() {
    let size = DVec2::new(0.4, 0.2);
    let refused = |scales: FlowScales| Setup::<D2>::for_flow(size, scales).unwrap_err();
    assert_eq!(refused(FlowScales { mach: 0.4, ..CYLINDER }).what, "Mach number");
    assert_eq!(refused(FlowScales { mach: f64::NAN, ..CYLINDER }).what, "Mach number");
    assert_eq!(refused(FlowScales { cells: 0, ..CYLINDER }).what, "cells across the length");
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(FlowScales { length: value, ..CYLINDER }).what, "length of the flow");
        assert_eq!(refused(FlowScales { speed: value, ..CYLINDER }).what, "speed of the flow");
        assert_eq!(refused(FlowScales { viscosity: value, ..CYLINDER }).what, "viscosity");
    }
    // Water at 1.5 m/s past 0.1 m in 20 cells.
    let error = refused(FlowScales { viscosity: 1e-6, ..CYLINDER });
    assert!(error.what == "grid Reynolds number" && error.allowed.contains(": 150 cells"), "{error}");
    let fits = FlowScales { viscosity: 1e-6, cells: 150, ..CYLINDER };
    assert!(Setup::<D2>::for_flow(DVec2::new(0.4, 0.2), fits).is_ok());
    let error = Setup::<D2>::for_flow(DVec2::new(0.4, 0.203), CYLINDER).unwrap_err();
    assert!(error.what == "size along y" && error.allowed.contains("0.200000000 m or 0.205"), "{error}");
    let error = Setup::<D2>::for_flow(DVec2::new(f64::NAN, 0.2), CYLINDER).unwrap_err();
    assert_eq!(error.what, "size along x");
    let error = Setup::<D2>::for_flow(DVec2::new(1e30, 0.2), CYLINDER).unwrap_err();
    assert!(error.allowed.contains("1e9 cells"), "{error}");
}

#[test]
fn whole_fields_are_the_values_of_cells() {
    let mut setup = Setup::<D2>::new([70, 69, 1], 1e-3, 1e-6, 0.7);
    setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(1e-3, 0.0))];
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::splat(0.02), radius: 5e-3 }));
    let dt = setup.time_step;
    let mut lbm = Lbm2::new(setup).unwrap();
    let mut field = FlowField::default();
    for steps in [7, 5] {
        lbm.advance(dt, steps).unwrap();
        lbm.flow_field_into(&mut field);
        assert_eq!(field, lbm.flow_field());
        assert_eq!(field.pressures, lbm.pressures());
        assert_eq!(field.velocities, lbm.velocities());
        for (k, pressure) in field.pressures.iter().enumerate() {
            let cell = [k % 70, k / 70, 0];
            let flow = lbm.flow(cell);
            assert_eq!(lbm.covering(cell), flow.is_none().then_some(0));
            assert_eq!(*pressure, flow.map_or(0.0, |flow| flow.pressure));
            assert_eq!(field.velocities[k], flow.map_or(DVec2::ZERO, |flow| flow.velocity));
        }
    }
}
