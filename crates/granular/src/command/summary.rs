//! What a run came to, for people.

use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// What is printed at the end of a run.
pub(super) fn of_result(facts: &Value, folder: &Path) -> String {
    let number = |key: &str| facts[key].as_f64().unwrap_or(f64::NAN);
    // Several solvers have no rate in common.
    let rate =
        facts["rate"].as_f64().map_or(String::new(), |rate| format!(" ({rate:.2e} {}-steps/s)", item(facts)));
    let mut text = format!(
        "done: {:.6} s in {} steps and {:.1} s of wall time{rate}\n",
        number("simulated_seconds"),
        facts["steps"],
        number("wall_seconds"),
    );
    text += &metrics(facts);
    text + &line("state hash", facts["state_hash"].as_str().unwrap_or(""))
        + &line("run folder", &folder.display().to_string())
}

/// What `granular info` tells of a run folder.
pub(super) fn of_run(facts: &Value, folder: &Path) -> String {
    let words = |key: &str| facts[key].as_str().unwrap_or("unknown").to_owned();
    let number = |value: &Value| value.as_f64().map_or("?".to_owned(), |number| format!("{number:.6}"));
    let mut text = format!("{}: {}\n", folder.display(), words("exit"));
    text += &line("solver", &words("solver"));
    let (time, steps) = (number(&facts["simulated_seconds"]), &facts["steps"]);
    text += &line("simulated", &format!("{time} s in {steps} steps"));
    if let (Some(wall), Some(rate)) = (facts["wall_seconds"].as_f64(), facts["rate"].as_f64()) {
        text += &line("wall time", &format!("{wall:.1} s, {rate:.2e} {}-steps/s", item(facts)));
    }
    for stage in facts["stages"].as_array().into_iter().flatten() {
        let end = match stage["ended"].as_str() {
            Some(why) => format!("to {} s ({why})", number(&stage["end"])),
            None => "on, not over".to_owned(),
        };
        let name = format!("stage {}", stage["name"].as_str().unwrap_or(""));
        text += &line(&name, &format!("from {} s {end}", number(&stage["start"])));
    }
    text += &metrics(facts);
    for (key, what) in [("failed", "figure failed"), ("left_out", "figure")] {
        for said in facts["figures"][key].as_array().into_iter().flatten().filter_map(Value::as_str) {
            text += &line(what, said);
        }
    }
    text += &line("state hash", &words("state_hash"));
    if let Some(built) = facts["built"].as_object() {
        let of = |key: &str| built.get(key).and_then(Value::as_str).unwrap_or("unknown");
        text += &line(
            "made by",
            &format!("version {}, commit {}, on {}", of("version"), of("commit"), of("cpu")),
        );
    }
    if let Some(files) = facts["checksums"].as_object() {
        text += &line("files", &format!("{} with checksums, which --json lists", files.len()));
    }
    text
}

/// What a step works on.
fn item(facts: &Value) -> &str {
    facts["item"].as_str().unwrap_or("grain")
}

fn metrics(facts: &Value) -> String {
    let mut text = String::new();
    for (name, value) in facts["metrics"].as_object().into_iter().flatten() {
        let unit = facts["units"][name].as_str().filter(|unit| *unit != "1").unwrap_or_default();
        let value = six_digits(value.as_f64().unwrap_or(f64::NAN));
        text += &line(&name.replace('_', " "), &format!("{value} {unit}"));
    }
    text
}

fn line(name: &str, value: &str) -> String {
    let mut text = String::new();
    let _ = write!(text, "  {name:<26} {value}");
    text.trim_end().to_owned() + "\n"
}

/// A number as people read it, to about six digits.
fn six_digits(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&size) { format!("{value:.6}") } else { format!("{value:.5e}") }
}
