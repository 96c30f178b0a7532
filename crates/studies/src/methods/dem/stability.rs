//! Sweeps of the discrete element method.
//!
//! Two questions are asked. How long may a step be? Samples that are squeezed between walls and at rest are stepped with
//! more and more of the step that the solver calls stable; a step that is too long makes them shake by themselves. And
//! how hostile may a scene be at the recommended step? Speeds, overlaps, damping and distances are raised until a run
//! no longer finishes.

mod sample;
mod shake;

use crate::validate::Effort;
use crate::validate::stability::judge::Swept;
use crate::validate::stability::search::Range;
use crate::validate::stability::watch::End;
use crate::validate::stability::{Outcome, Request, Row, Stability};
use granular_core::{Limits, Solver};
use granular_dem::material::restitution_of_damping;
use granular_dem::{Dem2, Material, Materials, Tension};
use granular_driver::failure::Failure;
use granular_driver::parallel;
use sample::{FLIGHT, Shape, Squeezed, flung, shot, touching};

/// Longest step that is tried, over the stable one.
const LONGEST: f64 = 8.0;

pub(super) const STUDY: Stability = Stability { choices: &[], run };

/// All sweeps.
fn run(request: &Request) -> Result<Vec<Row>, Failure> {
    let factor = if request.effort == Effort::Full { 1.02 } else { 1.1 };
    let steps = samples().into_iter().map(|(name, sample)| Sweep::Step(name, sample));
    let sweeps: Vec<Sweep> = steps.chain(Sweep::SCENES).collect();
    let mut rows = parallel::each(&sweeps, |sweep| sweep.run(factor))?;
    rows.push(no_restitution());
    Ok(rows)
}

/// What the step is sought for.
fn samples() -> Vec<(String, Squeezed)> {
    let base = Squeezed::default();
    let of = |name: &str, material: Material| (name.to_owned(), Squeezed { material, ..base });
    let glass = base.material;
    let mut list = vec![("one grain".to_owned(), Squeezed { shape: Shape::Hexagonal(1), ..base })];
    for factor in [1e-2, 1.0, 1e2, 1e4] {
        let normal_stiffness = factor * glass.normal_stiffness;
        list.push(of(&format!("stiffness x {factor}"), Material { normal_stiffness, ..glass }));
    }
    for zeta in [0.0, 0.1, 0.5, 1.0] {
        let restitution = restitution_of_damping(zeta, Tension::Cut);
        list.push(of(&format!("damping {zeta} of critical"), Material { restitution, ..glass }));
    }
    list.push(of("restitution 0.001", Material { restitution: 1e-3, ..glass }));
    list.push(of("restitution 1, no friction", Material { restitution: 1.0, friction: 0.0, ..glass }));
    for friction in [0.0, 10.0] {
        list.push(of(&format!("friction {friction}"), Material { friction, ..glass }));
    }
    for ratio in [1.0, 10.0, 100.0] {
        // Weightless: the weight of the large grain would crush the small ones.
        let sample = Squeezed { shape: Shape::Row(ratio), gravity: 0.0, ..base };
        list.push((format!("size ratio {ratio}"), sample));
    }
    for gravity in [0.0, 100.0] {
        let sample = Squeezed { gravity: gravity * 9.81, ..base };
        list.push((format!("{gravity} g"), sample));
    }
    list
}

/// One sweep.
enum Sweep {
    /// Longest step of a sample.
    Step(String, Squeezed),
    /// Speed of a grain that is shot at another one and at a wall, for a stiffness over that of glass.
    Speed(f64),
    /// Stiffness over that of glass, downwards, for a shot at 100 m/s.
    Stiffness,
    /// Overlap at the start, from round-off on.
    Overlap,
    /// Restitution, downwards.
    Restitution,
    /// Distance to which a grain has flown.
    Distance,
}

impl Sweep {
    const SCENES: [Self; 6] = [
        Self::Speed(1.0),
        Self::Speed(1e4),
        Self::Stiffness,
        Self::Overlap,
        Self::Restitution,
        Self::Distance,
    ];

    fn run(&self, factor: f64) -> Result<Row, Failure> {
        match self {
            Self::Step(name, sample) => longest_step(name, sample, factor),
            Self::Speed(stiffness) => fastest_shot(*stiffness, factor),
            Self::Stiffness => softest_shot(factor),
            Self::Overlap => deepest_start(factor),
            Self::Restitution => least_restitution(factor),
            Self::Distance => farthest(factor),
        }
    }
}

fn longest_step(name: &str, sample: &Squeezed, factor: f64) -> Result<Row, Failure> {
    let (calm, stable) = sample.calm()?;
    let range = [0.5, LONGEST];
    let found = Range::new(range, 1.5, Some(1.0), factor).search(|share| {
        // Every step begins from the same bits.
        match calm.again(sample) {
            Ok(mut dem) => shake::shake(&mut dem, share * stable, calm.energy),
            Err(error) => End::Missed(error.to_string()),
        }
    });
    let shown = |share: f64| share * stable;
    let swept = Swept { case: name.to_owned(), parameter: "step [s]", range, shown: &shown };
    Ok(swept.row(&found, Some(1.0), true))
}

