//! Where a solver fails, beside where it says that it will.
//!
//! Each sweep makes a flow that starts at full speed, or a sample of grains, more hostile, value by value, until a run no longer finishes, and
//! closes in on the limit by bisection. The prediction is the solver's own report of
//! [limits](granular_core::Solver::limits); it is one of the values tried. Two things must hold, or the study fails:
//!
//! - every blow-up is noticed by the guard of the solver, and named, within ten steps of the first field that makes no
//!   sense;
//! - a run that keeps all bounds finishes.
//!
//! ```
//! use granular_studies::validate::stability::{Request, lbm, verdict};
//! use granular_studies::validate::Effort;
//! let rows = lbm(&Request { effort: Effort::Quick, operators: vec!["regularised".to_owned()], flows: vec!["cavity".to_owned()] })?;
//! verdict(&rows)?;
//! # Ok::<(), granular_driver::failure::Failure>(())
//! ```

mod dem;
mod flows;
mod judge;
mod search;
mod show;
mod watch;

pub use dem::dem;
pub use show::table;

use super::Effort;
use flows::{Geometry, Start, State};
use granular_core::{Limits, Solver};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_lbm::Operator;
use judge::Swept;
use search::{Found, Range};
use serde::Serialize;
use watch::watch;

/// Collision operators by name.
pub const OPERATORS: [(&str, Operator); 5] = [
    ("single", Operator::SingleRelaxation),
    ("two", Operator::TwoRelaxation { magic: 3.0 / 16.0 }),
    ("multiple", Operator::EXACT_WALLS),
    ("kumar", Operator::KUMAR),
    ("regularised", Operator::Regularised),
];

/// Flows by name: two shear layers in a periodic box, a cavity under a lid, and a jet that enters through a velocity
/// face and leaves at given pressure, with faces after Zou and He and with regularised ones.
pub const FLOWS: [&str; 4] = ["shear-layer", "cavity", "jet", "regularised-jet"];

/// Constant of the Smagorinsky closure where it is on.
pub const SMAGORINSKY: f64 = 0.1;
/// Mach number of the sweeps over relaxation time and over the grid Reynolds number.
const MACH: [f64; 2] = [0.05, 0.17];

/// What to study.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// How fine.
    pub effort: Effort,
    /// Names among [`OPERATORS`]; all when empty.
    pub operators: Vec<String>,
    /// Names among [`FLOWS`]; all when empty.
    pub flows: Vec<String>,
}

/// What lies beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Nothing: the sweep finished at its hostile end.
    Finished,
    /// The check refuses what is beyond the predicted limit, before the run would fail.
    Refused,
    /// The guard stops the run.
    Stopped,
}

/// One limit: predicted and observed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Flow and scheme.
    pub case: String,
    /// What was swept, and what was held.
    pub parameter: &'static str,
    /// The limit that the solver reports; none where it knows of none.
    pub predicted_limit: Option<f64>,
    /// Most hostile value that finished, whatever the check says of it; none when nothing did.
    pub observed_limit: Option<f64>,
    /// What lies beyond.
    pub outcome: Outcome,
    /// Why.
    pub reason: String,
    /// What makes the study fail: a guard that was silent, or a failure within the bounds.
    #[serde(skip)]
    pub fault: Option<String>,
}

/// What is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Parameter {
    /// Down to 1/2 + 1e-4.
    SmallTau,
    /// Up to 5.
    LargeTau,
    /// Up to 1, with the least viscosity that the solver allows.
    Mach,
    /// Up to 1000.
    GridReynolds,
}

impl Parameter {
    const ALL: [Self; 4] = [Self::SmallTau, Self::LargeTau, Self::Mach, Self::GridReynolds];

    fn name(self) -> &'static str {
        match self {
            Self::SmallTau => "smallest relaxation time, Mach 0.05",
            Self::LargeTau => "largest relaxation time, Mach 0.05",
            Self::Mach => "Mach number, least viscosity allowed",
            Self::GridReynolds => "grid Reynolds number, Mach 0.17",
        }
    }

    /// Values from mild to hostile: of relaxation time, what is over 1/2.
    fn range(self) -> [f64; 2] {
        match self {
            Self::SmallTau => [0.1, 1e-4],
            Self::LargeTau => [0.5, 4.5],
            Self::Mach => [0.04, 1.0],
            Self::GridReynolds => [2.0, 1000.0],
        }
    }

    /// Speed and viscosity at a value.
    fn state(self, value: f64, bounds: &Bounds) -> State {
        let speed = |mach: f64| mach / 3.0_f64.sqrt();
        match self {
            Self::SmallTau | Self::LargeTau => State { speed: speed(MACH[0]), viscosity: value / 3.0 },
            Self::Mach => State { speed: speed(value), viscosity: bounds.least_viscosity(speed(value)) },
            Self::GridReynolds => State { speed: speed(MACH[1]), viscosity: speed(MACH[1]) / value },
        }
    }

    /// The limit that the bounds predict.
    fn predicted(self, bounds: &Bounds) -> Option<f64> {
        let least = |mach: f64| bounds.least_viscosity(mach / 3.0_f64.sqrt());
        match self {
            Self::SmallTau => Some(3.0 * least(MACH[0])),
            Self::LargeTau => None,
            Self::Mach => Some(bounds.mach),
            Self::GridReynolds => Some(MACH[1] / 3.0_f64.sqrt() / least(MACH[1])),
        }
    }

    /// A value as it is printed.
    fn shown(self, value: f64) -> f64 {
        match self {
            Self::SmallTau | Self::LargeTau => 0.5 + value,
            _ => value,
        }
    }
}

