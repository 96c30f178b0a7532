//! Obstacles of a scene and their paths.

use super::{Reader, vector_of};
use crate::scene::fluid::{ObstacleSpec, PathSpec, ShapeSpec, SurfaceSpec};
use crate::solids::solid;
use granular_core::units::AngularVelocity;
use granular_core::{Dim, Linear, Spin};
use granular_coupling::{Body, Path};
use granular_lbm::{Obstacle, Reference, WallScheme};

impl Reader<'_> {
    pub(super) fn obstacle<D: Dim>(
        &mut self,
        number: usize,
        spec: &ObstacleSpec,
    ) -> Option<(Obstacle<D>, Option<Body<D>>)> {
        let path = format!("fluid.obstacles.{number}");
        let before = &self.fluid.obstacles[..number];
        if before.iter().any(|other| other.name == spec.name) {
            self.problems.add(
                format!("{path}.name"),
                format!("`{}` again", spec.name),
                "a name of its own",
                "",
            );
        }
        let shape = solid::<D>(&format!("{path}.shape"), &spec.shape, self.problems)?;
        let spin = self.spin::<D>(&format!("{path}.spin"), &spec.spin)?;
        let body = match &spec.path {
            Some(way) => Some(self.body(&path, way, &spec.shape, spin)?),
            None => None,
        };
        let motion = body.map(|body: Body<D>| body.motion(0.0));
        let reference = spec
            .reference
            .map(|reference| Reference { speed: reference.speed.value(), length: reference.length.value() });
        if let Some(Reference { speed, length }) = reference
            && !(speed > 0.0 && length > 0.0)
        {
            self.problems.add(format!("{path}.reference"), format!("{speed} m/s, {length} m"), "above 0", "");
        }
        let centre = shape.centre();
        let obstacle = Obstacle {
            name: spec.name.clone(),
            displacement: motion.map_or(D::Vec::ZERO, |motion| motion.position - centre),
            velocity: motion.map_or(D::Vec::ZERO, |motion| motion.velocity),
            shape,
            wall: match spec.surface {
                SurfaceSpec::Interpolated => WallScheme::Bouzidi,
                SurfaceSpec::Yu => WallScheme::Yu,
                SurfaceSpec::HalfWay => WallScheme::HalfWay,
            },
            spin,
            reference,
        };
        Some((obstacle, body))
    }

    pub(in crate::methods::lbm) fn spin<D: Dim>(
        &mut self,
        path: &str,
        values: &[AngularVelocity],
    ) -> Option<D::Spin> {
        let numbers: Vec<f64> = values.iter().map(|value| value.value()).collect();
        match (D::N, numbers.as_slice()) {
            (_, []) => Some(D::Spin::ZERO),
            (2, [rate]) => Some(D::Spin::about_z(*rate)),
            (3, [x, y, z]) => Some(D::Spin::of_components([*x, *y, *z])),
            _ => {
                let allowed = "one value in the plane, three components in space";
                self.problems.add(path, format!("a list of {}", values.len()), allowed, "");
                None
            }
        }
    }

    fn body<D: Dim>(
        &mut self,
        path: &str,
        way: &PathSpec,
        shape: &ShapeSpec,
        spin: D::Spin,
    ) -> Option<Body<D>> {
        let place = format!("{path}.path");
        let ShapeSpec::Ball { centre, radius } = shape else {
            let value = "the path of a shape that is not a Ball";
            self.problems.add(place, value, "a path of a Ball", "what turns in its place has a spin instead");
            return None;
        };
        let way = match way {
            PathSpec::Steady(velocity) => Path::Steady(self.problems.vector::<D, _>(&place, velocity)?),
            PathSpec::Oscillation { amplitude, frequency, phase } => Path::Oscillation {
                amplitude: self.problems.vector::<D, _>(&format!("{place}.amplitude"), amplitude)?,
                frequency: frequency.value(),
                phase: *phase,
            },
            PathSpec::Orbit { centre, rate } => Path::Orbit {
                centre: self.problems.vector::<D, _>(&format!("{place}.centre"), centre)?,
                rate: self.spin::<D>(&format!("{place}.rate"), rate)?,
            },
        };
        let centre = vector_of::<D, _>(centre)?;
        Some(Body { place: centre, radius: radius.value(), path: way, spin })
    }
}
