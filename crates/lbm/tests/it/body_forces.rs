//! Body forces that vary in space and time.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, Dim, Solver, Vector};
use granular_lbm::*;
use std::f64::consts::TAU;

fn operators() -> Vec<Operator> {
    vec![
        Operator::SingleRelaxation,
        Operator::TwoRelaxation { magic: 0.25 },
        Operator::EXACT_WALLS,
        Operator::Regularised,
    ]
}

const PERIOD: usize = 16;
/// So small that the square of the Mach number is round-off.
const SMALL: f64 = 1e-8;

/// Largest difference from `U sin(k y)` over U, with the amplitude of the scheme itself.
///
/// With `f(1,1) - f(-1,1) = G` above and below a row, `A` their sum (odd) and `B` their difference (even), the steady scheme is
/// `(A + B) z = A + F + (1 - w) B` and `(A - B) / z = A + F - (1 - w) B`, `z = exp(i k)`, with `u = 3 A + 2 F tau_odd + F / 2`:
/// `U = (F / nu) (1 / (2 - 2 cos k) + 2 Lambda / 3 - 1 / 4)`, which is `F / (nu k^2)` to second order.
fn error_of_kolmogorov<L: Lattice<Q>, const Q: usize>(operator: Operator, tau: f64, across: usize) -> f64 {
    let mut cells = [3, 3, if L::Dim::N == 3 { 3 } else { 1 }];
    cells[across] = PERIOD;
    let k = TAU / PERIOD as f64;
    let mut setup = Setup::<L::Dim>::new(cells, 1.0, 1.0, tau);
    setup.operator = operator;
    let dt = setup.time_step;
    setup.body_force = Some(BodyForce::in_space(move |point: <L::Dim as Dim>::Vec| {
        Vector::along(0, SMALL * (k * point.component(across)).sin())
    }));
    let mut lbm = Lbm::<L, Q>::new(setup).unwrap();
    lbm.advance(dt, (30.0 / (k * k * dt)) as u64).unwrap();
    let scheme = 1.0 / (2.0 - 2.0 * k.cos()) + 2.0 * operator.magic(tau) / 3.0 - 0.25;
    assert!((scheme * k * k - 1.0).abs() < 0.2, "{scheme}");
    (0..PERIOD)
        .map(|at| {
            let mut cell = [1, 1, 0];
            cell[across] = at;
            let expected = SMALL * scheme * (k * (at as f64 + 0.5)).sin();
            (lbm.flow(cell).unwrap().velocity.component(0) - expected).abs() / (SMALL * scheme)
        })
        .fold(0.0, f64::max)
}

#[test]
fn kolmogorov_flow_has_the_amplitude_of_the_scheme_for_every_operator() {
    for operator in operators() {
        for tau in [0.6, 1.1] {
            let plane = error_of_kolmogorov::<D2Q9, 9>(operator, tau, 1);
            let space = error_of_kolmogorov::<D3Q19, 19>(operator, tau, 2);
            assert!(plane < 1e-9 && space < 1e-9, "{operator:?} at {tau}: {plane:e}, {space:e}");
        }
    }
}

/// Largest error over the largest speed of the flow under `F sin(k y) cos(w t)`, which is
/// `Re F exp(i w t) / (i w + nu k^2) sin(k y)` from a start that is that too.
fn error_of_oscillation(cells: usize) -> f64 {
    let (k, height) = (TAU, 1.0);
    let mut setup = Setup::<D2>::new([2, cells, 1], height / cells as f64, 1.0, 0.8);
    let (rate, damping, viscosity) = (40.0, k * k, setup.viscosity);
    assert_eq!(viscosity, 1.0);
    let amplitude = move |time: f64| {
        let (sine, cosine) = (rate * time).sin_cos();
        SMALL * (damping * cosine + rate * sine) / (rate * rate + damping * damping)
    };
    let shape = move |point: DVec2| DVec2::new((k * point.y).sin(), 0.0);
    setup.body_force =
        Some(BodyForce::in_space_times(move |point| SMALL * shape(point), move |time| (rate * time).cos()));
    let dt = setup.time_step;
    let mut lbm = Lbm2::new(setup).unwrap();
    lbm.set_flow(|point| Flow { pressure: 0.0, velocity: amplitude(0.0) * shape(point) });
    let mut worst = 0.0_f64;
    for k in 1..=20 {
        let steps = (0.5 * TAU / rate / dt / 20.0).round() as u64;
        lbm.advance(dt, steps).unwrap();
        let time = (k * steps) as f64 * dt;
        for y in 0..cells {
            let expected = amplitude(time) * shape(lbm.centre([0, y, 0])).x;
            worst = worst.max((lbm.flow([0, y, 0]).unwrap().velocity.x - expected).abs());
        }
    }
    worst / (SMALL / (rate * rate + damping * damping).sqrt())
}

