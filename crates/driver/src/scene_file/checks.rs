//! What the reader would accept in silence: keys written twice and numbers that are not finite.

use super::SceneText;
use super::path::write_path;
use super::problem::SceneProblem;
use super::tokens::Kind;
use super::tree::{Node, Shape, Tree};
use super::words::shortened;
use std::collections::HashMap;

/// The first such place in the text.
pub(super) fn first(scene: &SceneText, tree: &Tree) -> Option<SceneProblem> {
    let mut path = Vec::new();
    check(scene, tree.root.as_ref()?, &mut path)
}

fn check(scene: &SceneText, node: &Node, path: &mut Vec<String>) -> Option<SceneProblem> {
    let group = match &node.shape {
        Shape::Leaf(kind) => return not_finite(scene, *kind, node, path),
        Shape::Group(group) => group,
    };
    let mut seen: HashMap<(bool, String), &Node> = HashMap::new();
    for (index, entry) in group.entries.iter().enumerate() {
        let name = match &entry.key {
            Some(key) => {
                let name = key.key_text(&scene.text);
                if let Some(first) = seen.insert((key.is(Kind::Text), name.clone()), key) {
                    return Some(duplicate(scene, first, key, &name, path));
                }
                Some(name)
            }
            // Paths need not name the only argument.
            None if node.only_argument().is_some() => None,
            None => Some(index.to_string()),
        };
        let named = name.map(|name| path.push(name)).is_some();
        let problem = entry.value.as_ref().and_then(|value| check(scene, value, path));
        if problem.is_some() {
            return problem;
        }
        if named {
            path.pop();
        }
    }
    None
}

fn duplicate(scene: &SceneText, first: &Node, second: &Node, name: &str, path: &[String]) -> SceneProblem {
    let (line, column) = scene.line_and_column(first.span.start);
    let mut problem = SceneProblem::of_file(scene.name.clone(), format!("key `{name}` is written twice"));
    problem.place.path = Some(write_path(&[path, &[name.to_owned()]].concat()));
    problem.notes.push(format!("the first is at {}:{line}:{column}", scene.name));
    problem.with_hint("leave out one of them").at(scene, second.span.clone(), "second")
}

fn not_finite(scene: &SceneText, kind: Kind, node: &Node, path: &[String]) -> Option<SceneProblem> {
    let written = &scene.text[node.span.clone()];
    let unsigned = written.trim_start_matches(['+', '-']);
    let infinite = match kind {
        Kind::Word | Kind::Number if is_special(unsigned) => true,
        Kind::Number if !unsigned.starts_with("0x") => {
            let digits = written.replace('_', "");
            let digits = digits.trim_end_matches("f32").trim_end_matches("f64");
            digits.parse::<f64>().is_ok_and(f64::is_infinite)
        }
        _ => false,
    };
    infinite.then(|| {
        let message = format!("`{}` is not a finite number", shortened(written));
        let mut problem = SceneProblem::of_file(scene.name.clone(), message);
        problem.place.path = Some(write_path(path));
        problem.at(scene, node.span.clone(), "expected a finite number")
    })
}

fn is_special(word: &str) -> bool {
    ["inf", "NaN"].iter().any(|special| matches!(word.strip_prefix(special), Some("" | "f32" | "f64")))
}
