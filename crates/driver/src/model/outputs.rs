//! Whether outputs and figures ask only for what there is, and write only where they may.

mod files;

use super::Model;
use crate::machine::room_for;
use crate::methods::member::Member;
use crate::observers::Line;
use crate::observers::source::place_of;
use crate::problems::{Problems, nearest, quoted};
use crate::scene::names::Need;
use crate::scene::{Chosen, Dimension, EverySpec, FigureSpec, Output, Scene, Writer};
use files::{Files, Taken, check_path, spelled};
use granular_core::{Location, ShownAs};
use granular_io::can_be_a_column;
use std::sync::Arc;

/// Memory that a point of a line takes, with the cells around it \[bytes\].
const BYTES_PER_POINT: f64 = 400.0;
/// Memory that a cell takes over which grains are averaged \[bytes\].
const BYTES_PER_AVERAGE: f64 = 1000.0;

/// Checks of schedules and files.
pub(super) fn check_files(scene: &Scene, problems: &mut Problems) {
    let mut taken = Taken::default();
    let mut names: Vec<String> = Vec::new();
    for (k, output) in scene.outputs.iter().enumerate() {
        let (positive, shown) = match output.every {
            EverySpec::Time(time) => (time.value() > 0.0, time.to_string()),
            EverySpec::Steps(steps) => (steps > 0, steps.to_string()),
        };
        if !positive {
            problems.add(format!("outputs.{k}.every"), shown, "a positive interval", "");
        }
        if cfg!(not(feature = "hdf5")) && matches!(output.write, Writer::Hdf5 { .. }) {
            let hint = "Fields writes the same for ParaView without it";
            let value = "Hdf5, which this program was built without";
            problems.add(
                format!("outputs.{k}.write"),
                value,
                "a program with the cargo feature `hdf5`",
                hint,
            );
        }
        let free_surface = output.write.free_surface();
        if !(free_surface > 1.0 && free_surface.is_finite()) {
            let hint = "cells larger than this many times the mean are free surface; 2 is the default";
            problems.add(format!("outputs.{k}.write.free_surface"), free_surface, "a number above 1", hint);
        }
        let place = format!("outputs.{k}.write.path");
        let path = output.write.path();
        if check_path(&place, path, problems) {
            let path = spelled(path);
            // Outputs are known by their paths, also those that write several files.
            if names.contains(&path) {
                problems.add(place, format!("`{}` again", output.write.path()), "a path of its own", "");
                continue;
            }
            let files = match output.write {
                Writer::Table { .. } | Writer::Profile { .. } | Writer::Tracks { .. } => {
                    vec![Files::One(path.clone())]
                }
                Writer::Fields { .. } | Writer::Contacts { .. } => {
                    let frames = [".vtp", ".vti"].map(|ending| Files::Frames(path.clone(), ending));
                    [vec![Files::One(format!("{path}.pvd"))], frames.to_vec()].concat()
                }
                Writer::Hdf5 { .. } => vec![Files::One(format!("{path}.vtkhdf"))],
            };
            names.push(path);
            taken.claim(&place, output.write.path(), files, problems);
        }
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        let Some(path) = &stage.save else { continue };
        let place = format!("stages.{k}.save");
        if check_path(&place, path, problems) {
            taken.claim(&place, path, vec![Files::One(spelled(path))], problems);
            check_materials(scene, problems);
        }
    }
    for (k, figure) in scene.figures.iter().enumerate() {
        let place = format!("figures.{k}.path");
        let path = figure.path();
        if check_path(&place, path, problems) {
            let files = ["svg", "png"].map(|ending| Files::One(format!("{}.{ending}", spelled(path))));
            taken.claim(&place, path, files.to_vec(), problems);
        }
        let (key, empty) = match figure {
            FigureSpec::Series { columns, .. } | FigureSpec::Curve { columns, .. } => {
                ("columns", columns.is_empty())
            }
            FigureSpec::Flow { times, .. }
            | FigureSpec::RadialProfile { times, .. }
            | FigureSpec::Cells { times, .. }
            | FigureSpec::Map { times, .. }
            | FigureSpec::Profile { times, .. } => ("times", times.is_empty()),
            _ => ("", false),
        };
        if let FigureSpec::Map { range: Some(range), .. } | FigureSpec::Cells { range: Some(range), .. } =
            figure
            && !matches!(range.as_slice(), [low, high] if low < high)
        {
            let allowed = "two values, the lower one first";
            problems.add(format!("figures.{k}.range"), format!("{range:?}"), allowed, "");
        }
        if empty {
            problems.add(format!("figures.{k}.{key}"), "empty", "at least one", "");
        }
    }
}

