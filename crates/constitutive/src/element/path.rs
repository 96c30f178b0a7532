//! What is prescribed in a test.

use granular_core::SymmetricTensor;

/// What is prescribed of one component over a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// The strain that is added, in equal increments.
    Strain(f64),
    /// The stress \[Pa\] at the end, approached in equal increments.
    Stress(f64),
}

/// A part of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// What is prescribed of the components xx, yy, zz, xy, yz and xz.
    pub controls: [Control; 6],
    /// Duration \[s\].
    pub duration: f64,
    /// Number of increments.
    pub increments: usize,
}

impl Leg {
    /// The values to be met in an increment: strains that are added, stresses at its end.
    pub(super) fn targets(&self, from: [f64; 6], increment: usize) -> [f64; 6] {
        let count = self.increments as f64;
        let share = (increment + 1) as f64 / count;
        std::array::from_fn(|i| match self.controls[i] {
            Control::Strain(added) => added / count,
            Control::Stress(_) if increment + 1 == self.increments => self.stress(i),
            Control::Stress(end) => from[i] + share * (end - from[i]),
        })
    }

    fn stress(&self, component: usize) -> f64 {
        match self.controls[component] {
            Control::Strain(_) => 0.0,
            Control::Stress(end) => end,
        }
    }
}

/// The way along which a material is led. Axial is y, lateral are x and z; strains given here are positive as written, and pressures
/// in compression.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Stress \[Pa\] before the first leg, positive in tension.
    pub start: SymmetricTensor,
    /// One after the other.
    pub legs: Vec<Leg>,
}

/// No strain.
const HELD: Control = Control::Strain(0.0);

impl Path {
    /// Number of increments of a ready path.
    pub const INCREMENTS: usize = 1000;
    /// Duration \[s\] of a ready path.
    pub const DURATION: f64 = 1.0;

    /// One leg from a stress \[Pa\], of [`Path::INCREMENTS`] increments in [`Path::DURATION`].
    pub fn of(start: SymmetricTensor, controls: [Control; 6]) -> Self {
        let leg = Leg { controls, duration: Self::DURATION, increments: Self::INCREMENTS };
        Self { start, legs: vec![leg] }
    }

    /// The same with another number of increments in each leg.
    pub fn in_increments(mut self, increments: usize) -> Self {
        for leg in &mut self.legs {
            leg.increments = increments;
        }
        self
    }

    /// The same with another duration \[s\] of each leg.
    pub fn over(mut self, duration: f64) -> Self {
        for leg in &mut self.legs {
            leg.duration = duration;
        }
        self
    }

    /// The same, and a leg after it.
    pub fn then(mut self, leg: Leg) -> Self {
        self.legs.push(leg);
        self
    }

    /// Pressed from all sides, from one pressure \[Pa\] to another, without shear.
    pub fn isotropic(from: f64, to: f64) -> Self {
        let end = Control::Stress(-to);
        Self::of(SymmetricTensor::IDENTITY * -from, [end, end, end, HELD, HELD, HELD])
    }

    /// Compressed along y by a strain under a lateral pressure \[Pa\] that stays.
    pub fn triaxial_compression(cell_pressure: f64, axial_strain: f64) -> Self {
        let cell = Control::Stress(-cell_pressure);
        let start = SymmetricTensor::IDENTITY * -cell_pressure;
        Self::of(start, [cell, Control::Strain(-axial_strain), cell, HELD, HELD, HELD])
    }

    /// The same in plane strain: no strain along z.
    pub fn biaxial_compression(cell_pressure: f64, axial_strain: f64) -> Self {
        let cell = Control::Stress(-cell_pressure);
        let start = SymmetricTensor::IDENTITY * -cell_pressure;
        Self::of(start, [cell, Control::Strain(-axial_strain), HELD, HELD, HELD, HELD])
    }

    /// Compressed along y by a strain between rigid sides, from a pressure \[Pa\].
    pub fn oedometer(pressure: f64, axial_strain: f64) -> Self {
        let start = SymmetricTensor::IDENTITY * -pressure;
        Self::of(start, [HELD, Control::Strain(-axial_strain), HELD, HELD, HELD, HELD])
    }

    /// Sheared by `du_x / dy` under a normal stress \[Pa\] along y that stays, from that pressure; no strain along x and z.
    pub fn simple_shear(normal_stress: f64, shear: f64) -> Self {
        let start = SymmetricTensor::IDENTITY * -normal_stress;
        let sheared = Control::Strain(0.5 * shear);
        Self::of(start, [HELD, Control::Stress(-normal_stress), HELD, sheared, HELD, HELD])
    }

    /// Sheared by `du_x / dy` at constant volume, from a pressure \[Pa\].
    pub fn simple_shear_of_constant_volume(pressure: f64, shear: f64) -> Self {
        let start = SymmetricTensor::IDENTITY * -pressure;
        Self::of(start, [HELD, HELD, HELD, Control::Strain(0.5 * shear), HELD, HELD])
    }
}
