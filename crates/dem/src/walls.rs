//! Walls: what they are made of, contacts with them, and what they show. Their shapes and motions are those of
//! [`granular_core::shape`] and [`granular_core::walls`].

mod below;
pub(crate) mod contact;
mod numbers;
pub(crate) mod surfaces;
mod wall;

pub use below::{Falling, Gates};
pub use wall::Wall;
