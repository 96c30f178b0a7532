//! What drives a cell: a rate or a stress for each component of its velocity gradient.

use super::{Matrix, PeriodicCell};
use crate::material::SetupError;
use granular_core::Dim;

/// How one component of the velocity gradient is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// A rate \[1/s\], held.
    Rate(f64),
    /// A stress \[Pa; N/m in the plane\], positive in compression, that the cell follows.
    Stress(f64),
}

/// Controls of all components; `component[i][j]` is that of `d v_i / d x_j`, held still by default.
///
/// Under stress control a component obeys
///
/// ```text
/// I L' = sigma - target - eta L,      I = M (T / 2 pi)^2,   eta = M T / pi
/// ```
///
/// with `T` the `response` time and `M` the `modulus`: an elastic sample of that modulus would make the
/// cell a critically damped oscillator of period `T`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellControl {
    /// By row and column.
    pub component: [[Control; 3]; 3],
    /// Response time \[s\]; zero for one that follows from the sample, see [`crate::Dem::control_cell`].
    pub response: f64,
    /// Modulus \[Pa\]; zero for one that follows from the sample.
    pub modulus: f64,
}

impl Default for CellControl {
    fn default() -> Self {
        Self { component: [[Control::Rate(0.0); 3]; 3], response: 0.0, modulus: 0.0 }
    }
}

impl CellControl {
    /// The same with another control of one component.
    pub fn with(mut self, row: usize, column: usize, control: Control) -> Self {
        self.component[row][column] = control;
        self
    }

    /// The same pressure \[Pa\] along all axes.
    pub fn isotropic<D: Dim>(pressure: f64) -> Self {
        (0..D::N).fold(Self::default(), |control, axis| control.with(axis, axis, Control::Stress(pressure)))
    }

    /// Whether any component follows a stress.
    pub fn follows_stress(&self) -> bool {
        self.component.iter().flatten().any(|control| matches!(control, Control::Stress(_)))
    }

    pub(crate) fn deforms(&self) -> bool {
        self.component.iter().flatten().any(|control| *control != Control::Rate(0.0))
    }

    pub(crate) fn check<D: Dim>(&self, cell: &PeriodicCell<D>) -> Result<(), SetupError> {
        for row in 0..3 {
            for column in 0..3 {
                let control = self.component[row][column];
                let (Control::Rate(value) | Control::Stress(value)) = control;
                if !value.is_finite() {
                    return Err(SetupError::new("rate or stress of the cell", value, "finite"));
                }
                let inside = row < D::N && column < D::N && cell.periodic[row] && cell.periodic[column];
                if control != Control::Rate(0.0) && !inside {
                    return Err(SetupError::new(
                        "control of the cell along an axis that is not periodic",
                        value,
                        "none",
                    ));
                }
            }
        }
        if self.follows_stress() && !cell.is_closed() {
            return Err(SetupError::new(
                "periodic axes of a cell that follows a stress",
                cell.periodic.iter().filter(|&&is| is).count() as f64,
                "all: only then there is a volume to divide by",
            ));
        }
        let fits = |value: f64| value.is_finite() && value >= 0.0;
        if !fits(self.response) || !fits(self.modulus) {
            return Err(SetupError::new(
                "response time or modulus of the cell",
                self.response.min(self.modulus),
                "zero or more, finite",
            ));
        }
        Ok(())
    }
}

impl<D: Dim> PeriodicCell<D> {
    /// Sets the gradient to the rates that are given; components under stress keep what they have.
    pub(crate) fn take_rates(&mut self) {
        let (control, gradient) = (self.control, self.gradient);
        self.gradient = Matrix::from_fn(|row, column| match control.component[row][column] {
            Control::Rate(rate) => rate,
            Control::Stress(_) => gradient.at(row, column),
        });
    }

    /// One step of the servo with the stress \[Pa\] of that step.
    pub(crate) fn follow_stress(&mut self, stress: &Matrix<D>, dt: f64) {
        let CellControl { component, response, modulus } = self.control;
        let turn = response / std::f64::consts::TAU;
        let (inertia, damping) = (modulus * turn * turn, 2.0 * modulus * turn);
        let gradient = self.gradient;
        self.gradient = Matrix::from_fn(|row, column| match component[row][column] {
            Control::Rate(rate) => rate,
            Control::Stress(target) => {
                // Damping at the end of the step: any ratio of step to response is stable.
                let driven = inertia * gradient.at(row, column) + dt * (stress.at(row, column) - target);
                driven / (inertia + dt * damping)
            }
        });
    }
}
