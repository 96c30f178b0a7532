use super::*;
use granular_core::{D2, D3};

/// Largest distance of the measured from the demanded curve, on both sides of every step.
fn curve_error<D: Dim>(grading: &Grading, radii: &[f64]) -> f64 {
    let mut sorted = radii.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let total: f64 = sorted.iter().map(|&radius| D::ball_volume(radius)).sum();
    let (mut finer, mut worst) = (0.0, 0.0_f64);
    for radius in sorted {
        let demanded = grading.cumulative(2.0 * radius);
        worst = worst.max((finer / total - demanded).abs());
        finer += D::ball_volume(radius);
        worst = worst.max((finer / total - demanded).abs());
    }
    worst
}

fn gradings() -> Vec<Grading> {
    let mut all = vec![
        Grading::EqualMass { min: 1e-3, max: 1.5e-3 },
        Grading::EqualMass { min: 1e-3, max: 6e-3 },
        Grading::Beta { min: 1e-3, max: 2e-3, a: 0.5, b: 0.5 },
        Grading::Beta { min: 1e-3, max: 4e-3, a: 2.0, b: 5.0 },
    ];
    all.extend([1.5, 1.8, 2.0, 6.0].map(|ratio| Grading::Beta {
        min: 1e-3,
        max: ratio * 1e-3,
        a: 4.0,
        b: 4.0,
    }));
    all
}

