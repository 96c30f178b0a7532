//! What a scene asks for beyond what a machine has: refused at once, before memory is taken.

use crate::support::{Outcome, SMALL, Scratch};
use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};

/// Far longer than a refusal takes, also on a machine that others load; without a cap these took minutes or all memory.
const SOON: Duration = Duration::from_secs(10);

#[track_caller]
fn soon<T>(work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let done = work();
    assert!(begun.elapsed() < SOON, "{:?}", begun.elapsed());
    done
}

/// Grains in a cell, and what is asked of them.
fn cell(more: &str) -> String {
    format!(
        r#"Scene(version: 1, dimension: Plane,
    materials: {{ "g": (density: 1000, normal_stiffness: 1e5, restitution: 0.5, friction: 0.5) }},
    sample: Cell(grains: 900, solid_fraction: 0.4, grading: Single("1 mm"), material: "g"), cell: (periodic: [true, true]),
    stages: [(name: "s", end: For("1 ms"))], solvers: {{ "grains": Dem(()) }}, {more})"#
    )
}

/// The command with so much address space.
#[cfg(target_os = "linux")]
fn with_memory(scratch: &Scratch, kilobytes: u64, arguments: &[&str]) -> Outcome {
    let mut command = Command::new("sh");
    command.args([
        "-c",
        &format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\""),
        env!("CARGO_BIN_EXE_granular"),
    ]);
    command.args(arguments).args(["--threads", "1"]);
    scratch.start_command(command).wait()
}

