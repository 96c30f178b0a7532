//! Progress of a run on standard error: one line that is rewritten on a terminal, plain lines
//! every ten seconds otherwise.

use crate::methods::member::Member;
use granular_core::{Every, Flow, Observer, ObserverError, Scheduled, Simulation};
use std::io::{IsTerminal, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Writes a line to standard error. What is said there is a courtesy: that nobody listens any more
/// does not stop a run, as `eprintln!` would.
pub(crate) fn say(line: std::fmt::Arguments<'_>) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// What the progress line says of the stage under way.
#[derive(Clone, Debug)]
pub(crate) struct StageLine {
    /// Name and place of the stage, such as `collapse (2/2)`.
    pub(crate) name: String,
    /// Time at which the stage ends at the latest \[s\].
    pub(crate) end: f64,
    /// Step and time from which it goes on \[s\].
    pub(crate) from: (u64, f64),
}

struct Progress {
    stage: StageLine,
    members: Vec<Arc<dyn Member>>,
    terminal: bool,
    last: (Instant, u64, f64),
    shown: bool,
}

/// The progress of one stage.
pub(crate) fn scheduled(stage: StageLine, members: Vec<Arc<dyn Member>>) -> Scheduled {
    let terminal = std::io::stderr().is_terminal();
    let interval = if terminal { Duration::from_millis(200) } else { Duration::from_secs(10) };
    let last = (Instant::now(), stage.from.0, stage.from.1);
    let progress = Progress { stage, members, terminal, last, shown: false };
    Scheduled::new("progress", Every::Wall(interval), Box::new(progress))
}

impl Observer for Progress {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let clock = simulation.clock();
        let (size, item) = simulation.solver().size();
        let now = (Instant::now(), clock.step(), clock.time());
        let (since, step, time) = std::mem::replace(&mut self.last, now);
        self.shown = true;
        let wall = now.0.duration_since(since).as_secs_f64();
        let rate = (clock.step() - step) as f64 / wall.max(1e-9);
        let pace = (clock.time() - time) / wall.max(1e-9);
        let worst = self.members.iter().map(|member| member.progress(simulation));
        let worst = worst.collect::<Vec<_>>().join("  ");
        let left = (self.stage.end - clock.time()).max(0.0) / pace;
        let line = format!(
            "{}  {:.4}/{:.4} s  step {}  dt {:.2e} s  {:.2e} {item}-steps/s  {worst}  at most {} left",
            self.stage.name,
            clock.time(),
            self.stage.end,
            clock.step(),
            clock.dt(),
            rate * size as f64,
            duration(left),
        );
        let mut out = std::io::stderr().lock();
        let _ = if self.terminal { write!(out, "\r\x1b[K{line}") } else { writeln!(out, "{line}") };
        let _ = out.flush();
        Ok(Flow::Continue)
    }

    fn finish(&mut self, _: &Simulation) -> Result<(), ObserverError> {
        if self.terminal && self.shown {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
        Ok(())
    }
}

/// A duration in seconds as people read it.
pub(crate) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "?".to_owned();
    }
    let whole = seconds.round() as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, 0, _) if seconds < 10.0 => format!("{seconds:.1} s"),
        (0, 0, s) => format!("{s} s"),
        (0, m, s) => format!("{m} min {s:02} s"),
        (h, m, _) => format!("{h} h {m:02} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn durations_read_well() {
        assert_eq!(duration(3.21), "3.2 s");
        assert_eq!(duration(75.0), "1 min 15 s");
        assert_eq!(duration(7290.0), "2 h 01 min");
        assert_eq!(duration(f64::INFINITY), "?");
    }
}
