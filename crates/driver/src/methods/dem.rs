//! The discrete element method, for grains.

mod boundaries;
mod build;
mod cell;
mod couplings;
mod falling;
mod grid;
mod materials;
mod member;
mod pairs;
mod probes;
mod region;
mod sample;
mod sample_file;
pub(crate) mod sheared;
mod stages;
mod stiffness;
mod voronoi;
mod whole;

use crate::methods::contract::{Building, Claims, Method};
use crate::methods::member::Member;
use crate::methods::parts::Part;
use crate::problems::Problems;
use crate::scene::{Dimension, Scene};
use granular_core::{D2, D3};
use granular_dem::spec::DemSpec;
use std::sync::Arc;

impl Claims for DemSpec {
    const PARTS: &'static [Part] = &[
        Part::Sample,
        Part::Materials,
        Part::Pairs,
        Part::Walls,
        Part::Inlets,
        Part::Outlets,
        Part::Cell,
        Part::StageStep,
        Part::Saving,
        Part::Quiet,
        Part::Packed,
        Part::BodyChanges,
        Part::GrainChanges,
        Part::Pushes,
    ];
    const STEP_KEY: &'static str = "steps_per_contact";
}

impl Method for DemSpec {
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
