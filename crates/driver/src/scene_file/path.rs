//! Paths such as `materials.glass.friction`, and what they lead to.

use super::tokens::Kind;
use super::tree::{Entry, Group, Node, Shape};

/// Reads a path up to `=`, with `walls.0` or `walls[0]` for items; returns its segments and the rest from `=` on.
pub(super) fn parse_path(text: &str) -> Option<(Vec<String>, &str)> {
    let mut segments = Vec::new();
    let mut rest = text.trim_start();
    loop {
        let segment;
        if let Some(quoted) = rest.strip_prefix('"') {
            let end = quoted.find('"')?;
            segment = quoted[..end].to_owned();
            rest = quoted[end + 1..].trim_start();
        } else {
            let end = rest.find(['.', '=', '[']).unwrap_or(rest.len());
            segment = rest[..end].trim().to_owned();
            rest = &rest[end..];
            if segment.is_empty() {
                return None;
            }
        }
        segments.push(segment);
        while let Some(index) = rest.strip_prefix('[') {
            let end = index.find(']').filter(|end| *end > 0)?;
            segments.push(index[..end].trim().to_owned());
            rest = index[end + 1..].trim_start();
        }
        match rest.strip_prefix('.') {
            Some(next) => rest = next.trim_start(),
            None if rest.is_empty() || rest.starts_with('=') => return Some((segments, rest)),
            None => return None,
        }
    }
}

/// The path and the value of an assignment such as `materials.glass.friction=0.3`, as they are written.
pub fn split_assignment(text: &str) -> Option<(&str, &str)> {
    let (_, rest) = parse_path(text)?;
    let value = rest.strip_prefix('=')?;
    Some((text[..text.len() - rest.len()].trim(), value.trim()))
}

/// A path as it is written in assignments.
pub(super) fn write_path(segments: &[String]) -> String {
    let segments: Vec<String> = segments
        .iter()
        .map(|segment| {
            let plain =
                !segment.is_empty() && !segment.contains(['.', '=', '"', '[']) && segment.trim() == segment;
            if plain { segment.clone() } else { format!("\"{segment}\"") }
        })
        .collect();
    segments.join(".")
}

/// Where a path leads.
pub(super) enum Found<'t> {
    /// To a value; the key is there unless it has none.
    Value { node: &'t Node, key: Option<&'t Node> },
    /// To a value that has no such segment.
    Missing { parent: &'t Node, key: Option<&'t Node>, segment: usize },
}

/// Follows a path from a value.
pub(super) fn find<'t>(text: &str, root: &'t Node, path: &[String]) -> Found<'t> {
    let mut node = root;
    let mut key = None;
    for (at, segment) in path.iter().enumerate() {
        match step(text, node, segment) {
            Step::Into(Entry { key: entry_key, value: Some(value) }) => {
                node = value;
                key = entry_key.as_ref();
            }
            Step::Stay => {}
            Step::Into(_) => return Found::Missing { parent: node, key, segment: at },
            Step::Nowhere(parent) => return Found::Missing { parent, key, segment: at },
        }
    }
    Found::Value { node, key }
}

enum Step<'t> {
    Into(&'t Entry),
    /// The segment names the variant that the value is.
    Stay,
    /// The innermost value that was asked.
    Nowhere(&'t Node),
}

fn step<'t>(text: &str, node: &'t Node, segment: &str) -> Step<'t> {
    let mut inner = node;
    let mut is_variant = false;
    loop {
        is_variant |= variant(text, inner) == Some(segment);
        // In `Grains([...])` an index means the list: paths need not name the only argument.
        let list = inner.only_argument().filter(|node| node.group().is_some_and(|list| list.bracket == '['));
        if let (Some(list), Ok(_)) = (list, segment.parse::<usize>()) {
            inner = list;
        }
        if let Some(entry) = inner.group().and_then(|group| entry(text, group, segment)) {
            return Step::Into(entry);
        }
        match inner.only_argument() {
            Some(argument) if argument.group().is_some() || !is_variant => inner = argument,
            _ if is_variant => return Step::Stay,
            _ => return Step::Nowhere(inner),
        }
        if inner.group().is_none() {
            return if is_variant { Step::Stay } else { Step::Nowhere(inner) };
        }
    }
}

fn variant<'a>(text: &'a str, node: &Node) -> Option<&'a str> {
    match &node.shape {
        Shape::Group(group) => group.name.clone().map(|name| &text[name]),
        Shape::Leaf(Kind::Word) => Some(&text[node.span.clone()]),
        Shape::Leaf(_) => None,
    }
}

fn entry<'t>(text: &str, group: &'t Group, segment: &str) -> Option<&'t Entry> {
    let named = |entry: &&Entry| entry.key.as_ref().is_some_and(|key| key.key_text(text) == segment);
    group.entries.iter().find(named).or_else(|| {
        let entry = group.entries.get(segment.parse::<usize>().ok()?)?;
        entry.key.is_none().then_some(entry)
    })
}

/// Names of the keys of a group.
pub(super) fn keys(text: &str, node: &Node) -> Vec<String> {
    let entries = node.group().map_or(&[][..], |group| &group.entries);
    entries.iter().filter_map(|entry| entry.key.as_ref()).map(|key| key.key_text(text)).collect()
}
