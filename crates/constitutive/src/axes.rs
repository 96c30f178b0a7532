//! Which components of a tensor can differ from zero.

/// Where stress and strain live. A law that needs principal stresses asks for them here: in plane strain one of them is known, and
/// the others follow from a square root.
pub trait Axes: Copy + Send + Sync + 'static {
    /// Whether the components xz and yz are zero, now and after any increment.
    const PLANE: bool;
}

/// Plane strain: the components xz and yz are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InPlane;

/// Any stress in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InSpace;

impl Axes for InPlane {
    const PLANE: bool = true;
}

impl Axes for InSpace {
    const PLANE: bool = false;
}
