//! A continuum as a member of a simulation.

use super::materials::KnownGrains;
use super::stages::{self, Action};
use crate::column::ColumnSize;
use crate::methods::contract::{Building, Claims};
use crate::methods::fronts::{self, Piece};
use crate::methods::grids::coarse_grid;
use crate::methods::member::{Averages, Member, NoGrid, Notes};
use crate::methods::parts::Part;
use crate::problems::Problems;
use crate::scene::{GridSpec, Scene};
use granular_core::coarse::{CoarseFields, CoarseGrid, Constituents};
use granular_core::units::Time;
use granular_core::{Dim, FieldSink, Location, NodeKey, Shown, ShownAs, Simulation, Solver};
use granular_mpm::spec::MpmSpec;
use granular_mpm::{Mpm, Particle, Scheme, ShapeFunctions};
use std::sync::Arc;

/// Cells of a grid over which particles are averaged.
#[derive(Clone, Copy, Debug)]
struct Grid<D: Dim> {
    cells: CoarseGrid<D>,
    key: NodeKey<Mpm<D>>,
    grains: Option<Constituents>,
}

impl<D: Dim> Averages for Grid<D> {
    fn location(&self) -> Location<'static> {
        self.cells.location()
    }

    fn show(&self, simulation: &Simulation, _: f64, sink: &mut dyn FieldSink) {
        simulation.get(self.key).show_coarse(&self.cells, self.grains, sink);
    }
}

/// Particles as fronts see them.
fn pieces<D: Dim>(mpm: &Mpm<D>) -> Vec<Piece<D>> {
    let main = mpm.main_mass();
    let piece = |(k, (_, particle)): (usize, (u32, Particle<D>))| Piece {
        position: particle.position,
        reach: 0.5 * particle.volume.powf(1.0 / D::N as f64),
        mass: mpm.masses()[k],
        is_main: main[k],
    };
    mpm.particles().enumerate().map(piece).collect()
}

/// The continuum of a scene.
pub(super) struct Continuum<D: Dim> {
    name: String,
    key: NodeKey<Mpm<D>>,
    /// What happens at the start of each stage, in their order.
    stages: Vec<Vec<Action<D>>>,
    column: Option<ColumnSize>,
    time_step: Option<f64>,
    /// Grains that it stands for, where the scene says.
    grains: Option<KnownGrains>,
}

/// What a scene makes of a continuum, besides the solver.
pub(super) struct Made<D: Dim> {
    pub(super) stages: Vec<Vec<Action<D>>>,
    pub(super) column: Option<ColumnSize>,
    pub(super) time_step: Option<Time>,
    pub(super) grains: Option<KnownGrains>,
}

impl<D: Dim> Continuum<D> {
    /// Adds a solver to a simulation.
    pub(super) fn add(
        name: &str,
        mpm: Mpm<D>,
        made: Made<D>,
        simulation: &mut Building,
        problems: &mut Problems,
    ) -> Option<Arc<dyn Member>> {
        let key = match simulation.add(name, mpm) {
            Ok(key) => key,
            Err(error) => {
                problems.add("solvers", error.place, error.reason, "");
                return None;
            }
        };
        let Made { stages, column, time_step, grains } = made;
        let time_step = time_step.map(|step| step.value());
        Some(Arc::new(Self { name: name.to_owned(), key, stages, column, time_step, grains }))
    }
}

impl<D: Dim> Continuum<D> {
    /// Mean diameter of the grains \[m\]; the edge of a cell where nobody names them.
    fn diameter(&self, mpm: &Mpm<D>) -> f64 {
        self.grains.map_or(mpm.cell(), |grains| grains.mean_diameter)
    }
}

/// Energies of a continuum, for the figure of them.
const ENERGIES: &[&str] = &[
    "potential_energy",
    "kinetic_energy",
    "elastic_energy",
    "loss_plastic",
    "loss_viscous",
    "loss_sliding_at_walls",
    "loss_stopping_at_walls",
    "loss_local_damping",
    "loss_pic",
    "energy_residual",
];

impl<D: Dim> Member for Continuum<D> {
    fn name(&self) -> &str {
        &self.name
    }

    fn solver<'a>(&self, simulation: &'a Simulation) -> &'a dyn Solver {
        simulation.get::<Mpm<D>>(self.key)
    }

    fn shown(&self, simulation: &Simulation) -> Vec<Shown> {
        let mut list = self.solver(simulation).shown();
        list.extend(fronts::numbers::<D>().iter().map(|number| number.shown(ShownAs::Number)));
        list
    }

    fn show(&self, simulation: &Simulation, _: f64, sink: &mut dyn FieldSink) {
        let mpm = simulation.get(self.key);
        mpm.show(sink);
        fronts::show(|| pieces(mpm), sink);
    }

    fn shown_on_grids(&self, _: &Simulation) -> Vec<Shown> {
        CoarseFields::<D>::catalogue_of_continuum(self.grains.is_some())
    }

    fn averages(&self, spec: &GridSpec) -> Result<Box<dyn Averages>, NoGrid> {
        Ok(Box::new(Grid {
            cells: coarse_grid::<D>(spec)?,
            key: self.key,
            grains: self.grains.map(|grains| grains.constituents),
        }))
    }

    fn offers(&self, part: Part) -> bool {
        MpmSpec::PARTS.contains(&part)
    }

    fn begin(&self, simulation: &mut Simulation, stage: usize) -> Notes {
        let mpm = simulation.get_mut(self.key);
        let diameter = self.diameter(mpm);
        let mut push = None;
        self.stages[stage].iter().for_each(|action| stages::apply(action, mpm, diameter, &mut push));
        Notes { push }
    }

    fn announced(&self, simulation: &Simulation, stage: usize) -> Vec<String> {
        let mpm = simulation.get(self.key);
        let target = stages::target(mpm, self.diameter(mpm));
        let pushes = self.stages[stage].iter().filter_map(|action| match action {
            Action::Push(push) => Some(push.described(target)),
            _ => None,
        });
        pushes.collect()
    }

    fn warnings(&self, _: &Scene, simulation: &Simulation) -> Vec<String> {
        let options = simulation.get(self.key).options();
        let is_unsafe = (options.shape, options.scheme) == (ShapeFunctions::Linear, Scheme::StressLast);
        let name = &self.name;
        let warning = || {
            format!(
                "`solvers.{name}.scheme`: with shape `Linear`, `StressLast` has no step that is safe everywhere: what enters a cell \
                 may gain energy within the limit; take `ModifiedStressLast`, or shape `UniformGimp`"
            )
        };
        is_unsafe.then(warning).into_iter().collect()
    }

    fn is_metric(&self, number: &str) -> bool {
        ["front", "height", "energy_residual"].contains(&number)
    }

    fn energies(&self) -> &'static [&'static str] {
        ENERGIES
    }

    fn progress(&self, simulation: &Simulation) -> String {
        let fastest = self.number(simulation, "max_speed");
        fastest.map_or(String::new(), |speed| format!("fastest {speed:.3} m/s"))
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
}
