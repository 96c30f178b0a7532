//! Observers of a run: tables, files of fields, rest, and the timer of snapshots.

#[cfg(feature = "hdf5")]
mod hdf5;
mod profile;
mod series;
pub(crate) mod source;
mod tracks;

pub(crate) use profile::Line;

use crate::failure::Failure;
use crate::methods::member::Member;
use crate::methods::parts::Part;
use crate::model::Model;
use crate::scene::{End, EverySpec, Output, Stage, Writer};
use granular_core::{
    Every, Flow, Numbers, Observer, ObserverError, Scheduled, Section, ShownAs, Simulation, SnapshotError,
};
use granular_io::{Collection, write_fields, write_links_vtp};
use series::Series;
use source::Source;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// Makes the observer of an output. On a fresh start its file is created; a resumed run reopens
/// it when its state is restored.
pub(crate) fn of_output(
    output: &Output,
    folder: &Path,
    model: &Model,
    fresh: bool,
) -> Result<Scheduled, Failure> {
    let (member, simulation) = (model.member(output.of.as_deref()), &model.simulation);
    let every = match output.every {
        EverySpec::Time(time) => Every::Time(time.value()),
        EverySpec::Steps(steps) => Every::Steps(steps),
    };
    let path = folder.join(output.write.path());
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(|error| Failure::io(parent.display(), error))?;
    }
    let free_surface = output.write.free_surface();
    let source = Source::of(&output.write, member.clone(), simulation);
    let observer: Box<dyn Observer> = match &output.write {
        Writer::Table { probes, .. } => {
            Box::new(TableObserver::new(path, (member.clone(), simulation), probes, free_surface, fresh)?)
        }
        Writer::Fields { fields, .. } => Box::new(FilesObserver::new(path, source, fields, false, fresh)?),
        Writer::Contacts { fields, .. } => Box::new(FilesObserver::new(path, source, fields, true, fresh)?),
        Writer::Profile { from, to, points, fields, .. } => {
            let line = profile::Line::of(from, to, *points);
            Box::new(profile::ProfileObserver::new(path, (line, source), fields, simulation, fresh)?)
        }
        Writer::Tracks { grains, fields, .. } => {
            let source = (member.clone(), simulation);
            Box::new(tracks::TracksObserver::new(path, source, grains, fields, fresh)?)
        }
        #[cfg(feature = "hdf5")]
        Writer::Hdf5 { fields, .. } => {
            Box::new(hdf5::Hdf5Observer::new(&path, source, fields, simulation, fresh)?)
        }
        #[cfg(not(feature = "hdf5"))]
        Writer::Hdf5 { path, .. } => {
            let reason = "this program was built without the cargo feature `hdf5`; use Fields instead";
            return Err(Failure::Scene(vec![crate::scene_file::SceneProblem::of_file(path.clone(), reason)]));
        }
    };
    Ok(Scheduled::new(format!("output {}", output.write.path()), every, observer))
}

/// One row of numbers per look.
struct TableObserver {
    series: Series,
    member: Arc<dyn Member>,
    probes: Vec<String>,
    free_surface: f64,
}

impl TableObserver {
    fn new(
        path: PathBuf,
        (member, simulation): (Arc<dyn Member>, &Simulation),
        probes: &[String],
        free_surface: f64,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let shown = member.shown(simulation);
        let unit = |name: &str| {
            let found = shown.iter().find(|s| s.kind == ShownAs::Number && s.name == name);
            found.map_or("1", |shown| shown.unit).to_owned()
        };
        let mut columns = vec![("time".to_owned(), "s".to_owned())];
        columns.extend(probes.iter().map(|name| (name.clone(), unit(name))));
        let series = Series::new(path, columns, fresh)?;
        Ok(Self { series, member, probes: probes.to_vec(), free_surface })
    }
}

impl Observer for TableObserver {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let mut numbers = Numbers::wanting(self.probes.iter().map(String::as_str));
        self.member.show(simulation, self.free_surface, &mut numbers);
        let mut row = vec![simulation.clock().time()];
        row.extend(self.probes.iter().map(|name| numbers.get(name).unwrap_or(f64::NAN)));
        self.series.row(&row)?;
        self.series.looked_at(simulation);
        Ok(Flow::Continue)
    }

    fn finish(&mut self, simulation: &Simulation) -> Result<(), ObserverError> {
        if self.series.lacks(simulation) {
            self.observe(simulation)?;
        }
        self.series.sync()
    }

    fn save(&self, to: &mut Section) {
        self.series.save(to);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.series.restore(from)
    }
}

