//! Flow between parallel plates.

use granular_core::{Dim, Solver, Vector};
use granular_lbm::*;

const HEIGHT: usize = 9;
/// So small that the square of the Mach number is round-off.
const ACCELERATION: f64 = 1e-6;

fn operators() -> Vec<(&'static str, Operator)> {
    vec![
        ("single", Operator::SingleRelaxation),
        ("two", Operator::TwoRelaxation { magic: 0.25 }),
        ("exact", Operator::EXACT_WALLS),
        ("kumar", Operator::KUMAR),
        ("regularised", Operator::Regularised),
    ]
}

/// A channel along x with plates across `axis`, driven by a body force, at rest.
fn channel<L: Lattice<Q>, const Q: usize>(operator: Operator, tau: f64, across: usize) -> Lbm<L, Q> {
    let mut cells = [3, 3, if L::Dim::N == 3 { 3 } else { 1 }];
    cells[across] = HEIGHT;
    let mut setup = Setup::<L::Dim>::new(cells, 1.0, 1.0, tau);
    setup.operator = operator;
    setup.faces[across] = [Face::REST, Face::REST];
    setup.time_step = (tau - 0.5) / 3.0;
    setup.acceleration = Vector::along(0, ACCELERATION);
    Lbm::new(setup).unwrap()
}

/// Largest difference from the parabola with the slip of `Lambda`, over the largest speed.
fn error_of_steady<L: Lattice<Q>, const Q: usize>(operator: Operator, tau: f64, across: usize) -> f64 {
    let mut lbm = channel::<L, Q>(operator, tau, across);
    let h = HEIGHT as f64;
    let dt = lbm.setup().time_step;
    lbm.advance(dt, (12.0 * h * h / dt) as u64).unwrap();
    let peak = ACCELERATION * h * h / 8.0;
    let slip = (16.0 * operator.magic(tau) - 3.0) / (3.0 * h * h);
    let speed = |k: usize| {
        let y = (k as f64 + 0.5) / h;
        peak * (4.0 * y * (1.0 - y) + slip)
    };
    (0..HEIGHT)
        .map(|k| {
            let mut cell = [1, 1, 0];
            cell[across] = k;
            (lbm.flow(cell).unwrap().velocity.component(0) - speed(k)).abs() / peak
        })
        .fold(0.0, f64::max)
}

#[test]
fn slip_follows_from_lambda_for_every_operator() {
    for (name, operator) in operators() {
        for tau in [0.6, 0.933, 1.7] {
            let plane = error_of_steady::<D2Q9, 9>(operator, tau, 1);
            let space = error_of_steady::<D3Q19, 19>(operator, tau, 2);
            println!("{name} tau {tau}: {plane:.2e} {space:.2e}");
            assert!(plane < 1e-10 && space < 1e-10, "{name} at tau {tau}: {plane:e}, {space:e}");
        }
    }
}

/// Between open faces at given pressures the parabola is exact too, at `Lambda = 3/16`. A sudden start leaves a
/// momentum that changes sign from cell to cell and from step to step, which nothing in the linear scheme damps (a
/// staggered invariant): the mean over two steps is free of it.
#[test]
fn pressure_drives_the_same_parabola() {
    for tau in [0.6, 0.9, 1.7] {
        let h = HEIGHT as f64;
        let mut setup = Setup::new([40, HEIGHT, 1], 1.0, 1.0, tau);
        setup.operator = Operator::TwoRelaxation { magic: 3.0 / 16.0 };
        let drop = 1e-8 * setup.density * setup.lattice_speed().powi(2);
        setup.faces[0] = [Face::Pressure(drop, OpenScheme::ZouHe), Face::Pressure(0.0, OpenScheme::ZouHe)];
        setup.faces[1] = [Face::REST, Face::REST];
        let peak = drop / 39.0 * h * h / (8.0 * setup.density * setup.viscosity);
        let mut lbm = Lbm2::new(setup).unwrap();
        let dt = lbm.setup().time_step;
        lbm.advance(dt, 100_000).unwrap();
        let mut later = Lbm2::new(lbm.setup().clone()).unwrap();
        later.advance(dt, 100_001).unwrap();
        // The corners of the open faces disturb the cells near them and take some of the pressure: what is left
        // drives the middle.
        let pressure = |x: usize| lbm.flow([x, 4, 0]).unwrap().pressure;
        let share = (pressure(15) - pressure(25)) / (10.0 * drop / 39.0);
        assert!((share - 1.0).abs() < 5e-4, "tau {tau}: {share}");
        for (x, k) in (15..25).flat_map(|x| (0..HEIGHT).map(move |k| (x, k))) {
            let y = (k as f64 + 0.5) / h;
            let speed = |lbm: &Lbm2| lbm.flow([x, k, 0]).unwrap().velocity.x / peak;
            let (one, two) = (speed(&lbm), speed(&later));
            let expected = share * 4.0 * y * (1.0 - y);
            assert!(
                (0.5 * (one + two) - expected).abs() < 1e-5,
                "tau {tau}, cell {x} {k}: {one}, {two}, {expected}"
            );
            let staggered = 4.0 * (tau - 0.5) / (h * h);
            assert!((0.5 * (one - two).abs() - staggered).abs() < 1e-4, "tau {tau}: {one} {two} {staggered}");
        }
    }
}
