//! What a scene says of a fluid, in the terms of the lattice.

mod changes;
mod forces;
mod obstacles;
mod spacing;

use crate::machine::room_for;
use crate::problems::{Problems, quoted};
use crate::scene::Scene;
use crate::scene::coupling::CouplingSpec;
use crate::scene::fluid::{FaceSpec, FacesSpec, FluidSpec, ProfileSpec, StartSpec};
pub(super) use changes::components;
use granular_core::units::{Measured, Unit, Velocity};
use granular_core::{Dim, Linear, Vector};
use granular_coupling::Body;
use granular_lbm::spec::{LbmSpec, PrecisionSpec, StepSpec};
use granular_lbm::{Face, Gauge, OpenScheme, PressureLevel, Profile, Setup};
use std::sync::Arc;

/// How far a size over the spacing may be off a whole number.
const FIT: f64 = 1e-6;

/// Velocities over places.
type Field<D> = Arc<dyn Fn(<D as Dim>::Vec) -> <D as Dim>::Vec + Send + Sync>;

/// A fluid, ready for the lattice.
pub(super) struct Fluid<D: Dim> {
    pub(super) setup: Setup<D>,
    pub(super) start: Field<D>,
    /// Numbers of the obstacles that move, with their paths.
    pub(super) bodies: Vec<(usize, Body<D>)>,
}

pub(super) struct Reader<'a> {
    pub(super) scene: &'a Scene,
    pub(super) fluid: &'a FluidSpec,
    pub(super) spec: &'a LbmSpec,
    pub(super) name: &'a str,
    pub(super) problems: &'a mut Problems,
}

/// A box in the scene.
#[derive(Clone, Copy)]
struct Extent<D: Dim> {
    pub(super) low: D::Vec,
    pub(super) size: D::Vec,
}

