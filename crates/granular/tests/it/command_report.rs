//! Pages about runs.

use crate::support::Scratch;
use serde_json::Value;
use std::fs;

/// What the scripts of a page read.
fn data(page: &str) -> Value {
    let start = "<script type=\"application/json\" id=\"data\">";
    let from = page.find(start).unwrap() + start.len();
    serde_json::from_str(&page[from..from + page[from..].find("</script>").unwrap()]).unwrap()
}

#[test]
fn a_page_tells_limits_sizes_and_stages_of_runs_side_by_side() {
    let scratch = Scratch::with_scene("report");
    for name in ["first", "second"] {
        scratch.granular(&["run", "small.ron", "--out", name, "-q"]).expect(0);
    }
    let told = scratch.granular(&["report", "first", "second", "--json"]).expect(0).json();
    assert_eq!((&told["runs"], &told["file"]), (&Value::from(2), &Value::from("report.html")));
    let page = fs::read_to_string(scratch.path("report.html")).unwrap();
    assert_eq!(told["bytes"], page.len());
    for run in data(&page)["runs"].as_array().unwrap() {
        let limits = run["limits"].as_array().unwrap();
        assert!(limits.iter().any(|limit| limit["binds"] == true), "{limits:?}");
        assert!(run["facts"]["sizes"]["grains"]["count"].as_u64().unwrap() > 0, "{}", run["facts"]);
        assert!(!run["facts"]["stages"].as_array().unwrap().is_empty());
        assert!(!run["tables"].as_array().unwrap().is_empty());
    }
    // One folder keeps its page.
    scratch.granular(&["report", "first"]).expect(0);
    assert!(scratch.path("first/report.html").is_file());
    scratch.granular(&["report", "none"]).expect(5).says(&["no such folder", "allowed", "granular run"]);
}
