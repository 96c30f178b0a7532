//! Bodies of a continuum: outlines filled with particles.

use super::materials;
use crate::column::{ColumnSize, Outline, check_grading, grading_of, volume};
use crate::machine::room_for;
use crate::problems::{Problems, nearest, quoted};
use crate::scene::{BodySpec, Extent, Sample, Scene};
use crate::solids::solid;
use granular_constitutive::AnyLaw;
use granular_constitutive::spec::ConstitutiveLawSpec;
use granular_core::{Dim, Linear, SymmetricTensor, Vector};
use granular_mpm::Particle;
use granular_mpm::spec::MpmSpec;

/// Memory that a particle takes from its placing to the end of a run \[bytes\]: plane and space.
const BYTES_PER_PARTICLE: [f64; 2] = [600.0, 900.0];
/// Grains that stand for a sample of many more, when the width is found that they fill.
const MOST_DRAWN: usize = 1_000_000;

/// A body before it is in a solver.
pub(super) struct BuiltBody<D: Dim> {
    /// Name of the continuum.
    pub(super) material: String,
    /// Its law as the scene or a calibration says it.
    pub(super) said: ConstitutiveLawSpec,
    pub(super) law: AnyLaw,
    /// Density at the start \[kg/m^3\].
    pub(super) density: f64,
    pub(super) particles: Vec<Particle<D>>,
}

/// The bodies of a scene, and the size of the column if they are one.
pub(super) struct BuiltSample<D: Dim> {
    pub(super) bodies: Vec<BuiltBody<D>>,
    pub(super) column: Option<ColumnSize>,
}

impl<D: Dim> BuiltSample<D> {
    /// Mass \[kg\].
    pub(super) fn mass(&self) -> f64 {
        let mass = |body: &BuiltBody<D>| body.density * body.particles.iter().map(|p| p.volume).sum::<f64>();
        self.bodies.iter().map(mass).sum()
    }

    /// Highest middle of a particle \[m\].
    pub(super) fn top(&self) -> f64 {
        let all = self.bodies.iter().flat_map(|body| &body.particles);
        all.map(|particle| particle.position.component(D::UP)).fold(0.0, f64::max)
    }
}

/// Fills the sample of a scene with particles.
pub(super) fn bodies<D: Dim>(
    scene: &Scene,
    name: &str,
    spec: &MpmSpec,
    problems: &mut Problems,
) -> Option<BuiltSample<D>> {
    let edge = edge::<D>(name, spec, problems)?;
    match scene.sample.as_ref() {
        Some(sample @ (Sample::Column { material, .. } | Sample::Cylinder { material, .. })) => {
            let outline = Outline::of::<D>(sample, problems);
            let continuum = continuum::<D>(scene, "sample.material", material, outline.as_ref(), problems);
            let outline = outline?;
            let size = outline.size::<D>(width_of::<D>(sample, &outline, problems)?);
            let (said, law, density) = continuum?;
            check_cell(name, spec, size.width.min(size.height), problems)?;
            let particles = column::<D>(size, edge, problems)?;
            Some(BuiltSample {
                bodies: vec![BuiltBody { material: material.clone(), said, law, density, particles }],
                column: Some(size),
            })
        }
        Some(Sample::Bodies(list)) => {
            if list.is_empty() {
                problems.add("sample", "no bodies", "at least one body", "");
            }
            let body = |(k, spec): (usize, &BodySpec)| one::<D>(k, spec, edge, scene, problems);
            let bodies: Vec<_> = list.iter().enumerate().map(body).collect();
            let bodies: Vec<_> = bodies.into_iter().collect::<Option<_>>()?;
            (!bodies.is_empty()).then_some(BuiltSample { bodies, column: None })
        }
        other => {
            let value = if other.is_some() { "grains one by one" } else { "missing" };
            problems.add("sample", value, "what a continuum fills: a Column, a Cylinder or Bodies", "");
            None
        }
    }
}

/// Edge of the square or cube of a particle \[m\].
fn edge<D: Dim>(name: &str, spec: &MpmSpec, problems: &mut Problems) -> Option<f64> {
    let cell = spec.cell.value();
    if cell <= 0.0 {
        problems.add(format!("solvers.{name}.cell"), spec.cell, "a positive length", "");
        return None;
    }
    let along = spec.particles_along_edge(D::N);
    if along.is_none() {
        let allowed = if D::N == 2 { "a square number: 4, 9, 16, 25, .." } else { "a cube: 8, 27, 64, .." };
        problems.add(format!("solvers.{name}.particles_per_cell"), spec.particles_per_cell, allowed, "");
    }
    Some(cell / along? as f64)
}

