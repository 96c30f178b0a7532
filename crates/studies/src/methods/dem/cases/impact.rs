//! Normal impact of two equal disks.

use granular_core::glam::DVec2;
use granular_core::{Solver, StepError};
use granular_dem::material::{contact_phase, damping_for_restitution};
use granular_dem::{Dem2, Grain, Material, Materials, Options, Setup, Tension};

/// Relative speed \[m/s\].
pub(crate) const SPEED: f64 = 0.1;
const RADIUS: f64 = 0.5e-3;
const STIFFNESS: f64 = 1.6e6;

/// An impact, and how finely it is resolved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impact {
    /// Coefficient of restitution asked for.
    pub(crate) restitution: f64,
    /// Treatment of tension.
    pub(crate) tension: Tension,
    /// Step times the natural frequency.
    pub(crate) phase_step: f64,
}

/// Contact time \[s\] and largest overlap \[m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    pub(crate) time: f64,
    pub(crate) overlap: f64,
}

impl Impact {
    /// Natural frequency of the pair \[1/s\].
    pub(crate) fn frequency() -> f64 {
        let mass = Material::default().density * std::f64::consts::PI * RADIUS * RADIUS;
        (STIFFNESS / (0.5 * mass)).sqrt()
    }

    /// Step \[s\].
    pub(crate) fn dt(&self) -> f64 {
        self.phase_step / Self::frequency()
    }

    /// Contact time of the closed form \[s\].
    pub(crate) fn contact_time(&self) -> f64 {
        let zeta = damping_for_restitution(self.restitution, self.tension);
        contact_phase(zeta, self.tension) / Self::frequency()
    }

    /// Two disks that meet after `gap` steps.
    pub(crate) fn disks(&self, gap: f64) -> Dem2 {
        let fits = "an impact of two disks is in range";
        let mut materials = Materials::new();
        let material = Material {
            restitution: self.restitution,
            friction: 0.0,
            normal_stiffness: STIFFNESS,
            ..Material::default()
        };
        let glass = materials.add(material).expect(fits);
        let apart = DVec2::new(RADIUS + 0.5 * gap * SPEED * self.dt(), 0.0);
        let towards = DVec2::new(0.5 * SPEED, 0.0);
        let grains = vec![
            Grain::at(-apart, RADIUS, glass).moving(towards),
            Grain::at(apart, RADIUS, glass).moving(-towards),
        ];
        let options = Options { tension: self.tension, ..Options::default() };
        Dem2::new(Setup { materials, grains, walls: vec![], gravity: DVec2::ZERO, options }).expect(fits)
    }

    /// Steps from the start until the disks have parted.
    pub(crate) fn steps(&self, gap: f64) -> u64 {
        (gap + self.contact_time() / self.dt()).ceil() as u64 + 2
    }

    /// Restitution measured from a gap of so many steps.
    ///
    /// # Errors
    /// When the solver gives up.
    pub(crate) fn measured(&self, gap: f64) -> Result<f64, StepError> {
        let mut disks = self.disks(gap);
        disks.advance(self.dt(), self.steps(gap))?;
        Ok(-approach(&disks) / SPEED)
    }

    /// Contact time and largest overlap of the trajectory.
    ///
    /// # Errors
    /// When the solver gives up.
    pub(crate) fn course(&self, gap: f64) -> Result<Course, StepError> {
        let mut disks = self.disks(gap);
        let dt = self.dt();
        let mass = 2.0 * STIFFNESS / Self::frequency().powi(2);
        let zeta = damping_for_restitution(self.restitution, self.tension);
        let damping = 2.0 * zeta * (0.5 * mass * STIFFNESS).sqrt();
        // What vanishes at the end of the contact: the force, or with the tension kept the overlap.
        let lasting = |overlap: f64, approach: f64| match self.tension {
            Tension::Cut => STIFFNESS * overlap + damping * approach,
            Tension::Kept => overlap,
        };
        let mut course = Course { time: f64::NAN, overlap: 0.0 };
        let (mut overlap, mut speed) = (overlap_of(&disks), approach(&disks));
        for step in 0..self.steps(gap) {
            disks.advance(dt, 1)?;
            let (next_overlap, next_speed) = (overlap_of(&disks), approach(&disks));
            if speed > 0.0 && next_speed <= 0.0 {
                // The speed falls to zero at this part of the step.
                let part = speed / (speed - next_speed);
                course.overlap = overlap + 0.5 * dt * part * speed;
            }
            let (now, next) = (lasting(overlap, speed), lasting(next_overlap, next_speed));
            if course.overlap > 0.0 && now > 0.0 && next <= 0.0 {
                course.time = (step as f64 + now / (now - next) - gap) * dt;
                break;
            }
            (overlap, speed) = (next_overlap, next_speed);
        }
        Ok(course)
    }
}

fn approach(disks: &Dem2) -> f64 {
    disks.grain(0).velocity.x - disks.grain(1).velocity.x
}

fn overlap_of(disks: &Dem2) -> f64 {
    2.0 * RADIUS - (disks.grain(1).position.x - disks.grain(0).position.x)
}