/// The list of frames of this name, which may hold a dot.
fn list_of(stem: &Path) -> PathBuf {
    let mut name = stem.as_os_str().to_owned();
    name.push(".pvd");
    PathBuf::from(name)
}

/// One file per look, listed in a `.pvd`.
struct FilesObserver {
    stem: PathBuf,
    source: Source,
    names: Vec<String>,
    links: bool,
    collection: Option<Collection>,
}

impl FilesObserver {
    fn new(
        stem: PathBuf,
        source: Source,
        names: &[String],
        links: bool,
        fresh: bool,
    ) -> Result<Self, Failure> {
        let collection = if fresh { Some(Collection::create(&list_of(&stem))?) } else { None };
        Ok(Self { stem, source, names: names.to_vec(), links, collection })
    }
}

impl Observer for FilesObserver {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let Some(collection) = &mut self.collection else { return Ok(Flow::Continue) };
        let frame = self.source.frame(&self.names, simulation);
        let (time, location) = (simulation.clock().time(), self.source.location(simulation));
        let name = self.stem.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let folder = self.stem.parent().unwrap_or(Path::new("."));
        let numbered = format!("{name}_{:06}", collection.len());
        let file = if self.links {
            let file = folder.join(format!("{numbered}.vtp"));
            write_links_vtp(&file, &location, &frame, time)?;
            file
        } else {
            write_fields(folder, &numbered, &location, &frame, time)?
        };
        let entry = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        collection.push(time, &entry)?;
        Ok(Flow::Continue)
    }

    fn save(&self, to: &mut Section) {
        to.put_one("files", self.collection.as_ref().map_or(0, Collection::len) as u64);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let files: u64 = from.one("files")?;
        self.collection = Some(Collection::reopen_at(&list_of(&self.stem), files as usize)?);
        Ok(())
    }
}

/// The observer that ends a stage, unless its time alone does; it raises the flag.
pub fn of_end(stage: &Stage, model: &Model, reached: &Arc<AtomicBool>) -> Option<Scheduled> {
    let reached = reached.clone();
    let sample = model.members.iter().find(|member| member.offers(Part::Quiet));
    let member = match &stage.of {
        None if !matches!(stage.end, End::Steady { .. }) => sample.unwrap_or(&model.members[0]),
        of => model.member(of.as_deref()),
    };
    let member = member.clone();
    Some(match stage.end {
        End::For(_) => return None,
        End::Quiet { kinetic_over_potential, within } => {
            Rest::scheduled(member, kinetic_over_potential, within.value(), reached)
        }
        End::Packed { solid_fraction, within } => {
            Packed::scheduled(member, solid_fraction, within.value(), reached)
        }
        End::Steady { change, within } => Steady::scheduled(member, change, within.value(), reached),
    })
}

/// Name of the observer that ends a stage.
pub(crate) const END_OF_STAGE: &str = "end of stage";

/// Ends a stage when the flow changes little.
pub(crate) struct Steady {
    member: Arc<dyn Member>,
    change: f64,
    /// Kinetic energy at the look before \[J\].
    before: f64,
    reached: Arc<AtomicBool>,
}

impl Steady {
    /// Watches from the start of a stage; raises the flag when it ends it.
    pub(crate) fn scheduled(
        member: Arc<dyn Member>,
        change: f64,
        within: f64,
        reached: Arc<AtomicBool>,
    ) -> Scheduled {
        let steady = Self { member, change, before: f64::NAN, reached };
        Scheduled::new(END_OF_STAGE, Every::Time(PATIENCE * within), Box::new(steady))
    }
}

impl Observer for Steady {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let energy = self.member.number(simulation, "kinetic_energy").unwrap_or(f64::NAN);
        let before = std::mem::replace(&mut self.before, energy);
        // Not a number before the second look; a fluid at rest has no energy to change yet.
        if energy > 0.0 && (energy - before).abs() < self.change * energy {
            self.reached.store(true, Ordering::Relaxed);
            return Ok(Flow::Stop);
        }
        Ok(Flow::Continue)
    }

    fn save(&self, to: &mut Section) {
        to.put_one("before", self.before);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.before = from.one("before")?;
        Ok(())
    }
}

