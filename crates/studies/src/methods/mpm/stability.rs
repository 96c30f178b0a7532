//! Sweeps of the material point method.
//!
//! How long may a step be? Bodies that tremble at random, at a random place in the grid, and columns that fall are stepped with
//! more and more of the step that the solver calls stable; one that is too long makes them gain energy. And how hostile
//! may a scene be at the recommended step? Speeds, reaches into empty cells and rates of tearing are raised until a run no
//! longer finishes.

mod bodies;
mod refused;
mod watch;

use super::names::{SCHEMES, SHAPES, said};
use crate::validate::Effort;
use crate::validate::stability::judge::Swept;
use crate::validate::stability::search::Range;
use crate::validate::stability::watch::End;
use crate::validate::stability::{Choice, Request, Row, Stability};
use bodies::{Falling, Torn, Trembling};
use granular_core::{Limits, SetupError, Solver, StepRule};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_mpm::{Mpm2, Options, Scheme, ShapeFunctions};
use watch::{finishes, gains};

pub(super) const STUDY: Stability = Stability {
    choices: &[
        Choice { flag: "shape", about: "Shape functions", names: &["linear", "gimp", "bspline"] },
        Choice {
            flag: "scheme",
            about: "Schemes",
            names: &["stress-last", "stress-first", "modified-stress-last"],
        },
    ],
    run,
};

/// Steps that are tried, over the longest stable one.
const STEPS: [f64; 2] = [0.5, 6.0];
/// Parameter of sweeps over the step.
const STEP: &str = "step over the longest stable one";

/// Shape functions and a scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Variant {
    shape: (&'static str, ShapeFunctions),
    scheme: (&'static str, Scheme),
}

impl Variant {
    fn options(self) -> Options {
        Options { shape: self.shape.1, scheme: self.scheme.1, ..Options::default() }
    }

    fn name(self) -> String {
        format!("{}, {}", self.shape.0, self.scheme.0)
    }

    /// Whether no step is safe everywhere, as docs/material-points.md says: a point that has just entered a cell gives the nodes beyond
    /// hardly any mass but all of its force, and strains taken from their velocities have no bound.
    fn bears_no_step(self) -> bool {
        (self.shape.1, self.scheme.1) == (ShapeFunctions::Linear, Scheme::StressLast)
    }
}

/// A row that tells a failure within the bounds that documentation and `check` tell too, as such.
fn known(row: Row) -> Row {
    if row.fault.is_none() {
        return row;
    }
    let reason = format!("nodes with little mass: {}", row.reason);
    Row { fault: None, known: true, reason, ..row }
}

/// How fine a study is.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    /// Bisection ends at this factor.
    factor: f64,
    /// Steps of what trembles.
    steps: u64,
    /// Random places and velocities.
    seeds: u64,
}

impl Fineness {
    fn of(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self { factor: 1.15, steps: 400, seeds: 2 },
            Effort::Full => Self { factor: 1.03, steps: 2000, seeds: 6 },
        }
    }
}

/// One sweep.
struct Sweep {
    case: String,
    parameter: &'static str,
    /// From mild to hostile.
    range: [f64; 2],
    /// Ratio of the values that are tried first.
    ratio: f64,
    kind: Kind,
    variant: Variant,
    fineness: Fineness,
}

/// What is made hostile.
#[derive(Clone, Copy)]
enum Kind {
    /// The step of what trembles.
    Tremble(Trembling),
    /// The step of what falls.
    Fall(Falling),
    /// Speed of a body that flies through the grid, over that of waves.
    Fly,
    /// What part of a cell a body reaches into.
    Reach,
    /// Rate at which a body is torn apart, times its size over the speed of waves.
    Tear(Torn),
}

/// All sweeps that are asked for.
fn run(request: &Request) -> Result<Vec<Row>, Failure> {
    let fineness = Fineness::of(request.effort);
    let mut sweeps = Vec::new();
    for variant in variants(request) {
        sweeps.push(step(Kind::Tremble(Trembling::default()), "trembling", variant, fineness));
    }
    for variant in hostile(request) {
        sweeps.extend(samples(variant, fineness));
        sweeps.extend(scenes(variant, fineness));
    }
    let mut rows = parallel::each(&sweeps, Sweep::run)?;
    rows.extend(refused::rows());
    Ok(rows)
}

/// All that are chosen.
fn variants(request: &Request) -> Vec<Variant> {
    let shapes = SHAPES.into_iter().filter(|(name, _)| request.wants("shape", name));
    let all = shapes.flat_map(|shape| SCHEMES.into_iter().map(move |scheme| Variant { shape, scheme }));
    all.filter(|variant| request.wants("scheme", variant.scheme.0)).collect()
}

/// Those that hostile scenes are run with: the default, and the one that bears least, of those that are chosen.
fn hostile(request: &Request) -> Vec<Variant> {
    let chosen = variants(request);
    let usual = |variant: &&Variant| {
        let chosen = (variant.shape.1, variant.scheme.1);
        chosen == (ShapeFunctions::UniformGimp, Scheme::ModifiedStressLast) || variant.bears_no_step()
    };
    let found: Vec<Variant> = chosen.iter().filter(usual).copied().collect();
    if found.is_empty() { chosen } else { found }
}

fn step(kind: Kind, name: &str, variant: Variant, fineness: Fineness) -> Sweep {
    let case = format!("{name}: {}", variant.name());
    Sweep { case, parameter: STEP, range: STEPS, ratio: 1.5, kind, variant, fineness }
}

