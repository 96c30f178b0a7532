//! A solver in a periodic cell: its set-up, its step, and putting grains back inside.

use super::images::Moved;
use super::{Cell, CellControl, Matrix, Shift, motion};
use crate::dem::{Dem, view_of};
use crate::kernel::View;
use crate::material::{PairProperties, SetupError};
use granular_core::{Dim, Linear, StepError, Vector};

/// The narrowest cell over the reach of a pair: no grain may see an image of itself, and no image
/// farther than one edge away.
const NARROWEST: f64 = 1.5;
/// Share of the narrowest width that grains may drift before they are put back inside.
const DRIFT: f64 = 0.125;
/// Tilt of an edge along another, as a share of it, beyond which the cell is flipped back. Above one
/// half, so that it does not flip to and fro.
const TILT: f64 = 0.55;
/// Edges by which a grain may be outside at the start.
const FARTHEST: f64 = 100.0;

impl<D: Dim> Dem<D> {
    /// Puts the grains into a periodic cell, at rest. Grains outside are put back inside by whole edges.
    ///
    /// # Errors
    /// When the cell is too narrow for its grains.
    pub fn set_cell(&mut self, cell: Cell<D>) -> Result<(), SetupError> {
        let needed = NARROWEST * self.pair_reach();
        if cell.narrowest() < needed {
            let ratio = cell.narrowest() / self.pair_reach();
            return Err(SetupError::new("width of the cell over the reach of a pair", ratio, "at least 1.5"));
        }
        if !self.traffic.is_empty() {
            let count = self.traffic.doors() as f64;
            return Err(SetupError::new("number of inlets and outlets with a periodic cell", count, "0"));
        }
        let shares = cell.edges.inverse();
        for &position in &self.grains.position {
            let share = shares.apply(position - cell.low);
            let periodic = (0..D::N).filter(|&axis| cell.periodic[axis]);
            if let Some(far) = periodic.map(|axis| share.component(axis)).find(|share| share.abs() > FARTHEST)
            {
                return Err(SetupError::new("place of a grain in edges of the cell", far, "at most 100"));
            }
        }
        self.cell = Some(Box::new(cell));
        self.put_inside([[0; 3]; 3]);
        self.injected = 0.0;
        self.initial_energy = self.initial_energy.map(|_| self.energies().mechanical());
        Ok(())
    }

    /// The periodic cell, if there is one.
    pub fn cell(&self) -> Option<&Cell<D>> {
        self.cell.as_deref()
    }

    /// Changes what drives the cell, from the next step on. Where zero, the modulus is that of a packing,
    /// the normal stiffness times the mean diameter to the power of two less the dimension, and the response
    /// is the period with which the mean grain swings on one contact. With these, grains in a gas are compressed
    /// with an inertial number of about half the root of stress over modulus.
    ///
    /// # Errors
    /// When there is no cell, or a control does not fit it.
    pub fn control_cell(&mut self, mut control: CellControl) -> Result<(), SetupError> {
        let (modulus, response) = (self.packing_modulus(), self.grain_period());
        let Some(cell) = self.cell.as_deref_mut() else {
            return Err(SetupError::new("periodic cells", 0.0, "one: control acts on it"));
        };
        control.check(cell)?;
        if control.modulus == 0.0 {
            control.modulus = modulus;
        }
        if control.response == 0.0 {
            control.response = response;
        }
        cell.control = control;
        cell.take_rates();
        cell.edge_rate = cell.gradient.times(&cell.edges);
        Ok(())
    }

    /// Stiffness of the hardest pair as a modulus \[Pa; N/m in the plane\]: the normal stiffness times the mean
    /// diameter to the power of two less the dimension, or the effective modulus of Hertz contacts.
    pub fn packing_modulus(&self) -> f64 {
        let scale = self.mean_diameter().powi(D::N as i32 - 2);
        let modulus = |pair: &PairProperties| (pair.normal_stiffness / scale).max(pair.effective_modulus);
        self.materials.pairs().map(|(.., pair)| modulus(&pair)).fold(0.0, f64::max)
    }

    /// Period \[s\] with which the mean grain swings on one contact.
    fn grain_period(&self) -> f64 {
        let mass = self.grains.mass.iter().sum::<f64>() / self.len().max(1) as f64;
        let stiffness = self.packing_modulus() * self.mean_diameter().powi(D::N as i32 - 2);
        std::f64::consts::TAU * (mass / stiffness).sqrt()
    }