#[test]
fn counts_beyond_reason_are_refused_at_once() {
    let scratch = Scratch::with_scene("counts");
    fs::write(scratch.path("cell.ron"), cell("")).unwrap();
    let line = r#"outputs=[(every: Time("1 s"), write: Profile(path: "p.csv", from: [0, 0], to: [1, 1], points: 4000000000000,
        fields: ["density"], grid: (from: [0, 0], to: [1, 1], spacing: 0.1)))]"#;
    let rain = r#"inlets=[(name: "rain", low: ["0 mm", "90 mm"], high: ["30 mm", "120 mm"], rate: 1e9,
        grading: Single("1 mm"), material: "glass")]"#;
    let held = r#"walls.0=HeldGrains(name: "base", low: [0, 0], high: [1, 1], diameter: 1e-5, spacing: 1e-5, material: "wall")"#;
    let cases: &[(&str, &str, i32, &[&str])] = &[
        (
            "cell.ron",
            "sample.grains=18446744073709551615",
            2,
            &["`sample.grains` is 18446744073709551615", "at most 1e8 grains"],
        ),
        ("cell.ron", "sample.grains=4000000000", 2, &["`sample.grains` is 4000000000", "at most 1e8 grains"]),
        ("small.ron", "sample.extent=Grains(18446744073709551615)", 2, &["at most 1e8 grains"]),
        ("cell.ron", line, 2, &["`outputs.0.write.points` is 4000000000000", "of memory are free"]),
        (
            "small.ron",
            rain,
            3,
            &["`inlets.0.rate` is 1000000000 1/s", "would be due in 100 steps", "1e4 grains at once"],
        ),
        ("small.ron", held, 2, &["10000200001 held grains", "at most 1e7"]),
    ];
    for &(scene, assignment, code, parts) in cases {
        let edits = ["check", scene, "--set", assignment, "--set", "figures=[]"];
        soon(|| scratch.granular(&edits)).expect(code).says(parts);
    }
    let axes = ["--set", "sample.seed=1..99999", "--set", "sample.extent=Grains(1),Grains(2)", "--dry-run"];
    let sweep = soon(|| scratch.granular(&[&["sweep", "small.ron"], &axes[..]].concat()));
    sweep.expect(2).says(&["the axes make 99999 x 2 = 199998 runs", "at most 100000 runs"]);
    let many = ["check", "small.ron", "--threads", "5000"];
    soon(|| scratch.granular(&many))
        .expect(0)
        .says(&["warning: 5000 threads are more than this machine can use"]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_the_memory_of_the_machine_cannot_hold_is_refused() {
    let scratch = Scratch::with_scene("memory");
    fs::write(scratch.path("cell.ron"), cell("")).unwrap();
    let averages = r#"outputs.0.write=Fields(path: "f", fields: ["density"], grid: (from: [0, 0], to: [1, 1], spacing: 1e-3))"#;
    let cases: &[(&str, &str, &str)] = &[
        ("cell.ron", "sample.grains=3000000", "`sample.grains` is 3000000"),
        ("small.ron", "sample.extent=Grains(3000000)", "`sample.extent` is a column of 3000000 grains"),
        ("small.ron", averages, "so small that the grid has 1000000 cells"),
    ];
    for (scene, assignment, part) in cases {
        let edits = ["check", scene, "--set", assignment, "--set", "figures=[]"];
        soon(|| with_memory(&scratch, 1_000_000, &edits)).expect(2).says(&[part, "of memory are free"]);
    }
    let said = soon(|| with_memory(&scratch, 1_000_000, &["check", "/dev/zero"])).expect(2);
    said.says(&["for which this machine has memory"]);
    let endless = ["check", "small.ron", "--set", "sample=File(path: \"/dev/zero\")", "--set", "walls=[]"];
    soon(|| with_memory(&scratch, 1_000_000, &endless)).expect(2).says(&["it is not a file"]);
}

/// Each problem has its place, which once took the reading of the whole text.
#[test]
fn thousands_of_problems_are_told_at_once() {
    let scratch = Scratch::new("problems");
    let grain = "        (position: [0, 0], radius: -1, material: \"stone\"),\n";
    let list = format!("sample: Grains([\n{}]),", grain.repeat(3000));
    let begin = SMALL.find("sample:").unwrap();
    let end = SMALL.find("walls:").unwrap();
    fs::write(scratch.path("many.ron"), format!("{}{list}\n    {}", &SMALL[..begin], &SMALL[end..])).unwrap();
    let said = soon(|| scratch.granular(&["check", "many.ron"])).expect(2);
    let said =
        said.says(&["`sample.Grains.0.radius` is -1 m", "`sample.Grains.2.material`", "more problems"]);
    assert!(said.err.lines().count() < 2000, "{}", said.err.lines().count());
}

/// A lattice of 27 million cells, of which only the few numbers that bounds need are looked at.
#[test]
fn a_fine_lattice_is_refused_before_it_is_built() {
    let scratch = Scratch::new("fine");
    let scene = r#"Scene(version: 1, dimension: Space,
        fluid: (size: ["0.3 m", "0.3 m", "0.3 m"], viscosity: "1e-6 m^2/s", faces: (bottom: Wall, top: MovingWall(["9 m/s", "0 m/s", "0 m/s"]))),
        solvers: { "water": Lbm((spacing: "1 mm", step: RelaxationTime(0.8))) }, stages: [(name: "s", end: For("1 s"))])"#;
    fs::write(scratch.path("fine.ron"), scene).unwrap();
    let said = soon(|| scratch.granular(&["check", "fine.ron", "--json"])).expect(3);
    assert_eq!(said.says(&["Mach number is ", "allowed: at most 0.3"]).json()["exit"], 3);
}

#[test]
fn sizes_that_do_not_fit_together_are_told_at_the_sample() {
    let scratch = Scratch::new("sizes");
    let scene = r#"Scene(version: 1, dimension: Plane,
        materials: { "g": (density: 1000, normal_stiffness: 1e5, restitution: 0.5, friction: 0.5) },
        sample: Grains([(position: [0, 0.1], radius: "1 mm", material: "g"),
            (position: [0.1, 0.1], radius: 5e-324, material: "g")]),
        stages: [(name: "s", end: For("1 ms"))], solvers: { "grains": Dem(()) })"#;
    std::fs::write(scratch.path("scene.ron"), scene).unwrap();
    let said = "`sample` is refused: smallest radius of a grain, where the largest is 0.001 m, is 5e-324";
    scratch.granular(&["check", "scene.ron"]).expect(2).says(&[said, "at least a millionth of the largest"]);
}
