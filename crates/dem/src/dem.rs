//! The solver: set-up, the step, and changes between stages.

mod changes;
mod single;
mod step;

pub use single::OtherBody;

use crate::choice::{choose_law, needs_rotation};
use crate::contacts::{Contacts, Pairs};
use crate::grains::{Grain, Grains};
use crate::inlets::InletsAndOutlets;
use crate::law::ContactLaw;
use crate::ledger::Losses;
use crate::material::{MaterialId, Materials, PairProperties, SetupError};
use crate::periodic::PeriodicCell;
use crate::setup::{LeverArm, Options, Setup, SpringTurning, check_options, check_stiffness};
use crate::shaking::Shaken;
use crate::view::View;
use crate::walls::Wall;
use granular_core::Shape;
use granular_core::quantity::Load;
use granular_core::solver::check_step;
use granular_core::walls::{MovingWalls, WallGeometry};
use granular_core::{
    Blocks, Dim, FieldSink, GrainMotion, Limits, Linear, Location, Memory, Provides, Section, Shown,
    SnapshotError, Solver, StepClock, StepError,
};

/// Blocks that a sample is cut into, and their smallest size. Many small blocks share the work
/// evenly (16 instead of 64 cost a fifth of the speed of two threads on a collapsing column of
/// 13 000 disks) for 2 % on one thread.
const BLOCKS: usize = 64;
const SMALLEST_BLOCK: usize = 128;
/// Least reach of lists over the longest.
const SHORTEST: f64 = 0.08;

/// Discrete element method in dimension `D`.
pub struct Dem<D: Dim> {
    pub(crate) materials: Materials,
    pub(crate) walls: Vec<Wall<D>>,
    pub(crate) moving_walls: MovingWalls<D>,
    pub(crate) clock: StepClock,
    pub(crate) inlets: InletsAndOutlets<D>,
    pub(crate) gravity: D::Vec,
    pub(crate) shaken: Option<Shaken<D>>,
    pub(crate) options: Options,
    pub(crate) grains: Grains<D>,
    pub(crate) pairs: Box<dyn Pairs<D>>,
    pub(crate) cell: Option<Box<PeriodicCell<D>>>,
    pub(crate) blocks: Blocks,
    pub(crate) losses: Losses,
    /// Energy put in by changes between steps, such as a new gravity \[J\].
    pub(crate) injected: f64,
    /// Work of loads that others put on grains \[J\].
    pub(crate) load_work: f64,
    pub(crate) initial_energy: Option<f64>,
    pub(crate) steps: u64,
    /// The last step taken \[s\].
    pub(crate) last_dt: f64,
    custom_law: bool,
    /// Whether what bounds the step changed since the last one was checked.
    pub(crate) unchecked: bool,
    any_step: bool,
    skin: f64,
    /// Reach of the present lists \[m\].
    pub(crate) reach: f64,
    /// Largest radius when the lists were built \[m\].
    pub(crate) largest: f64,
    /// Bound on how far any grain moved since the lists were built \[m\].
    pub(crate) travel: f64,
    pub(crate) speeds: Vec<u64>,
}

