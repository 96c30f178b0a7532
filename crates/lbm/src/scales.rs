//! A lattice from what is known of a flow: its size, speed, viscosity and how finely it is to be resolved.

use crate::setup::{Setup, SetupError};
use granular_core::{Dim, Vector};

/// Largest Mach number; errors of compressibility grow with its square.
const LARGEST_MACH: f64 = 0.3;
/// Relaxation time in steps above which errors at walls and in time grow.
const LONGEST_RELAXATION: f64 = 1.0;
/// Largest grid Reynolds number that any operator was seen to bear, with a closure.
const LARGEST_GRID_REYNOLDS: f64 = 1000.0;
/// How far a size over the edge of a cell may be off a whole number.
const FIT: f64 = 1e-6;
/// Most cells along an axis.
const MOST: f64 = 1e9;

/// What is known of a flow before it is solved; see [`Setup::for_flow`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowScales {
    /// A length \[m\] of the flow, such as the diameter of a cylinder.
    pub length: f64,
    /// Largest speed expected \[m/s\].
    pub speed: f64,
    /// Kinematic viscosity \[m^2/s\].
    pub viscosity: f64,
    /// Cells across the length.
    pub cells: usize,
    /// Largest Mach number of the speed on the lattice, such as 0.1, at most 0.3: errors fall with its square, the number of
    /// steps grows as one over it.
    pub mach: f64,
}

impl FlowScales {
    /// Edge of a cell \[m\].
    pub fn spacing(&self) -> f64 {
        self.length / self.cells as f64
    }

    /// The longest step \[s\] that keeps the Mach number and a relaxation time of one step: slow flows are bound by the
    /// second, and their Mach number is smaller than the one given.
    pub fn time_step(&self) -> f64 {
        let spacing = self.spacing();
        let by_mach = self.mach * spacing / (3.0_f64.sqrt() * self.speed);
        by_mach.min((LONGEST_RELAXATION - 0.5) * spacing * spacing / (3.0 * self.viscosity))
    }

    /// Speed times length over viscosity.
    pub fn reynolds_number(&self) -> f64 {
        self.speed * self.length / self.viscosity
    }

    /// Speed times edge of a cell over viscosity: what the cells bear is limited.
    pub fn grid_reynolds_number(&self) -> f64 {
        self.speed * self.spacing() / self.viscosity
    }

    fn check(&self) -> Result<(), SetupError> {
        let positive = [
            ("length of the flow", self.length, "m"),
            ("speed of the flow", self.speed, "m/s"),
            ("viscosity", self.viscosity, "m^2/s"),
        ];
        for (what, value, unit) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SetupError::new(what, format!("{value} {unit}"), "a positive number"));
            }
        }
        if self.cells == 0 {
            return Err(SetupError::new("cells across the length", "0".to_owned(), "1 or more"));
        }
        if !(self.mach > 0.0 && self.mach <= LARGEST_MACH) {
            let allowed = format!("above 0 and at most {LARGEST_MACH}, such as 0.1");
            return Err(SetupError::new("Mach number", self.mach.to_string(), allowed));
        }
        let grid = self.grid_reynolds_number();
        // A hair more is round-off.
        if grid * (1.0 - FIT) > LARGEST_GRID_REYNOLDS {
            let Self { speed, viscosity, cells, .. } = *self;
            let value = format!(
                "{grid:.3e} ({speed} m/s through cells of {:.3e} m at {viscosity:e} m^2/s)",
                self.spacing()
            );
            let least = (self.reynolds_number() * (1.0 - FIT) / LARGEST_GRID_REYNOLDS).ceil();
            let allowed = format!(
                "at most {LARGEST_GRID_REYNOLDS}, which a closure bears: {least:.0} cells across the length \
                 instead of {cells}, less speed or more viscosity"
            );
            return Err(SetupError::new("grid Reynolds number", value, allowed));
        }
        Ok(())
    }
}

impl<D: Dim> Setup<D> {
    /// Fluid in a periodic domain of this size \[m\], with cells and step \[s\] that follow from what is known of the flow,
    /// at density 1000 kg/m^3: see [`FlowScales::time_step`]. What each operator bears is among the limits of the solver.
    ///
    /// ```
    /// use granular_core::glam::DVec2;
    /// use granular_lbm::{FlowScales, Setup};
    /// use granular_core::D2;
    ///
    /// // A cylinder of 0.1 m in a channel of 2.2 m x 0.4 m at Reynolds number 100, 20 cells across it.
    /// let scales = FlowScales { length: 0.1, speed: 1.5, viscosity: 1e-3, cells: 20, mach: 0.1 };
    /// let setup = Setup::<D2>::for_flow(DVec2::new(2.2, 0.4), scales)?;
    /// assert_eq!(setup.cells, [440, 80, 1]);
    /// assert!((setup.tau() - 0.5231).abs() < 1e-4);
    /// # Ok::<(), granular_lbm::SetupError>(())
    /// ```
    ///
    /// # Errors
    /// When a number is not positive, the Mach number is above 0.3, the grid Reynolds number is beyond what any operator
    /// bears, or a size is no whole number of cells.
    pub fn for_flow(size: D::Vec, scales: FlowScales) -> Result<Self, SetupError> {
        scales.check()?;
        let spacing = scales.spacing();
        let mut cells = [1; 3];
        for (axis, cells) in cells.iter_mut().enumerate().take(D::N) {
            let size = size.component(axis);
            let name = format!("size along {}", D::AXES[axis]);
            if !(size > 0.0 && size.is_finite()) {
                return Err(SetupError::new(name, format!("{size} m"), "a positive number"));
            }
            let count = (size / spacing).round();
            if count > MOST {
                let value = format!("{size} m, {count:e} cells of {spacing:e} m");
                return Err(SetupError::new(name, value, format!("at most {MOST:e} cells")));
            }
            if count < 1.0 || (size / spacing - count).abs() > FIT * count {
                let below = (size / spacing).floor().max(1.0);
                let value = format!("{size} m, {:.4} cells of {spacing} m", size / spacing);
                let near = [below * spacing, (below + 1.0) * spacing];
                let allowed =
                    format!("a whole number of cells, such as {:.9} m or {:.9} m", near[0], near[1]);
                return Err(SetupError::new(name, value, allowed));
            }
            *cells = count as usize;
        }
        let mut setup = Self::new(cells, spacing, scales.viscosity, LONGEST_RELAXATION);
        setup.time_step = scales.time_step();
        setup.expected_speed = scales.speed;
        Ok(setup)
    }
}
