//! Grains as a member of a simulation.

use super::falling::{self, Region};
use super::grid::Grid;
use super::sample_file::SavedSample;
use super::stages::{self, Action};
use super::{boundaries, couplings, probes, voronoi};
use crate::column::ColumnSize;
use crate::failure::Failure;
use crate::methods::contract::{Building, Claims};
use crate::methods::member::{Averages, Member, NoGrid, Notes};
use crate::methods::parts::Part;
use crate::problems::Problems;
use crate::scene::names::ENERGIES;
use crate::scene::{GridSpec, Scene};
use granular_core::units::Time;
use granular_core::{Dim, FieldSink, NodeKey, Shown, Simulation, Solver};
use granular_dem::Dem;
use granular_dem::spec::DemSpec;
use std::path::Path;
use std::sync::Arc;

/// The grains of a scene.
pub(super) struct Grains<D: Dim> {
    name: String,
    key: NodeKey<Dem<D>>,
    /// What happens at the start of each stage, in their order.
    stages: Vec<Vec<Action<D>>>,
    column: Option<ColumnSize>,
    time_step: Option<f64>,
    /// Where walls and grains are at the start; none without walls.
    region: Option<Region<D>>,
}

/// What a scene makes of the grains, besides the solver.
type Made<D> = (Vec<Vec<Action<D>>>, Option<ColumnSize>, Option<Time>);

impl<D: Dim> Grains<D> {
    /// Adds a solver to a simulation.
    pub(super) fn add(
        name: &str,
        dem: Dem<D>,
        (stages, column, time_step): Made<D>,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>> {
        let region = falling::region(&dem);
        let key = match simulation.add(name, dem) {
            Ok(key) => key,
            Err(error) => {
                problems.add("solvers", error.place, error.reason, "");
                return None;
            }
        };
        let time_step = time_step.map(|step| step.value());
        Some(Arc::new(Self { name: name.to_owned(), key, stages, column, time_step, region }))
    }

    fn dem<'a>(&self, simulation: &'a Simulation) -> &'a Dem<D> {
        simulation.get(self.key)
    }
}

impl<D: Dim> Member for Grains<D> {
    fn name(&self) -> &str {
        &self.name
    }

    fn solver<'a>(&self, simulation: &'a Simulation) -> &'a dyn Solver {
        self.dem(simulation)
    }

    fn offers(&self, part: Part) -> bool {
        DemSpec::PARTS.contains(&part)
    }

    fn begin(&self, simulation: &mut Simulation, stage: usize) -> Notes {
        let dem = simulation.get_mut(self.key);
        let mut push = None;
        self.stages[stage].iter().for_each(|action| stages::apply(action, dem, &mut push));
        Notes { push }
    }

    fn announced(&self, simulation: &Simulation, stage: usize) -> Vec<String> {
        let pushes = self.stages[stage].iter().filter_map(|action| match action {
            Action::Push(push) => Some(push.described(stages::target(self.dem(simulation)))),
            _ => None,
        });
        pushes.collect()
    }

    fn shown(&self, simulation: &Simulation) -> Vec<Shown> {
        let dem = self.dem(simulation);
        let mut list = probes::shown(dem);
        list.extend(voronoi::shown(dem));
        list.extend(couplings::shown(simulation, &self.name));
        list
    }

    fn show(&self, simulation: &Simulation, free_surface: f64, sink: &mut dyn FieldSink) {
        let dem = self.dem(simulation);
        probes::show(dem, sink);
        voronoi::show(dem, free_surface, sink);
        couplings::show(simulation, &self.name, sink);
    }

    fn shown_on_grids(&self, simulation: &Simulation) -> Vec<Shown> {
        let mut list = Dem::<D>::coarse_catalogue();
        list.extend(voronoi::shown_on_grid(self.dem(simulation)));
        list
    }

    fn averages(&self, spec: &GridSpec) -> Result<Box<dyn Averages>, NoGrid> {
        Ok(Box::new(Grid::of(spec, self.key)?))
    }

    fn is_metric(&self, number: &str) -> bool {
        ["front", "height", "largest_overlap", "unconnected", "energy_residual"].contains(&number)
    }

    fn energies(&self) -> &'static [&'static str] {
        ENERGIES
    }

    fn progress(&self, simulation: &Simulation) -> String {
        let overlap = self.number(simulation, "largest_overlap");
        overlap.map_or(String::new(), |overlap| format!("overlap {overlap:.2} %"))
    }

    fn time_step(&self) -> Option<f64> {
        self.time_step
    }

    fn choose_step(&self, simulation: &mut Simulation) {
        if let Some(step) = self.time_step {
            simulation.choose_step(self.key, step);
        }
    }

    fn column(&self) -> Option<ColumnSize> {
        self.column
    }

    fn warnings(&self, scene: &Scene, simulation: &Simulation) -> Vec<String> {
        falling::warnings(scene, self.dem(simulation))
    }

    fn refusals(&self, scene: &Scene, steps: &[f64]) -> Vec<String> {
        boundaries::crowded_inlets(scene, steps)
    }

    fn left_out(&self, scene: &Scene, simulation: &Simulation) -> Vec<String> {
        let unused = voronoi::is_unused(scene, self.dem(simulation));
        unused.then(|| "Voronoi cells: no output asks for them".to_owned()).into_iter().collect()
    }

    fn may_be_gone(&self, simulation: &Simulation) -> bool {
        self.region.is_some() && falling::may_be_left(self.dem(simulation))
    }

    fn why_gone(&self, simulation: &Simulation) -> Option<String> {
        falling::why_left(self.dem(simulation), self.region?)
    }

    fn save_sample(&self, scene: &Scene, simulation: &Simulation, path: &Path) -> Result<(), Failure> {
        // The order in which materials are counted.
        let names: Vec<String> = scene.materials.keys().cloned().collect();
        SavedSample::of(self.dem(simulation), names, self.column).write(path)
    }
}
