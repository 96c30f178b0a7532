//! The periodic cell of a scene: size, sample and control.

use super::materials::NamedMaterials;
use super::sample::{BuiltSample, refuse_many};
use crate::column::grading_of;
use crate::problems::{Problems, nearest};
use crate::scene::cell::{CellChange, CellSpec};
use crate::scene::{Change, GradingSpec, Sample, Scene};
use granular_core::{Dim, Linear, Vector};
use granular_dem::{CellControl, Control, Grain, PeriodicCell};
use granular_packing::scattered;

/// The cell of a scene, if it has one, at rest.
pub(super) fn cell<D: Dim>(
    scene: &Scene,
    sample: Option<&BuiltSample<D>>,
    problems: &mut Problems,
) -> Option<PeriodicCell<D>> {
    let Some(spec) = &scene.cell else {
        refuse_changes(scene, problems);
        return None;
    };
    let low =
        if spec.low.is_empty() { Some(D::Vec::ZERO) } else { problems.vector::<D, _>("cell.low", &spec.low) };
    if spec.periodic.len() != D::N || !spec.periodic.contains(&true) {
        let allowed = format!("{} values, one per axis, at least one of them true", D::N);
        problems.add("cell.periodic", format!("{:?}", spec.periodic), allowed, "");
        return None;
    }
    let size = match (spec.size.is_empty(), &scene.sample) {
        (true, Some(Sample::Cell { .. })) => sample.and_then(|sample| sample.cell),
        (true, _) => {
            problems.add(
                "cell.size",
                "missing",
                "one length per axis",
                "only the sample Cell brings its own",
            );
            None
        }
        (false, Some(Sample::Cell { .. })) => {
            let hint = "the sample Cell chooses it from its solid_fraction";
            problems.add("cell.size", "given", "nothing", hint);
            None
        }
        (false, _) => problems.vector::<D, _>("cell.size", &spec.size),
    }?;
    match PeriodicCell::new(low?, size, &spec.periodic) {
        Ok(cell) => Some(cell),
        Err(error) => {
            problems.add("cell.size", error.value, error.allowed, "");
            None
        }
    }
}

/// A scene without a cell cannot drive one.
fn refuse_changes(scene: &Scene, problems: &mut Problems) {
    if matches!(scene.sample, Some(Sample::Cell { .. })) {
        problems.add(
            "cell",
            "missing",
            "a cell, such as (periodic: [true, true])",
            "the sample Cell fills it",
        );
    }
    for (k, stage) in scene.stages.iter().enumerate() {
        for (c, _) in stage.changes.iter().enumerate().filter(|(_, change)| matches!(change, Change::Cell(_)))
        {
            problems.add(format!("stages.{k}.changes.{c}"), "Cell", "no Cell: the scene has none", "");
        }
    }
}

/// Grains scattered in a cube or square.
pub(super) fn fill<D: Dim>(
    sample: &Sample,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Option<BuiltSample<D>> {
    let Sample::Cell { grains, solid_fraction, grading, material, seed } = sample else { return None };
    let before = problems.0.len();
    let material = materials.find("sample.material", material, problems);
    if !(*solid_fraction > 0.0 && *solid_fraction < 1.0) {
        problems.add("sample.solid_fraction", solid_fraction, "above 0 and below 1", "");
    }
    if *grains == 0 {
        problems.add("sample.grains", grains, "at least one grain", "");
    }
    if let Err(allowed) = refuse_many::<D>(*grains as f64) {
        problems.add("sample.grains", grains, allowed, "");
    }
    if problems.0.len() > before {
        return None;
    }
    match scatter::<D>(*grains, *solid_fraction, grading, *seed) {
        Ok((radii, places, size)) => {
            let material = material?;
            let pairs = places.into_iter().zip(radii);
            let grains = pairs.map(|(place, radius)| Grain::at(place, radius, material)).collect();
            Some(BuiltSample { grains, column: None, cell: Some(size) })
        }
        Err((path, value, allowed)) => {
            problems.add(path, value, allowed, "");
            None
        }
    }
}

type Scattered<D> = (Vec<f64>, Vec<<D as Dim>::Vec>, <D as Dim>::Vec);

/// Radii, places and size of the cell.
pub(super) fn scatter<D: Dim>(
    count: usize,
    solid_fraction: f64,
    grading: &GradingSpec,
    seed: u64,
) -> Result<Scattered<D>, (&'static str, String, String)> {
    let radii = grading_of(grading).sample::<D>(count, seed).map_err(|error| {
        ("sample.grading", format!("a grading whose {} is {}", error.what, error.value), error.allowed)
    })?;
    let volume: f64 = radii.iter().map(|&radius| D::ball_volume(radius)).sum();
    let side = (volume / solid_fraction).powf(1.0 / D::N as f64);
    let size = D::Vec::splat(side);
    let places = scattered::<D>(&radii, size, seed).map_err(|error| {
        let allowed = "a lower one: grains must not overlap at the start".to_owned();
        ("sample.solid_fraction", format!("{solid_fraction}, for which {error}"), allowed)
    })?;
    Ok((radii, places, size))
}

/// The control that a change asks for.
pub(super) fn control<D: Dim>(
    path: &str,
    change: &CellChange,
    spec: Option<&CellSpec>,
    problems: &mut Problems,
) -> Option<CellControl> {
    let before = problems.0.len();
    let mut control = CellControl::default();
    let rates = change.rate.iter().map(|(name, rate)| ("rate", name, Control::Rate(rate.value())));
    let stresses =
        change.stress.iter().map(|(name, stress)| ("stress", name, Control::Stress(stress.value())));
    for (key, name, choice) in rates.chain(stresses) {
        let at = format!("{path}.{key}.{name}");
        match component::<D>(name, &spec?.periodic) {
            Ok((row, column)) => {
                if key == "stress" && change.rate.contains_key(name) {
                    problems.add(at, "given as a rate too", "a rate or a stress", "");
                }
                control = control.with(row, column, choice);
            }
            Err((allowed, hint)) => problems.add(at, format!("`{name}`"), allowed, hint),
        }
    }
    if !change.stress.is_empty() && !spec?.periodic.iter().all(|&is| is) {
        let hint = "a cell with an open axis has no volume and no stress";
        problems.add(format!("{path}.stress"), "given", "nothing unless all axes are periodic", hint);
    }
    if let Some(response) = change.response {
        if response.value() <= 0.0 {
            problems.add(format!("{path}.response"), response, "a positive time", "");
        }
        control.response = response.value();
    }
    (problems.0.len() == before).then_some(control)
}

/// Row and column of a component such as `xy`.
fn component<D: Dim>(name: &str, periodic: &[bool]) -> Result<(usize, usize), (String, String)> {
    let is_periodic = |axis: &usize| periodic.get(*axis).copied().unwrap_or(false);
    let axes: Vec<usize> = (0..D::N).filter(is_periodic).collect();
    let name_of = |i: usize, j: usize| format!("{}{}", D::AXES[i], D::AXES[j]);
    let all: Vec<(usize, usize)> = axes.iter().flat_map(|&i| axes.iter().map(move |&j| (i, j))).collect();
    let found = all.iter().copied().find(|&(i, j)| name_of(i, j) == name);
    found.ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|&(i, j)| name_of(i, j)).collect();
        (format!("periodic axes: {}", names.join(", ")), nearest(name, names.iter().map(String::as_str)))
    })
}