#[test]
fn a_force_that_oscillates_meets_the_closed_form_to_second_order() {
    let errors = [16, 32, 64].map(error_of_oscillation);
    println!("{errors:?}");
    assert!(errors[1] < 0.01, "{errors:?}");
    assert!((errors[0] / errors[1]).log2() > 1.8 && (errors[1] / errors[2]).log2() > 1.8, "{errors:?}");
}

/// Largest error over the largest speed between plates under a force that oscillates [Womersley].
fn error_of_womersley(cells: usize) -> f64 {
    let mut setup = Setup::<D2>::new([2, cells, 1], 1.0 / cells as f64, 1.0, 0.9);
    setup.faces[1] = [Face::REST, Face::REST];
    let rate = 30.0;
    setup.body_force = Some(BodyForce::in_time(move |time| DVec2::new(SMALL * (rate * time).cos(), 0.0)));
    let dt = setup.time_step;
    let mut lbm = Lbm2::new(setup).unwrap();
    // The series of the closed form in sines, which needs no complex numbers.
    let expected = move |y: f64, time: f64| {
        let (sine, cosine) = (rate * time).sin_cos();
        let term = |n: usize| {
            let k = (2 * n + 1) as f64 * 0.5 * TAU;
            let share = (k * k * cosine + rate * sine) / (k.powi(4) + rate * rate);
            4.0 / k * (k * y).sin() * share
        };
        SMALL * (0..400).map(term).sum::<f64>()
    };
    // Long enough to forget the start: exp(-pi^2 2.5).
    let settle = (2.5 / dt).round() as u64;
    lbm.advance(dt, settle).unwrap();
    let (mut worst, mut largest, mut steps) = (0.0_f64, 0.0_f64, settle);
    for _ in 0..8 {
        let more = (TAU / rate / 8.0 / dt).round() as u64;
        lbm.advance(dt, more).unwrap();
        steps += more;
        for y in 0..cells {
            let expected = expected(lbm.centre([0, y, 0]).y, steps as f64 * dt);
            largest = largest.max(expected.abs());
            worst = worst.max((lbm.flow([0, y, 0]).unwrap().velocity.x - expected).abs());
        }
    }
    worst / largest
}

#[test]
fn an_oscillating_force_between_plates_meets_womersley_to_second_order() {
    let errors = [16, 32, 64].map(error_of_womersley);
    println!("{errors:?}");
    assert!(errors[1] < 0.01, "{errors:?}");
    assert!((errors[0] / errors[1]).log2() > 1.8 && (errors[1] / errors[2]).log2() > 1.8, "{errors:?}");
}

/// A cavity under a lid that is at rest in its corners: `u = 8 f g'`, `v = -8 f' g` with `f = x^4 - 2 x^3 + x^2` and
/// `g = y^4 - y^2` is a flow at constant pressure under the force that the equations leave.
#[test]
fn a_lid_with_a_profile_and_a_force_in_space_make_a_known_flow_to_second_order() {
    let f = |x: f64| {
        [
            x.powi(4) - 2.0 * x.powi(3) + x * x,
            4.0 * x.powi(3) - 6.0 * x * x + 2.0 * x,
            12.0 * x * x - 12.0 * x + 2.0,
            24.0 * x - 12.0,
        ]
    };
    let g = |y: f64| [y.powi(4) - y * y, 4.0 * y.powi(3) - 2.0 * y, 12.0 * y * y - 2.0, 24.0 * y];
    let flow = move |p: DVec2| {
        let (f, g) = (f(p.x), g(p.y));
        8.0 * DVec2::new(f[0] * g[1], -f[1] * g[0])
    };
    let viscosity = 0.1;
    let force = move |p: DVec2| {
        let (velocity, f, g) = (flow(p), f(p.x), g(p.y));
        let along_x = 8.0 * DVec2::new(f[1] * g[1], -f[2] * g[0]);
        let along_y = 8.0 * DVec2::new(f[0] * g[2], -f[1] * g[1]);
        let curved = 8.0 * DVec2::new(f[2] * g[1] + f[0] * g[3], -(f[3] * g[0] + f[1] * g[2]));
        velocity.x * along_x + velocity.y * along_y - viscosity * curved
    };
    let error = |cells: usize| {
        let mut setup = Setup::<D2>::new([cells, cells, 1], 1.0 / cells as f64, viscosity, 0.7);
        setup.faces[0] = [Face::REST, Face::REST];
        setup.faces[1] =
            [Face::REST, Face::WallProfile(Profile::new(move |p: DVec2| DVec2::new(16.0 * f(p.x)[0], 0.0)))];
        setup.body_force = Some(BodyForce::in_space(force));
        let dt = setup.time_step;
        let mut lbm = Lbm2::new(setup).unwrap();
        assert!((lbm.largest_expected_speed() - 1.0).abs() < 1e-12);
        lbm.advance(dt, (6.0 / dt) as u64).unwrap();
        let field = lbm.flow_field();
        let cell = |k: usize| [k % cells, k / cells, 0];
        let squared = field.velocities.iter().enumerate();
        let squared = squared.map(|(k, u)| (*u - flow(lbm.centre(cell(k)))).length_squared());
        (squared.sum::<f64>() / (cells * cells) as f64).sqrt()
    };
    let errors = [16, 32, 64].map(error);
    println!("{errors:?}");
    assert!(errors[2] < 1e-3, "{errors:?}");
    assert!((errors[0] / errors[1]).log2() > 1.8 && (errors[1] / errors[2]).log2() > 1.8, "{errors:?}");
}

