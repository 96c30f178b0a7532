//! A reference of all keys of a scene, in Markdown, from the schema of its type.

mod types;

use schemars::Schema;
use serde_json::{Map, Value};
use std::fmt::Write;
use types::{NAMELESS, Types, ron};

type Object = Map<String, Value>;

/// All types that a schema leads to, with their keys, units, defaults and meanings.
///
/// Every type has a heading, and types are linked to each other.
pub fn markdown(schema: &Schema, title: &str) -> String {
    let empty = Object::new();
    let root = schema.as_object().unwrap_or(&empty);
    let name = text(root, "title").unwrap_or(NAMELESS);
    let mut types = Types::of(root);
    let mut page = format!("# {title}\n");
    // A type that contains itself is a reference even at the root.
    if text(root, "$ref").is_some() {
        types.name(&Value::Object(root.clone()));
    } else {
        section(&mut page, name, root, &mut types);
    }
    while let Some((name, definition)) = types.next() {
        section(&mut page, name, definition, &mut types);
    }
    page
}

fn section(page: &mut String, name: &str, schema: &Object, types: &mut Types<'_>) {
    let _ = write!(page, "\n## {name}\n");
    if let Some(meaning) = text(schema, "description") {
        let _ = write!(page, "\n{}\n", without_links(meaning));
    }
    let choices = choices(schema);
    if let Some(properties) = object(schema, "properties").filter(|properties| !properties.is_empty()) {
        keys(page, properties, schema, types);
    } else if choices.is_empty() {
        let plain = types.name(&Value::Object(schema.clone()));
        let _ = write!(page, "\nWritten as: {plain}.\n");
    } else {
        choice_table(page, name, &choices, types);
    }
}

fn keys(page: &mut String, properties: &Object, owner: &Object, types: &mut Types<'_>) {
    page.push_str("\n| key | type or unit | default | meaning |\n|---|---|---|---|\n");
    let required = array(owner, "required");
    for (key, schema) in properties {
        let default = match schema.get("default") {
            _ if required.iter().any(|name| name.as_str() == Some(key)) => "required".to_owned(),
            None | Some(Value::Null) => "optional".to_owned(),
            Some(value) => format!("`{}`", ron(value, types.is_choice(schema))),
        };
        let kind = types.name(schema);
        let meaning = own_meaning(schema);
        let _ = writeln!(page, "| `{key}` | {} | {} | {} |", cell(&kind), cell(&default), cell(&meaning));
    }
}

/// What a key says about itself; the words that come with every unit are left out.
fn own_meaning(schema: &Value) -> String {
    let Some(schema) = schema.as_object() else { return String::new() };
    let meaning = text(schema, "description").unwrap_or_default();
    let of_unit = text(schema, "x-unit").is_some() && meaning.contains(", or a text such as \"");
    if of_unit { String::new() } else { meaning.to_owned() }
}

/// One way to write an enum.
struct Choice<'a> {
    name: &'a str,
    meaning: &'a str,
    content: Option<&'a Value>,
}

fn choices(schema: &Object) -> Vec<Choice<'_>> {
    let mut choices = names(schema, "");
    for variant in array(schema, "oneOf").iter().chain(array(schema, "anyOf")).filter_map(Value::as_object) {
        let meaning = text(variant, "description").unwrap_or_default();
        choices.extend(names(variant, meaning));
        for (name, content) in object(variant, "properties").into_iter().flatten() {
            choices.push(Choice { name, meaning, content: Some(content) });
        }
    }
    choices
}

fn names<'a>(schema: &'a Object, meaning: &'a str) -> Vec<Choice<'a>> {
    let names = array(schema, "enum").iter().chain(schema.get("const"));
    names.filter_map(Value::as_str).map(|name| Choice { name, meaning, content: None }).collect()
}

fn choice_table(page: &mut String, owner: &str, choices: &[Choice<'_>], types: &mut Types<'_>) {
    page.push_str("\n| choice | meaning |\n|---|---|\n");
    let mut with_keys = Vec::new();
    for choice in choices {
        let name = choice.name;
        let fields = choice.content.and_then(Value::as_object);
        let fields = fields.and_then(|fields| Some((fields, object(fields, "properties")?)));
        let written = match (choice.content, fields) {
            (None, _) => format!("`{name}`"),
            (Some(_), Some((fields, properties))) => {
                with_keys.push((name, fields, properties));
                format!("`{name}(...)`, keys below")
            }
            (Some(content), None) => match array_of(content, "prefixItems") {
                [] => format!("`{name}`({})", types.name(content)),
                // A tuple brings its own brackets.
                _ => format!("`{name}`{}", types.name(content)),
            },
        };
        let _ = writeln!(page, "| {} | {} |", cell(&written), cell(choice.meaning));
    }
    for (name, fields, properties) in with_keys {
        // The owner in the heading keeps it apart from a type of this name.
        let _ = write!(page, "\n### {owner}: {name}\n");
        keys(page, properties, fields, types);
    }
}

fn cell(text: &str) -> String {
    without_links(text).split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// Links to Rust items lead nowhere from a page.
fn without_links(text: &str) -> String {
    text.replace("[`", "`").replace("`]", "`")
}

fn text<'a>(schema: &'a Object, key: &str) -> Option<&'a str> {
    schema.get(key)?.as_str()
}

fn object<'a>(schema: &'a Object, key: &str) -> Option<&'a Object> {
    schema.get(key)?.as_object()
}

fn array<'a>(schema: &'a Object, key: &str) -> &'a [Value] {
    schema.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

fn array_of<'a>(schema: &'a Value, key: &str) -> &'a [Value] {
    schema.as_object().map_or(&[], |schema| array(schema, key))
}
