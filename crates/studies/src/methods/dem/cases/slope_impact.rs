//! A pile that is pushed: what physics demands of the push, and what the thesis says of the flow.

mod claims;

use crate::validate::Effort;
use crate::validate::stages;
use crate::validate::{Measure, Rows, Tier};
use granular_core::{D2, Every, Flow, Numbers, Observer, ObserverError, Scheduled, Section, Simulation};
use granular_dem::Dem;
use granular_driver::failure::Failure;
use granular_driver::figures::impact::Impact;
use granular_driver::model::Model;
use granular_driver::parallel;
use granular_driver::records::StageRecord;
use granular_driver::scene_file::SceneText;
use granular_driver::statistics::larger;
use granular_io::Table;
use std::any::Any;
use std::sync::{Arc, Mutex};

/// Place of the stage that begins with the push.
const IMPACT: usize = 2;
/// Numbers that are recorded.
const PROBES: [&str; 4] = ["front", "kinetic_energy", "kinetic_energy_x", "energy_residual"];
/// Simulated time between looks \[s\].
const LOOK: f64 = 2e-3;
/// End of the transient in units of sqrt(H/g): 7.5 sqrt(d/g) of a pile 80 d high.
const TRANSIENT: f64 = 0.84;
/// Speed of a push by speed \[m/s\].
const SPEED: f64 = 0.5;

/// Stiffness of the template \[N/m\], and a step of its impact that closes the energy balance within 0.1 % \[s\].
const STIFFNESS: f64 = 1.6e6;
const STEP: f64 = 1e-6;

/// Disks with which the claims on pushed piles can be judged.
const BEARS: usize = 1000;

/// How much is run.
struct Plan {
    grains: usize,
    seeds: Vec<u64>,
    /// Stiffness of the grains, which the quick form lowers for longer steps \[N/m\].
    stiffness: f64,
    /// Longest duration of a stage; a pile must rest for a twentieth of it \[s\].
    within: f64,
    /// Energies over the potential energy of the pile; the thesis has 10 J to 1000 J for a pile of 103 J.
    energies: Vec<f64>,
}

impl Plan {
    fn of(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self {
                grains: 100,
                seeds: vec![1],
                stiffness: 2e5,
                within: 1.8,
                energies: vec![0.2, 0.6, 2.0, 4.0],
            },
            Effort::Full => Self {
                grains: 1000,
                seeds: vec![1, 2, 3],
                stiffness: STIFFNESS,
                within: 3.0,
                energies: (1..=10).map(|k| 0.1 * f64::from(k)).chain((2..=10).map(f64::from)).collect(),
            },
        }
    }
}

/// A pile at rest.
struct Pile {
    text: SceneText,
    sections: Vec<Section>,
    /// Potential energy \[J/m\].
    potential: f64,
    /// Length over height.
    slenderness: f64,
    rests: bool,
}

/// How strong a push is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Strength {
    /// Energy over the potential energy of the pile.
    Energy(f64),
    /// Speed \[m/s\].
    Speed(f64),
}

/// A push of a pile.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Blow {
    pile: usize,
    strength: Strength,
    profile: &'static str,
    base_friction: f64,
}

/// What came of a push.
struct Struck {
    blow: Blow,
    impact: Impact,
    /// Kinetic energy that the grains gained over that asked for; that of a uniform speed for a push by speed.
    energy: f64,
    /// Momentum that they gained over mass times speed, for a push by speed.
    momentum: f64,
    /// Largest energy residual over potential energy and energy given.
    residual: f64,
    rests: bool,
}

pub(super) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let plan = Plan::of(effort);
    let piles = parallel::each(&plan.seeds, |&seed| Pile::build(&plan, seed))?;
    let usual = |strength| Blow { pile: 0, strength, profile: "Gradient", base_friction: 0.4 };
    let mut blows: Vec<Blow> = plan.energies.iter().map(|&energy| usual(Strength::Energy(energy))).collect();
    let low = usual(Strength::Energy(plan.energies[0]));
    blows.push(Blow { profile: "Uniform", ..low });
    if effort == Effort::Full {
        blows.extend([0.1, 0.2, 0.3].map(|base_friction| Blow { base_friction, ..low }));
    }
    let of_all = |blow: &Blow| (0..piles.len()).map(|pile| Blow { pile, ..*blow }).collect::<Vec<_>>();
    let mut blows: Vec<Blow> = blows.iter().flat_map(of_all).collect();
    blows.push(Blow { profile: "Uniform", ..usual(Strength::Speed(SPEED)) });
    let struck = parallel::each(&blows, |blow| piles[blow.pile].strike(*blow))?;
    required(rows, &plan, &piles, &struck);
    let piles: Vec<f64> = piles.iter().map(|pile| pile.slenderness).collect();
    rows.claims_need(plan.grains, BEARS);
    claims::add(rows, &plan, &piles, &struck);
    Ok(())
}

