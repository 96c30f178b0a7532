//! The motion of grains in the middle of the next step of a fluid.

use granular_core::{Dim, Motion, Spin, Vector};

/// Velocity and spin, and their changes.
pub(crate) type Seen = [[f64; 6]; 2];

/// What is known of a motion when it is first seen.
pub(crate) fn first_seen<D: Dim>(motion: &Motion<D>) -> Seen {
    [numbers(motion), [0.0; 6]]
}

/// Velocity and spin.
fn numbers<D: Dim>(motion: &Motion<D>) -> [f64; 6] {
    let ([u, v, w], [a, b, c]) = (motion.velocity.padded(), motion.spin.components());
    [u, v, w, a, b, c]
}

/// The motion half a step later than `motion`, which is taken note of.
pub(crate) fn later<D: Dim>(motion: Motion<D>, seen: &mut Seen, half: f64) -> Motion<D> {
    let now = numbers(&motion);
    let change: [f64; 6] = std::array::from_fn(|i| now[i] - seen[0][i]);
    let smaller = |i: usize| {
        let [new, old] = [change[i], seen[1][i]];
        if new * old > 0.0 { new.abs().min(old.abs()).copysign(new) } else { 0.0 }
    };
    let by: [f64; 6] = std::array::from_fn(|i| 0.5 * smaller(i));
    *seen = [now, change];
    let faster: D::Vec = Vector::from_slice(&by[..D::N]).expect("one component per axis");
    let turning = D::Spin::of_components([by[3], by[4], by[5]]);
    Motion {
        position: motion.position + (motion.velocity + faster * 0.5) * half,
        velocity: motion.velocity + faster,
        spin: motion.spin + turning,
        orientation: D::rotation_after(motion.orientation, (motion.spin + turning * 0.5) * half),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    #[test]
    fn an_impact_is_not_overshot_and_a_steady_acceleration_is_met() {
        let mut seen = [[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 6]];
        for velocity in [-1.0, -1.0, 0.8, 0.8, 0.8] {
            let motion = Motion::<D2>::new(DVec2::ZERO, DVec2::new(velocity, 0.0), 0.0);
            let found = later(motion, &mut seen, 0.5);
            assert_eq!((found.velocity.x, found.position.x), (velocity, 0.5 * velocity));
        }
        let at = |time: f64| Motion::<D2> {
            position: DVec2::new(0.5 * time * time, 0.0),
            velocity: DVec2::new(time, 0.0),
            spin: -2.0 * time,
            orientation: -time * time,
        };
        let mut seen = [[0.0; 6]; 2];
        for step in 0..3 {
            later(at(f64::from(step)), &mut seen, 0.5);
        }
        assert_eq!(later(at(3.0), &mut seen, 0.5), at(3.5));
    }

    #[test]
    fn an_obstacle_is_turned_as_its_body_is_in_the_middle_of_the_step() {
        let spin = DVec3::new(0.4, -1.0, 0.7);
        let at = |time: f64| Motion::<D3> {
            orientation: spin * time,
            ..Motion::new(DVec3::ZERO, DVec3::ZERO, spin)
        };
        let mut seen = [[0.0, 0.0, 0.0, spin.x, spin.y, spin.z], [0.0; 6]];
        let found = later(at(0.5), &mut seen, 0.125);
        assert!((found.orientation - spin * 0.625).length() < 1e-15);
    }
}