/// Whether a cell is smaller than the sample \[m\].
fn check_cell(name: &str, spec: &MpmSpec, sample: f64, problems: &mut Problems) -> Option<()> {
    if spec.cell.value() <= sample {
        return Some(());
    }
    let allowed = format!("smaller than the sample, which is {sample:.4e} m across");
    problems.add(format!("solvers.{name}.cell"), spec.cell, allowed, "ten cells across resolve a shear band");
    None
}

/// The law of a material as it is said and built, and its density, or what is wrong with them.
fn continuum<D: Dim>(
    scene: &Scene,
    path: &str,
    material: &str,
    outline: Option<&Outline>,
    problems: &mut Problems,
) -> Option<(ConstitutiveLawSpec, AnyLaw, f64)> {
    let Some(spec) = scene.continua.get(material) else {
        let known: Vec<&str> = scene.continua.keys().map(String::as_str).collect();
        let hint = nearest(material, known.iter().copied());
        let allowed = match known.as_slice() {
            [] => {
                "a law under this name in `continua`, such as (density: .., law: MohrCoulomb(..))".to_owned()
            }
            _ => format!("one of `continua`: {}", known.join(", ")),
        };
        problems.add(path, format!("`{material}`, for which there is no law of a continuum"), allowed, hint);
        return None;
    };
    let place = format!("continua.{}", quoted(material));
    // Grains fill a share of the outline.
    let of_grains = || Some(materials::density_of_grains(scene, material)? * outline?.solid::<D>());
    let density = match spec.density.map(|density| density.value()).or_else(of_grains) {
        Some(density) if density > 0.0 => density,
        Some(density) => {
            problems.add(format!("{place}.density"), density, "a positive density", "");
            return None;
        }
        None => {
            let hint = "that of the bulk; where the sample is of grains it follows from theirs";
            problems.add(format!("{place}.density"), "missing", "a positive density", hint);
            return None;
        }
    };
    let files = (&*scene.folder, Some(scene.dimension));
    let said = spec.law(files, &format!("{place}."), problems)?;
    let law = materials::law(&said, density, &format!("{place}.law"), problems)?;
    Some((said, law, density))
}

/// Width of a column \[m\]: as given, or as its grains fill.
fn width_of<D: Dim>(sample: &Sample, outline: &Outline, problems: &mut Problems) -> Option<f64> {
    if let Some(width) = outline.given_width() {
        return Some(width);
    }
    let (Sample::Column { grading, .. } | Sample::Cylinder { grading, .. }) = sample else { return None };
    let (Extent::Grains(count), Some(grading)) = (outline.extent, grading) else {
        let hint = "or give the width: extent: Width(\"0.1 m\")";
        problems.add(
            "sample.grading",
            "missing",
            "sizes of the grains, when their number says how wide it is",
            hint,
        );
        return None;
    };
    let before = problems.0.len();
    check_grading(grading, problems);
    if problems.0.len() > before {
        return None;
    }
    let drawn = count.min(MOST_DRAWN);
    let radii = grading_of(grading).sample::<D>(drawn, outline.seed).map_err(|error| {
        problems.add("sample.grading", format!("{} is {}", error.what, error.value), error.allowed, "");
    });
    Some(outline.width_for::<D>(volume::<D>(&radii.ok()?) * count as f64 / drawn as f64))
}

/// Particles of a column or cylinder.
fn column<D: Dim>(size: ColumnSize, edge: f64, problems: &mut Problems) -> Option<Vec<Particle<D>>> {
    let up = D::Vec::along(D::UP, size.height);
    let (low, high) = match size.round {
        None => (D::Vec::ZERO, D::Vec::along(0, size.width) + depth::<D>(size.depth) + up),
        Some(round) => {
            let behind = if round == crate::column::Round::Half { 0.0 } else { -size.width };
            let low = D::Vec::along(0, -size.width) + depth::<D>(Some(behind));
            (low, D::Vec::along(0, size.width) + depth::<D>(Some(size.width)) + up)
        }
    };
    room::<D>("sample.extent", (low, high), edge, problems)?;
    let inside = |at: D::Vec| {
        let flat = at - D::Vec::along(D::UP, at.component(D::UP));
        size.round.is_none() || flat.length() < size.width
    };
    Some(Particle::filling_part(low, high, edge, inside))
}

