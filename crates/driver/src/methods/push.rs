//! Pushes: grains or a continuum that get a velocity at the start of a stage.

use crate::problems::{Problems, nearest};
use crate::records::PushRecord;
use crate::scene::push::PushProfileSpec;
use crate::scene::{Change, FigureSpec, Scene};
use granular_core::push::{Push, PushProfile, Strength};
use granular_core::{Dim, Linear, Vector};

/// A push, as the scene asks for it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PushAction {
    /// Where to, one number per axis.
    direction: Vec<f64>,
    /// How strong.
    strength: Strength,
    /// How it is spread over the height.
    profile: PushProfile,
}

/// What is pushed, as far as records and reports need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Target {
    /// Mass \[kg; kg/m in the plane\].
    pub(crate) mass: f64,
    /// Magnitude of gravity \[m/s^2\].
    pub(crate) gravity: f64,
    /// Mean diameter of its grains \[m\]; the edge of a cell for a continuum whose grains nobody names.
    pub(crate) diameter: f64,
    /// Potential energy \[J\].
    pub(crate) potential: f64,
}

/// What a push gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Given {
    /// Kinetic energy \[J; J/m in the plane\].
    pub(crate) energy: f64,
    /// Momentum along the direction \[kg m/s; kg/s in the plane\].
    pub(crate) momentum: f64,
    /// Velocity of what it moves fastest \[m/s\].
    pub(crate) speed: f64,
}

/// What is there to be pushed at a stage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pushable {
    /// It has a weight.
    pub(crate) falls: bool,
    /// It is in a periodic cell.
    pub(crate) in_cell: bool,
    /// Its grains have a diameter.
    pub(crate) knows_grains: bool,
}

/// The push that a change asks for.
pub(crate) fn action<D: Dim>(
    path: &str,
    change: &Change,
    Pushable { falls, in_cell, knows_grains }: Pushable,
    problems: &mut Problems,
) -> Option<PushAction> {
    let Change::Push { direction, speed, energy, energy_per_grain, profile, .. } = change else {
        return None;
    };
    if in_cell {
        let hint = "what goes out at one face of a cell comes in at the other, so that it has no front";
        problems.add(path, "Push", "a scene without a cell", hint);
    }
    let given = [
        speed.map(|speed| Strength::Speed(speed.value())),
        energy.map(|energy| Strength::Energy(energy.value())),
        energy_per_grain.map(Strength::EnergyPerGrain),
    ];
    let given: Vec<Strength> = given.into_iter().flatten().collect();
    let &[strength] = given.as_slice() else {
        let allowed = "one of `speed`, `energy` and `energy_per_grain`";
        problems.add(path, format!("{} of them", given.len()), allowed, "such as Push(speed: \"1 m/s\")");
        return None;
    };
    let negative = |key: &str, value: f64, problems: &mut Problems| {
        if value < 0.0 {
            let hint = "a push against the direction: turn `direction` round";
            problems.add(format!("{path}.{key}"), value, "0 or more", hint);
        }
    };
    match strength {
        Strength::Speed(_) => {}
        Strength::Energy(energy) => negative("energy", energy, problems),
        Strength::EnergyPerGrain(energy) => {
            negative("energy_per_grain", energy, problems);
            if !knows_grains {
                let hint = "or give the sample a grading, and its material the density of the grains";
                let value = "given, of grains that nobody names";
                problems.add(format!("{path}.energy_per_grain"), value, "`energy` or `speed`", hint);
            }
            if !falls {
                let hint = "without gravity state `energy` or `speed`";
                problems.add(
                    format!("{path}.energy_per_grain"),
                    energy,
                    "a stage with gravity, which is in its unit",
                    hint,
                );
            }
        }
    }
    let along_x: Vec<f64> = (0..D::N).map(|axis| if axis == 0 { 1.0 } else { 0.0 }).collect();
    let direction = if direction.is_empty() { along_x } else { direction.clone() };
    let length = D::Vec::from_slice(&direction).map(Linear::length);
    if !length.is_some_and(|length| length > 0.0) {
        let allowed = format!("{} numbers, one per axis, not all zero", D::N);
        problems.add(format!("{path}.direction"), format!("{direction:?}"), allowed, "");
        return None;
    }
    Some(PushAction { direction, strength, profile: (*profile).into() })
}

