//! Body forces that vary in space, in time or in both.
//!
//! A step takes the force at its beginning, and a velocity has half of the force at its own time in it: together the
//! trapezoidal rule, of second order in time \[Guo2002\]. Time is the number of steps times the step, so that splits and
//! restarts keep every bit.

use crate::collision::Physics;
use crate::obstacle::{Domain, cell_index, cells_of};
use crate::populations::Grid;
use crate::real::Real;
use crate::setup::{Setup, SetupError};
use granular_core::blocks::Blocks;
use granular_core::{Dim, Linear, Vector};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

type InSpace<D> = Arc<dyn Fn(<D as Dim>::Vec) -> <D as Dim>::Vec + Send + Sync>;
type InTime<V> = Arc<dyn Fn(f64) -> V + Send + Sync>;
type Everywhere<D> = Arc<dyn Fn(<D as Dim>::Vec, f64) -> <D as Dim>::Vec + Send + Sync>;

/// A body force per mass \[m/s^2\] that varies, beside [`Setup::acceleration`]. As that one, its force density is that of the
/// density given, not of the local one.
///
/// What depends on time is a function of the time alone \[s\], 0 at the start: it must give the same value whenever it
/// is asked.
///
/// ```
/// use granular_core::{D2, glam::DVec2};
/// use granular_lbm::{BodyForce, Setup};
/// use std::f64::consts::TAU;
///
/// // Kolmogorov flow in a periodic box of 0.1 m.
/// let mut setup = Setup::<D2>::new([2, 100, 1], 1e-3, 1e-6, 0.8);
/// setup.body_force = Some(BodyForce::in_space(|point: DVec2| DVec2::new(1e-6 * (TAU * point.y / 0.1).sin(), 0.0)));
/// ```
#[derive(Clone)]
pub struct BodyForce<D: Dim>(Kind<D>);

#[derive(Clone)]
enum Kind<D: Dim> {
    Uniform(InTime<D::Vec>),
    Space(InSpace<D>),
    Product(InSpace<D>, InTime<f64>),
    Everywhere(Everywhere<D>),
}

impl<D: Dim> BodyForce<D> {
    /// The same everywhere, changing in time: costs what a constant one does.
    pub fn in_time(acceleration: impl Fn(f64) -> D::Vec + Send + Sync + 'static) -> Self {
        Self(Kind::Uniform(Arc::new(acceleration)))
    }

    /// A function of the place \[m\] that does not change: asked once for each cell, and stored as one number per axis
    /// and cell, which each step reads.
    pub fn in_space(acceleration: impl Fn(D::Vec) -> D::Vec + Send + Sync + 'static) -> Self {
        Self(Kind::Space(Arc::new(acceleration)))
    }

    /// A function of the place \[m\], times a factor that changes in time \[s\]: costs what [`BodyForce::in_space`] does.
    pub fn in_space_times(
        acceleration: impl Fn(D::Vec) -> D::Vec + Send + Sync + 'static,
        factor: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self(Kind::Product(Arc::new(acceleration), Arc::new(factor)))
    }

    /// Any function of place \[m\] and time \[s\]: asked for each cell and step, on which a sine
    /// in the plane spends several times what the step itself takes.
    pub fn everywhere(acceleration: impl Fn(D::Vec, f64) -> D::Vec + Send + Sync + 'static) -> Self {
        Self(Kind::Everywhere(Arc::new(acceleration)))
    }

    /// At a point \[m\] and a time \[s\].
    pub fn at(&self, point: D::Vec, time: f64) -> D::Vec {
        match &self.0 {
            Kind::Uniform(acceleration) => acceleration(time),
            Kind::Space(acceleration) => acceleration(point),
            Kind::Product(acceleration, factor) => acceleration(point) * factor(time),
            Kind::Everywhere(acceleration) => acceleration(point, time),
        }
    }

    /// Whether it is stored for each cell.
    pub(crate) fn has_field(&self) -> bool {
        !matches!(self.0, Kind::Uniform(_))
    }

    /// Whether it is asked for each cell before every step.
    pub(crate) fn is_asked_everywhere(&self) -> bool {
        matches!(self.0, Kind::Everywhere(_))
    }

    /// The part that is the same everywhere, at a time \[s\].
    pub(crate) fn uniform(&self, time: f64) -> D::Vec {
        match &self.0 {
            Kind::Uniform(acceleration) => acceleration(time),
            _ => D::Vec::ZERO,
        }
    }

    /// Factor of what is stored, at a time \[s\].
    pub(crate) fn factor(&self, time: f64) -> f64 {
        match &self.0 {
            Kind::Product(_, factor) => factor(time),
            _ => 1.0,
        }
    }

    /// What is stored for a cell.
    fn stored(&self, point: D::Vec, time: f64) -> D::Vec {
        match &self.0 {
            Kind::Product(acceleration, _) => acceleration(point),
            _ => self.at(point, time),
        }
    }
}

