//! One sample: compressed without friction, then sheared or compressed with it.

use crate::calibrate::plan::Plan;
use crate::failure::Failure;
use crate::model;
use crate::scene::cell::CellSpec;
use crate::scene::{End, Sample, Scene, Stage};
use crate::scene_file::SceneProblem;
use granular_core::{Dim, Solver};
use granular_dem::{CellControl, Control, Dem};
use std::any::Any;

/// Solid fractions that are tried for the gas at the start, until the grading fits.
const GAS: [f64; 5] = [0.5, 0.4, 0.3, 0.2, 0.1];
/// Longest compression, in strokes of the cell at the rate of this inertial number.
const LONGEST: f64 = 300.0;
/// How near the stress must come to its target at the end of the compression.
const NEAR: f64 = 0.02;
/// Shear strain between two looks.
const LOOK: f64 = 0.005;
/// Looks that a peak is averaged over: a strain of 0.04.
const WINDOW: usize = 8;
/// Compression over stress over modulus, to measure stiffness: springs only, no rearrangement.
const SMALL: f64 = 0.2;
/// Inertial number of that compression.
const GENTLE: f64 = 1e-4;
/// Strokes of the cell for which the packing rests before it: what still moves in it would be taken for stiffness.
const REST: u64 = 20;

/// A steady flow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow {
    pub(crate) normal_stress: f64,
    /// The same less what the motion of the cell took: the one asked for.
    pub(crate) held_stress: f64,
    pub(crate) inertial_number: f64,
    pub(crate) friction: f64,
    pub(crate) solid_fraction: f64,
    pub(crate) peak_friction: f64,
    /// Growth of height over shear strain.
    pub(crate) peak_dilation: f64,
    pub(crate) density: f64,
    pub(crate) diameter: f64,
    pub(crate) contact_friction: f64,
}

/// Elastic constants of a packing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stiffness {
    pub(crate) young: f64,
    pub(crate) poisson: f64,
}

/// A packing with friction at rest under a stress.
struct Packing<D: Dim> {
    dem: Dem<D>,
    dt: f64,
    stress: f64,
    density: f64,
    diameter: f64,
    friction: f64,
}

/// The grains of a scene in a cell of their own, without friction.
fn cell_scene(scene: &Scene, plan: &Plan, seed: u64, solid_fraction: f64) -> Result<Scene, Failure> {
    let graded = match &scene.sample {
        Some(Sample::Column { grading: Some(grading), material, .. }) => Some((grading, material)),
        Some(Sample::Cell { grading, material, .. }) => Some((grading, material)),
        _ => None,
    };
    let Some((grading, material)) = graded else {
        let hint = "only a sample with a grading, Column or Cell, can be drawn again";
        return Err(Failure::Scene(vec![SceneProblem::at_path("sample", "other", "Column or Cell", hint)]));
    };
    let mut materials = scene.materials.clone();
    materials.retain(|name, _| name == material);
    materials.values_mut().for_each(|spec| spec.friction = 0.0);
    let periodic = vec![true; if scene.dimension == crate::scene::Dimension::Plane { 2 } else { 3 }];
    let (name, end) = ("run".to_owned(), End::For(1.0.into()));
    let run = Stage { name, end, of: None, changes: Vec::new(), time_step: None, save: None };
    Ok(Scene {
        gravity: Vec::new(),
        materials,
        sample: Some(Sample::Cell {
            grains: plan.grains,
            solid_fraction,
            grading: *grading,
            material: material.clone(),
            seed,
        }),
        cell: Some(CellSpec { periodic, size: Vec::new(), low: Vec::new() }),
        walls: Vec::new(),
        stages: vec![run],
        outputs: Vec::new(),
        figures: Vec::new(),
        ..scene.clone()
    })
}

