//! Grains that carry obstacles.

use crate::methods::contract::Building;
use crate::problems::Problems;
use crate::scene::Scene;
use crate::scene::coupling::CouplingSpec;
use granular_core::{Dim, GrainMotion, NodeKey, Provides};
use granular_coupling::CarriedObstacles;
use granular_dem::Dem;
use granular_lbm::{Ball, Lattice, Lbm, Obstacle, Real, Setup};

/// Grains that carry obstacles.
pub(crate) struct Carried<D: Dim> {
    place: String,
    grains: NodeKey<Dem<D>>,
    /// Number of the obstacle of each grain.
    numbers: Vec<usize>,
}

impl<D: Dim> Carried<D> {
    /// Adds an obstacle for each grain to the set-up of a fluid, for all laws of the scene that say so.
    pub(crate) fn of(
        scene: &Scene,
        fluid: &str,
        setup: &mut Setup<D>,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Vec<Self>> {
        let mut list = Vec::new();
        for (k, law) in scene.couplings.iter().enumerate() {
            let CouplingSpec::Carried { grains, radius, fluid: name } = law else { continue };
            if name != fluid {
                continue;
            }
            let place = format!("couplings.{k}");
            if !(*radius > 0.0 && radius.is_finite()) {
                problems.add(format!("{place}.radius"), radius, "above 0, at most about 1", "");
                return None;
            }
            if !(scene.inlets.is_empty() && scene.outlets.is_empty() && scene.cell.is_none()) {
                let hint = "obstacles are made once, from the sample";
                problems.add(place, "Carried", "a scene without inlets, outlets and cell", hint);
                return None;
            }
            // It was built before, or there are problems already.
            let key = simulation.find::<Dem<D>>(grains)?;
            let first = setup.obstacles.len();
            let grains = Provides::<GrainMotion<D>>::view(simulation.simulation().get(key));
            let mut bodies: Vec<(u32, Obstacle<D>)> = Vec::new();
            for (id, motion, size) in grains.iter() {
                let ball = Ball { centre: motion.position, radius: radius * size };
                bodies.push((id, Obstacle::new(format!("grain {id}"), ball)));
            }
            bodies.sort_by_key(|(id, _)| *id);
            let numbers = (first..first + bodies.len()).collect();
            setup.obstacles.extend(bodies.into_iter().map(|(_, body)| body));
            list.push(Self { place, grains: key, numbers });
        }
        Some(list)
    }

    /// Couples the grains to the lattice.
    pub(crate) fn couple<L: Lattice<Q, Dim = D>, T: Real, const Q: usize>(
        self,
        water: NodeKey<Lbm<L, Q, T>>,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<()> {
        let law = CarriedObstacles::<D>::numbered(self.numbers);
        let coupled = simulation.simulation().couple(water, self.grains, law);
        coupled
            .map_err(|error| {
                problems.add(self.place, error.to_string(), "grains that fit the fluid", "");
            })
            .ok()
    }
}
