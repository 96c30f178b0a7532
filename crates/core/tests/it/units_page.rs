//! `docs/units.md` lists the units that are read, all of them, and with the right size.

use granular_core::units::{Dimension, parse};

const PAGE: &str = include_str!("../../../../docs/units.md");
const TABLES: &str = include_str!("../../src/units/symbols.rs");

/// Cells of the rows under a heading, without their code marks.
fn rows(heading: &str) -> Vec<Vec<String>> {
    let (_, section) = PAGE.split_once(&format!("## {heading}\n")).expect("the page has this heading");
    let section = section.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter(|line| line.starts_with('|')).skip(2);
    let cells = |line: &str| {
        line.trim_matches('|').split('|').map(|cell| cell.replace('`', "").trim().to_owned()).collect()
    };
    rows.map(cells).collect()
}

/// First strings of the entries of a table in the source, which begin with `start`.
fn names(table: &str, start: &str) -> Vec<String> {
    let (_, rest) = TABLES.split_once(table).expect("the source has this table");
    let body = rest.split("];").next().unwrap_or_default();
    let name = |line: &str| Some(line.trim().strip_prefix(start)?.split('"').next()?.to_owned());
    body.lines().filter_map(name).collect()
}

/// The value of a text, whatever it measures.
fn value(text: &str) -> Option<(f64, &'static str)> {
    Dimension::ALL.iter().find_map(|dimension| Some((parse(text, *dimension).ok()?, dimension.name)))
}

#[test]
fn every_unit_is_listed_with_its_size() {
    let listed = rows("Units");
    let known = names("const SYMBOLS", "symbol(\"");
    assert!(known.len() > 15, "{known:?}");
    assert_eq!(listed.iter().map(|row| row[0].clone()).collect::<Vec<_>>(), known);
    for row in &listed {
        let [unit, _, si, prefixes] = &row[..] else { panic!("{row:?}") };
        let found = value(&format!("1 {unit}")).unwrap_or_else(|| panic!("`{unit}` is not read"));
        let stated = value(si).unwrap_or_else(|| panic!("`{si}` is not read"));
        assert_eq!(found.1, stated.1, "{unit}");
        assert!((found.0 / stated.0 - 1.0).abs() < 1e-15, "{unit}: {found:?} {stated:?}");
        let kilo = value(&format!("1 k{unit}")).is_some_and(|kilo| kilo.0 == 1e3 * found.0);
        assert_eq!(kilo, prefixes == "yes", "{unit}");
    }
    // A drum at 300 turns a minute.
    let spin = value("300 rpm").unwrap();
    assert!((spin.0 - 10.0 * std::f64::consts::PI).abs() < 1e-12 && spin.1 == "angular velocity");
}

#[test]
fn every_prefix_and_every_quantity_is_listed() {
    let listed: Vec<String> = rows("Prefixes")
        .iter()
        .flat_map(|row| row[0].split(", ").map(str::to_owned).collect::<Vec<_>>())
        .collect();
    // Two spellings of micro are written as numbers in the source.
    let known = names("const PREFIXES", "(\"");
    assert_eq!(listed.len(), known.len());
    for row in rows("Prefixes") {
        for prefix in row[0].split(", ") {
            let (found, _) = value(&format!("1 {prefix}N")).unwrap_or_else(|| panic!("{prefix}"));
            assert_eq!(found, row[1].parse::<f64>().unwrap(), "{prefix}");
        }
    }
    let quantities: Vec<[String; 3]> =
        Dimension::ALL.iter().map(|d| [d.name, d.unit, d.example].map(str::to_owned)).collect();
    assert_eq!(rows("What values measure"), quantities);
    for [_, _, example] in quantities {
        assert!(value(&example).is_some(), "{example}");
    }
}
