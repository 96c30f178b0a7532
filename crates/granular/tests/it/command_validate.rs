//! `granular validate`: the report.

use crate::support::Scratch;
use std::fs;

#[test]
fn a_report_of_two_cases_has_their_rows_and_says_how_it_came_about() {
    let scratch = Scratch::new("report");
    let outcome = scratch.granular(&["validate", "_on_incline", "--report", "page.md", "--json"]).expect(0);
    let rows = outcome.json();
    let rows = rows.as_array().unwrap();
    let page = fs::read_to_string(scratch.path("page.md")).unwrap();
    let command = "- Command: `granular validate _on_incline --report page.md`\n";
    for part in [command, "commit `", "threads", "- Form: quick", "contains `_on_incline`", "## Overview"] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
    let headings: Vec<&str> = page.lines().filter(|line| line.starts_with("##")).collect();
    let method = "## Discrete element method (`dem`)";
    assert_eq!(headings, ["## Overview", method, "### disk_on_incline", "### ball_on_incline"]);
    assert_eq!(page.matches("\nWeakness: ").count(), 2);
    let of_rows = page.lines().filter(|line| line.starts_with("| ") && line.contains("| closed form |"));
    let of_rows: Vec<&str> = of_rows.filter(|line| !line.contains("](#")).collect();
    assert_eq!(of_rows.len(), rows.len(), "{page}");
    for (line, row) in of_rows.iter().zip(rows) {
        let metric: String = line.split(" | ").next().unwrap().replace(['|', '\\'], "");
        assert_eq!(metric.trim(), row["metric"].as_str().unwrap());
        assert!(line.contains("| pass |"), "{line}");
    }
    let left: Vec<_> =
        fs::read_dir(scratch.path("")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["page.md"], "nothing else is left behind");
}

#[test]
fn a_report_that_cannot_be_written_is_refused_before_anything_is_run() {
    let scratch = Scratch::new("report-nowhere");
    let outcome = scratch.granular(&["validate", "disk_on_incline", "--report", "missing/page.md"]).expect(5);
    assert!(!outcome.err.contains("a disk slips"), "{}", outcome.err);
    outcome.says(&["missing/page.md", "cannot be written"]);
}
