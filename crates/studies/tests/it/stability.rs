//! Limits from both sides.

use granular_studies::validate::Effort;
use granular_studies::validate::stability::{Outcome, Request, dem, lbm, table, verdict};

#[test]
fn the_limit_of_one_relaxation_time_is_met_from_both_sides() {
    let request = Request {
        effort: Effort::Quick,
        operators: vec!["single".to_owned()],
        flows: vec!["cavity".to_owned(), "jet".to_owned()],
    };
    let rows = lbm(&request).unwrap();
    verdict(&rows).unwrap_or_else(|failure| panic!("{failure}\n{}", table(&rows)));
    for case in ["cavity: single", "jet: single"] {
        let row = |parameter: &str| {
            rows.iter().find(|row| row.case == case && row.parameter.starts_with(parameter)).unwrap()
        };
        let reynolds = row("grid Reynolds");
        let (predicted, observed) = (reynolds.predicted_limit.unwrap(), reynolds.observed_limit.unwrap());
        assert!(predicted <= observed && observed < 2.0 * predicted, "{}", table(&rows));
        assert_eq!(reynolds.outcome, Outcome::Stopped);
        assert!(reynolds.reason.contains("density"), "{}", reynolds.reason);
        let tau = row("smallest relaxation time");
        let (predicted, observed) = (tau.predicted_limit.unwrap(), tau.observed_limit.unwrap());
        assert!(observed <= predicted && predicted - 0.5 < 2.0 * (observed - 0.5), "{}", table(&rows));
        assert_eq!(row("largest relaxation time").outcome, Outcome::Finished);
        assert_eq!(row("Mach").outcome, Outcome::Refused);
    }
}

#[test]
fn grains_are_safe_within_the_limits_that_are_reported_and_the_limits_are_not_far_off() {
    let rows = dem(Effort::Quick).unwrap();
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
