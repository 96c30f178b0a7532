//! Fields from the sums in cells.

use super::catalogue::{OUTSIDE, fields, needs, shown};
use super::grid::CoarseGrid;
use super::source::{CoarseSource, Kind};
use super::sums::{Bulk, Sums, Wanted, mean_velocity};
use crate::dim::{Dim, Linear, Vector};
use crate::field::{FieldRef, FieldSink, Shown};
use crate::tensor::SymmetricTensor;
use glam::DVec3;

/// Fields of a continuum at one time, one value per cell, x fastest. Where there is no grain, densities and stresses are
/// zero, and means over grains are not a number.
#[derive(Clone, Debug)]
pub struct CoarseFields<D: Dim> {
    grid: CoarseGrid<D>,
    sums: Sums<D>,
    kind: Kind,
}

/// The value, or not a number where there is none.
fn or_nothing(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}

impl<D: Dim> CoarseFields<D> {
    /// All fields of what a solver lends.
    pub fn of(source: &CoarseSource<'_, D>, grid: &CoarseGrid<D>) -> Self {
        Self { grid: *grid, sums: Sums::of(source, grid, Wanted::ALL), kind: source.kind() }
    }

    /// Shows fields on a grid; sums only what the sink wants, and asks for no `source` when it wants nothing.
    pub fn show_of<'a>(
        source: impl FnOnce() -> CoarseSource<'a, D>,
        grid: &CoarseGrid<D>,
        sink: &mut dyn FieldSink,
    ) {
        let Some(wanted) = needs(|name| sink.wants(name)) else { return };
        let source = source();
        Self { grid: *grid, sums: Sums::of(&source, grid, wanted), kind: source.kind() }.show(sink);
    }

    /// Everything that [`CoarseFields::show_of`] can show of grains.
    pub fn catalogue() -> Vec<Shown> {
        shown(Kind::Grains)
    }

    /// Everything that it can show of particles that carry stresses themselves; more when their grains are known
    /// ([`CoarseSource::constituents`]).
    pub fn catalogue_of_continuum(knows_grains: bool) -> Vec<Shown> {
        shown(if knows_grains { Kind::ContinuumOfGrains } else { Kind::Continuum })
    }

    fn per_volume<T>(&self, sums: &[T], value: impl Fn(&T) -> f64) -> Vec<f64> {
        let volume = self.grid.cell_volume();
        sums.iter().map(|sum| value(sum) / volume).collect()
    }

    fn per_mass(&self, value: impl Fn(usize, &Bulk<D>) -> f64) -> Vec<f64> {
        let of = |(cell, bulk): (usize, &Bulk<D>)| (bulk.mass > 0.0).then(|| value(cell, bulk) / bulk.mass);
        self.sums.bulk.iter().enumerate().map(|cell| or_nothing(of(cell))).collect()
    }

    /// The grid.
    pub fn grid(&self) -> &CoarseGrid<D> {
        &self.grid
    }

    /// Mass that the kernel spreads beyond the grid \[kg\]: with that of all cells it is the mass of all grains.
    pub fn mass_outside(&self) -> f64 {
        self.sums.outside
    }

    /// Mass per volume \[kg/m^3\].
    pub fn density(&self) -> Vec<f64> {
        self.per_volume(&self.sums.bulk, |bulk| bulk.mass)
    }

    /// Volume of grains per volume \[-\].
    pub fn solid_fraction(&self) -> Vec<f64> {
        self.per_volume(&self.sums.bulk, |bulk| bulk.volume)
    }

    /// Grains per volume \[1/m^3; 1/m^2 in the plane\].
    pub fn number_density(&self) -> Vec<f64> {
        self.per_volume(&self.sums.bulk, |bulk| bulk.number)
    }

    /// Diameter, mean by mass \[m\].
    pub fn mean_diameter(&self) -> Vec<f64> {
        self.per_mass(|_, bulk| bulk.diameter)
    }

    /// Momentum per volume \[kg/(m^2 s)\].
    pub fn momentum(&self) -> Vec<D::Vec> {
        let volume = self.grid.cell_volume();
        self.sums.bulk.iter().map(|bulk| bulk.momentum * (1.0 / volume)).collect()
    }

    /// Velocity \[m/s\]: momentum over density.
    pub fn velocity(&self) -> Vec<D::Vec> {
        let nothing = D::Vec::splat(f64::NAN);
        self.sums.bulk.iter().map(|bulk| mean_velocity(bulk).unwrap_or(nothing)).collect()
    }

    /// Derivatives of the velocity along each axis \[1/s\]; none where there is no grain.
    pub fn velocity_gradient(&self) -> Vec<Option<[D::Vec; 3]>> {
        let gradient = |(bulk, slopes): (&Bulk<D>, &super::sums::Slopes<D>)| {
            let mean = mean_velocity(bulk)?;
            let scale = 1.0 / (bulk.mass * self.grid.spacing());
            // Of p / rho, with p and rho differentiated exactly.
            Some(std::array::from_fn(|axis| (slopes.momentum[axis] - mean * slopes.mass[axis]) * scale))
        };
        self.sums.bulk.iter().zip(&self.sums.slopes).map(gradient).collect()
    }

    /// Symmetric part of the gradient of the velocity \[1/s\].
    pub fn strain_rate(&self) -> Vec<SymmetricTensor> {
        let nothing = SymmetricTensor::IDENTITY * f64::NAN;
        self.velocity_gradient().iter().map(|g| g.as_ref().map_or(nothing, strain_rate_of::<D>)).collect()
    }

    /// Curl of the velocity \[1/s\].
    pub fn vorticity(&self) -> Vec<D::Spin> {
        let curl = |gradient: &[D::Vec; 3]| {
            (0..D::N)
                .fold(D::Spin::ZERO, |sum, axis| sum + D::cross(D::Vec::along(axis, 1.0), gradient[axis]))
        };
        let nothing = || D::Spin::ZERO * f64::NAN;
        self.velocity_gradient().iter().map(|g| g.as_ref().map_or_else(nothing, curl)).collect()
    }

    /// `sqrt(2 e:e)` of the deviator `e` of the strain rate \[1/s\].
    pub fn shear_rate(&self) -> Vec<f64> {
        let rate = |gradient: &[D::Vec; 3]| {
            let strain = strain_rate_of::<D>(gradient);
            // The trace over the axes that there are: the plane has two.
            let squares = strain.contract(strain) - strain.trace().powi(2) / D::N as f64;
            (2.0 * squares.max(0.0)).sqrt()
        };
        self.velocity_gradient().iter().map(|g| or_nothing(g.as_ref().map(rate))).collect()
    }

    /// Stress carried by contacts \[Pa\], its symmetric part, positive in compression.
    pub fn contact_stress(&self) -> Vec<SymmetricTensor> {
        let volume = self.grid.cell_volume();
        self.sums.pushes.iter().map(|pushes| pushes.stress * (1.0 / volume)).collect()
    }

    /// Stress carried by velocities about the mean \[Pa\], positive in compression.
    pub fn kinetic_stress(&self) -> Vec<SymmetricTensor> {
        let volume = self.grid.cell_volume();
        self.sums.kinetic.iter().map(|&kinetic| kinetic * (1.0 / volume)).collect()
    }

    /// Contact and kinetic stress \[Pa\].
    pub fn stress(&self) -> Vec<SymmetricTensor> {
        self.contact_stress().into_iter().zip(self.kinetic_stress()).map(|(a, b)| a + b).collect()
    }

    /// Mean of the normal stresses along the axes \[Pa\].
    pub fn pressure(&self) -> Vec<f64> {
        // In the plane a continuum has a stress across it, which grains do not.
        let along = |stress: &SymmetricTensor| stress.trace() - if D::N == 2 { stress.zz } else { 0.0 };
        self.stress().iter().map(|stress| along(stress) / D::N as f64).collect()
    }

    /// Mean square of the velocities about the mean, per axis \[m^2/s^2\].
    pub fn granular_temperature(&self) -> Vec<f64> {
        self.per_mass(|cell, _| self.sums.kinetic[cell].trace() / D::N as f64)
    }

    /// Force of walls on grains per volume \[N/m^3\].
    pub fn wall_force(&self) -> Vec<D::Vec> {
        let volume = self.grid.cell_volume();
        self.sums.pushes.iter().map(|pushes| pushes.walls * (1.0 / volume)).collect()
    }

    /// Contacts per grain, walls included \[-\].
    pub fn coordination(&self) -> Vec<f64> {
        let of = |(bulk, cell): (&Bulk<D>, usize)| {
            (bulk.number > 0.0).then(|| self.sums.fabric[cell].contacts / bulk.number)
        };
        self.sums.bulk.iter().zip(0..).map(|cell| or_nothing(of(cell))).collect()
    }

    /// Mean of `n n` over the contacts of grains \[-\]: its trace is one.
    pub fn fabric(&self) -> Vec<SymmetricTensor> {
        let of = |fabric: &super::sums::Fabric| {
            let share = if fabric.contacts > 0.0 { 1.0 / fabric.contacts } else { f64::NAN };
            fabric.normals * share
        };
        self.sums.fabric.iter().map(of).collect()
    }

    /// Inertial number \[-\] after \[GdrMidi2004\]: `shear rate * diameter * sqrt(density of grains / pressure)`; not a
    /// number where nothing presses.
    pub fn inertial_number(&self) -> Vec<f64> {
        let (rates, pressures, diameters) = (self.shear_rate(), self.pressure(), self.mean_diameter());
        let number = |(cell, bulk): (usize, &Bulk<D>)| {
            let solid = bulk.mass / bulk.volume;
            let pressed = pressures[cell] > 0.0;
            or_nothing(pressed.then(|| rates[cell] * diameters[cell] * (solid / pressures[cell]).sqrt()))
        };
        self.sums.bulk.iter().enumerate().map(number).collect()
    }

    /// Shows what the sink wants; it must have been summed.
    fn show(&self, sink: &mut dyn FieldSink) {
        for &(name, unit, _) in fields(self.kind) {
            if sink.wants(name) {
                self.show_one(name, unit, sink);
            }
        }
        if sink.wants(OUTSIDE) {
            sink.number(OUTSIDE, "kg", self.mass_outside());
        }
    }

    fn show_one(&self, name: &str, unit: &str, sink: &mut dyn FieldSink) {
        let mut scalar = |values: Vec<f64>| sink.field(name, unit, FieldRef::Scalar(&values));
        match name {
            "density" => return scalar(self.density()),
            "solid_fraction" => return scalar(self.solid_fraction()),
            "number_density" => return scalar(self.number_density()),
            "mean_diameter" => return scalar(self.mean_diameter()),
            "speed" => return scalar(self.velocity().iter().map(|v| v.length()).collect()),
            "shear_rate" => return scalar(self.shear_rate()),
            "pressure" => return scalar(self.pressure()),
            "granular_temperature" => return scalar(self.granular_temperature()),
            "coordination" => return scalar(self.coordination()),
            "inertial_number" => return scalar(self.inertial_number()),
            _ => {}
        }
        let mut tensor = |values: Vec<SymmetricTensor>| sink.field(name, unit, FieldRef::Tensor(&values));
        match name {
            "strain_rate" => return tensor(self.strain_rate()),
            "stress" => return tensor(self.stress()),
            "contact_stress" => return tensor(self.contact_stress()),
            "kinetic_stress" => return tensor(self.kinetic_stress()),
            "fabric" => return tensor(self.fabric()),
            _ => {}
        }
        match name {
            "momentum" => sink.field(name, unit, D::vector_field(&self.momentum())),
            "velocity" => sink.field(name, unit, D::vector_field(&self.velocity())),
            "wall_force" => sink.field(name, unit, D::vector_field(&self.wall_force())),
            _ => sink.field(name, unit, D::spin_field(&self.vorticity())),
        }
    }
}

/// Symmetric part of a gradient whose entry `a` is the derivative along axis `a`.
fn strain_rate_of<D: Dim>(gradient: &[D::Vec; 3]) -> SymmetricTensor {
    (0..D::N).fold(SymmetricTensor::ZERO, |mut sum, axis| {
        let along = DVec3::from(D::Vec::along(axis, 1.0).padded());
        sum += SymmetricTensor::dyad(along, DVec3::from(gradient[axis].padded()));
        sum
    })
}