/// Refuses names of materials that the file of a saved sample cannot hold.
fn check_materials(scene: &Scene, problems: &mut Problems) {
    for name in scene.materials.keys().filter(|name| name.contains([',', '\n', '\r'])) {
        let place = format!("materials.{}", quoted(name));
        let hint = "a stage saves the grains with the names of their materials, one line a grain";
        problems.add(
            place,
            format!("a material called `{name}`"),
            "a name without comma and line break",
            hint,
        );
    }
}

/// Checks of probes, fields and columns.
pub(super) fn check_names(scene: &Scene, model: &Model, problems: &mut Problems) {
    let mut unknown = Vec::new();
    for (k, output) in scene.outputs.iter().enumerate() {
        let (key, kind) = match &output.write {
            Writer::Table { .. } => ("probes", ShownAs::Number),
            Writer::Fields { .. } | Writer::Profile { .. } | Writer::Tracks { .. } | Writer::Hdf5 { .. } => {
                ("fields", ShownAs::Field)
            }
            Writer::Contacts { .. } => ("fields", ShownAs::Link),
        };
        let names = output.write.names();
        let Some(member) = member_of(output, model) else {
            let path = format!("outputs.{k}.of");
            let known: Vec<&str> = scene.solvers.keys().map(String::as_str).collect();
            let of = output.of.as_deref().unwrap_or_default();
            let hint = nearest(of, known.iter().copied());
            problems.add(path, format!("`{of}`, which is no solver of this scene"), known.join(", "), hint);
            unknown.push(output.write.path());
            continue;
        };
        let shown = match output.write.grid() {
            Some(_) => member.shown_on_grids(&model.simulation),
            None => member.shown(&model.simulation),
        };
        let known: Vec<&str> = shown.iter().filter(|s| s.kind == kind).map(|s| s.name.as_str()).collect();
        for (n, name) in names.iter().enumerate() {
            let path = format!("outputs.{k}.write.{key}.{n}");
            if !known.contains(&name.as_str()) {
                let hint = nearest(name, known.iter().copied());
                problems.add(path, format!("`{name}`, which nothing shows"), known.join(", "), hint);
                unknown.push(output.write.path());
            } else if matches!(output.write, Writer::Tracks { .. }) && name == "id" {
                let allowed = "each name once: Tracks writes time, id and place in any case";
                problems.add(path, "`id` again", allowed, "");
            } else if kind == ShownAs::Number && !can_be_a_column(name) {
                let allowed = "a name without comma, quote, bracket and line break, and no blank at its ends";
                let hint = "rename the wall, obstacle or gauge";
                problems.add(path, format!("`{name}`, which no table can hold"), allowed, hint);
            } else if names[..n].contains(name) {
                problems.add(path, format!("`{name}` again"), "each name once", "");
            } else if kind == ShownAs::Field && output.write.grid().is_none() {
                let [first, here] = [&names[..1], &names[n..=n]].map(|names| place_of(names, &shown));
                if let (Some(first), Some(here)) = (first, here)
                    && first != here
                {
                    let value = format!("`{name}`, which lives at another place than `{}`", names[0]);
                    problems.add(
                        path,
                        value,
                        "fields of one place",
                        "write the others in an output of their own",
                    );
                }
            }
        }
    }
    check_grids(scene, model, problems);
    check_lines(scene, model, problems);
    check_tracks(scene, model, problems);
    let front = model.column().map_or("front", |column| column.front());
    check_figures(model, (scene, front), &unknown, problems);
}

