//! Bodies that are made hostile, in cells of 1 m; waves run at 1 m/s where nothing else is said.

use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_core::glam::DVec2;
use granular_core::random::Chance;
use granular_core::{D2, SetupError};
use granular_mpm::{Condition, Mpm2, Options, Particle, Setup, Wall};

const DENSITY: f64 = 1.0;
/// Share of the speed of waves at which particles tremble.
const TREMOR: f64 = 1e-6;

/// A block whose particles have random velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trembling {
    /// Particles along an edge of a cell.
    pub(super) along: usize,
    /// Young's modulus of its upper half over that of the lower.
    pub(super) stiffness: f64,
    /// Cells along its edge; an even number.
    pub(super) side: usize,
}

impl Default for Trembling {
    fn default() -> Self {
        Self { along: 3, stiffness: 1.0, side: 6 }
    }
}

/// Elastic, with waves of a speed \[m/s\].
fn rubber(wave: f64, poisson_ratio: f64) -> Result<LinearElastic, SetupError> {
    let share = (1.0 - poisson_ratio) / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
    LinearElastic::new(wave * wave * DENSITY / share, poisson_ratio)
}

impl Trembling {
    /// At a random place between nodes.
    pub(super) fn build(self, options: Options, seed: u64) -> Result<Mpm2, SetupError> {
        let mut random = Chance::new(seed);
        let low = DVec2::new(random.uniform() - 0.5, random.uniform() - 0.5);
        self.at(low, DVec2::ZERO, options, &mut random)
    }

    /// With a speed over that of waves, along no axis.
    pub(super) fn flying(self, speed: f64, options: Options, seed: u64) -> Result<Mpm2, SetupError> {
        let mut random = Chance::new(seed);
        let velocity = speed * DVec2::new(0.8, 0.6);
        self.at(DVec2::ZERO, velocity, options, &mut random)
    }

    /// So placed that its first particles reach by a part into a cell.
    pub(super) fn reaching(self, part: f64, options: Options, seed: u64) -> Result<Mpm2, SetupError> {
        let low = DVec2::splat(-part - 0.5 / self.along as f64);
        self.at(low, DVec2::ZERO, options, &mut Chance::new(seed))
    }

    fn at(
        self,
        low: DVec2,
        velocity: DVec2,
        options: Options,
        random: &mut Chance,
    ) -> Result<Mpm2, SetupError> {
        let mut mpm = Mpm2::new(Setup { options, ..Setup::new(1.0) })?;
        let half = DVec2::new(self.side as f64, 0.5 * self.side as f64);
        // The stiffest has waves of 1 m/s.
        for (part, stiffness) in [(0.0, 1.0 / self.stiffness), (1.0, 1.0)] {
            let low = low + DVec2::new(0.0, part * half.y);
            let mut particles = Particle::<D2>::filling(low, low + half, 1.0 / self.along as f64);
            for particle in &mut particles {
                let tremor = DVec2::new(random.uniform() - 0.5, random.uniform() - 0.5);
                particle.velocity = velocity + 2.0 * TREMOR * tremor;
            }
            mpm.body(rubber(f64::sqrt(stiffness), 0.45)?, DENSITY, &particles)?;
        }
        Ok(mpm)
    }
}

/// A column of soil that falls beside a rough wall, on a rough floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Falling {
    /// \[degrees\]
    pub(super) friction_angle: f64,
    /// \[Pa\]
    pub(super) cohesion: f64,
    /// \[m/s^2\]
    pub(super) gravity: f64,
}

impl Default for Falling {
    fn default() -> Self {
        Self { friction_angle: 30.0, cohesion: 0.0, gravity: 9.81 }
    }
}

impl Falling {
    /// Cells over the height, and height \[m\].
    const CELLS: f64 = 8.0;
    const HEIGHT: f64 = 0.5;

    pub(super) fn build(self, options: Options) -> Result<Mpm2, SetupError> {
        let rough = Condition::frictional(0.4);
        let walls = vec![
            Wall::plane("floor", DVec2::ZERO, DVec2::Y, rough)?,
            Wall::plane("left", DVec2::ZERO, DVec2::X, rough)?,
        ];
        let cell = Self::HEIGHT / Self::CELLS;
        let gravity = DVec2::new(0.0, -self.gravity);
        let mut mpm = Mpm2::new(Setup { gravity, walls, options, ..Setup::new(cell) })?;
        let mut particles = Particle::<D2>::filling(DVec2::ZERO, DVec2::splat(Self::HEIGHT), cell / 3.0);
        // Something moves also where nothing weighs.
        for particle in &mut particles {
            particle.velocity = DVec2::new(particle.position.y, 0.0);
        }
        let friction_angle = self.friction_angle.to_radians();
        let strength = Strength { friction_angle, dilation_angle: 0.0, cohesion: self.cohesion };
        mpm.body(MohrCoulomb::new(LinearElastic::new(1e6, 0.3)?, strength)?, 1600.0, &particles)?;
        Ok(mpm)
    }

    /// Steps of a length \[s\] until the column has fallen, or would have on Earth.
    pub(super) fn steps(self, dt: f64) -> u64 {
        let gravity = if self.gravity > 0.0 { self.gravity } else { 9.81 };
        (1.5 * (2.0 * Self::HEIGHT / gravity).sqrt() / dt).ceil() as u64
    }
}

/// A block whose ends fly apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Torn {
    /// It carries tension.
    Elastic,
    /// It carries none.
    Sand,
}

impl Torn {
    /// With a rate of strain times its size over the speed of waves.
    pub(super) fn torn(self, rate: f64, options: Options) -> Result<Mpm2, SetupError> {
        let mut mpm = Mpm2::new(Setup { options, ..Setup::new(1.0) })?;
        let size = 6.0;
        let mut particles =
            Particle::<D2>::filling(DVec2::splat(-0.5 * size), DVec2::splat(0.5 * size), 1.0 / 3.0);
        for particle in &mut particles {
            particle.velocity = DVec2::new(rate / size * particle.position.x, 0.0);
        }
        let elastic = rubber(1.0, 0.3)?;
        match self {
            Self::Elastic => mpm.body(elastic, DENSITY, &particles)?,
            Self::Sand => {
                mpm.body(MohrCoulomb::new(elastic, Strength::of_friction(0.5))?, DENSITY, &particles)?
            }
        };
        Ok(mpm)
    }
}
