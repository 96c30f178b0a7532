//! What each verb prints and writes when all is well.

use crate::support::{SMALL, Scratch, assert_same_run, facts, files, results, workspace};
use serde_json::Value;
use std::fs;
use std::process::Command;

/// Makes the small scene short: 20 ms in all.
const SHORT: &[&str] = &["--set", "stages.0.end=For(\"5 ms\")", "--set", "stages.1.end=For(\"15 ms\")"];

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

/// Only numbers that are there and finite have values in JSON.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn run_prints_one_object_of_the_promised_form() {
    let scratch = Scratch::with_scene("json");
    let outcome =
        scratch.granular(&[&["run", "small.ron", "--json", "--out", "a"], SHORT].concat()).expect(0);
    let result = outcome.json();
    let promised =
        "scene solver exit simulated_seconds steps wall_seconds rate state_hash metrics".split(' ');
    assert_eq!(keys(&result), promised.collect::<Vec<_>>());
    assert_eq!((result["solver"].as_str(), result["exit"].as_str()), (Some("dem"), Some("done")));
    assert_eq!(result["scene"], "a/scene.ron");
    assert!((number(&result["simulated_seconds"]) - 0.02).abs() < 1e-4, "{result}");
    assert!(number(&result["steps"]) > 100.0 && number(&result["rate"]) > 0.0);
    assert!(number(&result["wall_seconds"]) > 0.0);
    let hash = result["state_hash"].as_str().unwrap();
    assert!(hash.len() == 32 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{hash}");
    assert!(result["metrics"].as_object().unwrap().values().all(Value::is_number));
    // Each number has its unit in `run.json`.
    let facts = facts(&scratch.path("a"));
    assert_eq!(keys(&facts["units"]), keys(&result["metrics"]));
    assert_eq!((&facts["units"]["front"], &facts["units"]["runout"]), (&"m".into(), &"1".into()));
    // Progress goes to standard error, and is silenced with --quiet.
    assert!(outcome.err.contains("settle: 0.000000 s to 0.005"), "{}", outcome.err);
    let quiet = [&["run", "small.ron", "--json", "--quiet", "--out", "b"], SHORT].concat();
    assert_eq!(scratch.granular(&quiet).expect(0).err, "");
    assert_same_run(&scratch.path("a"), &scratch.path("b"));
}

#[test]
fn check_prints_one_object_also_when_it_refuses() {
    let scratch = Scratch::with_scene("check");
    let good = scratch.granular(&["check", "small.ron", "--json"]).expect(0).json();
    for key in ["limits", "memory_bytes", "estimated_seconds", "left_out", "problems"] {
        assert!(!good[key].is_null(), "{key} is missing in {good}");
    }
    for limit in good["limits"].as_array().unwrap() {
        assert!(limit["name"].is_string() && limit["binds"].is_boolean(), "{limit}");
        assert!(number(&limit["value"]) <= number(&limit["bound"]) * (1.0 + 1e-12), "{limit}");
    }
    assert_eq!(good["problems"], serde_json::json!([]));
    assert!(number(&good["memory_bytes"]) > 1e4 && number(&good["estimated_seconds"]) > 0.0);

    let step = ["--set", "solvers.grains=Dem((time_step: \"1 ms\"))"];
    let refused = scratch.granular(&[&["check", "small.ron", "--json"], &step[..]].concat()).expect(3);
    assert_eq!(refused.json()["problems"].as_array().map(Vec::len), Some(2), "one a stage");
    assert!(refused.json()["estimated_seconds"].is_null(), "nothing was measured");
    let text = scratch.granular(&[&["check", "small.ron"], &step[..]].concat()).expect(3);
    assert!(text.out.contains("the scene is refused") && text.err.contains("refused: small.ron: "));
    assert_eq!(files(&scratch.path("")).len(), 1, "a check writes nothing");
}

#[test]
fn failures_are_one_object_too() {
    let scratch = Scratch::with_scene("failures");
    let cases: [(&[&str], i32); 5] = [
        (&["run", "small.ron", "--set", "version=2"], 2),
        (&["check", "small.ron", "--set", "version=2"], 2),
        (&["run", "small.ron", "--set", "solvers.grains=Dem((time_step: \"1 ms\"))"], 3),
        (&["resume", "nowhere"], 5),
        (&["plot", "nowhere"], 5),
    ];
    for (arguments, code) in cases {
        let outcome = scratch.granular(&[arguments, &["--json"]].concat()).expect(code);
        let failure = outcome.json();
        assert_eq!(keys(&failure), ["exit", "problems"]);
        assert_eq!(failure["exit"], code);
        assert!(!failure["problems"].as_array().unwrap().is_empty());
    }
    let problem =
        &scratch.granular(&["check", "small.ron", "--json", "--set", "version=2"]).json()["problems"][0];
    assert_eq!(problem["place"]["path"], "version");
    assert_eq!((&problem["place"]["file"], &problem["place"]["line"]), (&"small.ron".into(), &3.into()));
    assert_eq!(problem["allowed"], "1");
}

