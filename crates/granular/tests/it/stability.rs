//! `granular validate stability`: limits from both sides, and the command.

use crate::support::Scratch;
use granular::validate::Effort;
use granular::validate::stability::{Outcome, Request, dem, lbm, table, verdict};

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
fn the_command_prints_the_promised_keys_and_keeps_its_plain_form() {
    let scratch = Scratch::new("stability");
    let sweep = ["validate", "stability", "lbm", "--operator", "regularised", "--flow", "cavity", "--json"];
    let rows = scratch.granular(&sweep).expect(0).json();
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 8);
    for row in rows {
        let keys: Vec<&str> = row.as_object().unwrap().keys().map(String::as_str).collect();
        let promised = "case parameter predicted_limit observed_limit outcome reason";
        assert_eq!(keys, promised.split(' ').collect::<Vec<_>>());
        assert!(["finished", "refused", "stopped"].contains(&row["outcome"].as_str().unwrap()), "{row}");
        assert!(!row["reason"].as_str().unwrap().is_empty());
    }
    let plain = scratch.granular(&["validate", "grading", "--full", "--json"]).expect(0).json();
    assert!(!plain.as_array().unwrap().is_empty());
    scratch.granular(&["validate", "stability", "lbm", "--operator", "triple"]).expect(2);
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

#[test]
fn flags_of_the_fluid_are_refused_for_grains() {
    let scratch = Scratch::new("stability-dem");
    let outcome = scratch.granular(&["validate", "stability", "dem", "--operator", "single"]);
    assert_ne!(outcome.code, Some(0));
    outcome.says(&["--operator and --flow are of `lbm`"]);
}
