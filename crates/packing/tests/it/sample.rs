//! Gradings and homogeneity of whole samples.

use granular_core::{D2, D3};
use granular_packing::{
    Bands, Grading, Sides, ballistic, finer_by_volume, homogeneity, median_diameter, solid_fraction_bands,
};
use proptest::prelude::*;

#[test]
fn a_column_of_the_source_is_homogeneous() {
    let grading = Grading::Beta { min: 0.92e-3, max: 1.38e-3, a: 4.0, b: 4.0 };
    let radii = grading.sample::<D2>(3000, 1).unwrap();
    let width = 46e-3;
    let deposit = ballistic(&radii, width, Sides::Periodic, 1).unwrap();
    let top = deposit.positions.iter().map(|point| point.y).fold(0.0, f64::max);
    let bands = Bands::of_grains::<D2>(&radii, width, 2e-3, top - 5e-3).unwrap();
    let solid = solid_fraction_bands::<D2>(&deposit.positions, &radii, &bands).unwrap();
    let variance = homogeneity(&solid).unwrap();
    println!("{} bands, homogeneity {variance:.2e}, solid fractions {solid:.3?}", solid.len());
    assert!(solid.len() > 10 && variance < 0.05);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn samples_keep_to_their_range_and_curve(
        min in 1e-6..1e3_f64, ratio in 1.0..6.0_f64, a in 0.3..20.0_f64, b in 0.3..20.0_f64, seed in any::<u64>(),
    ) {
        let grading = Grading::Beta { min, max: min * ratio, a, b };
        let radii = grading.sample::<D2>(2000, seed).unwrap();
        prop_assert!(radii.iter().all(|radius| (min..=min * ratio).contains(&(2.0 * radius))));
        for part in 1..10 {
            let diameter = min * (1.0 + (ratio - 1.0) * 0.1 * f64::from(part));
            let error = finer_by_volume::<D2>(&radii, diameter) - grading.cumulative(diameter);
            // A single size is a step: nothing to compare on it.
            prop_assert!(error.abs() < 0.01 || ratio < 1.0 + 1e-9, "{error} at {diameter}");
        }
    }

    #[test]
    fn lengths_scale(ratio in 1.1..5.0_f64, decade in -6.0..6.0_f64, seed in any::<u64>()) {
        let scale = 10.0_f64.powf(decade);
        let one = Grading::Beta { min: 1.0, max: ratio, a: 4.0, b: 4.0 }.sample::<D3>(200, seed).unwrap();
        let other = Grading::Beta { min: scale, max: scale * ratio, a: 4.0, b: 4.0 }.sample::<D3>(200, seed).unwrap();
        prop_assert!(one.iter().zip(&other).all(|(a, b)| (b / (a * scale) - 1.0).abs() < 1e-9));
        let medians = (median_diameter::<D3>(&one).unwrap(), median_diameter::<D3>(&other).unwrap());
        prop_assert!((medians.1 / (medians.0 * scale) - 1.0).abs() < 1e-9);
    }
}