/// A bound that the solver reports.
fn bound(dem: &Dem2, name: &str) -> Result<(f64, f64), Failure> {
    let mut limits = Limits::default();
    dem.limits(&mut limits);
    let found = limits.bounds.iter().find(|bound| bound.name == name);
    let missing = || Failure::Invalid(format!("the solver reports no bound on `{name}`"));
    found.map(|bound| (bound.value, bound.allowed)).ok_or_else(missing)
}

fn fastest_shot(stiffness: f64, factor: f64) -> Result<Row, Failure> {
    // The overlap of an impact is proportional to its speed.
    let (value, allowed) = bound(&shot(1.0, stiffness), "overlap of the hardest impact")?;
    let (predicted, range) = (allowed / value, [0.1, if stiffness > 1.0 { 1000.0 } else { 100.0 }]);
    let found = Range::new(range, 2.0, Some(predicted), factor).search(|speed| fly(speed, stiffness));
    let case = format!("shot, stiffness x {stiffness}");
    let swept = Swept { case, parameter: "speed [m/s]", range, shown: &|speed| speed };
    Ok(swept.row(&found, Some(predicted), true))
}

/// How a shot ends.
fn fly(speed: f64, stiffness: f64) -> End {
    let mut dem = shot(speed, stiffness);
    let dt = dem.recommended_step();
    shake::finishes(&mut dem, dt, (FLIGHT / (speed * dt)) as u64)
}

fn softest_shot(factor: f64) -> Result<Row, Failure> {
    let speed = 100.0;
    // The overlap of an impact falls with the root of the stiffness.
    let (value, allowed) = bound(&shot(speed, 1.0), "overlap of the hardest impact")?;
    let (predicted, range) = ((value / allowed).powi(2), [1e4, 1e-2]);
    let found = Range::new(range, 2.0, Some(predicted), factor).search(|stiffness| fly(speed, stiffness));
    let (case, parameter) = ("shot at 100 m/s".to_owned(), "stiffness over that of glass");
    let swept = Swept { case, parameter, range, shown: &|stiffness| stiffness };
    Ok(swept.row(&found, Some(predicted), true))
}

fn deepest_start(factor: f64) -> Result<Row, Failure> {
    let (value, allowed) = bound(&touching(1e-3), "overlap at the start")?;
    let (predicted, range) = (1e-3 * allowed / value, [1e-17, 0.9]);
    let found = Range::new(range, 10.0, Some(predicted), factor).search(|overlap| {
        let mut dem = touching(overlap);
        let dt = dem.recommended_step();
        shake::finishes(&mut dem, dt, 500)
    });
    let case = "touching by round-off, or more".to_owned();
    let swept = Swept { case, parameter: "overlap over radius", range, shown: &|overlap| overlap };
    Ok(swept.row(&found, Some(predicted), true))
}

fn least_restitution(factor: f64) -> Result<Row, Failure> {
    let range = [1.0, 1e-6];
    let mut refused = None;
    let found = Range::new(range, 3.0, None, factor).search(|restitution| {
        let sample = Squeezed {
            material: Material { restitution, ..Squeezed::default().material },
            ..Squeezed::default()
        };
        match sample.build() {
            Ok(mut dem) => {
                let dt = dem.recommended_step();
                shake::finishes(&mut dem, dt, 2000)
            }
            Err(error) => {
                let end = End::Missed(error.to_string());
                refused = Some(error);
                end
            }
        }
    });
    let case = "packing at the recommended step".to_owned();
    let swept = Swept { case, parameter: "restitution", range, shown: &|restitution| restitution };
    Ok(swept.row(&found, None, false))
}

fn farthest(factor: f64) -> Result<Row, Failure> {
    let range = [1.0, 1e12];
    let found = Range::new(range, 100.0, None, factor).search(|distance| {
        let mut dem = flung(distance);
        let dt = dem.recommended_step();
        let end = shake::finishes(&mut dem, dt, 200);
        let bytes = dem.memory().bytes;
        if bytes > shake::MOST_BYTES { End::Missed(format!("the lists take {bytes} bytes")) } else { end }
    });
    let case = "a grain flung away from a packing".to_owned();
    let swept = Swept { case, parameter: "distance [m]", range, shown: &|distance| distance };
    Ok(swept.row(&found, None, false))
}

/// No finite damping gives a restitution of zero, so the material is refused.
fn no_restitution() -> Row {
    let refusal = Materials::new().add(Material { restitution: 0.0, ..Material::default() }).err();
    let fault = refusal.is_none().then(|| "a restitution of 0 is taken".to_owned());
    let why = refusal.map(|error| error.to_string()).unwrap_or_default();
    Row {
        case: "restitution 0".to_owned(),
        parameter: "restitution",
        predicted_limit: Some(0.0),
        observed_limit: None,
        outcome: Outcome::Refused,
        reason: format!("refused: {why}; no finite damping gives 0, and critical damping gives 0.135"),
        fault,
        known: false,
    }
}

#[cfg(test)]
mod tests;
