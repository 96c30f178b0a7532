//! A fuzzer of scenes: mutations of all examples and templates go through `check`, which must refuse or accept each without a
//! panic, an abort or a hang. `scripts/fuzz` makes a long trial, and tries one scene again.
//!
//! Scenes are checked in child processes, so that the death of one is seen and the others go on. A scene follows from its
//! number alone.

mod mutate;
mod text;

use crate::support::{SMALL, Scratch, workspace};
use granular_driver::check;
use granular_driver::failure::Failure;
use granular_driver::scene_file::SceneText;
use granular_driver::sweep::Axis;
use mutate::{Base, Case};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Time of the processor that a check may take \[s\].
const SLOW: f64 = 2.0;
/// After this time of the processor a child is ended \[s\]; so it is when it sleeps for [`DEAD`].
const HANG: f64 = 10.0;
const DEAD: Duration = Duration::from_secs(120);
/// Address space of a child \[kB\]: what a scene may take is compared with what is left of it.
const MEMORY: u64 = 400_000;
/// Scenes that one child tries.
const BATCH: u64 = 2000;
/// Told to a child: numbers of its first scene and of the one after its last.
const RANGE: &str = "GRANULAR_FUZZ_RANGE";
/// Told to a child that shows its scenes.
const SHOW: &str = "GRANULAR_FUZZ_SHOW";

/// Tries `GRANULAR_FUZZ` scenes, 150 by default, from number `GRANULAR_FUZZ_FROM` on.
#[test]
fn mutated_scenes_are_checked_without_a_panic_an_abort_or_a_hang() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a number of scenes"))
    };
    let (first, count) = (number("GRANULAR_FUZZ_FROM", 0), number("GRANULAR_FUZZ", 150));
    let mut found = Found::default();
    let mut next = first;
    while next < first + count {
        next = one_child(next, (next + BATCH).min(first + count), &mut found);
        if count > BATCH {
            println!("{} scenes: {found}", next - first);
        }
    }
    println!("{count} scenes from number {first} on: {found}");
    let tried = found.accepted + found.refused;
    assert!(found.faults.is_empty(), "{}", found.faults_in_words());
    // What is never accepted tries nothing but the reader.
    assert!(found.accepted * 20 > tried, "{} of {tried} scenes were accepted", found.accepted);
}

/// What came of the scenes.
#[derive(Default)]
struct Found {
    accepted: u64,
    refused: u64,
    /// By what happened, the scenes at which it did.
    faults: BTreeMap<String, Vec<u64>>,
}

impl Found {
    fn faults_in_words(&self) -> String {
        let texts = self.faults.iter().map(|(what, scenes)| {
            let first: Vec<String> = scenes.iter().take(5).map(u64::to_string).collect();
            format!("{} scenes, such as {}: {what}", scenes.len(), first.join(", "))
        });
        texts.collect::<Vec<_>>().join("\n")
    }
}

impl std::fmt::Display for Found {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let faults: usize = self.faults.values().map(Vec::len).sum();
        write!(f, "{} accepted, {} refused, {faults} faults", self.accepted, self.refused)?;
        if faults > 0 { write!(f, "\n{}", self.faults_in_words()) } else { Ok(()) }
    }
}

