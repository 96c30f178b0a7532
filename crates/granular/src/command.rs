//! Verbs and flags.

#[cfg(feature = "studies")]
mod bench;
#[cfg(feature = "dem")]
mod calibrate;
mod compare;
#[cfg(feature = "mpm")]
mod element;
mod plot;
mod report;
mod summary;
mod sweep;
#[cfg(feature = "studies")]
mod validate;

use clap::{Args, Parser, Subcommand};
use granular_core::Shown;
use granular_driver::failure::Failure;
use granular_driver::run::Interrupt;
use granular_driver::scene_file::SceneText;
use granular_driver::{check, folder, machine, parts, run};
use serde_json::{Map, Value, json};
use signal_hook::iterator::Signals;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Granular flows from one scene file.
///
/// Exit codes: 0 done, 1 a validation failed, 2 the scene is wrong, 3 refused by the stability
/// check, 4 stopped by a guard (state saved), 5 input or output, 130 or 143 interrupted
/// (resumable).
#[derive(Parser, Debug)]
#[command(name = "granular", version, about)]
pub(crate) struct Command {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    common: Common,
}

#[derive(Args, Debug)]
struct Common {
    /// Number of threads; all cores by default. The results have the same bits for any number.
    #[arg(long, global = true, value_name = "N")]
    threads: Option<usize>,
    /// Print one JSON value on standard output.
    #[arg(long, global = true)]
    json: bool,
    /// Print only results and errors.
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Subcommand, Debug)]
enum Verb {
    /// Print a scene to start from.
    New {
        /// Name of the template; the list of all by default.
        #[arg(conflicts_with = "list")]
        template: Option<String>,
        /// List the templates, one line each.
        #[arg(long)]
        list: bool,
    },
    /// Check a scene without running it: sample, limits, bounds, memory, run time, and what is left out.
    Check {
        /// Scene file, or - for standard input.
        scene: PathBuf,
        #[command(flatten)]
        edits: Edits,
        /// Draw the scene before its first step: grains, walls, inlets and outlets, obstacles of a fluid. Writes an SVG
        /// file, and a PNG file of the same name.
        #[arg(long, value_name = "FILE")]
        draw: Option<PathBuf>,
    },
    /// Run a scene in a new folder.
    Run {
        /// Scene file, or - for standard input.
        scene: PathBuf,
        #[command(flatten)]
        edits: Edits,
        /// Run folder; `runs/<name of the scene>` by default.
        #[arg(short, long, value_name = "FOLDER")]
        out: Option<PathBuf>,
        /// Replace the run in the folder.
        #[arg(long)]
        force: bool,
    },
    /// Resume an interrupted run; the results have the same bits as without the interruption.
    Resume {
        /// Run folder.
        folder: PathBuf,
    },
    /// Run a grid of scenes and collect a table; the same command continues an interrupted sweep.
    Sweep(sweep::Sweep),
    /// Redraw the figures of a run, or draw a figure of a sweep or a calibrated material.
    Plot(plot::Plot),
    /// Compare runs: series, profiles and grids of run folders, and tables from elsewhere, in one figure and one table.
    Compare(compare::Compare),
    /// Write one HTML file about runs, which any browser opens: summary, series, animation, energies, limits, scene.
    Report(report::Report),
    /// Compare results with known answers; exit code 1 if a required one is missed.
    #[cfg(feature = "studies")]
    Validate(validate::Validate),
    /// Measure the parameters of a continuum made of the grains of a scene.
    #[cfg(feature = "dem")]
    #[command(subcommand)]
    Calibrate(calibrate::Calibrate),
    /// Lead one point of a continuum along a path of strain: its stress and volume as a table and a figure.
    #[cfg(feature = "mpm")]
    Element(element::Element),
    /// Measure error against run time, or speed.
    #[cfg(feature = "studies")]
    #[command(subcommand)]
    Bench(bench::Bench),
    /// Describe this program, a run folder, or everything that a scene can show.
    Info {
        /// Run folder or scene file.
        path: Option<PathBuf>,
    },
}

