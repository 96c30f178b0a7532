//! How types and values are called in the reference.

use super::{Object, array, array_of, object, text};
use serde_json::Value;
use std::collections::VecDeque;

/// What a root without a title is called.
pub(super) const NAMELESS: &str = "Scene";
const DEFINITIONS: &str = "#/$defs/";

/// Types by name, and those that are named on the page but not yet described.
pub(super) struct Types<'a> {
    root: &'a str,
    definitions: Option<&'a Object>,
    named: Vec<&'a str>,
    waiting: VecDeque<&'a str>,
}

impl<'a> Types<'a> {
    pub(super) fn of(root: &'a Object) -> Self {
        let name = text(root, "title").unwrap_or(NAMELESS);
        Self { root: name, definitions: object(root, "$defs"), named: Vec::new(), waiting: VecDeque::new() }
    }

    /// The next type to describe.
    pub(super) fn next(&mut self) -> Option<(&'a str, &'a Object)> {
        let definitions = self.definitions?;
        while let Some(name) = self.waiting.pop_front() {
            if let Some(definition) = definitions.get(name).and_then(Value::as_object) {
                return Some((name, definition));
            }
        }
        None
    }

    /// Whether a schema is one of several choices, which are written without quotes.
    pub(super) fn is_choice(&self, schema: &Value) -> bool {
        let Some(schema) = schema.as_object() else { return false };
        let inner = array(schema, "allOf").iter().chain(array(schema, "anyOf"));
        text(schema, "$ref").is_some()
            || !array(schema, "enum").is_empty()
            || inner.filter(|inner| inner.get("$ref").is_some()).count() > 0
    }

    /// What a type is called, with a link or its unit.
    pub(super) fn name(&mut self, schema: &Value) -> String {
        let Some(schema) = schema.as_object() else { return "anything".to_owned() };
        if let Some(reference) = text(schema, "$ref") {
            return self.link(reference);
        }
        if let Some(unit) = text(schema, "x-unit") {
            let dimension = text(schema, "x-dimension").unwrap_or("number");
            return if unit == "1" { dimension.to_owned() } else { format!("{dimension} \\[{unit}\\]") };
        }
        if let [only] = array(schema, "allOf") {
            return self.name(only);
        }
        let several = [array(schema, "anyOf"), array(schema, "oneOf")].concat();
        if !several.is_empty() {
            return self.any_of(&several);
        }
        match array(schema, "enum") {
            [] => {}
            names => {
                let names: Vec<String> = names.iter().map(|name| format!("`{}`", ron(name, true))).collect();
                return names.join(", ");
            }
        }
        if let Some(value) = schema.get("const") {
            return format!("`{}`", ron(value, true));
        }
        self.by_kind(schema)
    }

    fn by_kind(&mut self, schema: &Object) -> String {
        let optional = array(schema, "type").iter().any(|kind| kind == "null");
        let kinds = array(schema, "type").iter().filter_map(Value::as_str).find(|kind| *kind != "null");
        let name = match text(schema, "type").or(kinds) {
            Some("number") => format!("number{}", bounds(schema)),
            Some("integer") => format!("whole number{}", bounds(schema)),
            Some("string") => "text".to_owned(),
            Some("boolean") => "`true` or `false`".to_owned(),
            Some("null") => "`()`".to_owned(),
            Some("array") => self.list(schema),
            Some("object") => match schema.get("additionalProperties") {
                Some(values @ Value::Object(_)) => format!("map from names to {}", self.name(values)),
                _ => "keys and values".to_owned(),
            },
            _ => "anything".to_owned(),
        };
        if optional { format!("{name}, or `None`") } else { name }
    }

    fn list(&mut self, schema: &Object) -> String {
        let items = array(schema, "prefixItems");
        if !items.is_empty() {
            let names: Vec<String> = items.iter().map(|item| self.name(item)).collect();
            return format!("({})", names.join(", "));
        }
        let item = schema.get("items").map_or("anything".to_owned(), |item| self.name(item));
        let count = |key: &str| schema.get(key).and_then(Value::as_u64);
        match (count("minItems"), count("maxItems")) {
            (Some(least), Some(most)) if least == most => format!("`(...)` of {most}: {item}"),
            _ => format!("list of {item}"),
        }
    }

    fn any_of(&mut self, several: &[Value]) -> String {
        let is_null = |schema: &Value| schema.get("type").is_some_and(|kind| kind == "null");
        let mut names = Vec::new();
        for schema in several.iter().filter(|schema| !is_null(schema)) {
            let name = match schema.get("properties").and_then(Value::as_object) {
                Some(variant) if !variant.is_empty() && array_of(schema, "required").len() == 1 => {
                    variant.keys().map(|name| format!("`{name}(...)`")).collect::<Vec<_>>().join(" or ")
                }
                _ => self.name(schema),
            };
            names.push(name);
        }
        names.extend(several.iter().any(is_null).then(|| "`None`".to_owned()));
        match names.as_slice() {
            [one, none] if none == "`None`" => format!("{one}, or `None`"),
            _ => names.join(" or "),
        }
    }

    fn link(&mut self, reference: &str) -> String {
        if reference == "#" {
            return format!("[{}](#{})", self.root, self.root.to_lowercase());
        }
        let Some(name) = reference.strip_prefix(DEFINITIONS) else { return format!("`{reference}`") };
        let known = self.definitions.and_then(|definitions| definitions.get_key_value(name));
        let Some((name, _)) = known else { return format!("`{name}`") };
        if !self.named.contains(&name.as_str()) {
            self.named.push(name);
            self.waiting.push_back(name);
        }
        format!("[{name}](#{})", name.to_lowercase())
    }
}

fn bounds(schema: &Object) -> String {
    let words = [
        ("minimum", "at least"),
        ("exclusiveMinimum", "above"),
        ("maximum", "at most"),
        ("exclusiveMaximum", "below"),
    ];
    let parts = words.iter().filter_map(|(key, word)| Some(format!(" {word} {}", schema.get(*key)?)));
    parts.collect::<Vec<_>>().join(",")
}

/// A value as it is written in a scene; names of choices have no quotes.
pub(super) fn ron(value: &Value, choice: bool) -> String {
    match value {
        Value::Null => "None".to_owned(),
        Value::String(name) if choice => name.clone(),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| ron(item, false)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Object(keys) => match keys.iter().next() {
            Some((name, content)) if choice && keys.len() == 1 && name.starts_with(char::is_uppercase) => {
                let content = ron(content, false);
                let content =
                    content.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(&content);
                format!("{name}({content})")
            }
            _ => {
                let keys: Vec<String> =
                    keys.iter().map(|(key, value)| format!("{key}: {}", ron(value, false))).collect();
                format!("({})", keys.join(", "))
            }
        },
        other => other.to_string(),
    }
}
