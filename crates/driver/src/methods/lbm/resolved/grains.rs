//! Grains that a fluid moves.

use crate::methods::contract::Building;
use crate::problems::Problems;
use crate::scene::Scene;
use crate::scene::coupling::{CouplingSpec, HeldLoadSpec};
use granular_core::NodeKey;
use granular_coupling::{HeldLoad, ResolvedGrains, ResolvedOptions};
use granular_dem::Dem;
use granular_lbm::{Lattice, Lbm, Real};

/// Couples grains to the fluid of a name, for all laws of the scene that say so.
pub(crate) fn couple<L: Lattice<Q>, T: Real, const Q: usize>(
    scene: &Scene,
    name: &str,
    water: NodeKey<Lbm<L, Q, T>>,
    simulation: &mut Building,
    problems: &mut Problems,
) -> Option<()> {
    for (k, law) in scene.couplings.iter().enumerate() {
        let CouplingSpec::Resolved { grains, fluid, radius, held } = law else { continue };
        if fluid != name {
            continue;
        }
        let place = format!("couplings.{k}");
        if !(*radius > 0.0 && *radius <= 1.0) {
            problems.add(format!("{place}.radius"), radius, "above 0 and at most 1", "");
            return None;
        }
        if scene.cell.is_some() {
            let hint = "let walls bound the grains, and leave `cell` out";
            problems.add(place, "Resolved", "a scene without a cell of the grains", hint);
            return None;
        }
        // It was built before, or there are problems already.
        let key = simulation.find::<Dem<L::Dim>>(grains)?;
        let held = match held {
            HeldLoadSpec::OneStep => HeldLoad::OneStep,
            HeldLoadSpec::TwoSteps => HeldLoad::TwoSteps,
        };
        let options = ResolvedOptions { radius_factor: *radius, held, ..ResolvedOptions::default() };
        let coupled = simulation.simulation().couple(water, key, ResolvedGrains::<L::Dim>::new(options));
        let refused = |error: granular_core::CouplingError| {
            problems.add(place, error.to_string(), "grains that fit the fluid", "");
        };
        coupled.map_err(refused).ok()?;
    }
    Some(())
}
