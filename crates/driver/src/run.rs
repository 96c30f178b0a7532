//! Running a scene, stage by stage, and taking an interrupted run up again.

mod several;

use crate::check;
use crate::failure::Failure;
use crate::figures::Drawn;
use crate::folder::{PROGRAM, RunFolder, provenance};
use crate::model::{self, Model};
use crate::observers::{self, END_OF_STAGE, Gone, SnapshotTimer};
use crate::progress;
use crate::records::{RecordedStage, Seen};
use crate::scene::{End, Scene};
use crate::scene_file::SceneText;
use granular_core::simulation::find_section;
use granular_core::{Ending, Limits, Scheduled, Section, Simulation};
use granular_io::{SnapshotStore, hash_hex, simulation_hash};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Raised by a signal; holds its number.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    /// Whether to stop.
    pub raised: Arc<AtomicBool>,
    /// Number of the signal.
    pub signal: Arc<AtomicUsize>,
    /// Runs that take steps and save their state when they are told to stop. With none, the process may end at
    /// once: what is on the disk can be resumed or started again.
    pub stepping: Arc<AtomicUsize>,
}

/// Counts a run that takes steps, as long as it lives.
#[derive(Debug)]
struct Stepping(Arc<AtomicUsize>);

impl Stepping {
    fn count(interrupt: &Interrupt) -> Self {
        interrupt.stepping.fetch_add(1, Ordering::SeqCst);
        Self(interrupt.stepping.clone())
    }
}

impl Drop for Stepping {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

/// A run under way.
struct Session<'a> {
    scene: &'a Scene,
    /// The scene as it stands in the folder; snapshots hold it, so that they are known from those
    /// of other scenes.
    text: String,
    model: Model,
    folder: RunFolder,
    store: SnapshotStore,
    outputs: Vec<Scheduled>,
    records: Vec<RecordedStage>,
    steps: Vec<f64>,
    /// Limits at the start, as they stand in `run.json`.
    limits: Vec<Value>,
    interrupt: &'a Interrupt,
    /// While steps are taken.
    stepping: Option<Stepping>,
    quiet: bool,
    begun: Instant,
    first_step: u64,
    /// Why the run ended when nothing was left to see.
    gone: Arc<OnceLock<String>>,
    /// What came of the figures, once the stages are over.
    figures: Drawn,
    /// State of the observer that ends a stage, when a resumed run was within a stage that waits for it.
    watcher: Option<Section>,
}

/// Runs a scene in a new folder. Solvers that nothing joins run one after the other, each in a folder of its own within it.
///
/// # Errors
/// When the scene is wrong or refused, a guard stops it, something cannot be written, or the run
/// is interrupted.
pub fn run(
    text: &SceneText,
    out: &Path,
    force: bool,
    quiet: bool,
    interrupt: &Interrupt,
) -> Result<Value, Failure> {
    match crate::parts::of(text)?.as_slice() {
        [_] => run_one(text, (out, force), quiet, interrupt),
        _ => several::run(text, (out, force), quiet, interrupt),
    }
}

/// Runs a scene whose solvers share a simulation.
fn run_one(
    text: &SceneText,
    (out, force): (&Path, bool),
    quiet: bool,
    interrupt: &Interrupt,
) -> Result<Value, Failure> {
    let (scene, model) = check::read_to_run(text)?;
    let (limits, steps, problems) = check::limits_of(&scene, &model);
    if !problems.is_empty() {
        return Err(check::refusal(text.name(), &problems));
    }
    let mut text = text.clone();
    // The folder holds all that the run needs.
    let files = scene.take_files(&mut text)?;
    let folder = RunFolder::create(out, text.text(), &files, force)?;
    Session::new(&scene, model, folder, (limits, steps), interrupt, quiet, true)?.start()
}

