//! Fields derived from the velocity, against closed forms.

use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, FieldRef, FieldSink, Solver};
use granular_lbm::*;
use std::f64::consts::TAU;

/// Vortices of Taylor and Green in a periodic square of a metre: `psi = A sin(k x) sin(k y)`.
fn vortices(side: usize) -> Lbm2 {
    let setup = Setup::<D2>::new([side, side, 1], 1.0 / side as f64, 1e-3, 0.6);
    let mut lbm = Lbm2::new(setup).unwrap();
    lbm.set_flow(|p| {
        let (x, y) = (TAU * p.x, TAU * p.y);
        let velocity = DVec2::new(x.sin() * y.cos(), -x.cos() * y.sin()) * (AMPLITUDE * TAU);
        Flow { pressure: 0.0, velocity }
    });
    lbm
}

const AMPLITUDE: f64 = 1e-4;

/// What central differences make of a derivative of a wave of one period in `side` cells.
fn damped(side: usize) -> f64 {
    let angle = TAU / side as f64;
    angle.sin() / angle
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest, value| largest.max(value.abs()))
}

fn cells(side: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..side * side).map(move |i| [i % side, i / side, 0])
}

#[test]
fn vortices_have_the_stream_function_they_come_from_to_second_order() {
    let error = |side: usize| {
        let lbm = vortices(side);
        let psi = |p: DVec2| AMPLITUDE * (TAU * p.x).sin() * (TAU * p.y).sin();
        let first = psi(lbm.centre([0; 3]));
        let found = lbm.stream_function().unwrap();
        largest(found.iter().zip(cells(side)).map(|(value, cell)| value + first - psi(lbm.centre(cell))))
            / AMPLITUDE
    };
    let (coarse, fine) = (error(32), error(64));
    assert!(coarse < 1e-2 && (coarse / fine - 4.0).abs() < 0.1, "{coarse:e}, {fine:e}");
}

#[test]
fn vortices_have_the_q_and_the_divergence_of_central_differences() {
    let lbm = vortices(32);
    let q = lbm.q_criterion();
    let scale = (AMPLITUDE * TAU * TAU * damped(32)).powi(2);
    let expected = |p: DVec2| {
        let (x, y) = (TAU * p.x, TAU * p.y);
        (x.sin() * y.sin()).powi(2) - (x.cos() * y.cos()).powi(2)
    };
    let error = largest(q.iter().zip(cells(32)).map(|(q, cell)| q / scale - expected(lbm.centre(cell))));
    let divergence = largest(lbm.divergence().into_iter()) / scale.sqrt();
    assert!(error < 1e-9 && divergence < 1e-9, "{error:e}, {divergence:e}");
    let vorticity: f64 = lbm.vorticity().iter().map(|w| w * w).sum();
    assert!(vorticity > 0.0 && q.iter().sum::<f64>().abs() < 1e-9 * vorticity);
}

/// The flow of Arnold, Beltrami and Childress in a periodic cube.
#[test]
fn a_flow_in_space_has_the_q_of_central_differences_and_no_stream_function() {
    let side = 12;
    let setup = Setup::<D3>::new([side; 3], 1.0 / side as f64, 1e-3, 0.6);
    let mut lbm = Lbm3::new(setup).unwrap();
    let [a, b, c] = [1e-4, 2e-4, 3e-4];
    lbm.set_flow(|p| {
        let ([sx, sy, sz], [cx, cy, cz]) = waves(p);
        let velocity = DVec3::new(a * sz + c * cy, b * sx + a * cz, c * sy + b * cx);
        Flow { pressure: 0.0, velocity }
    });
    let scale = (TAU * damped(side)).powi(2);
    let found = lbm.q_criterion();
    let error = largest(found.iter().enumerate().map(|(i, q)| {
        let ([sx, sy, sz], [cx, cy, cz]) = waves(lbm.centre([i % side, i / side % side, i / (side * side)]));
        let expected = c * sy * b * cx + a * cz * b * sx + a * sz * c * cy;
        (q / scale - expected) / (b * c)
    }));
    assert!(error < 1e-8, "{error:e}");
    assert!(lbm.stream_function().is_none());
    assert!(lbm.shown().iter().all(|shown| shown.name != "stream_function"));
}

fn waves(p: DVec3) -> ([f64; 3], [f64; 3]) {
    let angles = (p * TAU).to_array();
    (angles.map(f64::sin), angles.map(f64::cos))
}

/// In a channel past a block: departures of the stream function inside the block from half, and in the highest row from
/// all of the flow rate, over that.
fn past_a_block(fine: usize) -> [f64; 2] {
    let (width, height) = (48 * fine, 24 * fine);
    let mut setup = Setup::<D2>::new([width, height, 1], 1.0 / fine as f64, 1.0, 0.8);
    setup.faces[1] = [Face::REST, Face::REST];
    setup.acceleration = DVec2::new(1e-4, 0.0);
    let block = Block { low: DVec2::new(20.0, 8.0), high: DVec2::new(28.0, 16.0) };
    setup.obstacles.push(Obstacle::new("block", block));
    let mut lbm = Lbm2::new(setup).unwrap();
    let dt = lbm.setup().time_step;
    lbm.advance(dt, 5000 * (fine * fine) as u64).unwrap();
    let psi = lbm.stream_function().unwrap();
    let at = |x: usize, y: usize| psi[y * width + x];
    let rate = at(0, height - 1);
    assert!(rate > 0.0);
    let inside = (20 * fine..28 * fine).flat_map(|x| (8 * fine..16 * fine).map(move |y| (x, y)));
    [
        largest(inside.map(|(x, y)| at(x, y) / rate - 0.5)),
        largest((0..width).map(|x| at(x, height - 1) / rate - 1.0)),
    ]
}

#[test]
fn the_stream_function_goes_on_through_an_obstacle() {
    let (coarse, fine) = (past_a_block(1), past_a_block(2));
    // Corners of the block leave less than second order.
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(*coarse < 0.03 && fine < 0.5 * coarse, "{coarse:e}, {fine:e}");
    }
}

/// Wants one field and keeps it.
struct One(&'static str, Vec<f64>, usize);

impl FieldSink for One {
    fn wants(&self, name: &str) -> bool {
        name == self.0
    }

    fn field(&mut self, _: &str, _: &str, values: FieldRef<'_>) {
        self.2 += 1;
        if let FieldRef::Scalar(values) = values {
            self.1 = values.to_vec();
        }
    }

    fn number(&mut self, _: &str, _: &str, _: f64) {
        self.2 += 1;
    }
}

#[test]
fn each_field_is_shown_when_it_alone_is_wanted() {
    let lbm = vortices(16);
    let fields = [
        ("q_criterion", lbm.q_criterion()),
        ("divergence", lbm.divergence()),
        ("stream_function", lbm.stream_function().unwrap()),
    ];
    for (name, expected) in fields {
        let mut one = One(name, Vec::new(), 0);
        lbm.show(&mut one);
        assert_eq!((one.1, one.2), (expected, 1), "{name}");
        assert!(lbm.shown().iter().any(|shown| shown.name == name));
    }
}