/// The solver of which an output is; none when the scene has none of this name.
fn member_of<'a>(output: &Output, model: &'a Model) -> Option<&'a Arc<dyn Member>> {
    match &output.of {
        None => model.members.first(),
        Some(name) => model.members.iter().find(|member| member.name() == name),
    }
}

/// Whether grids of outputs are of grains and make sense.
fn check_grids(scene: &Scene, model: &Model, problems: &mut Problems) {
    for (k, output) in scene.outputs.iter().enumerate() {
        let Some(member) = member_of(output, model) else { continue };
        match output.write.grid().map(|grid| member.averages(grid)) {
            Some(Err(error)) => {
                problems.add(format!("outputs.{k}.write.{}", error.key), error.value, error.allowed, "");
            }
            Some(Ok(grid)) => {
                let Location::Grid { cells, .. } = grid.location() else { continue };
                let count: f64 = cells.iter().map(|&along| along as f64).product();
                if let Err(allowed) = room_for(count, BYTES_PER_AVERAGE) {
                    let place = format!("outputs.{k}.write.grid.spacing");
                    problems.add(place, format!("so small that the grid has {count:.0} cells"), allowed, "");
                }
            }
            None => {}
        }
    }
}

/// Whether tracks are of grains that there are.
fn check_tracks(scene: &Scene, model: &Model, problems: &mut Problems) {
    for (k, output) in scene.outputs.iter().enumerate() {
        let Writer::Tracks { grains, .. } = &output.write else { continue };
        let Some(member) = member_of(output, model) else { continue };
        let (path, solver) = (format!("outputs.{k}.write"), member.solver(&model.simulation));
        if matches!(solver.location(), Location::Grid { .. }) {
            problems.add(path, "Tracks of a fluid", "Tracks of grains", "Fields writes all cells");
            continue;
        }
        let count = solver.size().0;
        match grains {
            Chosen::Every(0) => problems.add(format!("{path}.grains"), 0, "1 or more", "1 takes all grains"),
            Chosen::Ids(ids) if ids.is_empty() => {
                problems.add(format!("{path}.grains"), "empty", "at least one identifier", "");
            }
            Chosen::Ids(ids) => {
                if let Some(id) = ids.iter().find(|&&id| id as usize >= count) {
                    let allowed = format!("identifiers of the {count} grains, from 0 on");
                    problems.add(format!("{path}.grains"), id, allowed, "");
                }
            }
            Chosen::Every(_) => {}
        }
    }
}

/// Where the fields of an output live.
fn location_of<'a>(output: &Output, model: &'a Model) -> Option<Location<'a>> {
    let member = member_of(output, model)?;
    match output.write.grid() {
        Some(grid) => member.averages(grid).ok().map(|grid| grid.location()),
        None => Some(member.solver(&model.simulation).location()),
    }
}

/// Whether lines of profiles lie in the grid.
fn check_lines(scene: &Scene, model: &Model, problems: &mut Problems) {
    for (k, output) in scene.outputs.iter().enumerate() {
        let Writer::Profile { from, to, points, .. } = &output.write else { continue };
        let path = format!("outputs.{k}.write");
        // A grid that makes no sense has been blamed.
        let Some(location) = location_of(output, model) else { continue };
        let Location::Grid { origin, spacing, cells } = location else {
            let hint = "add `grid` to average the grains; Fields writes all of them";
            problems.add(path, "a Profile of grains", "a Profile of a fluid, or one with a `grid`", hint);
            continue;
        };
        let axes = if cells[2] > 1 { 3 } else { 2 };
        if *points < 2 {
            problems.add(format!("{path}.points"), points, "2 or more", "");
        }
        if let Err(allowed) = room_for(*points as f64, BYTES_PER_POINT) {
            problems.add(format!("{path}.points"), points, allowed, "");
        }
        for (key, end) in [("from", from), ("to", to)] {
            if end.len() != axes {
                let allowed = format!("{axes} values, one per axis");
                problems.add(format!("{path}.{key}"), format!("a list of {}", end.len()), allowed, "");
            }
        }
        let reach = |axis: usize| {
            let (low, size) = (origin[axis], spacing[axis] * cells[axis] as f64);
            (low - 1e-9 * size, low + size + 1e-9 * size)
        };
        let outside = Line::of(from, to, (*points).clamp(2, 1000))
            .points()
            .iter()
            .copied()
            .find(|point| (0..axes).any(|axis| !(reach(axis).0..=reach(axis).1).contains(&point[axis])));
        if let Some([x, y, z]) = outside {
            let place = if output.write.grid().is_some() { "grid" } else { "fluid" };
            let value = format!("({x}, {y}, {z}) m, outside the {place}");
            problems.add(path, value, format!("a line in the {place}"), "");
        }
    }
}

