//! `docs/constitutive-laws.md` names every key that scenes may give.

use granular_constitutive::spec::ConstitutiveLawSpec;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

fn collect(schema: &Value, keys: &mut BTreeSet<String>) {
    match schema {
        Value::Object(object) => {
            if let Some(Value::Object(properties)) = object.get("properties") {
                keys.extend(properties.keys().cloned());
            }
            object.values().for_each(|inner| collect(inner, keys));
        }
        Value::Array(array) => array.iter().for_each(|inner| collect(inner, keys)),
        _ => {}
    }
}

#[test]
fn the_page_names_every_key() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/constitutive-laws.md");
    let page = std::fs::read_to_string(path).unwrap();
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let words: BTreeSet<&str> = page.split(|c: char| !is_word(c)).collect();
    let mut keys = BTreeSet::new();
    collect(schemars::schema_for!(ConstitutiveLawSpec).as_value(), &mut keys);
    assert!(keys.len() > 30 && keys.contains("MohrCoulomb"), "{keys:?}");
    let missing: Vec<&String> = keys.iter().filter(|key| !words.contains(key.as_str())).collect();
    assert!(missing.is_empty(), "the page lacks {missing:?}");
}
