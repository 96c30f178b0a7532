//! Loads on grains stay with their grains.

use super::contract::{Breach, same, state_of};
use crate::dim::Dim;
use crate::exchange::{Accepts, Provides};
use crate::quantity::{GrainMotion, HydroLoad, Load};
use crate::solver::Solver;

const WHY: &str = "loads follow their grains";

/// Loads that are held over `steps` steps of `dt` \[s\], taken in one call, act as those that are given anew before each
/// step by the identifiers of grains: a solver that re-sorts grains carries their loads along. And they act: without them
/// the state is another.
///
/// `load` is the load by the identifier of the grain. There should be enough steps for grains to be re-sorted.
///
/// # Errors
/// When the promise is not kept.
pub fn loads_follow_their_grains<D: Dim, S>(
    build: impl Fn() -> S,
    load: impl Fn(u32) -> Load<D>,
    dt: f64,
    steps: u64,
) -> Result<(), Breach>
where
    S: Solver + Provides<GrainMotion<D>> + Accepts<HydroLoad<D>>,
{
    let go = |solver: &mut S, steps: u64| {
        let outcome = solver.advance(dt, steps);
        solver.publish();
        outcome.map_err(|error| Breach::new(WHY, format!("a step failed: {error}")))
    };
    let give = |solver: &mut S| {
        solver.clear_inputs();
        for (id, place) in solver.view_mut().iter_mut() {
            *place += load(id);
        }
    };
    let [mut held, mut anew, mut without] = [build(), build(), build()];
    for solver in [&mut held, &mut anew] {
        solver.enable();
    }
    give(&mut held);
    go(&mut held, steps)?;
    for _ in 0..steps {
        give(&mut anew);
        go(&mut anew, 1)?;
    }
    go(&mut without, steps)?;
    let motions = |solver: &S| {
        let mut list: Vec<_> = solver.view().iter().collect();
        list.sort_by_key(|(id, ..)| *id);
        list
    };
    if motions(&held) == motions(&without) {
        return Err(Breach::new(WHY, "the loads change nothing"));
    }
    same(&state_of(&held), &state_of(&anew), WHY, "loads that are held and loads that are given anew differ")
}