impl<D: Dim> fmt::Debug for BodyForce<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Kind::Uniform(_) => "BodyForce::in_time(..)",
            Kind::Space(_) => "BodyForce::in_space(..)",
            Kind::Product(..) => "BodyForce::in_space_times(..)",
            Kind::Everywhere(_) => "BodyForce::everywhere(..)",
        })
    }
}

/// Force densities of cells in lattice units, per axis, in rows as long as those of the populations. Empty without a force
/// that varies in space.
#[derive(Clone, Debug, Default)]
pub(crate) struct ForceField<T> {
    values: [Vec<T>; 3],
    /// Place of the first cell, and of a row after the one before.
    origin: usize,
    pitch: usize,
}

impl<T: Real> ForceField<T> {
    /// Room for all cells, if the setup has such a force.
    pub(crate) fn new<D: Dim>(setup: &Setup<D>, grid: &Grid) -> Self {
        if !setup.body_force.as_ref().is_some_and(BodyForce::has_field) {
            return Self::default();
        }
        let [_, ny, nz] = setup.cells;
        let (origin, pitch) = (grid.row_place(0), grid.stride(1));
        let length = ((nz - 1) * (ny + 2) + ny) * pitch;
        let values =
            std::array::from_fn(|axis| if axis < D::N { vec![T::of(0.0); length] } else { Vec::new() });
        Self { values, origin, pitch }
    }

    /// Asks the force at the centres of all cells.
    pub(crate) fn fill<D: Dim>(&mut self, setup: &Setup<D>, time: f64) {
        let Some(force) = setup.body_force.as_ref().filter(|force| force.has_field()) else { return };
        let domain = Domain::of(setup);
        // As a constant one, to the bit.
        let in_lattice_units = |a: f64| T::of(a * setup.time_step.powi(2) / setup.spacing);
        let (pitch, [nx, ny, _]) = (self.pitch, setup.cells);
        let [x, y, z] = self.values.each_mut().map(|values| &mut values[..]);
        let rows = x.len() / pitch;
        // Blocks of whole rows; the axis that the plane lacks has none.
        let blocks = Blocks::new(x.len(), pitch * (rows.div_ceil(64)).max(1));
        blocks.for_each((x, y, z), |block, (x, y, z)| {
            let first = blocks.range(block).start / pitch;
            for row in 0..x.len() / pitch {
                let (line, layer) = ((first + row) % (ny + 2), (first + row) / (ny + 2));
                if line >= ny {
                    continue;
                }
                for column in 0..nx {
                    let centre = domain.centre([column, line, layer].map(|at| at as i64));
                    let here = force.stored(centre, time).padded();
                    let at = row * pitch + column;
                    (x[at], y[at]) = (in_lattice_units(here[0]), in_lattice_units(here[1]));
                    if D::N == 3 {
                        z[at] = in_lattice_units(here[2]);
                    }
                }
            }
        });
    }

    /// Forces of some cells of a row; none without a field.
    #[inline]
    pub(crate) fn of_row(&self, row: usize, cells: Range<usize>) -> [&[T]; 3] {
        let start = row * self.pitch;
        self.values.each_ref().map(|values| values.get(start + cells.start..start + cells.end).unwrap_or(&[]))
    }

    pub(crate) fn bytes(&self) -> usize {
        self.values.iter().map(|values| values.capacity() * size_of::<T>()).sum()
    }
}

/// The force density at any cell, in lattice units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Force<'a, T> {
    /// The same everywhere.
    pub(crate) uniform: [f64; 3],
    /// Factor of the field.
    pub(crate) factor: f64,
    pub(crate) field: &'a ForceField<T>,
}

impl<'a, T: Real> Force<'a, T> {
    /// At the time of the physics.
    pub(crate) fn of(physics: &Physics, field: &'a ForceField<T>) -> Self {
        Self { uniform: physics.force, factor: physics.field_factor, field }
    }

    /// Of the cell at a place.
    #[inline]
    pub(crate) fn at(&self, place: usize) -> [f64; 3] {
        let mut force = self.uniform;
        for (component, values) in force.iter_mut().zip(&self.field.values) {
            if let Some(value) = place.checked_sub(self.field.origin).and_then(|at| values.get(at)) {
                *component += self.factor * value.double();
            }
        }
        force
    }
}

/// Refuses a force that is not finite in a fluid cell at the start.
pub(crate) fn check<D: Dim>(
    setup: &Setup<D>,
    is_fluid: impl Fn([usize; 3]) -> bool,
) -> Result<(), SetupError> {
    let Some(force) = &setup.body_force else { return Ok(()) };
    let domain = Domain::of(setup);
    for cell in cells_of([[0; 3], setup.cells]).filter(|cell| is_fluid(*cell)) {
        let centre = domain.centre(cell.map(|at| at as i64));
        let found = force.at(centre, 0.0);
        if !found.is_finite() || !force.stored(centre, 0.0).is_finite() {
            let value = format!("{found:?} m/s^2 at {centre:?} m in cell {}", cell_index(setup.cells, cell));
            return Err(SetupError::new("body force", value, "finite numbers"));
        }
        if !force.has_field() {
            break;
        }
    }
    Ok(())
}
