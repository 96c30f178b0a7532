//! Square matrices of the plane and of space: edges of cells, velocity gradients, stresses that need not be symmetric.

use crate::dim::{Dim, Linear, Vector};

/// A matrix by its columns; those beyond the number of axes are zero.
#[derive(Clone, Copy, Debug, Default)]
pub struct Matrix<D: Dim> {
    /// Columns.
    pub columns: [D::Vec; 3],
}

impl<D: Dim> PartialEq for Matrix<D> {
    fn eq(&self, other: &Self) -> bool {
        self.columns == other.columns
    }
}

impl<D: Dim> Matrix<D> {
    /// The zero matrix.
    pub fn zero() -> Self {
        Self { columns: [D::Vec::ZERO; 3] }
    }

    /// The unit matrix.
    pub fn unit() -> Self {
        Self::from_fn(|row, column| if row == column { 1.0 } else { 0.0 })
    }

    /// By components.
    pub fn from_fn(component: impl Fn(usize, usize) -> f64) -> Self {
        let mut matrix = Self::zero();
        for column in 0..D::N {
            for row in 0..D::N {
                matrix.columns[column] += D::Vec::along(row, component(row, column));
            }
        }
        matrix
    }

    /// Component in `row` and `column`.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.columns[column].component(row)
    }

    /// Product with a vector.
    #[inline(always)]
    pub fn apply(&self, vector: D::Vec) -> D::Vec {
        let mut sum = self.columns[0] * vector.component(0);
        for axis in 1..D::N {
            sum += self.columns[axis] * vector.component(axis);
        }
        sum
    }

    /// Product with a matrix.
    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::zero();
        for axis in 0..D::N {
            product.columns[axis] = self.apply(other.columns[axis]);
        }
        product
    }

    /// This matrix plus `share` times another.
    pub fn plus(&self, other: &Self, share: f64) -> Self {
        let mut sum = *self;
        for axis in 0..D::N {
            sum.columns[axis] += other.columns[axis] * share;
        }
        sum
    }

    /// `a (x) b`.
    #[inline(always)]
    pub fn dyad(a: D::Vec, b: D::Vec) -> Self {
        let mut matrix = Self::zero();
        for axis in 0..D::N {
            matrix.columns[axis] = a * b.component(axis);
        }
        matrix
    }

    /// Sum over all components of the product with those of another.
    pub fn contract(&self, other: &Self) -> f64 {
        (0..D::N).map(|axis| self.columns[axis].dot(other.columns[axis])).sum()
    }

    /// Root of the sum of squares.
    pub fn norm(&self) -> f64 {
        self.contract(self).sqrt()
    }

    /// Whether every component is finite.
    pub fn is_finite(&self) -> bool {
        self.columns.iter().all(|column| column.is_finite())
    }

    /// Determinant, and the inverse: not finite when there is none. Gauss with pivots.
    pub fn determinant_and_inverse(&self) -> (f64, Self) {
        let n = D::N;
        let mut left: [[f64; 3]; 3] =
            std::array::from_fn(|row| std::array::from_fn(|column| self.padded(row, column)));
        let mut right: [[f64; 3]; 3] =
            std::array::from_fn(|row| std::array::from_fn(|column| f64::from(u8::from(row == column))));
        let mut determinant = 1.0;
        for pivot in 0..n {
            let largest = (pivot..n)
                .max_by(|&a, &b| left[a][pivot].abs().total_cmp(&left[b][pivot].abs()))
                .unwrap_or(pivot);
            if largest != pivot {
                left.swap(pivot, largest);
                right.swap(pivot, largest);
                determinant = -determinant;
            }
            determinant *= left[pivot][pivot];
            let scale = 1.0 / left[pivot][pivot];
            for column in 0..n {
                left[pivot][column] *= scale;
                right[pivot][column] *= scale;
            }
            for row in (0..n).filter(|&row| row != pivot) {
                let share = left[row][pivot];
                for column in 0..n {
                    left[row][column] -= share * left[pivot][column];
                    right[row][column] -= share * right[pivot][column];
                }
            }
        }
        (determinant, Self::from_fn(|row, column| right[row][column]))
    }

    /// The inverse; not finite when there is none.
    pub fn inverse(&self) -> Self {
        self.determinant_and_inverse().1
    }

    /// The determinant.
    pub fn determinant(&self) -> f64 {
        self.determinant_and_inverse().0
    }

    fn padded(&self, row: usize, column: usize) -> f64 {
        if row < D::N && column < D::N { self.at(row, column) } else { f64::from(u8::from(row == column)) }
    }

    /// The columns, for snapshots.
    pub fn to_array(self) -> [D::Vec; 3] {
        self.columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{D2, D3};

    #[test]
    fn inverses_undo_and_determinants_are_volumes() {
        let matrix = Matrix::<D3>::from_fn(|row, column| {
            [[0.0, 2.0, 0.1], [3.0, 0.5, 0.0], [0.2, 0.0, 1.5]][row][column]
        });
        let product = matrix.times(&matrix.inverse());
        assert!(product.plus(&Matrix::unit(), -1.0).norm() < 1e-15);
        assert!((matrix.determinant() - (-9.0 + 0.1 * (0.0 - 0.1))).abs() < 1e-14);
        let shear = Matrix::<D2>::from_fn(|row, column| [[2.0, 0.7], [0.0, 3.0]][row][column]);
        assert_eq!(shear.determinant(), 6.0);
        assert!(!Matrix::<D2>::zero().inverse().is_finite());
    }
}
