//! The periodic cell: a parallelogram or parallelepiped whose opposite faces are one \[DEM-18\].
//!
//! A grain stands for all its images at `x + n_1 a_1 + n_2 a_2 (+ n_3 a_3)` with whole numbers
//! `n_k` \[Kumar2014, eq. 3.52\]; `a_k` are the edges of the cell. Along an axis that is not
//! periodic the cell has no edge and walls may stand.
//!
//! The cell deforms with the velocity gradient `L`, `a_k' = L a_k`, each component of which is
//! given as a rate or follows a stress. Velocities `u` of grains are those relative to that flow:
//!
//! ```text
//! x' = u + L x        u' = F / m + g - L u
//! ```
//!
//! which no shift of the origin or by an edge changes: a grain that leaves through one face and
//! enters through the opposite one keeps its velocity. The images of a cell in simple shear slide
//! past each other as those of Lees and Edwards do \[LeesEdwards1972\]. For steady shear (`L L = 0`) these are Newton's
//! equations of the laboratory; otherwise the term `m (L' + L L) x`, which would depend on the
//! place of the origin, is left out, as it must in any cell.
//!
//! The power that goes in is `-V sigma : L` with the stress of the cell `sigma` (positive in
//! compression here), `V sigma = sum m u (x) u + sum r (x) F` over grains and contacts.

mod control;
pub(crate) mod images;
pub(crate) mod motion;
mod show;
mod state;
mod step;

pub use control::{CellControl, Control};
pub use granular_core::Matrix;

use crate::material::SetupError;
use granular_core::{Dim, Linear, Vector};

/// Whole numbers of edges by which an image is away from its grain.
pub type Shift = [i8; 3];

/// A periodic cell.
#[derive(Clone, Debug)]
pub struct PeriodicCell<D: Dim> {
    pub(crate) low: D::Vec,
    /// Edges; unit vectors along axes that are not periodic.
    pub(crate) edges: Matrix<D>,
    pub(crate) periodic: [bool; 3],
    pub(crate) control: CellControl,
    /// Velocity gradient of the present step \[1/s\].
    pub(crate) gradient: Matrix<D>,
    /// Velocity over place at the end of the last step \[1/s\].
    pub(crate) last_gradient: Matrix<D>,
    /// Integral of the gradient over time \[-\].
    pub(crate) strain: Matrix<D>,
    /// Work done on the grains by deformation \[J\].
    pub(crate) work: f64,
    /// Bound on how far any grain moved against the cell since all were last put inside \[m\].
    pub(crate) drift: f64,
    /// Rate of the edges \[m/s\]: of this step within it, of the next one between steps.
    pub(crate) edge_rate: Matrix<D>,
    /// Scratch: the same on the way from the middle of the last step to the middle of this one.
    pub(crate) start_rate: Matrix<D>,
    /// Scratch: edges by which grains were last put back.
    pub(crate) wraps: Vec<Shift>,
    /// Scratch: laboratory velocities at the start of a step.
    pub(crate) start_velocity: Vec<D::Vec>,
    /// Scratch: one sum per block.
    pub(crate) sums: Vec<Sums<D>>,
}

/// Sums over the grains of a block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums<D: Dim> {
    /// Force times place plus momentum times velocity \[J\].
    pub(crate) virial: Matrix<D>,
    /// Mass times place \[kg m\].
    pub(crate) moment: D::Vec,
}

impl<D: Dim> PeriodicCell<D> {
    /// A cell at rest with edges along the axes: lowest corner `low` and size \[m\], and which
    /// axes are periodic. Corner and size of other axes have no meaning.
    ///
    /// # Errors
    /// When a size is not positive, or no axis is periodic.
    pub fn new(low: D::Vec, size: D::Vec, periodic: &[bool]) -> Result<Self, SetupError> {
        let sizes =
            (0..D::N.min(periodic.len())).filter(|&axis| periodic[axis]).map(|axis| size.component(axis));
        if let Some(size) = sizes.into_iter().find(|size| !(*size > 0.0 && size.is_finite())) {
            return Err(SetupError::new("size of the cell", size, "positive and finite"));
        }
        let edges = Matrix::from_fn(|row, column| if row == column { size.component(row) } else { 0.0 });
        Self::with_edges(low, edges, periodic)
    }

