//! A solver in a periodic cell: its set-up, its step, and putting grains back inside.

use super::images::Moved;
use super::{CellControl, Matrix, PeriodicCell, Shift, motion};
use crate::dem::Dem;
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
    pub fn set_cell(&mut self, cell: PeriodicCell<D>) -> Result<(), SetupError> {
        let needed = NARROWEST * self.pair_reach();
        if cell.narrowest() < needed {
            let ratio = cell.narrowest() / self.pair_reach();
            return Err(SetupError::new("width of the cell over the reach of a pair", ratio, "at least 1.5"));
        }
        if !self.inlets.is_empty() {
            let count = self.inlets.doors() as f64;
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
        self.unchecked = true;
        self.cell = Some(Box::new(cell));
        self.put_inside([[0; 3]; 3]);
        self.injected = 0.0;
        self.initial_energy = self.initial_energy.map(|_| self.energies().mechanical());
        Ok(())
    }

    /// The periodic cell, if there is one.
    pub fn cell(&self) -> Option<&PeriodicCell<D>> {
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
        2.0 * self.largest + self.pairs.reach() + self.reach
    }

    /// How far the flow of the cell moves near surfaces past each other in a step \[m\]; nothing without a cell.
    pub(crate) fn stride_of_flow(&self, dt: f64) -> f64 {
        let Some(cell) = self.cell.as_deref() else { return 0.0 };
        0.5 * cell.gradient.norm() * (2.0 * self.largest + self.pairs.reach() + self.reach) * dt
    }

    /// Books that grains moved so far by themselves \[m\]; `stride` counts the flow as well.
    pub(crate) fn drift_in_cell(&mut self, own: f64, stride: f64) -> Result<(), StepError> {
        let reach = self.reach;
        let farthest = 2.0 * self.largest + self.pairs.reach();
        let Some(cell) = self.cell.as_deref_mut() else { return Ok(()) };
        cell.drift += own;
        let (narrowest, needed) = (cell.narrowest(), NARROWEST * (farthest + reach.max(4.0 * stride)));
        if narrowest < needed { Err(too_narrow(narrowest, needed)) } else { Ok(()) }
    }

    /// Kick and second half of the drift in a cell that deforms, under an acceleration \[m/s^2\]; the cell books its work
    /// and follows its stress.
    pub(crate) fn close_in_cell(&mut self, dt: f64, field: D::Vec) {
        let Some(low) = self.cell().map(PeriodicCell::low) else { return };
        let of_loads = self.grains.takes_loads.then(|| self.virial_of_loads(low));
        let Some(cell) = self.cell.as_deref_mut() else { return };
        let (pairs, blocks) = (self.pairs.as_ref(), self.blocks);
        let (gradient, middle, pull) = (cell.gradient, cell.edges, pairs.pull());
        let sums = motion::close_step(&mut self.grains, cell, pairs, blocks, field, dt);
        let mut virial = sums.virial;
        for axis in (0..D::N).filter(|&axis| cell.periodic[axis]) {
            virial = virial.plus(&Matrix::dyad(pull[axis], middle.columns[axis]), -1.0);
        }
        if let Some(of_loads) = of_loads {
            virial = virial.plus(&of_loads, -1.0);
        }
        if self.options.ledger {
            // What shakes the grains has no potential in which the flow of the cell could lift them.
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
    pub(crate) fn tend_cell(&mut self) {
        let Some(cell) = self.cell.as_deref_mut() else { return };
        let flipped = cell.flip();
        if flipped.is_some() || cell.drift > DRIFT * cell.narrowest() {
            self.put_inside(flipped.unwrap_or([[0; 3]; 3]));
        }
    }

    /// Puts grains inside that were put outside of the cell; nothing without one.
    pub(crate) fn put_back_inside(&mut self) {
        self.put_inside([[0; 3]; 3]);
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

impl<D: Dim> PeriodicCell<D> {
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
