//! Elastic constants, and what follows from them for contacts.

use super::{PairProperties, Tension, contact_phase};
use std::f64::consts::PI;

/// Elastic constants of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    /// Young's modulus \[Pa\].
    pub young_modulus: f64,
    /// Poisson's ratio \[-\], above -1 and at most 0.5.
    pub poisson_ratio: f64,
}

impl Elasticity {
    /// Shear modulus \[Pa\].
    pub fn shear_modulus(&self) -> f64 {
        0.5 * self.young_modulus / (1.0 + self.poisson_ratio)
    }

    /// Effective modulus `E*` and effective shear modulus `G*` of a contact with another material
    /// \[Pa\]: `1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2`, `1/G* = (2 - nu_1)/G_1 + (2 -
    /// nu_2)/G_2` \[Johnson1985\].
    pub fn effective(&self, other: &Self) -> (f64, f64) {
        let normal = |e: &Self| (1.0 - e.poisson_ratio * e.poisson_ratio) / e.young_modulus;
        let shear = |e: &Self| (2.0 - e.poisson_ratio) / e.shear_modulus();
        (1.0 / (normal(self) + normal(other)), 1.0 / (shear(self) + shear(other)))
    }

    /// Tangential over normal stiffness of two bodies of this material, `2 (1 - nu)/(2 - nu)`
    /// \[Mindlin1949\]: the same at every load.
    pub fn stiffness_ratio(&self) -> f64 {
        2.0 * (1.0 - self.poisson_ratio) / (2.0 - self.poisson_ratio)
    }

    /// Linear stiffness of two spheres of this radius \[m\], `4 E r` \[N/m\] \[Kumar2014, eq. 4.3\]:
    /// a rule of thumb that gives the glass of its table 4.2. It is not the slope of any Hertz
    /// contact, which depends on the load.
    pub fn sphere_stiffness(&self, radius: f64) -> f64 {
        4.0 * self.young_modulus * radius
    }

    /// Linear stiffness \[N/m per metre of depth\] of two equal parallel cylinders of this radius
    /// \[m\] that press on each other with a typical `load` \[N per metre of depth\].
    ///
    /// ```text
    /// k = pi G / ((1 - nu)(2 ln(4 r / a) - 1))        a^2 = 2 r (1 - nu) load / (pi G)
    /// ```
    ///
    /// Load over the approach of both centres, with the half-width `a` of Hertz \[Johnson1985,
    /// section 5.6\]: each half cylinder shortens by `load (1 - nu)(2 ln(4 r/a) - 1)/(2 pi G)`.
    /// \[Kumar2014, eq. 4.1\] is that of a cylinder on a rigid plane, twice as stiff, and prints
    /// `2 r/a` in the logarithm where the integral over the strains gives `4 r/a`.
    pub fn cylinder_stiffness(&self, radius: f64, load: f64) -> f64 {
        let shear = self.shear_modulus() / (1.0 - self.poisson_ratio);
        let half_width = (2.0 * radius * load / (PI * shear)).sqrt();
        PI * shear / (2.0 * (4.0 * radius / half_width).ln() - 1.0)
    }

    /// Time in which a Rayleigh wave runs from pole to pole of a sphere of this radius \[m\] and density
    /// \[kg/m^3\]: `pi r sqrt(rho/G)/(0.1631 nu + 0.8766)` \[s\], the usual measure of a step that
    /// does not depend on speeds \[Li2005\].
    pub fn rayleigh_time(&self, radius: f64, density: f64) -> f64 {
        PI * radius * (density / self.shear_modulus()).sqrt() / (0.1631 * self.poisson_ratio + 0.8766)
    }
}

/// The impact of two elastic spheres, or of a sphere and a plane (`R* = r`, `m* = m`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzImpact {
    /// `E*` \[Pa\].
    pub effective_modulus: f64,
    /// `R*` \[m\].
    pub effective_radius: f64,
    /// `m*` \[kg\].
    pub effective_mass: f64,
    /// Relative speed along the normal \[m/s\].
    pub speed: f64,
}

impl HertzImpact {
    /// Largest overlap without damping \[m\]: `(15 m v^2/(16 E sqrt(R)))^(2/5)` \[Johnson1985\].
    /// Damping makes it smaller.
    pub fn largest_overlap(&self) -> f64 {
        let Self { effective_modulus, effective_radius, effective_mass, speed } = *self;
        (15.0 * effective_mass * speed * speed / (16.0 * effective_modulus * effective_radius.sqrt()))
            .powf(0.4)
    }

    /// Largest force without damping \[N\].
    pub fn largest_force(&self) -> f64 {
        let overlap = self.largest_overlap();
        4.0 / 3.0 * self.effective_modulus * (self.effective_radius * overlap).sqrt() * overlap
    }

    /// Duration \[s\] with the damping ratio `zeta` of [`PairProperties::zeta`]; `2.943` times the
    /// largest overlap over the speed without damping.
    ///
    /// With `z = delta^(5/4)` the impact is that of a linear spring (see
    /// [`HertzNormal`](crate::HertzNormal)) in a time `s` with `dt = 4/5 z^(-1/5) ds`, in units of
    /// `((m/K)^2/v)^(1/5)`, `K = 4/3 E sqrt(R)`; integrated numerically, to 1e-5.
    pub fn duration(&self, zeta: f64, tension: Tension) -> f64 {
        let stiffness = 4.0 / 3.0 * self.effective_modulus * self.effective_radius.sqrt();
        let unit = ((self.effective_mass / stiffness).powi(2) / self.speed).powf(0.2);
        unit * scaled_duration(zeta, tension)
    }
}

fn scaled_duration(zeta: f64, tension: Tension) -> f64 {
    // A kept contact that is overdamped never parts: `contact_phase` gives its time scale.
    let zeta = if tension == Tension::Kept { zeta.min(0.999) } else { zeta };
    let frequency = 0.8_f64.sqrt();
    let end = contact_phase(zeta, tension) / frequency;
    let parts = 2000;
    let mut sum = 0.0;
    for k in 0..parts {
        // Places crowd at both ends, where z may vanish.
        let u = (f64::from(k) + 0.5) / f64::from(parts);
        let (place, weight) = (u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u));
        let s = end * place;
        let w = (1.0 - zeta * zeta).abs().sqrt() * frequency;
        let swing = match zeta {
            _ if w * s < 1e-6 => s,
            z if z < 1.0 => (w * s).sin() / w,
            _ => (w * s).sinh() / w,
        };
        let z = (-zeta * frequency * s).exp() * swing;
        sum += weight * z.powf(-0.2);
    }
    0.8 * end * sum / f64::from(parts)
}

impl PairProperties {
    /// The impact of two bodies of this effective radius \[m\] and mass \[kg\] at a relative speed
    /// \[m/s\] in Hertz contact.
    pub fn hertz_impact(&self, effective_radius: f64, effective_mass: f64, speed: f64) -> HertzImpact {
        HertzImpact { effective_modulus: self.effective_modulus, effective_radius, effective_mass, speed }
    }
}

#[cfg(test)]
mod tests;
