use super::*;
use crate::validate::stability::{Outcome, limits, table, verdict};
use granular_lbm::OpenScheme;

fn sweep(parameter: Parameter) -> Sweep {
    let start = Start {
        geometry: Geometry::Jet(OpenScheme::ZouHe),
        operator: Operator::SingleRelaxation,
        smagorinsky: None,
        side: 16,
    };
    Sweep { case: "jet".to_owned(), start, parameter, fineness: Fineness::of(Effort::Quick) }
}

fn found(finished: f64, failed: f64) -> Found {
    Found { finished: Some(finished), failed: Some((failed, "too dense".to_owned())), missed: Vec::new() }
}

#[test]
fn flows_and_operators_have_the_names_that_are_offered() {
    let offered = STUDY.choices.iter().map(|choice| choice.names);
    let known = [OPERATORS.map(|(name, _)| name).to_vec(), Geometry::ALL.map(Geometry::name).to_vec()];
    assert!(offered.eq(known));
    let request = Request::default().choose("operator", &["triple"]);
    let failure = limits("lbm", &request).unwrap_err().to_string();
    assert!(failure.contains("no operator is called `triple`; known: single, two"), "{failure}");
}

#[test]
fn a_silent_guard_fails_the_study() {
    let good = sweep(Parameter::GridReynolds).row(&found(20.0, 22.0), Some(10.0), false);
    assert_eq!((good.outcome, &good.fault), (Outcome::Stopped, &None));
    verdict(std::slice::from_ref(&good)).unwrap();
    let mut silent = found(20.0, 22.0);
    silent.missed.push((22.0, "the speed is not a number".to_owned()));
    let silent = sweep(Parameter::GridReynolds).row(&silent, Some(10.0), false);
    assert!(silent.reason.contains("guard silent at 22"), "{}", silent.reason);
    assert!(table(std::slice::from_ref(&silent)).contains("FAILED"));
    let failure = verdict(&[good, silent]).unwrap_err();
    assert_eq!(failure.code(), 1);
    assert!(failure.to_string().contains("1 of 2 limits failed"), "{failure}");
}

#[test]
fn a_failure_within_the_bounds_fails_the_study_whichever_way_the_sweep_goes() {
    let is_fault =
        |p: Parameter, f: Found, predicted| sweep(p).row(&f, Some(predicted), false).fault.is_some();
    assert!(is_fault(Parameter::GridReynolds, found(8.0, 9.0), 10.0));
    assert!(!is_fault(Parameter::GridReynolds, found(10.0, 11.0), 10.0));
    assert!(is_fault(Parameter::SmallTau, found(0.02, 0.018), 0.01));
    assert!(!is_fault(Parameter::SmallTau, found(0.009, 0.008), 0.01));
    let nothing = Found { finished: None, failed: Some((0.1, "too dense".to_owned())), missed: Vec::new() };
    assert!(is_fault(Parameter::SmallTau, nothing, 0.01));
}

#[test]
fn what_the_check_refuses_is_told_with_what_would_have_happened() {
    let row = sweep(Parameter::Mach).row(&found(0.5, 0.6), Some(0.3), true);
    assert_eq!(row.outcome, Outcome::Refused);
    assert!(row.reason.contains("refused above 0.3") && row.reason.contains("stopped at 0.6"), "{row:?}");
    let early = sweep(Parameter::Mach).row(&found(0.2, 0.21), Some(0.3), true);
    assert!(early.outcome == Outcome::Stopped && early.fault.is_some());
    let all = Found { finished: Some(1000.0), failed: None, missed: Vec::new() };
    assert_eq!(sweep(Parameter::GridReynolds).row(&all, None, false).outcome, Outcome::Finished);
}

#[test]
fn predictions_are_those_of_the_solver() {
    for parameter in [Parameter::SmallTau, Parameter::GridReynolds, Parameter::Mach] {
        let sweep = sweep(parameter);
        let bounds = sweep.bounds().unwrap();
        let value = parameter.predicted(&bounds).unwrap();
        let state = parameter.state(value, &bounds);
        let lbm = sweep.start.at(state).unwrap();
        if parameter == Parameter::SmallTau {
            assert!((lbm.setup().tau() - parameter.shown(value)).abs() < 1e-12);
        }
        let mut limits = Limits::default();
        lbm.limits(&mut limits);
        // At the predicted value one bound is met, and none is broken.
        let shares: Vec<f64> = limits.bounds.iter().map(|bound| bound.value / bound.allowed).collect();
        let largest = shares.iter().fold(0.0_f64, |a, &b| a.max(b));
        assert!((largest - 1.0).abs() < 1e-9, "{parameter:?}: {shares:?}");
    }
}

#[test]
fn the_limit_of_one_relaxation_time_is_met_from_both_sides() {
    let request = Request::default().choose("operator", &["single"]).choose("flow", &["cavity", "jet"]);
    let rows = limits("lbm", &request).unwrap();
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
