//! Validation cases of the fluid: channels, decaying vortices, a cavity, bodies in a stream, balances.

mod balance;
pub(super) mod bodies;
pub(super) mod cavity;
mod channel;
pub(super) mod cylinder;
pub(super) mod decay;
mod street;
mod wall;

use crate::validate::cases;
use granular_core::Solver;
use granular_driver::failure::Failure;
use granular_lbm::{Lattice, Lbm, Operator, Real, Setup};

cases! { "lbm";
    poiseuille: "flow between plates, steady and started" => channel::poiseuille;
    couette: "a plate starts to move" => channel::couette;
    womersley: "oscillating flow between plates" => channel::womersley;
    taylor_green: "decaying vortices: viscosity and order" => decay::taylor_green;
    cavity: "a cavity under a moving lid" => cavity::run;
    cylinder: "drag and lift of a cylinder in a channel" => cylinder::run;
    wall_in_channel: "the stream turns back behind a wall" => wall::run;
    vortex_street: "Strouhal numbers of a disk and a square" => street::run;
    square_array: "drag of a square array of disks" => bodies::square_array;
    disk_in_channel: "drag of a disk in a channel" => bodies::disk_in_channel;
    carried_disk: "a disk carried by a stream" => bodies::carried_disk;
    fluid_mass: "mass of a fluid between walls" => balance::mass;
    hydrostatic: "a fluid at rest under gravity" => balance::hydrostatic;
}

const FITS: &str = "the flow of the case is in range";

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
