use super::{Effort, all, table};

/// Runs the quick form of a case and fails with its table when a required row does.
pub(crate) fn passes(name: &str) {
    let case = all().find(|case| case.name == name).unwrap();
    let rows = case.run(Effort::Quick);
    assert!(rows.iter().any(|row| row.gate), "{name} requires nothing");
    assert!(rows.iter().all(|row| row.pass || !row.gate), "{}", table(&rows));
}

#[test]
fn every_case_says_what_its_evidence_is_worth() {
    for case in all() {
        let text =
            granular_validation_data::readme(case.name).unwrap_or_else(|| panic!("{}: no README", case.name));
        for part in ["Evidence", "Source", "Set-up", "Weakness"] {
            assert!(text.contains(&format!("- {part}:")), "{}: {part}", case.name);
        }
    }
}
