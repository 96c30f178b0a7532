//! One ball above or on a plane wall: x along the plane, the upward axis away from it.

use granular_core::{Dim, Linear, Solver, StepError, Vector};
use granular_dem::{Dem, Grain, Material, Materials, Options, Setup, Wall};

/// A ball and its surroundings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    /// Radius \[m\].
    pub(super) radius: f64,
    /// Of ball and plane.
    pub(super) material: Material,
    /// Distance of the surfaces \[m\]; negative for an overlap.
    pub(super) gap: f64,
    /// Velocity along the plane and away from it \[m/s\].
    pub(super) velocity: [f64; 2],
    /// Gravity along the plane and away from it \[m/s^2\].
    pub(super) gravity: [f64; 2],
}

impl Ball {
    /// Mass \[kg\].
    pub(super) fn mass<D: Dim>(&self) -> f64 {
        self.material.density * D::ball_volume(self.radius)
    }

    /// Natural frequency of the contact with the plane \[1/s\].
    pub(super) fn frequency<D: Dim>(&self) -> f64 {
        (self.material.normal_stiffness / self.mass::<D>()).sqrt()
    }

    /// Starts with the overlap that carries the weight.
    pub(super) fn at_rest_on_plane<D: Dim>(self) -> Self {
        let weight = -self.mass::<D>() * self.gravity[1];
        Self { gap: -weight / self.material.normal_stiffness, ..self }
    }

    /// The simulation.
    pub(super) fn on_plane<D: Dim>(&self) -> Rolling<D> {
        let fits = "the set-ups of validation cases are in range";
        let vector = |[along, up]: [f64; 2]| D::Vec::along(0, along) + D::Vec::along(D::UP, up);
        let mut materials = Materials::new();
        let material = materials.add(self.material).expect(fits);
        let center = D::Vec::along(D::UP, self.radius + self.gap);
        let wall = Wall::plane("plane", D::Vec::ZERO, D::Vec::along(D::UP, 1.0), material);
        let dem = Dem::new(Setup {
            materials,
            grains: vec![Grain::at(center, self.radius, material).moving(vector(self.velocity))],
            walls: vec![wall.expect(fits)],
            gravity: vector(self.gravity),
            options: Options::default(),
        });
        Rolling { dem: dem.expect(fits) }
    }
}

/// A ball that moves over a plane.
pub(super) struct Rolling<D: Dim> {
    dem: Dem<D>,
}

impl<D: Dim> Rolling<D> {
    /// Takes one step.
    pub(super) fn step(&mut self, dt: f64) -> Result<(), StepError> {
        self.dem.advance(dt, 1)
    }

    /// Takes many steps.
    pub(super) fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        self.dem.advance(dt, steps)
    }

    /// Speed along the plane \[m/s\].
    pub(super) fn speed(&self) -> f64 {
        self.dem.grain(0).velocity.component(0)
    }

    /// Speed away from the plane \[m/s\].
    pub(super) fn rise(&self) -> f64 {
        self.dem.grain(0).velocity.component(D::UP)
    }

    /// Distance of the surfaces \[m\].
    pub(super) fn gap(&self) -> f64 {
        let grain = self.dem.grain(0);
        grain.position.component(D::UP) - grain.radius
    }

    /// Angular speed \[rad/s\].
    pub(super) fn turning(&self) -> f64 {
        self.dem.grain(0).spin.length()
    }

    /// Speed of the contact point along the plane \[m/s\].
    pub(super) fn slip(&self) -> f64 {
        let grain = self.dem.grain(0);
        let arm = D::Vec::along(D::UP, -grain.radius - 0.5 * self.gap().min(0.0));
        (grain.velocity + D::turn(grain.spin, arm)).component(0)
    }
}
