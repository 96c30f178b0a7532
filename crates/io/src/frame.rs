//! What a solver shows at one time, kept until it is written.

use crate::error::IoError;
use granular_core::{FieldRef, FieldSink, Location, Solver};
use std::path::Path;

/// Owned values of a field, one per point, cell or link.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers.
    Scalar(Vec<f64>),
    /// Numbers in single precision.
    Single(Vec<f32>),
    /// Vectors of space; those of the plane have z = 0.
    Vector(Vec<[f64; 3]>),
    /// Symmetric tensors as xx, yy, zz, xy, yz, xz.
    Tensor(Vec<[f64; 6]>),
    /// Identifiers and counts.
    Index(Vec<u32>),
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Scalar(v) => v.len(),
            Self::Single(v) => v.len(),
            Self::Vector(v) => v.len(),
            Self::Tensor(v) => v.len(),
            Self::Index(v) => v.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Numbers per value: 1, 3 or 6.
    pub fn components(&self) -> usize {
        match self {
            Self::Scalar(_) | Self::Single(_) | Self::Index(_) => 1,
            Self::Vector(_) => 3,
            Self::Tensor(_) => 6,
        }
    }
}

impl From<FieldRef<'_>> for Values {
    fn from(field: FieldRef<'_>) -> Self {
        match field {
            FieldRef::Scalar(v) => Self::Scalar(v.to_vec()),
            FieldRef::Single(v) => Self::Single(v.to_vec()),
            FieldRef::Vector2(v) => Self::Vector(v.iter().map(|a| [a.x, a.y, 0.0]).collect()),
            FieldRef::Vector3(v) => Self::Vector(v.iter().map(|a| a.to_array()).collect()),
            FieldRef::Tensor(v) => {
                Self::Tensor(v.iter().map(|t| [t.xx, t.yy, t.zz, t.xy, t.yz, t.xz]).collect())
            }
            FieldRef::Index(v) => Self::Index(v.to_vec()),
        }
    }
}

/// A field with its name and unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name, as the solver shows it.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// One value per point, cell or link.
    pub values: Values,
}

/// A number with its name and unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Name, as the solver shows it.
    pub name: String,
    /// Unit of the value.
    pub unit: String,
    /// The value.
    pub value: f64,
}

/// Collects wanted fields, links and numbers of a solver at one time.
///
/// ```
/// use granular_core::{FieldRef, FieldSink};
/// let mut frame = granular_io::Frame::wanting(["radius"]);
/// frame.field("radius", "m", FieldRef::Scalar(&[1e-3, 2e-3])); // a solver does this
/// frame.field("temperature", "K", FieldRef::Scalar(&[293.0, 294.0])); // not wanted
/// assert_eq!(frame.fields().len(), 1);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Frame {
    wanted: Option<Vec<String>>,
    fields: Vec<Field>,
    numbers: Vec<Number>,
    links: Vec<[u32; 2]>,
    link_fields: Vec<Field>,
}

impl Frame {
    /// A frame for the fields, link fields and numbers of these names.
    pub fn wanting<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        Self { wanted: Some(names.into_iter().map(str::to_owned).collect()), ..Self::default() }
    }

    /// A frame for all that a solver shows.
    pub fn wanting_all() -> Self {
        Self::default()
    }

    /// A frame for all that lives at a place of a solver, and its numbers. The first place goes by an empty name, too.
    pub fn of_place(solver: &dyn Solver, place: &str) -> Self {
        Self::wanting(solver.shown_at(place).iter().map(|shown| shown.name.as_str()))
    }

    /// Forgets what was collected, so that the same names are wanted at another time.
    pub fn clear(&mut self) {
        self.fields.clear();
        self.numbers.clear();
        self.links.clear();
        self.link_fields.clear();
    }

    /// Fields, in the order shown.
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Numbers, in the order shown.
    pub fn numbers(&self) -> &[Number] {
        &self.numbers
    }

    /// Pairs of points that are linked.
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.links
    }

    /// One field per quantity with one value per link.
    pub fn link_fields(&self) -> &[Field] {
        &self.link_fields
    }

    /// The field of this name.
    pub fn get(&self, name: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// Names that are wanted but were not shown; for a warning. Empty when all are wanted.
    pub fn missing(&self) -> Vec<&str> {
        let shown = |name: &str| {
            self.fields.iter().chain(&self.link_fields).any(|field| field.name == name)
                || self.numbers.iter().any(|number| number.name == name)
        };
        self.wanted.iter().flatten().map(String::as_str).filter(|name| !shown(name)).collect()
    }

    /// Checks that there is one value per place and no name twice: readers would crash.
    pub(crate) fn check(path: &Path, fields: &[Field], count: usize, of: &str) -> Result<(), IoError> {
        for (i, field) in fields.iter().enumerate() {
            if field.values.len() != count {
                let (name, found) = (&field.name, field.values.len());
                let reason = format!("field `{name}` has {found} values for {count} {of}");
                return Err(IoError::new("write", path, reason));
            }
            if fields[..i].iter().any(|other| other.name == field.name) {
                return Err(IoError::new("write", path, format!("field `{}` is shown twice", field.name)));
            }
        }
        Ok(())
    }
}

impl FieldSink for Frame {
    fn wants(&self, name: &str) -> bool {
        self.wanted.as_ref().is_none_or(|wanted| wanted.iter().any(|w| w == name))
    }

    fn field(&mut self, name: &str, unit: &str, values: FieldRef<'_>) {
        if self.wants(name) {
            self.fields.push(Field { name: name.to_owned(), unit: unit.to_owned(), values: values.into() });
        }
    }

    fn number(&mut self, name: &str, unit: &str, value: f64) {
        if self.wants(name) {
            self.numbers.push(Number { name: name.to_owned(), unit: unit.to_owned(), value });
        }
    }

    fn links(&mut self, pairs: &[[u32; 2]]) {
        self.links.clear();
        self.links.extend_from_slice(pairs);
    }

    fn link_field(&mut self, name: &str, unit: &str, values: FieldRef<'_>) {
        if self.wants(name) {
            let field = Field { name: name.to_owned(), unit: unit.to_owned(), values: values.into() };
            self.link_fields.push(field);
        }
    }
}

/// Coordinates \[m\] of the points, z = 0 in the plane.
pub(crate) fn coordinates(path: &Path, location: &Location<'_>) -> Result<Vec<[f64; 3]>, IoError> {
    if let Location::Points(field) = location
        && let Values::Vector(points) = Values::from(*field)
    {
        return Ok(points);
    }
    Err(IoError::new("write", path, "the solver has no points; its fields live on a grid"))
}

/// A regular grid as files describe it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    pub(crate) origin: [f64; 3],
    pub(crate) spacing: [f64; 3],
    pub(crate) cells: [usize; 3],
}

impl Grid {
    pub(crate) fn of(path: &Path, location: &Location<'_>) -> Result<Self, IoError> {
        match *location {
            Location::Grid { origin, spacing, cells } => Ok(Self { origin, spacing, cells }),
            Location::Points(_) => {
                Err(IoError::new("write", path, "the solver has no grid; its fields live at points"))
            }
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// First and last point along each axis. One cell along z is the plane, a flat image.
    pub(crate) fn extent(&self) -> [i64; 6] {
        let [x, y, z] = self.cells.map(|n| n as i64);
        [0, x, 0, y, 0, if z == 1 { 0 } else { z }]
    }
}
