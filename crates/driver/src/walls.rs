//! Walls of a scene: their shapes, how they move, and when they open. What touches them is a matter of methods.

mod motion;

#[cfg(feature = "dem")]
pub(crate) use motion::waits;

use crate::column::{ColumnSize, Round};
use crate::machine;
use crate::problems::{Problems, nearest};
use crate::scene::{Scene, WallSpec};
use granular_core::units::Length;
use granular_core::{Dim, SetupError, Shape, Vector, WallMotion};
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
    /// A sample that is no column.
    Nothing,
}

/// A wall of a scene.
pub(crate) struct BuiltWall<D: Dim> {
    pub(crate) name: String,
    pub(crate) shape: Shape<D>,
    /// Name of its material.
    pub(crate) material: String,
    pub(crate) motion: Option<WallMotion<D>>,
    /// Whether it moves only once a stage starts it.
    pub(crate) waits: bool,
}

impl<D: Dim> AsRef<Shape<D>> for BuiltWall<D> {
    fn as_ref(&self) -> &Shape<D> {
        &self.shape
    }
}

/// Walls, and which opens at which stage: scene path, name of the wall, name of the stage.
pub(crate) struct BuiltWalls<D: Dim> {
    pub(crate) list: Vec<BuiltWall<D>>,
    pub(crate) openings: Vec<(String, String, String)>,
}

/// What walls need to know of the scene.
pub(crate) struct Surroundings<'a> {
    pub(crate) scene: &'a Scene,
    /// Whether there is a material of this name; says at a path when there is not.
    pub(crate) knows: &'a dyn Fn(&str, &str, &mut Problems) -> bool,
    /// Stiffness of a material \[N/m\], by its name; for the dashpots of servos.
    pub(crate) stiffness: &'a dyn Fn(&str) -> f64,
    /// Mass of the sample \[kg\].
    pub(crate) mass: f64,
    /// Highest point of the sample \[m\].
    pub(crate) top: f64,
}

