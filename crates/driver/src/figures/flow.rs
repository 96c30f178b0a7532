//! Grains and force chains at chosen times, from the files of a run.

use super::walls::Walls;
use super::{Units, title};
use crate::failure::Failure;
use crate::scene::Scene;
use granular_io::figure::{Chain, Grain, GrainFigure, GrainPanel};
use granular_io::vtk::read_vtp;
use std::path::PathBuf;

/// Grains at several times, coloured by a field.
pub(super) fn grains(
    walls: &Walls<'_>,
    files: &[PathBuf],
    colour: &str,
    units: Units,
) -> Result<GrainFigure, Failure> {
    let (mut panels, mut times) = (Vec::new(), Vec::new());
    for file in files {
        let frame = read_vtp(file)?;
        let radius = frame.magnitude("radius").unwrap_or_default();
        let value = frame.magnitude(colour).unwrap_or_default();
        let grains = frame.points.iter().zip(radius.iter().zip(&value));
        let grains = grains.map(|(p, (&radius, &value))| Grain {
            center: in_plane(walls.scene, *p),
            radius: 1e3 * radius,
            value,
        });
        let label = units.label(frame.time);
        times.push(frame.time);
        panels.push(GrainPanel { label, grains: grains.collect(), ..GrainPanel::default() });
    }
    walls.add(&mut panels, &times);
    let quantity = match colour {
        "speed" | "velocity" => "speed [m/s]".to_owned(),
        "radius" => "radius [m]".to_owned(),
        other => other.replace('_', " "),
    };
    let mut figure = GrainFigure::new(title(walls.scene, "the flow"), quantity, panels);
    figure.axes = axes(walls.scene);
    Ok(figure)
}

/// Contacts at some times, their width by the normal force.
pub(super) fn chains(walls: &Walls<'_>, files: &[PathBuf], units: Units) -> Result<GrainFigure, Failure> {
    let (mut panels, mut times) = (Vec::new(), Vec::new());
    for file in files {
        let frame = read_vtp(file)?;
        let forces = frame.magnitude("normal_force").unwrap_or_default();
        let place = |index: u32| in_plane(walls.scene, frame.points[index as usize]);
        let chains = frame.links.iter().zip(forces);
        let chains = chains.map(|(&[a, b], force)| Chain { from: place(a), to: place(b), force });
        let label = units.label(frame.time);
        times.push(frame.time);
        panels.push(GrainPanel { label, chains: chains.collect(), ..GrainPanel::default() });
    }
    walls.add(&mut panels, &times);
    let mut figure = GrainFigure::new(title(walls.scene, "force chains"), "", panels);
    figure.force = "normal force [N]".to_owned();
    figure.axes = axes(walls.scene);
    Ok(figure)
}

/// The plane that is drawn, in millimetres: x and the upward axis.
pub(super) fn in_plane(scene: &Scene, [x, y, z]: [f64; 3]) -> [f64; 2] {
    match scene.dimension {
        crate::scene::Dimension::Plane => [1e3 * x, 1e3 * y],
        crate::scene::Dimension::Space => [1e3 * x, 1e3 * z],
    }
}

pub(super) fn axes(scene: &Scene) -> [String; 2] {
    match scene.dimension {
        crate::scene::Dimension::Plane => ["x [mm]".to_owned(), "y [mm]".to_owned()],
        crate::scene::Dimension::Space => ["x [mm]".to_owned(), "z [mm]".to_owned()],
    }
}
