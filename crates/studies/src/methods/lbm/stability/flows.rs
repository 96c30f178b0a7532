//! Flows that start at full speed.

use granular_core::D2;
use granular_core::glam::DVec2;
use granular_lbm::{D2Q9, Face, Flow, Lbm, Lbm2, OpenScheme, Operator, Profile, Setup, SetupError};
use std::f64::consts::TAU;

/// A flow by its geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Geometry {
    /// Two shear layers one cell thick in a doubly periodic box, with a kick across.
    ShearLayer,
    /// A cavity whose lid moves at full speed from the first step on.
    Cavity,
    /// A jet a quarter of the height wide that enters a channel of fluid at rest through a velocity face; pressure is
    /// given where it leaves.
    Jet(OpenScheme),
}

/// What is run: geometry, scheme and size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) geometry: Geometry,
    pub(super) operator: Operator,
    pub(super) smagorinsky: Option<f64>,
    /// Cells across.
    pub(super) side: usize,
}

/// Speed and viscosity in units of the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    /// Speed, in cells per step.
    pub(super) speed: f64,
    /// Viscosity, in squares of cells per step.
    pub(super) viscosity: f64,
}

impl Geometry {
    pub(super) const ALL: [Self; 4] =
        [Self::ShearLayer, Self::Cavity, Self::Jet(OpenScheme::ZouHe), Self::Jet(OpenScheme::Regularised)];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::ShearLayer => "shear-layer",
            Self::Cavity => "cavity",
            Self::Jet(OpenScheme::ZouHe) => "jet",
            Self::Jet(OpenScheme::Regularised) => "regularised-jet",
        }
    }
}

impl Start {
    /// The flow, ready for its first step.
    pub(super) fn at(&self, state: State) -> Result<Lbm2, SetupError> {
        let side = self.side;
        let long = if matches!(self.geometry, Geometry::Jet(_)) { 2 * side } else { side };
        let mut setup = Setup::<D2>::new([long, side, 1], 1.0, 1.0, 0.5 + 3.0 * state.viscosity);
        (setup.operator, setup.smagorinsky) = (self.operator, self.smagorinsky);
        let speed = state.speed * setup.lattice_speed();
        setup.expected_speed = speed;
        match self.geometry {
            Geometry::ShearLayer => {}
            Geometry::Cavity => {
                setup.faces[0] = [Face::REST, Face::REST];
                setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(speed, 0.0))];
            }
            Geometry::Jet(scheme) => {
                let height = side as f64;
                let profile = move |point: DVec2| {
                    let is_inside = (point.y - 0.5 * height).abs() < 0.125 * height;
                    DVec2::new(if is_inside { speed } else { 0.0 }, 0.0)
                };
                setup.faces[0] = [Face::Velocity(Profile::new(profile), scheme), Face::Pressure(0.0, scheme)];
                setup.faces[1] = [Face::REST, Face::REST];
            }
        }
        let mut lbm = Lbm::<D2Q9, 9>::new(setup)?;
        if self.geometry == Geometry::ShearLayer {
            lbm.set_flow(|point| Flow { pressure: 0.0, velocity: shear(point, side as f64, speed) });
        }
        Ok(lbm)
    }

    /// Steps in which the flow crosses its domain so many times.
    pub(super) fn steps(&self, state: State, crossings: f64) -> u64 {
        (crossings * self.side as f64 / state.speed).ceil() as u64
    }
}

/// Velocity of the shear layers.
fn shear(point: DVec2, side: f64, speed: f64) -> DVec2 {
    let across =
        if point.y < 0.5 * side { (point.y - 0.25 * side).tanh() } else { (0.75 * side - point.y).tanh() };
    let kick = 0.05 * (TAU * (point.x / side + 0.25)).sin();
    DVec2::new(speed * across, speed * kick)
}
