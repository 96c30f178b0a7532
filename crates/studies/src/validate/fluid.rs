//! Lattice Boltzmann cases: channels, decaying vortices, a cavity, bodies in a stream, balances.

pub(super) mod balance;
pub(crate) mod bodies;
pub(crate) mod cavity;
pub(super) mod channel;
pub(crate) mod cylinder;
pub(crate) mod decay;
pub(super) mod street;
pub(super) mod wall;

use granular_core::Solver;
use granular_lbm::{Lattice, Lbm, Operator, Real, Setup};

use granular_driver::failure::Failure;

const FITS: &str = "the flow of the case is in range";
/// What rows say of the solver.
const SOLVER: &str = "lbm";

/// Every operator that a scene may choose.
const OPERATORS: [(&str, Operator); 6] = [
    ("one relaxation time", Operator::SingleRelaxation),
    ("two relaxation times, Lambda 3/16", Operator::DEFAULT),
    ("two relaxation times, Lambda 1/4", Operator::TwoRelaxation { magic: 0.25 }),
    ("multiple relaxation times, exact walls", Operator::EXACT_WALLS),
    ("multiple relaxation times, rates of Kumar", Operator::KUMAR),
    ("regularised", Operator::Regularised),
];

fn fluid<L: Lattice<Q>, const Q: usize>(setup: Setup<L::Dim>) -> Lbm<L, Q> {
    Lbm::new(setup).expect(FITS)
}

fn advance<L: Lattice<Q>, const Q: usize, T: Real>(
    lbm: &mut Lbm<L, Q, T>,
    steps: u64,
) -> Result<(), Failure> {
    let dt = lbm.setup().time_step;
    Ok(lbm.advance(dt, steps)?)
}

/// Calls the body for both lattices.
macro_rules! on_both {
    ($body:ident($($argument:expr),*)) => {
        [
            (<D2Q9 as Lattice<9>>::NAME, $body::<D2Q9, 9>($($argument),*)?),
            (<D3Q19 as Lattice<19>>::NAME, $body::<D3Q19, 19>($($argument),*)?),
        ]
    };
}
use on_both;
