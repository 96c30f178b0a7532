//! What a page needs to know of the text of a scene.

/// The title of a scene: the text of its key `title`, not of one further inside.
pub(crate) fn title(text: &str) -> Option<String> {
    let mut rest = text;
    let (mut depth, mut before) = (0_usize, "");
    while let Some(first) = rest.chars().next() {
        let length = token(rest);
        let (this, next) = rest.split_at(length);
        match first {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            '"' if depth == 1 && before == "title" => return unquoted(this),
            _ => {}
        }
        if !(first.is_whitespace() || first == ':' || this.starts_with("//") || this.starts_with("/*")) {
            before = this;
        }
        rest = next;
    }
    None
}

/// Bytes of the first comment, text, word or sign.
fn token(text: &str) -> usize {
    let whole = text.len();
    if text.starts_with("//") {
        return text.find('\n').unwrap_or(whole);
    }
    if text.starts_with("/*") {
        return text.find("*/").map_or(whole, |end| end + 2);
    }
    if text.starts_with('"') {
        let mut escaped = false;
        let end = text.char_indices().skip(1).find(|(_, c)| {
            let ends = *c == '"' && !escaped;
            escaped = *c == '\\' && !escaped;
            ends
        });
        return end.map_or(whole, |(at, _)| at + 1);
    }
    let in_word = |c: char| c.is_alphanumeric() || c == '_';
    let word = text.find(|c| !in_word(c)).unwrap_or(whole);
    if word > 0 { word } else { text.chars().next().map_or(whole, char::len_utf8) }
}

/// A text without its quotes. Escapes of RON that matter in a title are those of JSON.
fn unquoted(text: &str) -> Option<String> {
    serde_json::from_str(text).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_title_is_that_of_the_scene() {
        let found = |text: &str| title(text);
        assert_eq!(found(r#"Scene(version: 1, title: "Dry \"column\"")"#).as_deref(), Some("Dry \"column\""));
        let nested = r#"Scene( // title: "no"
            materials: { "title": (title: "inner") }, /* title: "no" */ title : "outer")"#;
        assert_eq!(found(nested).as_deref(), Some("outer"));
        for text in
            ["Scene(version: 1)", "", "Scene(title: \"open", "//", "/* é", "Scene(title: 3, a: \"b\")"]
        {
            assert_eq!(found(text), None, "{text}");
        }
    }
}
