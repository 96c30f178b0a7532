//! Pressure and velocity at points.

use crate::lattice::Lattice;
use crate::lbm::{Flow, Lbm};
use crate::obstacle::{Domain, cells_of};
use crate::real::Real;
use granular_core::{Dim, Linear, Vector};

/// A point at which pressure and velocity are shown, as `pressure_at_<name>` and `velocity_at_<name>_x`.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge<D: Dim> {
    /// Name.
    pub name: String,
    /// Place \[m\].
    pub place: D::Vec,
}

/// Cells on each side from which a fit is made.
const REACH: i64 = 2;
/// Unknowns of a quadratic fit in space.
const MOST: usize = 10;

/// Sums of a weighted fit: normal equations, and one right side for pressure and each component of velocity.
struct Fit {
    matrix: [[f64; MOST]; MOST],
    right: [[f64; 4]; MOST],
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Pressure over that at rest \[Pa\] and velocity \[m/s\] at a point \[m\]: a quadratic fit to the fluid cells within two
    /// cells, weighted by their distance, or a linear one where these are too few. It is of third order, also on the
    /// surface of an obstacle. None where there are too few for either.
    pub fn flow_at(&self, point: <L::Dim as Dim>::Vec) -> Option<Flow<L::Dim>> {
        let n = L::Dim::N;
        let (domain, spacing) = (Domain::of(&self.setup), self.setup.spacing);
        let mut range = [[0; 3], self.setup.cells];
        for axis in 0..n {
            let at = ((point - domain.origin).component(axis) / spacing).floor() as i64;
            range[0][axis] = (at - REACH).clamp(0, self.setup.cells[axis] as i64) as usize;
            range[1][axis] = (at + REACH + 1).clamp(0, self.setup.cells[axis] as i64) as usize;
        }
        let mut fit = Fit { matrix: [[0.0; MOST]; MOST], right: [[0.0; 4]; MOST] };
        let quadratic = (n + 1) * (n + 2) / 2;
        for cell in cells_of(range) {
            let Some(flow) = self.flow(cell) else { continue };
            let arm = (self.centre(cell) - point) * (1.0 / spacing);
            let weight = (1.0 - arm.length() / (REACH as f64 + 1.5)).max(0.0).powi(2);
            let [u, v, w] = flow.velocity.padded();
            fit.add(&basis(arm.padded(), n)[..quadratic], weight, [flow.pressure, u, v, w]);
        }
        let [pressure, u, v, w] = fit.first(quadratic).or_else(|| fit.first(n + 1))?;
        let velocity = Vector::from_slice(&[u, v, w][..n]).expect("one component per axis");
        Some(Flow { pressure, velocity })
    }
}

/// One, the coordinates, and their products.
fn basis([x, y, z]: [f64; 3], axes: usize) -> [f64; MOST] {
    match axes {
        2 => [1.0, x, y, x * x, x * y, y * y, 0.0, 0.0, 0.0, 0.0],
        _ => [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x],
    }
}

impl Fit {
    fn add(&mut self, basis: &[f64], weight: f64, values: [f64; 4]) {
        for (i, left) in basis.iter().enumerate() {
            for (j, right) in basis.iter().enumerate() {
                self.matrix[i][j] += weight * left * right;
            }
            for (side, value) in values.into_iter().enumerate() {
                self.right[i][side] += weight * left * value;
            }
        }
    }

    /// The first of so many unknowns, which is the value at the point, for each right side; none when the system is
    /// singular. From the last unknown to the first, which needs no back substitution.
    fn first(&self, size: usize) -> Option<[f64; 4]> {
        let (mut matrix, mut right) = (self.matrix, self.right);
        for pivot in (0..size).rev() {
            let largest = matrix[pivot][pivot];
            if largest.is_nan() || largest <= 1e-6 * self.matrix[pivot][pivot].max(1e-6) {
                return None;
            }
            for row in 0..pivot {
                let factor = matrix[row][pivot] / largest;
                (0..=pivot).for_each(|column| matrix[row][column] -= factor * matrix[pivot][column]);
                (0..4).for_each(|side| right[row][side] -= factor * right[pivot][side]);
            }
        }
        Some(right[0].map(|value| value / matrix[0][0]))
    }
}

#[cfg(test)]
mod tests {
    use crate::{Ball, Flow, Lbm2, Obstacle, Setup};
    use granular_core::glam::DVec2;

    #[test]
    fn a_quadratic_flow_is_met_exactly_also_at_a_surface() {
        let mut setup = Setup::new([40, 40, 1], 1e-3, 1e-6, 0.8);
        setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::splat(0.02), radius: 5e-3 }));
        let speed = setup.lattice_speed();
        let pressure = move |p: DVec2| speed * speed * (0.1 + 3.0 * p.x - 20.0 * p.y * p.x);
        let velocity = move |p: DVec2| DVec2::new(1.0 + 30.0 * p.y * p.y, 2.0 * p.x) * (0.01 * speed);
        let mut fluid = Lbm2::new(setup).unwrap();
        fluid.set_flow(|p| Flow { pressure: pressure(p), velocity: velocity(p) });
        for point in [DVec2::new(0.0333, 0.0217), DVec2::new(0.015, 0.02), DVec2::new(0.02, 0.025)] {
            let found = fluid.flow_at(point).unwrap();
            assert!((found.pressure - pressure(point)).abs() < 1e-9 * speed * speed, "{point}: {found:?}");
            assert!((found.velocity - velocity(point)).length() < 1e-9 * speed, "{point}: {found:?}");
        }
        assert!(fluid.flow_at(DVec2::splat(0.02)).is_none());
        assert!(fluid.flow_at(DVec2::splat(0.5)).is_none());
    }
}