/// Takes the run in a folder up again from its newest snapshot.
///
/// # Errors
/// As [`run`], and when no snapshot can be read.
pub fn resume(out: &Path, quiet: bool, interrupt: &Interrupt) -> Result<Value, Failure> {
    let folder = RunFolder::take_up(out)?;
    let text = SceneText::read(folder.scene_path())?;
    if folder.facts()?["exit"] == "done" {
        return Err(Failure::io(out.display(), "this run is done; there is nothing to resume"));
    }
    match crate::parts::of(&text)?.as_slice() {
        [_] => resume_in(folder, &text, quiet, interrupt),
        _ => several::go_on(&folder, quiet, interrupt),
    }
}

/// Takes up the run of a scene whose solvers share a simulation.
fn resume_one(out: &Path, quiet: bool, interrupt: &Interrupt) -> Result<Value, Failure> {
    let folder = RunFolder::take_up(out)?;
    let text = SceneText::read(folder.scene_path())?;
    resume_in(folder, &text, quiet, interrupt)
}

fn resume_in(
    folder: RunFolder,
    text: &SceneText,
    quiet: bool,
    interrupt: &Interrupt,
) -> Result<Value, Failure> {
    let (scene, model) = check::read(text)?;
    let (limits, steps, _) = check::limits_of(&scene, &model);
    if !folder.has_snapshots() {
        if !quiet {
            progress::say(format_args!("no snapshot was taken yet: the run starts again"));
        }
        return Session::new(&scene, model, folder, (limits, steps), interrupt, quiet, true)?.start();
    }
    let latest = folder.snapshots().latest()?;
    for warning in &latest.warnings {
        progress::say(format_args!("warning: {warning}; an older snapshot is used"));
    }
    let mut session = Session::new(&scene, model, folder, (limits, steps), interrupt, quiet, false)?;
    let stage = session
        .restore(&latest.sections)
        .map_err(|failure| failure.with_context(format_args!("resuming from {}", latest.path.display())))?;
    if !quiet {
        let clock = session.model.simulation.clock();
        progress::say(format_args!("resuming at {:.6} s, step {}", clock.time(), clock.step()));
    }
    session.write_facts(("running", None), None)?;
    session.finish_run(stage, true)
}

/// Draws the figures of a run again.
///
/// # Errors
/// When the folder is none of a run, or a figure cannot be written. Those that have nothing to show are in the result.
pub fn plot(out: &Path) -> Result<Drawn, Failure> {
    let folder = RunFolder::open(out)?;
    let text = SceneText::read(folder.scene_path())?;
    let parts = crate::parts::of(&text)?;
    if parts.len() > 1 {
        return several::plot(&folder, &parts);
    }
    let (scene, model) = check::read(&text)?;
    let records: Vec<RecordedStage> = serde_json::from_value(folder.facts()?["stages"].clone())
        .map_err(|error| Failure::io(out.display(), format!("run.json has no stages: {error}")))?;
    crate::figures::draw(&scene, &folder, &records, model.column())
}

impl<'a> Session<'a> {
    fn new(
        scene: &'a Scene,
        model: Model,
        folder: RunFolder,
        (limits, steps): (Limits, Vec<f64>),
        interrupt: &'a Interrupt,
        quiet: bool,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let outputs = scene.outputs.iter();
        let outputs = outputs.map(|output| observers::of_output(output, folder.path(), &model, fresh));
        Ok(Self {
            scene,
            text: SceneText::read(folder.scene_path())?.text().to_owned(),
            outputs: outputs.collect::<Result<_, _>>()?,
            store: folder.snapshots(),
            first_step: 0,
            gone: Arc::default(),
            figures: Drawn::default(),
            watcher: None,
            begun: Instant::now(),
            records: Vec::new(),
            model,
            folder,
            limits: check::limits_to_json(&limits, &steps),
            steps,
            interrupt,
            stepping: None,
            quiet,
        })
    }

    /// Runs all stages from the first step on.
    fn start(&mut self) -> Result<Value, Failure> {
        let snapshots = self.store.folder();
        std::fs::create_dir_all(snapshots).map_err(|error| Failure::io(snapshots.display(), error))?;
        self.write_facts(("running", None), None)?;
        self.finish_run(0, false)
    }

