//! Packing density on a grid: Voronoi cells shared out to the cells of the grid.

use super::{LOCAL_DENSITY, Packing, grains, room_in_plane, solids};
use granular_core::glam::DVec2;
use granular_core::{D2, FieldRef, FieldSink, Location, Shown, ShownAs, Solver};
use granular_dem::CoarseGrid;
use granular_tessellate::{Cells, Diagram, TessellationError, bulk_of};

/// Straight parts by which a curved side is drawn: they miss 1/36 of what one chord misses.
const CHORDS: u32 = 6;

/// Share of a cell of the grid that must be covered.
const LEAST: f64 = 1e-6;

/// What can be shown on a grid: of disks without a periodic cell.
pub(in super::super) fn shown_on_grid(solver: &dyn Solver) -> Vec<Shown> {
    match Packing::of(solver) {
        Some(Packing::Plane(dem)) if dem.cell().is_none() => vec![Shown::new(
            LOCAL_DENSITY,
            "1",
            "share of the grains in Voronoi cells, as far as these lie in the cell, without the free surface",
            ShownAs::Field,
        )],
        _ => Vec::new(),
    }
}

/// Shows the packing density in the cells of a grid: a mean over the Voronoi cells of the bulk, weighted by the area that lies in
/// the cell of the grid. Not a number where there are none.
pub(in super::super) fn show_on_grid(
    grid: &CoarseGrid<D2>,
    solver: &dyn Solver,
    free_surface: f64,
    sink: &mut dyn FieldSink,
) {
    if !sink.wants(LOCAL_DENSITY) || shown_on_grid(solver).is_empty() {
        return;
    }

    if let Some(Packing::Plane(dem)) = Packing::of(solver) {
        let (positions, radii) = grains(dem);
        let values = (|| -> Result<Vec<f64>, TessellationError> {
            let diagram = Diagram::new(&positions, &radii)?;
            let domain = room_in_plane(dem, &positions, &radii)?;
            Ok(shared(grid, &diagram.cells(&domain), &solids::<D2>(&radii), free_surface))
        })();
        let [columns, rows, _] = grid.cells();
        let values = values.unwrap_or_else(|_| vec![f64::NAN; columns * rows]);
        sink.field(LOCAL_DENSITY, "1", FieldRef::Scalar(&values));
    }
}

/// Shares cells out to a grid.
fn shared(grid: &CoarseGrid<D2>, cells: &Cells<'_>, solids: &[f64], free_surface: f64) -> Vec<f64> {
    let [columns, rows, _] = grid.cells();
    let (mut solid, mut area) = (vec![0.0; columns * rows], vec![0.0; columns * rows]);
    let limit = bulk_of(solids, cells.areas(), free_surface).map_or(0.0, |bulk| bulk.limit);
    let Location::Grid { origin: [x, y, _], .. } = grid.location() else { return area };
    let (origin, spacing) = (DVec2::new(x, y), grid.spacing());
    for (site, &whole) in cells.areas().iter().enumerate() {
        if !(whole > 0.0 && whole <= limit * solids[site]) {
            continue;
        }
        for outline in cells.boundary(site) {
            let points = outline.iter().flat_map(|side| {
                let parts = if side.is_straight() { 1 } else { CHORDS };
                (0..parts).map(move |part| side.point(f64::from(part) / f64::from(parts)))
            });
            let outline: Vec<DVec2> = points.map(|point| (point - origin) / spacing).collect();
            let (low, high) = outline
                .iter()
                .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
            // The conversion saturates, below at 0.
            for row in low.y as usize..rows.min(high.y as usize + 1) {
                for column in low.x as usize..columns.min(high.x as usize + 1) {
                    let part =
                        area_within(&outline, DVec2::new(column as f64, row as f64)) * spacing * spacing;
                    solid[row * columns + column] += part * solids[site] / whole;
                    area[row * columns + column] += part;
                }
            }
        }
    }
    // Less is rounding at a wall.
    let least = LEAST * spacing * spacing;
    solid.iter().zip(&area).map(|(solid, &area)| if area > least { solid / area } else { f64::NAN }).collect()
}

/// Area of a polygon within the unit square at a corner.
fn area_within(outline: &[DVec2], corner: DVec2) -> f64 {
    let mut part = outline.to_vec();
    for (point, normal) in
        [(corner, DVec2::X), (corner, DVec2::Y), (corner + 1.0, DVec2::NEG_X), (corner + 1.0, DVec2::NEG_Y)]
    {
        part = cut_at_line(&part, point, normal);
    }
    let turn = |k: usize| (part[k] - corner).perp_dot(part[(k + 1) % part.len()] - corner);
    (0..part.len()).map(|k| 0.5 * turn(k)).sum()
}

/// The part of a polygon on the side of a line to which its normal points. Parts that fall apart stay joined by sides without
/// area between them.
pub(super) fn cut_at_line(polygon: &[DVec2], point: DVec2, normal: DVec2) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(polygon.len() + 2);
    for (k, &from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let (a, b) = ((from - point).dot(normal), (to - point).dot(normal));
        if a >= 0.0 {
            kept.push(from);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            kept.push(from.lerp(to, a / (a - b)));
        }
    }
    kept
}
