//! The solver.

use crate::choice::{BodyLaw, Kernels, kernels};
use crate::contact::Contacts;
use crate::grid::Grid;
use crate::layout::{Lattice, Node, TileShape};
use crate::ledger::Losses;
use crate::motion::Watch;
use crate::nodes::Touches;
use crate::particle::Particle;
use crate::particles::Particles;
use crate::setup::{Options, Setup, check_damping};
use crate::sorting::{Group, Sorting};
use crate::wall::{Condition, Wall};
use granular_core::solver::check_step;
use granular_core::walls::{MovingWalls, WallGeometry};
use granular_core::{
    Dim, FieldSink, Limits, Linear, Location, Memory, Section, SetupError, Shown, SnapshotError, Solver,
    StepClock, StepError,
};
use std::sync::OnceLock;

/// A body of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BodyId(pub(crate) usize);

/// Material point method in the plane (plane strain) or in space.
#[derive(Debug)]
pub struct Mpm<D: Dim> {
    pub(crate) options: Options,
    pub(crate) gravity: D::Vec,
    pub(crate) walls: Vec<Wall<D>>,
    pub(crate) moving: MovingWalls<D>,
    pub(crate) touches: Touches<D>,
    /// Force on each wall in the last step \[N\].
    pub(crate) wall_forces: Vec<D::Vec>,
    pub(crate) kernels: Kernels<D>,
    pub(crate) grid: Grid<D>,
    pub(crate) tiles: Vec<Node>,
    pub(crate) particles: Particles<D>,
    pub(crate) groups: Vec<Group<D>>,
    pub(crate) sorting: Sorting<D>,
    pub(crate) contacts: Contacts<D>,
    /// Mass of the heaviest particle.
    pub(crate) heaviest: f64,
    pub(crate) watches: Vec<Watch>,
    /// What local damping took on each block of nodes.
    pub(crate) damped: Vec<f64>,
    /// Greatest speed in the last step \[m/s\].
    pub(crate) fastest: f64,
    /// How far any particle may have moved since they were sorted \[m\].
    pub(crate) travel: f64,
    pub(crate) losses: Losses,
    /// Energy of what was put in \[J\].
    pub(crate) injected: f64,
    /// Whether steps are taken that are too long.
    pub(crate) any_step: bool,
    pub(crate) clock: StepClock,
    pub(crate) steps: u64,
    /// Places of nodes that hold mass, once they were asked for.
    pub(crate) node_places: OnceLock<Vec<D::Vec>>,
}

