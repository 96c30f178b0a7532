//! Energies, and where they went. Every loss is summed from its own force and velocity; what the ledger misses is shown.

use crate::mpm::Mpm;
use granular_core::{Blocks, Dim, Linear, Vector};

/// Energies \[J; J/m in the plane\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// In the field of gravity, zero at the origin.
    pub potential: f64,
    /// Of motion along each axis.
    pub kinetic: [f64; 3],
    /// Stored by stresses.
    pub elastic: f64,
}

impl Energies {
    /// Of motion along all axes.
    pub fn translational(&self) -> f64 {
        self.kinetic.iter().sum()
    }

    /// All of it.
    pub fn mechanical(&self) -> f64 {
        self.potential + self.translational() + self.elastic
    }
}

/// Losses of energy since the start \[J; J/m in the plane\]; zero unless the ledger is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// To plastic strain.
    pub plastic: f64,
    /// To viscosity of the material.
    pub viscous: f64,
    /// To friction at walls.
    pub friction: f64,
    /// To stopping at walls of what moved into them.
    pub stopping: f64,
    /// To local damping.
    pub damping: f64,
    /// To the share of PIC in the velocity update.
    pub pic: f64,
    /// To friction of bodies in contact.
    pub contact_friction: f64,
    /// To stopping of bodies in contact that approach.
    pub contact_stopping: f64,
    /// To walls that absorb waves.
    pub absorbed: f64,
}

impl Losses {
    /// All of them.
    pub fn total(&self) -> f64 {
        self.to_array().iter().sum()
    }

    pub(crate) fn to_array(self) -> [f64; 9] {
        let Self {
            plastic,
            viscous,
            friction,
            stopping,
            damping,
            pic,
            contact_friction,
            contact_stopping,
            absorbed,
        } = self;
        [plastic, viscous, friction, stopping, damping, pic, contact_friction, contact_stopping, absorbed]
    }

    pub(crate) fn from_array(losses: [f64; 9]) -> Self {
        let [
            plastic,
            viscous,
            friction,
            stopping,
            damping,
            pic,
            contact_friction,
            contact_stopping,
            absorbed,
        ] = losses;
        Self {
            plastic,
            viscous,
            friction,
            stopping,
            damping,
            pic,
            contact_friction,
            contact_stopping,
            absorbed,
        }
    }
}

/// Particles whose energies are summed at once.
const BLOCK: usize = 4096;

impl<D: Dim> Mpm<D> {
    /// Energies of the present state.
    pub fn energies(&self) -> Energies {
        (0..self.groups.len()).map(|group| self.energy_of_group(group)).fold(
            Energies::default(),
            |sum, of| Energies {
                potential: sum.potential + of.potential,
                kinetic: std::array::from_fn(|axis| sum.kinetic[axis] + of.kinetic[axis]),
                elastic: sum.elastic + of.elastic,
            },
        )
    }

    pub(crate) fn energy_of_group(&self, group: usize) -> Energies {
        let (group, particles) = (&self.groups[group], &self.particles);
        let (first, last) = (group.starts[0] as usize, *group.starts.last().unwrap_or(&0) as usize);
        let blocks = Blocks::new(last - first, BLOCK);
        let mass = |k: usize| particles.mass[first + k];
        let kinetic = |axis: usize| {
            blocks.sum(|k| 0.5 * mass(k) * particles.velocity[first + k].component(axis).powi(2))
        };
        let stored = |k: usize| group.body.stored_energy(k, particles.stress(first + k));
        Energies {
            potential: -blocks.sum(|k| mass(k) * particles.position[first + k].dot(self.gravity)),
            kinetic: std::array::from_fn(|axis| if axis < D::N { kinetic(axis) } else { 0.0 }),
            elastic: blocks.sum(|k| particles.volume[first + k] * stored(k)),
        }
    }

    /// What the energy ledger misses \[J\]: energy put in and work of moving walls, less the present energy and all losses.
    /// `None` unless the ledger is kept.
    pub fn energy_residual(&self) -> Option<f64> {
        let put_in = self.injected + self.moving.work + self.level_of_loads();
        self.options.ledger.then(|| put_in - self.energies().mechanical() - self.losses.total())
    }

    /// Work of moving walls on what touches them since the start \[J\]; zero unless the ledger is kept.
    pub fn work_of_walls(&self) -> f64 {
        self.moving.work
    }

    /// Sum of momenta \[kg m/s\].
    pub fn momentum(&self) -> D::Vec {
        let particles = &self.particles;
        (0..self.len()).fold(D::Vec::ZERO, |sum, k| sum + particles.velocity[k] * particles.mass[k])
    }

    /// Sum of angular momenta about the origin \[kg m^2/s\].
    pub fn angular_momentum(&self) -> D::Spin {
        let particles = &self.particles;
        let cell = self.grid.lattice.cell;
        // Affine velocities turn what is around a particle, too.
        let turning = |k: usize| {
            let moments = particles.affine.iter().enumerate().take(D::N);
            let present = moments.filter_map(|(axis, along)| Some((axis, *along.get(k)?)));
            present
                .fold(D::Spin::ZERO, |sum, (axis, moment)| sum + D::cross(D::Vec::along(axis, cell), moment))
        };
        (0..self.len()).fold(D::Spin::ZERO, |sum, k| {
            let orbital = D::cross(particles.position[k], particles.velocity[k]);
            sum + (orbital + turning(k)) * particles.mass[k]
        })
    }

    /// Sum of masses \[kg\].
    pub fn mass(&self) -> f64 {
        Blocks::new(self.len(), BLOCK).sum(|k| self.particles.mass[k])
    }
}
