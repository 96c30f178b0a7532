//! `docs/adding-a-law.md` names every part of a contact law.

const PAGE: &str = include_str!("../../../../docs/adding-a-law.md");
const SOURCE: &str = include_str!("../../src/law.rs");

#[test]
fn every_part_of_a_law_is_on_the_page() {
    let (_, rest) = SOURCE.split_once("pub trait ContactLaw<").expect("the trait is there");
    let body = rest.split("\n}\n").next().unwrap_or_default();
    let word = |line: &str| {
        let line = line.strip_prefix("    ")?;
        let rest = ["type ", "const ", "fn "].iter().find_map(|start| line.strip_prefix(start))?;
        rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().map(str::to_owned)
    };
    let parts: Vec<String> = body.lines().filter_map(word).collect();
    assert!(parts.len() > 7, "{parts:?}");
    for part in parts {
        assert!(PAGE.contains(&format!("`{part}`")), "docs/adding-a-law.md does not explain `{part}`");
    }
}
