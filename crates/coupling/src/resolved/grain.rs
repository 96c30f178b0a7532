//! A grain as the fluid met it last, and the load that it got.

use super::HeldLoad;
use crate::middle::{Seen, first_seen, later};
use granular_core::{CoveredFluid, Dim, FlowLoads, Linear, Load, Motion};

/// A grain in the fluid.
#[derive(Clone, Copy, Debug)]
pub(super) struct GrainInFluid<D: Dim> {
    pub(super) id: u32,
    /// Its own radius and the hydrodynamic one \[m\].
    pub(super) radius: [f64; 2],
    /// Velocity and spin at the start of the last step of the fluid, and their change in the one before.
    pub(super) seen: Seen,
    /// Velocity and spin with which the fluid met it in its last step, and in the one before.
    pub(super) met: [(D::Vec, D::Spin); 2],
    /// Whether the fluid has not taken a step with it.
    pub(super) is_new: bool,
    /// What the fluid did in its last step.
    pub(super) last: Load<D>,
    /// What is put on the grain.
    pub(super) load: Load<D>,
}

impl<D: Dim> PartialEq for GrainInFluid<D> {
    fn eq(&self, other: &Self) -> bool {
        let Self { id, radius, seen, met, is_new, last, load } = self;
        (id, radius, seen, met) == (&other.id, &other.radius, &other.seen, &other.met)
            && (is_new, last, load) == (&other.is_new, &other.last, &other.load)
    }
}

/// What all grains have in common in a step of the fluid.
pub(super) struct Around<'a, D: Dim> {
    pub(super) flow: FlowLoads<'a, D>,
    /// The step of the fluid \[s\].
    pub(super) dt: f64,
    pub(super) gravity: D::Vec,
    pub(super) held: HeldLoad,
}

impl<D: Dim> GrainInFluid<D> {
    /// One that the fluid has not met yet.
    pub(super) fn new(id: u32, motion: &Motion<D>, radius: f64) -> Self {
        Self {
            id,
            radius: [radius; 2],
            seen: first_seen(motion),
            met: [(motion.velocity, motion.spin); 2],
            is_new: true,
            last: Load::ZERO,
            load: Load::ZERO,
        }
    }

    /// The motion with which the fluid is to meet it in a step of `dt` \[s\] that begins with `motion`. Nobody sees a ball turn.
    pub(super) fn meet(&mut self, motion: Motion<D>, dt: f64) -> Motion<D> {
        let motion = Motion { orientation: D::Spin::ZERO, ..motion };
        let motion = Motion { orientation: D::Spin::ZERO, ..later(motion, &mut self.seen, 0.5 * dt) };
        self.met = [(motion.velocity, motion.spin), self.met[0]];
        motion
    }

    /// Takes the load of the flow in the step that the fluid has taken.
    pub(super) fn take(&mut self, flow: &Load<D>, covered: &CoveredFluid<D>, around: &Around<'_, D>) {
        let [own, hydrodynamic] = self.radius;
        let volume = D::ball_volume(hydrodynamic) * covered.share;
        let mass = around.flow.inner_density * volume;
        let inertia = D::BALL_INERTIA * mass * hydrodynamic * hydrodynamic;
        if std::mem::take(&mut self.is_new) && mass > 0.0 {
            self.met[1] = (covered.momentum * (1.0 / mass), covered.angular_momentum * (1.0 / inertia));
        }
        let [now, before] = self.met;
        let displaced = around.flow.density * D::ball_volume(own) * covered.share;
        let new = Load {
            force: flow.force + (now.0 - before.0) * (mass / around.dt) - around.gravity * displaced,
            torque: flow.torque + (now.1 - before.1) * (inertia / around.dt),
        };
        self.load = match around.held {
            HeldLoad::OneStep => new,
            HeldLoad::TwoSteps => Load {
                force: (new.force + self.last.force) * 0.5,
                torque: (new.torque + self.last.torque) * 0.5,
            },
        };
        self.last = new;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::D2;
    use granular_core::glam::DVec2;

    /// Of a grain that is half in the fluid, with its hydrodynamic radius half of its own.
    #[test]
    fn weights_are_of_the_whole_grain_and_inertia_of_what_the_fluid_meets() {
        let motion =
            |velocity: f64| Motion::<D2>::new(DVec2::ZERO, DVec2::new(velocity, 0.0), 2.0 * velocity);
        let mut grain = GrainInFluid::new(7, &motion(0.0), 2.0);
        grain.radius = [2.0, 1.0];
        let covered = CoveredFluid::<D2> { share: 0.5, ..CoveredFluid::NONE };
        let around = |held| Around {
            flow: FlowLoads {
                loads: &[],
                covered: &[],
                density: 3.0,
                inner_density: 3.0,
                gravity: DVec2::ZERO,
                spacing: 0.1,
            },
            dt: 0.1,
            gravity: DVec2::new(0.0, -10.0),
            held,
        };
        let flow = Load { force: DVec2::new(1.0, 0.0), torque: 5.0 };
        grain.meet(motion(0.2), 0.1);
        grain.take(&flow, &covered, &around(HeldLoad::OneStep));
        let inner = 0.5 * 3.0 * std::f64::consts::PI;
        let expected = DVec2::new(1.0 + inner * 0.2 / 0.1, 4.0 * inner * 10.0);
        assert!((grain.load.force - expected).length() < 1e-12, "{:?}", grain.load);
        assert!((grain.load.torque - (5.0 + 0.5 * inner * 0.4 / 0.1)).abs() < 1e-12, "{:?}", grain.load);
        // No further change of velocity; the mean of both steps is held.
        grain.meet(motion(0.2), 0.1);
        grain.take(&flow, &covered, &around(HeldLoad::TwoSteps));
        let mean = DVec2::new(1.0 + 0.5 * inner * 0.2 / 0.1, 4.0 * inner * 10.0);
        assert!((grain.load.force - mean).length() < 1e-12, "{:?}", grain.load);
    }
}
