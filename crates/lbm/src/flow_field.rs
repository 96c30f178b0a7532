//! Pressure and velocity of all cells at once.

use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::real::Real;
use granular_core::{Blocks, Dim, Linear};

/// Cells of a block.
const BLOCK: usize = 4096;

/// Pressure and velocity of all cells of a fluid, x fastest: cell `[x, y, z]` is number
/// `(z * cells[1] + y) * cells[0] + x`.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowField<D: Dim> {
    /// Cells along each axis; 1 along z in the plane.
    pub cells: [usize; 3],
    /// Pressure over that at rest \[Pa\] of each cell; zero inside obstacles.
    pub pressures: Vec<f64>,
    /// Velocity \[m/s\] of each cell; zero inside obstacles.
    pub velocities: Vec<D::Vec>,
}

impl<D: Dim> Default for FlowField<D> {
    fn default() -> Self {
        Self { cells: [0; 3], pressures: Vec::new(), velocities: Vec::new() }
    }
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Pressure \[Pa\] and velocity \[m/s\] of all cells, computed together: the values of [`Lbm::flow`], zero inside
    /// obstacles. See [`Lbm::flow_field_into`] for memory that is used again, and [`Lbm::covering`] for obstacles.
    ///
    /// ```
    /// use granular_core::{Solver, glam::DVec2};
    /// use granular_lbm::{Face, Lbm2, Setup};
    ///
    /// let mut setup = Setup::new([4, 9, 1], 1e-3, 1e-6, 0.9);
    /// setup.faces[1] = [Face::REST, Face::Wall(DVec2::new(1e-3, 0.0))];
    /// let dt = setup.time_step;
    /// let mut fluid = Lbm2::new(setup)?;
    /// fluid.advance(dt, 100)?;
    /// let field = fluid.flow_field();
    /// assert_eq!(field.velocities.len(), 4 * 9);
    /// assert_eq!(field.velocities[8 * 4 + 2], fluid.flow([2, 8, 0]).expect("fluid").velocity);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn flow_field(&self) -> FlowField<L::Dim> {
        let mut field = FlowField::default();
        self.flow_field_into(&mut field);
        field
    }

    /// As [`Lbm::flow_field`], into memory that is there.
    pub fn flow_field_into(&self, field: &mut FlowField<L::Dim>) {
        let cells = self.setup().cells;
        let count = cells.iter().product();
        field.cells = cells;
        field.pressures.resize(count, 0.0);
        field.velocities.resize(count, <L::Dim as Dim>::Vec::ZERO);
        let blocks = Blocks::new(count, BLOCK);
        let work = (&mut field.pressures[..], &mut field.velocities[..]);
        blocks.for_each(work, |block, (pressures, velocities)| {
            let values = pressures.iter_mut().zip(velocities);
            for ((pressure, velocity), index) in values.zip(blocks.range(block)) {
                let flow = self.flow(self.cell(index));
                *pressure = flow.map_or(0.0, |flow| flow.pressure);
                *velocity = flow.map_or(<L::Dim as Dim>::Vec::ZERO, |flow| flow.velocity);
            }
        });
    }

    /// Pressure over that at rest \[Pa\] of all cells, x fastest; zero inside obstacles.
    pub fn pressures(&self) -> Vec<f64> {
        self.map(|cell| self.flow(cell).map_or(0.0, |flow| flow.pressure))
    }

    /// Number of the obstacle that covers a cell; none where there is fluid.
    ///
    /// # Panics
    /// When the cell lies outside the domain.
    pub fn covering(&self, cell: [usize; 3]) -> Option<usize> {
        let cells = self.setup().cells;
        assert!((0..3).all(|axis| cell[axis] < cells[axis]), "cell {cell:?} lies outside");
        (self.covered_by(cell) as usize).checked_sub(1)
    }
}
