//! Grains and force chains at chosen times, from the files of a run.

use super::{Units, title};
use crate::failure::Failure;
use crate::folder::RunFolder;
use crate::scene::{Scene, WallSpec};
use granular_io::Collection;
use granular_io::figure::{Chain, Grain, GrainFigure, GrainPanel};
use granular_io::vtk::{Points, read_vtp};
use std::path::{Path, PathBuf};

/// The file of an output that is nearest to a simulated time \[s\].
pub(super) fn nearest_file(folder: &RunFolder, output: &str, time: f64) -> Result<PathBuf, Failure> {
    let list = folder.path().join(format!("{output}.pvd"));
    let files = Collection::open(&list)?;
    let distance = |entry: &&(f64, String)| (entry.0 - time).abs();
    let nearest = files.entries().iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let (_, file) = nearest.ok_or_else(|| Failure::io(list.display(), "lists no files yet"))?;
    Ok(list.parent().unwrap_or(Path::new(".")).join(file))
}

pub(super) fn nearest_frame(folder: &RunFolder, output: &str, time: f64) -> Result<Points, Failure> {
    Ok(read_vtp(&nearest_file(folder, output, time)?)?)
}

/// Grains at several times, coloured by a field.
pub(super) fn grains(
    scene: &Scene,
    folder: &RunFolder,
    (output, colour): (&str, &str),
    times: &[f64],
    units: Units,
) -> Result<GrainFigure, Failure> {
    let mut panels = Vec::new();
    for &time in times {
        let frame = nearest_frame(folder, output, units.start + time * units.time)?;
        let radius = frame.magnitude("radius").unwrap_or_default();
        let value = frame.magnitude(colour).unwrap_or_default();
        let grains = frame.points.iter().zip(radius.iter().zip(&value));
        let grains = grains.map(|(p, (&radius, &value))| Grain {
            center: in_plane(scene, *p),
            radius: 1e3 * radius,
            value,
        });
        let shown = (frame.time - units.start) / units.time;
        let label = units.name_of((shown * 100.0).round() / 100.0);
        panels.push(GrainPanel { label, grains: grains.collect(), ..GrainPanel::default() });
    }
    add_walls(scene, &mut panels);
    let quantity = match colour {
        "speed" | "velocity" => "speed [m/s]".to_owned(),
        "radius" => "radius [m]".to_owned(),
        other => other.replace('_', " "),
    };
    let mut figure = GrainFigure::new(title(scene, "the flow"), quantity, panels);
    figure.axes = axes(scene);
    Ok(figure)
}

/// Contacts at one time, their width by the normal force.
pub(super) fn chains(
    scene: &Scene,
    folder: &RunFolder,
    output: &str,
    time: f64,
    units: Units,
) -> Result<GrainFigure, Failure> {
    let frame = nearest_frame(folder, output, units.start + time * units.time)?;
    let forces = frame.magnitude("normal_force").unwrap_or_default();
    let place = |index: u32| in_plane(scene, frame.points[index as usize]);
    let chains = frame.links.iter().zip(forces);
    let chains = chains.map(|(&[a, b], force)| Chain { from: place(a), to: place(b), force });
    let shown = (frame.time - units.start) / units.time;
    let label = units.name_of((shown * 100.0).round() / 100.0);
    let mut panels = vec![GrainPanel { label, chains: chains.collect(), ..GrainPanel::default() }];
    add_walls(scene, &mut panels);
    let mut figure = GrainFigure::new(title(scene, "force chains"), "", panels);
    figure.force = "normal force [N]".to_owned();
    figure.axes = axes(scene);
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

/// Floor and left wall, as far as grains reach in any panel.
pub(super) fn add_walls(scene: &Scene, panels: &mut [GrainPanel]) {
    let ends = panels.iter().flat_map(|panel| {
        let grains = panel
            .grains
            .iter()
            .flat_map(|g| [[g.center[0] - g.radius, 0.0], [g.center[0] + g.radius, g.center[1] + g.radius]]);
        let chains = panel.chains.iter().flat_map(|chain| [chain.from, chain.to]);
        grains.chain(chains).collect::<Vec<_>>()
    });
    let [left, right, top] = ends.fold([0.0_f64; 3], |[x0, x1, y], [a, b]| [x0.min(a), x1.max(a), y.max(b)]);
    // Beside a wall at x = 0 grains overlap it a little.
    let left =
        if scene.walls.iter().any(|wall| matches!(wall, WallSpec::Left { .. })) { 0.0 } else { 1.02 * left };
    let point = |at: &[granular_core::units::Length]| {
        in_plane(scene, std::array::from_fn(|axis| at.get(axis).map_or(0.0, |x| x.value())))
    };
    let mut lines = Vec::new();
    for wall in &scene.walls {
        match wall {
            WallSpec::Floor { .. } => lines.push([[left, 0.0], [1.02 * right, 0.0]]),
            WallSpec::Left { .. } => lines.push([[0.0, 0.0], [0.0, 1.05 * top]]),
            WallSpec::Segment { from, to, opens: None, .. } => lines.push([point(from), point(to)]),
            WallSpec::Chain { points, closed, .. } => {
                let closing = points.last().zip(points.first()).filter(|_| *closed);
                let pairs = points.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing);
                lines.extend(pairs.map(|(from, to)| [point(from), point(to)]));
            }
            _ => {}
        }
    }
    panels.iter_mut().for_each(|panel| panel.walls.clone_from(&lines));
}