fn depth<D: Dim>(depth: Option<f64>) -> D::Vec {
    depth.map_or(D::Vec::ZERO, |depth| D::Vec::along(1, depth))
}

/// Refuses more particles than memory holds.
fn room<D: Dim>(path: &str, (low, high): (D::Vec, D::Vec), edge: f64, problems: &mut Problems) -> Option<()> {
    let count: f64 = (0..D::N).map(|axis| ((high - low).component(axis) / edge).max(1.0)).product();
    if let Err(allowed) = room_for(count, BYTES_PER_PARTICLE[D::N - 2]) {
        let hint = "larger cells or fewer particles in each make fewer";
        problems.add(path, format!("{count:.3e} particles"), allowed, hint);
        return None;
    }
    Some(())
}

/// A body by its outline; its particles lie where those of a full grid would.
fn one<D: Dim>(
    index: usize,
    spec: &BodySpec,
    edge: f64,
    scene: &Scene,
    problems: &mut Problems,
) -> Option<BuiltBody<D>> {
    let path = format!("sample.Bodies.{index}");
    let shape = solid::<D>(&format!("{path}.shape"), &spec.shape, problems);
    let velocity = if spec.velocity.is_empty() {
        Some(D::Vec::ZERO)
    } else {
        problems.vector::<D, _>(&format!("{path}.velocity"), &spec.velocity)
    };
    let (said, law, density) =
        continuum::<D>(scene, &format!("{path}.material"), &spec.material, None, problems)?;
    let (shape, velocity) = (shape?, velocity?);
    let (low, high) = shape.bounds();
    if !(low.is_finite() && high.is_finite()) {
        problems.add(format!("{path}.shape"), "a body without end", "a shape with an end", "");
        return None;
    }
    // Corners of the lattice of all particles, so that bodies that touch do not overlap.
    let snapped =
        |at: D::Vec, round: fn(f64) -> f64| D::Vec::from_fn(|k| round(at.component(k) / edge) * edge);
    let (low, high) = (snapped(low, |x| (x + 1e-6).floor()), snapped(high, |x| (x - 1e-6).ceil()));
    room::<D>(&format!("{path}.shape"), (low, high), edge, problems)?;
    // What lies on a face that two bodies share belongs to one of them, whatever round-off says.
    let nudge = D::Vec::from_fn(|axis| edge * [1e-7, 1.3e-7, 1.7e-7][axis]);
    let particles = Particle::filling_part(low, high, edge, |at| shape.contains(at + nudge));
    if particles.is_empty() {
        let value = format!("a body in which no particle fits: they are {edge:.3e} m apart");
        problems.add(format!("{path}.shape"), value, "a larger body, or smaller cells", "");
        return None;
    }
    let particles = particles.into_iter().map(|particle| particle.moving(velocity)).collect();
    Some(BuiltBody { material: spec.material.clone(), said, law, density, particles })
}

/// Stress at rest: the weight of what is above the same place, and that times a ratio to the sides.
pub(super) fn put_at_rest<D: Dim>(body: &mut BuiltBody<D>, weight: f64, ratio: f64, edge: f64) {
    use std::collections::BTreeMap;
    let foot = |particle: &Particle<D>| -> [i64; 3] {
        std::array::from_fn(|k| {
            let along = if k < D::N && k != D::UP { particle.position.component(k) } else { 0.0 };
            (along / edge).floor() as i64
        })
    };
    let mut tops: BTreeMap<[i64; 3], f64> = BTreeMap::new();
    for particle in &body.particles {
        let top = tops.entry(foot(particle)).or_insert(f64::NEG_INFINITY);
        *top = top.max(particle.position.component(D::UP) + 0.5 * edge);
    }
    for particle in &mut body.particles {
        let below = tops[&foot(particle)] - particle.position.component(D::UP);
        let (vertical, beside) = (-body.density * weight * below, -ratio * body.density * weight * below);
        let (yy, zz) = if D::UP == 1 { (vertical, beside) } else { (beside, vertical) };
        particle.stress = SymmetricTensor { xx: beside, yy, zz, ..SymmetricTensor::ZERO };
    }
}
