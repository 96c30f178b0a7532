//! Columns that collapse in memory, with numbers over time after their release.

use crate::validate::stages;
use granular_core::{Every, Flow, Numbers, Observer, ObserverError, Scheduled, Simulation};
use granular_driver::failure::Failure;
use granular_driver::figures::running_median;
use granular_driver::methods::Member;
use granular_driver::scene_file::SceneText;
use granular_driver::statistics::larger;
use granular_tessellate::FREE_SURFACE;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// Looks in one sqrt(H/g).
const LOOKS: f64 = 20.0;
/// Steps in the shortest contact: enough that the balance of energy closes to a thousandth also in tall columns, where dashpots
/// take most of it.
const STEPS: u32 = 32;

/// A collapse over time.
#[derive(Clone, Debug)]
pub(crate) struct Recorded {
    /// Width of the column \[m\].
    pub(crate) width: f64,
    /// Height of the main mass when the gate opens \[m\].
    pub(crate) height: f64,
    /// Whether all stages before came to the end that they waited for.
    pub(crate) settled: bool,
    names: Vec<String>,
    /// Time after the release in sqrt(H/g), then the numbers.
    rows: Vec<Vec<f64>>,
}

impl Recorded {
    /// Height over width when the gate opens.
    pub(crate) fn aspect_ratio(&self) -> f64 {
        self.height / self.width
    }

    /// Times after the release in units of sqrt(H/g).
    pub(crate) fn times(&self) -> Vec<f64> {
        self.rows.iter().map(|row| row[0]).collect()
    }

    /// A number over time; not a number if it was not recorded.
    pub(crate) fn column(&self, name: &str) -> Vec<f64> {
        let place = self.names.iter().position(|known| known == name);
        self.rows.iter().map(|row| place.map_or(f64::NAN, |place| row[place + 1])).collect()
    }

    /// The last value of a number.
    pub(crate) fn last(&self, name: &str) -> f64 {
        self.column(name).last().copied().unwrap_or(f64::NAN)
    }

    /// `(L - L0) / L0` over time.
    pub(crate) fn run_outs(&self) -> Vec<f64> {
        let fronts: Vec<[f64; 2]> =
            self.times().into_iter().zip(self.column("front")).map(|(time, front)| [time, front]).collect();
        running_median(&fronts).into_iter().map(|[_, front]| (front - self.width) / self.width).collect()
    }

    /// `(L - L0) / L0` at the end.
    pub(crate) fn run_out(&self) -> f64 {
        self.run_outs().last().copied().unwrap_or(f64::NAN)
    }

    /// Largest energy that is missing in the balance since the release, over the potential energy there.
    pub(crate) fn residual(&self) -> f64 {
        let first = |name: &str| self.column(name).first().copied().unwrap_or(f64::NAN);
        let (scale, start) = (first("potential_energy"), first("energy_residual"));
        let residuals =
            self.column("energy_residual").into_iter().map(|residual| ((residual - start) / scale).abs());
        residuals.fold(0.0, larger)
    }
}

/// Runs all stages of a scene, and records numbers from the start of its last stage, at which the gate opens, for so many
/// sqrt(H/g).
///
/// # Errors
/// When the scene is wrong or refused, or the solver gives up.
pub(crate) fn record(text: &SceneText, names: &[&str], until: f64) -> Result<Recorded, Failure> {
    let mut text = text.clone();
    text.set(&stages::asking_for(names))?;
    text.set(&format!("solvers.grains.steps_per_contact={STEPS}"))?;
    let (scene, mut model, steps) = stages::open(&text)?;
    let mut settled = true;
    let last = steps.len() - 1;
    for (index, &dt) in steps[..last].iter().enumerate() {
        stages::begin(&mut model, index);
        settled &= stages::stage(&scene, &mut model, index, dt, Vec::new())?;
    }
    let height = model.number("height").unwrap_or(f64::NAN);
    let gravity = scene.gravity.iter().map(|g| g.value().powi(2)).sum::<f64>().sqrt();
    let unit = (height / gravity).sqrt();
    stages::begin(&mut model, last);
    let rows = Arc::new(Mutex::new(Vec::new()));
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    let member = model.member(None).clone();
    let look = Look { member, names: names.clone(), unit, rows: rows.clone() };
    let mut observers = vec![Scheduled::new("looks", Every::Time(unit / LOOKS), Box::new(look))];
    model.simulation.begin_segment(steps[last])?;
    model.simulation.run(until * unit, &mut observers, &AtomicBool::new(false))?;
    let rows = std::mem::take(&mut *rows.lock().expect("the observer does not panic"));
    let width = model.column().map_or(f64::NAN, |column| column.width);
    Ok(Recorded { width, height, settled, names, rows })
}

struct Look {
    member: Arc<dyn Member>,
    names: Vec<String>,
    unit: f64,
    rows: Arc<Mutex<Vec<Vec<f64>>>>,
}

impl Observer for Look {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let mut numbers = Numbers::wanting(self.names.iter().map(String::as_str));
        self.member.show(simulation, FREE_SURFACE, &mut numbers);
        let mut row = vec![simulation.clock().time_in_segment() / self.unit];
        row.extend(self.names.iter().map(|name| numbers.get(name).unwrap_or(f64::NAN)));
        self.rows.lock().expect("only this thread holds it").push(row);
        Ok(Flow::Continue)
    }
}
