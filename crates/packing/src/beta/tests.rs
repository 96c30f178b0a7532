use super::*;
use proptest::prelude::*;

/// I_x(4, 4) at x = 0, 0.05, ..., 1: exact decimal values of the polynomial
/// 35 x^4 - 84 x^5 + 70 x^6 - 20 x^7, from reference/beta_cumulative_a4_b4.csv.
const BETA_4_4: [f64; 21] = [
    0.0,
    0.00019357812,
    0.002728,
    0.012103172,
    0.033344,
    0.070556641,
    0.126036,
    0.19984573,
    0.289792,
    0.3917122,
    0.5,
    0.6082878,
    0.710208,
    0.80015427,
    0.873964,
    0.92944336,
    0.966656,
    0.98789683,
    0.997272,
    0.99980642,
    1.0,
];

#[test]
fn matches_the_reference_table_of_a_4_b_4() {
    for (index, expected) in BETA_4_4.iter().enumerate() {
        let value = regularised_incomplete_beta(index as f64 * 0.05, 4.0, 4.0);
        // The table has eight significant digits.
        assert!((value - expected).abs() < 5e-9, "x = {}: {value}", index as f64 * 0.05);
    }
}

#[test]
fn matches_closed_forms() {
    let mut worst = 0.0_f64;
    for k in 0..=1000 {
        let x = k as f64 / 1000.0;
        let polynomial = x.powi(4) * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)));
        let cases = [
            (4.0, 4.0, polynomial),
            (1.0, 1.0, x),
            (3.0, 1.0, x.powi(3)),
            (1.0, 5.0, 1.0 - (1.0 - x).powi(5)),
            (0.5, 0.5, 2.0 / PI * x.sqrt().asin()),
        ];
        for (a, b, exact) in cases {
            worst = worst.max((regularised_incomplete_beta(x, a, b) - exact).abs());
        }
    }
    println!("largest difference from closed forms {worst:.1e}");
    assert!(worst < 1e-14, "{worst:e}");
}

#[test]
fn large_parameters_approach_the_normal_curve_and_end() {
    // Median of a symmetric curve is exact for any parameter.
    for a in [10.0, 1e2, 1e3, 1e4] {
        let middle = regularised_incomplete_beta(0.5, a, a);
        assert!((middle - 0.5).abs() < 1e-11, "a = {a}: {middle}");
    }
}

#[test]
fn logarithm_of_gamma_matches_factorials_and_the_half() {
    let mut factorial = 1.0_f64;
    for n in 1..20 {
        assert!((ln_gamma(f64::from(n)) - factorial.ln()).abs() < 1e-13, "{n}");
        factorial *= f64::from(n);
    }
    assert!((ln_gamma(0.5) - PI.sqrt().ln()).abs() < 1e-15);
    assert!((ln_gamma(0.25) - 3.625_609_908_221_908_f64.ln()).abs() < 1e-14);
}

#[test]
fn bad_arguments_give_not_a_number() {
    for (x, a, b) in [(0.5, 0.0, 1.0), (0.5, 1.0, -1.0), (f64::NAN, 1.0, 1.0), (0.5, f64::NAN, 1.0)] {
        assert!(regularised_incomplete_beta(x, a, b).is_nan());
    }
    assert_eq!(regularised_incomplete_beta(-1.0, 2.0, 2.0), 0.0);
    assert_eq!(regularised_incomplete_beta(2.0, 2.0, 2.0), 1.0);
}

proptest! {
    #[test]
    fn mirror_and_recurrence(x in 0.001..0.999_f64, a in 0.05..50.0_f64, b in 0.05..50.0_f64) {
        let value = regularised_incomplete_beta(x, a, b);
        let mirrored = regularised_incomplete_beta(1.0 - x, b, a);
        prop_assert!((value + mirrored - 1.0).abs() < 2e-13);
        // I_x(a, b) = x I_x(a - 1, b) + (1 - x) I_x(a, b - 1), written one up.
        let up = regularised_incomplete_beta(x, a + 1.0, b + 1.0);
        let mixed = x * regularised_incomplete_beta(x, a, b + 1.0)
            + (1.0 - x) * regularised_incomplete_beta(x, a + 1.0, b);
        prop_assert!((up - mixed).abs() < 2e-13);
    }

    #[test]
    fn never_falls(a in 0.05..500.0_f64, b in 0.05..500.0_f64) {
        let values: Vec<f64> = (0..=200).map(|k| regularised_incomplete_beta(f64::from(k) / 200.0, a, b)).collect();
        prop_assert!(values.windows(2).all(|pair| pair[1] >= pair[0] - 1e-13));
    }
}