#[derive(Args, Debug)]
struct Edits {
    /// Change a value of the scene, such as `sample.aspect_ratio=2` or `materials.glass.friction=0.3`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

impl Command {
    /// Runs the verb and prints what came of it.
    pub(crate) fn execute(self) -> ExitCode {
        let threads = threads(self.common.threads);
        // The global pool is built once, here, before anything runs in it.
        if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global() {
            eprintln!("warning: {error}; the default number of threads is used");
        }
        let checks = matches!(self.verb, Verb::Check { .. });
        match self.verb.execute(&self.common) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => {
                // A failed validation has printed its rows, a check its report and a sweep its
                // list, and they say what failed.
                let reported = matches!(failure, Failure::Invalid(_) | Failure::Runs { .. })
                    || checks && matches!(failure, Failure::Refused(_));
                tell(&failure, self.common.json && !reported);
                ExitCode::from(failure.code())
            }
        }
    }
}

/// Says why a command failed, with `json` on standard output too.
fn tell(failure: &Failure, json: bool) {
    if json {
        print(&(pretty(&failure_json(failure)) + "\n"));
    }
    // Nobody may be listening; the exit code says it too.
    let in_colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let text = if in_colour { failure.in_colour() } else { failure.to_string() };
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Threads to use; 0 for all cores. More than make sense would wait for one another for seconds.
fn threads(asked: Option<usize>) -> usize {
    let of_rayon = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok();
    let (asked, most) = (asked.or_else(of_rayon).unwrap_or(0), machine::most_threads());
    if asked > most {
        eprintln!(
            "warning: {asked} threads are more than this machine can use: {most} are taken; the results are the same"
        );
    }
    asked.min(most)
}

impl Verb {
    fn execute(self, common: &Common) -> Result<(), Failure> {
        match self {
            Self::New { template, list: _ } => new(common, template.as_deref()),
            Self::Check { scene, edits, draw } => check(common, &read(&scene, &edits)?, draw.as_deref()),
            Self::Run { scene, edits, out, force } => {
                let text = read(&scene, &edits)?;
                let out = out.unwrap_or_else(|| default_folder(&scene));
                let facts = run::run(&text, &out, force, common.quiet, &interrupt(common, &out)?)?;
                show(common, &result(&facts), || summary::of_result(&facts, &out));
                Ok(())
            }
            Self::Resume { folder } => {
                let facts = run::resume(&folder, common.quiet, &interrupt(common, &folder)?)?;
                show(common, &result(&facts), || summary::of_result(&facts, &folder));
                Ok(())
            }
            Self::Plot(verb) => verb.execute(common),
            Self::Compare(verb) => verb.execute(common),
            Self::Report(verb) => verb.execute(common),
            Self::Sweep(verb) => verb.execute(common),
            #[cfg(feature = "studies")]
            Self::Bench(verb) => verb.execute(common),
            #[cfg(feature = "dem")]
            Self::Calibrate(calibrate) => calibrate.execute(common),
            #[cfg(feature = "mpm")]
            Self::Element(verb) => verb.execute(common),
            #[cfg(feature = "studies")]
            Self::Validate(verb) => verb.execute(common),
            Self::Info { path } => info(common, path.as_deref()),
        }
    }
}

/// Checks a scene; one of several solvers that nothing joins part by part.
fn check(common: &Common, text: &SceneText, draw: Option<&Path>) -> Result<(), Failure> {
    let parts = parts::of(text)?;
    let (mut reports, mut refused) = (Map::new(), None);
    for part in &parts {
        let stem = draw.map(|path| match part.name.as_str() {
            "" => path.to_owned(),
            name => path
                .with_extension("")
                .with_file_name(format!("{}-{name}", path.file_stem().unwrap_or_default().to_string_lossy())),
        });
        let report = check::check_and_draw(&part.text, stem.as_deref()).inspect_err(|failure| {
            // Refused before there was a report.
            if common.json && matches!(failure, Failure::Refused(_)) {
                print(&(pretty(&failure_json(failure)) + "\n"));
            }
        })?;
        if !report.problems.is_empty() {
            refused.get_or_insert(report.refusal());
        }
        if !common.json {
            let head = if part.name.is_empty() { String::new() } else { format!("== {}\n", part.name) };
            print(&format!("{head}{report}"));
        }
        reports.insert(part.name.clone(), report.to_json());
    }
    if common.json {
        let whole = if parts.len() == 1 { reports.remove("").unwrap_or_default() } else { json!(reports) };
        print(&(pretty(&whole) + "\n"));
    }
    refused.map_or(Ok(()), Err)
}

fn read(path: &Path, edits: &Edits) -> Result<SceneText, Failure> {
    let mut text = SceneText::read(path)?;
    for assignment in &edits.set {
        text.set(assignment)?;
    }
    Ok(text)
}

/// `runs/<folder of the scene>` for a file called `scene.ron`, else `runs/<name of the file>`.
fn default_folder(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let parent = scene.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    let name = match (stem.as_str(), parent) {
        ("scene", Some(parent)) => parent,
        ("-", _) | ("", _) => "scene".to_owned(),
        _ => stem,
    };
    Path::new("runs").join(name)
}

/// Raises a flag on SIGINT and SIGTERM, at which runs that take steps save their state. While none does, a sample is
/// built, a figure drawn or a file read: then the process ends.
fn interrupt(common: &Common, out: &Path) -> Result<Interrupt, Failure> {
    let interrupt = Interrupt::default();
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        let number = interrupt.signal.clone();
        let flag = interrupt.raised.clone();
        // The number first: who sees the flag must find the number.
        let register = signal_hook::flag::register_usize(signal, number, signal as usize)
            .and_then(|_| signal_hook::flag::register(signal, flag));
        register.map_err(|error| Failure::io("signals", error))?;
    }
    let signals = Signals::new([signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM]);
    let mut signals = signals.map_err(|error| Failure::io("signals", error))?;
    let (watched, out, json) = (interrupt.clone(), out.to_owned(), common.json);
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            end_when_idle(&watched, signal, &out, json);
        }
    });
    // Without a handler a limit on the size of files (`ulimit -f`) kills the process; with one the
    // write fails, which is told.
    let too_large = signal_hook::flag::register(FILE_TOO_LARGE, Arc::default());
    too_large.map_err(|error| Failure::io("signals", error))?;
    Ok(interrupt)
}