impl Reader<'_> {
    pub(super) fn read<D: Dim>(&mut self) -> Option<Fluid<D>> {
        self.check_positive();
        let extent = self.extent::<D>()?;
        let faces = self.faces(extent);
        let (cells, origin) = self.cells(extent, &faces)?;
        let gravity = match self.scene.gravity.as_slice() {
            [] => Some(D::Vec::ZERO),
            values => self.problems.vector::<D, _>("gravity", values),
        };
        let mut obstacles = Vec::new();
        let mut bodies = Vec::new();
        for (k, spec) in self.fluid.obstacles.iter().enumerate() {
            let (obstacle, path) = self.obstacle::<D>(k, spec)?;
            obstacles.push(obstacle);
            bodies.extend(path.map(|body| (k, body)));
        }
        let start = self.start::<D>(&faces)?;
        let gauges = self.gauges::<D>(extent);
        let mut setup = Setup::new(cells, self.spec.spacing.value(), self.fluid.viscosity.value(), 1.0);
        setup.origin = origin;
        setup.density = self.fluid.density.value();
        setup.acceleration = gravity?;
        setup.pressure = self.pressure();
        setup.body_force = self.forces::<D>()?;
        setup.operator = self.spec.operator.into();
        setup.smagorinsky = self.spec.smagorinsky;
        setup.faces = faces;
        setup.obstacles = obstacles;
        setup.gauges = gauges;
        let turning = setup.obstacles.iter().map(|body| body.spin.length() * body.shape.reach());
        let later = self.changes(&setup, &bodies);
        let named = bodies.iter().map(|(_, body)| body.fastest()).chain(turning).chain([later]);
        let named = named.chain([self.largest_speed::<D>()]);
        let speed = self.fluid.largest_speed.map(|speed| speed.value());
        setup.expected_speed = speed.unwrap_or(named.fold(0.0, f64::max));
        setup.time_step = self.time_step(setup.expected_speed)?;
        // Faces and obstacles as they are at the start count in any case; so do those that stages change.
        setup.expected_speed = setup.expected_speed.max(later);
        Some(Fluid { setup, start, bodies })
    }

    /// A fluid around grains has no weight of its own: it would first slosh as sound, and be denser below. Their buoyancy follows from
    /// gravity all the same.
    fn pressure(&self) -> PressureLevel {
        let resolves =
            |law: &CouplingSpec| matches!(law, CouplingSpec::Resolved { fluid, .. } if fluid == self.name);
        let is_around_grains = self.scene.couplings.iter().any(resolves);
        if is_around_grains { PressureLevel::AboveHydrostatic } else { PressureLevel::Whole }
    }

    fn check_positive(&mut self) {
        let (fluid, solver) = (self.fluid, self.name);
        if fluid.viscosity.value() <= 0.0 {
            self.problems.add("fluid.viscosity", fluid.viscosity, "above 0", "");
        }
        if fluid.density.value() <= 0.0 {
            self.problems.add("fluid.density", fluid.density, "above 0", "");
        }
        if let Some(speed) = fluid.largest_speed.filter(|speed| speed.value() <= 0.0) {
            self.problems.add("fluid.largest_speed", speed, "above 0", "");
        }
        if self.spec.spacing.value() <= 0.0 {
            self.problems.add(format!("solvers.{solver}.spacing"), self.spec.spacing, "above 0", "");
        }
        if let Some(constant) = self.spec.smagorinsky.filter(|constant| *constant < 0.0) {
            self.problems.add(
                format!("solvers.{solver}.smagorinsky"),
                constant,
                "0 or more",
                "0.1 is common",
            );
        }
    }

    fn extent<D: Dim>(&mut self) -> Option<Extent<D>> {
        let low = match self.fluid.low.as_slice() {
            [] => Some(D::Vec::ZERO),
            values => self.problems.vector::<D, _>("fluid.low", values),
        };
        let size = self.problems.vector::<D, _>("fluid.size", &self.fluid.size)?;
        if let Some(axis) = (0..D::N).find(|axis| size.component(*axis) <= 0.0) {
            let value = self.fluid.size[axis];
            self.problems.add(format!("fluid.size.{axis}"), value, "a positive length", "");
            return None;
        }
        Some(Extent { low: low?, size })
    }

    /// Cells along each axis and the corner of the first. Velocities and pressures are given at the centres of the
    /// outermost cells: along an axis that is open at both ends these lie on the faces of the box.
    fn cells<D: Dim>(
        &mut self,
        extent: Extent<D>,
        faces: &[[Face<D>; 2]; 3],
    ) -> Option<([usize; 3], D::Vec)> {
        let spacing = self.spec.spacing.value();
        let (mut cells, mut origin) = ([1; 3], extent.low);
        for axis in 0..D::N {
            let size = extent.size.component(axis);
            let count = (size / spacing).round().max(1.0);
            if !(spacing > 0.0 && count < 1e9) || (size / spacing - count).abs() > FIT * count {
                let value = format!("{spacing} m, which does not divide fluid.size.{axis} of {size} m");
                let sizes: Vec<f64> = (0..D::N).map(|axis| extent.size.component(axis)).collect();
                let hint = spacing::advice(&sizes, spacing);
                let path = format!("solvers.{}.spacing", self.name);
                self.problems.add(path, value, "a length that divides all sizes", hint);
                return None;
            }
            cells[axis] = count as usize;
            let is_open = |face: &Face<D>| {
                matches!(face, Face::Velocity(..) | Face::Pressure(..) | Face::Absorbing { .. })
            };
            if faces[axis].iter().all(is_open) {
                cells[axis] += 1;
                origin -= D::Vec::along(axis, 0.5 * spacing);
            }
        }
        let count: f64 = cells.iter().map(|&along| along as f64).product();
        if let Err(allowed) = room_for(count, self.bytes_per_cell::<D>()) {
            let value = format!("{spacing} m, which makes {count:.0} cells");
            self.problems.add(
                format!("solvers.{}.spacing", self.name),
                value,
                allowed,
                "a larger one makes fewer",
            );
            return None;
        }
        Some((cells, origin))
    }

    /// Memory that a cell takes while the lattice is made: its populations, its place, and whether it is covered \[bytes\].
    fn bytes_per_cell<D: Dim>(&self) -> f64 {
        let populations = if D::N == 2 { 9.0 } else { 19.0 };
        let number = match self.spec.precision {
            PrecisionSpec::Double => 8.0,
            PrecisionSpec::Single => 4.0,
        };
        populations * number + 50.0
    }

    fn faces<D: Dim>(&mut self, extent: Extent<D>) -> [[Face<D>; 2]; 3] {
        let specs = self.fluid.faces.clone();
        let names: [[&str; 2]; 3] = match D::N {
            2 => [["left", "right"], ["bottom", "top"], ["front", "back"]],
            _ => [["left", "right"], ["front", "back"], ["bottom", "top"]],
        };
        let of = |name| match name {
            "left" => &specs.left,
            "right" => &specs.right,
            "front" => &specs.front,
            "back" => &specs.back,
            "bottom" => &specs.bottom,
            _ => &specs.top,
        };
        std::array::from_fn(|axis| {
            [0, 1].map(|side| {
                let name = names[axis][side];
                match of(name) {
                    Some(_) if axis >= D::N => {
                        let path = format!("fluid.faces.{name}");
                        self.problems.add(path, "given", "left, right, bottom and top in the plane", "");
                        Face::Periodic
                    }
                    Some(spec) => self.face(spec, name, (axis, side), extent).unwrap_or(Face::Periodic),
                    None => Face::Periodic,
                }
            })
        })
    }

    fn face<D: Dim>(
        &mut self,
        spec: &FaceSpec,
        name: &str,
        (axis, side): (usize, usize),
        extent: Extent<D>,
    ) -> Option<Face<D>> {
        let path = format!("fluid.faces.{name}");
        Some(match spec {
            FaceSpec::Periodic => Face::Periodic,
            FaceSpec::Wall => Face::Wall(D::Vec::ZERO),
            FaceSpec::MovingWall(velocity) => Face::Wall(self.problems.vector::<D, _>(&path, velocity)?),
            FaceSpec::RegularisedLid(velocity) => {
                let velocity = self.problems.vector::<D, _>(&path, velocity)?;
                Face::WallProfile(self.regularised(velocity, axis, extent))
            }
            FaceSpec::NavierSlip { length, velocity } => {
                let velocity = match velocity.as_slice() {
                    [] => D::Vec::ZERO,
                    velocity => self.problems.vector::<D, _>(&format!("{path}.velocity"), velocity)?,
                };
                if length.value() < 0.0 {
                    self.problems.add(format!("{path}.length"), length, "0 or more", "");
                }
                Face::NavierSlip { length: length.value(), velocity }
            }
            FaceSpec::FreeSlip => Face::FreeSlip,
            FaceSpec::Inflow(ProfileSpec::Uniform(velocity)) => {
                let velocity = self.problems.vector::<D, _>(&path, velocity)?;
                Face::Velocity(Profile::uniform(velocity), OpenScheme::Regularised)
            }
            FaceSpec::Inflow(ProfileSpec::Parabola { peak }) => {
                let way = if side == 0 { 1.0 } else { -1.0 };
                let peak = D::Vec::along(axis, way * peak.value());
                let parabola = move |point: D::Vec| {
                    let share = (0..D::N).filter(|other| *other != axis).map(|other| {
                        let at = (point - extent.low).component(other) / extent.size.component(other);
                        4.0 * at * (1.0 - at)
                    });
                    peak * share.product::<f64>()
                };
                Face::Velocity(Profile::new(parabola), OpenScheme::Regularised)
            }
            FaceSpec::Absorbing(pressure) => Face::absorbing(pressure.value()),
            FaceSpec::Outflow(pressure) => Face::Pressure(pressure.value(), OpenScheme::Regularised),
        })
    }

    /// Largest speed that faces and the start name \[m/s\].
    fn largest_speed<D: Dim>(&self) -> f64 {
        let FacesSpec { left, right, front, back, bottom, top } = &self.fluid.faces;
        let length = |velocity: &[Velocity]| vector_of::<D, _>(velocity).map_or(0.0, Linear::length);
        let faces = [left, right, front, back, bottom, top].into_iter().flatten().map(|face| match face {
            FaceSpec::MovingWall(velocity)
            | FaceSpec::RegularisedLid(velocity)
            | FaceSpec::NavierSlip { velocity, .. }
            | FaceSpec::Inflow(ProfileSpec::Uniform(velocity)) => length(velocity),
            FaceSpec::Inflow(ProfileSpec::Parabola { peak }) => peak.value().abs(),
            _ => 0.0,
        });
        let start = match &self.fluid.start {
            StartSpec::Uniform(velocity) => length(velocity),
            _ => 0.0,
        };
        faces.fold(start, f64::max)
    }

    fn start<D: Dim>(&mut self, faces: &[[Face<D>; 2]; 3]) -> Option<Field<D>> {
        Some(match &self.fluid.start {
            StartSpec::Rest => Arc::new(|_| D::Vec::ZERO),
            StartSpec::Uniform(velocity) => {
                let velocity = self.problems.vector::<D, _>("fluid.start", velocity)?;
                Arc::new(move |_| velocity)
            }
            StartSpec::LikeInflow => match &faces[0][0] {
                Face::Velocity(profile, _) => {
                    let profile = profile.clone();
                    Arc::new(move |point| profile.at(point))
                }
                _ => {
                    let value = "LikeInflow without an Inflow";
                    self.problems.add("fluid.start", value, "an Inflow at fluid.faces.left", "");
                    return None;
                }
            },
        })
    }

    /// The gauges; those outside the box would show no number.
    fn gauges<D: Dim>(&mut self, extent: Extent<D>) -> Vec<Gauge<D>> {
        let mut gauges = Vec::new();
        for (name, place) in &self.fluid.gauges {
            let path = format!("fluid.gauges.{}", quoted(name));
            let Some(place) = self.problems.vector::<D, _>(&path, place) else { continue };
            let outside = (0..D::N).find(|&axis| {
                let (low, size) = (extent.low.component(axis), extent.size.component(axis));
                !(low - FIT * size..=low + size + FIT * size).contains(&place.component(axis))
            });
            if let Some(axis) = outside {
                let (low, size) = (extent.low.component(axis), extent.size.component(axis));
                let axis_name = D::AXES[axis];
                let value = format!("at {axis_name} = {} m, outside the fluid", place.component(axis));
                let (low, high) = (spacing::short(low), spacing::short(low + size));
                let allowed = format!("{axis_name} from {low} to {high} m");
                self.problems.add(path, value, allowed, "");
                continue;
            }
            gauges.push(Gauge { name: name.clone(), place });
        }
        gauges
    }

    fn time_step(&mut self, speed: f64) -> Option<f64> {
        let path = format!("solvers.{}.step", self.name);
        match self.spec.step {
            StepSpec::Mach(mach) if mach.is_nan() || mach <= 0.0 => {
                self.problems.add(path, mach, "above 0 and at most 0.3", "");
            }
            StepSpec::Mach(_) if speed <= 0.0 => {
                let hint = "set fluid.largest_speed, or step: RelaxationTime(0.8)";
                let value = "a Mach number of a flow whose speed nothing names";
                self.problems.add(path, value, "a step for a known speed", hint);
            }
            StepSpec::RelaxationTime(tau) if tau.is_nan() || tau <= 0.5 => {
                self.problems.add(path, tau, "above 0.5 steps", "0.6 to 1 is common");
            }
            StepSpec::Time(time) if time.value() <= 0.0 => {
                self.problems.add(path, time, "a positive time", "");
            }
            _ => return Some(self.spec.time_step(self.fluid.viscosity.value(), speed)),
        }
        None
    }
}

fn vector_of<D: Dim, U: Unit>(values: &[Measured<U>]) -> Option<D::Vec> {
    D::Vec::from_slice(&values.iter().map(|value| value.value()).collect::<Vec<_>>())
}
