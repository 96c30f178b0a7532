//! Grains that others put into the fluid, and the loads that they get back.

use crate::immersed::{Immersed, Surroundings, speed_of};
use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::moving::FASTEST;
use crate::obstacle::Domain;
use crate::real::Real;
use crate::setup::Setup;
use granular_core::quantity::{CoveredFluid, FlowLoad, FlowLoads, ImmersedGrain, ImmersedGrains, Load};
use granular_core::{Accepts, Dim, Motion, Provides, Section, SnapshotError, Solver, StepError};

impl<L: Lattice<Q>, const Q: usize, T: Real> Provides<ImmersedGrains<L::Dim>> for Lbm<L, Q, T> {
    fn view(&self) -> &[ImmersedGrain<L::Dim>] {
        &self.immersed.given
    }
}

/// Grains that cover cells in part are met by partially saturated cells \[NobleTorczynski1998\], with any collision operator.
/// What stays where it is costs no search for the cells that it covers. Grains may touch and overlap; what lies beyond a
/// face or in an obstacle is not fluid and is left out.
impl<L: Lattice<Q>, const Q: usize, T: Real> Accepts<ImmersedGrains<L::Dim>> for Lbm<L, Q, T> {
    fn enable(&mut self) {
        self.immersed.is_on = true;
    }

    fn view_mut(&mut self) -> &mut Vec<ImmersedGrain<L::Dim>> {
        self.immersed.is_on = true;
        &mut self.immersed.given
    }
}

