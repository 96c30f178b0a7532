//! The solver: set-up, the step, and changes between stages.

use crate::cell::Cell;
use crate::choice::{choose_law, needs_rotation};
use crate::contacts::{Contacts, Pairs};
use crate::grains::{Grain, Grains};
use crate::law::ContactLaw;
use crate::ledger::Losses;
use crate::material::{MaterialId, Materials, SetupError};
use crate::pass::Trouble;
use crate::setup::{ContactModel, LeverArm, Options, Setup, check_options, check_stiffness};
use crate::shaking::Shaken;
use crate::traffic::Traffic;
use crate::view::View;
use crate::walls::Wall;
use crate::{lists, motion};
use granular_core::Shape;
use granular_core::solver::check_step;
use granular_core::walls::{MovingWalls, Reaction, WallGeometry};
use granular_core::{
    Blocks, Dim, FieldSink, GrainMotion, Limits, Linear, Location, Memory, Provides, Section, Shown,
    SnapshotError, Solver, StepClock, StepError,
};

/// Steps between re-sorting grains in memory. Tied to the count of steps, so that a restart
/// sorts at the same places.
const SORT_EVERY: u64 = 5000;
/// Below this number sorting does not pay.
const SORT_FROM: usize = 512;
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
    pub(crate) traffic: Traffic<D>,
    pub(crate) gravity: D::Vec,
    pub(crate) shaken: Option<Shaken<D>>,
    pub(crate) options: Options,
    pub(crate) grains: Grains<D>,
    pub(crate) pairs: Box<dyn Pairs<D>>,
    pub(crate) cell: Option<Box<Cell<D>>>,
    pub(crate) blocks: Blocks,
    pub(crate) losses: Losses,
    /// Energy put in by changes between steps, such as a new gravity \[J\].
    pub(crate) injected: f64,
    pub(crate) initial_energy: Option<f64>,
    pub(crate) steps: u64,
    /// The last step taken \[s\].
    pub(crate) last_dt: f64,
    custom_law: bool,
    skin: f64,
    /// Reach of the present lists \[m\].
    pub(crate) reach: f64,
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

    /// A simulation with a contact law of the caller's own.
    ///
    /// # Errors
    /// When a value is out of range.
    pub fn with_law<L: ContactLaw<D>>(setup: Setup<D>) -> Result<Self, SetupError> {
        let law = |materials: &Materials, options: &Options, blocks| -> Box<dyn Pairs<D>> {
            Box::new(Contacts::<D, L>::new(materials, options.tension, blocks))
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
        if pairs.tangential() {
            grains.rotate(list.iter().map(|grain| grain.spin));
        } else if let Some(grain) = list.iter().find(|grain| grain.spin != D::Spin::ZERO) {
            let spin = grain.spin.length();
            return Err(SetupError::new("spin of a grain", spin, "zero, since nothing couples to it"));
        }
        let mean = grains.radius.iter().sum::<f64>() / grains.len().max(1) as f64;
        let moving_walls = MovingWalls::of(&geometry(&walls))?;
        let mut dem = Self {
            moving_walls,
            clock: StepClock::default(),
            traffic: Traffic::new(list.len()),
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
            initial_energy: None,
            steps: 0,
            last_dt: 0.0,
            custom_law,
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
        self.pairs.tangential()
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

    /// Opens or closes the wall of this name. Returns whether there is one.
    pub fn set_open(&mut self, name: &str, open: bool) -> bool {
        let found = self.walls.iter().position(|wall| wall.name == name);
        self.change(|dem| {
            if let Some(index) = found {
                dem.walls[index].open = open;
            }
        });
        found.is_some()
    }

    /// Starts or holds the moving wall of this name, where it is. Returns whether there is one.
    pub fn set_moving(&mut self, name: &str, moves: bool) -> bool {
        let Some(wall) = self.walls.iter().position(|wall| wall.name == name) else { return false };
        let time = self.clock.time();
        let found = self.moving_walls.set_running(wall, moves, time);
        if found {
            self.moving_walls.place(time);
        }
        found
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

    /// Changes gravity \[m/s^2\].
    pub fn set_gravity(&mut self, gravity: D::Vec) {
        self.change(|dem| dem.gravity = gravity);
    }

    /// Changes the friction of one material. When friction comes into a scene that had none,
    /// grains begin to turn and contacts to remember.
    pub fn set_friction(&mut self, material: MaterialId, friction: f64) {
        self.change(|dem| {
            dem.materials.set_friction(material, friction);
            dem.take_materials(needs_rotation(&dem.materials));
        });
    }

    /// Sets all velocities and spins to zero.
    pub fn stop_motion(&mut self) {
        self.change(|dem| {
            dem.grains.velocity.fill(D::Vec::ZERO);
            dem.grains.spin.fill(D::Spin::ZERO);
        });
    }

    /// Changes something between steps, and books the energy that this puts in.
    pub(crate) fn change(&mut self, change: impl FnOnce(&mut Self)) {
        let before = self.options.ledger.then(|| self.energies().mechanical());
        change(self);
        self.list(0.0, None);
        if let Some(before) = before {
            self.injected += self.energies().mechanical() - before;
        }
    }

    /// Takes changed materials; grains begin to turn if they shall. They never stop turning: a
    /// scene may give friction and take it away again.
    pub(crate) fn take_materials(&mut self, turning: bool) {
        if self.custom_law || self.pairs.tangential() || !turning {
            self.pairs.update(&self.materials, self.options.tension);
        } else {
            self.pairs = choose_law::<D>(&self.materials, &self.options, self.blocks, true);
            self.grains.rotate(std::iter::repeat_n(D::Spin::ZERO, self.grains.len()));
        }
    }

    /// What kernels see of the state between steps.
    pub(crate) fn view(&self) -> View<'_, D> {
        let cell = self.cell.as_deref();
        View { cell, ..view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt) }
    }

    /// Rebuilds the lists for grains that move at most `stride` \[m\] in a step, zero when that is not known.
    pub(crate) fn list(&mut self, stride: f64, order: Option<&[u32]>) {
        self.reach = self.reach_for(stride);
        self.travel = 0.0;
        let (_, largest) = self.grains.radius_range();
        self.moving_walls.note_distances(&self.grains.position, 2.0 * self.reach + largest);
        let view = view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt);
        self.pairs.list(&View { cell: self.cell.as_deref(), ..view }, self.reach, order);
    }

    /// How far lists reach beyond contact \[m\] for grains that move at most `stride` \[m\] in a step.
    ///
    /// A long list is read in every step, a short one is built often: with the reach `r` the one costs `a r` and the
    /// other `b stride / r`, least together at `r^2 = b/a stride`, where `b/a` was measured as ten
    /// diameters. A stride near the skin (a shot) widens the reach so that the list serves for another step.
    fn reach_for(&self, stride: f64) -> f64 {
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

    /// Sorts grains in memory when the count of steps says so.
    pub(crate) fn sort_if_due(&mut self) {
        if self.sorts_after(0) {
            let (_, largest) = self.grains.radius_range();
            let order = self.grains.sort(2.0 * largest);
            self.list(0.0, Some(&order));
        }
    }

    /// Whether grains will be sorted when so many more steps are taken.
    fn sorts_after(&self, steps: u64) -> bool {
        (self.steps + steps).is_multiple_of(SORT_EVERY) && self.len() >= SORT_FROM
    }

    /// Steps without a periodic cell.
    fn advance_in_the_open(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        // Between two steps of one call, the end of one and the start of the next share a pass.
        let mut opened = false;
        for remaining in (0..steps).rev() {
            if !opened {
                self.sort_if_due();
                self.exchange_if_due();
                motion::open_step(&mut self.grains, self.blocks, dt, &mut self.speeds);
            }
            opened = remaining > 0 && !self.sorts_after(1) && !self.looks_after(1);
            self.load_and_kick(dt, opened)?;
        }
        self.moving_walls.place(self.clock.time());
        Ok(())
    }

    /// One step between its two halves: lists, loads, kick.
    fn load_and_kick(&mut self, dt: f64, go_on: bool) -> Result<(), StepError> {
        let mut stride = motion::fastest(&self.speeds) * dt;
        if !self.moving_walls.is_empty() {
            stride = stride.max(self.moving_walls.fastest(dt) * dt);
            self.moving_walls.place_in_step(self.clock.time(), dt);
        }
        if !stride.is_finite() {
            return Err(self.not_finite());
        }
        self.travel += stride;
        // Much too long a list costs more than another one.
        if 2.0 * self.travel + stride > self.reach || self.reach > 4.0 * self.reach_for(stride) {
            self.list(stride, None);
        }
        self.push(dt, stride);
        self.last_dt = dt;
        if !self.moving_walls.is_empty() {
            self.move_walls(dt);
        }
        let shaking = self.shake(dt);
        let before = shaking.filter(|_| self.options.ledger).map(|_| self.momentum());
        let (pairs, gravity) = (self.pairs.as_ref(), self.gravity + shaking.unwrap_or(D::Vec::ZERO));
        motion::close_step(&mut self.grains, pairs, self.blocks, gravity, dt, go_on, &mut self.speeds);
        if let (Some(shaking), Some(before)) = (shaking, before) {
            self.injected += 0.5 * dt * shaking.dot(before + self.momentum());
        }
        self.steps += 1;
        self.clock.step();
        let (losses, trouble) = self.pairs.outcome();
        self.losses += losses;
        if !self.losses.total().is_finite() {
            let (solver, quantity, step) = ("dem", "losses of energy", self.steps);
            return Err(StepError::NotFinite { solver, quantity, id: 0, step });
        }
        trouble.map_or(Ok(()), |trouble| Err(self.too_deep(trouble)))
    }

    /// Tells walls how grains pushed them.
    pub(crate) fn move_walls(&mut self, dt: f64) {
        self.moving_walls.reactions.fill(Reaction::default());
        self.pairs.add_reactions(&mut self.moving_walls.reactions);
        self.moving_walls.take_reactions(dt, self.options.ledger);
    }

    /// Writes the loads of all contacts where the accelerations will be.
    fn push(&mut self, dt: f64, margin: f64) {
        let mut force = std::mem::take(&mut self.grains.acceleration);
        let mut torque = std::mem::take(&mut self.grains.spin_acceleration);
        let view = View {
            velocity: &self.grains.middle_velocity,
            spin: &self.grains.middle_spin,
            dt,
            predicts: self.pairs.predicts(),
            margin,
            ..view_of(&self.grains, (&self.walls, &self.moving_walls), &self.options, self.last_dt)
        };
        self.pairs.push(&view, self.options.ledger, &mut force, &mut torque);
        (self.grains.acceleration, self.grains.spin_acceleration) = (force, torque);
    }

    pub(crate) fn not_finite(&self) -> StepError {
        let grains = &self.grains;
        let at =
            lists::all_finite::<D>(&grains.position).or_else(|| lists::all_finite::<D>(&grains.velocity));
        let id = at.map_or(0, |index| u64::from(grains.id[index]));
        StepError::NotFinite { solver: "dem", quantity: "motion", id, step: self.steps }
    }

    pub(crate) fn too_deep(&self, trouble: Trouble) -> StepError {
        let id = self.grains.id[trouble.first as usize];
        let (share, allowed) = (trouble.overlap / trouble.radius, crate::view::DEEPEST);
        // As if this was the hardest impact; it may be harder still a step later.
        let stiffer = match self.options.contact {
            ContactModel::Linear => {
                let factor = crate::limits::softer_than(share / allowed, crate::limits::LINEAR);
                format!("raise the normal stiffness at least {factor}-fold")
            }
            ContactModel::Hertz => {
                let factor = crate::limits::softer_than(share / allowed, crate::limits::HERTZ);
                format!("raise Young's modulus at least {factor}-fold")
            }
        };
        StepError::TooStiff {
            what: format!("overlap over radius at grain {id} in step {}", self.steps),
            value: share,
            allowed,
            hint: format!("{stiffer}, or lower the speed of the grains"),
        }
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
        mass: &grains.mass,
        material: &grains.material,
        first_material: grains.first_material,
        walls,
        poses: &moving_walls.poses,
        cell: None,
        dt: 0.0,
        last_dt,
        predicts: true,
        margin: 0.0,
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

    fn advance(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        check_step(dt)?;
        self.clock.run_at(dt);
        self.blocks.inside_pool(|| match self.cell {
            Some(_) => self.advance_in_cell(dt, steps),
            None => self.advance_in_the_open(dt, steps),
        })
    }

    fn location(&self) -> Location<'_> {
        Location::Points(D::vector_field(&self.grains.position))
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
