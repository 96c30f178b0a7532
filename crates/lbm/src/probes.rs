//! Fields that tell vortices and paths: derived from the velocity when something asks for them.

use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::obstacle::cell_index;
use crate::real::Real;
use granular_core::{Dim, Vector};

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Number from the gradient of the velocity \[1/s\] in each cell: `gradient[a][b]` is the derivative of the
    /// component `b` along `a`, differenced as [`Lbm::vorticity`]. Zero inside obstacles.
    fn of_gradient(&self, number: impl Fn([[f64; 3]; 3]) -> f64 + Sync) -> Vec<f64> {
        let velocities = self.velocities();
        self.map(|cell| {
            if !self.is_fluid(cell) {
                return 0.0;
            }
            let mut gradient = [[0.0; 3]; 3];
            for (axis, row) in gradient.iter_mut().enumerate().take(L::Dim::N) {
                *row = self.slope(&velocities, cell, axis).padded();
            }
            number(gradient)
        })
    }

    /// Divergence of the velocity \[1/s\] of all cells, x fastest: what is left of compressibility.
    pub fn divergence(&self) -> Vec<f64> {
        self.of_gradient(|gradient| (0..3).map(|axis| gradient[axis][axis]).sum())
    }

    /// Q \[1/s^2\] of all cells, x fastest: half of the squared rate of rotation less half of that of strain, which is
    /// above zero in vortices \[Hunt1988\].
    pub fn q_criterion(&self) -> Vec<f64> {
        self.of_gradient(|gradient| {
            let pairs = (0..3).flat_map(|a| (0..3).map(move |b| (a, b)));
            -0.5 * pairs.map(|(a, b)| gradient[a][b] * gradient[b][a]).sum::<f64>()
        })
    }

    /// Stream function \[m^2/s\] in the plane of all cells, x fastest; none in space.
    ///
    /// `u = dpsi/dy` and `v = -dpsi/dx`, zero at the centre of the first cell: by the trapezoidal rule along the lowest row
    /// and from there up each column. Obstacles count as at rest, with walls half-way between cells, so that the value
    /// goes on through them. The difference between two points is the flow rate per depth that passes between them.
    pub fn stream_function(&self) -> Option<Vec<f64>> {
        if L::Dim::N != 2 {
            return None;
        }
        let velocities = self.velocities();
        let [width, height, _] = self.setup().cells;
        let mut values = vec![0.0; velocities.len()];
        // Between the centres of neighbours; a wall half-way leaves half of the way to the fluid.
        let between = |from: [usize; 3], to: [usize; 3], component: usize| {
            let [a, b] =
                [from, to].map(|cell| velocities[cell_index(self.setup().cells, cell)].component(component));
            let share = if self.is_fluid(from) == self.is_fluid(to) { 0.5 } else { 0.25 };
            share * self.setup().spacing * (a + b)
        };
        for x in 1..width {
            values[x] = values[x - 1] - between([x - 1, 0, 0], [x, 0, 0], 1);
        }
        for (y, x) in (1..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            values[y * width + x] = values[(y - 1) * width + x] + between([x, y - 1, 0], [x, y, 0], 0);
        }
        Some(values)
    }
}
