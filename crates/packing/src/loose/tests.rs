use super::*;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3, Linear};
use proptest::prelude::*;

fn assert_apart<D: Dim>(centres: &[D::Vec], radii: &[f64]) {
    for i in 0..radii.len() {
        for j in 0..i {
            let sum = radii[i] + radii[j];
            assert!((centres[i] - centres[j]).length() >= sum * (1.0 - 1e-14), "{i} and {j}");
        }
    }
}

#[test]
fn layers_stand_on_the_base_and_follow_the_order() {
    let radii = vec![0.5; 25];
    let centres = loose_lattice::<D3>(&radii, DVec3::new(1.0, 2.0, 3.0), &[3.0, 4.0], 0.0, 1).unwrap();
    assert_eq!(centres[0], DVec3::new(1.5, 2.5, 3.5));
    assert_eq!(centres[3], DVec3::new(1.5, 3.5, 3.5));
    assert_eq!(centres[12], DVec3::new(1.5, 2.5, 4.5));
    assert_eq!(centres[24], DVec3::new(1.5, 2.5, 5.5));
}

#[test]
fn bad_requests_are_refused() {
    let make = |radii: &[f64], base: &[f64], gap| loose_lattice::<D2>(radii, DVec2::ZERO, base, gap, 0);
    assert!(make(&[1.0], &[2.1], 0.1).unwrap_err().to_string().starts_with("edge of the base [m] is 2.1"));
    assert!(make(&[], &[10.0], 0.1).is_err());
    assert!(make(&[1.0, -1.0], &[10.0], 0.1).is_err());
    assert!(make(&[1.0], &[10.0, 1.0], 0.1).is_err());
    for gap in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(make(&[1.0], &[10.0], gap).is_err());
    }
    assert!(make(&[1.0], &[f64::NAN], 0.1).is_err());
    assert!(make(&[1.0], &[f64::INFINITY], 0.1).is_err());
}

proptest! {
    #[test]
    fn grains_never_overlap_and_stay_inside(
        radii in prop::collection::vec(0.2..1.0_f64, 1..80),
        width in 3.0..12.0_f64,
        depth in 3.0..12.0_f64,
        gap in 0.0..0.5_f64,
        seed in any::<u64>(),
    ) {
        let plane = loose_lattice::<D2>(&radii, DVec2::ZERO, &[width], gap, seed).unwrap();
        assert_apart::<D2>(&plane, &radii);
        let space = loose_lattice::<D3>(&radii, DVec3::ZERO, &[width, depth], gap, seed).unwrap();
        assert_apart::<D3>(&space, &radii);
        for (centre, &radius) in space.iter().zip(&radii) {
            let edge = radius * (1.0 - 1e-12);
            prop_assert!(centre.min_element() >= edge && centre.x <= width - edge && centre.y <= depth - edge);
        }
        prop_assert_eq!(space, loose_lattice::<D3>(&radii, DVec3::ZERO, &[width, depth], gap, seed).unwrap());
    }
}
