//! What is known before the first step: limits, memory, time, and what was left out.

use crate::failure::Failure;
use crate::figures::{self, Extents};
use crate::methods::member::Member;
use crate::model::{self, Model};
use crate::progress::duration;
use crate::scene::{Scene, Stage};
use crate::scene_file::{SceneProblem, SceneText};
use granular_core::{Limits, Memory, StepRule};
use serde_json::{Value, json};
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Wall time spent on measuring the speed of a scene.
const PROBE: Duration = Duration::from_millis(300);

/// Report of a check.
#[derive(Clone, Debug)]
pub struct Report {
    /// Name of the scene file.
    pub scene: String,
    /// Solvers, in the order of their names.
    pub solvers: Vec<Part>,
    /// Limits and bounds.
    pub limits: Limits,
    /// Steps of the stages \[s\], with their names and longest durations \[s\].
    pub stages: Vec<(String, f64, f64)>,
    /// Names of stages that push the grains, and what each push does.
    pub pushes: Vec<(String, String)>,
    /// Longest run time with the present number of threads \[s\], from a measured burst of steps.
    pub estimated_seconds: f64,
    /// What the grains take up; none without any.
    sample: Option<Extents>,
    /// Gravity at the start \[m/s^2\].
    gravity: Vec<f64>,
    /// Axis that points up.
    up: usize,
    /// Files of the drawing, if one was asked for.
    pub drawing: Option<[PathBuf; 2]>,
    /// What is no reason to refuse the run, but perhaps not as it was meant.
    pub warnings: Vec<String>,
    /// Reasons to refuse the run.
    pub problems: Vec<String>,
}

/// A solver of the scene.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name in the scene.
    pub name: String,
    /// Name of the solver.
    pub solver: &'static str,
    /// Number and name of what a step works on.
    pub size: (usize, &'static str),
    /// Memory, and what costs nothing.
    pub memory: Memory,
}

impl Part {
    fn of(scene: &Scene, model: &Model, member: &dyn Member) -> Self {
        let solver = member.solver(&model.simulation);
        let mut memory = solver.memory();
        memory.left_out.extend(member.left_out(scene, &model.simulation));
        Self { name: member.name().to_owned(), solver: solver.name(), size: solver.size(), memory }
    }
}

/// Reads and builds a scene; problems know their place in the text.
///
/// # Errors
/// With all problems of the scene.
pub fn read(text: &SceneText) -> Result<(Scene, Model), Failure> {
    built(Scene::of(text)?, text)
}

fn built(scene: Scene, text: &SceneText) -> Result<(Scene, Model), Failure> {
    let model =
        model::build(&scene).map_err(|list| Failure::Scene(SceneProblem::all_located_in(list, text)))?;
    Ok((scene, model))
}

/// The step of each stage: its own, that of the solver, or the recommended one \[s\].
pub(crate) fn steps(scene: &Scene, model: &Model, limits: &Limits) -> Vec<f64> {
    let recommended = limits.recommended().map_or(1e-3, |limit| limit.dt);
    let default = model.time_step().unwrap_or(recommended);
    scene.stages.iter().map(|stage| stage.time_step.map_or(default, |step| step.value())).collect()
}

/// Limits of a model and the reasons to refuse it.
pub fn limits_of(scene: &Scene, model: &Model) -> (Limits, Vec<f64>, Vec<String>) {
    let mut limits = Limits::default();
    model.simulation.limits(&mut limits);
    let steps = steps(scene, model, &limits);
    let mut problems = Vec::new();
    if let Some(largest) = limits.largest_allowed() {
        for (k, (stage, &dt)) in scene.stages.iter().zip(&steps).enumerate() {
            let path = key_of_step(scene, model, k);
            if dt > largest.dt {
                problems.push(format!(
                    "`{path}`: a step of {dt:.4e} s in stage `{}`; allowed: at most {:.4e} s, the limit of {} \
                     ({}); leave the key out or take a shorter step",
                    stage.name, largest.dt, largest.name, largest.why
                ));
            }
        }
    }
    problems.extend(model.members.iter().flat_map(|member| member.refusals(scene, &steps)));
    problems.extend(broken_bounds(&limits));
    (limits, steps, problems)
}

/// Limits and bounds beside what is taken of them by steps of stages \[s\], for scripts and `run.json`.
pub(crate) fn limits_to_json(limits: &Limits, steps: &[f64]) -> Vec<Value> {
    let chosen = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let steps = limits.steps.iter().map(|limit| {
        json!({ "name": limit.name, "value": chosen, "bound": limit.dt, "unit": "s",
            "binds": (chosen - limit.dt).abs() <= 1e-12 * limit.dt, "why": limit.why })
    });
    let bounds = limits.bounds.iter().map(|bound| {
        json!({ "name": bound.name, "value": bound.value, "bound": bound.allowed, "unit": bound.unit,
            "binds": !bound.holds(), "why": bound.why })
    });
    steps.chain(bounds).collect()
}

