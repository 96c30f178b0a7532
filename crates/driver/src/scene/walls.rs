//! What all kinds of walls have.

use super::WallSpec;
use super::boundaries::MotionSpec;

impl WallSpec {
    /// How the wall moves.
    pub(crate) fn moves(&self) -> Option<&MotionSpec> {
        match self {
            Self::Plane { moves, .. }
            | Self::Segment { moves, .. }
            | Self::Block { moves, .. }
            | Self::Tube { moves, .. }
            | Self::Circle { moves, .. }
            | Self::Chain { moves, .. }
            | Self::Mesh { moves, .. }
            | Self::HeldGrains { moves, .. } => moves.as_ref(),
            _ => None,
        }
    }

    /// The name by which changes open and close the wall; empty for walls that are several.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Floor { .. } => "floor",
            Self::Left { .. } => "left",
            Self::Right { .. } => "right",
            Self::Gate { .. } => "gate",
            Self::Plane { name, .. }
            | Self::Segment { name, .. }
            | Self::Block { name, .. }
            | Self::Tube { name, .. }
            | Self::Circle { name, .. }
            | Self::Chain { name, .. }
            | Self::Mesh { name, .. }
            | Self::HeldGrains { name, .. } => name,
            Self::Sides { .. } | Self::Box { .. } => "",
        }
    }

    /// The stage at whose start the wall opens.
    pub(crate) fn opens(&self) -> Option<&str> {
        match self {
            Self::Gate { opens, .. } => Some(opens),
            Self::Plane { opens, .. }
            | Self::Segment { opens, .. }
            | Self::Block { opens, .. }
            | Self::Tube { opens, .. }
            | Self::Circle { opens, .. }
            | Self::Chain { opens, .. }
            | Self::Mesh { opens, .. }
            | Self::HeldGrains { opens, .. } => opens.as_deref(),
            _ => None,
        }
    }
}
