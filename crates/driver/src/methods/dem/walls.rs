//! Walls of a scene.

use super::boundaries::{self, Surroundings};
use crate::column::{ColumnSize, Round};
use crate::machine;
use crate::problems::Problems;
use crate::scene::WallSpec;
use granular_core::units::Length;
use granular_core::{Dim, Vector};
use granular_dem::{MaterialId, SetupError, Wall};
use std::path::Path;

/// Memory that a byte of a file of triangles takes, with the tree of boxes around them \[bytes\].
const BYTES_PER_BYTE: f64 = 20.0;

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
    around: &Surroundings<'_>,
    problems: &mut Problems,
) -> BuiltWalls<D> {
    let mut built = BuiltWalls { list: Vec::new(), openings: Vec::new() };
    let mut moving = Vec::new();
    for (k, spec) in specs.iter().enumerate() {
        let path = format!("walls.{k}");
        let Some(material) = around.materials.find(&format!("{path}.material"), spec.material(), problems)
        else {
            continue;
        };
        let column = match beside {
            Beside::Column(column) => Some(column),
            Beside::Unknown if spec.needs_column() => continue,
            Beside::Nothing if spec.needs_column() => {
                let (value, hint) = ("a wall beside a column", "write a Plane instead");
                problems.add(path, value, "only with a sample that is a Column or Cylinder", hint);
                continue;
            }
            _ => None,
        };
        let before = built.list.len();
        match shapes::<D>(&path, spec, (column, around), material, problems) {
            Ok(list) => {
                if let Some(motion) = spec.moves() {
                    moving.extend((0..list.len()).map(|index| (path.clone(), before + index, motion)));
                }
                built.list.extend(list);
            }
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
    // A motion may name walls that stand further down in the scene.
    for (path, index, motion) in moving {
        boundaries::set_moving(&path, (&mut built.list, index), motion, around, problems);
    }
    built
}

fn shapes<D: Dim>(
    path: &str,
    spec: &WallSpec,
    (column, around): (Option<ColumnSize>, &Surroundings<'_>),
    material: MaterialId,
    problems: &mut Problems,
) -> Result<Vec<Wall<D>>, SetupError> {
    let mut point = |key: &str, values: &[Length]| problems.vector::<D, _>(&format!("{path}.{key}"), values);
    Ok(match spec {
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
        WallSpec::Tube { name, from, to, radius, .. } => match (point("from", from), point("to", to)) {
            (Some(from), Some(to)) => vec![Wall::tube(name, from, to, radius.value(), material)?],
            _ => vec![],
        },
        WallSpec::Circle { name, centre, radius, .. } => match point("centre", centre) {
            Some(centre) => vec![Wall::circle(name, centre, radius.value(), material)?],
            None => vec![],
        },
        WallSpec::Chain { name, points, closed, .. } => {
            let points: Option<Vec<D::Vec>> =
                points.iter().enumerate().map(|(k, at)| point(&format!("points.{k}"), at)).collect();
            points
                .map(|points| Wall::chain(name, &points, *closed, material))
                .transpose()?
                .into_iter()
                .collect()
        }
        WallSpec::Mesh { .. } => mesh::<D>(path, spec, (material, &around.scene.folder), problems)?,
        WallSpec::HeldGrains { name, low, high, diameter, spacing, scatter, seed, .. } => {
            match (point("low", low), point("high", high)) {
                (Some(low), Some(high)) => {
                    let sizes = (diameter.value(), spacing.value(), scatter.value());
                    let held = boundaries::held_grains::<D>(path, (low, high), sizes, *seed, problems);
                    held.map(|held| Wall::held_grains(name, &held, material))
                        .transpose()?
                        .into_iter()
                        .collect()
                }
                _ => vec![],
            }
        }
        WallSpec::Box { name, low, high, .. } => match (point("low", low), point("high", high)) {
            (Some(low), Some(high)) => closed_box::<D>(name, low, high, material)?,
            _ => vec![],
        },
        _ => beside_walls::<D>(path, spec, (column, around.top), material, problems)?,
    })
}

/// Walls whose place follows from the sample.
fn beside_walls<D: Dim>(
    path: &str,
    spec: &WallSpec,
    (column, top): (Option<ColumnSize>, f64),
    material: MaterialId,
    problems: &mut Problems,
) -> Result<Vec<Wall<D>>, SetupError> {
    let right = column.map_or(0.0, |column| column.width);
    let plane = |name: &str, axis: usize, at: f64, towards: f64| {
        Wall::plane(name, D::Vec::along(axis, at), D::Vec::along(axis, towards), material)
    };
    Ok(match spec {
        WallSpec::Floor { .. } => vec![plane("floor", D::UP, 0.0, 1.0)?],
        WallSpec::Left { .. } => vec![plane("left", 0, 0.0, 1.0)?],
        WallSpec::Right { .. } if column.is_some_and(|column| column.round.is_some()) => {
            problems.add(path, "Right", "a Gate beside a cylinder", "or write a Tube");
            vec![]
        }
        WallSpec::Right { .. } => vec![plane("right", 0, right, -1.0)?],
        WallSpec::Gate { .. } => match column {
            Some(ColumnSize { width, height, round: Some(_), .. }) => {
                // Beyond the floor and the loose lattice from which the cylinder settles.
                let ends = [-0.1 * width, height.max(top) + width];
                let [from, to] = ends.map(|at| D::Vec::along(D::UP, at));
                vec![Wall::tube("gate", from, to, width, material)?]
            }
            _ => vec![plane("gate", 0, right, -1.0)?],
        },
        WallSpec::Sides { .. } => match column {
            Some(ColumnSize { depth: Some(depth), .. }) => {
                vec![plane("front", 1, 0.0, 1.0)?, plane("back", 1, depth, -1.0)?]
            }
            Some(ColumnSize { round: Some(Round::Half), .. }) => vec![plane("front", 1, 0.0, 1.0)?],
            _ => {
                let hint = "a plane column and a whole cylinder have no sides";
                problems.add(path, "Sides", "a column in space or half a cylinder", hint);
                vec![]
            }
        },
        _ => vec![],
    })
}

/// The triangles of a file, where the scene puts them.
fn mesh<D: Dim>(
    path: &str,
    spec: &WallSpec,
    (material, folder): (MaterialId, &Path),
    problems: &mut Problems,
) -> Result<Vec<Wall<D>>, SetupError> {
    let WallSpec::Mesh { name, file, unit, at, .. } = spec else { return Ok(vec![]) };
    let file = folder.join(file);
    let read = machine::readable(&file, BYTES_PER_BYTE)
        .and_then(|()| granular_io::read_stl(&file).map_err(|error| error.to_string()));
    let triangles = match read {
        Ok(triangles) => triangles,
        Err(error) => {
            let hint = "the path counts from the folder of the scene";
            problems.add(
                format!("{path}.file"),
                format!("`{}`: {error}", file.display()),
                "an STL file that can be read",
                hint,
            );
            return Ok(vec![]);
        }
    };
    let at = if at.is_empty() {
        Some(D::Vec::default())
    } else {
        problems.vector::<D, _>(&format!("{path}.at"), at)
    };
    let Some(at) = at else { return Ok(vec![]) };
    let corner = |corner: &[f64; 3]| D::Vec::from_slice(corner).map(|corner| at + corner * unit.value());
    let corners: Option<Vec<D::Vec>> = triangles.as_flattened().iter().map(corner).collect();
    match corners {
        Some(corners) => Ok(vec![Wall::triangles(name, corners, material)?]),
        None => {
            problems.add(path, "Mesh", "a scene in space", "in the plane a Chain does the same");
            Ok(vec![])
        }
    }
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
    /// Name of its material.
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
            | Self::Tube { material, .. }
            | Self::Circle { material, .. }
            | Self::Chain { material, .. }
            | Self::Mesh { material, .. }
            | Self::HeldGrains { material, .. }
            | Self::Box { material, .. } => material,
        }
    }

    /// Whether its place follows from that of a column.
    fn needs_column(&self) -> bool {
        matches!(self, Self::Right { .. } | Self::Gate { .. } | Self::Sides { .. })
    }
}
