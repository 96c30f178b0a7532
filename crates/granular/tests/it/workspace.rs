//! Rules of the workspace that no compiler checks: who depends on whom, how long files are, and
//! that what is cited exists.

use crate::support::workspace;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Who may depend on whom: all edges between packages of the workspace.
const ALLOWED: &[(&str, &str)] = &[
    ("granular-core", ""),
    ("granular-constitutive", "core"),
    ("granular-mpm", "core constitutive"),
    ("granular-packing", "core"),
    ("granular-dem", "core"),
    ("granular-lbm", "core"),
    ("granular-tessellate", "core"),
    ("granular-coupling", "core"),
    ("granular-io", "core"),
    ("granular-report", "io"),
    ("granular-validation-data", ""),
    ("granular-driver", "core packing constitutive dem lbm mpm tessellate coupling io"),
    ("granular-studies", "core packing constitutive dem lbm mpm tessellate io driver validation-data"),
    ("granular", "core driver report studies"),
];

/// All other packages that come with one that is used alone, at any depth: `rayon` is more than one.
const BROUGHT: &[(&str, &str)] = &[
    ("granular-core", "glam rayon"),
    ("granular-constitutive", "glam rayon"),
    ("granular-mpm", "glam rayon multiversion granular-constitutive"),
    ("granular-packing", "glam rayon rand_chacha rand_core ppv-lite86 zerocopy"),
    ("granular-dem", "glam rayon multiversion"),
    ("granular-lbm", "glam rayon multiversion bytemuck memmap2 libc"),
    ("granular-tessellate", "glam rayon robust"),
    ("granular-coupling", "glam rayon"),
];

/// What these bring themselves.
const FAMILIES: &[(&str, &str)] = &[
    ("rayon", "rayon-core crossbeam-deque crossbeam-epoch crossbeam-utils either"),
    ("multiversion", "multiversion-macros rustversion proc-macro2 quote syn unicode-ident"),
];

/// Libraries of methods, which only the folders of methods may name.
const METHODS: [&str; 5] =
    ["granular_dem", "granular_lbm", "granular_coupling", "granular_mpm", "granular_constitutive"];

/// Lines that a source file may have, with its tests.
const LONGEST_FILE: usize = 700;

fn cargo(arguments: &[&str]) -> String {
    let mut command = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned()));
    let output = command.args(arguments).current_dir(workspace()).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("cargo writes UTF-8")
}

#[test]
fn packages_depend_only_on_what_the_design_allows() {
    let text = cargo(&["metadata", "--no-deps", "--format-version", "1", "--offline"]);
    let metadata: Value = serde_json::from_str(&text).unwrap();
    let name = |value: &Value| value["name"].as_str().expect("packages have names").to_owned();
    let packages: BTreeMap<String, &Value> =
        metadata["packages"].as_array().unwrap().iter().map(|package| (name(package), package)).collect();
    let mut forbidden = Vec::new();
    for (package, about) in &packages {
        let rule = ALLOWED.iter().find(|(known, _)| known == package);
        let (_, allowed) = rule.unwrap_or_else(|| panic!("{package} has no line in ALLOWED"));
        let is_allowed =
            |other: &str| allowed.split(' ').any(|short| other.strip_prefix("granular-") == Some(short));
        for dependency in about["dependencies"].as_array().unwrap() {
            let other = name(dependency);
            // Tests may use other packages: `dev`.
            let counts = packages.contains_key(&other) && dependency["kind"] != "dev";
            if counts && !is_allowed(&other) {
                forbidden.push(format!("{package} -> {other}"));
            }
        }
    }
    assert!(forbidden.is_empty(), "the design (docs/architecture.md) has no edge {}", forbidden.join(", "));
}

#[test]
fn a_package_alone_brings_what_is_listed_and_nothing_else() {
    for (package, brought) in BROUGHT {
        let tree = cargo(&["tree", "-p", package, "-e", "normal", "--offline", "--prefix", "none"]);
        let names: BTreeSet<&str> = tree.lines().filter_map(|line| line.split_whitespace().next()).collect();
        let mut known: BTreeSet<&str> = brought.split(' ').collect();
        for (head, family) in FAMILIES {
            if known.contains(head) {
                known.extend(family.split(' '));
            }
        }
        known.extend([*package, "granular-core"]);
        assert_eq!(names, known, "{package} brings other packages than those listed");
    }
}

/// All files below some folders of the workspace whose names end so.
fn files_below(folders: &[&str], ending: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = folders.iter().map(|folder| workspace().join(folder)).collect();
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|other| other == ending) {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path, text));
            }
        }
    }
    found
}

/// All Rust sources of the packages.
fn sources() -> Vec<(PathBuf, String)> {
    let mut found = files_below(&["crates", "validation"], "rs");
    found.retain(|(path, _)| path.components().any(|part| part.as_os_str() == "src"));
    assert!(found.len() > 100, "the crates are there");
    found
}

#[test]
fn only_the_folders_of_methods_name_their_crates() {
    let mut found = Vec::new();
    for (path, text) in files_below(&["crates/driver/src", "crates/studies/src", "crates/granular/src"], "rs")
    {
        let is_method = path.components().any(|part| part.as_os_str() == "methods");
        if !is_method && METHODS.iter().any(|name| text.contains(name)) {
            found.push(shown(&path));
        }
    }
    assert!(found.is_empty(), "{} name the crate of a method", found.join(", "));
}