impl<D: Dim> Mpm<D> {
    /// A grid and walls without particles.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn new(setup: Setup<D>) -> Result<Self, SetupError> {
        setup.check()?;
        let Setup { cell, origin, gravity, walls, options } = setup;
        let kernels = kernels::<D>(&options);
        let moving = MovingWalls::of(&geometry(&walls))?;
        Ok(Self {
            options,
            gravity,
            wall_forces: vec![D::Vec::ZERO; walls.len()],
            walls,
            moving,
            touches: Touches::new(),
            grid: Grid::new(Lattice { origin, cell }, TileShape::new::<D>(kernels.reach)),
            kernels,
            tiles: Vec::new(),
            particles: Particles::default(),
            groups: Vec::new(),
            sorting: Sorting::default(),
            contacts: Contacts::default(),
            heaviest: 0.0,
            watches: Vec::new(),
            damped: Vec::new(),
            fastest: 0.0,
            travel: 0.0,
            losses: Losses::default(),
            injected: 0.0,
            any_step: false,
            clock: StepClock::default(),
            steps: 0,
            node_places: OnceLock::new(),
        })
    }

    /// Adds a body of one law, with its density \[kg/m^3\] at the start; its particles get the next identifiers.
    ///
    /// # Errors
    /// When density or a particle is out of range, or a particle is wider than a cell where its width counts.
    pub fn body(
        &mut self,
        law: impl Into<BodyLaw<D>>,
        density: f64,
        particles: &[Particle<D>],
    ) -> Result<BodyId, SetupError> {
        if !(density > 0.0 && density.is_finite()) {
            return Err(SetupError::new("density", density, "positive and finite, in kg/m^3"));
        }
        let cell = self.grid.lattice.cell;
        for (index, particle) in particles.iter().enumerate() {
            particle.check(index)?;
            let width = width_of::<D>(particle.volume, cell);
            if self.kernels.has_width && width > 1.0 + 1e-9 {
                let error =
                    SetupError::new("width in cells", width, "at most 1: more particles or larger cells");
                return Err(error.of(format_args!("particle {index}")));
            }
        }
        let mut body = law.into().body;
        body.start(particles.len());
        let first = self.particles.len() as u32;
        for particle in particles {
            let width = self.kernels.has_width.then(|| width_of::<D>(particle.volume, cell).min(1.0));
            self.particles.push(particle, density, width, self.kernels.affine.is_some());
            self.heaviest = self.heaviest.max(density * particle.volume);
            self.fastest = self.fastest.max(particle.velocity.length());
        }
        let starts = vec![first, self.particles.len() as u32];
        self.groups.push(Group { body, density, starts, looseness: 1.0, field: 0 });
        if !self.contacts.is_empty() {
            self.lay_out_fields();
        }
        self.injected += self.energy_of_group(self.groups.len() - 1).mechanical();
        self.sort().map_err(|_| SetupError::new("place", f64::NAN, "within 2^31 cells of the origin"))?;
        self.check_thin_walls()?;
        Ok(BodyId(self.groups.len() - 1))
    }

    /// Sorts particles by block and cell.
    pub(crate) fn sort(&mut self) -> Result<(), StepError> {
        let reach = 2.0_f64.powi(31) * self.grid.lattice.cell;
        let origin = self.grid.lattice.origin;
        let far = self.particles.position.iter().position(|&at| {
            (0..D::N).any(|axis| granular_core::Vector::component(at - origin, axis).abs() >= reach)
        });
        if let Some(index) = far {
            let position = granular_core::Vector::padded(self.particles.position[index]);
            return Err(StepError::LeftDomain { id: u64::from(self.particles.id[index]), position });
        }
        self.sorting.sort(&mut self.particles, &mut self.groups, &mut self.grid);
        self.travel = 0.0;
        Ok(())
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Simulated time since the start \[s\].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// Choices of the method.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Walls, open gates included.
    pub fn walls(&self) -> &[Wall<D>] {
        &self.walls
    }

    /// Gravity \[m/s^2\].
    pub fn gravity(&self) -> D::Vec {
        self.gravity
    }

    /// Edge of a cell \[m\].
    pub fn cell(&self) -> f64 {
        self.grid.lattice.cell
    }

    /// Force on each wall in the last step \[N; N/m in the plane\].
    pub fn wall_forces(&self) -> &[D::Vec] {
        &self.wall_forces
    }

    /// Losses of energy since the start; zero unless the ledger is kept.
    pub fn losses(&self) -> Losses {
        self.losses
    }

    /// All particles with their identifiers, in the order of memory.
    pub fn particles(&self) -> impl Iterator<Item = (u32, Particle<D>)> + '_ {
        (0..self.len()).map(|index| (self.particles.id[index], self.particles.get(index)))
    }

    /// Masses of all particles \[kg\], in the order of memory.
    pub fn masses(&self) -> &[f64] {
        &self.particles.mass
    }

    /// The particle of a stable identifier. Searches: for a few particles.
    ///
    /// # Panics
    /// When there is no such particle.
    pub fn particle(&self, id: u32) -> Particle<D> {
        let index = self.particles.id.iter().position(|&other| other == id);
        self.particles.get(index.expect("the identifier is that of a particle"))
    }

    /// Changes gravity \[m/s^2\].
    ///
    /// # Errors
    /// When it is not finite.
    pub fn set_gravity(&mut self, gravity: D::Vec) -> Result<(), SetupError> {
        if !gravity.is_finite() {
            return Err(SetupError::new("gravity", f64::NAN, "finite"));
        }
        self.injected -= self.energies().potential;
        self.gravity = gravity;
        self.injected += self.energies().potential;
        Ok(())
    }

    /// Changes the local damping.
    ///
    /// # Errors
    /// When it is not from 0 to 1 (excluded).
    pub fn set_local_damping(&mut self, share: f64) -> Result<(), SetupError> {
        check_damping(share)?;
        self.options.local_damping = share;
        Ok(())
    }

    /// Changes what a wall does to nodes.
    ///
    /// # Errors
    /// When a coefficient is out of range.
    ///
    /// # Panics
    /// When there is no wall of this index.
    pub fn set_condition(&mut self, wall: usize, condition: Condition) -> Result<(), SetupError> {
        let changed = Wall { condition, ..self.walls[wall].clone() };
        changed.check()?;
        self.walls[wall] = changed;
        Ok(())
    }

    /// Opens or closes a gate.
    ///
    /// # Panics
    /// When there is no wall of this index.
    pub fn set_open(&mut self, wall: usize, open: bool) {
        self.walls[wall].open = open;
        self.touches.forget();
    }

    /// Starts or holds a wall that has a motion. Returns whether it is one.
    pub fn set_moving(&mut self, wall: usize, moves: bool) -> bool {
        let time = self.clock.time();
        self.moving.set_running(wall, moves, time)
    }

    /// Takes steps that are too long instead of refusing them: for studies of stability.
    pub fn allow_any_step(&mut self) {
        self.any_step = true;
    }
}

/// Width of a particle of some volume, in cells.
fn width_of<D: Dim>(volume: f64, cell: f64) -> f64 {
    let width = if D::N == 2 { volume.sqrt() } else { volume.cbrt() };
    width / cell
}

/// What motion needs to know of walls.
fn geometry<D: Dim>(walls: &[Wall<D>]) -> Vec<WallGeometry<'_, D>> {
    walls
        .iter()
        .map(|Wall { name, shape, motion, held, .. }| WallGeometry {
            name,
            shape,
            motion: *motion,
            held: *held,
        })
        .collect()
}

impl<D: Dim> Solver for Mpm<D> {
    fn name(&self) -> &'static str {
        "mpm"
    }

    fn size(&self) -> (usize, &'static str) {
        (self.len(), "particle")
    }

    fn limits(&self, report: &mut Limits) {
        self.report_limits(report);
    }

    fn hard_limits(&self, report: &mut Limits) {
        self.report_hard_limits(report);
    }

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        check_step(dt)?;
        self.check_stability(dt)?;
        self.clock.run_at(dt);
        self.node_places.take();
        self.grid.tile_blocks().inside_pool(|| self.take_steps(dt, steps))
    }

    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![
            ("particles", Location::Points(D::vector_field(&self.particles.position))),
            ("nodes", Location::Points(D::vector_field(self.node_places()))),
        ]
    }

    fn shown(&self) -> Vec<Shown> {
        self.catalogue()
    }

    fn show(&self, sink: &mut dyn FieldSink) {
        self.show_all(sink);
    }

    fn save(&self, to: &mut Section) {
        self.save_state(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.restore_state(from)
    }

    fn memory(&self) -> Memory {
        self.report_memory()
    }
}