#[test]
fn any_function_is_the_product_that_it_equals_also_beside_open_faces() {
    let after = |force: BodyForce<granular_core::D3>| {
        let mut setup = Setup::new([9, 8, 7], 1e-3, 1e-6, 0.7);
        setup.faces[0] = [Face::Pressure(0.0, OpenScheme::Regularised), Face::absorbing(0.0)];
        setup.faces[1] = [Face::REST, Face::Pressure(0.0, OpenScheme::ZouHe)];
        setup.body_force = Some(force);
        let dt = setup.time_step;
        let mut lbm = Lbm3::new(setup).unwrap();
        lbm.advance(dt, 60).unwrap();
        lbm.flow_field()
    };
    let shape = |p: DVec3| 1e-3 * DVec3::new((700.0 * p.y).sin(), 0.3, (500.0 * p.x).cos());
    let factor = |time: f64| (20.0 * time).cos();
    let product = after(BodyForce::in_space_times(shape, factor));
    let any = after(BodyForce::everywhere(move |p, time| shape(p) * factor(time)));
    let largest = product.velocities.iter().map(|u| u.length()).fold(0.0, f64::max);
    assert!(largest > 1e-5, "{largest}");
    for (a, b) in product.velocities.iter().zip(&any.velocities) {
        assert!((*a - *b).length() < 1e-10 * largest, "{a} {b}");
    }
}

#[test]
fn a_constant_force_in_space_is_the_acceleration() {
    let after = |set: &dyn Fn(&mut Setup<D2>)| {
        let mut setup = Setup::<D2>::new([12, 20, 1], 1e-3, 1e-6, 0.6);
        setup.faces[1] = [Face::REST, Face::FreeSlip];
        setup.smagorinsky = Some(0.1);
        set(&mut setup);
        let dt = setup.time_step;
        let mut lbm = Lbm2::new(setup).unwrap();
        lbm.advance(dt, 301).unwrap();
        lbm.flow_field()
    };
    let constant = DVec2::new(1e-3, 2e-4);
    let expected = after(&|setup| setup.acceleration = constant);
    for force in [BodyForce::in_space(move |_| constant), BodyForce::in_time(move |_| constant)] {
        assert!(after(&|setup| setup.body_force = Some(force.clone())) == expected, "{force:?}");
    }
    let halves = after(&|setup| {
        setup.acceleration = 0.5 * constant;
        setup.body_force = Some(BodyForce::everywhere(move |_, _| 0.5 * constant));
    });
    assert!(halves == expected);
}

#[test]
fn a_force_that_is_not_finite_is_refused_where_there_is_fluid_only() {
    let pole = |covered: bool| {
        let mut setup = Setup::<D2>::new([9, 9, 1], 1.0, 1.0, 0.8);
        let centre = DVec2::splat(4.5);
        setup.body_force =
            Some(BodyForce::in_space(move |p: DVec2| (p - centre) / (p - centre).length_squared()));
        if covered {
            setup.obstacles.push(Obstacle::new("pole", Ball { centre, radius: 1.5 }));
        }
        Lbm2::new(setup).err()
    };
    let error = pole(false).unwrap();
    assert!(error.what == "body force" && error.value.contains("4.5"), "{error}");
    assert_eq!(pole(true), None);
}

#[test]
fn only_a_force_that_varies_in_space_takes_memory() {
    let bytes = |force: Option<BodyForce<D2>>| {
        let mut setup = Setup::<D2>::new([60, 50, 1], 1.0, 1.0, 0.8);
        setup.body_force = force;
        Lbm2::new(setup).unwrap().memory().bytes
    };
    let none = bytes(None);
    assert_eq!(bytes(Some(BodyForce::in_time(|time| DVec2::new(1e-9 * time, 0.0)))), none);
    let field = bytes(Some(BodyForce::in_space(|point| 1e-9 * point))) - none;
    let least = 2 * 8 * 60 * 50;
    assert!((least..2 * least).contains(&field), "{field} bytes");
}
