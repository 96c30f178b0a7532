//! Walls along which the fluid slips, or whose velocity varies; walls around the fluid; motion by name.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Dim, Section, Solver, Vector};
use granular_lbm::*;

const HEIGHT: usize = 9;
const ACCELERATION: f64 = 1e-7;

fn operators() -> Vec<Operator> {
    vec![
        Operator::SingleRelaxation,
        Operator::TwoRelaxation { magic: 0.25 },
        Operator::EXACT_WALLS,
        Operator::KUMAR,
        Operator::Regularised,
    ]
}

/// Largest error over the largest speed of a steady flow between faces, driven along x.
fn error_of_steady<L: Lattice<Q>, const Q: usize>(
    (operator, tau, across): (Operator, f64, usize),
    faces: [Face<L::Dim>; 2],
    acceleration: f64,
    speed: impl Fn(f64) -> f64,
) -> f64 {
    let mut cells = [3, 3, if L::Dim::N == 3 { 3 } else { 1 }];
    cells[across] = HEIGHT;
    let mut setup = Setup::<L::Dim>::new(cells, 1.0, 1.0, tau);
    setup.operator = operator;
    setup.faces[across] = faces;
    setup.acceleration = Vector::along(0, acceleration);
    let dt = setup.time_step;
    let mut lbm = Lbm::<L, Q>::new(setup).unwrap();
    let h = HEIGHT as f64;
    lbm.advance(dt, (60.0 * h * h / dt) as u64).unwrap();
    let found = |at: usize| {
        let mut cell = [1, 1, 0];
        cell[across] = at;
        lbm.flow(cell).unwrap().velocity.component(0)
    };
    let rows = || (0..HEIGHT).map(|at| (found(at), speed(at as f64 + 0.5)));
    let largest = rows().map(|(_, expected)| expected.abs()).fold(0.0, f64::max);
    rows().map(|(found, expected)| (found - expected).abs() / largest).fold(0.0, f64::max)
}

/// Between walls of slip lengths `a` below and `b` above.
fn errors_of_slip<L: Lattice<Q>, const Q: usize>(operator: Operator, tau: f64, across: usize) -> [f64; 2] {
    let (h, a, b) = (HEIGHT as f64, 0.7, 2.3);
    let case = (operator, tau, across);
    // u = F / 2 (a h c + c y - y^2), from u = a u' below and u = -b u' above: c = h (h + 2 b) / (h + a + b).
    let c = h * (h + 2.0 * b) / (h + a + b);
    let beside = ACCELERATION * (16.0 * operator.magic(tau) - 3.0) / 24.0;
    let poiseuille =
        error_of_steady::<L, Q>(case, [Face::slipping(a), Face::slipping(b)], ACCELERATION, |y| {
            0.5 * ACCELERATION * (a * c + c * y - y * y) + beside
        });
    let speed = 1e-6;
    let moving = Face::NavierSlip { length: b, velocity: Vector::along(0, speed) };
    let couette =
        error_of_steady::<L, Q>(case, [Face::slipping(a), moving], 0.0, |y| speed * (y + a) / (h + a + b));
    [poiseuille, couette]
}

#[test]
fn slip_lengths_are_exact_for_every_operator() {
    for operator in operators() {
        for tau in [0.6, 0.933, 1.7] {
            let plane = errors_of_slip::<D2Q9, 9>(operator, tau, 1);
            let space = errors_of_slip::<D3Q19, 19>(operator, tau, 2);
            let worst = plane.into_iter().chain(space).fold(0.0, f64::max);
            assert!(worst < 1e-9, "{operator:?} at {tau}: {plane:?} {space:?}");
        }
    }
}

#[test]
fn no_slip_length_is_a_wall() {
    let after = |face: Face<D2>| {
        let mut setup = Setup::<D2>::new([20, 15, 1], 1e-3, 1e-6, 0.7);
        setup.faces[0] = [Face::REST, Face::REST];
        setup.faces[1] = [face, Face::Wall(DVec2::new(1e-3, 0.0))];
        let dt = setup.time_step;
        let mut lbm = Lbm2::new(setup).unwrap();
        lbm.advance(dt, 100).unwrap();
        lbm.flow_field()
    };
    assert!(after(Face::slipping(0.0)) == after(Face::REST));
    let free = after(Face::FreeSlip);
    let nearly = after(Face::slipping(1e6));
    for (a, b) in free.velocities.iter().zip(&nearly.velocities) {
        assert!((*a - *b).length() < 1e-7, "{a} {b}");
    }
}