/// Ends the process after a signal as soon as no run has taken steps for a while, in which it would have ended by
/// itself.
fn end_when_idle(interrupt: &Interrupt, signal: i32, out: &Path, json: bool) {
    let mut idle = Instant::now();
    while idle.elapsed() < IDLE {
        if interrupt.stepping.load(Ordering::SeqCst) > 0 {
            idle = Instant::now();
        }
        std::thread::sleep(IDLE / 20);
    }
    let signal = signal as usize;
    let failure = if folder::RunFolder::open(out).is_ok() {
        let hint = format!("continue with `granular resume {}`", out.display());
        Failure::Interrupted { signal, hint }
    } else {
        Failure::NotBegun { signal }
    };
    tell(&failure, json);
    // Nothing that other threads hold is worth waiting for: files are whole at any moment.
    signal_hook::low_level::exit(failure.code().into());
}

/// How long nothing must take steps after a signal before the process ends.
const IDLE: Duration = Duration::from_millis(400);

/// SIGXFSZ, of the same number on Linux (but for MIPS), macOS and the BSDs.
const FILE_TOO_LARGE: i32 = 25;

fn show(common: &Common, value: &Value, text: impl FnOnce() -> String) {
    if common.json {
        print(&(pretty(value) + "\n"));
    } else {
        print(&text());
    }
}

/// Prints a result. That the reader has left, as `head` does, is no failure; a full disk is.
fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    if let Err(error) = out.write_all(text.as_bytes()).and_then(|()| out.flush())
        && error.kind() != std::io::ErrorKind::BrokenPipe
    {
        let failure = Failure::io("standard output", error);
        let _ = writeln!(std::io::stderr(), "{failure}");
        // Printing is the last thing that any verb does.
        std::process::exit(failure.code().into());
    }
}

