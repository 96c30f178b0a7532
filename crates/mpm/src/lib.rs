//! Material point method for soils that deform without bound.
