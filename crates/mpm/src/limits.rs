//! Limits on the step.

use crate::mpm::Mpm;
use crate::setup::{Scheme, ShapeFunctions};
use granular_core::{Dim, Limits, Memory, StepError, StepLimit};

/// The longest stable step over that in which a wave crosses a cell. Measured with bodies at random places in the grid and random
/// velocities, Poisson's ratios from 0 to 0.45, 4 to 16 particles in a cell, in plane and space: these are stable, and a seventh
/// more is not for some. With affine velocities the same was measured in the plane: schemes that take strains and forces from different states
/// of the nodes bear less.
const fn stable_share(scheme: Scheme, shape: ShapeFunctions, is_affine: bool) -> f64 {
    if is_affine {
        return match (scheme, shape) {
            (Scheme::StressLast, ShapeFunctions::QuadraticBspline) => 0.9,
            (Scheme::StressLast, _) => 0.45,
            (_, ShapeFunctions::QuadraticBspline) => 1.05,
            _ => 0.6,
        };
    }
    match (scheme, shape) {
        (Scheme::StressLast, ShapeFunctions::QuadraticBspline) => 0.7,
        (Scheme::StressLast, ShapeFunctions::UniformGimp) => 0.4,
        (Scheme::StressLast, ShapeFunctions::Linear) => 0.25,
        (_, ShapeFunctions::QuadraticBspline) => 1.6,
        _ => 1.2,
    }
}

/// A limit and where it comes from.
struct Found {
    dt: f64,
    why: String,
}

impl<D: Dim> Mpm<D> {
    /// Longest stable step \[s\] as things are; infinite without particles.
    pub fn stable_step(&self) -> f64 {
        self.wave_step().0.min(self.viscous_step().0)
    }

    /// Step to take \[s\]: the Courant number of the options times the longest stable one.
    pub fn recommended_step(&self) -> f64 {
        self.options.courant * self.stable_step()
    }

    /// The step in which a wave crosses a cell, and the speed of the wave.
    fn wave_step(&self) -> (f64, f64) {
        let speeds = self.groups.iter().map(|group| group.body.wave_speed(group.density / group.looseness));
        let wave = speeds.fold(0.0, f64::max);
        let share = stable_share(self.options.scheme, self.options.shape, self.kernels.affine.is_some());
        (share * self.grid.lattice.cell / (wave + self.fastest), wave)
    }

    /// The step in which momentum diffuses across a cell, and the kinematic viscosity.
    fn viscous_step(&self) -> (f64, f64) {
        let cell = self.grid.lattice.cell;
        let of = self.groups.iter().map(|group| group.body.viscosity() * group.looseness / group.density);
        let viscosity = of.fold(0.0, f64::max);
        (cell * cell / (8.0 / 3.0 * D::N as f64 * viscosity), viscosity)
    }

    fn found(&self) -> [Option<Found>; 2] {
        let ((wave_step, wave), (viscous_step, viscosity)) = (self.wave_step(), self.viscous_step());
        let (cell, speed) = (self.grid.lattice.cell, self.fastest);
        let wave = Found {
            dt: wave_step,
            why: format!(
                "a wave of {wave:.4} m/s in what moves at {speed:.4} m/s crosses a cell of {cell:e} m"
            ),
        };
        let viscous = Found {
            dt: viscous_step,
            why: format!("a viscosity of {viscosity:e} m^2/s levels velocities over a cell of {cell:e} m"),
        };
        [wave, viscous].map(|found| found.dt.is_finite().then_some(found))
    }

    pub(crate) fn report_hard_limits(&self, report: &mut Limits) {
        for (name, found) in ["wave across a cell", "viscosity"].into_iter().zip(self.found()) {
            report.steps.extend(found.map(|found| StepLimit::at_most(name, found.dt, found.why)));
        }
    }

    pub(crate) fn report_limits(&self, report: &mut Limits) {
        self.report_hard_limits(report);
        let dt = self.recommended_step();
        if dt.is_finite() {
            let why = format!("{} of the longest stable step", self.options.courant);
            report.steps.push(StepLimit::recommended("Courant number", dt, why));
        }
    }

    /// Refuses a step that is not stable.
    pub(crate) fn check_stability(&self, dt: f64) -> Result<(), StepError> {
        if self.any_step || dt <= self.stable_step() {
            return Ok(());
        }
        let shortest = self.found().into_iter().flatten().reduce(|a, b| if b.dt < a.dt { b } else { a });
        let Some(Found { dt: allowed, why }) = shortest else { return Ok(()) };
        Err(StepError::Step { dt, why: format!("at most {allowed:e} s is stable: {why}") })
    }

    pub(crate) fn report_memory(&self) -> Memory {
        let memory = self.groups.iter().map(|group| group.body.bytes_each()).max().unwrap_or(0);
        let each = self.particles.bytes_each() + memory + crate::sorting::Sorting::<D>::bytes_each();
        let nodes = self.grid.bytes() + size_of_val(&self.tiles[..]) + size_of_val(&self.touches.list[..]);
        let nodes = nodes + self.contacts.bytes();
        let mut left_out = Vec::new();
        let mut leave_out = |is_out: bool, what: &str| {
            if is_out {
                left_out.push(what.to_owned());
            }
        };
        leave_out(!self.kernels.has_width, "widths of particles: the shape functions have none");
        leave_out(self.kernels.affine.is_none(), "moments of velocities: they are not affine");
        leave_out(memory == 0, "memory of particles: no law has any");
        leave_out(D::N == 2, "stresses xz and yz: plane strain");
        leave_out(!self.options.ledger, "losses of energy: no ledger");
        leave_out(self.moving.is_empty(), "poses of walls: none moves");
        leave_out(self.particles.load.is_empty(), "forces on particles: no traction");
        leave_out(self.contacts.is_empty(), "velocities of each body on nodes: none are in contact");
        let nodes_each = nodes / self.len().max(1);
        Memory { bytes: each * self.len() + nodes, bytes_per_item: each + nodes_each, left_out }
    }
}
