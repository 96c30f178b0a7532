//! The promises on steps and restarts.

use super::allocator::CountingAllocator;
use crate::snapshot::Section;
use crate::solver::Solver;
use std::fmt;

/// A promise that a solver did not keep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Breach {
    /// The promise.
    pub promise: &'static str,
    /// What was found instead.
    pub found: String,
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.promise, self.found)
    }
}

impl std::error::Error for Breach {}

impl Breach {
    pub(super) fn new(promise: &'static str, found: impl Into<String>) -> Self {
        Self { promise, found: found.into() }
    }
}

type Builder = Box<dyn Fn() -> Box<dyn Solver> + Send + Sync>;

/// The contract of a solver, ready to be tested.
pub struct Contract {
    pub(super) build: Builder,
    pub(super) dt: f64,
    pub(super) steps: u64,
    warm_up: u64,
    pub(super) any_length: Vec<&'static str>,
    pub(super) not_numbers: Vec<&'static str>,
}

impl fmt::Debug for Contract {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Contract").field("dt", &self.dt).field("steps", &self.steps).finish_non_exhaustive()
    }
}

impl Contract {
    /// The contract of what `build` builds, with steps of `dt` \[s\].
    pub fn new<S: Solver>(build: impl Fn() -> S + Send + Sync + 'static, dt: f64) -> Self {
        Self {
            build: Box::new(move || Box::new(build())),
            dt,
            steps: 24,
            warm_up: 200,
            any_length: Vec::new(),
            not_numbers: Vec::new(),
        }
    }

    /// Steps of one leg of each run; 24 unless set.
    pub fn steps(self, steps: u64) -> Self {
        Self { steps: steps.max(2), ..self }
    }

    /// Steps before allocations are counted; 200 unless set.
    pub fn warm_up(self, steps: u64) -> Self {
        Self { warm_up: steps, ..self }
    }

    /// Entries of a section that may have any length, such as texts.
    pub fn any_length(self, names: &[&'static str]) -> Self {
        Self { any_length: names.to_vec(), ..self }
    }

    /// Entries that are not numbers although their bytes look so; they are not overwritten with
    /// NaN. See [`Contract::not_finite`].
    pub fn not_numbers(self, names: &[&'static str]) -> Self {
        Self { not_numbers: names.to_vec(), ..self }
    }

    /// Takes steps that must succeed.
    pub(super) fn go(&self, solver: &mut dyn Solver, steps: u64, why: &'static str) -> Result<(), Breach> {
        let outcome = solver.advance(self.dt, steps);
        solver.publish();
        outcome.map_err(|error| Breach::new(why, format!("a step failed: {error}")))
    }

    /// Runs in pools of 1, 2, 3 and 8 threads give the same state. The state must change, or the
    /// comparison would be empty.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn threads(&self) -> Result<(), Breach> {
        const WHY: &str = "same bits for any number of threads";
        let run = |threads: usize| {
            in_pool(threads, || {
                let mut solver = (self.build)();
                self.go(solver.as_mut(), self.steps, WHY)?;
                Ok(state_of(solver.as_ref()))
            })
        };
        let alone = run(1)?;
        if alone == state_of((self.build)().as_ref()) {
            return Err(Breach::new(WHY, format!("nothing changes in {} steps", self.steps)));
        }
        for threads in [2, 3, 8] {
            let found = format!("{threads} threads and one differ");
            same(&alone, &run(threads)?, WHY, &found)?;
        }
        Ok(())
    }

    /// One call of 2N steps, 2N single steps, two calls of N, and 1 then 2N - 1 with an empty
    /// call between give the same state.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn split(&self) -> Result<(), Breach> {
        const WHY: &str = "same bits for any split into calls";
        let n = self.steps;
        let run = |calls: &mut dyn Iterator<Item = u64>| {
            let mut solver = (self.build)();
            for steps in calls {
                self.go(solver.as_mut(), steps, WHY)?;
            }
            Ok(state_of(solver.as_ref()))
        };
        let whole = run(&mut [2 * n].into_iter())?;
        same(&whole, &run(&mut [n, n].into_iter())?, WHY, "two calls of N and one of 2N differ")?;
        same(&whole, &run(&mut (0..2 * n).map(|_| 1))?, WHY, "single steps and one call differ")?;
        same(&whole, &run(&mut [1, 0, 2 * n - 1].into_iter())?, WHY, "1, 0, 2N - 1 and one call differ")
    }