/// Builds the gas as dense as the grading allows, compresses it, and gives it its friction.
fn prepare<D: Dim>(scene: &Scene, plan: &Plan, seed: u64, level: f64) -> Result<Packing<D>, Failure> {
    let mut built = Err(Vec::new());
    for solid_fraction in GAS {
        built = model::build(&cell_scene(scene, plan, seed, solid_fraction)?);
        if built.is_ok() {
            break;
        }
    }
    let mut model = built.map_err(Failure::Scene)?;
    let solver: &mut dyn Any = model.simulation.solver_mut();
    let Some(dem) = solver.downcast_mut::<Dem<D>>() else {
        return Err(Failure::Io("calibrate friction: the solver of the scene must be Dem".to_owned()));
    };
    let mut dem = std::mem::replace(dem, empty::<D>()?);
    let count = dem.len() as f64;
    let diameter = dem.grains().map(|(_, grain)| 2.0 * grain.radius).sum::<f64>() / count;
    let material = dem.grains().next().map(|(_, grain)| grain.material);
    let Some(material) = material else {
        return Err(Failure::Io("calibrate friction: no grains".to_owned()));
    };
    let density = dem.materials().get(material).density;
    let stress = level * dem.packing_modulus();
    let dt = model.time_step().unwrap_or_else(|| dem.recommended_step());
    control(&mut dem, CellControl::isotropic::<D>(stress))?;
    // A stroke is the time in which the stress moves a grain by its diameter.
    let stroke = diameter * (density / stress).sqrt();
    let steps = (stroke / dt).ceil() as u64;
    let mut strokes = 0.0;
    while !is_compressed(&dem, stress) {
        if strokes > LONGEST {
            let reason = format!("compression does not come to rest within {LONGEST} strokes");
            return Err(Failure::Stopped { reason, hint: "lower the restitution of the grains".to_owned() });
        }
        advance(&mut dem, dt, steps)?;
        strokes += 1.0;
    }
    let friction = friction_of_grains(scene);
    dem.set_friction(material, friction);
    let dt = model.time_step().unwrap_or_else(|| dem.recommended_step());
    Ok(Packing { dem, dt, stress, density, diameter, friction })
}

/// Friction of the material of the sample.
fn friction_of_grains(scene: &Scene) -> f64 {
    match &scene.sample {
        Some(Sample::Column { material, .. } | Sample::Cell { material, .. }) => {
            scene.materials.get(material).map_or(0.0, |spec| spec.friction)
        }
        _ => 0.0,
    }
}

fn empty<D: Dim>() -> Result<Dem<D>, Failure> {
    let setup = granular_dem::Setup {
        materials: granular_dem::Materials::new(),
        grains: Vec::new(),
        walls: Vec::new(),
        gravity: D::Vec::default(),
        options: granular_dem::Options::default(),
    };
    Dem::new(setup).map_err(|error| Failure::Io(error.to_string()))
}

fn control<D: Dim>(dem: &mut Dem<D>, control: CellControl) -> Result<(), Failure> {
    dem.control_cell(control).map_err(|error| Failure::Io(format!("calibrate friction: {error}")))
}

fn advance<D: Dim>(dem: &mut Dem<D>, dt: f64, steps: u64) -> Result<(), Failure> {
    let hint = "a smaller time_step of the solver, or stiffer grains".to_owned();
    dem.advance(dt, steps).map_err(|error| Failure::Stopped { reason: error.to_string(), hint })
}

/// Whether all normal stresses are near their target and motion holds no part of it.
fn is_compressed<D: Dim>(dem: &Dem<D>, target: f64) -> bool {
    let (Some(stress), Some(volume)) = (dem.cell_stress(), dem.cell().and_then(|cell| cell.volume())) else {
        return false;
    };
    let near = (0..D::N).all(|axis| (stress.at(axis, axis) / target - 1.0).abs() < NEAR);
    near && 2.0 * dem.energies().translational() / volume < 1e-3 * target
}

/// A look at a flow.
struct Look {
    strain: f64,
    height: f64,
    shear: f64,
    normal: f64,
    solid_fraction: f64,
    /// Strain along the upward axis and its rate \[1/s\].
    rise: [f64; 2],
}

