//! A column collapse in memory: the template scene, run stage by stage without a run folder.

use crate::validate::stages;
use granular_core::{Every, Flow, Observer, ObserverError, Scheduled, Simulation};
use granular_driver::failure::Failure;
use granular_driver::methods::Member;
use granular_driver::model::Model;
use granular_driver::observers::Rest;
use granular_driver::scene::{End, Scene};
use granular_driver::scene_file::SceneText;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Simulated time between looks at the energy residual \[s\].
const LOOK: f64 = 1e-3;
/// End of the flow after the opening of the gate, in units of sqrt(H/g): 2.5 sqrt(2) in
/// \[StaronHinch2005\], 0.8 + 2 + 0.6 in \[Kumar2014, section 4.2\].
const FLOW: f64 = 3.54;
/// End of the run after the opening of the gate, in units of sqrt(H/g).
const DURATION: f64 = 8.0;

/// A column collapse to be run.
#[derive(Clone, Debug)]
pub(crate) struct Collapse {
    grains: usize,
    seed: u64,
    ledger: bool,
    edits: Vec<String>,
}

/// What came of a collapse.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fallen {
    /// Width of the column \[m\].
    pub(crate) width: f64,
    /// Height of the main mass when the gate opens \[m\].
    pub(crate) height: f64,
    /// Front of the main mass when the flow ends, at 3.54 sqrt(H/g) \[m\].
    pub(crate) flow_front: f64,
    /// Front of the main mass at the end of the run, at 8 sqrt(H/g) \[m\].
    pub(crate) front: f64,
    /// Kinetic energy at the end of the run, rotation included, over that at the end of the flow.
    pub(crate) still_moving: f64,
    /// Energy of rotation over that of translation at the end of the run; 1/2 for disks that roll.
    pub(crate) rotation: f64,
    /// Largest energy residual over the potential energy at the start; zero without a ledger.
    pub(crate) largest_residual: f64,
    /// Steps taken.
    pub(crate) steps: u64,
    /// Step during the collapse \[s\].
    pub(crate) dt: f64,
    /// Wall time of the steps \[s\].
    pub(crate) seconds: f64,
}

impl Fallen {
    /// Height over width when the gate opens.
    pub(crate) fn aspect_ratio(&self) -> f64 {
        self.height / self.width
    }

    /// `(L - L0) / L0` at the end of the run.
    pub(crate) fn run_out(&self) -> f64 {
        (self.front - self.width) / self.width
    }

    /// `(L - L0) / L0` at the end of the flow.
    pub(crate) fn run_out_of_flow(&self) -> f64 {
        (self.flow_front - self.width) / self.width
    }
}

impl Collapse {
    /// The template with so many grains.
    pub(crate) fn of(grains: usize) -> Self {
        Self { grains, seed: 1, ledger: false, edits: Vec::new() }
    }

    /// With the energy ledger.
    pub(crate) fn with_ledger(self) -> Self {
        Self { ledger: true, ..self }
    }

    /// With another seed.
    pub(crate) fn seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// With a change of the scene.
    pub(crate) fn set(mut self, edit: String) -> Self {
        self.edits.push(edit);
        self
    }

    /// Its scene.
    pub(crate) fn scene(&self) -> Result<SceneText, Failure> {
        let template = granular_driver::TEMPLATES.iter().find(|(name, _)| *name == "column-collapse");
        let (name, text) = template.expect("there is a template of a column collapse");
        let mut text = SceneText::new(*name, *text);
        text.set(&format!("sample.extent=Grains({})", self.grains))?;
        text.set(&format!("sample.seed={}", self.seed))?;
        if !self.ledger {
            text.set("figures=[]")?;
            text.set("outputs=[]")?;
        }
        self.edits.iter().try_for_each(|edit| text.set(edit))?;
        Ok(text)
    }

