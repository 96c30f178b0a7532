//! Body forces, and walls whose velocity varies.

use super::{Extent, Reader};
use crate::scene::fluid::{FaceSpec, ForceSpec, InSpaceSpec, InTimeSpec};
use granular_core::{Dim, Linear, Vector};
use granular_lbm::{BodyForce, Profile};
use std::f64::consts::TAU;

/// A sine: of the coordinate along an axis in space, or of time.
#[derive(Clone, Copy)]
struct Sine {
    axis: usize,
    /// Radians per metre or per second.
    rate: f64,
    phase: f64,
}

/// A force: its size, how it varies in space, how in time.
#[derive(Clone, Copy)]
struct Force<D: Dim> {
    size: D::Vec,
    in_space: Option<Sine>,
    in_time: Option<Sine>,
}

impl<D: Dim> Force<D> {
    fn shape(&self, point: D::Vec) -> D::Vec {
        self.size
            * self.in_space.map_or(1.0, |sine| (sine.rate * point.component(sine.axis) + sine.phase).sin())
    }

    fn factor(&self, time: f64) -> f64 {
        self.in_time.map_or(1.0, |sine| (sine.rate * time + sine.phase).sin())
    }
}

/// Sum of what each force is.
fn sum<D: Dim>(forces: &[Force<D>], of: impl Fn(&Force<D>) -> D::Vec) -> D::Vec {
    forces.iter().map(of).fold(D::Vec::ZERO, |sum, force| sum + force)
}

impl Reader<'_> {
    /// All forces as the cheapest kind that can tell them; the outer none when one makes no sense.
    pub(super) fn forces<D: Dim>(&mut self) -> Option<Option<BodyForce<D>>> {
        let specs = &self.fluid.forces;
        let forces: Vec<Option<Force<D>>> = specs
            .iter()
            .enumerate()
            .map(|(k, spec)| self.force(&format!("fluid.forces.{k}"), spec))
            .collect();
        let forces: Vec<Force<D>> = forces.into_iter().collect::<Option<_>>()?;
        Some(match forces.as_slice() {
            [] => None,
            [force] if force.in_space.is_some() => {
                let force = *force;
                Some(match force.in_time {
                    None => BodyForce::in_space(move |point| force.shape(point)),
                    Some(_) => BodyForce::in_space_times(
                        move |point| force.shape(point),
                        move |time| force.factor(time),
                    ),
                })
            }
            all if all.iter().all(|force| force.in_space.is_none()) => {
                Some(BodyForce::in_time(move |time| sum(&forces, |force| force.size * force.factor(time))))
            }
            all if all.iter().all(|force| force.in_time.is_none()) => {
                Some(BodyForce::in_space(move |point| sum(&forces, |force| force.shape(point))))
            }
            _ => Some(BodyForce::everywhere(move |point, time| {
                sum(&forces, |force| force.shape(point) * force.factor(time))
            })),
        })
    }

    fn force<D: Dim>(&mut self, path: &str, spec: &ForceSpec) -> Option<Force<D>> {
        let size = self.problems.vector::<D, _>(&format!("{path}.acceleration"), &spec.acceleration);
        let in_space = match spec.in_space {
            InSpaceSpec::Uniform => None,
            InSpaceSpec::Sine { along, wavelength, phase } => {
                let axis = along as usize;
                if axis >= D::N {
                    self.problems.add(format!("{path}.in_space.along"), "Z", "X or Y in the plane", "");
                    return None;
                }
                if wavelength.value() <= 0.0 {
                    self.problems.add(format!("{path}.in_space.wavelength"), wavelength, "above 0", "");
                    return None;
                }
                Some(Sine { axis, rate: TAU / wavelength.value(), phase })
            }
        };
        let in_time = match spec.in_time {
            InTimeSpec::Steady => None,
            InTimeSpec::Oscillating { frequency, phase } => {
                if frequency.value() <= 0.0 {
                    let hint = "Steady does not oscillate";
                    self.problems.add(format!("{path}.in_time.frequency"), frequency, "above 0", hint);
                    return None;
                }
                Some(Sine { axis: 0, rate: TAU * frequency.value(), phase })
            }
        };
        Some(Force { size: size?, in_space, in_time })
    }

    /// Velocities along a face that is at rest at its edges.
    pub(super) fn regularised<D: Dim>(&self, peak: D::Vec, axis: usize, extent: Extent<D>) -> Profile<D> {
        let faces = &self.fluid.faces;
        let is_closed = |face: &Option<FaceSpec>| !matches!(face, None | Some(FaceSpec::Periodic));
        let along_y = if D::N == 2 { &faces.bottom } else { &faces.front };
        let closed = [is_closed(&faces.left), is_closed(along_y), is_closed(&faces.bottom)];
        Profile::new(move |point: D::Vec| {
            let across = (0..D::N).filter(|other| *other != axis && closed[*other]);
            let share = across.map(|other| {
                let at = (point - extent.low).component(other) / extent.size.component(other);
                16.0 * (at * (1.0 - at)).powi(2)
            });
            peak * share.product::<f64>()
        })
    }
}
