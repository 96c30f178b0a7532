//! How stages began and ended, for `run.json` and figures.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What was a stage and how it began and ended, as one solver saw it.
#[derive(Clone, Debug, PartialEq)]
pub struct StageRecord {
    /// Name.
    pub name: String,
    /// Simulated time at its start \[s\].
    pub start: f64,
    /// Front of the main mass of grains at its start \[m\]; not a number without grains.
    pub front: f64,
    /// Height of the main mass of grains at its start \[m\]; not a number without grains.
    pub height: f64,
    /// What pushes at its start did; none without any.
    pub push: Option<PushRecord>,
}

/// A stage as it stands in `run.json`: what all solvers share, and what each saw, by its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedStage {
    /// Name.
    pub name: String,
    /// Simulated time at its start \[s\].
    pub start: f64,
    /// Simulated time at its end \[s\]; absent while it is under way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<f64>,
    /// Step \[s\].
    pub dt: f64,
    /// Why it ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ended: Option<String>,
    /// What each solver saw at its start.
    pub solvers: BTreeMap<String, Seen>,
}

/// What a solver saw at the start of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Front of the main mass of grains \[m\]; not a number without grains.
    #[serde(default = "unknown", skip_serializing_if = "is_unknown", with = "crate::json::number")]
    pub front: f64,
    /// Height of the main mass of grains \[m\]; not a number without grains.
    #[serde(default = "unknown", skip_serializing_if = "is_unknown", with = "crate::json::number")]
    pub height: f64,
    /// What pushes did; absent without any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub push: Option<PushRecord>,
}

impl RecordedStage {
    /// The stage as a solver saw it.
    pub fn of(&self, solver: &str) -> StageRecord {
        let seen = self.solvers.get(solver);
        let nothing = Seen { front: f64::NAN, height: f64::NAN, push: None };
        let Seen { front, height, push } = seen.copied().unwrap_or(nothing);
        StageRecord { name: self.name.clone(), start: self.start, front, height, push }
    }
}

fn unknown() -> f64 {
    f64::NAN
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_unknown(value: &f64) -> bool {
    value.is_nan()
}

/// What the pushes at the start of a stage did, and the units in which impacts are measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PushRecord {
    /// Kinetic energy given \[J; J/m in the plane\].
    #[serde(with = "crate::json::number")]
    pub energy: f64,
    /// Momentum given along the direction \[kg m/s; kg/s in the plane\].
    #[serde(with = "crate::json::number")]
    pub momentum: f64,
    /// Velocity given to the grains that were moved fastest \[m/s\].
    #[serde(with = "crate::json::number")]
    pub speed: f64,
    /// Mean diameter of the grains \[m\].
    #[serde(with = "crate::json::number")]
    pub diameter: f64,
    /// Mass of all grains \[kg; kg/m in the plane\].
    #[serde(with = "crate::json::number")]
    pub mass: f64,
    /// Gravity \[m/s^2\].
    #[serde(with = "crate::json::number")]
    pub gravity: f64,
    /// Potential energy of the grains above the origin \[J; J/m in the plane\].
    #[serde(with = "crate::json::number")]
    pub potential: f64,
}