/// What the step is sought for.
fn samples(variant: Variant, fineness: Fineness) -> Vec<Sweep> {
    let base = Trembling::default();
    let mut list = Vec::new();
    let mut add = |name: String, kind: Kind| list.push(step(kind, &name, variant, fineness));
    for along in [1, 2, 10] {
        let name = format!("{} particles in a cell", along * along);
        add(name, Kind::Tremble(Trembling { along, ..base }));
    }
    for stiffness in [1e3, 1e6] {
        add(format!("stiffness ratio {stiffness:.0e}"), Kind::Tremble(Trembling { stiffness, ..base }));
    }
    for (name, friction_angle, cohesion) in [
        ("angle of friction 0, cohesion 1 kPa", 0.0, 1e3),
        ("angle of friction 1 degree, no cohesion", 1.0, 0.0),
        ("angle of friction 60 degrees, no cohesion", 60.0, 0.0),
    ] {
        add(name.to_owned(), Kind::Fall(Falling { friction_angle, cohesion, ..Falling::default() }));
    }
    for gravity in [0.0, 1.0, 100.0] {
        add(format!("{gravity} g"), Kind::Fall(Falling { gravity: 9.81 * gravity, ..Falling::default() }));
    }
    list
}

/// What is made hostile at the recommended step.
fn scenes(variant: Variant, fineness: Fineness) -> Vec<Sweep> {
    let of = |name: &str, parameter, range, ratio, kind| Sweep {
        case: format!("{name}: {}", variant.name()),
        parameter,
        range,
        ratio,
        kind,
        variant,
        fineness,
    };
    vec![
        of("flying through cells", "speed over that of waves", [0.01, 1e3], 10.0, Kind::Fly),
        of("nearly empty cells", "part of a cell that is reached", [0.5, 1e-12], 30.0, Kind::Reach),
        of(
            "torn apart, elastic",
            "rate times size over wave speed",
            [0.01, 10.0],
            3.0,
            Kind::Tear(Torn::Elastic),
        ),
        of(
            "torn apart, dry sand",
            "rate times size over wave speed",
            [0.01, 10.0],
            3.0,
            Kind::Tear(Torn::Sand),
        ),
    ]
}

/// Longest step \[s\] beyond which the solver refuses, by its own report.
fn stable(mpm: &Mpm2) -> Result<f64, Failure> {
    let mut limits = Limits::default();
    mpm.limits(&mut limits);
    let steps = limits.steps.iter().filter(|limit| limit.rule == StepRule::AtMost).map(|limit| limit.dt);
    let shortest = steps.reduce(f64::min);
    shortest.ok_or_else(|| Failure::Invalid("the solver reports no limit on the step".to_owned()))
}

impl Sweep {
    fn run(&self) -> Result<Row, Failure> {
        let by_step = matches!(self.kind, Kind::Tremble(_) | Kind::Fall(_));
        let predicted = by_step.then_some(1.0);
        let mut wrong = None;
        let found = Range::new(self.range, self.ratio, predicted, self.fineness.factor).search(|value| {
            self.end(value).unwrap_or_else(|failure| {
                let end = End::Missed(failure.to_string());
                wrong = Some(failure);
                end
            })
        });
        if let Some(failure) = wrong {
            return Err(failure);
        }
        let (case, parameter, range) = (self.case.clone(), self.parameter, self.range);
        let swept = Swept { case, parameter, range, shown: &|value| value };
        let row = swept.row(&found, predicted, by_step);
        // A guard that is silent is a fault of any variant.
        let is_known = found.missed.is_empty() && self.variant.bears_no_step();
        Ok(if is_known { known(row) } else { row })
    }

    /// How runs with a value end: as the first of them that does not finish.
    fn end(&self, value: f64) -> Result<End, Failure> {
        let options = self.variant.options();
        let Fineness { steps, seeds, .. } = self.fineness;
        let seeded = |run: &dyn Fn(u64) -> Result<End, Failure>| {
            (1..=seeds).map(run).find(|end| !matches!(end, Ok(End::Finished))).unwrap_or(Ok(End::Finished))
        };
        let built = |mpm: Result<Mpm2, SetupError>| mpm.map_err(said);
        match self.kind {
            Kind::Tremble(body) => seeded(&|seed| {
                let mut mpm = built(body.build(options, seed))?;
                let dt = value * stable(&mpm)?;
                Ok(gains(&mut mpm, |_| dt, steps, watch::TREMBLES))
            }),
            Kind::Fall(column) => {
                let mut mpm = built(column.build(options))?;
                let dt = |mpm: &Mpm2| value * mpm.stable_step();
                let steps = column.steps(value * stable(&mpm)?);
                Ok(gains(&mut mpm, dt, steps, watch::FALLS))
            }
            Kind::Fly => seeded(&|seed| {
                let mut mpm = built(Trembling::default().flying(value, options, seed))?;
                Ok(finishes(&mut mpm, steps, watch::TREMBLES))
            }),
            Kind::Reach => seeded(&|seed| {
                let mut mpm = built(Trembling::default().reaching(value, options, seed))?;
                Ok(finishes(&mut mpm, steps, watch::TREMBLES))
            }),
            Kind::Tear(material) => {
                let mut mpm = built(material.torn(value, options))?;
                Ok(finishes(&mut mpm, steps, watch::FALLS))
            }
        }
    }
}

#[cfg(test)]
mod tests;
