//! Progress on standard error: bars on a terminal, plain lines every ten seconds otherwise.

use crate::methods::member::Member;
use granular_core::{Every, Flow, Observer, ObserverError, Scheduled, Simulation};
use indicatif::{
    MultiProgress, ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressState, ProgressStyle,
};
use std::io::Write;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// All bars of this process; they are hidden when standard error is not a terminal.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);
/// Positions of the bar of a stage.
const POSITIONS: u64 = 1000;

/// Writes a line to standard error, above all bars. What is said there is a courtesy: that nobody listens any more
/// does not stop a run, as `eprintln!` would.
pub(crate) fn say(line: std::fmt::Arguments<'_>) {
    let _ =
        if BARS.is_hidden() { writeln!(std::io::stderr(), "{line}") } else { BARS.println(line.to_string()) };
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
    bar: Option<ProgressBar>,
    last: (Instant, u64, f64),
}

/// The progress of one stage.
pub(crate) fn scheduled(stage: StageLine, members: Vec<Arc<dyn Member>>) -> Scheduled {
    let is_terminal = !BARS.is_hidden();
    let interval = if is_terminal { Duration::from_millis(200) } else { Duration::from_secs(10) };
    let last = (Instant::now(), stage.from.0, stage.from.1);
    let bar = is_terminal.then(|| BARS.add(stage_bar(&stage.name, ProgressDrawTarget::stderr())));
    Scheduled::new("progress", Every::Wall(interval), Box::new(Progress { stage, members, bar, last }))
}

fn stage_bar(name: &str, target: ProgressDrawTarget) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(POSITIONS), target).with_finish(ProgressFinish::AndClear);
    bar.with_style(style("{prefix} {bar:20} {wide_msg}")).with_prefix(name.to_owned())
}

/// How many runs of a sweep are over, with an estimate of the time left; drawn on a terminal only.
pub(crate) fn runs(count: usize) -> ProgressBar {
    let bar = BARS.add(ProgressBar::new(count as u64).with_finish(ProgressFinish::AndClear));
    // Nothing is known of the time left before the first run is over.
    let left = |state: &ProgressState, to: &mut dyn std::fmt::Write| {
        let known = state.pos() > 0;
        let _ = known.then(|| write!(to, ", about {} left", duration(state.eta().as_secs_f64())));
    };
    bar.set_style(style("{pos} of {len} runs {bar:20} {elapsed}{left}").with_key("left", left));
    bar
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .expect("the template is written in this file")
        .progress_chars("=> ")
}

impl Progress {
    /// The time, then step, rate and worst number, and how long it takes at most from here.
    fn told(&mut self, simulation: &Simulation) -> [String; 3] {
        let clock = simulation.clock();
        let (size, item) = simulation.solver().size();
        let now = (Instant::now(), clock.step(), clock.time());
        let (since, step, time) = std::mem::replace(&mut self.last, now);
        let wall = now.0.duration_since(since).as_secs_f64();
        let rate = (clock.step() - step) as f64 / wall.max(1e-9);
        let pace = (clock.time() - time) / wall.max(1e-9);
        let worst = self.members.iter().map(|member| member.progress(simulation));
        let worst = worst.collect::<Vec<_>>().join("  ");
        let left = (self.stage.end - clock.time()).max(0.0) / pace;
        let (step, dt, rate) = (clock.step(), clock.dt(), rate * size as f64);
        [
            format!("{:.4}/{:.4} s", clock.time(), self.stage.end),
            format!("step {step}  dt {dt:.2e} s  {rate:.2e} {item}-steps/s  {worst}"),
            format!("at most {} left", duration(left)),
        ]
    }

    /// Share of the stage, or of what was left of it, that is over.
    fn share(&self, time: f64) -> f64 {
        let (from, end) = (self.stage.from.1, self.stage.end);
        if end > from { ((time - from) / (end - from)).clamp(0.0, 1.0) } else { 1.0 }
    }
}

impl Observer for Progress {
    fn observe(&mut self, simulation: &Simulation) -> Result<Flow, ObserverError> {
        let [time, work, left] = self.told(simulation);
        let share = self.share(simulation.clock().time());
        match &self.bar {
            Some(bar) => {
                // A terminal may be narrow: what matters most comes first.
                bar.set_message(format!("{time}  {left}  {work}"));
                bar.set_position((share * POSITIONS as f64) as u64);
            }
            None => say(format_args!("{}  {time}  {work}  {left}", self.stage.name)),
        }
        Ok(Flow::Continue)
    }

    fn finish(&mut self, _: &Simulation) -> Result<(), ObserverError> {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
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
    use super::*;
    use indicatif::{InMemoryTerm, TermLike};

    #[test]
    fn the_bar_of_a_stage_fits_on_one_line() {
        let terminal = InMemoryTerm::new(10, 60);
        let target = ProgressDrawTarget::term_like(Box::new(terminal.clone()));
        let stage = StageLine { name: "collapse (2/2)".to_owned(), end: 0.5, from: (100, 0.1) };
        let bar = stage_bar(&stage.name, target);
        let progress =
            Progress { stage, members: Vec::new(), bar: Some(bar), last: (Instant::now(), 100, 0.1) };
        assert_eq!(
            [0.1, 0.3, 0.5, 0.7].map(|time| progress.share(time)),
            [0.0, 0.49999999999999994, 1.0, 1.0]
        );
        let bar = progress.bar.unwrap();
        bar.set_message("0.3000/0.5000 s  step 2000  dt 1.0e-4 s  at most 3 s left");
        bar.set_position(500);
        bar.tick();
        assert_eq!(terminal.contents(), "collapse (2/2) ==========>          0.3000/0.5000 s  step 20");
        assert_eq!(terminal.width(), 60);
        bar.finish_and_clear();
        assert_eq!(terminal.contents(), "");
    }

    #[test]
    fn durations_read_well() {
        assert_eq!(duration(3.21), "3.2 s");
        assert_eq!(duration(75.0), "1 min 15 s");
        assert_eq!(duration(7290.0), "2 h 01 min");
        assert_eq!(duration(f64::INFINITY), "?");
    }
}
