use super::*;
use crate::validate::{Measure, Rows, Tier, find};
use cases::{escaped, weakness};

/// A page outside of the tree.
fn page(rows: &[Row], effort: Effort) -> String {
    let path = Path::new("/somewhere/page.md");
    Report { effort, filter: None, path, rows }.page()
}

#[test]
fn every_row_has_a_line_of_as_many_cells_as_the_head() {
    let cases = [find(Some("grading")).unwrap(), find(Some("tessellation")).unwrap()].concat();
    let rows: Vec<Row> = cases.iter().flat_map(|case| case.run(Effort::Quick)).collect();
    let page = page(&rows, Effort::Quick);
    let cells = |line: &str| line.replace("\\|", "").matches('|').count();
    let of_rows: Vec<&str> = page.lines().skip_while(|line| !line.starts_with("### ")).collect();
    let of_rows: Vec<&str> = of_rows.into_iter().filter(|line| line.starts_with('|')).collect();
    assert!(of_rows.iter().all(|line| cells(line) == 9), "{page}");
    // Each table has a head of two lines.
    assert_eq!(of_rows.len(), rows.len() + 2 * cases.len());
    for case in &cases {
        assert_eq!(page.matches(&format!("\n### {}\n", case.name)).count(), 1);
        assert!(page.contains(&format!("| [{0}](#{0}) | {1} |", case.name, case.about)), "{page}");
    }
    assert!(page.contains("## Samples (`packing`)") && page.contains("## Weighted Voronoi diagrams"));
    assert!(!page.contains("What does not agree") && !page.contains("](../"), "{page}");
    assert!(page.contains("Weakness: tests the sizes only, not the positions.\n"));
}

#[test]
fn failures_come_first_and_claims_say_what_they_are() {
    let mut rows = Rows::new("grading", "packing");
    let note = "a reason that is too long to stand in a cell of a table | as it has a bar and then goes on";
    let claim = || Measure::relative(Tier::Thesis, "a | b [m]", 1.0, 2.0, 0.1).claim().note(note);
    rows.claims_need(80, 1000);
    rows.add(claim());
    rows.claims_need(1000, 1000);
    rows.add(claim());
    rows.add(Measure::absolute(Tier::Experiment, "angle", 1.0, 0.0, 0.1).note("short"));
    let page = page(&rows.finish(), Effort::Full);
    let (head, rest) = page.split_once("## What does not agree").unwrap();
    assert!(
        head.contains("\n- Form: complete\n")
            && head.contains("granular validate --full --report /somewhere/page.md`")
    );
    assert!(head.contains("| **0 of 1** | **0 of 1**, 1 small |"), "{head}");
    assert!(rest.contains("  - a \\| b \\[m\\] (**differs**)\n  - angle (**FAILED**)\n"), "{rest}");
    assert!(rest.contains("| 1.00000 | 2.00000 | 5.0e-1 | 1.0e-1 | small | see 1 |"), "{rest}");
    assert!(rest.contains("| 1.0e0 abs. | 1.0e-1 | **FAILED** | short |"), "{rest}");
    assert_eq!(rest.matches("a reason that").count(), 1, "notes that rows share stand once");
    assert!(rest.contains("\n1. a reason") && rest.contains("table \\| as it"), "{rest}");
}

#[test]
fn the_page_says_what_was_asked_for() {
    let path = Path::new("/somewhere/page.md");
    let text = Report { effort: Effort::Quick, filter: Some("grad"), path, rows: &[] }.page();
    assert!(text.contains("`granular validate grad --report /somewhere/page.md`"), "{text}");
    assert!(text.contains("- Form: quick") && text.contains("whose name contains `grad`"), "{text}");
}

#[test]
fn links_lead_to_the_tree_from_wherever_the_page_lies_in_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let link = |page: &str| Links::from(&root.join(page)).to("validation/x");
    assert_eq!(link("docs/page.md").as_deref(), Some("../validation/x"));
    assert_eq!(link("page.md").as_deref(), Some("validation/x"));
    assert_eq!(Links::from(Path::new("/somewhere/page.md")).to("validation/x"), None);
}

#[test]
fn what_a_readme_says_of_its_weakness_is_found_whole() {
    let text = "# A\n\n- Weakness: one\n  two.\n- Measured: 3\n";
    assert_eq!(weakness(text).as_deref(), Some("one two."));
    assert_eq!(weakness("# A\n"), None);
    // Links of a README lead elsewhere from the page.
    for case in crate::validate::all() {
        let found = weakness(granular_validation_data::readme(case.name).unwrap()).unwrap();
        assert!(!found.is_empty() && !found.contains("]("), "{}: {found}", case.name);
    }
}

#[test]
fn nothing_of_a_text_is_markup() {
    assert_eq!(escaped("E* of [a_b] | <c>"), "E\\* of \\[a\\_b\\] \\| \\<c>");
}

#[test]
fn a_page_that_cannot_be_written_is_refused_before_anything_is_run() {
    let folder = std::env::temp_dir().join(format!("granular-report-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let refusal = |path: &Path| can_write(path).unwrap_err().to_string();
    assert!(refusal(&folder).contains("it is a folder"));
    assert!(refusal(&folder.join("missing/page.md")).contains("cannot be written"));
    let page = folder.join("page.md");
    fs::write(&page, "old").unwrap();
    can_write(&page).unwrap();
    let left = fs::read_dir(&folder).unwrap().count();
    assert_eq!((left, fs::read_to_string(&page).unwrap().as_str()), (1, "old"), "nothing is touched");
    fs::remove_dir_all(&folder).unwrap();
}
