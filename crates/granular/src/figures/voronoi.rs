//! Voronoi cells over the grains, from the files of a run.

use super::flow::{add_walls, axes, in_plane, nearest_frame};
use super::{Units, title};
use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::scene::{Scene, WallSpec};
use granular_core::glam::DVec2;
use granular_io::figure::{Grain, GrainFigure, GrainPanel, Patch};
use granular_io::vtk::Points;
use granular_tessellate::{Diagram, Domain};

/// Straight parts by which a curved side is drawn.
const CHORDS: u32 = 4;

/// The cells at several times, grey by the packing density of the grain.
pub(super) fn cells(
    scene: &Scene,
    folder: &RunFolder,
    (output, range): (&str, Option<[f64; 2]>),
    times: &[f64],
    units: Units,
) -> Result<GrainFigure, Failure> {
    let mut panels = Vec::new();
    for &time in times {
        let frame = nearest_frame(folder, output, units.start + time * units.time)?;
        let mut panel = panel(scene, &frame)?;
        let shown = (frame.time - units.start) / units.time;
        panel.label = units.name_of((shown * 100.0).round() / 100.0);
        panels.push(panel);
    }
    add_walls(scene, &mut panels);
    let mut figure = GrainFigure::new(title(scene, "Voronoi cells"), "packing density [-]", panels);
    figure.values = range;
    figure.axes = axes(scene);
    Ok(figure)
}

/// One time. The files hold no walls: cells end at floor and left side, and at the box around the grains.
fn panel(scene: &Scene, frame: &Points) -> Result<GrainPanel, Failure> {
    let radii: Vec<f64> = frame.magnitude("radius").unwrap_or_default().iter().map(|r| 1e3 * r).collect();
    let centres: Vec<DVec2> = frame.points.iter().map(|point| in_plane(scene, *point).into()).collect();
    let mut panel = GrainPanel::default();
    if centres.is_empty() {
        return Ok(panel);
    }
    let density = frame.magnitude("local_density").unwrap_or_default();
    let in_bulk = frame.magnitude("in_bulk").unwrap_or_default();
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for (&centre, &radius) in centres.iter().zip(&radii) {
        (low, high) = (low.min(centre - radius), high.max(centre + radius));
    }
    for wall in &scene.walls {
        match wall {
            WallSpec::Floor { .. } => low.y = low.y.max(0.0),
            WallSpec::Left { .. } => low.x = low.x.max(0.0),
            _ => {}
        }
    }
    let diagram = Diagram::new(&centres, &radii)?;
    let domain = Domain::rectangle(low, high)?;
    let cells = diagram.cells(&domain);
    for (site, (&density, &in_bulk)) in density.iter().zip(&in_bulk).enumerate() {
        let value = if in_bulk > 0.0 { density } else { f64::NAN };
        for sides in cells.boundary(site) {
            let points = sides.iter().flat_map(|side| {
                let parts = if side.is_straight() { 1 } else { CHORDS };
                (0..parts).map(move |part| side.point(f64::from(part) / f64::from(parts)).to_array())
            });
            panel.cells.push(Patch { outline: points.collect(), value });
        }
    }
    let grain = |(centre, radius): (&DVec2, &f64)| Grain {
        center: centre.to_array(),
        radius: *radius,
        value: f64::NAN,
    };
    panel.grains = centres.iter().zip(&radii).map(grain).collect();
    Ok(panel)
}