/// Whether figures draw from outputs that hold what they need. Outputs with `unknown` names have
/// been blamed: what seems to lack is perhaps only misspelt.
fn check_figures(
    model: &Model,
    (scene, front): (&Scene, &'static str),
    unknown: &[&str],
    problems: &mut Problems,
) {
    for (k, figure) in scene.figures.iter().enumerate() {
        if matches!(figure, FigureSpec::Cells { .. }) && scene.dimension == Dimension::Space {
            let hint = "Flow draws spheres; `local_density` can be its colour";
            problems.add(format!("figures.{k}"), "Cells in space", "Cells in the plane", hint);
        }
        let mut need = figure.needs(front);
        if let (FigureSpec::Energies { .. }, Some(member)) = (figure, drawn_of(scene, model, &need)) {
            need.names = member.energies().to_vec();
        }
        for need in std::iter::once(&need).chain(figure.also_needs().as_ref()) {
            check_need(scene, k, need, unknown, problems);
        }
        if let Some(stage) = need.stage.filter(|s| !scene.stages.iter().any(|other| other.name == *s)) {
            let known: Vec<&str> = scene.stages.iter().map(|stage| stage.name.as_str()).collect();
            let hint = nearest(stage, known.iter().copied());
            let value = format!("`{stage}`, which is not a stage of this scene");
            let allowed = format!("a stage of this scene: {}", known.join(", "));
            problems.add(format!("figures.{k}.stage"), value, allowed, hint);
        }
    }
}

/// The solver whose output a figure draws.
fn drawn_of<'a>(scene: &Scene, model: &'a Model, need: &Need<'_>) -> Option<&'a Arc<dyn Member>> {
    let mut outputs = scene.outputs.iter();
    let output =
        outputs.find(|output| output.write.kind() == need.writer && output.write.path() == need.output);
    output.and_then(|output| member_of(output, model))
}

/// Whether there is an output that holds what figure `k` needs.
fn check_need(scene: &Scene, k: usize, need: &Need<'_>, unknown: &[&str], problems: &mut Problems) {
    let place = format!("figures.{k}.{}", need.key);
    let of_kind = scene.outputs.iter().filter(|output| output.write.kind() == need.writer);
    let found = of_kind.clone().find(|output| output.write.path() == need.output);
    if let Some(output) = found {
        let lacks = |name: &&str| !output.write.names().iter().any(|other| other == name);
        let lacking: Vec<String> =
            need.names.iter().copied().filter(lacks).map(|name| format!("\"{name}\"")).collect();
        if !lacking.is_empty() && !unknown.contains(&need.output) {
            let lacking = lacking.join(", ");
            let value = format!("`{}`, which does not hold {lacking}", need.output);
            let allowed = format!("a {} with {}", need.writer, need.names.join(", "));
            problems.add(place, value, allowed, format!("add {lacking} to the output `{}`", need.output));
        }
    } else {
        let known: Vec<&str> = of_kind.map(|output| output.write.path()).collect();
        let hint = nearest(need.output, known.iter().copied());
        let value = format!("`{}`, which no {} writes", need.output, need.writer);
        let allowed = match known.as_slice() {
            [] => format!("the path of a {}; add one to the outputs", need.writer),
            _ => format!("the path of a {}: {}", need.writer, known.join(", ")),
        };
        problems.add(place, value, allowed, hint);
    }
}