fn shown(path: &Path) -> String {
    path.strip_prefix(workspace()).unwrap_or(path).display().to_string()
}

#[test]
fn files_are_short_enough_to_read() {
    let long: Vec<String> = sources()
        .iter()
        .map(|(path, text)| (shown(path), text.lines().count()))
        .filter(|(_, lines)| *lines > LONGEST_FILE)
        .map(|(path, lines)| format!("{path}: {lines} lines"))
        .collect();
    assert!(long.is_empty(), "split what has more than {LONGEST_FILE} lines: {}", long.join(", "));
}

/// Keys in a comment: `[Kumar2014, eq. 3.43]` cites `Kumar2014`. A key is a name with a capital
/// letter, then a year of four digits.
fn keys(comment: &str) -> Vec<String> {
    let brackets = comment.split('[').skip(1).map(|rest| rest.split(']').next().unwrap_or_default());
    let words = brackets.flat_map(|inside| inside.split(|c: char| !c.is_alphanumeric()));
    words.filter(|word| is_key(word)).map(str::to_owned).collect()
}

fn is_key(word: &str) -> bool {
    let name = word.trim_end_matches(|c: char| c.is_ascii_lowercase());
    // A letter may follow the year, as in `Kumar2014b`.
    let name = if word.len() <= name.len() + 1 { name } else { word };
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    letters.starts_with(char::is_uppercase)
        && letters.chars().all(char::is_alphabetic)
        && name.len() == letters.len() + 4
}

#[test]
fn keys_are_told_from_other_words() {
    let text = r"after \[Vold1959, Kumar2014b, section 3.5\] and [`Grain2D`], [D3], [a2014], [Name14]";
    assert_eq!(keys(text), ["Vold1959", "Kumar2014b"]);
}

#[test]
fn what_is_cited_is_in_the_references_and_the_other_way_round() {
    let mut cited: BTreeMap<String, String> = BTreeMap::new();
    for (path, text) in files_below(&["crates", "validation"], "rs") {
        // A citation may break over two lines, so that a comment is read as a whole.
        let is_comment = |line: &&str| line.trim_start().starts_with("//");
        let comment: Vec<&str> = text
            .lines()
            .filter(is_comment)
            .map(|line| line.trim_start().trim_start_matches(['/', '!']))
            .collect();
        for key in keys(&comment.join(" ")) {
            cited.entry(key).or_insert_with(|| shown(&path));
        }
    }
    for (path, text) in files_below(&["docs"], "md") {
        if !path.ends_with("references.md") {
            keys(&text).into_iter().for_each(|key| _ = cited.entry(key).or_insert_with(|| shown(&path)));
        }
    }
    let page =
        fs::read_to_string(workspace().join("docs/references.md")).expect("docs/references.md is there");
    let listed: BTreeSet<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("- **")?.split_once("**"))
        .map(|(key, _)| key)
        .collect();
    assert!(cited.len() >= 4, "citations are found: {cited:?}");
    for (key, path) in &cited {
        assert!(listed.contains(key.as_str()), "{path} cites [{key}], which docs/references.md lacks");
    }
    for key in listed {
        assert!(cited.contains_key(key), "docs/references.md lists [{key}], which nothing cites");
    }
}

/// What a package needs to be published: its own README, both licences and words to be found by; no address that does not
/// exist.
#[test]
fn packages_carry_what_their_users_read() {
    let text = cargo(&["metadata", "--no-deps", "--format-version", "1", "--offline"]);
    let metadata: Value = serde_json::from_str(&text).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 8, "{} packages", packages.len());
    for package in packages {
        let name = package["name"].as_str().unwrap();
        let folder = Path::new(package["manifest_path"].as_str().unwrap()).parent().unwrap();
        assert_eq!(package["license"], "MIT OR Apache-2.0", "{name}");
        assert_eq!(package["readme"], "README.md", "{name}");
        for (file, words) in [
            ("README.md", name),
            ("LICENSE-MIT", "Permission is hereby granted"),
            ("LICENSE-APACHE", "Apache License"),
        ] {
            let text = fs::read_to_string(folder.join(file))
                .unwrap_or_else(|error| panic!("{name}: {file}: {error}"));
            assert!(text.contains(words), "{name}: {file} does not say `{words}`");
        }
        for list in ["keywords", "categories"] {
            let count = package[list].as_array().unwrap().len();
            assert!((1..=5).contains(&count), "{name} has {count} {list}");
        }
        assert!(
            package["keywords"].as_array().unwrap().iter().all(|word| word.as_str().unwrap().len() <= 20),
            "{name}"
        );
        assert_eq!(package["repository"], Value::Null, "{name}: a repository that exists, or none");
        let features = package["features"].as_object().unwrap();
        let docs = &package["metadata"]["docs"]["rs"];
        let whole = docs["all-features"] == true || docs["features"].is_array();
        assert!(features.is_empty() || whole, "{name} shows not all features on docs.rs");
    }
}
