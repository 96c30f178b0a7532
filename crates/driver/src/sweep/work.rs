//! Working through a grid.

use super::{Plan, State, lock_path, state};
use crate::failure::Failure;
use crate::lock::Lock;
use crate::machine::most_threads;
use crate::progress::{duration, runs, say};
use crate::run::{self, Interrupt};
use crate::scene_file::SceneProblem;
use indicatif::ProgressBar;
use serde_json::Value;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// How often the table is collected while runs are under way.
const COLLECTS_EVERY: Duration = Duration::from_secs(10);

/// How a sweep is worked through.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// Runs at the same time, each with its share of the threads.
    pub jobs: usize,
    /// Whether runs that failed before are tried again.
    pub retry: bool,
    /// The only run to work on, counted from 0; no table is collected then.
    pub only: Option<usize>,
    /// Whether to say nothing but results and errors.
    pub quiet: bool,
}

impl Default for Work {
    /// All runs, one at a time.
    fn default() -> Self {
        Self { jobs: 1, retry: false, only: None, quiet: true }
    }
}

/// What came of a sweep.
#[derive(Debug)]
pub struct Outcome {
    /// The list of runs, as in `sweep.json`.
    pub report: Value,
    /// The runs that failed, now or before, as one failure.
    pub failure: Option<Failure>,
}

impl Plan {
    /// Works through the grid and collects the table.
    ///
    /// # Errors
    /// When the sweep was interrupted, or a file cannot be written. The table holds what is done in
    /// any case.
    pub fn work(&self, out: &Path, work: Work, interrupt: &Interrupt) -> Result<Outcome, Failure> {
        self.refuse_folder(out)?;
        let chosen = self.chosen(work.only)?;
        std::fs::create_dir_all(out).map_err(|error| Failure::io(out.display(), error))?;
        let result = self.run_all(out, &chosen, work, interrupt);
        // What is done is worth a table, whatever came after. Tasks that work on one run each would
        // all write the same file.
        let report = if work.only.is_none() { self.collect(out)? } else { self.report(out)? };
        result?;
        if interrupt.raised.load(Ordering::Relaxed) {
            let signal = interrupt.signal.load(Ordering::Relaxed);
            return Err(Failure::Interrupted { signal, hint: "continue with the same command".to_owned() });
        }
        Ok(Outcome { report, failure: self.verdict(out, &chosen)? })
    }

    pub(super) fn refuse_folder(&self, out: &Path) -> Result<(), Failure> {
        if out.join("run.json").exists() {
            let reason = "holds a run, so a sweep leaves it alone; choose another folder with --out";
            return Err(Failure::io(out.display(), reason));
        }
        Ok(())
    }

    fn chosen(&self, only: Option<usize>) -> Result<Vec<usize>, Failure> {
        let count = self.points.len();
        match only {
            Some(only) if only >= count => {
                let message = format!("there is no run {only}; allowed: 0 to {}", count - 1);
                Err(SceneProblem::of_file("--only", message).into())
            }
            Some(only) => Ok(vec![only]),
            None => Ok((0..count).collect()),
        }
    }

    fn report(&self, out: &Path) -> Result<Value, Failure> {
        let states = self.points.iter().map(|point| State::of(out, &point.folder));
        Ok(self.list(states.collect::<Result<Vec<_>, _>>()?.into_iter()))
    }