    /// Runs all stages from `first` on and writes what is known at the end. `under_way` when the
    /// first stage was begun before.
    fn finish_run(&mut self, first: usize, under_way: bool) -> Result<Value, Failure> {
        self.first_step = self.model.simulation.clock().step();
        self.stepping = Some(Stepping::count(self.interrupt));
        let result = (first..self.scene.stages.len())
            .try_for_each(|stage| self.stage(stage, under_way && stage == first))
            .and_then(|()| self.close())
            .and_then(|()| self.write_facts(("done", None), Some(self.folder.checksums()?)));
        result.map_err(|failure| {
            let exit = if let Failure::Interrupted { .. } = failure { "interrupted" } else { "failed" };
            // The failure itself matters more than a folder that cannot be written.
            let _ = self.write_facts((exit, Some(&failure)), None);
            match failure {
                Failure::Io(reason) => {
                    let path = self.folder.path().display();
                    Failure::Io(format!(
                        "{reason}\n  = help: when that is fixed, continue with `granular resume {path}`"
                    ))
                }
                other => other,
            }
        })
    }

    fn close(&mut self) -> Result<(), Failure> {
        for output in &mut self.outputs {
            output.finish(&self.model.simulation).map_err(granular_core::RunError::from)?;
        }
        self.save(self.scene.stages.len())?;
        self.stepping = None;
        // The run is done also when a figure has nothing to show: to resume it would change nothing.
        self.figures = crate::figures::draw(self.scene, &self.folder, &self.records, self.model.column())?;
        let told = self.figures.failed.iter().chain(self.figures.left_out.iter().filter(|_| !self.quiet));
        told.for_each(|warning| progress::say(format_args!("warning: {warning}")));
        Ok(())
    }

