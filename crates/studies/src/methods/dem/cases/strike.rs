//! Impacts of elastic grains: on each other, or of one on a rigid plane.

use granular_core::{Dim, Linear, Solver, StepError, Vector};
use granular_dem::material::damping_for_restitution;
use granular_dem::{
    ContactModel, Dem, Elasticity, Grain, HertzImpact, Material, Materials, Options, Setup, Tension, Wall,
};

/// What a rigid plane is made of.
const RIGID: Elasticity = Elasticity { young_modulus: 1e25, poisson_ratio: 0.0 };

/// An impact, and how finely it is resolved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strike {
    /// Elastic constants of the grains.
    pub(crate) elasticity: Elasticity,
    /// Density \[kg/m^3\].
    pub(crate) density: f64,
    /// Radius \[m\].
    pub(crate) radius: f64,
    /// Restitution asked for.
    pub(crate) restitution: f64,
    /// Friction.
    pub(crate) friction: f64,
    /// Whether a grain strikes a rigid plane; else two grains strike each other.
    pub(crate) on_plane: bool,
    /// Velocity along the surface and towards it \[m/s\]; the second grain has the opposite.
    pub(crate) velocity: [f64; 2],
    /// Spin of every grain \[rad/s\].
    pub(crate) spin: f64,
    /// Treatment of tension.
    pub(crate) tension: Tension,
    /// Steps in the duration without damping.
    pub(crate) steps: f64,
}

/// What comes of an impact.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outcome {
    /// Velocity of the first grain along the surface and away from it \[m/s\].
    pub(crate) velocity: [f64; 2],
    /// Its spin \[rad/s\].
    pub(crate) spin: f64,
    /// Largest overlap \[m\].
    pub(crate) overlap: f64,
    /// Largest force \[N\].
    pub(crate) force: f64,
    /// Duration \[s\].
    pub(crate) duration: f64,
}

impl Strike {
    /// Two balls of glass of 1 mm, the restitution of which is asked for.
    pub(crate) fn of_glass(restitution: f64, tension: Tension, speed: f64, steps: f64) -> Self {
        Self {
            elasticity: Elasticity { young_modulus: 7e10, poisson_ratio: 0.25 },
            density: 2650.0,
            radius: 0.5e-3,
            restitution,
            friction: 0.0,
            on_plane: false,
            velocity: [0.0, 0.5 * speed],
            spin: 0.0,
            tension,
            steps,
        }
    }

    /// The normal impact without damping.
    pub(crate) fn elastic<D: Dim>(&self) -> HertzImpact {
        let mass = self.density * D::ball_volume(self.radius);
        let other = if self.on_plane { RIGID } else { self.elasticity };
        let share = if self.on_plane { 1.0 } else { 0.5 };
        HertzImpact {
            effective_modulus: self.elasticity.effective(&other).0,
            effective_radius: share * self.radius,
            effective_mass: share * mass,
            speed: self.velocity[1] / share,
        }
    }

    /// Step \[s\].
    pub(crate) fn dt<D: Dim>(&self) -> f64 {
        self.elastic::<D>().duration(0.0, Tension::Kept) / self.steps
    }

    /// Duration with damping \[s\].
    pub(crate) fn duration<D: Dim>(&self) -> f64 {
        let zeta = damping_for_restitution(self.restitution, self.tension);
        self.elastic::<D>().duration(zeta, self.tension)
    }

    /// The grains `gap` steps before they meet.
    pub(crate) fn grains<D: Dim>(&self, gap: f64) -> Dem<D> {
        let fits = "an impact of grains is in range";
        let mut materials = Materials::new();
        let material = Material {
            density: self.density,
            normal_stiffness: 0.0,
            elasticity: Some(self.elasticity),
            restitution: self.restitution,
            friction: self.friction,
            ..Material::default()
        };
        let own = materials.add(material).expect(fits);
        let rigid = materials.add(Material { elasticity: Some(RIGID), ..material }).expect(fits);
        let [along, towards] = self.velocity;
        let place = D::Vec::along(D::UP, self.radius + gap * towards * self.dt::<D>());
        let velocity = D::Vec::along(0, along) - D::Vec::along(D::UP, towards);
        let spin = if self.friction > 0.0 { self.turning::<D>() } else { D::Spin::ZERO };
        let mut grains = vec![Grain::at(place, self.radius, own).moving(velocity).turning(spin)];
        let mut walls = Vec::new();
        if self.on_plane {
            let up = D::Vec::along(D::UP, 1.0);
            walls.push(Wall::plane("plane", D::Vec::ZERO, up, rigid).expect(fits));
        } else {
            grains.push(Grain::at(-place, self.radius, own).moving(-velocity).turning(spin));
        }
        let options = Options { tension: self.tension, contact: ContactModel::Hertz, ..Options::default() };
        Dem::new(Setup { materials, grains, walls, gravity: D::Vec::ZERO, options }).expect(fits)
    }

    /// The spin that moves the lowest point against the first axis.
    fn turning<D: Dim>(&self) -> D::Spin {
        let down = D::Vec::along(D::UP, -1.0);
        D::cross(down, D::Vec::along(0, -self.spin))
    }

    /// Steps until the grains have parted.
    pub(crate) fn steps_needed<D: Dim>(&self, gap: f64) -> u64 {
        (gap + self.duration::<D>() / self.dt::<D>()).ceil() as u64 + 2
    }

    /// Restitution measured from a gap of so many steps.
    ///
    /// # Errors
    /// When the solver gives up.
    pub(crate) fn measured<D: Dim>(&self, gap: f64) -> Result<f64, StepError> {
        let mut dem = self.grains::<D>(gap);
        dem.advance(self.dt::<D>(), self.steps_needed::<D>(gap))?;
        Ok(dem.grain(0).velocity.component(D::UP) / self.velocity[1])
    }

    /// What comes of it.
    ///
    /// # Errors
    /// When the solver gives up.
    pub(crate) fn outcome<D: Dim>(&self, gap: f64) -> Result<Outcome, StepError> {
        let (mut dem, dt) = (self.grains::<D>(gap), self.dt::<D>());
        let share = if self.on_plane { 1.0 } else { 2.0 };
        let overlap_of = |dem: &Dem<D>| share * (self.radius - dem.grain(0).position.component(D::UP));
        let mut outcome = Outcome::default();
        let mut last = overlap_of(&dem);
        for step in 0..self.steps_needed::<D>(gap) {
            dem.advance(dt, 1)?;
            let overlap = overlap_of(&dem);
            if last > 0.0 && overlap <= 0.0 {
                outcome.duration = (step as f64 + last / (last - overlap) - gap) * dt;
            }
            dem.visit_contacts(&mut |contact| {
                outcome.overlap = outcome.overlap.max(contact.overlap);
                outcome.force = outcome.force.max(contact.normal_force);
            });
            last = overlap;
        }
        let grain = dem.grain(0);
        outcome.velocity = [grain.velocity.component(0), grain.velocity.component(D::UP)];
        let unit = Self { spin: 1.0, ..*self }.turning::<D>();
        outcome.spin = grain.spin.dot(unit);
        Ok(outcome)
    }
}