    /// A solver that was saved after N steps and restored into a fresh one has the same state at
    /// once and after 1, 2, 3, 4, 6, 10, ... further steps as the one that ran on.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn restart(&self) -> Result<(), Breach> {
        const WHY: &str = "same bits after a restart";
        let mut first = (self.build)();
        self.go(first.as_mut(), self.steps, WHY)?;
        let saved = state_of(first.as_ref());
        let mut second = (self.build)();
        second
            .restore(&saved)
            .map_err(|error| Breach::new(WHY, format!("its own section is refused: {error}")))?;
        same(&saved, &state_of(second.as_ref()), WHY, "saved and restored differ at once")?;
        let (mut after, mut leg) = (0, 1);
        while after < self.steps {
            self.go(first.as_mut(), leg, WHY)?;
            self.go(second.as_mut(), leg, WHY)?;
            after += leg;
            let found = format!("{after} steps after the restart it differs");
            same(&state_of(first.as_ref()), &state_of(second.as_ref()), WHY, &found)?;
            // The first steps one by one: what was lost often shows only there.
            leg = if after < 4 { 1 } else { (2 * leg).min(self.steps - after).max(1) };
        }
        Ok(())
    }

    /// Steps of zero, below zero and not finite are refused and change nothing.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn bad_steps(&self) -> Result<(), Breach> {
        const WHY: &str = "a step that makes no sense is refused and changes nothing";
        let mut solver = (self.build)();
        self.go(solver.as_mut(), 2, WHY)?;
        let before = state_of(solver.as_ref());
        for dt in [0.0, -0.0, -self.dt, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for outcome in [solver.advance(dt, 3), solver.step(dt)] {
                if outcome.is_ok() {
                    return Err(Breach::new(WHY, format!("a step of {dt} s was taken")));
                }
            }
            let found = format!("the state changed when a step of {dt} s was refused");
            same(&before, &state_of(solver.as_ref()), WHY, &found)?;
        }
        // Refusing must not have spoilt the solver.
        self.go(solver.as_mut(), 1, WHY)
    }

    /// After a warm-up, steps do not allocate. Counted in a pool of one thread; needs
    /// [`CountingAllocator`] as the global allocator.
    ///
    /// # Errors
    /// When the promise is not kept, or the allocator is not installed.
    pub fn allocations(&self) -> Result<(), Breach> {
        const WHY: &str = "steps do not allocate";
        in_pool(1, || {
            if !CountingAllocator::is_installed() {
                let found = "install `CountingAllocator` with #[global_allocator] in the test binary";
                return Err(Breach::new(WHY, found));
            }
            let mut solver = (self.build)();
            self.go(solver.as_mut(), self.warm_up, WHY)?;
            let (mut worst, mut total) = (None, 0);
            // Calls of different lengths, so that whatever a call costs counts as well.
            for (call, steps) in [self.steps, 1, self.steps].into_iter().enumerate() {
                let before = CountingAllocator::on_this_thread();
                self.go(solver.as_mut(), steps, WHY)?;
                let made = CountingAllocator::on_this_thread() - before;
                total += made;
                worst = worst.or((made > 0).then_some(call));
            }
            match worst {
                None => Ok(()),
                Some(call) => Err(Breach::new(
                    WHY,
                    format!(
                        "{total} allocations in {} steps after {} steps of warm-up, first in call {call}",
                        2 * self.steps + 1,
                        self.warm_up
                    ),
                )),
            }
        })
    }
}

/// All that decides how a run goes on.
pub(super) fn state_of(solver: &dyn Solver) -> Section {
    let mut section = Section::new("solver");
    solver.save(&mut section);
    section
}

/// Compares two states byte by byte; names the first entry that differs.
pub(super) fn same(a: &Section, b: &Section, promise: &'static str, found: &str) -> Result<(), Breach> {
    if a == b {
        return Ok(());
    }
    let entry = a.entries().zip(b.entries()).find(|(a, b)| a != b);
    let place = entry.map_or_else(
        || "in the number of entries".to_owned(),
        |((name, a), (_, b))| {
            let byte = a.iter().zip(b).position(|(a, b)| a != b).unwrap_or(a.len().min(b.len()));
            format!("in `{name}` from byte {byte} of {} on", a.len())
        },
    );
    Err(Breach::new(promise, format!("{found} {place}")))
}

pub(crate) fn in_pool<T: Send>(threads: usize, body: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("a pool of a few threads can be built").install(body)
}
