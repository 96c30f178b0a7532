//! The material point method, for a continuum.

mod build;
mod continuum;
pub mod element;
mod materials;
mod member;
mod sample;
mod stages;
#[cfg(test)]
mod tests;

pub use continuum::ContinuumSpec;

use crate::methods::contract::{Building, Claims, Method};
use crate::methods::member::Member;
use crate::methods::parts::Part;
use crate::problems::Problems;
use crate::scene::{Dimension, Scene};
use granular_core::{D2, D3};
use granular_mpm::spec::MpmSpec;
use std::sync::Arc;

impl Claims for MpmSpec {
    const PARTS: &'static [Part] = &[
        Part::Sample,
        Part::Materials,
        Part::Continua,
        Part::Walls,
        Part::StageStep,
        Part::Quiet,
        Part::BodyChanges,
        Part::Pushes,
    ];
    const STEP_KEY: &'static str = "courant";
}

impl Method for MpmSpec {
    fn build(
        &self,
        scene: &Scene,
        name: &str,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>> {
        match scene.dimension {
            Dimension::Plane => build::build::<D2>(scene, name, self, simulation, problems),
            Dimension::Space => build::build::<D3>(scene, name, self, simulation, problems),
        }
    }
}
