//! Colour maps of a fluid, from the files of a run.

use super::{Units, title};
use crate::failure::Failure;
use crate::scene::fluid::{ObstacleSpec, ShapeSpec};
use crate::scene::{Dimension, Scene};
use granular_core::units::Length;
use granular_io::figure::{MapDisk, MapFigure, MapPanel};
use granular_io::vtk::{GridFields, read_vti, read_vtp};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Corners of the outline of a disk.
const ROUND: usize = 72;

/// Width over height from which maps stand above one another only.
const FLAT: f64 = 3.0;

/// What a map shows.
pub(super) struct MapSpec<'a> {
    pub(super) files: &'a [PathBuf],
    /// Grains to be drawn over each file; none, or as many.
    pub(super) grains: &'a [PathBuf],
    pub(super) color: &'a str,
    pub(super) diverging: bool,
    pub(super) range: Option<[f64; 2]>,
}

/// A field at several times, in the unit of length that suits the size of the fluid.
pub(super) fn map(scene: &Scene, units: Units, spec: &MapSpec<'_>) -> Result<MapFigure, Failure> {
    let mut panels = Vec::new();
    let mut grid = GridFields::default();
    for (k, file) in spec.files.iter().enumerate() {
        grid = read_vti(file)?;
        let disks = spec.grains.get(k).map(|file| disks(scene, &grid, file)).transpose()?;
        panels.push(MapPanel { disks: disks.unwrap_or_default(), ..panel(scene, &grid, units, spec) });
    }
    let scale = if grid.spacing[0] * grid.cells[0] as f64 > 1.0 { 1.0 } else { 1e3 };
    let unit = if scale > 1.0 { "mm" } else { "m" };
    let upward = upward(scene);
    let corner = |axis: usize, end: usize| {
        scale
            * (grid.origin[axis] + if end == 1 { grid.spacing[axis] * grid.cells[axis] as f64 } else { 0.0 })
    };
    let corners = [0, 1].map(|end| [corner(0, end), corner(upward, end)]);
    for panel in &mut panels {
        panel.outlines.iter_mut().flatten().for_each(|point| *point = point.map(|x| scale * x));
        for disk in &mut panel.disks {
            *disk = MapDisk { center: disk.center.map(|x| scale * x), radius: scale * disk.radius };
        }
    }
    let quantity = quantity(&grid, spec.color);
    let mut figure = MapFigure::new(title(scene, &spec.color.replace('_', " ")), quantity, corners, panels);
    figure.axes = [format!("x [{unit}]"), format!("{} [{unit}]", ["x", "y", "z"][upward])];
    figure.diverging = spec.diverging;
    let [[left, below], [right, above]] = corners;
    figure.columns = if spec.files.len() > 1 && right - left < FLAT * (above - below) { 2 } else { 1 };
    figure.values = spec.range.or_else(|| from_zero(&figure));
    Ok(figure)
}

/// The colours of a speed begin at rest.
fn from_zero(figure: &MapFigure) -> Option<[f64; 2]> {
    let values = figure.panels.iter().flat_map(|panel| &panel.values);
    let largest = values.filter(|value| value.is_finite()).fold(0.0_f64, |a, b| a.max(*b));
    (figure.quantity.starts_with("speed") && largest > 0.0).then_some([0.0, largest])
}

/// The axis drawn upwards.
pub(super) fn upward(scene: &Scene) -> usize {
    match scene.dimension {
        Dimension::Plane => 1,
        Dimension::Space => 2,
    }
}

fn quantity(grid: &GridFields, color: &str) -> String {
    let unit = match color {
        "pressure" => "Pa",
        "velocity" | "speed" => "m/s",
        "vorticity" => "1/s",
        _ => return color.replace('_', " "),
    };
    let is_vector = grid.fields.iter().any(|(name, components, _)| name == color && *components > 1);
    let name = if color == "velocity" && is_vector { "speed" } else { color };
    format!("{name} [{unit}]")
}

/// One time: the plane of the fluid, or its middle layer along y in space.
fn panel(scene: &Scene, grid: &GridFields, units: Units, spec: &MapSpec<'_>) -> MapPanel {
    let values = grid.magnitude(spec.color).unwrap_or_default();
    let solid = grid.magnitude("solid").unwrap_or_default();
    // Covered cells have no flow.
    let is_solid = |index: usize| solid.get(index).is_some_and(|number| *number > 0.0);
    let values: Vec<f64> =
        values.iter().enumerate().map(|(k, value)| if is_solid(k) { f64::NAN } else { *value }).collect();
    let (normal, index) = match scene.dimension {
        Dimension::Plane => (2, 0),
        Dimension::Space => (1, grid.cells[1] / 2),
    };
    let (values, cells) = grid.plane(&values, normal, index).unwrap_or_default();
    let label = units.label(grid.time);
    let obstacles = scene.fluid.iter().flat_map(|fluid| &fluid.obstacles);
    // Those that move show by their cells.
    let outlines = obstacles.filter(|obstacle| obstacle.path.is_none()).map(|body| outline(scene, body));
    MapPanel { label, cells, values, outlines: outlines.collect(), ..MapPanel::default() }
}

/// Grains in the plane that is drawn; in space where the middle layer cuts them \[m\].
fn disks(scene: &Scene, grid: &GridFields, file: &Path) -> Result<Vec<MapDisk>, Failure> {
    let frame = read_vtp(file)?;
    let upward = upward(scene);
    let middle = grid.origin[1] + grid.spacing[1] * ((grid.cells[1] / 2) as f64 + 0.5);
    let disk = |(place, radius): (&[f64; 3], f64)| {
        let off = if upward == 2 { place[1] - middle } else { 0.0 };
        // No radius where the layer is not met.
        MapDisk { center: [place[0], place[upward]], radius: (radius * radius - off * off).max(0.0).sqrt() }
    };
    Ok(frame.points.iter().zip(frame.magnitude("radius").unwrap_or_default()).map(disk).collect())
}

/// The outline of an obstacle in the plane that is drawn \[m\].
pub(super) fn outline(scene: &Scene, obstacle: &ObstacleSpec) -> Vec<[f64; 2]> {
    let upward = upward(scene);
    let of = |values: &[Length]| [0, upward].map(|axis| values.get(axis).map_or(0.0, |x| x.value()));
    let mut shape = &obstacle.shape;
    while let ShapeSpec::Hole(inner) = shape {
        shape = inner;
    }
    match shape {
        ShapeSpec::Hole(_) => Vec::new(),
        ShapeSpec::Ball { centre, radius } => {
            let [x, y] = of(centre);
            let corner = |k| {
                let (sine, cosine) = (TAU * k as f64 / ROUND as f64).sin_cos();
                [x + radius.value() * cosine, y + radius.value() * sine]
            };
            (0..ROUND).map(corner).collect()
        }
        ShapeSpec::Block { low, high } => {
            let ([a, b], [c, d]) = (of(low), of(high));
            vec![[a, b], [c, b], [c, d], [a, d]]
        }
        ShapeSpec::Polygon(_) if scene.dimension == Dimension::Space => Vec::new(),
        ShapeSpec::Polygon(corners) => corners.iter().map(|corner| of(corner)).collect(),
    }
}