/// Grains are filled with fluid, which moves with them.
impl<L: Lattice<Q>, const Q: usize, T: Real> Provides<FlowLoad<L::Dim>> for Lbm<L, Q, T> {
    fn view(&self) -> FlowLoads<'_, L::Dim> {
        let Setup { density, spacing, acceleration: gravity, .. } = self.setup;
        let Immersed { loads, covered, .. } = &self.immersed;
        FlowLoads { loads, covered, density, inner_density: density, gravity, spacing }
    }
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Takes up the grains that were given since the last step.
    pub(crate) fn meet_immersed_grains(&mut self) -> Result<(), StepError> {
        if self.immersed.given != self.immersed.met {
            self.check_immersed()?;
        }
        self.find_covered_cells();
        Ok(())
    }

    fn find_covered_cells(&mut self) {
        let Self { immersed, setup, populations, runs, .. } = self;
        immersed.meet(&Surroundings { setup, grid: &populations.grid, fluid: runs });
    }

    fn check_immersed(&self) -> Result<(), StepError> {
        let domain = Domain::of(&self.setup);
        for (k, grain) in self.immersed.given.iter().enumerate() {
            if !(grain.motion.is_finite() && grain.radius > 0.0 && grain.radius.is_finite()) {
                let (solver, quantity) = (self.name(), "motion or radius of a grain in the fluid");
                return Err(StepError::NotFinite { solver, quantity, id: k as u64, step: self.steps });
            }
            let speed = speed_of(grain) / self.setup.lattice_speed();
            if speed > FASTEST {
                return Err(StepError::TooStiff {
                    what: format!(
                        "speed of grain {k} in the fluid in cells per step after step {}",
                        self.steps
                    ),
                    value: speed,
                    allowed: FASTEST,
                    hint: "take a smaller step of the fluid".to_owned(),
                });
            }
            let periods = (0..L::Dim::N).filter(|axis| domain.is_periodic[*axis]);
            let shortest = periods.map(|axis| domain.cells[axis]).min();
            if let Some(cells) = shortest
                .map(|cells| cells as f64)
                .filter(|cells| 2.0 * grain.radius / domain.spacing > *cells)
            {
                return Err(StepError::TooStiff {
                    what: format!("diameter of grain {k} in cells of a periodic domain"),
                    value: 2.0 * grain.radius / domain.spacing,
                    allowed: cells,
                    hint: "a grain must not meet itself: take a larger domain".to_owned(),
                });
            }
        }
        Ok(())
    }

    /// Share of each cell that grains in the fluid cover, x fastest.
    pub fn grain_shares(&self) -> Vec<f64> {
        self.immersed.shares(&self.populations.grid)
    }

    /// Saves grains and loads, where anybody may put grains.
    pub(crate) fn save_immersed(&self, to: &mut Section) {
        if !self.immersed.is_on {
            return;
        }
        let motions = || self.immersed.met.iter().map(|grain| grain.motion);
        let positions: Vec<_> = motions().map(|motion| motion.position).collect();
        let velocities: Vec<_> = motions().map(|motion| motion.velocity).collect();
        let spins: Vec<_> = motions().map(|motion| motion.spin).collect();
        let radii: Vec<_> = self.immersed.met.iter().map(|grain| grain.radius).collect();
        let loads: Vec<_> = self.immersed.loads.iter().map(|load| (load.force, load.torque)).collect();
        let covered: Vec<_> = self.immersed.covered.iter().map(stored).collect();
        to.put("positions of grains in the fluid", &positions);
        to.put("velocities of grains in the fluid", &velocities);
        to.put("spins of grains in the fluid", &spins);
        to.put("radii of grains in the fluid", &radii);
        to.put("loads on grains in the fluid", &loads);
        to.put("fluid in the place of grains", &covered);
    }

    /// Takes up grains and loads.
    pub(crate) fn restore_immersed(&mut self, from: &Section) -> Result<(), SnapshotError> {
        if !self.immersed.is_on {
            return Ok(());
        }
        let radii: Vec<f64> = from.array("radii of grains in the fluid")?;
        type Place<L, const Q: usize> = <<L as Lattice<Q>>::Dim as Dim>::Vec;
        type Turn<L, const Q: usize> = <<L as Lattice<Q>>::Dim as Dim>::Spin;
        let vectors = |name: &str| from.array_of::<Place<L, Q>>(name, radii.len());
        let positions = vectors("positions of grains in the fluid")?;
        let velocities = vectors("velocities of grains in the fluid")?;
        let spins: Vec<Turn<L, Q>> = from.array_of("spins of grains in the fluid", radii.len())?;
        type Pair<L, const Q: usize> = (Place<L, Q>, Turn<L, Q>);
        let loads: Vec<Pair<L, Q>> = from.array_of("loads on grains in the fluid", radii.len())?;
        let covered: Vec<(f64, Pair<L, Q>)> = from.array_of("fluid in the place of grains", radii.len())?;
        let covered: Vec<CoveredFluid<L::Dim>> = covered.into_iter().map(taken_up).collect();
        let motion = |k: usize| Motion::new(positions[k], velocities[k], spins[k]);
        let grains =
            (0..radii.len()).map(|k| ImmersedGrain { motion: motion(k), radius: radii[k] }).collect();
        let loads: Vec<_> = loads.into_iter().map(|(force, torque)| Load { force, torque }).collect();
        let before = std::mem::replace(&mut self.immersed.given, grains);
        let are_finite = loads.iter().all(Load::is_finite) && covered.iter().all(CoveredFluid::is_finite);
        if self.check_immersed().is_err() || !are_finite {
            self.immersed.given = before;
            let found = "a grain that the fluid cannot meet".to_owned();
            return Err(SnapshotError::Damaged {
                place: "solver/positions of grains in the fluid".to_owned(),
                found,
            });
        }
        self.find_covered_cells();
        (self.immersed.loads, self.immersed.covered) = (loads, covered);
        Ok(())
    }
}

/// As a section holds it.
fn stored<D: Dim>(fluid: &CoveredFluid<D>) -> (f64, (D::Vec, D::Spin)) {
    (fluid.share, (fluid.momentum, fluid.angular_momentum))
}

fn taken_up<D: Dim>((share, (momentum, angular_momentum)): (f64, (D::Vec, D::Spin))) -> CoveredFluid<D> {
    CoveredFluid { share, momentum, angular_momentum }
}