/// A wall before it has a material.
type Named<D> = (String, Shape<D>);

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
        if !(around.knows)(&format!("{path}.material"), spec.material(), problems) {
            continue;
        }
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
        match shapes::<D>(&path, spec, (column, around), problems) {
            Ok(list) => {
                if let Some(motion) = spec.moves() {
                    moving.extend((0..list.len()).map(|index| (path.clone(), before + index, motion)));
                }
                let material = spec.material();
                built.list.extend(list.into_iter().map(|(name, shape)| BuiltWall {
                    name,
                    shape,
                    material: material.to_owned(),
                    motion: None,
                    waits: false,
                }));
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
    for (path, index, spec) in moving {
        motion::set_moving(&path, (&mut built.list, index), spec, around, problems);
    }
    built
}

/// Whether walls open at stages that there are.
pub(crate) fn check_openings(scene: &Scene, openings: &[(String, String, String)], problems: &mut Problems) {
    let known: Vec<&str> = scene.stages.iter().map(|stage| stage.name.as_str()).collect();
    for (path, _, stage) in openings.iter().filter(|(.., stage)| !known.contains(&stage.as_str())) {
        if !known.is_empty() {
            problems.add(
                format!("{path}.opens"),
                format!("`{stage}`, which is not a stage of this scene"),
                format!("a stage of this scene: {}", known.join(", ")),
                nearest(stage, known.iter().copied()),
            );
        }
    }
}

/// A shape under a name; an error says of which wall it is.
fn named<D: Dim>(name: &str, shape: Result<Shape<D>, SetupError>) -> Result<Vec<Named<D>>, SetupError> {
    let shape = shape.map_err(|error| error.of(format_args!("wall `{name}`")))?;
    Ok(vec![(name.to_owned(), shape)])
}

fn shapes<D: Dim>(
    path: &str,
    spec: &WallSpec,
    (column, around): (Option<ColumnSize>, &Surroundings<'_>),
    problems: &mut Problems,
) -> Result<Vec<Named<D>>, SetupError> {
    let mut point = |key: &str, values: &[Length]| problems.vector::<D, _>(&format!("{path}.{key}"), values);
    let shape = match spec {
        WallSpec::Plane { point: on, normal, .. } => {
            let on = point("point", on);
            let numbers: Vec<Length> = normal.iter().map(|&n| n.into()).collect();
            on.zip(point("normal", &numbers)).map(|(on, normal)| Shape::plane(on, normal))
        }
        WallSpec::Segment { from, to, .. } => {
            point("from", from).zip(point("to", to)).map(|(from, to)| Shape::segment(from, to))
        }
        WallSpec::Block { low, high, .. } => {
            point("low", low).zip(point("high", high)).map(|(low, high)| Shape::block(low, high))
        }
        WallSpec::Tube { from, to, radius, .. } => {
            point("from", from).zip(point("to", to)).map(|(from, to)| Shape::tube(from, to, radius.value()))
        }
        WallSpec::Circle { centre, radius, .. } => {
            point("centre", centre).map(|centre| Shape::circle(centre, radius.value()))
        }
        WallSpec::Chain { points, closed, .. } => {
            let points: Option<Vec<D::Vec>> =
                points.iter().enumerate().map(|(k, at)| point(&format!("points.{k}"), at)).collect();
            points.map(|points| Shape::chain(&points, *closed))
        }
        WallSpec::Mesh { .. } => mesh::<D>(path, spec, &around.scene.folder, problems),
        WallSpec::HeldGrains { low, high, diameter, spacing, scatter, seed, .. } => {
            let corners = point("low", low).zip(point("high", high));
            let sizes = (diameter.value(), spacing.value(), scatter.value());
            let held =
                corners.and_then(|corners| motion::held_grains::<D>(path, corners, sizes, *seed, problems));
            held.map(|held| Shape::balls(&held))
        }
        WallSpec::Box { name, low, high, .. } => {
            return match point("low", low).zip(point("high", high)) {
                Some((low, high)) => closed_box::<D>(name, low, high),
                None => Ok(vec![]),
            };
        }
        _ => return beside_walls::<D>(path, spec, (column, around.top), problems),
    };
    shape.map_or(Ok(vec![]), |shape| named(spec.name(), shape))
}

/// Walls whose place follows from the sample.
fn beside_walls<D: Dim>(
    path: &str,
    spec: &WallSpec,
    (column, top): (Option<ColumnSize>, f64),
    problems: &mut Problems,
) -> Result<Vec<Named<D>>, SetupError> {
    let right = column.map_or(0.0, |column| column.width);
    let plane = |name: &str, axis: usize, at: f64, towards: f64| {
        named(name, Shape::plane(D::Vec::along(axis, at), D::Vec::along(axis, towards)))
    };
    Ok(match spec {
        WallSpec::Floor { .. } => plane("floor", D::UP, 0.0, 1.0)?,
        WallSpec::Left { .. } => plane("left", 0, 0.0, 1.0)?,
        WallSpec::Right { .. } if column.is_some_and(|column| column.round.is_some()) => {
            problems.add(path, "Right", "a Gate beside a cylinder", "or write a Tube");
            vec![]
        }
        WallSpec::Right { .. } => plane("right", 0, right, -1.0)?,
        WallSpec::Gate { .. } => match column {
            Some(ColumnSize { width, height, round: Some(_), .. }) => {
                // Beyond the floor and the loose lattice from which the cylinder settles.
                let ends = [-0.1 * width, height.max(top) + width];
                let [from, to] = ends.map(|at| D::Vec::along(D::UP, at));
                named("gate", Shape::tube(from, to, width))?
            }
            _ => plane("gate", 0, right, -1.0)?,
        },
        WallSpec::Sides { .. } => match column {
            Some(ColumnSize { depth: Some(depth), .. }) => {
                [plane("front", 1, 0.0, 1.0)?, plane("back", 1, depth, -1.0)?].concat()
            }
            Some(ColumnSize { round: Some(Round::Half), .. }) => plane("front", 1, 0.0, 1.0)?,
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
    folder: &Path,
    problems: &mut Problems,
) -> Option<Result<Shape<D>, SetupError>> {
    let WallSpec::Mesh { file, unit, at, .. } = spec else { return None };
    let file = folder.join(file);
    let read = machine::readable(&file, BYTES_PER_BYTE)
        .and_then(|()| granular_io::read_stl(&file).map_err(|error| error.to_string()));
    let triangles = match read {
        Ok(triangles) => triangles,
        Err(error) => {
            let hint = "the path counts from the folder of the scene";
            let value = format!("`{}`: {error}", file.display());
            problems.add(format!("{path}.file"), value, "an STL file that can be read", hint);
            return None;
        }
    };
    let at =
        if at.is_empty() { D::Vec::default() } else { problems.vector::<D, _>(&format!("{path}.at"), at)? };
    let corner = |corner: &[f64; 3]| D::Vec::from_slice(corner).map(|corner| at + corner * unit.value());
    let corners: Option<Vec<D::Vec>> = triangles.as_flattened().iter().map(corner).collect();
    if corners.is_none() {
        problems.add(path, "Mesh", "a scene in space", "in the plane a Chain does the same");
    }
    corners.map(Shape::triangles)
}

fn closed_box<D: Dim>(name: &str, low: D::Vec, high: D::Vec) -> Result<Vec<Named<D>>, SetupError> {
    // The same rules as a block: finite corners in order.
    named(name, Shape::<D>::block(low, high))?;
    let mut walls = Vec::new();
    for (axis, axis_name) in D::AXES.iter().enumerate() {
        let normal = D::Vec::along(axis, 1.0);
        walls.extend(named(&format!("{name}_{axis_name}_low"), Shape::plane(low, normal))?);
        walls.extend(named(&format!("{name}_{axis_name}_high"), Shape::plane(high, -normal))?);
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