/// Bounds that the solver reports.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    mach: f64,
    /// Whether the check refuses a larger Mach number.
    refuses: bool,
    reynolds: f64,
    /// Grid Reynolds number of sound, where it is bounded.
    sound: f64,
}

impl Bounds {
    fn of(lbm: &impl Solver) -> Result<Self, Failure> {
        let mut limits = Limits::default();
        lbm.limits(&mut limits);
        let named = |name: &str| limits.bounds.iter().find(|bound| bound.name == name);
        match (named("Mach number"), named("grid Reynolds number")) {
            (Some(mach), Some(reynolds)) => Ok(Self {
                mach: mach.allowed,
                refuses: mach.refuses,
                reynolds: reynolds.allowed,
                sound: named("grid Reynolds number of sound").map_or(f64::INFINITY, |bound| bound.allowed),
            }),
            _ => Err(Failure::Invalid("the solver reports no Mach or grid Reynolds number".to_owned())),
        }
    }

    /// Least viscosity at a speed, in units of the lattice.
    fn least_viscosity(&self, speed: f64) -> f64 {
        (speed / self.reynolds).max(1.0 / (3.0_f64.sqrt() * self.sound))
    }
}

/// How fine a study is.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    side: usize,
    /// Times that the flow crosses its domain.
    crossings: f64,
    ladder: f64,
    factor: f64,
}

impl Fineness {
    fn of(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self { side: 24, crossings: 6.0, ladder: 2.5, factor: 1.2 },
            Effort::Full => Self { side: 32, crossings: 10.0, ladder: 2.0, factor: 1.08 },
        }
    }
}

/// One sweep.
#[derive(Clone, Debug)]
struct Sweep {
    case: String,
    start: Start,
    parameter: Parameter,
    fineness: Fineness,
}

/// Sweeps the lattice Boltzmann method.
///
/// # Errors
/// When no operator or flow has such a name, or a flow cannot be set up.
pub fn lbm(request: &Request) -> Result<Vec<Row>, Failure> {
    let fineness = Fineness::of(request.effort);
    check_names("operator", &request.operators, &OPERATORS.map(|(name, _)| name))?;
    check_names("flow", &request.flows, &FLOWS)?;
    let is_wanted = |name: &str, wanted: &[String]| wanted.is_empty() || wanted.iter().any(|n| n == name);
    let mut sweeps = Vec::new();
    for geometry in Geometry::ALL.into_iter().filter(|g| is_wanted(g.name(), &request.flows)) {
        for (name, operator) in OPERATORS.into_iter().filter(|(n, _)| is_wanted(n, &request.operators)) {
            for smagorinsky in [None, Some(SMAGORINSKY)] {
                let start = Start { geometry, operator, smagorinsky, side: fineness.side };
                let closure = if smagorinsky.is_some() { " with closure" } else { "" };
                let case = format!("{}: {name}{closure}", geometry.name());
                let of = |parameter| Sweep { case: case.clone(), start, parameter, fineness };
                sweeps.extend(Parameter::ALL.map(of));
            }
        }
    }
    parallel::each(&sweeps, Sweep::run)
}

fn check_names(what: &str, names: &[String], known: &[&str]) -> Result<(), Failure> {
    match names.iter().find(|name| !known.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => Err(Failure::Io(format!("no {what} is called `{name}`; known: {}", known.join(", ")))),
    }
}

impl Sweep {
    /// What the solver allows; the same at any speed and viscosity.
    fn bounds(&self) -> Result<Bounds, Failure> {
        Bounds::of(&self.start.at(State { speed: 0.01, viscosity: 0.1 }).map_err(refused)?)
    }

    fn run(&self) -> Result<Row, Failure> {
        let Self { start, parameter, fineness, .. } = self;
        let bounds = self.bounds()?;
        let predicted = parameter.predicted(&bounds);
        let range = Range::new(parameter.range(), fineness.ladder, predicted, fineness.factor);
        let mut refusal = None;
        let found = range.search(|value| {
            let state = parameter.state(value, &bounds);
            match start.at(state) {
                Ok(mut lbm) => watch(&mut lbm, start.steps(state, fineness.crossings)),
                Err(error) => {
                    refusal = Some(error);
                    watch::End::Stopped("it cannot be set up".to_owned())
                }
            }
        });
        match refusal {
            Some(error) => Err(refused(error)),
            None => Ok(self.row(&found, predicted, bounds.refuses && *parameter == Parameter::Mach)),
        }
    }

    /// `refuses`: the check refuses what is beyond the prediction.
    fn row(&self, found: &Found, predicted: Option<f64>, refuses: bool) -> Row {
        let parameter = self.parameter;
        let swept = Swept {
            case: self.case.clone(),
            parameter: parameter.name(),
            range: parameter.range(),
            shown: &|value| parameter.shown(value),
        };
        swept.row(found, predicted, refuses)
    }
}

fn refused(error: granular_lbm::SetupError) -> Failure {
    Failure::Refused(vec![error.to_string()])
}

/// What a study comes to.
///
/// # Errors
/// When a guard was silent, or a run failed within the bounds.
pub fn verdict(rows: &[Row]) -> Result<(), Failure> {
    let faults: Vec<String> = rows
        .iter()
        .filter_map(|row| row.fault.as_ref().map(|fault| format!("{}, {}: {fault}", row.case, row.parameter)))
        .collect();
    if faults.is_empty() {
        return Ok(());
    }
    Err(Failure::Invalid(format!("{} of {} limits failed: {}", faults.len(), rows.len(), faults.join("\n"))))
}

#[cfg(test)]
mod tests;
