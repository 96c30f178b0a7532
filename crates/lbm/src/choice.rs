//! Which kernel a fluid needs.

use crate::body_force::ForceField;
use crate::collision::{Parameters, Parts, Physics, With};
use crate::immersed::Cells;
use crate::lattice::{D2Q9, D3Q19, Lattice};
use crate::populations::{Populations, Runs};
use crate::real::Real;
use crate::rows::RowLinks;
use std::any::Any;

/// Fluid without grains, and cells that grains cover.
type Where<'a, T> = (&'a Runs, &'a mut Cells<T>);
type StepFunction<T> =
    for<'a> fn(&mut Populations<T>, Where<'a, T>, &ForceField<T>, &Parameters<T>, T) -> bool;
type PairFunction<T> = for<'a> fn(
    &mut Populations<T>,
    Where<'a, T>,
    &RowLinks<T>,
    &ForceField<T>,
    &[Parameters<T>; 2],
    T,
) -> bool;

/// One step, and two in one pass.
pub(crate) type Steps<T> = (StepFunction<T>, PairFunction<T>);

/// The step compiled for the parts that are on.
///
/// Kernels of both lattices and number types are compiled here, and not again in every crate that builds a fluid.
pub(crate) fn step_function<L: Lattice<Q>, T: Real, const Q: usize>(physics: &Physics) -> Steps<T> {
    let steps: Box<dyn Any> = match (L::NAME, T::LINE) {
        (D2Q9::NAME, f64::LINE) => Box::new(plane_double(physics)),
        (D2Q9::NAME, _) => Box::new(plane_single(physics)),
        (_, f64::LINE) => Box::new(space_double(physics)),
        _ => Box::new(space_single(physics)),
    };
    *steps.downcast::<Steps<T>>().expect("there are two lattices and two types of numbers")
}

#[inline(never)]
fn plane_double(physics: &Physics) -> Steps<f64> {
    steps::<D2Q9, f64, 9>(physics)
}

#[inline(never)]
fn plane_single(physics: &Physics) -> Steps<f32> {
    steps::<D2Q9, f32, 9>(physics)
}

#[inline(never)]
fn space_double(physics: &Physics) -> Steps<f64> {
    steps::<D3Q19, f64, 19>(physics)
}

#[inline(never)]
fn space_single(physics: &Physics) -> Steps<f32> {
    steps::<D3Q19, f32, 19>(physics)
}

fn steps<L: Lattice<Q>, T: Real, const Q: usize>(physics: &Physics) -> Steps<T> {
    fn of<L: Lattice<Q>, T: Real, P: Parts, const Q: usize>() -> Steps<T> {
        (Populations::step::<L, P, Q>, Populations::two_steps::<L, P, Q>)
    }
    fn forced<L: Lattice<Q>, T: Real, const G: bool, const C: bool, const Q: usize>(
        physics: &Physics,
    ) -> Steps<T> {
        match (physics.has_force(), physics.has_field()) {
            (false, _) => of::<L, T, With<G, false, C, false>, Q>(),
            (true, false) => of::<L, T, With<G, true, C, false>, Q>(),
            (true, true) => of::<L, T, With<G, true, C, true>, Q>(),
        }
    }
    match (physics.has_ghosts(), physics.has_closure()) {
        (false, false) => forced::<L, T, false, false, Q>(physics),
        (false, true) => forced::<L, T, false, true, Q>(physics),
        (true, false) => forced::<L, T, true, false, Q>(physics),
        (true, true) => forced::<L, T, true, true, Q>(physics),
    }
}