#[test]
fn a_profile_that_does_not_vary_is_a_moving_wall_also_in_space() {
    let lid = DVec3::new(1e-3, 4e-4, 0.0);
    let after = |face: Face<D3>| {
        let mut setup = Setup::<D3>::new([8, 7, 9], 1e-3, 1e-6, 0.7);
        setup.faces[0] = [Face::REST, Face::REST];
        setup.faces[1] = [Face::REST, Face::FreeSlip];
        setup.faces[2] = [Face::REST, face];
        let dt = setup.time_step;
        let mut lbm = Lbm3::new(setup).unwrap();
        lbm.advance(dt, 60).unwrap();
        lbm.flow_field()
    };
    assert!(after(Face::WallProfile(Profile::uniform(lid))) == after(Face::Wall(lid)));
}

#[test]
fn walls_that_make_no_sense_are_refused() {
    let refused = |face: Face<D2>| {
        let mut setup = Setup::<D2>::new([8, 8, 1], 1.0, 1.0, 0.8);
        setup.faces[1] = [Face::REST, face];
        Lbm2::new(setup).unwrap_err()
    };
    for length in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(Face::slipping(length)).what, "slip length of a face");
    }
    let out = refused(Face::NavierSlip { length: 1.0, velocity: DVec2::new(0.0, 1.0) });
    assert_eq!(out.what, "velocity of a wall");
    let leaks = Profile::new(|p: DVec2| DVec2::new(1.0, if p.x > 6.9 { 1e-9 } else { 0.0 }));
    let error = refused(Face::WallProfile(leaks));
    assert!(error.what == "velocity of a wall" && error.value.contains("(7.0, 8.0)"), "{error}");
    let hole = Profile::new(|p: DVec2| DVec2::new(1.0 / (p.x - 4.0), 0.0));
    assert_eq!(refused(Face::WallProfile(hole)).what, "velocity of a wall");
}

/// Relative errors of the velocity (root of the mean square) and of both torques between cylinders, of which the one
/// at `turning` turns.
fn errors_of_annulus(cells: usize, wall: WallScheme, turning: usize) -> [f64; 3] {
    let (inner, outer) = (0.21, 0.46);
    let centre = DVec2::new(0.503, 0.498);
    let mut setup = Setup::<D2>::new([cells, cells, 1], 1.0 / cells as f64, 0.1, 0.8);
    setup.obstacles.push(Obstacle::new("shaft", Ball { centre, radius: inner }));
    setup.obstacles.push(Obstacle::new("tank", Hole(Ball { centre, radius: outer })));
    let rate = 0.01 / [inner, outer][turning];
    setup.obstacles[turning].spin = rate;
    setup.obstacles.iter_mut().for_each(|body| body.wall = wall);
    let (dt, density, viscosity) = (setup.time_step, setup.density, setup.viscosity);
    let mut lbm = Lbm2::new(setup).unwrap();
    // What is left of the start decays as exp(-15.8 t).
    lbm.advance(dt, (0.8 / dt) as u64).unwrap();
    // u = a r + b / r.
    let [a, b] = match turning {
        0 => [-rate * inner * inner, rate * (inner * outer).powi(2)],
        _ => [rate * outer * outer, -rate * (inner * outer).powi(2)],
    }
    .map(|number| number / (outer * outer - inner * inner));
    let (mut squared, mut count) = (0.0, 0);
    for k in 0..cells * cells {
        let cell = [k % cells, k / cells, 0];
        let Some(flow) = lbm.flow(cell) else { continue };
        let arm = lbm.centre(cell) - centre;
        let expected = arm.perp() * (a + b / arm.length_squared());
        squared += (flow.velocity - expected).length_squared();
        count += 1;
    }
    let torque = -4.0 * std::f64::consts::PI * density * viscosity * b;
    let errors = [0, 1].map(|body| lbm.torque_on(body) / torque * if body == 0 { 1.0 } else { -1.0 } - 1.0);
    [(squared / f64::from(count)).sqrt() / 0.01, errors[0], errors[1]]
}