/// Tries scenes in one child; returns the number to go on from.
fn one_child(first: u64, after: u64, found: &mut Found) -> u64 {
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\"")])
        .arg(std::env::current_exe().expect("the test is a file"))
        .args(["--exact", "fuzz::child_of_the_fuzzer", "--nocapture", "--test-threads", "1"])
        .env(RANGE, format!("{first}..{after}"))
        .env("RAYON_NUM_THREADS", "1")
        .env_remove("RUST_BACKTRACE")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the child starts");
    let lines = lines_of(&mut child);
    let mut under_way = first;
    let (mut begun, mut spent) = (Instant::now(), 0.0);
    let mut last_words = Vec::new();
    let mut hang = |what: String, scene: u64| found.faults.entry(what).or_default().push(scene);
    loop {
        match lines.recv_timeout(Duration::from_millis(500)) {
            Ok(line) => {
                let mut words = line.splitn(3, ' ');
                let said =
                    (words.next(), words.next().and_then(|word| word.parse::<u64>().ok()), words.next());
                match said {
                    (Some("scene"), Some(scene), _) => {
                        under_way = scene;
                        (begun, spent) = (Instant::now(), processor_time(child.id()).unwrap_or(spent));
                    }
                    (Some("fault"), Some(scene), Some(what)) => hang(what.to_owned(), scene),
                    (Some("accepted"), Some(_), _) => found.accepted += 1,
                    (Some("refused"), Some(_), _) => found.refused += 1,
                    _ => last_words.push(line),
                }
            }
            Err(RecvTimeoutError::Timeout) => {
                let taken = processor_time(child.id()).map_or(0.0, |time| time - spent);
                if taken > HANG || begun.elapsed() > DEAD {
                    let _ = child.kill();
                    let _ = child.wait();
                    hang(format!("hangs for more than {HANG} s"), under_way);
                    return under_way + 1;
                }
            }
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    let ended = child.wait().expect("the child was started");
    if ended.success() {
        return after;
    }
    last_words.retain(|line| !line.trim().is_empty() && !line.starts_with("running "));
    last_words.truncate(3);
    hang(format!("dies: {ended}: {}", last_words.join("; ")), under_way);
    under_way + 1
}

/// Lines of both outputs of a child, until it has closed them.
fn lines_of(child: &mut Child) -> Receiver<String> {
    let (sender, receiver) = channel();
    let (out, err) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
    let other = sender.clone();
    std::thread::spawn(move || {
        BufReader::new(out).lines().map_while(Result::ok).try_for_each(|line| sender.send(line))
    });
    std::thread::spawn(move || {
        BufReader::new(err).lines().map_while(Result::ok).try_for_each(|line| other.send(line))
    });
    receiver
}

/// Time of the processor that a process has taken \[s\], where the system tells.
fn processor_time(process: u32) -> Option<f64> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name in brackets may hold blanks. Ticks are hundredths of a second on all Linux.
    let mut fields = text.rsplit_once(") ")?.1.split(' ').skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

/// The child: checks the scenes that the fuzzer tells it and says what came of each. Alone it does nothing.
#[test]
fn child_of_the_fuzzer() {
    let Ok(range) = std::env::var(RANGE) else { return };
    let (first, after) = range.split_once("..").expect("a range of scenes");
    let scratch = Scratch::new("fuzz");
    let bases = bases(&scratch);
    let place = Arc::new(Mutex::new(String::new()));
    let panicked_at = place.clone();
    std::panic::set_hook(Box::new(move |panic| {
        let text = panic.to_string().replace('\n', " ");
        *panicked_at.lock().unwrap_or_else(|held| held.into_inner()) = text.chars().take(300).collect();
    }));
    for number in first.parse::<u64>().expect("a number")..after.parse::<u64>().expect("a number") {
        say(&format!("scene {number}"));
        let case = mutate::case(&bases, number);
        if std::env::var(SHOW).is_ok() {
            say(&format!("// {}\n{}", case.name, case.text));
            case.set.iter().for_each(|set| say(&format!("--set {set}")));
            case.axes.iter().for_each(|axis| say(&format!("axis {axis}")));
        }
        let before = processor_time(std::process::id());
        let outcome = catch_unwind(AssertUnwindSafe(|| tried(&case)));
        let after = processor_time(std::process::id());
        let taken = before.zip(after).map_or(0.0, |(before, after)| after - before);
        match outcome {
            Err(_) => {
                let text = place.lock().unwrap_or_else(|held| held.into_inner());
                say(&format!("fault {number} {text}"));
            }
            Ok(_) if taken > SLOW => say(&format!("fault {number} takes {taken:.0} s")),
            Ok(Ok(report)) => {
                say(&format!("accepted {number} {}", report.lines().next().unwrap_or_default()))
            }
            Ok(Err(message)) => {
                if std::env::var(SHOW).is_ok() {
                    say(&message);
                }
                say(&format!("refused {number}"));
            }
        }
    }
}

/// Prints a line past the capture of the test harness.
fn say(line: &str) {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}").and_then(|()| out.flush()).expect("the fuzzer listens");
}

/// Checks a scene as the command does; the report or the message.
fn tried(case: &Case) -> Result<String, String> {
    for axis in &case.axes {
        let _ = Axis::of(axis).map_err(|problem| problem.to_string());
    }
    let check = || -> Result<String, Failure> {
        let mut text = SceneText::from_bytes(case.name.clone(), case.text.clone().into_bytes())?;
        for assignment in &case.set {
            text.set(assignment)?;
        }
        let report = check::check_within(&text, Duration::ZERO)?;
        serde_json::to_string(&report.to_json()).expect("a report can be written");
        if report.problems.is_empty() { Ok(report.to_string()) } else { Err(report.refusal()) }
    };
    check().map_err(|failure| failure.to_string())
}

