//! What a solver or a law shows to the outside: fields, links and numbers, and where they live.

use crate::tensor::SymmetricTensor;
use glam::{DVec2, DVec3};

/// A borrowed field: one value per point, cell or link.
#[derive(Clone, Copy, Debug)]
pub enum FieldRef<'a> {
    /// Numbers.
    Scalar(&'a [f64]),
    /// Numbers in single precision.
    Single(&'a [f32]),
    /// Vectors of the plane.
    Vector2(&'a [DVec2]),
    /// Vectors of space.
    Vector3(&'a [DVec3]),
    /// Symmetric tensors.
    Tensor(&'a [SymmetricTensor]),
    /// Identifiers and counts.
    Index(&'a [u32]),
}

impl FieldRef<'_> {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Scalar(v) => v.len(),
            Self::Single(v) => v.len(),
            Self::Vector2(v) => v.len(),
            Self::Vector3(v) => v.len(),
            Self::Tensor(v) => v.len(),
            Self::Index(v) => v.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Where fields of a solver live.
#[derive(Clone, Copy, Debug)]
pub enum Location<'a> {
    /// At points, one per grain or particle \[m\].
    Points(FieldRef<'a>),
    /// In the cells of a regular grid.
    Grid {
        /// Lower corner \[m\].
        origin: [f64; 3],
        /// Edge lengths of a cell \[m\].
        spacing: [f64; 3],
        /// Cells along each axis; 1 along z in the plane.
        cells: [usize; 3],
    },
}

/// Receives what a solver shows. Solvers compute only what the sink wants.
pub trait FieldSink {
    /// Whether this field, link field or number should be shown.
    fn wants(&self, name: &str) -> bool;
    /// One value per point or cell of the place where the field lives.
    fn field(&mut self, name: &str, unit: &str, values: FieldRef<'_>);
    /// One number.
    fn number(&mut self, name: &str, unit: &str, value: f64);
    /// The pairs of points, all of one place, that the following link fields belong to (contacts).
    fn links(&mut self, pairs: &[[u32; 2]]) {
        let _ = pairs;
    }
    /// One value per link, after [`FieldSink::links`].
    fn link_field(&mut self, name: &str, unit: &str, values: FieldRef<'_>) {
        let _ = (name, unit, values);
    }
}

/// What a solver can show, for help texts and error messages.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Shown {
    /// Name that a sink asks for.
    pub name: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// One number, one value per item, or one per link.
    pub kind: ShownAs,
    /// Name of the place where a field or the points of links live; empty for the first place. See
    /// [`Solver::places`](crate::Solver::places).
    pub place: &'static str,
}

impl Shown {
    /// At the first place of a solver.
    pub fn new(name: impl Into<String>, unit: &'static str, meaning: &'static str, kind: ShownAs) -> Self {
        Self { name: name.into(), unit, meaning, kind, place: "" }
    }

    /// At the place of this name.
    pub fn at(self, place: &'static str) -> Self {
        Self { place, ..self }
    }
}

/// The shape of what is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownAs {
    /// One number.
    Number,
    /// One value per grain, particle or cell.
    Field,
    /// One value per contact.
    Link,
}

/// A sink that keeps the numbers it asked for; fields are ignored.
#[derive(Clone, Debug, Default)]
pub struct Numbers {
    wanted: Vec<String>,
    values: Vec<(String, String, f64)>,
}

impl Numbers {
    /// A sink for these numbers.
    pub fn wanting<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        Self { wanted: names.into_iter().map(str::to_owned).collect(), values: Vec::new() }
    }

    /// The number shown under this name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|(n, ..)| n == name).map(|(.., value)| *value)
    }

    /// Name, unit and value of all numbers, in the order shown.
    pub fn values(&self) -> &[(String, String, f64)] {
        &self.values
    }
}

impl FieldSink for Numbers {
    fn wants(&self, name: &str) -> bool {
        self.wanted.iter().any(|wanted| wanted == name)
    }
    fn field(&mut self, _: &str, _: &str, _: FieldRef<'_>) {}
    fn number(&mut self, name: &str, unit: &str, value: f64) {
        if self.wants(name) {
            self.values.push((name.to_owned(), unit.to_owned(), value));
        }
    }
}
