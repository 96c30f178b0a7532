//! What is told before the first step.

use granular_core::glam::DVec2;
use granular_core::{D2, Limits, Solver};
use granular_lbm::*;

/// A channel that a stream enters and leaves.
fn channel(outlet: Face<D2>, operator: Operator) -> Setup<D2> {
    let mut setup = Setup::<D2>::new([80, 16, 1], 1.0, 1.0, 0.55);
    setup.operator = operator;
    let speed = 0.01 * setup.lattice_speed();
    let parabola = move |p: DVec2| DVec2::new(4.0 * speed * p.y / 16.0 * (1.0 - p.y / 16.0), 0.0);
    setup.faces[0] = [Face::Velocity(Profile::new(parabola), OpenScheme::Regularised), outlet];
    setup.faces[1] = [Face::REST, Face::REST];
    setup
}

/// Time after which the pressure in the middle stays within a hundredth of its largest departure from the last one \[s\].
fn lasts(setup: Setup<D2>, steps: u64) -> f64 {
    let Face::Velocity(inlet, _) = setup.faces[0][0].clone() else { panic!("fluid enters on the left") };
    let mut lbm = Lbm2::new(setup).unwrap();
    // A stream everywhere, and too much pressure: sound, and hardly anything else.
    let (height, speed) = (1e-2, lbm.setup().lattice_speed());
    let scale = lbm.setup().density * speed * speed / 3.0;
    lbm.set_flow(|p| Flow {
        pressure: height * scale * (std::f64::consts::FRAC_PI_2 * p.x / 80.0).cos(),
        velocity: inlet.at(p),
    });
    let dt = lbm.setup().time_step;
    let mut pressures = Vec::new();
    for _ in 0..steps {
        lbm.advance(dt, 1).unwrap();
        pressures.push(lbm.flow([2, 8, 0]).unwrap().pressure / scale);
    }
    let last = pressures[steps as usize - 1];
    let gone = pressures.iter().rposition(|pressure| (pressure - last).abs() > 0.01 * height).unwrap();
    gone as f64 * dt
}

#[test]
fn sound_lasts_as_long_as_is_said() {
    for operator in [Operator::DEFAULT, Operator::EXACT_WALLS, Operator::Regularised] {
        let setup = channel(Face::Pressure(0.0, OpenScheme::Regularised), operator);
        let [said] = setup.sloshing()[..] else { panic!("one axis is open") };
        assert_eq!((said.axis, said.returned), (0, 1.0));
        let found = lasts(setup, 12_000);
        assert!((0.7..1.4).contains(&(found / said.lasts)), "{operator:?}: {found} s, {said:?}");
    }
    let setup = channel(Face::absorbing(0.0), Operator::DEFAULT);
    let [absorbed] = setup.sloshing()[..] else { panic!("one axis is open") };
    assert!(absorbed.returned < 0.2, "{absorbed:?}");
    let found = lasts(setup, 12_000);
    assert!((0.5..2.0).contains(&(found / absorbed.lasts)), "{found} s, {absorbed:?}");
}

fn told(setup: Setup<D2>) -> Vec<String> {
    let mut limits = Limits::default();
    Lbm2::new(setup).unwrap().limits(&mut limits);
    limits.advice
}

#[test]
fn a_face_that_throws_sound_back_is_told_with_what_absorbing_would_make_of_it() {
    let held = told(channel(Face::Pressure(0.0, OpenScheme::Regularised), Operator::DEFAULT));
    assert!(held[0].starts_with("sound along x: 100 %") && held[0].contains("Absorbing"), "{held:?}");
    let absorbed = told(channel(Face::absorbing(0.0), Operator::DEFAULT));
    assert!(absorbed[0].starts_with("sound along x: 16 %"), "{absorbed:?}");
    assert!(!absorbed[0].contains("Absorbing"), "{absorbed:?}");
}

#[test]
fn an_operator_is_recommended_with_the_reason() {
    let mut setup = channel(Face::absorbing(0.0), Operator::DEFAULT);
    assert!(told(setup.clone())[1].starts_with("operator TwoRelaxation(0.1875) suits"));
    // A grid Reynolds number of 40, where 11 are borne beside open faces.
    setup.viscosity *= 0.01;
    setup.expected_speed = 40.0 * setup.viscosity;
    let advice = told(setup.clone());
    assert!(
        advice[1].contains("stable up to a grid Reynolds number of 11 here, and this flow has"),
        "{advice:?}"
    );
    assert!(
        advice[1].contains("Regularised is stable up to 80") && advice[1].contains("slips"),
        "{advice:?}"
    );
    let mut free = Setup::<D2>::new([20, 20, 1], 1.0, 1.0, 0.6);
    assert!(told(free.clone())[0].contains("Kumar is more accurate in free flow"));
    free.operator = Operator::KUMAR;
    assert!(told(free)[0].starts_with("operator Kumar suits"));
    // A lid with a profile and a wall with slip are walls.
    let lid = || Face::WallProfile(Profile::new(|_: DVec2| DVec2::ZERO));
    for face in [lid, || Face::slipping(0.5)] {
        let mut bounded = Setup::<D2>::new([20, 20, 1], 1.0, 1.0, 0.6);
        bounded.faces[1] = [face(), face()];
        let advice = told(bounded);
        assert!(advice[0].starts_with("operator TwoRelaxation(0.1875) suits"), "{advice:?}");
    }
    let walls = told(channel(Face::absorbing(0.0), Operator::SingleRelaxation));
    assert!(walls[1].contains("TwoRelaxation(0.1875) is exact at flat walls"), "{walls:?}");
}