/// Shears a fresh sample along x with the gradient along the upward axis.
pub(crate) fn shear<D: Dim>(
    scene: &Scene,
    plan: &Plan,
    seed: u64,
    level: f64,
    inertial_number: f64,
) -> Result<Flow, Failure> {
    let Packing { mut dem, dt, stress, density, diameter, friction: contact_friction } =
        prepare::<D>(scene, plan, seed, level)?;
    let rate = inertial_number / (diameter * (density / stress).sqrt());
    let driven = CellControl::default().with(0, D::UP, Control::Rate(rate)).with(
        D::UP,
        D::UP,
        Control::Stress(stress),
    );
    control(&mut dem, driven)?;
    let steps = (LOOK / (rate * dt)).ceil() as u64;
    let (steady_from, end) = plan.strains(inertial_number);
    let mut looks: Vec<Look> = Vec::new();
    loop {
        advance(&mut dem, dt, steps)?;
        let (Some(stress), Some(cell)) = (dem.cell_stress(), dem.cell()) else { break };
        looks.push(Look {
            strain: cell.strain().at(0, D::UP),
            height: cell.edges().at(D::UP, D::UP),
            shear: -0.5 * (stress.at(0, D::UP) + stress.at(D::UP, 0)),
            normal: stress.at(D::UP, D::UP),
            solid_fraction: dem.solid_fraction().unwrap_or(f64::NAN),
            rise: [cell.strain(), cell.gradient()].map(|matrix| matrix.at(D::UP, D::UP)),
        });
        if cell.strain().at(0, D::UP) >= end {
            break;
        }
    }
    let steady: Vec<&Look> = looks.iter().filter(|look| look.strain > steady_from).collect();
    let mean =
        |value: fn(&Look) -> f64| steady.iter().map(|look| value(look)).sum::<f64>() / steady.len() as f64;
    let normal_stress = mean(|look| look.normal);
    let peak_friction = looks.windows(WINDOW).map(friction_of).fold(f64::NEG_INFINITY, f64::max);
    let peak_dilation = looks.windows(WINDOW).map(dilation_of).fold(f64::NEG_INFINITY, f64::max);
    let taken = dem.cell().map_or(0.0, |cell| taken_by_motion(cell.control(), &steady, rate));
    Ok(Flow {
        normal_stress,
        held_stress: normal_stress - taken,
        inertial_number: rate * diameter * (density / normal_stress).sqrt(),
        friction: mean(|look| look.shear) / normal_stress,
        solid_fraction: mean(|look| look.solid_fraction),
        peak_friction,
        peak_dilation,
        density,
        diameter,
        contact_friction,
    })
}

/// Mean stress that the cell takes to move: by its law, `sigma - target = I L' + eta L` with the rate `L` of its height.
fn taken_by_motion(control: &CellControl, looks: &[&Look], shear_rate: f64) -> f64 {
    let (Some(first), Some(last)) = (looks.first(), looks.last()) else { return f64::NAN };
    let turn = control.response / std::f64::consts::TAU;
    let (inertia, damping) = (control.modulus * turn * turn, 2.0 * control.modulus * turn);
    let [rise, rate] = [0, 1].map(|k| last.rise[k] - first.rise[k]);
    (inertia * rate + damping * rise) * shear_rate / (last.strain - first.strain)
}

fn friction_of(looks: &[Look]) -> f64 {
    looks.iter().map(|look| look.shear).sum::<f64>() / looks.iter().map(|look| look.normal).sum::<f64>()
}

fn dilation_of(looks: &[Look]) -> f64 {
    let (first, last) = (&looks[0], &looks[looks.len() - 1]);
    (last.height / first.height).ln() / (last.strain - first.strain)
}

/// Compresses a fresh sample along the upward axis, held sideways: for an isotropic elastic body
/// `d sigma_up / d strain = E (1 - nu) / ((1 + nu) (1 - 2 nu))` and `d sigma_x / d sigma_up = nu / (1 - nu)`.
pub(crate) fn compress<D: Dim>(
    scene: &Scene,
    plan: &Plan,
    seed: u64,
    level: f64,
) -> Result<Stiffness, Failure> {
    let Packing { mut dem, dt, stress, density, diameter, .. } = prepare::<D>(scene, plan, seed, level)?;
    control(&mut dem, CellControl::default())?;
    let stroke = diameter * (density / stress).sqrt();
    advance(&mut dem, dt, REST * (stroke / dt).ceil() as u64)?;
    let rate = GENTLE / stroke;
    let before = dem.cell_stress().unwrap_or_default();
    control(&mut dem, CellControl::default().with(D::UP, D::UP, Control::Rate(-rate)))?;
    let steps = (SMALL * level / (rate * dt)).ceil() as u64;
    advance(&mut dem, dt, steps)?;
    let after = dem.cell_stress().unwrap_or_default();
    let change = |axis: usize| after.at(axis, axis) - before.at(axis, axis);
    let confined = change(D::UP) / (rate * dt * steps as f64);
    let share = change(0) / change(D::UP);
    let poisson = share / (1.0 + share);
    let young = confined * (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1.0 - poisson);
    Ok(Stiffness { young, poisson })
}