fn pretty(value: &Value) -> String {
    serde_json::to_string_pretty(value).expect("a JSON value can be written")
}

/// The keys of `run --json`.
fn result(facts: &Value) -> Value {
    let keys = [
        "scene",
        "solver",
        "exit",
        "simulated_seconds",
        "steps",
        "wall_seconds",
        "rate",
        "state_hash",
        "metrics",
    ];
    keys.iter().map(|&key| (key.to_owned(), facts[key].clone())).collect::<serde_json::Map<_, _>>().into()
}

fn failure_json(failure: &Failure) -> Value {
    let problems = match failure {
        Failure::Scene(problems) => json!(problems),
        Failure::Refused(reasons) => json!(reasons),
        other => json!([other.to_string()]),
    };
    json!({ "exit": failure.code(), "problems": problems })
}

/// Prints a template, or lists all by the first line of each.
fn new(common: &Common, template: Option<&str>) -> Result<(), Failure> {
    let templates = granular_driver::TEMPLATES;
    let Some(name) = template else {
        let titles = templates
            .iter()
            .map(|(name, text)| (*name, text.lines().next().unwrap_or_default().trim_start_matches("// ")));
        let titles: Vec<(&str, &str)> = titles.collect();
        let list: Vec<Value> =
            titles.iter().map(|(name, title)| json!({ "name": name, "title": title })).collect();
        show(common, &json!(list), || {
            titles.iter().map(|(name, title)| format!("{name:<24} {title}\n")).collect()
        });
        return Ok(());
    };
    match templates.iter().find(|(known, _)| *known == name) {
        Some((_, text)) => {
            print(text);
            Ok(())
        }
        None => {
            let known: Vec<&str> = templates.iter().map(|(name, _)| *name).collect();
            let known = known.join(", ");
            let reason = format!("there is no template `{name}`; allowed: {known} (--list describes them)");
            Err(Failure::io("new", reason))
        }
    }
}

fn info(common: &Common, path: Option<&Path>) -> Result<(), Failure> {
    let facts = match path {
        None => folder::provenance(),
        Some(path) if path.is_dir() => {
            let facts = folder::RunFolder::open(path)?.facts()?;
            show(common, &facts, || summary::of_run(&facts, path));
            return Ok(());
        }
        Some(path) => return shown(common, path),
    };
    show(common, &facts, || pretty(&facts) + "\n");
    Ok(())
}

/// Lists all that a scene can show.
fn shown(common: &Common, path: &Path) -> Result<(), Failure> {
    let mut list = Vec::new();
    for part in parts::of(&SceneText::read(path)?)? {
        let (_, model) = check::read(&part.text)?;
        for member in &model.members {
            let of = |kind: String, shown: Shown| (member.name().to_owned(), kind, shown);
            let all = member.shown(&model.simulation).into_iter();
            list.extend(all.map(|shown| of(format!("{:?}", shown.kind), shown)));
            let averages = member.shown_on_grids(&model.simulation).into_iter();
            list.extend(averages.map(|shown| of("Grid".to_owned(), shown)));
        }
    }
    let rows: Vec<Value> = list
        .iter()
        .map(|(of, kind, s)| json!({ "of": of, "name": s.name, "unit": s.unit, "kind": kind, "meaning": s.meaning }))
        .collect();
    show(common, &json!(rows), || {
        let several = list.iter().any(|(of, ..)| *of != list[0].0);
        let line = |(of, kind, s): &(String, String, Shown)| {
            let of = if several { format!("{of:<12} ") } else { String::new() };
            format!("{of}{kind:<8} {:<28} {:<8} {}\n", s.name, s.unit, s.meaning)
        };
        list.iter().map(line).collect()
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Command;
    use clap::CommandFactory;

    #[test]
    fn flags_of_all_verbs_make_sense_to_their_parser() {
        Command::command().debug_assert();
    }
}
