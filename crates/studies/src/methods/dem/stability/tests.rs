use super::*;
use crate::validate::stability::{limits, table, verdict};

#[test]
fn critical_damping_has_the_restitution_that_is_named() {
    assert!((restitution_of_damping(1.0, Tension::Cut) - 0.135).abs() < 5e-4);
}

#[test]
fn a_step_within_the_limit_is_calm_and_one_far_beyond_is_not() {
    let row = longest_step("one grain", &samples()[0].1, 1.1).unwrap();
    let (predicted, observed) = (row.predicted_limit.unwrap(), row.observed_limit.unwrap());
    assert!(row.fault.is_none() && predicted <= observed && observed < 3.0 * predicted, "{row:?}");
}

#[test]
fn choices_of_another_method_are_refused_with_its_name() {
    let failure = limits("dem", &Request::default().choose("colour", &["red"])).unwrap_err().to_string();
    assert!(failure.contains("no study has a choice of `colour`"), "{failure}");
    assert!(limits("packing", &Request::default()).is_err());
}

#[test]
fn grains_are_safe_within_the_limits_that_are_reported_and_the_limits_are_not_far_off() {
    let rows = limits("dem", &Request::default()).unwrap();
    verdict(&rows).unwrap_or_else(|failure| panic!("{failure}\n{}", table(&rows)));
    for row in &rows {
        assert!(!row.reason.is_empty());
        if let (Some(predicted), Some(observed), "step [s]") =
            (row.predicted_limit, row.observed_limit, row.parameter)
        {
            // Strong damping costs most: the prediction takes all contacts of a grain to pull the same way.
            assert!(predicted <= observed && observed < 6.0 * predicted, "{}", table(&rows));
        }
    }
    let outcome = |case: &str| rows.iter().find(|row| row.case == case).unwrap().outcome;
    assert_eq!(outcome("restitution 0"), Outcome::Refused);
    assert_eq!(outcome("shot at 100 m/s"), Outcome::Refused);
    assert_eq!(outcome("a grain flung away from a packing"), Outcome::Finished);
    assert_eq!(outcome("packing at the recommended step"), Outcome::Finished);
}
