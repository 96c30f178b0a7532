//! Parts of a scene that only some methods use.

/// A part of a scene that only some methods use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// `sample`.
    Sample,
    /// `materials`.
    Materials,
    /// `continua`.
    Continua,
    /// `pairs`.
    Pairs,
    /// `walls`.
    Walls,
    /// `inlets`.
    Inlets,
    /// `outlets`.
    Outlets,
    /// `cell`.
    Cell,
    /// `fluid`.
    Fluid,
    /// Steps that stages choose.
    StageStep,
    /// Samples that stages save.
    Saving,
    /// The end of a stage when all is at rest.
    Quiet,
    /// The end of a stage at a density.
    Packed,
    /// Changes that whatever moves knows: motion that stops, walls that open and start.
    BodyChanges,
    /// Pushes: a velocity that all get at once.
    Pushes,
    /// Changes of grains, their friction, and cells.
    GrainChanges,
    /// Changes of faces and obstacles of a fluid.
    FluidChanges,
}