    /// Runs it.
    ///
    /// # Errors
    /// When the scene is wrong or refused, or the solver gives up.
    pub(crate) fn run(&self) -> Result<Fallen, Failure> {
        let (scene, mut model, steps) = stages::open(&self.scene()?)?;
        let begun = Instant::now();
        let number = |model: &Model, name| model.number(name).unwrap_or(f64::NAN);
        let scale = number(&model, "potential_energy");
        let column = model.column().expect("the template is a column");
        let (last, settling) = steps.split_last().expect("the template has stages");
        let mut residual = 0.0_f64;
        for (index, &dt) in settling.iter().enumerate() {
            residual = residual.max(self.stage(&scene, &mut model, index, dt)?);
        }
        // The grains that the gate lets go: the state at the start of the last stage.
        let height = number(&model, "height");
        let unit = (column.height / gravity(&scene)).sqrt();
        stages::begin(&mut model, settling.len());
        residual = residual.max(self.part(&mut model, *last, FLOW * unit, Vec::new())?);
        let flow_front = number(&model, "front");
        let moving = |model: &Model| number(model, "kinetic_energy") + number(model, "rotational_energy");
        let flowing = moving(&model);
        residual = residual.max(self.part(&mut model, *last, (DURATION - FLOW) * unit, Vec::new())?);
        Ok(Fallen {
            width: column.width,
            height,
            flow_front,
            front: number(&model, "front"),
            still_moving: moving(&model) / flowing,
            rotation: number(&model, "rotational_energy") / number(&model, "kinetic_energy"),
            largest_residual: residual / scale,
            steps: model.simulation.clock().step(),
            dt: model.simulation.clock().dt(),
            seconds: begun.elapsed().as_secs_f64(),
        })
    }

    /// Runs it until some time after the opening of the gate, in units of sqrt(H/g), and looks at it then and, before, when
    /// the gate opens.
    ///
    /// # Errors
    /// When the scene is wrong or refused, or the solver gives up.
    pub(crate) fn watch<T>(
        &self,
        time: f64,
        look: impl Fn(&Model) -> Result<T, Failure>,
    ) -> Result<[T; 2], Failure> {
        let (scene, mut model, steps) = stages::open(&self.scene()?)?;
        let column = model.column().expect("the template is a column");
        let (last, settling) = steps.split_last().expect("the template has stages");
        for (index, &dt) in settling.iter().enumerate() {
            self.stage(&scene, &mut model, index, dt)?;
        }
        let settled = look(&model)?;
        stages::begin(&mut model, settling.len());
        let unit = (column.height / gravity(&scene)).sqrt();
        self.part(&mut model, *last, time * unit, Vec::new())?;
        Ok([settled, look(&model)?])
    }

    /// Runs a stage and returns the largest energy residual.
    fn stage(&self, scene: &Scene, model: &mut Model, index: usize, dt: f64) -> Result<f64, Failure> {
        stages::begin(model, index);
        match scene.stages[index].end {
            End::For(_) | End::Steady { .. } | End::Packed { .. } => {
                self.part(model, dt, scene.stages[index].end.longest(), Vec::new())
            }
            End::Quiet { kinetic_over_potential, within } => {
                let rested = Arc::new(AtomicBool::new(false));
                let grains = model.member(None).clone();
                let rest = Rest::scheduled(grains, kinetic_over_potential, within.value(), rested);
                self.part(model, dt, within.value(), vec![rest])
            }
        }
    }

    /// Runs for a time \[s\] and returns the largest energy residual.
    fn part(
        &self,
        model: &mut Model,
        dt: f64,
        duration: f64,
        mut observers: Vec<Scheduled>,
    ) -> Result<f64, Failure> {
        model.simulation.begin_segment(dt)?;
        let largest = Arc::new(Mutex::new(0.0));
        if self.ledger {
            let watch = Watch { member: model.member(None).clone(), largest: largest.clone() };
            observers.push(Scheduled::new("residual", Every::Time(LOOK), Box::new(watch)));
        }
        model.simulation.run(duration, &mut observers, &AtomicBool::new(false))?;
        let largest = *largest.lock().expect("the observer does not panic");
        Ok(largest)
    }
}

/// Gravity \[m/s^2\].
fn gravity(scene: &Scene) -> f64 {
    scene.gravity.iter().map(|component| component.value().powi(2)).sum::<f64>().sqrt()
}

/// Remembers the largest energy residual.
struct Watch {
    member: Arc<dyn Member>,
    largest: Arc<Mutex<f64>>,
}

impl Observer for Watch {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let residual = self.member.number(simulation, "energy_residual").unwrap_or(f64::NAN).abs();
        let mut largest = self.largest.lock().expect("only this thread holds it");
        // A residual that is not a number must not get lost in a comparison.
        if residual.is_nan() || residual > *largest {
            *largest = residual;
        }
        Ok(Flow::Continue)
    }
}
