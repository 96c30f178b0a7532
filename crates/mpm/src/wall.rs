//! Walls: shapes with a name, and what they do to the nodes behind them.

use granular_core::walls::WallMotion;
use granular_core::{Dim, SetupError, Shape};

/// What a wall does to the velocity of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// The node moves with the wall.
    Fixed,
    /// The node keeps to the wall but slides along it freely: a roller, or a plane of symmetry.
    Slip,
    /// Dashpots, as if the material went on behind the wall: a wave that meets it head on leaves, one that meets it aslant leaves in part
    /// \[Lysmer1969\]. A load that stays pushes the wall away slowly, so that it is for waves about a state without stress.
    Absorbing {
        /// Speed of compression waves of the material \[m/s\].
        compression_speed: f64,
        /// Speed of its shear waves \[m/s\].
        shear_speed: f64,
    },
    /// Coulomb friction \[Bandara2013\]: what moves into the wall is stopped and rubs, what moves away is free.
    Frictional {
        /// Coefficient of friction of what slides.
        friction: f64,
        /// Coefficient of friction of what sticks, not less.
        static_friction: f64,
    },
}

impl Condition {
    /// Coulomb friction with one coefficient.
    pub const fn frictional(friction: f64) -> Self {
        Self::Frictional { friction, static_friction: friction }
    }

    fn check(self) -> Result<(), SetupError> {
        if let Self::Absorbing { compression_speed, shear_speed } = self {
            let speeds =
                [("speed of compression waves", compression_speed), ("speed of shear waves", shear_speed)];
            let wrong = speeds.into_iter().find(|(_, speed)| !(*speed >= 0.0 && speed.is_finite()));
            return wrong.map_or(Ok(()), |(what, speed)| {
                Err(SetupError::new(what, speed, "zero or more m/s, and finite"))
            });
        }
        let Self::Frictional { friction, static_friction } = self else { return Ok(()) };
        if !(friction >= 0.0 && friction.is_finite()) {
            return Err(SetupError::new("friction", friction, "zero or more, and finite"));
        }
        if !(static_friction >= friction && static_friction.is_finite()) {
            return Err(SetupError::new(
                "static friction",
                static_friction,
                "not below friction, and finite",
            ));
        }
        Ok(())
    }
}

/// A wall, at rest unless it has a motion. It acts at the nodes of the grid that are behind its surface or on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall<D: Dim> {
    /// Name, unique in a scene.
    pub name: String,
    /// Surface.
    pub shape: Shape<D>,
    /// What it does to nodes.
    pub condition: Condition,
    /// Whether it is out of the way: an open gate.
    pub open: bool,
    /// How it moves; the shape is where it begins.
    pub motion: Option<WallMotion<D>>,
    /// Whether a moving wall waits where it is until [`Mpm::set_moving`](crate::Mpm::set_moving).
    pub held: bool,
}

impl<D: Dim> Wall<D> {
    /// A wall of any shape.
    pub fn new(name: &str, shape: Shape<D>, condition: Condition) -> Self {
        Self { name: name.to_owned(), shape, condition, open: false, motion: None, held: false }
    }

    /// A plane through `point` \[m\]; material is on the side to which `normal` points (any length).
    ///
    /// # Errors
    /// When the normal has no direction.
    pub fn plane(
        name: &str,
        point: D::Vec,
        normal: D::Vec,
        condition: Condition,
    ) -> Result<Self, SetupError> {
        let shape = Shape::plane(point, normal).map_err(|error| error.of(format_args!("wall `{name}`")))?;
        Ok(Self::new(name, shape, condition))
    }

    /// A solid block between two corners \[m\].
    ///
    /// # Errors
    /// When the upper corner is below the lower one, or a corner is not finite.
    pub fn block(name: &str, low: D::Vec, high: D::Vec, condition: Condition) -> Result<Self, SetupError> {
        let shape = Shape::block(low, high).map_err(|error| error.of(format_args!("wall `{name}`")))?;
        Ok(Self::new(name, shape, condition))
    }

    /// The same wall with a motion; its shape is where it begins.
    pub fn moving(self, motion: WallMotion<D>) -> Self {
        Self { motion: Some(motion), ..self }
    }

    pub(crate) fn check(&self) -> Result<(), SetupError> {
        self.condition.check().map_err(|error| error.of(format_args!("wall `{}`", self.name)))
    }
}

impl<D: Dim> AsRef<Shape<D>> for Wall<D> {
    fn as_ref(&self) -> &Shape<D> {
        &self.shape
    }
}