/// What physics demands.
fn required(rows: &mut Rows, plan: &Plan, piles: &[Pile], struck: &[Struck]) {
    let name = |text: &str| format!("{} disks: {text}", plan.grains);
    let farthest = |of: &dyn Fn(&Struck) -> f64| {
        let all = struck.iter().map(of).filter(|value| !value.is_nan());
        all.max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())).unwrap_or(f64::NAN)
    };
    let energy = farthest(&|one| one.energy);
    let metric = name("kinetic energy gained over that asked for");
    rows.add(
        Measure::absolute(Tier::Identity, metric, energy, 1.0, 1e-12).note("the farthest off of all pushes"),
    );
    let momentum = farthest(&|one| one.momentum);
    let metric = name("momentum gained in a uniform push over mass times speed");
    rows.add(Measure::absolute(Tier::Identity, metric, momentum, 1.0, 1e-12));
    let residual = struck.iter().map(|one| one.residual).fold(0.0, f64::max);
    let metric = name("largest energy residual over potential energy and energy given");
    let residual = Measure::absolute(Tier::Conservation, metric, residual, 0.0, 1e-3);
    rows.add(residual.note(format!("of {} pushes", struck.len())));
    let resting = piles.iter().map(|pile| pile.rests).chain(struck.iter().map(|one| one.rests));
    let count = resting.clone().count() as f64;
    let share = resting.filter(|rests| *rests).count() as f64 / count;
    let metric = name("share of piles that rest before and after the push");
    rows.add(Measure::absolute(Tier::Conservation, metric, share, 1.0, 0.0));
}

impl Pile {
    fn build(plan: &Plan, seed: u64) -> Result<Self, Failure> {
        let edits = [
            stages::asking_for(&PROBES),
            format!("sample.extent=Grains({})", plan.grains),
            format!("sample.seed={seed}"),
            format!("materials.grain.normal_stiffness={}", plan.stiffness),
            format!("stages.1.end.within={}", plan.within),
            format!("stages.{IMPACT}.end.within={}", plan.within),
            format!("stages.{IMPACT}.time_step={}", STEP * (STIFFNESS / plan.stiffness).sqrt()),
        ];
        let text = stages::template("slope-impact", &edits)?;
        let (scene, mut model, steps) = stages::open(&text)?;
        let mut rests = true;
        for (index, &dt) in steps.iter().enumerate().take(IMPACT) {
            stages::begin(&mut model, index);
            rests &= stages::stage(&scene, &mut model, index, dt, Vec::new())?;
        }
        let number = |name| model.number(name).unwrap_or(f64::NAN);
        Ok(Self {
            sections: model.simulation.save(),
            potential: number("potential_energy"),
            slenderness: number("front") / number("height"),
            text,
            rests,
        })
    }

    fn strike(&self, blow: Blow) -> Result<Struck, Failure> {
        let strength = match blow.strength {
            Strength::Energy(share) => format!("energy: {}", share * self.potential),
            Strength::Speed(speed) => format!("speed: {speed}"),
        };
        let mut text = self.text.clone();
        text.set(&format!("stages.{IMPACT}.changes.0=Push({strength}, profile: {})", blow.profile))?;
        text.set(&format!("stages.{IMPACT}.changes.1.value={}", blow.base_friction))?;
        let (scene, mut model, steps) = stages::open(&text)?;
        model.simulation.restore(&self.sections)?;
        let number = |model: &Model, name| model.number(name).unwrap_or(f64::NAN);
        let before = (number(&model, "kinetic_energy"), momentum(&model));
        let push = stages::begin(&mut model, IMPACT);
        let mass = push.map_or(f64::NAN, |push| push.mass);
        let gained = [number(&model, "kinetic_energy") - before.0, momentum(&model) - before.1];
        let record = StageRecord {
            name: scene.stages[IMPACT].name.clone(),
            start: model.simulation.clock().time(),
            front: number(&model, "front"),
            height: number(&model, "height"),
            push,
        };
        let rows = Arc::new(Mutex::new(Vec::new()));
        let recorder = Box::new(Recorder { rows: rows.clone() });
        let recorder = Scheduled::new("rows", Every::Time(LOOK), recorder);
        let rests = stages::stage(&scene, &mut model, IMPACT, steps[IMPACT], vec![recorder])?;
        let rows = std::mem::take(&mut *rows.lock().expect("the observer does not panic"));
        let asked = match blow.strength {
            Strength::Energy(share) => share * self.potential,
            // A little is left of the motion before: the mass moves at the speed beside it.
            Strength::Speed(speed) => 0.5 * mass * speed * speed + speed * before.1,
        };
        let given = asked.abs() + self.potential;
        let largest = rows.iter().map(|row: &Vec<f64>| row[PROBES.len()].abs()).fold(0.0, larger);
        let columns = ["time"].iter().chain(&PROBES).map(|name| ((*name).to_owned(), String::new()));
        let table = Table { columns: columns.collect(), rows };
        let impact = Impact::of(&table, &record, TRANSIENT);
        let impact = impact.ok_or_else(|| Failure::Io("the push moved nothing".to_owned()))?;
        Ok(Struck {
            blow,
            impact,
            energy: gained[0] / asked,
            momentum: match blow.strength {
                Strength::Energy(_) => f64::NAN,
                Strength::Speed(speed) => gained[1] / (mass * speed),
            },
            residual: largest / given,
            rests,
        })
    }
}

/// Momentum along x \[kg/s\].
fn momentum(model: &Model) -> f64 {
    let any: &dyn Any = model.simulation.solver();
    any.downcast_ref::<Dem<D2>>().map_or(f64::NAN, |dem| dem.momentum().x)
}

/// Keeps rows of numbers.
struct Recorder {
    rows: Arc<Mutex<Vec<Vec<f64>>>>,
}

impl Observer for Recorder {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let mut numbers = Numbers::wanting(PROBES);
        simulation.solver().show(&mut numbers);
        let values = PROBES.iter().map(|name| numbers.get(name).unwrap_or(f64::NAN));
        let row = std::iter::once(simulation.clock().time()).chain(values).collect();
        self.rows.lock().expect("only this thread holds it").push(row);
        Ok(Flow::Continue)
    }
}
