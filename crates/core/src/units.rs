//! Values with units, as they are written in scenes.
//!
//! A value is a number in SI units or a text with its unit. Angles are a base of their own, so
//! that `45 deg` is refused where a plain number belongs. A text gives the bits that the same
//! number written in SI units gives.
//!
//! ```
//! use granular_core::units::{Length, Stiffness};
//!
//! let diameter: Length = "1.15 mm".parse()?;
//! assert_eq!(diameter.value(), 1.15e-3);
//! let wrong = "1.15 kg".parse::<Length>().unwrap_err();
//! assert_eq!(wrong.to_string(), "`1.15 kg` is a mass, but a length such as `1 mm` is expected");
//! assert_eq!(Stiffness::from(1.6e6), "1.6 MN/m".parse()?);
//! # Ok::<(), granular_core::units::UnitError>(())
//! ```

mod dimension;
mod error;
mod expression;
#[cfg(feature = "serde")]
mod scene;
mod symbols;
#[cfg(test)]
mod tests;

pub use dimension::Dimension;
pub use error::UnitError;
pub use expression::parse;

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;

/// A unit that a value is measured in; implemented by types without data.
pub trait Unit: Copy + Default + PartialEq + PartialOrd + Send + Sync + 'static {
    /// What the value measures.
    const DIMENSION: Dimension;
}

/// A number in the SI unit of `U`, which scenes may write with any unit of that dimension.
///
/// [`From`] takes any number; reading a text or a scene refuses what is not finite.
#[derive(Clone, Copy, Default, PartialEq, PartialOrd)]
pub struct Measured<U: Unit> {
    value: f64,
    unit: PhantomData<U>,
}

impl<U: Unit> Measured<U> {
    /// The number in SI units.
    pub const fn value(self) -> f64 {
        self.value
    }
}

impl<U: Unit> From<f64> for Measured<U> {
    fn from(value: f64) -> Self {
        Self { value, unit: PhantomData }
    }
}

impl<U: Unit> From<Measured<U>> for f64 {
    fn from(measured: Measured<U>) -> Self {
        measured.value
    }
}

impl<U: Unit> FromStr for Measured<U> {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        parse(text, U::DIMENSION).map(Self::from)
    }
}

/// The number and its SI unit, readable by [`FromStr`].
impl<U: Unit> fmt::Display for Measured<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.value, f)?;
        if U::DIMENSION.is_number() { Ok(()) } else { write!(f, " {}", U::DIMENSION.unit) }
    }
}

impl<U: Unit> fmt::Debug for Measured<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.value, f)?;
        if U::DIMENSION.is_number() { Ok(()) } else { write!(f, " {}", U::DIMENSION.unit) }
    }
}

macro_rules! measured {
    ($($name:ident, $constant:ident;)*) => {
        /// One type without data per dimension: the parameter of [`Measured`].
        pub mod unit {
            use super::{Dimension, Unit};
            $(
                #[doc = concat!("The SI unit of [`Dimension::", stringify!($constant), "`].")]
                #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
                pub struct $name;
                impl Unit for $name {
                    const DIMENSION: Dimension = Dimension::$constant;
                }
            )*
        }
        $(
            #[doc = concat!("A value of [`Dimension::", stringify!($constant), "`].")]
            pub type $name = Measured<unit::$name>;
        )*
    };
}

measured! {
    Number, NUMBER;
    Length, LENGTH;
    Area, AREA;
    Volume, VOLUME;
    Time, TIME;
    Frequency, FREQUENCY;
    Angle, ANGLE;
    AngularVelocity, ANGULAR_VELOCITY;
    Velocity, VELOCITY;
    Acceleration, ACCELERATION;
    Mass, MASS;
    Density, DENSITY;
    Force, FORCE;
    Stiffness, STIFFNESS;
    Damping, DAMPING;
    Pressure, PRESSURE;
    Energy, ENERGY;
    Power, POWER;
    Viscosity, VISCOSITY;
    KinematicViscosity, KINEMATIC_VISCOSITY;
}
