//! Walls of a scene.

use super::{ColumnSize, NamedMaterials, Problems};
use crate::scene::WallSpec;
use granular_core::units::Length;
use granular_core::{Dim, Vector};
use granular_dem::{MaterialId, SetupError, Wall};

/// What walls may stand beside.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Beside {
    /// A column of this size.
    Column(ColumnSize),
    /// A column that could not be built.
    Unknown,
    /// Grains that are no column.
    Nothing,
}

/// Walls, and which opens at which stage: scene path, name of the wall, name of the stage.
pub(crate) struct BuiltWalls<D: Dim> {
    pub(crate) list: Vec<Wall<D>>,
    pub(crate) openings: Vec<(String, String, String)>,
}

pub(crate) fn walls<D: Dim>(
    specs: &[WallSpec],
    beside: Beside,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> BuiltWalls<D> {
    let mut built = BuiltWalls { list: Vec::new(), openings: Vec::new() };
    for (k, spec) in specs.iter().enumerate() {
        let path = format!("walls.{k}");
        let Some(material) = materials.find(&format!("{path}.material"), spec.material(), problems) else {
            continue;
        };
        let column = match beside {
            Beside::Column(column) => Some(column),
            Beside::Unknown if spec.needs_column() => continue,
            Beside::Nothing if spec.needs_column() => {
                let (value, hint) = ("a wall beside a column", "write a Plane instead");
                problems.add(path, value, "only with a sample that is a Column", hint);
                continue;
            }
            _ => None,
        };
        let before = built.list.len();
        match shapes::<D>(&path, spec, column, material, problems) {
            Ok(list) => built.list.extend(list),
            Err(error) => {
                let value = format!("a wall that cannot be: {} is {}", error.what, error.value);
                problems.add(path.clone(), value, error.allowed, "");
            }
        }
        if let Some(stage) = spec.opens() {
            let names = built.list[before..].iter().map(|wall| wall.name.clone());
            built.openings.extend(names.map(|name| (path.clone(), name, stage.to_owned())));
        }
    }
    built
}

fn shapes<D: Dim>(
    path: &str,
    spec: &WallSpec,
    column: Option<ColumnSize>,
    material: MaterialId,
    problems: &mut Problems,
) -> Result<Vec<Wall<D>>, SetupError> {
    let right = column.map_or(0.0, |column| column.width);
    let plane = |name: &str, axis: usize, at: f64, towards: f64| {
        Wall::plane(name, D::Vec::along(axis, at), D::Vec::along(axis, towards), material)
    };
    let mut point = |key: &str, values: &[Length]| problems.vector::<D, _>(&format!("{path}.{key}"), values);
    Ok(match spec {
        WallSpec::Floor { .. } => vec![plane("floor", D::UP, 0.0, 1.0)?],
        WallSpec::Left { .. } => vec![plane("left", 0, 0.0, 1.0)?],
        WallSpec::Right { .. } => vec![plane("right", 0, right, -1.0)?],
        WallSpec::Gate { .. } => vec![plane("gate", 0, right, -1.0)?],
        WallSpec::Sides { .. } => match column.and_then(|column| column.depth) {
            Some(depth) => vec![plane("front", 1, 0.0, 1.0)?, plane("back", 1, depth, -1.0)?],
            None => {
                problems.add(path, "Sides", "a scene in space", "a plane scene has no sides");
                vec![]
            }
        },
        WallSpec::Plane { name, point: on, normal, .. } => {
            let on = point("point", on);
            let numbers: Vec<Length> = normal.iter().map(|&n| n.into()).collect();
            match (on, point("normal", &numbers)) {
                (Some(on), Some(normal)) => vec![Wall::plane(name, on, normal, material)?],
                _ => vec![],
            }
        }
        WallSpec::Segment { name, from, to, .. } => match (point("from", from), point("to", to)) {
            (Some(from), Some(to)) => vec![Wall::segment(name, from, to, material)?],
            _ => vec![],
        },
        WallSpec::Block { name, low, high, .. } => match (point("low", low), point("high", high)) {
            (Some(low), Some(high)) => vec![Wall::block(name, low, high, material)?],
            _ => vec![],
        },
        WallSpec::Box { name, low, high, .. } => match (point("low", low), point("high", high)) {
            (Some(low), Some(high)) => closed_box::<D>(name, low, high, material)?,
            _ => vec![],
        },
    })
}

fn closed_box<D: Dim>(
    name: &str,
    low: D::Vec,
    high: D::Vec,
    material: MaterialId,
) -> Result<Vec<Wall<D>>, SetupError> {
    // The same rules as a block: finite corners in order.
    Wall::<D>::block(name, low, high, material)?;
    let mut walls = Vec::new();
    for (axis, axis_name) in D::AXES.iter().enumerate() {
        let normal = D::Vec::along(axis, 1.0);
        walls.push(Wall::plane(&format!("{name}_{axis_name}_low"), low, normal, material)?);
        walls.push(Wall::plane(&format!("{name}_{axis_name}_high"), high, -normal, material)?);
    }
    Ok(walls)
}

impl WallSpec {
    fn material(&self) -> &str {
        match self {
            Self::Floor { material }
            | Self::Left { material }
            | Self::Right { material }
            | Self::Sides { material }
            | Self::Gate { material, .. }
            | Self::Plane { material, .. }
            | Self::Segment { material, .. }
            | Self::Block { material, .. }
            | Self::Box { material, .. } => material,
        }
    }

    fn needs_column(&self) -> bool {
        matches!(self, Self::Right { .. } | Self::Gate { .. } | Self::Sides { .. })
    }

    /// The stage at whose start the wall opens.
    fn opens(&self) -> Option<&str> {
        match self {
            Self::Gate { opens, .. } => Some(opens),
            Self::Plane { opens, .. } | Self::Segment { opens, .. } | Self::Block { opens, .. } => {
                opens.as_deref()
            }
            _ => None,
        }
    }
}