/// Where the scene chooses the step of a stage.
fn key_of_step(scene: &Scene, model: &Model, stage: usize) -> String {
    if scene.stages[stage].time_step.is_some() {
        return format!("stages.{stage}.time_step");
    }
    let chooses = model.members.iter().find(|member| member.time_step().is_some());
    match (chooses, scene.solvers.iter().next()) {
        (Some(member), _) => format!("solvers.{}.time_step", member.name()),
        (None, Some((name, solver))) => format!("solvers.{name}.{}", solver.step_key()),
        (None, None) => "solvers".to_owned(),
    }
}

/// The bounds that refuse a run.
fn broken_bounds(limits: &Limits) -> Vec<String> {
    let broken = limits.bounds.iter().filter(|bound| bound.refuses && !bound.holds());
    broken
        .map(|bound| {
            format!(
                "{} is {:.4} {unit}; allowed: at most {} {unit}; {}",
                bound.name,
                bound.value,
                bound.allowed,
                bound.why,
                unit = bound.unit
            )
        })
        .collect()
}

/// Reads and builds a scene that is to be run. A fluid of many cells whose bounds are broken is refused before it is built.
///
/// # Errors
/// With all problems of the scene, or why it is refused.
pub(crate) fn read_to_run(text: &SceneText) -> Result<(Scene, Model), Failure> {
    let scene = Scene::of(text)?;
    let problems = model::early_limits(&scene).map_or(Vec::new(), |limits| broken_bounds(&limits));
    if problems.is_empty() { built(scene, text) } else { Err(refusal(text.name(), &problems)) }
}

/// Checks a scene and measures its speed on a few steps.
///
/// # Errors
/// When the scene is wrong. A scene that would be refused gives a report with problems.
pub fn check(text: &SceneText) -> Result<Report, Failure> {
    measured(text, None, PROBE)
}

/// The same with another wall time to measure the speed in; at least one step is taken.
///
/// # Errors
/// As [`check`].
pub fn check_within(text: &SceneText, probe: Duration) -> Result<Report, Failure> {
    measured(text, None, probe)
}

/// The same, with a drawing of the scene before its first step, as `.svg` and `.png`.
///
/// # Errors
/// As [`check`], and when the drawing cannot be written.
pub fn check_and_draw(text: &SceneText, drawing: Option<&Path>) -> Result<Report, Failure> {
    measured(text, drawing, PROBE)
}

fn measured(text: &SceneText, drawing: Option<&Path>, probe: Duration) -> Result<Report, Failure> {
    let (scene, mut model) = read_to_run(text)?;
    let drawing = drawing.map(|path| figures::draw_initial(&scene, &model, path)).transpose()?;
    let sample = model.members.iter().find_map(|member| Extents::of(member.solver(&model.simulation)));
    let mut warnings = figures::times_beyond(&scene, model.column());
    warnings.extend(sample.and_then(|sample| apart(&sample, figures::ends_of_walls(&scene, model.column()))));
    let (limits, steps, problems) = limits_of(&scene, &model);
    // Measuring the speed lets grains come in.
    let solvers = model.members.iter().map(|member| Part::of(&scene, &model, &**member)).collect();
    let stages: Vec<(String, f64, f64)> = scene
        .stages
        .iter()
        .zip(&steps)
        .map(|(stage, &dt)| (stage.name.clone(), dt, stage.end.longest()))
        .collect();
    let count: f64 = stages.iter().map(|(_, dt, longest)| longest / dt).sum();
    let pushes = pushes(&scene, &model);
    let of_members = model.members.iter().flat_map(|member| member.warnings(&scene, &model.simulation));
    warnings.extend(of_members);
    let estimated_seconds =
        if problems.is_empty() { count * seconds_per_step(&mut model, steps[0], probe) } else { f64::NAN };
    Ok(Report {
        scene: text.name().to_owned(),
        solvers,
        limits,
        stages,
        pushes,
        estimated_seconds,
        sample,
        gravity: scene.gravity.iter().map(|value| value.value()).collect(),
        up: model.up,
        drawing,
        warnings,
        problems,
    })
}

/// What solvers will do at the start of stages, by stage.
fn pushes(scene: &Scene, model: &Model) -> Vec<(String, String)> {
    let of_stage = |(k, stage): (usize, &Stage)| {
        let members = model.members.iter();
        let lines = members.flat_map(move |member| member.announced(&model.simulation, k));
        lines.map(|text| (stage.name.clone(), text)).collect::<Vec<_>>()
    };
    scene.stages.iter().enumerate().flat_map(of_stage).collect()
}

