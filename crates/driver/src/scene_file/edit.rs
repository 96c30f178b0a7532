//! Assignments that edit the text at the place of a value.

use super::path::{Found, find, keys, parse_path, write_path};
use super::problem::SceneProblem;
use super::tokens::Kind;
use super::tree::{Group, Node, Shape, Tree};
use super::words::{listed, nearest};
use super::{SceneText, Span};

/// A place that an assignment wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Edit {
    pub(super) span: Span,
    pub(super) assignment: String,
}

pub(super) fn set(scene: &mut SceneText, assignment: &str) -> Result<(), SceneProblem> {
    let wrong = |message: String| SceneProblem::of_file(format!("--set {assignment}"), message);
    let usage = || {
        wrong("an assignment is a path, `=` and a value".to_owned())
            .with_hint("for example `--set sample.width=\"68 mm\"` or `--set stages.0.0=settle`")
    };
    let (path, rest) = parse_path(assignment).ok_or_else(usage)?;
    let value = rest.strip_prefix('=').ok_or_else(usage)?.trim();
    if value.is_empty() {
        return Err(usage());
    }
    let tree = Tree::of(&scene.text);
    let root = tree.root.as_ref().ok_or_else(|| scene.empty())?;
    let (span, written) = match find(&scene.text, root, &path) {
        Found::Value { node, .. } => (node.span.clone(), as_ron(value, node.is(Kind::Text))),
        Found::Missing { parent, segment, .. } => {
            let last = segment + 1 == path.len();
            let inserted = last.then(|| insertion(parent, &path[segment])).flatten();
            let Some((at, before)) = inserted else {
                let (message, hint) = no_parent(&scene.text, parent, &path, segment);
                return Err(SceneProblem { hint, ..wrong(message) });
            };
            (at..at, format!("{before}{}", as_ron(value, false)))
        }
    };
    replace(scene, span, &written, assignment);
    Ok(())
}

/// Takes a value out with its key, and the comma behind it. Nothing where there is none.
pub(super) fn remove(scene: &mut SceneText, path: &str) {
    let Some((path, _)) = parse_path(path) else { return };
    let tree = Tree::of(&scene.text);
    let Some(root) = &tree.root else { return };
    let Found::Value { node, key } = find(&scene.text, root, &path) else { return };
    let start = key.map_or(node.span.start, |key| key.span.start);
    let next = tree.token_at(node.span.end).filter(|token| &scene.text[token.span.clone()] == ",");
    let end = next.map_or(node.span.end, |comma| comma.span.end);
    replace(scene, start..end, "", "");
    scene.edits.pop();
}

fn replace(scene: &mut SceneText, span: Span, written: &str, assignment: &str) {
    scene.text.replace_range(span.clone(), written);
    let new_end = span.start + written.len();
    // What is overwritten is forgotten; what follows moves; what surrounds grows or shrinks.
    scene
        .edits
        .retain(|edit| !(span.start <= edit.span.start && edit.span.end <= span.end && !span.is_empty()));
    for edit in &mut scene.edits {
        for bound in [&mut edit.span.start, &mut edit.span.end] {
            if *bound >= span.end && *bound > span.start {
                *bound = *bound - span.end + new_end;
            }
        }
    }
    scene.edits.push(Edit { span: span.start..new_end, assignment: assignment.to_owned() });
}

/// The value as it is if it is one RON value, and as a text otherwise.
fn as_ron(value: &str, replaces_text: bool) -> String {
    let tree = Tree::of(value);
    // A comment after the value would hide the rest of the line.
    let whole = tree.root.as_ref().is_some_and(|root| root.span == (0..value.len()));
    // A name in place of a text is meant as a text.
    let name = replaces_text && tree.root.is_some_and(|root| root.is(Kind::Word));
    if whole && !name && ron::from_str::<ron::Value>(value).is_ok() {
        return value.to_owned();
    }
    quoted(value)
}

fn quoted(value: &str) -> String {
    format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Where a key can be added to a value, with what comes before its value.
fn insertion(parent: &Node, key: &str) -> Option<(usize, String)> {
    let Shape::Group(group) = &parent.shape else { return None };
    let named = group.entries.iter().all(|entry| entry.key.is_some());
    let key = match group.bracket {
        '(' if named && is_word(key) => key.to_owned(),
        '{' if named && !has_word_keys(group) => quoted(key),
        '{' if named => key.to_owned(),
        _ => return None,
    };
    let last = group.entries.last().and_then(|entry| entry.value.as_ref().or(entry.key.as_ref()));
    Some(match last {
        Some(last) => (last.span.end, format!(", {key}: ")),
        None => (group.open + 1, format!("{key}: ")),
    })
}

fn is_word(key: &str) -> bool {
    key.chars().all(|c| c == '_' || c.is_alphanumeric()) && !key.starts_with(|c: char| c.is_numeric())
}

fn has_word_keys(group: &Group) -> bool {
    group.entries.iter().filter_map(|entry| entry.key.as_ref()).any(|key| !key.is(Kind::Text))
}

fn no_parent(text: &str, parent: &Node, path: &[String], segment: usize) -> (String, Option<String>) {
    let name = &path[segment];
    let within = match segment {
        0 => "the scene".to_owned(),
        _ => format!("`{}`", write_path(&path[..segment])),
    };
    let keys = keys(text, parent);
    if !keys.is_empty() {
        let hint = match nearest(name, &keys) {
            Some(nearest) => format!("did you mean `{nearest}`?"),
            None => format!("it has: {}", listed(&keys)),
        };
        return (format!("{within} has no `{name}`"), Some(hint));
    }
    match &parent.shape {
        Shape::Group(group) => {
            let count = group.entries.len();
            let hint = (count > 0).then(|| format!("its values are called 0 to {}", count - 1));
            (format!("{within} has {count} values without keys, and no `{name}`"), hint)
        }
        Shape::Leaf(_) => {
            let written = &text[parent.span.clone()];
            let hint = parent.is(Kind::Word).then(|| format!("write it with keys first: `{written}(...)`"));
            (format!("{within} is `{written}`, which has no keys"), hint)
        }
    }
}
