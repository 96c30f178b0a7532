//! What a simulation is made of.

use crate::wall::Wall;
use granular_core::{Dim, Linear, SetupError};

/// How a particle is spread over the nodes of its cell and of those around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShapeFunctions {
    /// Hat functions of a point: the least work, and noise whenever a particle crosses a cell \[Sulsky1994\].
    Linear,
    /// Hat functions averaged over a block as large as the particle, which keeps its size and direction: no noise from
    /// crossing, as long as particles do not stretch much \[Bardenhagen2004\].
    #[default]
    UniformGimp,
    /// Quadratic B-splines of a point: smooth, and independent of the size of particles \[Steffen2008\].
    QuadraticBspline,
}

/// When in a step stresses follow strains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Update stress last: strains from velocities at the end of the step. The least work; takes energy out of waves that the
    /// step resolves poorly \[Bardenhagen2002\]. A node with little mass flies off and strains the particles around it, so only
    /// short steps are stable.
    StressLast,
    /// Update stress first: strains from velocities at the start of the step, before forces are taken. Keeps energy, and may gain
    /// some \[Bardenhagen2002\].
    StressFirst,
    /// Modified update stress last: particles hand their new momenta to the nodes before strains are taken, so that nodes with
    /// little mass do not strain particles at random \[Sulsky1995\]. One more pass there and back.
    #[default]
    ModifiedStressLast,
}

/// How particles take their velocities from the nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VelocityUpdate {
    /// Particles take the change of velocity (FLIP), and give up what of their own the nodes do not see at a rate (PIC).
    /// The rate is one over time, so that the damping does not depend on the step: a share `1 - exp(-rate dt)` of a step.
    Flip {
        /// Rate of PIC \[1/s\]; zero for none.
        pic_rate: f64,
    },
    /// Particles take the velocity of the nodes and the moment of it about themselves, and give both back (affine particle in cell):
    /// angular momentum is kept to round-off, and what the nodes do not see is given up \[Jiang2015\]. One more pass there and back, and
    /// a vector for each axis on every particle. Not for linear shape functions, in which the second moment of the nodes about a particle,
    /// by which the moment is divided, vanishes at a node.
    Apic,
}

impl Default for VelocityUpdate {
    fn default() -> Self {
        Self::Flip { pic_rate: 0.0 }
    }
}

impl VelocityUpdate {
    /// A blend in which PIC has this `share` in every step of `reference_step` \[s\]; with other steps the damping in time is
    /// the same.
    ///
    /// # Errors
    /// When the share is not within 0 and 1 (excluded), or the step not positive.
    pub fn blend(share: f64, reference_step: f64) -> Result<Self, SetupError> {
        if !(0.0..1.0).contains(&share) {
            return Err(SetupError::new("share of PIC", share, "from 0 to 1, which is excluded"));
        }
        if !(reference_step > 0.0 && reference_step.is_finite()) {
            return Err(SetupError::new("reference step", reference_step, "positive and finite, in s"));
        }
        Ok(Self::Flip { pic_rate: -(-share).ln_1p() / reference_step })
    }

    /// Share of PIC in a step of `dt` \[s\].
    pub fn pic_share(&self, dt: f64) -> f64 {
        match self {
            Self::Flip { pic_rate } => -(-pic_rate * dt).exp_m1(),
            Self::Apic => 1.0,
        }
    }
}

/// How stress turns with the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ObjectiveRate {
    /// By the rotation that the mean spin of the step makes, an exact rotation \[HughesWinget1980\].
    #[default]
    HughesWinget,
    /// By the spin to first order, `dt (W s - s W)`: the rate of Jaumann.
    Jaumann,
}

/// Choices of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Shape functions.
    pub shape: ShapeFunctions,
    /// When stresses follow strains.
    pub scheme: Scheme,
    /// How particles take their velocities.
    pub velocity_update: VelocityUpdate,
    /// How stress turns with the material.
    pub objective_rate: ObjectiveRate,
    /// Share of the force on a node that acts against its velocity, for gravity loading (0.02 to 0.05) \[Cundall1987\]; zero
    /// for none. A force of this kind is no viscosity: it must be off where a flow matters.
    pub local_damping: f64,
    /// Share of the stable step that is recommended.
    pub courant: f64,
    /// Whether losses of energy are integrated. Costs a few per cent; off unless asked for.
    pub ledger: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            shape: ShapeFunctions::default(),
            scheme: Scheme::default(),
            velocity_update: VelocityUpdate::default(),
            objective_rate: ObjectiveRate::default(),
            local_damping: 0.0,
            courant: 0.5,
            ledger: false,
        }
    }
}

/// All that makes a simulation but the bodies, which [`Mpm::body`](crate::Mpm::body) adds.
#[derive(Clone, Debug)]
pub struct Setup<D: Dim> {
    /// Edge of a cell of the grid \[m\].
    pub cell: f64,
    /// A node of the grid \[m\], which has no end. Walls act at nodes, so they are best laid through them.
    pub origin: D::Vec,
    /// Gravity \[m/s^2\].
    pub gravity: D::Vec,
    /// Walls.
    pub walls: Vec<Wall<D>>,
    /// Choices of the method.
    pub options: Options,
}

impl<D: Dim> Setup<D> {
    /// A grid with a node at the origin, without gravity and walls.
    pub fn new(cell: f64) -> Self {
        let zero = D::Vec::ZERO;
        Self { cell, origin: zero, gravity: zero, walls: Vec::new(), options: Options::default() }
    }

    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let Self { cell, options, .. } = self;
        if !(*cell > 0.0 && cell.is_finite()) {
            return Err(SetupError::new("cell", *cell, "positive and finite, in m"));
        }
        if !self.origin.is_finite() || !self.gravity.is_finite() {
            return Err(SetupError::new("origin or gravity", f64::NAN, "finite"));
        }
        if !(options.courant > 0.0 && options.courant <= 1.0) {
            return Err(SetupError::new("Courant number", options.courant, "more than 0, and at most 1"));
        }
        match options.velocity_update {
            VelocityUpdate::Flip { pic_rate } if !(pic_rate >= 0.0 && pic_rate.is_finite()) => {
                return Err(SetupError::new("rate of PIC", pic_rate, "zero or more 1/s, and finite"));
            }
            VelocityUpdate::Apic if options.shape == ShapeFunctions::Linear => {
                let what =
                    "second moment of the nodes about a particle on one of them, by which Apic divides,";
                return Err(SetupError::new(
                    what,
                    0.0,
                    "more than 0: take the shape UniformGimp or QuadraticBspline",
                ));
            }
            _ => {}
        }
        check_damping(options.local_damping)?;
        self.walls.iter().try_for_each(Wall::check)
    }
}

pub(crate) fn check_damping(share: f64) -> Result<(), SetupError> {
    if (0.0..1.0).contains(&share) {
        return Ok(());
    }
    Err(SetupError::new("local damping", share, "from 0 to 1, which is excluded"))
}
