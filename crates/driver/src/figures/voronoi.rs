//! Voronoi cells over the grains, from the files of a run.

use super::flow::{axes, in_plane};
use super::walls::Walls;
use super::{Units, title};
use crate::failure::Failure;
use crate::scene::{Scene, WallSpec};
use granular_core::glam::DVec2;
use granular_io::figure::{Grain, GrainFigure, GrainPanel, Patch};
use granular_io::vtk::{Points, read_vtp};
use granular_tessellate::{Diagram, Domain};
use std::path::PathBuf;

/// Straight parts by which a curved side is drawn.
const CHORDS: u32 = 4;

/// The cells at several times, grey by the packing density of the grain.
pub(super) fn cells(
    walls: &Walls<'_>,
    files: &[PathBuf],
    range: Option<[f64; 2]>,
    units: Units,
) -> Result<GrainFigure, Failure> {
    let (mut panels, mut times) = (Vec::new(), Vec::new());
    for file in files {
        let frame = read_vtp(file)?;
        let mut panel = panel(walls.scene, &frame)?;
        panel.label = units.label(frame.time);
        times.push(frame.time);
        panels.push(panel);
    }
    walls.add(&mut panels, &times);
    let mut figure = GrainFigure::new(title(walls.scene, "Voronoi cells"), "packing density [-]", panels);
    figure.values = range;
    figure.axes = axes(walls.scene);
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
