//! Limits of the lattice Boltzmann method: relaxation times, Mach numbers and grid Reynolds numbers at which flows blow up.

mod flows;
mod guard;

use crate::validate::Effort;
use crate::validate::stability::judge::Swept;
use crate::validate::stability::search::{Found, Range};
use crate::validate::stability::watch::{End, watch};
use crate::validate::stability::{Choice, Request, Row, Stability};
use flows::{Geometry, Start, State};
use granular_core::{Limits, Solver};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_lbm::Operator;

pub(super) const STUDY: Stability = Stability {
    choices: &[
        Choice {
            flag: "operator",
            about: "Collision operators",
            names: &["single", "two", "multiple", "kumar", "regularised"],
        },
        Choice { flag: "flow", about: "Flows", names: &["shear-layer", "cavity", "jet", "regularised-jet"] },
    ],
    run,
};

/// Collision operators by name.
const OPERATORS: [(&str, Operator); 5] = [
    ("single", Operator::SingleRelaxation),
    ("two", Operator::TwoRelaxation { magic: 3.0 / 16.0 }),
    ("multiple", Operator::EXACT_WALLS),
    ("kumar", Operator::KUMAR),
    ("regularised", Operator::Regularised),
];

/// Constant of the Smagorinsky closure where it is on.
const SMAGORINSKY: f64 = 0.1;
/// Mach number of the sweeps over relaxation time and over the grid Reynolds number.
const MACH: [f64; 2] = [0.05, 0.17];

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

/// All sweeps that are asked for.
fn run(request: &Request) -> Result<Vec<Row>, Failure> {
    let fineness = Fineness::of(request.effort);
    let mut sweeps = Vec::new();
    for geometry in Geometry::ALL.into_iter().filter(|g| request.wants("flow", g.name())) {
        for (name, operator) in OPERATORS.into_iter().filter(|(n, _)| request.wants("operator", n)) {
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
                    End::Stopped("it cannot be set up".to_owned())
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

#[cfg(test)]
mod tests;