/// All scenes to start from, made small where they are large, with the files that they read.
fn bases(scratch: &Scratch) -> Vec<Base> {
    let mut bases = Vec::new();
    let mut add = |name: String, text: &str| bases.push(Base::of(name, text));
    for (name, text) in granular_driver::TEMPLATES {
        add(scratch.path(name).display().to_string(), text);
    }
    fs::write(scratch.path("pyramid.stl"), crate::command_boundaries::PYRAMID)
        .expect("a file can be written");
    fs::write(scratch.path("sample.csv"), SAMPLE).expect("a file can be written");
    let own = [SMALL, crate::command_boundaries::SPACE, FROM_FILE, IN_CELL];
    own.iter().for_each(|text| add(scratch.path("own.ron").display().to_string(), text));
    let mut paths = Vec::new();
    scenes_in(&workspace().join("examples"), &mut paths);
    paths.sort();
    for path in paths {
        add(path.clone(), &fs::read_to_string(&path).expect("an example can be read"));
    }
    bases
}

fn scenes_in(folder: &Path, found: &mut Vec<String>) {
    for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("a folder").path()) {
        if path.is_dir() {
            scenes_in(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "ron") {
            found.push(path.display().to_string());
        }
    }
}

const SAMPLE: &str = "# granular sample 1\n# plane\n# column width 0.02 height 0.01\n\
    x [m],y [m],radius [m],velocity_x [m/s],velocity_y [m/s],spin [rad/s],material\n\
    0.001,0.001,0.001,0,0,0,glass\n0.0031,0.001,0.001,0,0.1,0,glass\n0.0052,0.00101,0.001,0.2,0,1.5,glass\n";

/// A scene that starts from a file, cut and shifted, whose grains are tracked and averaged.
const FROM_FILE: &str = r#"Scene(
    version: 1, dimension: Plane, gravity: [0.0, -9.81],
    materials: { "glass": (density: 2650, young_modulus: "1 GPa", poisson_ratio: 0.2, typical_load: "10 N/m", restitution: 0.5,
        friction: 0.3, rolling_friction: 0.1) },
    pairs: [(between: ("glass", "glass"), friction: 0.2)],
    sample: File(path: "sample.csv", cut: [Box(low: ["0 mm", "0 mm"], high: ["5 mm", "5 mm"])], shift: ["1 mm", "0 mm"], moving: true),
    walls: [Floor(material: "glass"), Chain(name: "bowl", points: [["-9 mm", "9 mm"], ["0 mm", "-1 mm"], ["9 mm", "9 mm"]], material: "glass",
        moves: Rotate(about: ["0 mm", "5 mm"], spin: ["1 rad/s"]))],
    inlets: [(name: "rain", low: ["0 mm", "20 mm"], high: ["9 mm", "29 mm"], rate: 100, number: 5, grading: Single("1 mm"), material: "glass")],
    stages: [(name: "fall", end: For("5 ms"), save: "end.csv"), (name: "push", end: Quiet(kinetic_over_potential: 1e-4, within: "9 ms"),
        changes: [Push(direction: [1, 0], speed: Some("0.1 m/s")), Halt("rain")])],
    solvers: { "grains": Dem((contact: Hertz, skin: 0.2)) },
    outputs: [(every: Time("1 ms"), write: Tracks(path: "tracks.csv", grains: Ids([0, 1]), fields: ["velocity"])),
        (every: Steps(50), write: Profile(path: "profile.csv", from: ["0 mm", "1 mm"], to: ["9 mm", "1 mm"], points: 5, fields: ["density"],
            grid: (from: ["0 mm", "0 mm"], to: ["9 mm", "9 mm"], spacing: "1 mm", width: 2)))],
)"#;

/// Spheres in a periodic cell that is compressed and sheared.
const IN_CELL: &str = r#"Scene(
    version: 1, dimension: Space,
    materials: { "g": (density: 1000, normal_stiffness: 1e4, restitution: 0.5, friction: 0.5) },
    sample: Cell(grains: 60, solid_fraction: 0.2, grading: Beta(min: "1 mm", max: "1.3 mm", a: 2, b: 3), material: "g"),
    cell: (periodic: [true, true, true]),
    stages: [(name: "press", end: For("1 ms"), changes: [Cell((stress: {"xx": "100 Pa", "yy": "100 Pa", "zz": "100 Pa"}, response: "1 ms"))]),
        (name: "shear", end: For("1 ms"), changes: [Cell((rate: {"xz": "5 1/s"}))])],
    solvers: { "grains": Dem(()) },
    outputs: [(every: Time("1 ms"), write: Table(path: "series.csv", probes: ["kinetic_energy", "cell_work"]))],
)"#;
