//! The solver.

use crate::body_force::{self, BodyForce, Force, ForceField};
use crate::boundary::{Beyond, Builder};
use crate::choice::{Steps, step_function};
use crate::collision::{Parameters, Physics};
use crate::immersed::Immersed;
use crate::lattice::Lattice;
use crate::links::Cuts;
use crate::named::SetFace;
use crate::obstacle::{Cover, Domain, cell_index, cells_of, cover};
use crate::open::{dot, equilibrium, moments};
use crate::populations::{Grid, Layout, Populations, Runs};
use crate::real::Real;
use crate::rows::RowLinks;
use crate::setup::{Setup, SetupError};
use granular_core::solver::check_step;
use granular_core::{Dim, Linear, Motion, StepError, Vector};

/// Largest population at rest, without its weight, that still means something: its density would
/// be twice that at rest.
const BEYOND: f64 = 4.0 / 9.0;

/// Fewest steps at once for which links are sorted for two steps together.
const PAIRED: u64 = 4;

/// A fluid on a lattice. `T` is the type in which populations are stored and computed.
pub struct Lbm<L: Lattice<Q>, const Q: usize, T: Real = f64> {
    pub(crate) setup: Setup<L::Dim>,
    pub(crate) populations: Populations<T>,
    pub(crate) runs: Runs,
    pub(crate) cover: Cover,
    /// Motion lent to the obstacles, and whether it was looked at since the last step.
    pub(crate) motions: Vec<Motion<L::Dim>>,
    pub(crate) may_have_moved: bool,
    pub(crate) immersed: Immersed<L::Dim, T>,
    pub(crate) beyond: Beyond<T>,
    pub(crate) row_links: RowLinks<T>,
    /// As at the time reached.
    pub(crate) physics: Physics,
    parameters: Parameters<T>,
    pub(crate) field: ForceField<T>,
    step: Steps<T>,
    pub(crate) steps: u64,
    pub(crate) fluid_cells: usize,
    pub(crate) set_faces: Vec<SetFace<L::Dim>>,
}

impl<L: Lattice<Q>, const Q: usize, T: Real> std::fmt::Debug for Lbm<L, Q, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Lbm")
            .field("lattice", &L::NAME)
            .field("setup", &self.setup)
            .field("steps", &self.steps)
            .finish_non_exhaustive()
    }
}

/// Pressure over that at rest and velocity at a point.
#[derive(Clone, Copy, Debug)]
pub struct Flow<D: Dim> {
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Velocity \[m/s\].
    pub velocity: D::Vec,
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// A fluid at rest.
    ///
    /// # Errors
    /// When a value makes no sense; it is named with what is allowed.
    pub fn new(setup: Setup<L::Dim>) -> Result<Self, SetupError> {
        setup.check()?;
        let grid = Grid::new::<T>(setup.cells, L::Dim::N == 3);
        if u32::try_from(grid.len::<Q>()).is_err() {
            let value = format!("{:?}", setup.cells);
            return Err(SetupError::new("cells", value, "fewer than 2^32 populations"));
        }
        let cover = cover(&setup)?;
        let is_fluid = |cell| cover.is_empty() || cover[cell_index(setup.cells, cell)] == 0;
        body_force::check(&setup, is_fluid)?;
        let runs = Runs::of(&grid, is_fluid);
        let beyond = Builder::<L, Q>::new(&setup, &grid, &cover).build();
        let solid = cover.iter().filter(|number| **number != 0).count();
        let physics = Physics {
            operator: setup.operator,
            tau: setup.tau(),
            force: [0.0; 3],
            varies: [setup.body_force.is_some(), setup.body_force.as_ref().is_some_and(BodyForce::has_field)],
            field_factor: 1.0,
            smagorinsky: setup.smagorinsky.unwrap_or(0.0),
        };
        let field = ForceField::new(&setup, &grid);
        let mut lbm = Self {
            populations: Populations::new::<Q>(grid, &runs),
            fluid_cells: setup.cells.iter().product::<usize>() - solid,
            runs,
            cover,
            motions: setup.obstacles.iter().map(|obstacle| obstacle.motion()).collect(),
            may_have_moved: false,
            immersed: Immersed::default(),
            beyond,
            row_links: RowLinks::default(),
            parameters: physics.parameters::<L, T, Q>(),
            step: step_function::<L, T, Q>(&physics),
            field,
            physics,
            steps: 0,
            set_faces: Vec::new(),
            setup,
        };
        lbm.set_acceleration(lbm.setup.acceleration)?;
        lbm.field.fill(&lbm.setup, 0.0);
        if lbm.is_pairable() {
            lbm.sort_links();
        }
        lbm.set_flow(|_| Flow { pressure: 0.0, velocity: Vector::along(0, 0.0) });
        Ok(lbm)
    }

