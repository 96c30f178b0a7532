//! Limits, refusals, memory, and what happens beyond.

use granular_core::glam::DVec2;
use granular_core::{Limits, Solver, StepError};
use granular_lbm::*;

fn setup() -> Setup<granular_core::D2> {
    Setup::new([200, 100, 1], 1e-3, 1e-6, 0.6)
}

#[test]
fn what_makes_no_sense_is_refused_by_name() {
    type Change = fn(&mut Setup<granular_core::D2>);
    let cases: [(&str, Change); 9] = [
        ("viscosity", |s| s.viscosity = -1e-6),
        ("time step", |s| s.time_step = f64::NAN),
        ("cells", |s| s.cells = [200, 1, 1]),
        ("cells", |s| s.cells = [20, 20, 2]),
        ("faces", |s| s.faces[0][1] = Face::REST),
        ("velocity of a wall", |s| s.faces[1] = [Face::REST, Face::Wall(DVec2::new(0.0, 1e-3))]),
        ("relaxation rate", |s| {
            s.operator = Operator::MultipleRelaxation { ghosts: [1.5, 2.0, 1.4], odd: OddRate::Rate(1.5) };
        }),
        ("Lambda", |s| s.operator = Operator::TwoRelaxation { magic: 0.0 }),
        ("fluid", |s| {
            let block = Block { low: DVec2::splat(-1.0), high: DVec2::splat(1.0) };
            s.obstacles.push(Obstacle::new("all", block));
        }),
    ];
    for (what, change) in cases {
        let mut setup = setup();
        change(&mut setup);
        let error = Lbm2::new(setup).unwrap_err();
        assert_eq!(error.what, what, "{error}");
    }
}

#[test]
fn another_step_than_that_of_the_lattice_is_refused() {
    let mut lbm = Lbm2::new(setup()).unwrap();
    let dt = lbm.setup().time_step;
    assert!(matches!(lbm.advance(0.5 * dt, 1), Err(StepError::Step { .. })));
    assert!(lbm.advance(dt, 1).is_ok());
}

#[test]
fn a_plain_fluid_takes_72_bytes_a_cell_and_half_of_it_in_single_precision() {
    let mut with_ghosts = setup();
    with_ghosts.operator = Operator::EXACT_WALLS;
    let memory = Lbm2::new(with_ghosts).unwrap().memory();
    // Nine numbers, and the ring and padding around 20 000 cells.
    assert!((72..=84).contains(&memory.bytes_per_item), "{}", memory.bytes_per_item);
    assert_eq!(memory.left_out.len(), 6, "{:?}", memory.left_out);
    let mut large = setup();
    large.cells = [1000, 1000, 1];
    large.operator = Operator::SingleRelaxation;
    let double = Lbm2::new(large.clone()).unwrap().memory();
    assert!((72..=74).contains(&double.bytes_per_item), "{}", double.bytes_per_item);
    assert_eq!(double.left_out.len(), 7, "{:?}", double.left_out);
    let single = Lbm::<D2Q9, 9, f32>::new(large).unwrap().memory();
    assert!((36..=38).contains(&single.bytes_per_item), "{}", single.bytes_per_item);
}

#[test]
fn speeds_of_walls_faces_and_obstacles_count_for_the_mach_number() {
    let mach = |change: fn(&mut Setup<granular_core::D2>)| {
        let mut setup = setup();
        setup.faces[1] = [Face::REST, Face::REST];
        change(&mut setup);
        let speed = setup.lattice_speed();
        let mut limits = Limits::default();
        Lbm2::new(setup).unwrap().limits(&mut limits);
        let bound = limits.bounds.iter().find(|bound| bound.name == "Mach number").unwrap();
        assert!(limits.bounds.iter().all(|bound| !bound.why.contains("inf")), "{limits:?}");
        (bound.value * speed / 3.0_f64.sqrt(), bound.holds())
    };
    assert_eq!(mach(|_| {}).0, 0.0);
    let (speed, holds) = mach(|s| s.faces[1][1] = Face::Wall(DVec2::new(0.004, 0.0)));
    assert!((speed - 0.004).abs() < 1e-15 && holds);
    let (speed, holds) = mach(|s| {
        let stream = Profile::uniform(DVec2::new(0.03, 0.0));
        s.faces[0] = [Face::Velocity(stream, OpenScheme::ZouHe), Face::Pressure(0.0, OpenScheme::ZouHe)];
    });
    assert!((speed - 0.03).abs() < 1e-15 && !holds);
}

/// Shear layers at a grid Reynolds number far beyond what one relaxation time bears.
fn shear_layers(operator: Operator, smagorinsky: Option<f64>) -> Lbm2 {
    let mut setup = Setup::new([64, 64, 1], 1.0, 1.0, 0.5 + 1e-4);
    setup.operator = operator;
    setup.smagorinsky = smagorinsky;
    let speed = 0.15 * setup.lattice_speed();
    let mut lbm = Lbm2::new(setup).unwrap();
    lbm.set_flow(|p| {
        let across = if p.y < 32.0 { (p.y - 16.0).tanh() } else { (48.0 - p.y).tanh() };
        let kick = 0.05 * (std::f64::consts::TAU * (p.x / 64.0 + 0.25)).sin();
        Flow { pressure: 0.0, velocity: DVec2::new(speed * across, speed * kick) }
    });
    lbm
}

#[test]
fn a_blow_up_is_named_within_ten_steps_and_the_closure_prevents_it() {
    let mut lbm = shear_layers(Operator::SingleRelaxation, None);
    let dt = lbm.setup().time_step;
    let mut sane = Vec::new();
    let error = loop {
        let largest =
            lbm.velocities().iter().map(|v| v.length()).fold(0.0, f64::max) / lbm.setup().lattice_speed();
        sane.push(largest.is_finite() && largest < 1.0);
        assert!(sane.len() < 20_000, "one relaxation time bears it");
        if let Err(error) = lbm.advance(dt, 1) {
            break error;
        }
    };
    let first_insane = sane.iter().position(|sane| !sane).unwrap_or(sane.len());
    assert!(sane.len() - first_insane <= 10, "noticed {} steps late", sane.len() - first_insane);
    assert!(matches!(error, StepError::TooStiff { .. } | StepError::NotFinite { .. }), "{error}");
    let mut closed = shear_layers(Operator::EXACT_WALLS, Some(0.15));
    closed.advance(dt, 20_000).unwrap();
}