    /// A cell at rest with these edges \[m\], one per column. Those of periodic axes must not leave the
    /// space of the periodic axes; others have no meaning.
    ///
    /// # Errors
    /// When the edges span no volume, or no axis is periodic.
    pub fn with_edges(low: D::Vec, edges: Matrix<D>, periodic: &[bool]) -> Result<Self, SetupError> {
        if periodic.len() != D::N || !periodic.contains(&true) {
            let found = periodic.iter().filter(|&&is| is).count() as f64;
            return Err(SetupError::new(
                "periodic axes",
                found,
                "one choice per axis, at least one of them true",
            ));
        }
        let mut cell = Self {
            low,
            edges,
            periodic: std::array::from_fn(|axis| periodic.get(axis).copied().unwrap_or(false)),
            control: CellControl::default(),
            gradient: Matrix::zero(),
            last_gradient: Matrix::zero(),
            strain: Matrix::zero(),
            work: 0.0,
            drift: 0.0,
            edge_rate: Matrix::zero(),
            start_rate: Matrix::zero(),
            wraps: Vec::new(),
            start_velocity: Vec::new(),
            sums: Vec::new(),
        };
        for axis in 0..D::N {
            if !cell.periodic[axis] {
                cell.edges.columns[axis] = D::Vec::along(axis, 1.0);
            }
        }
        for column in (0..D::N).filter(|&k| cell.periodic[k]) {
            for row in (0..D::N).filter(|&k| !cell.periodic[k]) {
                let out = cell.edges.at(row, column);
                if out != 0.0 {
                    return Err(SetupError::new("edge of the cell along a fixed axis", out, "zero"));
                }
            }
        }
        let volume = cell.edges.determinant();
        if !(volume > 0.0 && volume.is_finite() && low.is_finite()) {
            return Err(SetupError::new("volume of the cell", volume, "positive and finite"));
        }
        Ok(cell)
    }

    /// Lowest corner \[m\]; it stays where it is.
    pub fn low(&self) -> D::Vec {
        self.low
    }

    /// Edges \[m\], one per column; unit vectors along axes that are not periodic.
    pub fn edges(&self) -> &Matrix<D> {
        &self.edges
    }

    /// Whether an axis is periodic.
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.periodic[axis]
    }

    /// Whether all axes are periodic: only then the cell has a volume, a stress and a density.
    pub fn is_closed(&self) -> bool {
        (0..D::N).all(|axis| self.periodic[axis])
    }

    /// Area or volume \[m^2 or m^3\]; `None` unless all axes are periodic.
    pub fn volume(&self) -> Option<f64> {
        self.is_closed().then(|| self.edges.determinant())
    }

    /// Velocity gradient \[1/s\].
    pub fn gradient(&self) -> &Matrix<D> {
        &self.gradient
    }

    /// Integral of the velocity gradient over time \[-\].
    pub fn strain(&self) -> &Matrix<D> {
        &self.strain
    }

    /// Work that the deformation of the cell did on the grains \[J\]; zero unless the ledger is kept.
    pub fn work(&self) -> f64 {
        self.work
    }

    /// How components of the gradient are chosen.
    pub fn control(&self) -> &CellControl {
        &self.control
    }

    /// Whether it deforms now, did in the last step, or may in the next one.
    pub(crate) fn deforms(&self) -> bool {
        let still = Matrix::zero();
        self.control.deforms() || self.gradient != still || self.last_gradient != still
    }

    /// Place of an image of the origin \[m\].
    #[inline(always)]
    pub(crate) fn offset(&self, shift: Shift) -> D::Vec {
        let columns = self.edges.columns.iter().zip(shift).take(D::N);
        columns.fold(D::Vec::ZERO, |offset, (&edge, n)| offset + edge * f64::from(n))
    }

    /// Distance of opposite faces \[m\]; infinite along axes that are not periodic.
    pub(crate) fn widths(&self) -> [f64; 3] {
        let inverse = self.edges.inverse();
        std::array::from_fn(|axis| {
            if axis >= D::N || !self.periodic[axis] {
                return f64::INFINITY;
            }
            // The rows of the inverse are the normals of the faces over their distances.
            (0..D::N).map(|column| inverse.at(axis, column).powi(2)).sum::<f64>().sqrt().recip()
        })
    }

    /// The smallest distance of opposite faces \[m\].
    pub fn narrowest(&self) -> f64 {
        self.widths().into_iter().fold(f64::INFINITY, f64::min)
    }

    /// All shifts but none, in a fixed order.
    pub(crate) fn shifts(&self) -> impl Iterator<Item = Shift> + '_ {
        let reach = |axis: usize| if axis < D::N && self.periodic[axis] { -1..=1_i8 } else { 0..=0 };
        reach(2)
            .flat_map(move |z| reach(1).flat_map(move |y| reach(0).map(move |x| [x, y, z])))
            .filter(|shift| *shift != [0; 3])
    }
}
