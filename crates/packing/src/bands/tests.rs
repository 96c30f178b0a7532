use super::*;
use granular_core::glam::{DVec2, DVec3};
use granular_core::{D2, D3};
use proptest::prelude::*;
use std::f64::consts::PI;

#[test]
fn parts_of_a_ball_match_segment_and_cap() {
    for k in -120..=120 {
        let t = f64::from(k) / 100.0;
        let c = t.clamp(-1.0, 1.0);
        let segment = 4.0 * (0.5 * PI + c.asin() + c * (1.0 - c * c).sqrt());
        let cap = 8.0 * PI * (2.0 / 3.0 + c - c.powi(3) / 3.0);
        assert!((volume_below::<D2>(2.0, 2.0 * t) - segment).abs() < 1e-13, "{t}");
        assert!((volume_below::<D3>(2.0, 2.0 * t) - cap).abs() < 1e-13, "{t}");
    }
}

#[test]
fn a_ball_is_shared_by_its_bands() {
    let bands = Bands { base: 2.0, low: 0.0, high: 4.0, thickness: 1.0 };
    let fractions = solid_fraction_bands::<D3>(&[DVec3::new(0.0, 0.0, 2.0)], &[1.0], &bands).unwrap();
    let half = PI * 2.0 / 3.0 / 2.0;
    for (fraction, expected) in fractions.iter().zip([0.0, half, half, 0.0]) {
        assert!((fraction - expected).abs() < 1e-15);
    }
}

#[test]
fn parts_outside_the_bands_are_left_out() {
    let bands = Bands { base: 1.0, low: 0.0, high: 1.0, thickness: 0.5 };
    let centres = [DVec2::new(0.0, -5.0), DVec2::new(0.0, 0.0), DVec2::new(0.0, 1.0), DVec2::new(0.0, 9.0)];
    let fractions = solid_fraction_bands::<D2>(&centres, &[0.1; 4], &bands).unwrap();
    let half = 0.5 * PI * 0.01 / 0.5;
    assert!(fractions.iter().all(|fraction| (fraction - half).abs() < 1e-15), "{fractions:?}");
}

#[test]
fn homogeneity_matches_a_sum_by_hand() {
    // e = 1 and 1/3 in the bands; overall solid fraction 0.625, e = 0.6.
    let expected = (0.4_f64.powi(2) + (0.6 - 1.0 / 3.0_f64).powi(2)) / 1.0;
    assert!((homogeneity(&[0.5, 0.75]).unwrap() - expected).abs() < 1e-15);
    assert_eq!(homogeneity(&[0.5; 7]).unwrap(), 0.0);
}

#[test]
fn bad_requests_are_refused() {
    assert!(homogeneity(&[0.8]).is_err());
    assert!(homogeneity(&[0.8, 0.0]).is_err());
    assert!(homogeneity(&[0.8, f64::NAN]).is_err());
    let good = Bands { base: 1.0, low: 0.0, high: 1.0, thickness: 0.1 };
    assert_eq!(good.count().unwrap(), 10);
    for bad in [
        Bands { base: 0.0, ..good },
        Bands { low: f64::NAN, ..good },
        Bands { high: 0.05, ..good },
        Bands { high: f64::INFINITY, ..good },
        Bands { thickness: 0.0, ..good },
        Bands { thickness: 1e-12, ..good },
    ] {
        assert!(bad.count().is_err(), "{bad:?}");
    }
    let one = [DVec2::ZERO];
    assert!(solid_fraction_bands::<D2>(&one, &[1.0, 1.0], &good).is_err());
    assert!(solid_fraction_bands::<D2>(&[DVec2::NAN], &[1.0], &good).is_err());
    assert!(solid_fraction_bands::<D2>(&[], &[], &good).is_err());
}

proptest! {
    #[test]
    fn bands_hold_all_of_the_sample(
        grains in prop::collection::vec((0.1..1.0_f64, 1.0..9.0_f64), 1..50),
        thickness in 0.05..3.0_f64,
    ) {
        let radii: Vec<f64> = grains.iter().map(|grain| grain.0).collect();
        let centres: Vec<DVec3> = grains.iter().map(|grain| DVec3::new(0.0, 0.0, grain.1)).collect();
        let bands = Bands { base: 3.0, low: 0.0, high: 10.0 + thickness, thickness };
        let fractions = solid_fraction_bands::<D3>(&centres, &radii, &bands).unwrap();
        let held = fractions.iter().sum::<f64>() * 3.0 * thickness;
        let all: f64 = radii.iter().map(|&radius| D3::ball_volume(radius)).sum();
        prop_assert!((held / all - 1.0).abs() < 1e-12);
    }
}