impl<D: Dim> Dem<D> {
    /// A simulation with the law that the options and materials need: without friction no grain
    /// turns and no contact remembers anything, and neither takes memory.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn new(setup: Setup<D>) -> Result<Self, SetupError> {
        check_stiffness(&setup.materials, setup.options.contact)?;
        let law = |materials: &Materials, options: &Options, blocks| {
            choose_law::<D>(materials, options, blocks, needs_rotation(materials))
        };
        Self::build(setup, law, false)
    }

    /// A simulation with a contact law of the caller's own, a value with its own parameters. What the law takes from
    /// materials, if anything, is up to [`ContactLaw::for_pair`].
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn with_law<L: ContactLaw<D>>(setup: Setup<D>, law: L) -> Result<Self, SetupError> {
        let law = |materials: &Materials, options: &Options, blocks| -> Box<dyn Pairs<D>> {
            let between = move |pair: &PairProperties, tension| law.for_pair(pair, tension);
            Box::new(Contacts::<D, L>::new(materials, options.tension, blocks, Box::new(between)))
        };
        Self::build(setup, law, true)
    }

    fn build(
        setup: Setup<D>,
        law: impl Fn(&Materials, &Options, Blocks) -> Box<dyn Pairs<D>>,
        custom_law: bool,
    ) -> Result<Self, SetupError> {
        let Setup { materials, grains: list, walls, gravity, options } = setup;
        check_options(&options, gravity.is_finite())?;
        let mut grains = Grains::new(&list, &materials, gravity)?;
        let blocks = Blocks::about(list.len(), BLOCKS, SMALLEST_BLOCK);
        let pairs = law(&materials, &options, blocks);
        // Without friction a spin stays what it is.
        if pairs.tangential() || list.iter().any(|grain| grain.spin != D::Spin::ZERO) {
            grains.rotate(list.iter().map(|grain| grain.spin));
        }
        let mean = grains.radius.iter().sum::<f64>() / grains.len().max(1) as f64;
        let moving_walls = MovingWalls::of(&geometry(&walls))?;
        let mut dem = Self {
            moving_walls,
            clock: StepClock::default(),
            inlets: InletsAndOutlets::new(list.len()),
            skin: options.skin * 2.0 * mean,
            reach: 0.0,
            speeds: vec![0; blocks.count()],
            materials,
            walls,
            gravity,
            shaken: None,
            options,
            grains,
            pairs,
            cell: None,
            blocks,
            losses: Losses::default(),
            injected: 0.0,
            load_work: 0.0,
            initial_energy: None,
            steps: 0,
            last_dt: 0.0,
            custom_law,
            unchecked: true,
            any_step: false,
            largest: 0.0,
            travel: 0.0,
        };
        dem.list(0.0, None);
        dem.initial_energy = dem.options.ledger.then(|| dem.energies().mechanical());
        Ok(dem)
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.grains.len()
    }

    /// Whether there are no grains.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Whether grains turn; if not, there are no arrays of spins.
    pub fn turns(&self) -> bool {
        self.grains.turns
    }

    /// Lets [`advance`](Solver::advance) take steps beyond the [limit of a contact](Dem::contact_step), which it refuses
    /// otherwise: for studies of what happens there.
    pub fn allow_any_step(&mut self) {
        self.any_step = true;
    }

    /// Refuses a step at which a contact gains energy. The limit is looked for when a step becomes longer, and after changes.
    fn check_stability(&mut self, dt: f64) -> Result<(), StepError> {
        if self.any_step || (dt <= self.last_dt && !self.unchecked) {
            return Ok(());
        }
        let (limit, names) = self.limit_of_a_contact();
        if dt > limit * (1.0 + 1e-9) {
            let why = format!("it must be at most {limit:.4e} s for the stability of a contact ({names})");
            return Err(StepError::Step { dt, why });
        }
        self.unchecked = false;
        Ok(())
    }

    /// Makes room for spins, if there is none.
    pub(crate) fn let_turn(&mut self) {
        if !self.turns() {
            self.grains.rotate(std::iter::repeat_n(D::Spin::ZERO, self.grains.len()));
        }
    }

    /// The place in memory of a grain.
    pub(crate) fn index_of(&self, id: u32) -> Result<usize, SetupError> {
        let found = self.grains.id.iter().position(|&other| other == id);
        found.ok_or_else(|| SetupError::new("identifier of a grain", f64::from(id), "that of a grain"))
    }

    /// The grain of a stable identifier, as it is now; in a cell that deforms its velocity is that relative to the flow of
    /// the cell, as a cell takes it. Searches: for a few grains.
    ///
    /// # Panics
    /// When there is no such grain.
    pub fn grain(&self, id: u32) -> Grain<D> {
        let index = self.grains.id.iter().position(|&other| other == id);
        self.grain_at(index.expect("the identifier is that of a grain"))
    }

    /// All grains with their identifiers, in the order of memory; velocities as [`Dem::grain`] has them.
    pub fn grains(&self) -> impl Iterator<Item = (u32, Grain<D>)> + '_ {
        (0..self.len()).map(|index| (self.grains.id[index], self.grain_at(index)))
    }

    fn grain_at(&self, index: usize) -> Grain<D> {
        Grain {
            position: self.grains.position[index],
            velocity: self.grains.velocity[index],
            spin: self.grains.spin.get(index).copied().unwrap_or(D::Spin::ZERO),
            radius: self.grains.radius[index],
            material: MaterialId(self.grains.material_of(index) as u8),
        }
    }

    /// Masses of all grains \[kg; kg/m in the plane\], in the order of storage.
    pub fn masses(&self) -> &[f64] {
        &self.grains.mass
    }

    /// Walls, open gates included.
    pub fn walls(&self) -> &[Wall<D>] {
        &self.walls
    }

    /// Materials.
    pub fn materials(&self) -> &Materials {
        &self.materials
    }

    /// Gravity \[m/s^2\].
    pub fn gravity(&self) -> D::Vec {
        self.gravity
    }

    /// Losses of energy since the start; zero unless the ledger is kept.
    pub fn losses(&self) -> Losses {
        self.losses
    }

    /// Work that moving walls did on grains since the start \[J\]; zero unless the ledger is kept.
    pub fn wall_work(&self) -> f64 {
        self.moving_walls.work
    }

    /// Where a wall is \[m\]: the point with which a plane was given, moved along with it; for other walls how far they
    /// were shifted. Turning does not count.
    ///
    /// # Panics
    /// When there is no wall of this index.
    pub fn wall_position(&self, wall: usize) -> D::Vec {
        let shift = self.moving_walls.poses.get(wall).map_or(D::Vec::ZERO, |pose| pose.shift);
        match self.walls[wall].shape {
            Shape::Plane { point, .. } => point + shift,
            _ => shift,
        }
    }

    /// Simulated time since the start \[s\].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// What kernels see of the state between steps.
    pub(crate) fn view(&self) -> View<'_, D> {
        let cell = self.cell.as_deref();
        let law_reach = self.pairs.reach();
        View {
            cell,
            law_reach,
            margin: law_reach,
            ..view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt)
        }
    }

    /// Rebuilds the lists for grains that move at most `stride` \[m\] in a step, zero when that is not known.
    pub(crate) fn list(&mut self, stride: f64, order: Option<&[u32]>) {
        self.reach = self.reach_for(stride);
        self.travel = 0.0;
        self.largest = self.grains.radius_range().1;
        let largest = self.largest;
        self.moving_walls.note_distances(&self.grains.position, 2.0 * self.reach + largest);
        let law_reach = self.pairs.reach();
        let view = view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt);
        self.pairs.list(&View { cell: self.cell.as_deref(), ..view }, self.reach + law_reach, order);
    }

    /// How far lists reach beyond contact \[m\] for grains that move at most `stride` \[m\] in a step.
    ///
    /// A long list is read in every step, a short one is built often: with the reach `r` the one costs `a r` and the
    /// other `b stride / r`, least together at `r^2 = b/a stride`, where `b/a` was measured as ten
    /// diameters. A stride near the skin (a shot) widens the reach so that the list serves for another step.
    pub(crate) fn reach_for(&self, stride: f64) -> f64 {
        let longest = self.skin;
        let best = (10.0 * longest / self.options.skin * stride).sqrt();
        let reach = if stride > 0.0 { best.clamp(SHORTEST * longest, longest) } else { longest };
        reach.max(4.0 * stride)
    }

    /// Longest reach of the lists for grains of this mean diameter \[m\].
    pub(crate) fn use_skin_of(&mut self, diameter: f64) {
        self.skin = self.options.skin * diameter;
    }

    /// Cuts another number of grains into blocks.
    pub(crate) fn cut(&mut self) -> Blocks {
        self.blocks = Blocks::about(self.len(), BLOCKS, SMALLEST_BLOCK);
        self.speeds.resize(self.blocks.count(), 0);
        self.blocks
    }

    /// Takes up that grains were put in or taken out; `place` tells where each is now.
    pub(crate) fn regroup(&mut self, place: &[u32]) {
        let blocks = self.cut();
        self.pairs.regroup(&self.walls, blocks, place);
        self.list(0.0, None);
    }
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