    /// Mean diameter of the grains \[m\]; zero without grains.
    pub fn mean_diameter(&self) -> f64 {
        2.0 * self.grains.radius.iter().sum::<f64>() / self.len().max(1) as f64
    }

    /// Centres farther apart than this are in no list \[m\].
    fn pair_reach(&self) -> f64 {
        2.0 * self.largest_radius() + self.reach
    }

    fn largest_radius(&self) -> f64 {
        self.grains.radius.iter().fold(0.0, |a: f64, &b| a.max(b))
    }

    /// Steps of a solver in a cell.
    pub(crate) fn advance_in_cell(&mut self, dt: f64, steps: u64) -> Result<(), StepError> {
        let largest = self.largest_radius();
        for _ in 0..steps {
            self.sort_if_due();
            self.tend_cell();
            let Some(cell) = self.cell.as_deref_mut() else { return Ok(()) };
            let steps = [self.last_dt, dt];
            motion::open_step(&mut self.grains, cell, self.blocks, steps, &mut self.speeds);
            self.load_in_cell(dt, largest)?;
        }
        self.movers.place(self.clock.time());
        Ok(())
    }

    /// One step between its two halves.
    fn load_in_cell(&mut self, dt: f64, largest: f64) -> Result<(), StepError> {
        let mut own = crate::motion::fastest(&self.speeds) * dt;
        if !self.movers.is_empty() {
            own = own.max(self.movers.fastest(dt) * dt);
            self.movers.place_in_step(self.clock.time(), dt);
        }
        let Some(cell) = self.cell.as_deref_mut() else { return Ok(()) };
        let flow = 0.5 * cell.gradient.norm() * (2.0 * largest + self.reach) * dt;
        let stride = own + flow;
        if !(stride.is_finite() && cell.edges.is_finite()) {
            return Err(self.not_finite());
        }
        cell.drift += own;
        let (narrowest, needed) =
            (cell.narrowest(), NARROWEST * (2.0 * largest + self.reach.max(4.0 * stride)));
        if narrowest < needed {
            return Err(too_narrow(narrowest, needed));
        }
        self.travel += stride;
        if 2.0 * self.travel + stride > self.reach {
            self.list(stride, None);
        }
        self.push_in_cell(dt, stride);
        self.last_dt = dt;
        if !self.movers.is_empty() {
            self.move_walls(dt);
        }
        let (losses, trouble) = self.pairs.outcome();
        self.close_in_cell(dt);
        self.steps += 1;
        self.clock.step();
        self.losses += losses;
        trouble.map_or(Ok(()), |trouble| Err(self.too_deep(trouble)))
    }

    fn push_in_cell(&mut self, dt: f64, margin: f64) {
        let mut force = std::mem::take(&mut self.grains.acceleration);
        let mut torque = std::mem::take(&mut self.grains.spin_acceleration);
        let seen = view_of(&self.grains, (&self.walls, &self.movers), &self.options, self.last_dt);
        let started = self.cell.as_deref().map(|cell| cell.start_velocity.as_slice());
        let view = View {
            velocity: &self.grains.middle_velocity,
            spin: &self.grains.middle_spin,
            start_velocity: started.filter(|list| !list.is_empty()).unwrap_or(seen.start_velocity),
            dt,
            margin,
            cell: self.cell.as_deref(),
            ..seen
        };
        self.pairs.push(&view, self.options.ledger, &mut force, &mut torque);
        (self.grains.acceleration, self.grains.spin_acceleration) = (force, torque);
    }

    /// Kick and second half of the drift; the cell books its work and follows its stress.
    fn close_in_cell(&mut self, dt: f64) {
        let Some(cell) = self.cell.as_deref_mut() else { return };
        let (pairs, blocks, gravity) = (self.pairs.as_ref(), self.blocks, self.gravity);
        if !cell.deforms() {
            let speeds = &mut self.speeds;
            return crate::motion::close_step(&mut self.grains, pairs, blocks, gravity, dt, false, speeds);
        }
        let (gradient, middle, pull) = (cell.gradient, cell.edges, pairs.pull());
        let sums = motion::close_step(&mut self.grains, cell, pairs, blocks, gravity, dt);
        let mut virial = sums.virial;
        for axis in (0..D::N).filter(|&axis| cell.periodic[axis]) {
            virial = virial.plus(&Matrix::dyad(pull[axis], middle.columns[axis]), -1.0);
        }
        if self.options.ledger {
            let of_gravity = Matrix::dyad(self.gravity, sums.moment);
            cell.work -= dt * (virial.contract(&gradient) + of_gravity.contract(&gradient));
        }
        cell.strain = cell.strain.plus(&gradient, dt);
        if cell.control.follows_stress() {
            let stress = Matrix::zero().plus(&virial, 1.0 / middle.determinant());
            cell.follow_stress(&stress, dt);
        }
        cell.last_gradient = gradient.times(&Matrix::unit().plus(&gradient, 0.5 * dt).inverse());
        cell.edge_rate = cell.gradient.times(&cell.edges);
    }