#[test]
fn between_cylinders_the_flow_and_both_torques_are_known() {
    for (wall, turning) in [(WallScheme::Bouzidi, 0), (WallScheme::Bouzidi, 1), (WallScheme::Yu, 0)] {
        let [coarse, fine] = [24, 96].map(|cells| errors_of_annulus(cells, wall, turning));
        println!("{wall:?} {turning} {coarse:?} {fine:?}");
        assert!(fine[0] < 1e-3 && fine[1].abs() < 2e-3 && fine[2].abs() < 2e-3, "{fine:?}");
        // Links meet the wall elsewhere on each lattice: errors scatter about the second order.
        let order = (coarse[0] / fine[0]).log2() / 2.0;
        assert!(order > 1.5, "{order}");
    }
}

#[test]
fn a_pipe_through_periodic_faces_carries_what_poiseuille_says() {
    let (cells, radius) = (26, 11.3);
    let mut setup = Setup::<D3>::new([cells, cells, 3], 1.0, 1.0, 0.8);
    let centre = DVec2::new(13.1, 12.8);
    let pipe = Hole(Extruded { shape: Ball::<D2> { centre, radius }, from: -10.0, to: 13.0 });
    setup.obstacles.push(Obstacle::new("pipe", pipe));
    setup.acceleration = DVec3::new(0.0, 0.0, ACCELERATION);
    let dt = setup.time_step;
    let mut lbm = Lbm3::new(setup).unwrap();
    lbm.advance(dt, (1.5 * radius * radius / dt) as u64).unwrap();
    let flow_rate = |z: usize| -> f64 {
        let cells = (0..cells * cells).map(|k| [k % cells, k / cells, z]);
        cells.filter_map(|cell| lbm.flow(cell)).map(|flow| flow.velocity.z).sum()
    };
    let expected = std::f64::consts::PI * radius.powi(4) / 8.0 * ACCELERATION;
    for z in 0..3 {
        assert!((flow_rate(z) / expected - 1.0).abs() < 0.015, "{z}: {}", flow_rate(z) / expected);
    }
    // All that the body force gives, the wall takes.
    let fluid = (0..3 * cells * cells)
        .filter(|k| lbm.flow([k % cells, k / cells % cells, k / (cells * cells)]).is_some());
    let whole = fluid.count() as f64 * lbm.setup().density * ACCELERATION;
    assert!((lbm.force_on(0).z / whole - 1.0).abs() < 1e-3, "{} {whole}", lbm.force_on(0).z);
}

#[test]
fn holes_are_shapes_from_within() {
    let block = Hole(Block::<D2> { low: DVec2::ZERO, high: DVec2::splat(2.0) });
    assert!(!block.contains(DVec2::ONE) && block.contains(DVec2::new(2.5, 1.0)));
    assert_eq!(SolidShape::<D2>::centre(&block), DVec2::ONE);
    let q = block.crossing(DVec2::ONE, DVec2::new(3.0, 2.0));
    assert!((q - 0.5).abs() < 1e-12, "{q}");
    let twice = Hole(Hole(Ball::<D2> { centre: DVec2::ZERO, radius: 1.0 }));
    assert!((twice.crossing(DVec2::new(-2.0, 0.0), DVec2::ZERO) - 0.5).abs() < 1e-12);
}

fn lid_driven() -> Lbm2 {
    let mut setup = Setup::<D2>::new([16, 14, 1], 1e-3, 1e-6, 0.7);
    setup.faces[0] = [Face::REST, Face::slipping(1e-3)];
    setup.faces[1] = [Face::REST, Face::WallProfile(Profile::new(|p: DVec2| DVec2::new(0.1 * p.x, 0.0)))];
    setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::splat(7e-3), radius: 3e-3 }));
    Lbm2::new(setup).unwrap()
}

fn state(lbm: &Lbm2) -> Section {
    let mut section = Section::new("solver");
    lbm.save(&mut section);
    section
}

