//! `granular validate stability`: the command.

use crate::support::Scratch;

#[test]
fn the_command_prints_the_promised_keys_and_keeps_its_plain_form() {
    let scratch = Scratch::new("stability");
    let sweep = ["validate", "stability", "lbm", "--operator", "regularised", "--flow", "cavity", "--json"];
    let rows = scratch.granular(&sweep).expect(0).json();
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 8);
    for row in rows {
        let keys: Vec<&str> = row.as_object().unwrap().keys().map(String::as_str).collect();
        let promised = "case parameter predicted_limit observed_limit outcome reason known";
        assert_eq!(keys, promised.split(' ').collect::<Vec<_>>());
        assert!(["finished", "refused", "stopped"].contains(&row["outcome"].as_str().unwrap()), "{row}");
        assert!(!row["reason"].as_str().unwrap().is_empty());
    }
    let plain = scratch.granular(&["validate", "grading", "--full", "--json"]).expect(0).json();
    assert!(!plain.as_array().unwrap().is_empty());
    scratch.granular(&["validate", "stability", "lbm", "--operator", "triple"]).expect(2);
}

#[test]
fn flags_of_the_fluid_are_refused_for_grains() {
    let scratch = Scratch::new("stability-dem");
    let outcome = scratch.granular(&["validate", "stability", "dem", "--operator", "single"]);
    assert_ne!(outcome.code, Some(0));
    outcome.says(&["--operator and --flow are of `lbm`"]);
}