    /// Flips a cell that is tilted far, and puts grains back inside that drifted far. What it does
    /// depends on the state alone.
    fn tend_cell(&mut self) {
        let Some(cell) = self.cell.as_deref_mut() else { return };
        let flipped = cell.flip();
        if flipped.is_some() || cell.drift > DRIFT * cell.narrowest() {
            self.put_inside(flipped.unwrap_or([[0; 3]; 3]));
        }
    }

    /// Puts every grain inside the cell, by whole edges. `mixed[k][l]` of edge `l` were taken off edge
    /// `k` just before.
    fn put_inside(&mut self, mixed: [[i8; 3]; 3]) {
        let Some(cell) = self.cell.as_deref_mut() else { return };
        let shares = cell.edges.inverse();
        let mut wraps = std::mem::take(&mut cell.wraps);
        wraps.clear();
        let mut lifted = 0.0;
        for (position, &mass) in self.grains.position.iter_mut().zip(&self.grains.mass) {
            let share = shares.apply(*position - cell.low);
            let wrap: Shift = std::array::from_fn(|axis| {
                let periodic = axis < D::N && cell.periodic[axis];
                if periodic { share.component(axis).floor() as i8 } else { 0 }
            });
            if wrap != [0; 3] {
                let offset = cell.offset(wrap);
                *position -= offset;
                lifted += mass * self.gravity.dot(offset);
            }
            wraps.push(wrap);
        }
        // Energy in the field of gravity is that of the place inside: what a shift by an edge adds was
        // put in by the periodic axis, as on a slope without end.
        self.injected += lifted;
        cell.drift = 0.0;
        let recombined =
            std::array::from_fn(|l| std::array::from_fn(|k| if k == l { 1 } else { mixed[k][l] }));
        self.pairs.relocate(&Moved::Inside { recombined, wraps: &wraps });
        if let Some(cell) = self.cell.as_deref_mut() {
            cell.wraps = wraps;
        }
        self.list(0.0, None);
    }

    /// Laboratory velocities of all grains \[m/s\], unless those of the state are.
    pub(crate) fn laboratory_velocities(&self) -> Option<Vec<D::Vec>> {
        let cell = self.cell().filter(|cell| cell.gradient != Matrix::zero())?;
        let grains = self.grains.position.iter().zip(&self.grains.velocity);
        Some(grains.map(|(&x, &u)| u + cell.gradient.apply(x - cell.low)).collect())
    }
}

impl<D: Dim> Cell<D> {
    /// Takes whole edges off others that lean on them too far. `Some(mixed)` when any was: `mixed[k][l]` of
    /// edge `l` were taken off edge `k`.
    fn flip(&mut self) -> Option<[[i8; 3]; 3]> {
        for k in 0..D::N {
            for l in 0..D::N {
                if k == l || !self.periodic[k] || !self.periodic[l] {
                    continue;
                }
                let along = self.edges.columns[l];
                let tilt = self.edges.columns[k].dot(along) / along.length_squared();
                if tilt.abs() > TILT {
                    let whole = tilt.round();
                    self.edges.columns[k] -= along * whole;
                    self.edge_rate = self.gradient.times(&self.edges);
                    let mut mixed = [[0; 3]; 3];
                    mixed[k][l] = whole as i8;
                    return Some(mixed);
                }
            }
        }
        None
    }
}

fn too_narrow(width: f64, needed: f64) -> StepError {
    StepError::TooStiff {
        what: "reach of a pair over the width of the cell".to_owned(),
        value: needed / NARROWEST / width,
        allowed: 1.0 / NARROWEST,
        hint: "take more grains, or stop the cell before it gets so narrow".to_owned(),
    }
}