    fn stage(&mut self, index: usize, under_way: bool) -> Result<(), Failure> {
        let stage = &self.scene.stages[index];
        if !under_way {
            self.begin_stage(index)?;
        }
        let longest = stage.end.longest();
        let quiet_flag = match stage.end {
            End::For(_) => None,
            End::Quiet { .. } | End::Steady { .. } | End::Packed { .. } => {
                Some(Arc::new(AtomicBool::new(false)))
            }
        };
        let mut extra = self.stage_observers(index, longest, quiet_flag.as_ref())?;
        let ended = loop {
            let mut observers: Vec<Scheduled> = self.outputs.drain(..).chain(extra.drain(..)).collect();
            let ending = self.model.simulation.run(longest, &mut observers, &self.interrupt.raised);
            extra = observers.split_off(self.scene.outputs.len());
            self.outputs = observers;
            match ending.map_err(|error| self.explain(error))? {
                Ending::Interrupted => {
                    self.save_with(index, &extra)?;
                    finish_all(&mut extra, &self.model.simulation)?;
                    return Err(self.interrupted());
                }
                // Rest goes first: whether a snapshot is due at the same step is a matter of the
                // wall clock, and must not decide how long the stage lasts.
                Ending::Stopped if quiet_flag.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) => {
                    break match stage.end {
                        End::Steady { .. } => "steady",
                        End::Packed { .. } => "packed",
                        _ => "at rest",
                    };
                }
                Ending::Stopped if self.gone.get().is_some() => {
                    self.save_with(index, &extra)?;
                    finish_all(&mut extra, &self.model.simulation)?;
                    return Err(self.all_gone());
                }
                Ending::Stopped => {
                    self.save_with(index, &extra)?;
                    // The interval counts from the end of the save: a slow disk must not make
                    // the next snapshot due at once.
                    extra[0] = self.snapshot_timer();
                }
                Ending::Finished if quiet_flag.is_some() => {
                    break match stage.end {
                        End::Steady { .. } => "not steady within the time",
                        End::Packed { .. } => "not packed within the time",
                        _ => "not at rest within the time",
                    };
                }
                Ending::Finished => break "time",
            }
        };
        finish_all(&mut extra, &self.model.simulation)?;
        if let Some(path) = &stage.save {
            model::save_sample(self.scene, &self.model, &self.folder.path().join(path))?;
        }
        self.end_stage(ended);
        Ok(())
    }

    fn begin_stage(&mut self, index: usize) -> Result<(), Failure> {
        let notes = self.model.begin(index);
        self.model.simulation.begin_segment(self.steps[index])?;
        let Model { simulation, members, .. } = &self.model;
        let seen = members.iter().zip(notes).map(|(member, (name, notes))| {
            let number = |name| member.number(simulation, name).unwrap_or(f64::NAN);
            (name, Seen { front: number("front"), height: number("height"), push: notes.push })
        });
        self.records.push(RecordedStage {
            name: self.scene.stages[index].name.clone(),
            start: simulation.clock().time(),
            end: None,
            dt: self.steps[index],
            ended: None,
            solvers: seen.collect(),
        });
        self.save(index)
    }

    fn stage_observers(
        &mut self,
        index: usize,
        longest: f64,
        quiet_flag: Option<&Arc<AtomicBool>>,
    ) -> Result<Vec<Scheduled>, Failure> {
        let mut extra = vec![self.snapshot_timer()];
        let watcher =
            quiet_flag.and_then(|flag| observers::of_end(&self.scene.stages[index], &self.model, flag));
        if let Some(mut watcher) = watcher {
            if let Some(saved) = self.watcher.take() {
                watcher.restore(&saved)?;
            }
            extra.push(watcher);
        }
        for member in self.model.members.iter().filter(|member| member.may_be_gone(&self.model.simulation)) {
            extra.push(Gone::scheduled(member.clone(), self.gone.clone()));
        }
        if !self.quiet {
            let name =
                format!("{} ({}/{})", self.scene.stages[index].name, index + 1, self.scene.stages.len());
            let end = self.records.last().map_or(0.0, |record| record.start) + longest;
            let clock = self.model.simulation.clock();
            let from = (clock.step(), clock.time());
            extra.push(progress::scheduled(
                progress::StageLine { name, end, from },
                self.model.members.clone(),
            ));
        }
        Ok(extra)
    }

    fn snapshot_timer(&self) -> Scheduled {
        let interval = Duration::try_from_secs_f64(self.scene.snapshot_every.value());
        let step = self.model.simulation.clock().step();
        SnapshotTimer::scheduled(interval.unwrap_or(Duration::MAX), step)
    }

    fn end_stage(&mut self, ended: &str) {
        let time = self.model.simulation.clock().time();
        if let Some(record) = self.records.last_mut() {
            record.end = Some(time);
            record.ended = Some(ended.to_owned());
            if !self.quiet {
                let (name, start) = (&record.name, record.start);
                progress::say(format_args!("{name}: {start:.6} s to {time:.6} s ({ended})"));
            }
        }
    }

    /// What to say when the run loop fails.
    fn explain(&self, error: granular_core::RunError) -> Failure {
        match Failure::from(error) {
            Failure::Stopped { reason, hint } => {
                let last = format!("the last good snapshot is in {}", self.store.folder().display());
                Failure::Stopped { reason, hint: format!("{hint}; {last}") }
            }
            other => other,
        }
    }

    /// What to say when there is nothing left to see.
    fn all_gone(&self) -> Failure {
        let reason = self.gone.get().cloned().unwrap_or_default();
        let folder = self.folder.path().display();
        let hint = format!("add a wall below the grains, such as Floor; what was seen so far is in {folder}");
        Failure::Stopped { reason, hint }
    }

    fn interrupted(&self) -> Failure {
        let hint = format!("continue with `granular resume {}`", self.folder.path().display());
        Failure::Interrupted { signal: self.interrupt.signal.load(Ordering::Relaxed), hint }
    }
}

fn finish_all(observers: &mut [Scheduled], simulation: &Simulation) -> Result<(), Failure> {
    for observer in observers {
        observer.finish(simulation).map_err(granular_core::RunError::from)?;
    }
    Ok(())
}