fn worst_of_all<D: Dim>(count: usize) -> f64 {
    let errors = gradings().into_iter().map(|grading| {
        let error = curve_error::<D>(&grading, &grading.sample::<D>(count, 1).unwrap());
        println!("{count} grains in {} axes, {grading:?}: {error:.2e}", D::N);
        error
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn samples_meet_their_curve() {
    assert!(worst_of_all::<D2>(3000) < 0.002);
    assert!(worst_of_all::<D3>(3000) < 0.005);
    assert!(worst_of_all::<D2>(300) < 0.012);
    assert!(worst_of_all::<D3>(300) < 0.04);
}

#[test]
fn mean_volume_is_exact_for_any_count() {
    // Mean of d^N by number is 1 over the mean of d^-N by volume, closed for equal mass:
    // in the plane min max, in space 2 min^2 max^2 / (min + max).
    let grading = Grading::EqualMass { min: 1.0, max: 3.0 };
    for count in [1, 2, 7, 1000] {
        let plane: f64 = grading.sample::<D2>(count, 0).unwrap().iter().map(|r| 4.0 * r * r).sum();
        let space: f64 = grading.sample::<D3>(count, 0).unwrap().iter().map(|r| 8.0 * r.powi(3)).sum();
        assert!((plane / count as f64 / 3.0 - 1.0).abs() < 1e-8, "{plane}");
        assert!((space / count as f64 / 4.5 - 1.0).abs() < 1e-8, "{space}");
    }
}

#[test]
fn equal_mass_follows_the_closed_form_by_number() {
    let (min, max) = (0.5, 1.5); // radii
    let grading = Grading::EqualMass { min: 1.0, max: 3.0 };
    let count = 10_000;
    let rising = |mut radii: Vec<f64>| {
        radii.sort_unstable_by(f64::total_cmp);
        radii
    };
    let (plane, space) = (grading.sample::<D2>(count, 5).unwrap(), grading.sample::<D3>(count, 5).unwrap());
    for (index, (disk, sphere)) in rising(plane).into_iter().zip(rising(space)).enumerate() {
        let z = (index as f64 + 0.5) / count as f64;
        let expected = min * max / (max - z * (max - min));
        assert!((disk - expected).abs() < 1e-5 * expected, "plane {z}: {disk} {expected}");
        let (from, to) = (1.0 / (min * min), 1.0 / (max * max));
        let expected = (from - z * (from - to)).powf(-0.5);
        assert!((sphere - expected).abs() < 1e-5 * expected, "space {z}: {sphere} {expected}");
    }
}

#[test]
fn the_seed_decides_the_order_only() {
    let grading = Grading::Beta { min: 0.92e-3, max: 1.38e-3, a: 4.0, b: 4.0 };
    let (mut one, mut two) = (grading.sample::<D2>(500, 1).unwrap(), grading.sample::<D2>(500, 2).unwrap());
    assert_eq!(one, grading.sample::<D2>(500, 1).unwrap());
    assert_ne!(one, two);
    one.sort_unstable_by(f64::total_cmp);
    two.sort_unstable_by(f64::total_cmp);
    assert_eq!(one, two);
    assert!(one.windows(2).all(|pair| pair[1] > pair[0]), "no two grains are equal");
}

#[test]
fn bad_gradings_are_refused_with_what_value_and_range() {
    let beta = |min, max, a, b| Grading::Beta { min, max, a, b };
    for (grading, what) in [
        (beta(0.0, 1.0, 4.0, 4.0), "smallest diameter [m]"),
        (beta(-1.0, 1.0, 4.0, 4.0), "smallest diameter [m]"),
        (beta(f64::NAN, 1.0, 4.0, 4.0), "smallest diameter [m]"),
        (beta(1.0, 0.5, 4.0, 4.0), "largest diameter [m]"),
        (beta(1.0, f64::INFINITY, 4.0, 4.0), "largest diameter [m]"),
        (beta(1.0, 2.0, 0.0, 4.0), "shape parameter a"),
        (beta(1.0, 2.0, 4.0, f64::NAN), "shape parameter b"),
        (Grading::Single { diameter: 0.0 }, "smallest diameter [m]"),
        (Grading::EqualMass { min: 2.0, max: 1.0 }, "largest diameter [m]"),
    ] {
        let error = grading.sample::<D2>(10, 0).unwrap_err();
        assert_eq!(error.what, what, "{grading:?}");
        assert!(grading.cumulative(1.0).is_nan());
    }
    let error = beta(1.0, 0.5, 4.0, 4.0).check().unwrap_err();
    assert_eq!(error.to_string(), "largest diameter [m] is 0.5, allowed is 1 (the smallest) to 10000");
    assert_eq!(beta(1.0, 2.0, 4.0, 4.0).sample::<D2>(0, 0).unwrap_err().what, "number of grains");
}

#[test]
fn curves_are_known_at_known_points() {
    let grading = Grading::Beta { min: 0.92e-3, max: 1.38e-3, a: 4.0, b: 4.0 };
    assert!((grading.cumulative(1.15e-3) - 0.5).abs() < 1e-12);
    assert!((grading.cumulative(1.035e-3) - 0.070556641).abs() < 1e-8);
    assert_eq!((grading.cumulative(0.9e-3), grading.cumulative(1.4e-3)), (0.0, 1.0));
    assert!((grading.size_span() - 0.2).abs() < 1e-12);
    let single = Grading::Single { diameter: 2.0 };
    assert_eq!(single.sample::<D3>(3, 0).unwrap(), [1.0; 3]);
    assert_eq!((single.cumulative(1.9), single.cumulative(2.0), single.size_span()), (0.0, 1.0, 0.0));
}

#[test]
fn measured_curves_and_medians() {
    let radii = [1.0, 2.0, 3.0];
    assert!((finer_by_volume::<D2>(&radii, 4.0) - 5.0 / 14.0).abs() < 1e-15);
    assert!((finer_by_volume::<D3>(&radii, 4.0) - 9.0 / 36.0).abs() < 1e-15);
    assert_eq!(finer_by_volume::<D2>(&radii, 6.0), 1.0);
    assert_eq!(median_diameter::<D2>(&radii).unwrap(), 6.0);
    let grading = Grading::Beta { min: 1.0, max: 2.0, a: 4.0, b: 4.0 };
    let median = median_diameter::<D3>(&grading.sample::<D3>(3000, 1).unwrap()).unwrap();
    assert!((median - 1.5).abs() < 1e-3, "{median}");
    assert!(median_diameter::<D2>(&[]).is_err());
}