/// Checks that figures of an impact are of stages that push.
pub(crate) fn check_figures(scene: &Scene, problems: &mut Problems) {
    let pushes = |change: &Change| matches!(change, Change::Push { .. });
    let pushing = scene.stages.iter().filter(|stage| stage.changes.iter().any(pushes));
    let known: Vec<&str> = pushing.map(|stage| stage.name.as_str()).collect();
    for (k, figure) in scene.figures.iter().enumerate() {
        let FigureSpec::Impact { stage, transient, .. } = figure else { continue };
        if *transient < 0.0 {
            problems.add(format!("figures.{k}.transient"), transient, "0 or more", "");
        }
        let exists = scene.stages.iter().any(|other| other.name == *stage);
        if exists && !known.contains(&stage.as_str()) {
            let allowed = match known.as_slice() {
                [] => "a stage with a Push; add one to its `changes`".to_owned(),
                _ => format!("a stage with a Push: {}", known.join(", ")),
            };
            let hint = nearest(stage, known.iter().copied());
            problems.add(
                format!("figures.{k}.stage"),
                format!("`{stage}`, which pushes nothing"),
                allowed,
                hint,
            );
        }
    }
}

impl PushRecord {
    /// Of a push and the pushes `before` at the same stage.
    pub(crate) fn of(target: Target, given: Given, before: Option<Self>) -> Self {
        let earlier = before.map_or([0.0; 3], |before| [before.energy, before.momentum, before.speed]);
        let Target { mass, gravity, diameter, potential } = target;
        Self {
            energy: earlier[0] + given.energy,
            momentum: earlier[1] + given.momentum,
            speed: earlier[2] + given.speed,
            diameter,
            mass,
            gravity,
            potential,
        }
    }
}

impl PushAction {
    /// As the solver takes it. An energy per grain is handed on, or made one of all where the solver has no grains.
    pub(crate) fn push<D: Dim>(&self, target: Target, has_grains: bool) -> Push<D> {
        let direction = D::Vec::from_slice(&self.direction).expect("axes were counted at build");
        let strength = match self.strength {
            Strength::EnergyPerGrain(units) if !has_grains => {
                Strength::Energy(units * target.mass * target.gravity * target.diameter)
            }
            strength => strength,
        };
        Push { direction, strength, profile: self.profile }
    }

    /// What it will do as far as it is known before, as a line of a report.
    pub(crate) fn described(&self, target: Target) -> String {
        let (mass, scale) = (target.mass, target.gravity * target.diameter);
        let of_energy = |energy: f64| {
            let [unit, speed] = [energy / (mass * scale), (2.0 * energy / mass).sqrt()];
            format!(
                "{energy:.4} J in all, {unit:.4} m g d per grain, root mean square velocity {speed:.4} m/s"
            )
        };
        let strength = match (self.strength, self.profile) {
            (Strength::Speed(speed), PushProfile::Uniform) => {
                format!("{speed} m/s, {}", of_energy(0.5 * mass * speed * speed))
            }
            // The energy depends on how the grains lie then.
            (Strength::Speed(speed), PushProfile::Gradient) => format!("{speed} m/s at most"),
            (Strength::Energy(energy), _) => of_energy(energy),
            (Strength::EnergyPerGrain(units), _) => of_energy(units * mass * scale),
        };
        let spread = match self.profile {
            PushProfile::Uniform => "everything alike",
            PushProfile::Gradient => "most at the bottom, nothing at the top",
        };
        format!("a push along {:?}: {strength}; {spread}", self.direction)
    }
}

impl From<PushProfileSpec> for PushProfile {
    fn from(spec: PushProfileSpec) -> Self {
        match spec {
            PushProfileSpec::Uniform => Self::Uniform,
            PushProfileSpec::Gradient => Self::Gradient,
        }
    }
}