    /// Runs what is to be run, several at a time.
    fn run_all(
        &self,
        out: &Path,
        chosen: &[usize],
        work: Work,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let mut waiting = Vec::new();
        for &index in chosen {
            if State::of(out, &self.points[index].folder)?.is_to_run(work.retry) {
                waiting.push(index);
            }
        }
        if !work.quiet && waiting.len() < chosen.len() {
            let (left_alone, all) = (chosen.len() - waiting.len(), chosen.len());
            say(format_args!("{left_alone} of {all} runs are done or failed before and are left alone"));
        }
        let jobs = work.jobs.clamp(1, waiting.len().max(1)).min(most_threads());
        let threads = (rayon::current_num_threads() / jobs).max(1);
        let (next, troubles) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let collected = Mutex::new(Instant::now());
        let bar = if work.quiet || waiting.len() < 2 { ProgressBar::hidden() } else { runs(waiting.len()) };
        // The time left changes also while no run ends.
        bar.enable_steady_tick(Duration::from_millis(500));
        let worker = || {
            while !interrupt.raised.load(Ordering::Relaxed) {
                let Some(&index) = waiting.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
                let one = One { plan: self, out, index, work, alone: jobs == 1 };
                let done = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                    Ok(pool) => {
                        pool.install(|| one.run(interrupt)).and_then(|()| self.refresh(out, work, &collected))
                    }
                    Err(error) => Err(Failure::io("threads", error)),
                };
                bar.inc(1);
                if let Err(trouble) = done {
                    // The others would meet it too.
                    next.store(waiting.len(), Ordering::Relaxed);
                    troubles.lock().expect("no holder panics").push(trouble);
                }
            }
        };
        std::thread::scope(|scope| (0..jobs).for_each(|_| _ = scope.spawn(worker)));
        bar.finish_and_clear();
        troubles.into_inner().expect("no holder panics").into_iter().next().map_or(Ok(()), Err)
    }

    /// Collects the table when that was long ago, so that a long sweep shows what is done so far.
    fn refresh(&self, out: &Path, work: Work, collected: &Mutex<Instant>) -> Result<(), Failure> {
        // When another run is at it, that one's table will do.
        if let (None, Ok(mut last)) = (work.only, collected.try_lock())
            && last.elapsed() > COLLECTS_EVERY
        {
            self.collect(out)?;
            *last = Instant::now();
        }
        Ok(())
    }

    /// The failures of the chosen runs as one.
    fn verdict(&self, out: &Path, chosen: &[usize]) -> Result<Option<Failure>, Failure> {
        let mut failed = Vec::new();
        for &index in chosen {
            if let State::Failed { code, reason } = State::of(out, &self.points[index].folder)? {
                failed.push((code, format!("{}: {reason}", self.name(index))));
            }
        }
        let help = "they are run again only with --retry";
        Ok((!failed.is_empty()).then(|| failed_runs(&failed, chosen.len(), help)))
    }
}

/// Several failures as one, with the exit code of the first.
pub(super) fn failed_runs(failed: &[(u8, String)], of: usize, help: &str) -> Failure {
    let reasons: Vec<&str> = failed.iter().map(|(_, reason)| reason.as_str()).collect();
    let count = format!("{} of {of} runs failed", failed.len());
    let reason = format!("{count}\n{}\n  = help: {help}", reasons.join("\n"));
    Failure::Runs { code: failed.first().map_or(4, |(code, _)| *code), reason }
}

/// A run of the grid at work.
struct One<'a> {
    plan: &'a Plan,
    out: &'a Path,
    index: usize,
    work: Work,
    /// Whether no other run is under way, so that its progress is told.
    alone: bool,
}

impl One<'_> {
    /// Starts the run or takes it up again. A failure of the run is written down; what cannot be
    /// written down ends the sweep.
    fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let point = &self.plan.points[self.index];
        let Some(_lock) = Lock::take(&lock_path(self.out, &point.folder))? else {
            self.say("another process works on it");
            return Ok(());
        };
        // Another process may have worked on it since the list was made.
        let state = State::of(self.out, &point.folder)?;
        if !state.is_to_run(self.work.retry) {
            return Ok(());
        }
        if self.alone {
            self.say(if state.can_resume() { "resumes" } else { "starts" });
        }
        state::forget_failure(self.out, &point.folder)?;
        let (begun, folder) = (Instant::now(), self.out.join(&point.folder));
        let quiet = self.work.quiet || !self.alone;
        let result = if state.can_resume() {
            run::resume(&folder, quiet, interrupt)
        } else {
            run::run(&point.text, &folder, folder.join("run.json").is_file(), quiet, interrupt)
        };
        let said = match result {
            Ok(_) => "done",
            Err(Failure::Interrupted { .. }) => "interrupted",
            Err(failure) => {
                state::write_failure(self.out, &point.folder, &failure)?;
                "failed"
            }
        };
        self.say(&format!("{said} after {}", duration(begun.elapsed().as_secs_f64())));
        Ok(())
    }

    fn say(&self, what: &str) {
        if !self.work.quiet {
            let (number, count) = (self.index + 1, self.plan.points.len());
            say(format_args!("[{number}/{count}] {}: {what}", self.plan.name(self.index)));
        }
    }
}