/// Ends a stage when the grains have been at rest for a while.
pub struct Rest {
    member: Arc<dyn Member>,
    threshold: f64,
    /// Time that motion must stay below the threshold \[s\].
    patience: f64,
    loud: f64,
    reached: Arc<AtomicBool>,
}

/// Share of the longest time of a stage during which grains must stay at rest.
const PATIENCE: f64 = 0.05;
/// Looks within the patience.
const LOOKS: f64 = 20.0;

impl Rest {
    /// Watches from the start of a stage; raises the flag when it ends it.
    pub fn scheduled(
        member: Arc<dyn Member>,
        threshold: f64,
        within: f64,
        reached: Arc<AtomicBool>,
    ) -> Scheduled {
        let patience = PATIENCE * within;
        let rest = Self { member, threshold, patience, loud: 0.0, reached };
        Scheduled::new(END_OF_STAGE, Every::Time(patience / LOOKS), Box::new(rest))
    }
}

impl Observer for Rest {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let mut numbers = Numbers::wanting(["kinetic_energy", "rotational_energy", "potential_energy"]);
        self.member.solver(simulation).show(&mut numbers);
        let get = |name| numbers.get(name).unwrap_or(0.0);
        let moving = get("kinetic_energy") + get("rotational_energy");
        let now = simulation.clock().time_in_segment();
        if moving > self.threshold * get("potential_energy").abs() {
            self.loud = now;
        }
        if now - self.loud < self.patience {
            return Ok(Flow::Continue);
        }
        self.reached.store(true, Ordering::Relaxed);
        Ok(Flow::Stop)
    }

    fn save(&self, to: &mut Section) {
        to.put_one("loud", self.loud);
    }

    fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        self.loud = from.one("loud")?;
        Ok(())
    }
}

/// Looks within the longest time of a stage that ends by density.
const DENSITY_LOOKS: f64 = 400.0;

/// Ends a stage when the grains are packed densely enough.
pub struct Packed {
    member: Arc<dyn Member>,
    solid_fraction: f64,
    reached: Arc<AtomicBool>,
}

impl Packed {
    /// Watches from the start of a stage; raises the flag when it ends it.
    pub fn scheduled(
        member: Arc<dyn Member>,
        solid_fraction: f64,
        within: f64,
        reached: Arc<AtomicBool>,
    ) -> Scheduled {
        let packed = Self { member, solid_fraction, reached };
        Scheduled::new(END_OF_STAGE, Every::Time(within / DENSITY_LOOKS), Box::new(packed))
    }
}

impl Observer for Packed {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        if self.member.number(simulation, "solid_fraction").is_some_and(|found| found >= self.solid_fraction)
        {
            self.reached.store(true, Ordering::Relaxed);
            return Ok(Flow::Stop);
        }
        Ok(Flow::Continue)
    }
}

/// Ends a run of which nothing is left to see.
pub(crate) struct Gone {
    member: Arc<dyn Member>,
    reason: Arc<OnceLock<String>>,
}

/// Steps between looks.
const GONE_STEPS: u64 = 1000;

impl Gone {
    /// Watches from now on; tells the reason when it ends the run.
    pub(crate) fn scheduled(member: Arc<dyn Member>, reason: Arc<OnceLock<String>>) -> Scheduled {
        Scheduled::new("grains gone", Every::Steps(GONE_STEPS), Box::new(Self { member, reason }))
    }
}

impl Observer for Gone {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        match self.member.why_gone(simulation) {
            Some(reason) => {
                self.reason.get_or_init(|| reason);
                Ok(Flow::Stop)
            }
            None => Ok(Flow::Continue),
        }
    }
}

/// Stops the run loop when a snapshot is due; the loop takes it and goes on.
pub(crate) struct SnapshotTimer {
    /// Step of the snapshot before, or of the start: there must be something new to save, or a
    /// short interval would stop the loop for ever.
    before: u64,
}

impl SnapshotTimer {
    pub(crate) fn scheduled(interval: Duration, before: u64) -> Scheduled {
        Scheduled::new("snapshot timer", Every::Wall(interval), Box::new(Self { before }))
    }
}

impl Observer for SnapshotTimer {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let new = simulation.clock().step() > self.before;
        Ok(if new { Flow::Stop } else { Flow::Continue })
    }
}
