//! Pushes: grains that get a velocity at the start of a stage.

use crate::problems::{Problems, nearest};
use crate::records::PushRecord;
use crate::scene::push::PushProfileSpec;
use crate::scene::{Change, FigureSpec, Scene};
use granular_core::{Dim, Linear, Vector};
use granular_dem::{Dem, Push, PushProfile, Pushed, Strength};

/// A push, as the scene asks for it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PushAction {
    /// Where to, one number per axis.
    direction: Vec<f64>,
    /// How strong.
    strength: Strength,
    /// How it is spread over the height.
    profile: PushProfile,
}

/// The push that a change asks for. `falls` when grains have a weight at that stage.
pub(super) fn action<D: Dim>(
    path: &str,
    change: &Change,
    (falls, in_cell): (bool, bool),
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
pub(super) fn check_figures(scene: &Scene, problems: &mut Problems) {
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

/// Pushes the grains of a solver; returns what this and the pushes `before` at the same stage did.
pub(super) fn apply<D: Dim>(action: &PushAction, dem: &mut Dem<D>, before: Option<PushRecord>) -> PushRecord {
    let direction = D::Vec::from_slice(&action.direction).expect("axes were counted at build");
    let push = Push { direction, strength: action.strength, profile: action.profile };
    let pushed = dem.apply_push(&push).expect("the values were checked at build");
    record(dem, pushed, before)
}

/// What a push of the grains of a solver did, and those before it.
fn record<D: Dim>(dem: &Dem<D>, pushed: Pushed, before: Option<PushRecord>) -> PushRecord {
    let earlier = before.map_or([0.0; 3], |before| [before.energy, before.momentum, before.speed]);
    PushRecord {
        energy: earlier[0] + pushed.energy,
        momentum: earlier[1] + pushed.momentum,
        speed: earlier[2] + pushed.speed,
        diameter: dem.mean_diameter(),
        mass: dem.mass(),
        gravity: dem.gravity().length(),
        potential: dem.energies().potential,
    }
}

/// What a push will do to the grains of a solver as far as it is known before, as a line of a report.
pub(super) fn described<D: Dim>(action: &PushAction, dem: &Dem<D>) -> String {
    action.text((dem.mass(), dem.gravity().length() * dem.mean_diameter()))
}

impl PushAction {
    /// For grains of this mass and gravity times mean diameter.
    fn text(&self, (mass, scale): (f64, f64)) -> String {
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
            PushProfile::Uniform => "all grains alike",
            PushProfile::Gradient => "most for the lowest grain, nothing for the highest",
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
