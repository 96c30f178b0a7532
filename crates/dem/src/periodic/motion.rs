//! Moving the grains of a cell: the scheme of [`crate::motion`] with a cell that deforms.
//!
//! The edges change at a constant rate within a step, `h_m = h_n + h' dt/2`, `h_(n+1) = h_m + h' dt/2`
//! with `h' = L h_m`:
//!
//! ```text
//! x_m = A x_n + u_n dt/2                u_m = u_n + (a_(m-1) - L u_n) dt/2      A = (1 - L dt/2)^-1
//! (u_(n+1) - u_n) / dt = a_m - L (u_n + u_(n+1)) / 2
//! x_(n+1) = B (x_m + u_(n+1) dt/2)                                              B = 1 + L dt/2
//! ```
//!
//! Both halves are each other's mirror in time, so the scheme stays of second order. Images stay
//! images to round-off, and the change of kinetic energy is exactly that of forces and of `-L u` at the
//! mean velocity.

use super::{Matrix, PeriodicCell, Sums};
use crate::contacts::Pairs;
use crate::grains::Grains;
use crate::motion::{Particulars, order_of};
use granular_core::{Blocks, Dim, Linear, PerBlock};

/// First half of a step: drift, and predict the velocity at the middle, now that of the laboratory.
pub(crate) fn open_step<D: Dim>(
    grains: &mut Grains<D>,
    cell: &mut PeriodicCell<D>,
    blocks: Blocks,
    [last_dt, dt]: [f64; 2],
    speeds: &mut [u64],
) {
    let half = 0.5 * dt;
    let gradient = cell.gradient;
    let stretch = Matrix::unit().plus(&gradient, -half).inverse();
    // Springs advance from the middle of the last step to the middle of this one, and the rate of the cell may have
    // jumped on the way.
    let share = dt / (last_dt + dt);
    let start_gradient =
        Matrix::zero().plus(&gradient.times(&stretch), share).plus(&cell.last_gradient, 1.0 - share);
    cell.start_rate = start_gradient.times(&cell.edges);
    cell.edges = stretch.times(&cell.edges);
    cell.edge_rate = gradient.times(&cell.edges);
    let deforms = cell.deforms();
    cell.start_velocity.resize(if deforms { grains.len() } else { 0 }, D::Vec::ZERO);
    if !deforms {
        return crate::motion::open_step(grains, blocks, dt, speeds);
    }
    let low = cell.low;
    let work = (
        &mut grains.position[..],
        &mut grains.middle_velocity[..],
        &mut grains.middle_spin[..],
        &mut cell.start_velocity[..],
        PerBlock(speeds),
    );
    let (velocity, acceleration) = (&grains.velocity, &grains.acceleration);
    let (spin, spin_acceleration) = (&grains.spin, &grains.spin_acceleration);
    blocks.for_each(work, |block, (position, middle, middle_spin, start_velocity, speed)| {
        let start = blocks.range(block).start;
        let mut fastest = 0;
        for k in 0..position.len() {
            let u = velocity[start + k];
            let mut predicted = u + acceleration[start + k] * half;
            predicted -= gradient.apply(u) * half;
            fastest = fastest.max(order_of(u.length_squared())).max(order_of(predicted.length_squared()));
            let place = position[k] - low;
            start_velocity[k] = u + start_gradient.apply(place);
            let moved = stretch.apply(place) + u * half;
            position[k] = low + moved;
            middle[k] = predicted + gradient.apply(moved);
        }
        for k in 0..middle_spin.len() {
            middle_spin[k] = spin[start + k] + spin_acceleration[start + k] * half;
        }
        speed.0[0] = fastest;
    });
}

/// Second half of a step, with the loads in `acceleration` and `spin_acceleration`. Returns the
/// sums over all grains. For a cell that deforms; [`crate::motion`] closes steps of others.
pub(crate) fn close_step<D: Dim>(
    grains: &mut Grains<D>,
    cell: &mut PeriodicCell<D>,
    pairs: &dyn Pairs<D>,
    blocks: Blocks,
    gravity: D::Vec,
    dt: f64,
) -> Sums<D> {
    let half = 0.5 * dt;
    let (forth, back) =
        (Matrix::unit().plus(&cell.gradient, -half), Matrix::unit().plus(&cell.gradient, half).inverse());
    let stretch = Matrix::unit().plus(&cell.gradient, half);
    cell.edges = cell.edges.plus(&cell.edge_rate, half);
    cell.sums.resize(blocks.count(), Sums::default());
    let low = cell.low;
    let work = (
        &mut grains.position[..],
        (&mut grains.velocity[..], &mut grains.acceleration[..]),
        (&mut grains.spin[..], &mut grains.spin_acceleration[..]),
        PerBlock(&mut cell.sums),
    );
    let (masses, radii, fixed, inertia) = (&grains.mass, &grains.radius, &grains.fixed, &grains.inertia);
    blocks.for_each(work, |block, (position, (velocity, load), (spin, moment), sums)| {
        pairs.collect(block, load, moment);
        let range = blocks.range(block);
        let particulars = Particulars::of(fixed, inertia, range.clone());
        let (mass, radius) = (&masses[range.clone()], &radii[range]);
        let mut sum = Sums::<D>::default();
        for (k, &mass) in mass.iter().enumerate() {
            let free = load[k] * (1.0 / mass) + gravity;
            // A grain that is fixed goes with the flow of the cell.
            let acceleration = if particulars.is_fixed(k) { D::Vec::ZERO } else { free };
            let u = back.apply(forth.apply(velocity[k]) + acceleration * dt);
            let (place, mean) = (position[k] - low, (velocity[k] + u) * 0.5);
            sum.virial = sum.virial.plus(&Matrix::dyad(load[k], place), 1.0);
            sum.virial = sum.virial.plus(&Matrix::dyad(mean, mean), mass);
            sum.moment += place * mass;
            velocity[k] = u;
            position[k] = low + stretch.apply(place + u * half);
            load[k] = acceleration;
        }
        for k in 0..spin.len() {
            let free = moment[k] * (1.0 / particulars.inertia::<D>(k, mass[k], radius[k]));
            let acceleration = if particulars.is_fixed(k) { D::Spin::ZERO } else { free };
            moment[k] = acceleration;
            spin[k] += acceleration * dt;
        }
        sums.0[0] = sum;
    });
    let mut total = Sums::default();
    for sum in &cell.sums {
        total.virial = total.virial.plus(&sum.virial, 1.0);
        total.moment += sum.moment;
    }
    total
}
