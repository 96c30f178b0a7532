//! The lattice Boltzmann method, for a fluid.

mod build;
mod carried;
mod member;
mod read;
mod resolved;

use crate::methods::contract::{Building, Claims, Method};
use crate::methods::member::Member;
use crate::methods::parts::Part;
use crate::problems::Problems;
use crate::scene::{Dimension, Scene};
use granular_core::Limits;
use granular_lbm::spec::LbmSpec;
use granular_lbm::{D2Q9, D3Q19};
use std::sync::Arc;

impl Claims for LbmSpec {
    const PARTS: &'static [Part] = &[Part::Fluid, Part::FluidChanges];
    const STEP_KEY: &'static str = "step";
}

impl Method for LbmSpec {
    fn build(
        &self,
        scene: &Scene,
        name: &str,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>> {
        match scene.dimension {
            Dimension::Plane => build::build::<D2Q9, 9>(scene, name, self, simulation, problems),
            Dimension::Space => build::build::<D3Q19, 19>(scene, name, self, simulation, problems),
        }
    }

    fn early_limits(&self, scene: &Scene, name: &str) -> Option<Limits> {
        match scene.dimension {
            Dimension::Plane => build::early_limits::<D2Q9, 9>(scene, name, self),
            Dimension::Space => build::early_limits::<D3Q19, 19>(scene, name, self),
        }
    }
}