pub(crate) fn view_of<'a, D: Dim>(
    grains: &'a Grains<D>,
    (walls, moving_walls): (&'a [Wall<D>], &'a MovingWalls<D>),
    options: &Options,
    last_dt: f64,
) -> View<'a, D> {
    View {
        position: &grains.position,
        velocity: &grains.velocity,
        spin: &grains.spin,
        start_velocity: &grains.velocity,
        start_spin: &grains.spin,
        radius: &grains.radius,
        mass: grains.contact_mass(),
        material: &grains.material,
        first_material: grains.first_material,
        walls,
        poses: &moving_walls.poses,
        cell: None,
        dt: 0.0,
        last_dt,
        predicts: true,
        margin: 0.0,
        law_reach: 0.0,
        twist_share: if options.spring_turning == SpringTurning::MeanSpin { 0.5 } else { 0.0 },
        arm_share: if options.lever_arm == LeverArm::Exact { 0.5 } else { 0.0 },
    }
}

/// In a cell that deforms velocities are those relative to its flow.
impl<D: Dim> Provides<GrainMotion<D>> for Dem<D> {
    fn view(&self) -> granular_core::Grains<'_, D> {
        let Grains { position, velocity, spin, radius, id, .. } = &self.grains;
        granular_core::Grains::new(position, velocity, spin, radius, id)
    }
}

impl<D: Dim> Solver for Dem<D> {
    fn name(&self) -> &'static str {
        "dem"
    }

    fn size(&self) -> (usize, &'static str) {
        (self.len(), "grain")
    }

    fn limits(&self, report: &mut Limits) {
        self.report_limits(report);
    }

    fn hard_limits(&self, report: &mut Limits) {
        self.report_hard_limits(report);
    }

    /// What is reported is the limit of a packing at the hardest impact, which single contacts may well exceed; what no contact
    /// bears, [`Dem::contact_step`], is refused by `advance` itself.
    fn hard_limits_may_change(&self) -> bool {
        false
    }

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        check_step(dt)?;
        self.check_stability(dt)?;
        self.clock.run_at(dt);
        self.blocks.inside_pool(|| self.take_steps(dt, steps))
    }

    fn clear_inputs(&mut self) {
        self.grains.load.fill(Load::ZERO);
    }

    fn places(&self) -> Vec<(&'static str, Location<'_>)> {
        vec![("grains", Location::Points(D::vector_field(&self.grains.position)))]
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

#[cfg(test)]
mod tests;
