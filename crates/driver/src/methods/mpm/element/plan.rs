//! Along which path a material is led, and how far.

use crate::failure::Failure;
use granular_constitutive::element::{ElementState, Path};
use serde::Serialize;

/// Most increments of a test: each is a row of its table.
const MOST_STEPS: usize = 100_000;
/// Largest strain of a test \[-\].
const LARGEST_STRAIN: f64 = 10.0;

/// A path. Axial is y, lateral are x and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Compressed along y under a lateral pressure that stays.
    Triaxial,
    /// The same without strain along z.
    PlaneStrain,
    /// Compressed along y between rigid sides.
    Oedometer,
    /// Sheared along x under a normal stress along y that stays.
    SimpleShear,
}

impl Test {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Triaxial, Self::PlaneStrain, Self::Oedometer, Self::SimpleShear];

    /// Name in commands.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triaxial => "triaxial",
            Self::PlaneStrain => "plane-strain",
            Self::Oedometer => "oedometer",
            Self::SimpleShear => "simple-shear",
        }
    }

    /// What is done, in a line.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Triaxial => "Compression under a lateral pressure that stays",
            Self::PlaneStrain => "The same without strain across the plane: biaxial compression",
            Self::Oedometer => "Compression between rigid sides",
            Self::SimpleShear => "Shear under a normal stress that stays, without lateral strain",
        }
    }

    /// Label of [`Test::strain`].
    pub(super) const fn strain_label(self) -> &'static str {
        if matches!(self, Self::SimpleShear) { "shear strain [-]" } else { "axial strain [-]" }
    }

    /// Label of [`Test::stress`].
    pub(super) const fn stress_label(self) -> &'static str {
        match self {
            Self::Triaxial | Self::PlaneStrain => "axial less lateral stress [Pa]",
            Self::Oedometer => "axial stress [Pa]",
            Self::SimpleShear => "shear stress [Pa]",
        }
    }

    /// Label of [`Test::ratio`].
    pub(super) const fn ratio_label(self) -> &'static str {
        match self {
            Self::Triaxial | Self::PlaneStrain => "axial over lateral stress [-]",
            Self::Oedometer => "lateral over axial stress [-]",
            Self::SimpleShear => "shear over normal stress [-]",
        }
    }

    /// The strain that is prescribed, so far \[-\]; of shear `du_x / dy`.
    pub(super) fn strain(self, state: &ElementState) -> f64 {
        if self == Self::SimpleShear { 2.0 * state.strain.xy } else { -state.strain.yy }
    }

    /// The stress that answers it \[Pa\].
    pub(super) fn stress(self, state: &ElementState) -> f64 {
        let stress = state.stress;
        match self {
            Self::Triaxial | Self::PlaneStrain => stress.xx - stress.yy,
            Self::Oedometer => -stress.yy,
            Self::SimpleShear => stress.xy,
        }
    }

    /// A ratio of stresses that says how much of the strength is mobilised; not finite without stress.
    pub(super) fn ratio(self, state: &ElementState) -> f64 {
        let stress = state.stress;
        match self {
            Self::Triaxial | Self::PlaneStrain => stress.yy / stress.xx,
            Self::Oedometer => stress.xx / stress.yy,
            Self::SimpleShear => -stress.xy / stress.yy,
        }
    }
}

/// What is done to a material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The path.
    #[serde(skip)]
    pub test: Test,
    /// Lateral pressure of a compression, normal stress of a shear, pressure at the start of an oedometer \[Pa\].
    pub pressure: f64,
    /// Strain at the end \[-\].
    pub strain: f64,
    /// Equal increments of strain.
    pub steps: usize,
    /// Duration \[s\], which laws that know a rate ask for.
    pub duration: f64,
}

impl Plan {
    /// From 100 kPa to a strain of 0.1, an oedometer from no pressure to 0.02, in 1000 increments and one second.
    pub fn of(test: Test) -> Self {
        let [pressure, strain] = if test == Test::Oedometer { [0.0, 0.02] } else { [100e3, 0.1] };
        Self { test, pressure, strain, steps: Path::INCREMENTS, duration: Path::DURATION }
    }

    pub(super) fn path(&self) -> Path {
        let &Self { pressure, strain, .. } = self;
        let path = match self.test {
            Test::Triaxial => Path::triaxial_compression(pressure, strain),
            Test::PlaneStrain => Path::biaxial_compression(pressure, strain),
            Test::Oedometer => Path::oedometer(pressure, strain),
            Test::SimpleShear => Path::simple_shear(pressure, strain),
        };
        path.in_increments(self.steps).over(self.duration)
    }

    pub(super) fn check(&self) -> Result<(), Failure> {
        let refuse = |flag: &str, value: String, allowed: &str| {
            Err(Failure::io(flag, format!("{value}; allowed: {allowed}")))
        };
        if !(self.pressure >= 0.0 && self.pressure.is_finite()) {
            return refuse("--pressure", format!("{} Pa", self.pressure), "zero or more");
        }
        if !(self.strain > 0.0 && self.strain <= LARGEST_STRAIN) {
            return refuse("--strain", self.strain.to_string(), "more than 0, and at most 10");
        }
        if !(1..=MOST_STEPS).contains(&self.steps) {
            return refuse("--steps", self.steps.to_string(), "from 1 to 100000");
        }
        if !(self.duration > 0.0 && self.duration.is_finite()) {
            return refuse("--duration", format!("{} s", self.duration), "more than 0");
        }
        Ok(())
    }
}