#[test]
fn assignments_reach_the_run_and_its_scene() {
    let scratch = Scratch::with_scene("set");
    let edits = ["--set", "sample.aspect_ratio=1.5", "--set", "materials.glass.normal_stiffness=5e4 N/m"];
    let run = |out: &str, more: &[&str]| {
        let arguments = [&["run", "small.ron", "--json", "-q", "--out", out], SHORT, more].concat();
        scratch.granular(&arguments).expect(0).json()
    };
    let (plain, edited) = (run("plain", &[]), run("edited", &edits));
    let ratio = |result: &Value| number(&result["metrics"]["aspect_ratio"]);
    assert!((ratio(&plain) - 0.8).abs() < 0.15 && (ratio(&edited) - 1.5).abs() < 0.25, "{plain} {edited}");
    // A softer contact lasts longer by the root of two, and so does the step.
    let dt = |out: &str| number(&facts(&scratch.path(out))["stages"][0]["dt"]);
    assert!((dt("edited") / dt("plain") - 2.0_f64.sqrt()).abs() < 1e-9);
    let text = fs::read_to_string(scratch.path("edited/scene.ron")).unwrap();
    assert!(text.contains("aspect_ratio: 1.5,") && text.contains("normal_stiffness: \"5e4 N/m\""), "{text}");
    assert!(text.starts_with("// A small column"), "comments stay");
    // The scene of the folder is the whole truth: run again, it gives the same bits.
    let again = ["run", "edited/scene.ron", "-q", "--out", "again"];
    scratch.granular(&again).expect(0);
    assert_same_run(&scratch.path("edited"), &scratch.path("again"));
    assert_eq!(fs::read_to_string(scratch.path("small.ron")).unwrap(), SMALL, "the scene file itself stays");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scratch = Scratch::with_scene("threads");
    // Large enough for several blocks of grains.
    let edits = [
        "sample.extent=Grains(1600)",
        "stages.0.end=For(\"4 ms\")",
        "stages.1.end=For(\"6 ms\")",
        "figures=[]",
    ];
    let edits: Vec<&str> = edits.iter().flat_map(|edit| ["--set", edit]).collect();
    for threads in ["1", "2", "3", "8"] {
        let arguments = [&["run", "small.ron", "-q", "--threads", threads, "--out", threads], &edits[..]];
        scratch.granular(&arguments.concat()).expect(0);
        assert_eq!(facts(&scratch.path(threads))["built"]["threads"].to_string(), threads);
        assert_same_run(&scratch.path("1"), &scratch.path(threads));
    }
}

#[test]
fn plot_draws_the_same_figures_again_and_info_tells() {
    let scratch = Scratch::with_scene("plot");
    scratch.granular(&["run", "small.ron", "-q", "--out", "run"]).expect(0);
    let before = files(&scratch.path("run"));
    let figures = ["runout", "energies", "flow", "force_chains"];
    for name in figures {
        for ending in ["svg", "png"] {
            fs::remove_file(scratch.path(&format!("run/{name}.{ending}"))).unwrap();
        }
    }
    let listed = scratch.granular(&["plot", "run", "--json"]).expect(0).json();
    assert_eq!(listed, serde_json::json!(figures.map(|name| format!("run/{name}"))));
    assert!(files(&scratch.path("run")) == before, "the figures differ");

    let run = scratch.granular(&["info", "run", "--json"]).expect(0).json();
    assert_eq!(run, facts(&scratch.path("run")));
    let program = scratch.granular(&["info", "--json"]).expect(0).json();
    assert_eq!(program["version"], env!("CARGO_PKG_VERSION"));
    let shown = scratch.granular(&["info", "small.ron"]).expect(0).out;
    for (kind, name) in [("Number", "front"), ("Field", "speed"), ("Link", "normal_force")] {
        let told = |line: &str| line.starts_with(kind) && line.split_whitespace().nth(1) == Some(name);
        assert!(shown.lines().any(told), "{kind} {name} is not in\n{shown}");
    }
}

#[test]
fn templates_are_the_examples_and_pass_the_check() {
    let scratch = Scratch::new("new");
    let list = scratch.granular(&["new", "--list"]).expect(0).out;
    assert_eq!(scratch.granular(&["new"]).expect(0).out, list);
    let json = scratch.granular(&["new", "--list", "--json"]).expect(0).json();
    assert_eq!(json.as_array().unwrap().len(), list.lines().count());
    let examples: Vec<_> = fs::read_dir(workspace().join("examples"))
        .unwrap()
        .filter_map(|entry| fs::read_to_string(entry.unwrap().path().join("scene.ron")).ok())
        .collect();
    assert_eq!(list.lines().count(), granular_driver::TEMPLATES.len());
    for (name, _) in granular_driver::TEMPLATES {
        let line = list.lines().find(|line| line.starts_with(name)).expect("the template is listed");
        assert!(line.len() > name.len() + 10, "`{line}` says nothing");
        let text = scratch.granular(&["new", name]).expect(0).out;
        assert!(examples.contains(&text), "template {name} is no example, byte for byte");
        fs::write(scratch.path("scene.ron"), text).unwrap();
        scratch.granular(&["check", "scene.ron"]).expect(0);
    }
}

/// A reader that leaves, as `head` does, must not stop a run or cause a panic.
#[test]
fn a_closed_pipe_does_no_harm() {
    let scratch = Scratch::with_scene("pipe");
    let program = env!("CARGO_BIN_EXE_granular");
    let short = SHORT.iter().map(|word| format!("'{word}'")).collect::<Vec<_>>().join(" ");
    // The reader has left before the first byte comes; the exit code is that of granular.
    let script = format!(
        "set -o pipefail; ( {program} run small.ron {short} --out run 2>&1 ) | true; echo $? > code; \
         ( sleep 0.1; {program} new column-collapse ) | true; echo $? >> code"
    );
    let mut shell = Command::new("bash");
    shell.args(["-c", &script]);
    scratch.start_command(shell).wait().expect(0);
    assert_eq!(fs::read_to_string(scratch.path("code")).unwrap(), "0\n0\n");
    assert_eq!(facts(&scratch.path("run"))["exit"], "done");
    assert!(results(&scratch.path("run")).contains_key("series.csv"));
}