/// Snapshots.
impl Session<'_> {
    fn save(&mut self, stage: usize) -> Result<(), Failure> {
        self.save_with(stage, &[])
    }

    /// Saves clock, solvers, outputs, the observer that ends the stage, and which stage is under way.
    fn save_with(&mut self, stage: usize, extra: &[Scheduled]) -> Result<(), Failure> {
        let mut sections = self.model.simulation.save();
        let mut run = Section::new("run");
        run.put_one("stage", stage as u64);
        run.put_text("records", &serde_json::to_string(&self.records).expect("records can be written"));
        run.put_text("version", env!("CARGO_PKG_VERSION"));
        run.put_text("scene", &self.text);
        sections.push(run);
        sections.extend(self.outputs.iter().map(Scheduled::save));
        sections.extend(extra.iter().filter(|observer| observer.name() == END_OF_STAGE).map(Scheduled::save));
        self.store.save(self.model.simulation.clock().step(), &sections)?;
        Ok(())
    }

    /// Restores everything; returns the stage under way.
    fn restore(&mut self, sections: &[Section]) -> Result<usize, Failure> {
        let run = find_section(sections, "run")?;
        let version = run.text("version")?;
        if version != env!("CARGO_PKG_VERSION") {
            return Err(Failure::Io(format!(
                "the snapshot is of version {version}, this program of version {}; resume with that version",
                env!("CARGO_PKG_VERSION")
            )));
        }
        if run.text("scene")? != self.text {
            return Err(Failure::Io(format!(
                "section `run/scene` of the snapshot differs from {}: the snapshot is of another scene; put that \
                 scene back, or start a new run",
                self.folder.scene_path().display()
            )));
        }
        self.model.simulation.restore(sections)?;
        for output in &mut self.outputs {
            output.restore(find_section(sections, &format!("observer {}", output.name()))?)?;
        }
        self.records = serde_json::from_str(&run.text("records")?)
            .map_err(|error| Failure::Io(format!("section `run/records` of the snapshot: {error}")))?;
        let name = format!("observer {END_OF_STAGE}");
        self.watcher = sections.iter().find(|section| section.name() == name).cloned();
        Ok(run.one::<u64>("stage")? as usize)
    }

    /// Writes `run.json`: how far the run is, and what it failed of if it did.
    fn write_facts(
        &self,
        (exit, failure): (&str, Option<&Failure>),
        checksums: Option<Value>,
    ) -> Result<Value, Failure> {
        let simulation = &self.model.simulation;
        let (clock, wall) = (simulation.clock(), self.begun.elapsed().as_secs_f64());
        let steps = clock.step() - self.first_step;
        let metrics = crate::figures::metrics(self.scene, &self.model, (&self.folder, &self.records));
        let values = metrics.iter().map(|metric| (metric.name.clone(), json!(metric.value)));
        let units = metrics.iter().map(|metric| (metric.name.clone(), json!(metric.unit)));
        let first = self.model.member(None).solver(simulation);
        let members = self.model.members.iter();
        let solvers =
            members.map(|member| (member.name().to_owned(), json!(member.solver(simulation).name())));
        let sizes = self.model.members.iter().map(|member| {
            let (count, item) = member.solver(simulation).size();
            (member.name().to_owned(), json!({ "count": count, "item": item }))
        });
        let facts = json!({
            "program": PROGRAM,
            "scene": self.folder.scene_path().display().to_string(),
            "solver": first.name(),
            "solvers": solvers.collect::<serde_json::Map<_, _>>(),
            "exit": exit,
            "code": failure.map(Failure::code),
            "reason": failure.map(Failure::to_string),
            "simulated_seconds": clock.time(),
            "steps": clock.step(),
            "wall_seconds": wall,
            "sizes": sizes.collect::<serde_json::Map<_, _>>(),
            "item": first.size().1,
            "rate": steps as f64 * first.size().0 as f64 / wall,
            "state_hash": hash_hex(simulation_hash(simulation)),
            "metrics": Value::Object(values.collect()),
            "units": Value::Object(units.collect()),
            "limits": self.limits,
            "stages": self.records,
            "figures": self.figures.to_json(),
            "built": provenance(),
            "checksums": checksums.unwrap_or(Value::Null),
        });
        self.folder.set_facts(&facts)?;
        Ok(facts)
    }
}
