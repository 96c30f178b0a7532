//! What stages change of the motion of faces and obstacles.

use super::Reader;
use crate::problems::nearest;
use crate::scene::Change;
use granular_core::{Dim, Linear};
use granular_coupling::Body;
use granular_lbm::Setup;

impl Reader<'_> {
    /// Checks the changes; returns the largest speed \[m/s\] that they name.
    pub(super) fn changes<D: Dim>(&mut self, setup: &Setup<D>, bodies: &[(usize, Body<D>)]) -> f64 {
        let mut fastest = 0.0_f64;
        for (k, stage) in self.scene.stages.iter().enumerate() {
            for (c, change) in stage.changes.iter().enumerate() {
                let path = format!("stages.{k}.changes.{c}");
                let speed = match change {
                    Change::FaceVelocity { face, velocity } => {
                        let velocity = self.problems.vector::<D, _>(&format!("{path}.velocity"), velocity);
                        velocity.map(|velocity| self.face_velocity(&path, face, velocity, setup))
                    }
                    Change::ObstacleSpin { obstacle, spin } => {
                        let spin = self.spin::<D>(&format!("{path}.spin"), spin);
                        spin.map(|spin| self.turning(&path, obstacle, spin, (setup, bodies)))
                    }
                    _ => None,
                };
                fastest = fastest.max(speed.unwrap_or(0.0));
            }
        }
        fastest
    }

    fn face_velocity<D: Dim>(&mut self, path: &str, face: &str, velocity: D::Vec, setup: &Setup<D>) -> f64 {
        if let Err(error) = setup.clone().set_face_velocity(face, velocity) {
            let (key, hint) = match error.what.as_str() {
                "name of a face" => ("face", ""),
                "velocity of a wall" => ("velocity", "zero across the face"),
                _ => ("face", "Wall, MovingWall, RegularisedLid, NavierSlip and Inflow have a velocity"),
            };
            self.problems.add(format!("{path}.{key}"), error.value, error.allowed, hint);
        }
        velocity.length()
    }

    fn turning<D: Dim>(
        &mut self,
        path: &str,
        name: &str,
        spin: D::Spin,
        (setup, bodies): (&Setup<D>, &[(usize, Body<D>)]),
    ) -> f64 {
        let place = format!("{path}.obstacle");
        match setup.obstacle_named(name) {
            Ok(number) if bodies.iter().any(|(moving, _)| *moving == number) => {
                let value = format!("`{name}`, which has a path");
                let hint = format!("set fluid.obstacles.{number}.spin");
                self.problems.add(place, value, "an obstacle without a path", hint);
                0.0
            }
            Ok(number) => spin.length() * setup.obstacles[number].shape.reach(),
            Err(error) => {
                let names = setup.obstacles.iter().map(|obstacle| obstacle.name.as_str());
                self.problems.add(place, error.value, error.allowed, nearest(name, names));
                0.0
            }
        }
    }
}

/// The components of an angular velocity about x, y and z, whatever the dimension.
pub(in crate::methods::lbm) fn components(values: &[f64]) -> [f64; 3] {
    match values {
        [z] => [0.0, 0.0, *z],
        _ => std::array::from_fn(|axis| values.get(axis).copied().unwrap_or(0.0)),
    }
}
