//! The contract of every solver, for every combination of choices that has its own kernel or its own pass.

use crate::sample::{falling, flowing, tumbling};
use granular_core::{D2, D3, contract_tests};
use granular_mpm::{ObjectiveRate, Options, Scheme, ShapeFunctions, VelocityUpdate};

fn with(shape: ShapeFunctions, scheme: Scheme) -> Options {
    Options { shape, scheme, ..Options::default() }
}

fn damped() -> Options {
    Options {
        velocity_update: VelocityUpdate::Flip { pic_rate: 2.0 },
        local_damping: 0.1,
        ledger: true,
        objective_rate: ObjectiveRate::Jaumann,
        ..with(ShapeFunctions::QuadraticBspline, Scheme::StressLast)
    }
}

fn affine(options: Options) -> Options {
    Options { velocity_update: VelocityUpdate::Apic, ..options }
}

const STEP: f64 = 1.25e-3;

contract_tests!(
    linear_stress_last,
    || flowing::<D2>(with(ShapeFunctions::Linear, Scheme::StressLast), 1.0),
    0.5 * STEP,
    warm_up = 1200
);
contract_tests!(
    linear_modified,
    || tumbling::<D2>(with(ShapeFunctions::Linear, Scheme::ModifiedStressLast), 2.0),
    STEP,
    warm_up = 1800
);
contract_tests!(
    blocks_stress_first,
    || tumbling::<D2>(with(ShapeFunctions::UniformGimp, Scheme::StressFirst), 2.0),
    STEP,
    warm_up = 1800
);
contract_tests!(
    splines_modified,
    || tumbling::<D2>(with(ShapeFunctions::QuadraticBspline, Scheme::ModifiedStressLast), 2.0),
    STEP,
    warm_up = 1800
);
contract_tests!(
    affine_splines,
    || tumbling::<D2>(affine(with(ShapeFunctions::QuadraticBspline, Scheme::ModifiedStressLast)), 2.0),
    STEP,
    warm_up = 1800
);
contract_tests!(
    affine_blocks_in_space,
    || tumbling::<D3>(affine(with(ShapeFunctions::UniformGimp, Scheme::ModifiedStressLast)), 0.7),
    0.5 * STEP,
    warm_up = 1800
);
contract_tests!(damped_among_walls, || falling::<D2>(damped(), 1.0), 0.5 * STEP);
contract_tests!(
    blocks_in_space,
    || flowing::<D3>(with(ShapeFunctions::UniformGimp, Scheme::StressLast), 0.6),
    0.5 * STEP
);
contract_tests!(
    linear_in_space,
    || tumbling::<D3>(with(ShapeFunctions::Linear, Scheme::ModifiedStressLast), 0.7),
    STEP,
    warm_up = 1800
);
