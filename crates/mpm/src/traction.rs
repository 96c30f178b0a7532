//! Traction on the surface of a body: forces on the particles that are its surface. They follow the material, wherever it goes.

use crate::mpm::{BodyId, Mpm};
use granular_core::{Blocks, Dim, Linear, SetupError};

/// Particles whose forces are summed at once.
const BLOCK: usize = 4096;

impl<D: Dim> Mpm<D> {
    /// Puts a traction \[Pa\] on the particles of a region, told by their body and place: on each on the face of the square or cube that it
    /// is now, as on a surface along the axes of one layer of particles. It stays as it is, in size and direction, until it is set anew; zero
    /// takes it off. Returns the area of all these faces \[m^2; m in the plane\].
    ///
    /// Forces act at the middles of particles, half of one below the surface.
    ///
    /// # Errors
    /// When it is not finite.
    pub fn set_traction(
        &mut self,
        region: impl Fn(BodyId, D::Vec) -> bool,
        traction: D::Vec,
    ) -> Result<f64, SetupError> {
        if !traction.is_finite() {
            return Err(SetupError::new("traction", f64::NAN, "finite, in Pa"));
        }
        let chosen = self.chosen(region);
        // What loads have done so far counts as put in.
        self.injected += self.level_of_loads();
        let particles = &mut self.particles;
        particles.load.resize(particles.position.len(), D::Vec::ZERO);
        let mut area = 0.0;
        for k in chosen {
            let face = particles.volume[k].powf(1.0 - 1.0 / D::N as f64);
            particles.load[k] = traction * face;
            area += face;
        }
        if particles.load.iter().all(|load| *load == D::Vec::ZERO) {
            particles.load = Vec::new();
        }
        self.injected -= self.level_of_loads();
        Ok(area)
    }

    /// What forces on particles have in store, the wrong way round: force times place \[J\]. Their work is how it grows.
    pub(crate) fn level_of_loads(&self) -> f64 {
        let particles = &self.particles;
        Blocks::new(particles.load.len(), BLOCK).sum(|k| particles.load[k].dot(particles.position[k]))
    }
}
