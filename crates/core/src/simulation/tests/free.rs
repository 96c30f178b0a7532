//! Solvers that nothing couples keep their own steps.

use super::*;

const SLOW: Option<(f64, StepRule)> = Some((0.1, StepRule::AtMost));
const QUICK: Option<(f64, StepRule)> = Some((0.003, StepRule::Recommended));

/// Two solvers that nothing joins, whichever comes first.
fn free(first: Option<(f64, StepRule)>, second: Option<(f64, StepRule)>) -> [Pair; 2] {
    [[first, second], [second, first]].map(|[first, second]| {
        let mut simulation = Simulation::named("first", Box::new(Vessel::new(1.0, first)));
        let key = simulation.find::<Vessel>("first").expect("it was named");
        let other = simulation.add("second", Vessel::new(0.5, second)).unwrap();
        (simulation, key, other)
    })
}

fn recommended(simulation: &Simulation) -> f64 {
    let mut limits = Limits::default();
    simulation.limits(&mut limits);
    limits.recommended().expect("there is a limit").dt
}

#[test]
fn two_free_solvers_cost_what_they_cost_alone() {
    let alone = |level, limit| {
        let mut simulation = Simulation::new(Box::new(Vessel::new(level, limit)));
        let step = recommended(&simulation);
        simulation.begin_segment(step).unwrap();
        simulation.run(1.0, &mut [], &AtomicBool::new(false)).unwrap();
        let key = simulation.find::<Vessel>("solver").expect("it is the only one");
        let vessel = simulation.get(key);
        (vessel.taken.len(), vessel.level)
    };
    for (k, (mut simulation, first, second)) in free(SLOW, QUICK).into_iter().enumerate() {
        let step = recommended(&simulation);
        assert_eq!(step, 0.1);
        simulation.begin_segment(step).unwrap();
        simulation.run(1.0, &mut [], &AtomicBool::new(false)).unwrap();
        assert_eq!((simulation.clock().step(), simulation.clock().time()), (10, 1.0));
        let [slow, quick] =
            if k == 0 { [first, second] } else { [second, first] }.map(|key| simulation.get(key));
        let [level_of_slow, level_of_quick] = if k == 0 { [1.0, 0.5] } else { [0.5, 1.0] };
        // The slow one cannot tell that it has company.
        assert_eq!((slow.taken.len(), slow.level), alone(level_of_slow, SLOW));
        // The quick one takes 34 equal steps in each 0.1 s: at most one in 34 more than alone.
        assert_eq!(quick.taken, [0.1 / 34.0; 340]);
        assert_eq!(alone(level_of_quick, QUICK).0, 334);
    }
}

#[test]
fn free_solvers_take_a_burst_in_one_call_each() {
    let [(mut simulation, slow, quick), _] = free(SLOW, QUICK);
    simulation.begin_segment(0.1).unwrap();
    simulation.advance(50).unwrap();
    assert_eq!([slow, quick].map(|key| simulation.get(key).calls), [1, 1]);
    assert_eq!([slow, quick].map(|key| simulation.get(key).taken.len()), [50, 1700]);
}

#[test]
fn a_coupled_pair_and_a_free_solver_do_not_shorten_each_others_steps() {
    let (mut simulation, tank, bucket) =
        pair(Some((0.01, StepRule::AtMost)), Some((0.004, StepRule::AtMost)));
    let free = simulation.add("free", Vessel::new(0.3, SLOW)).unwrap();
    let step = recommended(&simulation);
    assert_eq!(step, 0.1);
    simulation.begin_segment(step).unwrap();
    simulation.advance(2).unwrap();
    assert_eq!(simulation.get(free).taken, [0.1; 2]);
    assert_eq!(simulation.get(tank).taken, [0.01; 20]);
    assert_eq!(simulation.get(bucket).taken, [0.01 / 3.0; 60]);
    // The pair does what it does without company.
    let (mut other, ..) = pair(Some((0.01, StepRule::AtMost)), Some((0.004, StepRule::AtMost)));
    other.begin_segment(0.01).unwrap();
    other.advance(20).unwrap();
    assert_eq!(other.get(tank).level, simulation.get(tank).level);
    // And the other way round: the free one takes several steps within a long one of the pair.
    let (mut simulation, tank, _) = pair(SLOW, FAST);
    let free = simulation.add("free", Vessel::new(0.3, QUICK)).unwrap();
    let step = recommended(&simulation);
    simulation.begin_segment(step).unwrap();
    simulation.advance(1).unwrap();
    assert_eq!([tank, free].map(|key| simulation.get(key).taken.len()), [1, 34]);
}

#[test]
fn exact_steps_of_free_solvers_must_fit_and_set_the_step_that_is_recommended() {
    let exactly = |dt| Some((dt, StepRule::Exactly));
    for (mut simulation, ..) in free(exactly(0.1), exactly(0.03)) {
        let error = simulation.begin_segment(0.1).unwrap_err().to_string();
        assert!(error.contains("whole number of steps") && error.contains("3e-2"), "{error}");
    }
    // A step that may be chosen is cut to a whole number of those that may not.
    for (mut simulation, ..) in free(SLOW, exactly(0.03)) {
        let step = recommended(&simulation);
        assert!((step - 0.09).abs() < 1e-12);
        simulation.begin_segment(step).unwrap();
        simulation.advance(1).unwrap();
        let taken = |name| simulation.get(simulation.find::<Vessel>(name).unwrap()).taken.clone();
        let mut taken = [taken("first"), taken("second")];
        taken.sort_by_key(Vec::len);
        assert_eq!(taken, [vec![step], vec![0.03; 3]]);
    }
}

#[test]
fn free_solvers_are_restored_and_observers_look_after_each_step_of_the_simulation() {
    struct Look(std::sync::Arc<std::sync::Mutex<Vec<f64>>>);
    impl crate::observer::Observer for Look {
        fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
            self.0.lock().expect("no panic").push(simulation.clock().time());
            Ok(Flow::Continue)
        }
    }
    let run = |halt: Option<f64>| {
        let [(mut simulation, ..), (mut second, ..)] = free(SLOW, QUICK);
        let seen = std::sync::Arc::default();
        let every = crate::observer::Every::Time(0.25);
        let mut observers = [Scheduled::new("look", every, Box::new(Look(std::sync::Arc::clone(&seen))))];
        simulation.begin_segment(0.1).unwrap();
        let flag = AtomicBool::new(false);
        if let Some(halt) = halt {
            simulation.run(halt, &mut observers, &flag).unwrap();
            // By way of a simulation whose steps are shared in another way: only the state is taken over.
            second.restore(&simulation.save()).unwrap();
            [(simulation, ..), _] = free(SLOW, QUICK);
            simulation.restore(&second.save()).unwrap();
        }
        simulation.run(1.05, &mut observers, &flag).unwrap();
        let seen = seen.lock().expect("no panic").clone();
        (simulation.save(), seen)
    };
    let (whole, seen) = run(None);
    assert_eq!(seen.len(), 5);
    assert!(seen.iter().zip([0.0, 0.3, 0.5, 0.8, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{seen:?}");
    assert_eq!(run(Some(0.6)), (whole, seen));
}