/// Wall time of one step, measured.
fn seconds_per_step(model: &mut Model, dt: f64, probe: Duration) -> f64 {
    let begun = Instant::now();
    let (mut steps, mut burst) = (0, 1);
    if model.simulation.begin_segment(dt).is_err() {
        return f64::NAN;
    }
    while steps == 0 || begun.elapsed() < probe {
        if model.simulation.advance(burst).is_err() {
            return f64::NAN;
        }
        steps += burst as u32;
        // A step of a large scene may take as long as all of the probe.
        burst = (2 * burst).min(20);
    }
    begun.elapsed().as_secs_f64() / f64::from(steps)
}

/// What is said when all walls that have ends lie beside the sample.
fn apart(sample: &Extents, walls: Option<[f64; 2]>) -> Option<String> {
    let ([left, right], [first, last]) = ([sample.low[0], sample.high[0]], walls?);
    (right < first || left > last).then(|| {
        format!(
            "the sample and the walls that have ends do not meet: it lies from {} to {} along x, they from {} to {}; \
             --draw shows them",
            length(left),
            length(right),
            length(first),
            length(last)
        )
    })
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// A length with four digits, in the unit that suits it.
fn length(metres: f64) -> String {
    let (value, unit) = match metres.abs() {
        size if size >= 1.0 => (metres, "m"),
        size if size >= 1e-4 => (1e3 * metres, "mm"),
        size if size < 1e-9 => (0.0, "mm"),
        _ => (1e6 * metres, "um"),
    };
    let decimals = (3.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 4.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{} {unit}", if text == "-0" { "0" } else { text })
}

/// A refusal that names the scene.
pub(crate) fn refusal(scene: &str, problems: &[String]) -> Failure {
    Failure::Refused(problems.iter().map(|problem| format!("{scene}: {problem}")).collect())
}

impl Report {
    /// The failure that the problems are.
    pub fn refusal(&self) -> Failure {
        refusal(&self.scene, &self.problems)
    }

    /// What costs nothing since the scene does not ask for it.
    fn left_out(&self) -> impl Iterator<Item = &String> {
        self.solvers.iter().flat_map(|part| &part.memory.left_out)
    }

    /// Where the grains are, and which way they fall.
    fn write_sample(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(sample) = &self.sample {
            let depth =
                if self.up == 2 { format!("{} deep, ", length(sample.size(1))) } else { String::new() };
            writeln!(
                f,
                "\nsample    {} wide, {depth}{} high: from {} to {} along {}, from {} to {} along x",
                length(sample.size(0)),
                length(sample.size(self.up)),
                length(sample.low[self.up]),
                length(sample.high[self.up]),
                AXES[self.up],
                length(sample.low[0]),
                length(sample.high[0]),
            )?;
        }
        let size = self.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let along = self.gravity.iter().position(|g| g.abs() == size);
        match along {
            _ if size == 0.0 => writeln!(f, "gravity   none"),
            Some(axis) => {
                let sign = if self.gravity[axis] < 0.0 { "-" } else { "+" };
                writeln!(f, "gravity   {size} m/s^2 along {sign}{}", AXES[axis])
            }
            None => writeln!(f, "gravity   {:?} m/s^2", self.gravity),
        }
    }

    /// The report as JSON.
    pub fn to_json(&self) -> Value {
        let steps: Vec<f64> = self.stages.iter().map(|(_, dt, _)| *dt).collect();
        let pushes = self.pushes.iter().map(|(stage, text)| json!({ "stage": stage, "push": text }));
        let first = &self.solvers[0];
        let solvers = self.solvers.iter().map(|part| {
            json!({ "name": part.name, "solver": part.solver, "size": part.size.0, "memory_bytes": part.memory.bytes,
                "bytes_per_item": part.memory.bytes_per_item, "left_out": part.memory.left_out })
        });
        json!({
            "scene": self.scene,
            "solver": first.solver,
            "size": first.size.0,
            "solvers": solvers.collect::<Vec<_>>(),
            "limits": limits_to_json(&self.limits, &steps),
            "pushes": pushes.collect::<Vec<_>>(),
            "advice": self.limits.advice,
            "memory_bytes": self.solvers.iter().map(|part| part.memory.bytes).sum::<usize>(),
            "bytes_per_item": first.memory.bytes_per_item,
            "estimated_seconds": self.estimated_seconds,
            "left_out": self.left_out().collect::<Vec<_>>(),
            "sample": self.sample.map(|sample| json!({
                "width": sample.size(0), "height": sample.size(self.up), "lowest": sample.low[self.up],
                "highest": sample.high[self.up], "low": sample.low, "high": sample.high, "unit": "m",
            })),
            "gravity": self.gravity,
            "drawing": self.drawing,
            "warnings": self.warnings,
            "problems": self.problems,
        })
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |part: &Part| format!("{} {}s, solver {}", part.size.0, part.size.1, part.solver);
        match self.solvers.as_slice() {
            [alone] => writeln!(f, "{}: {}", self.scene, part(alone))?,
            several => {
                writeln!(f, "{}", self.scene)?;
                for solver in several {
                    writeln!(f, "  {}: {}", solver.name, part(solver))?;
                }
            }
        }
        self.write_sample(f)?;
        writeln!(f, "\nstages")?;
        for (name, dt, longest) in &self.stages {
            writeln!(
                f,
                "  {name:<24} at most {longest} s in steps of {dt:.4e} s: {:.0} steps",
                (longest / dt).ceil()
            )?;
            for (_, push) in self.pushes.iter().filter(|(stage, _)| stage == name) {
                writeln!(f, "    begins with {push}")?;
            }
        }
        writeln!(f, "\nlimits on the step")?;
        let chosen = self.stages.iter().map(|(_, dt, _)| *dt).fold(f64::INFINITY, f64::min);
        for limit in &self.limits.steps {
            let binds = (chosen - limit.dt).abs() <= 1e-12 * limit.dt;
            let remark = match limit.rule {
                _ if binds => "binds".to_owned(),
                StepRule::Recommended => format!("chosen step is {:.2} of it", chosen / limit.dt),
                _ => format!("safety factor {:.1}", limit.dt / chosen),
            };
            writeln!(f, "  {:<24} {:.4e} s  {remark}  ({})", limit.name, limit.dt, limit.why)?;
        }
        writeln!(f, "\nbounds")?;
        for bound in &self.limits.bounds {
            let verdict = match (bound.holds(), bound.refuses) {
                (true, _) => "holds",
                (false, true) => "BROKEN, refuses the run",
                (false, false) => "EXCEEDED, a warning",
            };
            writeln!(
                f,
                "  {:<32} {:>8.3} of {} {}  {verdict}  ({})",
                bound.name, bound.value, bound.allowed, bound.unit, bound.why
            )?;
        }
        if !self.limits.advice.is_empty() {
            writeln!(f, "\nadvice")?;
        }
        for advice in &self.limits.advice {
            writeln!(f, "  {advice}")?;
        }
        writeln!(f)?;
        for Part { name, memory, size: (_, item), .. } in &self.solvers {
            let megabytes = memory.bytes as f64 / 1e6;
            let of = if self.solvers.len() > 1 { format!("{name}: ") } else { String::new() };
            writeln!(f, "memory    {of}{megabytes:.2} MB, {} bytes per {item}", memory.bytes_per_item)?;
        }
        let threads = rayon::current_num_threads();
        let packs = self.solvers.iter().any(|part| part.size.1 == "grain");
        let later = if packs { "; grains that pack later take longer" } else { "" };
        writeln!(
            f,
            "run time  at most {} on {threads} threads (measured over the first steps{later})",
            duration(self.estimated_seconds)
        )?;
        writeln!(f, "\nleft out")?;
        for left_out in self.left_out() {
            writeln!(f, "  {left_out}")?;
        }
        if let Some([svg, png]) = &self.drawing {
            writeln!(f, "\ndrawing   {}, {}", svg.display(), png.display())?;
        }
        for warning in &self.warnings {
            writeln!(f, "\nwarning: {warning}")?;
        }
        // What the problems are, the failure says.
        match (self.problems.is_empty(), self.warnings.len()) {
            (false, _) => writeln!(f, "\nthe scene is refused"),
            (true, 0) => writeln!(f, "\nthe scene can be run"),
            (true, 1) => writeln!(f, "\nthe scene can be run, with a warning"),
            (true, count) => writeln!(f, "\nthe scene can be run, with {count} warnings"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_four_digits_and_a_unit_that_suits_them() {
        let cases = [
            (0.0703412, "70.34 mm"),
            (2.2, "2.2 m"),
            (0.0, "0 mm"),
            (3e-18, "0 mm"),
            (1.25e-5, "12.5 um"),
            (-0.004, "-4 mm"),
        ];
        for (metres, text) in cases {
            assert_eq!(length(metres), text);
        }
        assert_eq!(length(1234.5678), "1235 m");
    }

    #[test]
    fn a_sample_beside_all_walls_that_have_ends_is_told() {
        let sample = Extents { low: [0.0; 3], high: [0.05, 0.04, 0.0] };
        let said = apart(&sample, Some([0.1, 0.2])).unwrap();
        assert!(said.contains("it lies from 0 mm to 50 mm along x, they from 100 mm to 200 mm"), "{said}");
        assert_eq!((apart(&sample, Some([-0.1, 0.01])), apart(&sample, None)), (None, None));
    }
}
