//! Where a moving wall is and how its surface moves.
//!
//! Shapes stay as they were given; a point of the scene is taken into the frame of the wall instead, so that
//! no tree of facets is ever moved and a wall that returns is where it was, to the last bit.

use crate::dim::{Dim, Linear};

/// A rigid motion of a wall at one instant: turned about a point, then shifted.
#[derive(Clone, Copy, Debug)]
pub struct Pose<D: Dim> {
    /// Shift \[m\].
    pub shift: D::Vec,
    /// Point about which the wall is turned before it is shifted \[m\].
    pub about: D::Vec,
    /// Unit spin about which the wall is turned; any value when it is not.
    pub axis: D::Spin,
    /// Angle by which it is turned.
    pub angle: Turned,
    /// How it moves.
    pub rate: Rate<D>,
    /// The rate at the start of the step, with which the wall moves from the middle of the last step to the
    /// middle of this one.
    pub start_rate: Rate<D>,
}

/// Sine, and one less the cosine, of an angle; the latter from the half angle, so that a small turn is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turned {
    sine: f64,
    versine: f64,
}

impl Turned {
    /// By an angle \[rad\].
    pub fn by(angle: f64) -> Self {
        let half = (0.5 * angle).sin();
        Self { sine: angle.sin(), versine: 2.0 * half * half }
    }
}

/// Velocity of the point about which a wall turns, and the spin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rate<D: Dim> {
    /// Velocity of that point \[m/s\].
    pub velocity: D::Vec,
    /// Angular velocity \[rad/s\].
    pub spin: D::Spin,
}

impl<D: Dim> Default for Pose<D> {
    fn default() -> Self {
        Self {
            shift: D::Vec::ZERO,
            about: D::Vec::ZERO,
            axis: D::Spin::ZERO,
            angle: Turned::default(),
            rate: Rate::default(),
            start_rate: Rate::default(),
        }
    }
}

impl<D: Dim> Pose<D> {
    /// A vector turned with the wall (`sign` 1) or back (`sign` -1). Rodrigues' formula, with the square of
    /// the cross product in place of the axis, so that one line serves plane and space.
    #[inline(always)]
    fn turned(&self, vector: D::Vec, sign: f64) -> D::Vec {
        let once = D::turn(self.axis, vector);
        vector + once * (sign * self.angle.sine) + D::turn(self.axis, once) * self.angle.versine
    }

    fn is_turned(&self) -> bool {
        self.angle != Turned::default()
    }

    /// A point in the frame of the wall.
    #[inline(always)]
    pub fn within_wall(&self, point: D::Vec) -> D::Vec {
        let shifted = point - self.shift;
        if self.is_turned() { self.about + self.turned(shifted - self.about, -1.0) } else { shifted }
    }

    /// Where a point of the frame of the wall is in the scene.
    pub fn out_of_wall_at(&self, point: D::Vec) -> D::Vec {
        self.about + self.out_of_wall(point - self.about) + self.shift
    }

    /// A direction of the frame of the wall in that of the scene.
    #[inline(always)]
    pub fn out_of_wall(&self, direction: D::Vec) -> D::Vec {
        if self.is_turned() { self.turned(direction, 1.0) } else { direction }
    }

    /// Velocity of the wall at a point of the scene, at the middle of the step and at its start.
    #[inline(always)]
    pub fn velocities(&self, point: D::Vec) -> (D::Vec, D::Vec) {
        let arm = point - self.about - self.shift;
        let of = |rate: &Rate<D>| rate.velocity + D::turn(rate.spin, arm);
        (of(&self.rate), of(&self.start_rate))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{D2, D3};
    use glam::{DQuat, DVec2, DVec3};

    #[test]
    fn points_go_into_the_frame_of_a_wall_and_directions_come_back() {
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        let angle = 0.7;
        let (about, shift) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.0, -1.0, 0.5));
        let pose = Pose::<D3> { shift, about, axis, angle: Turned::by(angle), ..Pose::default() };
        let turn = DQuat::from_axis_angle(axis, angle);
        let body = DVec3::new(0.4, -0.3, 0.9);
        let scene = about + turn * (body - about) + shift;
        assert!((pose.within_wall(scene) - body).length() < 1e-15);
        assert!((pose.out_of_wall(body) - turn * body).length() < 1e-15);
        assert!((pose.out_of_wall_at(body) - scene).length() < 1e-15);
        let flat = Pose::<D2> { axis: 1.0, angle: Turned::by(angle), ..Pose::default() };
        let direction = DVec2::from_angle(0.2);
        assert!((flat.out_of_wall(direction) - DVec2::from_angle(0.9)).length() < 1e-15);
    }
}
