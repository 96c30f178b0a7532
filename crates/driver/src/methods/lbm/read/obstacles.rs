//! Obstacles of a scene and their paths.

use super::{Reader, vector_of};
use crate::scene::fluid::{ObstacleSpec, PathSpec, ShapeSpec, SurfaceSpec};
use granular_core::units::AngularVelocity;
use granular_core::{D2, Dim, Linear, Spin, Vector};
use granular_coupling::{Body, Path};
use granular_lbm::{Ball, Block, Hole, Obstacle, Polygon, Reference, SolidShape, WallScheme};
use std::sync::Arc;

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
        let shape = self.shape::<D>(&format!("{path}.shape"), &spec.shape)?;
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

    fn shape<D: Dim>(&mut self, path: &str, spec: &ShapeSpec) -> Option<Arc<dyn SolidShape<D>>> {
        match spec {
            ShapeSpec::Ball { centre, radius } => {
                let centre = self.problems.vector::<D, _>(&format!("{path}.centre"), centre);
                let radius = radius.value();
                if radius <= 0.0 {
                    self.problems.add(format!("{path}.radius"), format!("{radius} m"), "above 0", "");
                    return None;
                }
                Some(Arc::new(Ball { centre: centre?, radius }))
            }
            ShapeSpec::Block { low, high } => {
                let low = self.problems.vector::<D, _>(&format!("{path}.low"), low);
                let high = self.problems.vector::<D, _>(&format!("{path}.high"), high);
                let (low, high): (D::Vec, D::Vec) = (low?, high?);
                if (0..D::N).any(|axis| low.component(axis) >= high.component(axis)) {
                    let allowed = "above low along every axis";
                    self.problems.add(format!("{path}.high"), "not above low", allowed, "");
                    return None;
                }
                Some(Arc::new(Block { low, high }))
            }
            ShapeSpec::Polygon(corners) => {
                let corner = |(k, corner): (usize, &Vec<_>)| {
                    self.problems.vector::<D2, _>(&format!("{path}.Polygon.{k}"), corner)
                };
                let corners: Vec<_> = corners.iter().enumerate().map(corner).collect::<Option<_>>()?;
                if corners.len() < 3 {
                    let value = format!("a Polygon of {} corners", corners.len());
                    self.problems.add(path, value, "three corners or more", "");
                    return None;
                }
                Some(Arc::new(Polygon { corners }))
            }
            ShapeSpec::Hole(inner) => Some(Arc::new(Hole(self.shape::<D>(&format!("{path}.Hole"), inner)?))),
        }
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
