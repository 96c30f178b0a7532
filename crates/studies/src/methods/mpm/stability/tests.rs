use super::*;
use crate::validate::stability::{Outcome, limits, table, verdict};

#[test]
fn continua_are_safe_within_the_limits_that_are_reported_and_the_limits_are_not_far_off() {
    let rows = limits("mpm", &Request::default()).unwrap();
    verdict(&rows).unwrap_or_else(|failure| panic!("{failure}\n{}", table(&rows)));
    for row in &rows {
        assert!(!row.reason.is_empty(), "{}", row.case);
        if row.case.starts_with("trembling") {
            // The limit is that of the worst place and velocities of many.
            let observed = row.observed_limit.unwrap();
            assert!((1.0..3.0).contains(&observed), "{}", table(&rows));
        }
    }
    // What is excused belongs to one variant, and to it alone.
    let mut excused = rows.iter().filter(|row| row.known);
    assert!(excused.all(|row| row.case.ends_with("linear, stress-last")), "{}", table(&rows));
    assert_eq!(rows.iter().filter(|row| row.parameter == "set-up").count(), 6);
    assert!(rows.iter().filter(|row| row.parameter == "set-up").all(|row| row.outcome == Outcome::Refused));
}

#[test]
fn what_is_chosen_is_run_and_nothing_else() {
    let request = Request::default().choose("shape", &["bspline"]).choose("scheme", &["stress-first"]);
    let names = |chosen: Vec<Variant>| chosen.into_iter().map(Variant::name).collect::<Vec<_>>();
    assert_eq!(names(variants(&request)), ["bspline, stress-first"]);
    assert_eq!(names(hostile(&request)), ["bspline, stress-first"]);
    assert_eq!(variants(&Request::default()).len(), 9);
    let usual = names(hostile(&Request::default()));
    assert_eq!(usual, ["linear, stress-last", "gimp, modified-stress-last"]);
}