    /// The setup.
    pub fn setup(&self) -> &Setup<L::Dim> {
        &self.setup
    }

    /// Places of all fluid cells in a plane and their coordinates, x fastest.
    pub(crate) fn fluid(&self) -> impl Iterator<Item = ([usize; 3], usize)> + '_ {
        cells_of([[0; 3], self.setup.cells])
            .filter(|cell| self.is_fluid(*cell))
            .map(|cell| (cell, self.populations.grid.place(cell.map(|x| x as i64))))
    }

    pub(crate) fn is_fluid(&self, cell: [usize; 3]) -> bool {
        self.cover.is_empty() || self.cover[cell_index(self.setup.cells, cell)] == 0
    }

    /// Sets pressure and velocity everywhere, with the stress that belongs to the gradient of the
    /// velocity.
    pub fn set_flow(&mut self, flow: impl Fn(<L::Dim as Dim>::Vec) -> Flow<L::Dim>) {
        let speed = self.setup.lattice_speed();
        let lattice_velocity = |at| flow(at).velocity.padded().map(|c| c / speed);
        let cells: Vec<_> = self.fluid().collect();
        for (cell, place) in cells {
            let centre = Domain::of(&self.setup).centre(cell.map(|x| x as i64));
            let excess = self.setup.density_excess(flow(centre).pressure);
            let mut gradient = [[0.0; 3]; 3];
            for (axis, row) in gradient.iter_mut().enumerate().take(L::Dim::N) {
                let half = <L::Dim as Dim>::Vec::along(axis, 0.5 * self.setup.spacing);
                let (low, high) = (lattice_velocity(centre - half), lattice_velocity(centre + half));
                *row = std::array::from_fn(|component| high[component] - low[component]);
            }
            let force = self.force().at(place);
            let f = started::<L, Q>(excess, lattice_velocity(centre), gradient, (self.physics.tau, force));
            // What enters from beyond the fluid too: boundaries act from the first step on.
            self.populations.set_entering::<L, Q>(place, f.map(T::of));
        }
        // What open faces learned was of another flow.
        self.beyond.open.set_seen(&vec![[0.0; 2]; self.beyond.open.seen().len()]);
        self.look_at_open_faces();
    }

    /// Lets open faces look at the flow as it is.
    pub(crate) fn look_at_open_faces(&mut self) {
        let force = Force::of(&self.physics, &self.field);
        self.beyond.open.look::<L, T, Q>(&self.populations, force);
    }

    /// Sets the body force per mass \[m/s^2\], from the next step on.
    ///
    /// # Errors
    /// When it is not finite; the one before stays.
    pub fn set_acceleration(&mut self, acceleration: <L::Dim as Dim>::Vec) -> Result<(), SetupError> {
        if !acceleration.is_finite() {
            return Err(SetupError::new("acceleration", format!("{acceleration:?} m/s^2"), "finite numbers"));
        }
        self.setup.acceleration = acceleration;
        self.physics = self.physics_at(self.steps);
        self.parameters = self.physics.parameters::<L, T, Q>();
        self.step = step_function::<L, T, Q>(&self.physics);
        Ok(())
    }

    /// What a collision needs after so many steps.
    fn physics_at(&self, steps: u64) -> Physics {
        let Setup { spacing, time_step, body_force, .. } = &self.setup;
        let time = steps as f64 * time_step;
        let mut physics = self.physics;
        let mut acceleration = self.setup.acting_acceleration();
        if let Some(force) = body_force {
            let varying = force.uniform(time).padded();
            acceleration = std::array::from_fn(|axis| acceleration[axis] + varying[axis]);
            physics.field_factor = force.factor(time);
        }
        physics.force = acceleration.map(|a| a * time_step.powi(2) / spacing);
        physics
    }

    /// Takes the body force of the time reached, if there is one that varies.
    pub(crate) fn follow_body_force(&mut self) {
        let Some(force) = &self.setup.body_force else { return };
        if force.is_asked_everywhere() {
            self.field.fill(&self.setup, self.steps as f64 * self.setup.time_step);
        }
        self.physics = self.physics_at(self.steps);
        self.parameters = self.physics.parameters::<L, T, Q>();
    }

    /// The force on any cell at the time reached.
    pub(crate) fn force(&self) -> Force<'_, T> {
        Force::of(&self.physics, &self.field)
    }

    fn apply_boundaries(&mut self) {
        self.beyond.copies.apply(&mut self.populations);
        for obstacle in &mut self.beyond.obstacles {
            obstacle.apply::<L, Q>(&mut self.populations);
        }
        let force = Force::of(&self.physics, &self.field);
        self.beyond.open.apply::<L, T, Q>(&mut self.populations, force);
    }

    /// Advances; the step must be that of the setup.
    pub(crate) fn advance_by(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        check_step(dt)?;
        if dt != self.setup.time_step {
            let why = format!("the lattice has a step of {:e} s", self.setup.time_step);
            return Err(StepError::Step { dt, why });
        }
        self.meet_moved_obstacles()?;
        self.meet_immersed_grains()?;
        let is_paired = steps >= PAIRED && self.is_pairable();
        if is_paired {
            self.sort_links();
        }
        let (one, two) = self.step;
        let mut left = steps;
        while left > 0 {
            let bound = T::of(BEYOND);
            let (taken, is_beyond) = if is_paired && left > 1 && self.populations.layout == Layout::Natural {
                let second = match &self.setup.body_force {
                    Some(_) => self.physics_at(self.steps + 1).parameters::<L, T, Q>(),
                    None => self.parameters,
                };
                let parameters = [self.parameters, second];
                self.row_links.take_dues(&self.beyond.obstacles);
                let populations = &mut self.populations;
                let is_beyond = two(
                    populations,
                    self.immersed.places(&self.runs),
                    &self.row_links,
                    &self.field,
                    &parameters,
                    bound,
                );
                self.row_links.hand_over_kept(&mut self.beyond.obstacles);
                (2, is_beyond)
            } else {
                let populations = &mut self.populations;
                let places = self.immersed.places(&self.runs);
                (1, one(populations, places, &self.field, &self.parameters, bound))
            };
            self.steps += taken;
            self.follow_body_force();
            self.apply_boundaries();
            left -= taken;
            if is_beyond {
                return Err(self.culprit());
            }
        }
        if !self.immersed.is_empty() {
            self.immersed.sum_loads(&self.setup, self.force_scale());
        }
        Ok(())
    }

    /// Whether two steps may share a pass over memory: open faces, and a force that is asked everywhere, act on all cells
    /// between.
    fn is_pairable(&self) -> bool {
        let is_asked = self.setup.body_force.as_ref().is_some_and(BodyForce::is_asked_everywhere);
        L::Dim::N == 2 && self.beyond.open.is_empty() && !is_asked
    }

    /// Links as they are now, for steps in pairs.
    fn sort_links(&mut self) {
        self.row_links.fill(&self.populations.grid, &self.beyond.copies, &self.beyond.obstacles);
    }

    /// Names the first cell whose state makes no sense.
    fn culprit(&self) -> StepError {
        let found = self.fluid().find(|(_, place)| {
            let (excess, _) = self.moments(*place);
            excess.is_nan() || excess.abs() >= 0.5
        });
        // What the guard saw may be a population at rest whose cell has a density that others make up for.
        let deviation = |place: usize| self.populations.entering::<L, Q>(place)[0].double().abs();
        let worst = || self.fluid().max_by(|a, b| deviation(a.1).total_cmp(&deviation(b.1)));
        let (cell, place) = found.or_else(worst).expect("some cells are fluid");
        let (excess, momentum) = self.moments(place);
        let resting = deviation(place) / L::WEIGHTS[0];
        if excess.is_finite() && resting.is_finite() && momentum.iter().all(|c| c.is_finite()) {
            // Half of the density at rest is as wrong as half more: what is judged is the distance from 1.
            let (off, allowed) =
                if found.is_some() { (excess, 0.5) } else { (resting, BEYOND / L::WEIGHTS[0]) };
            return StepError::TooStiff {
                what: format!(
                    "density over that at rest in cell {cell:?} after step {} is {:.4}; its distance from 1",
                    self.steps,
                    1.0 + off
                ),
                value: off.abs(),
                allowed,
                hint: "the flow is too fast or too little viscous for its cells: take a smaller step (Mach number) \
                       or smaller cells (grid Reynolds number), or the operator Regularised"
                    .to_owned(),
            };
        }
        let id = cell_index(self.setup.cells, cell) as u64;
        StepError::NotFinite { solver: "lattice Boltzmann", quantity: "density", id, step: self.steps }
    }

    /// Density excess and momentum in lattice units, half of the force included.
    pub(crate) fn moments(&self, place: usize) -> (f64, [f64; 3]) {
        let f = self.populations.entering::<L, Q>(place).map(T::double);
        moments::<L, Q>(&f, self.force().at(place))
    }

    /// Pressure \[Pa\] over that at rest and velocity \[m/s\] in a cell; none inside an obstacle.
    ///
    /// # Panics
    /// When the cell lies outside the domain.
    pub fn flow(&self, cell: [usize; 3]) -> Option<Flow<L::Dim>> {
        assert!((0..3).all(|axis| cell[axis] < self.setup.cells[axis]), "cell {cell:?} lies outside");
        if !self.is_fluid(cell) {
            return None;
        }
        let (excess, momentum) = self.moments(self.populations.grid.place(cell.map(|x| x as i64)));
        let speed = self.setup.lattice_speed();
        let velocity = momentum.map(|j| j / (1.0 + excess) * speed);
        let velocity = Vector::from_slice(&velocity[..L::Dim::N]).expect("one component per axis");
        Some(Flow { pressure: excess / 3.0 * self.setup.density * speed * speed, velocity })
    }

    /// Number of cells that an obstacle covers, by the number of the obstacle; none for a number that no obstacle has.
    pub fn cells_in(&self, obstacle: usize) -> usize {
        self.cover.iter().filter(|number| **number as usize == obstacle + 1).count()
    }

    /// Centre of a cell \[m\].
    pub fn centre(&self, cell: [usize; 3]) -> <L::Dim as Dim>::Vec {
        Domain::of(&self.setup).centre(cell.map(|x| x as i64))
    }

    /// Force \[N, per metre of depth in the plane\] of the fluid on an obstacle in the last step, by the number of the obstacle.
    ///
    /// # Panics
    /// When no obstacle has this number.
    pub fn force_on(&self, obstacle: usize) -> <L::Dim as Dim>::Vec {
        let scale = self.force_scale();
        let force = self.loads_on(obstacle).force.map(|c| c * scale);
        Vector::from_slice(&force[..L::Dim::N]).expect("one component per axis")
    }

    /// Torque \[N m, per metre of depth in the plane\] about the centre of an obstacle, as [`Lbm::force_on`].
    ///
    /// # Panics
    /// When no obstacle has this number.
    pub fn torque_on(&self, obstacle: usize) -> <L::Dim as Dim>::Spin {
        let scale = self.force_scale() * self.setup.spacing;
        granular_core::Spin::of_components(self.loads_on(obstacle).torque.map(|c| c * scale))
    }

    fn loads_on(&self, obstacle: usize) -> &Cuts<T> {
        let count = self.beyond.obstacles.len();
        assert!(obstacle < count, "there is no obstacle {obstacle} among {count}, counted from 0");
        &self.beyond.obstacles[obstacle]
    }

    /// One lattice unit of force: density h^N h / dt^2.
    pub(crate) fn force_scale(&self) -> f64 {
        let Setup { spacing, time_step, density, .. } = self.setup;
        density * spacing.powi(L::Dim::N as i32 + 1) / (time_step * time_step)
    }
}

/// Populations of a given density, velocity and velocity gradient (`gradient[a][b]` is the derivative of `u_b` along
/// `a`), to first order in the gradient.
fn started<L: Lattice<Q>, const Q: usize>(
    excess: f64,
    velocity: [f64; 3],
    gradient: [[f64; 3]; 3],
    (tau, force): (f64, [f64; 3]),
) -> [f64; Q] {
    let trace: f64 = (0..3).map(|axis| gradient[axis][axis]).sum();
    let mut f = equilibrium::<L, Q>(excess, velocity);
    for (i, f) in f.iter_mut().enumerate() {
        let c = L::VELOCITIES[i].map(f64::from);
        let strained: f64 = (0..3).map(|a| (0..3).map(|b| c[a] * c[b] * gradient[a][b]).sum::<f64>()).sum();
        let stress = -3.0 * tau * (1.0 + excess) * (strained - trace / 3.0);
        *f += L::WEIGHTS[i] * (stress - 1.5 * dot(L::VELOCITIES[i], force));
    }
    f
}