#[test]
fn motions_set_by_name_are_those_of_a_setup_and_are_saved() {
    let dt = lid_driven().setup().time_step;
    let mut set = lid_driven();
    set.advance(dt, 3).unwrap();
    set.set_face_velocity("top", DVec2::new(2e-3, 0.0)).unwrap();
    set.set_face_velocity("right", DVec2::new(0.0, -1e-3)).unwrap();
    let mut motion = set.obstacle_motion("disk").unwrap();
    (motion.position.x, motion.velocity.x, motion.spin) = (7.4e-3, 1e-4, 0.05);
    set.set_obstacle_motion("disk", motion).unwrap();
    assert_eq!(set.obstacle_motion("disk").unwrap(), motion);
    assert!((set.largest_expected_speed() - 2e-3).abs() < 1e-15);
    // At once after the change, and later.
    let mut restored = lid_driven();
    restored.restore(&state(&set)).unwrap();
    assert!(state(&set) == state(&restored));
    for lbm in [&mut set, &mut restored] {
        lbm.advance(dt, 20).unwrap();
    }
    assert!(state(&set) == state(&restored));
    // A snapshot from before puts the faces back.
    let mut first = lid_driven();
    first.advance(dt, 20).unwrap();
    let before = state(&lid_driven());
    restored.restore(&before).unwrap();
    assert!(state(&restored) == before);
    restored.advance(dt, 20).unwrap();
    assert!(state(&restored) == state(&first));
}

#[test]
fn a_face_set_at_the_start_is_that_of_a_setup() {
    let mut setup = lid_driven().setup().clone();
    setup.faces[1][1] = Face::Wall(DVec2::new(2e-3, 0.0));
    let dt = setup.time_step;
    let mut expected = Lbm2::new(setup).unwrap();
    let mut set = lid_driven();
    set.set_face_velocity("top", DVec2::new(2e-3, 0.0)).unwrap();
    for lbm in [&mut expected, &mut set] {
        lbm.advance(dt, 40).unwrap();
    }
    assert!(set.flow_field() == expected.flow_field());
    let mut setup = Setup::<D2>::new([12, 8, 1], 1e-3, 1e-6, 0.7);
    let inflow = |speed| Face::Velocity(Profile::uniform(DVec2::new(speed, 0.0)), OpenScheme::Regularised);
    setup.faces[0] = [inflow(1e-3), Face::Pressure(0.0, OpenScheme::Regularised)];
    let mut set = Lbm2::new(setup.clone()).unwrap();
    set.set_face_velocity("left", DVec2::new(2e-3, 0.0)).unwrap();
    setup.faces[0][0] = inflow(2e-3);
    let mut expected = Lbm2::new(setup).unwrap();
    let dt = set.setup().time_step;
    for lbm in [&mut expected, &mut set] {
        lbm.advance(dt, 40).unwrap();
    }
    assert!(set.flow_field() == expected.flow_field());
}

#[test]
fn names_and_motions_that_do_not_fit_are_refused_and_change_nothing() {
    let mut lbm = lid_driven();
    let before = state(&lbm);
    let along = DVec2::new(1e-3, 0.0);
    let what = |result: Result<(), SetupError>| result.unwrap_err();
    assert_eq!(what(lbm.set_face_velocity("lid", along)).allowed, "one of left, right, bottom, top");
    assert_eq!(what(lbm.set_face_velocity("left", along)).what, "velocity of a wall");
    assert_eq!(what(lbm.set_face_velocity("top", DVec2::new(f64::NAN, 0.0))).what, "velocity of a wall");
    assert_eq!(lbm.obstacle_motion("ball").unwrap_err().allowed, "one of `disk`");
    let mut motion = lbm.obstacle_motion("disk").unwrap();
    motion.spin = f64::NAN;
    assert_eq!(what(lbm.set_obstacle_motion("disk", motion)).what, "motion of obstacle `disk`");
    motion.spin = 1e9;
    assert_eq!(what(lbm.set_obstacle_motion("disk", motion)).what, "motion of obstacle `disk`");
    assert!(state(&lbm) == before);
    let dt = lbm.setup().time_step;
    lbm.advance(dt, 4).unwrap();
    assert_eq!(Setup::<D3>::face_named("bottom").unwrap(), (2, 0));
    let mut setup = Setup::<D2>::new([8, 8, 1], 1.0, 1.0, 0.8);
    setup.faces[1] = [Face::REST, Face::FreeSlip];
    let error = Lbm2::new(setup).unwrap().set_face_velocity("top", along).unwrap_err();
    assert_eq!(error.what, "face `top`");
}
