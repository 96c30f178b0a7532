//! RON text in tokens and entries, as far as mutations need them; broken texts do no harm.

use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    Text,
    Number,
    Mark,
}

/// A token and its place.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) span: Range<usize>,
}

/// All tokens without blanks and comments.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let bytes = text.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    let until = |from: usize, ends: &dyn Fn(u8) -> bool| {
        bytes[from..].iter().position(|byte| ends(*byte)).map_or(bytes.len(), |length| from + length)
    };
    while at < bytes.len() {
        let (kind, end) = match bytes[at] {
            byte if byte.is_ascii_whitespace() => {
                at += 1;
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                at = until(at, &|byte| byte == b'\n');
                continue;
            }
            b'"' => (Kind::Text, (until(at + 1, &|byte| byte == b'"') + 1).min(bytes.len())),
            byte if byte.is_ascii_digit() || b"-+.".contains(&byte) => {
                let end = until(at + 1, &|byte| !(byte.is_ascii_alphanumeric() || b"-+._".contains(&byte)));
                (Kind::Number, end)
            }
            byte if byte.is_ascii_alphabetic() || byte == b'_' => {
                (Kind::Word, until(at, &|byte| !(byte.is_ascii_alphanumeric() || byte == b'_')))
            }
            byte if byte.is_ascii() => (Kind::Mark, at + 1),
            _ => (
                Kind::Mark,
                (at + 1..=bytes.len()).find(|end| text.is_char_boundary(*end)).unwrap_or(bytes.len()),
            ),
        };
        found.push(Token { kind, span: at..end });
        at = end;
    }
    found
}

/// A value in brackets, with its key if it has one.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) key: Option<String>,
    pub(super) value: Range<usize>,
    /// Key and value.
    pub(super) whole: Range<usize>,
    /// Place as `--set` writes it.
    pub(super) path: String,
}

/// All entries of all brackets, the outer ones first.
pub(super) fn entries(text: &str) -> Vec<Entry> {
    let tokens = tokens(text);
    let mut found = Vec::new();
    let Some(open) = tokens.iter().position(|token| opens(text, token)) else { return found };
    group(text, &tokens, open, "", &mut found);
    found
}

fn mark(text: &str, token: &Token) -> u8 {
    if token.kind == Kind::Mark { text.as_bytes()[token.span.start] } else { 0 }
}

/// Brackets within brackets beyond this are not looked into.
const DEEPEST: usize = 100;

fn opens(text: &str, token: &Token) -> bool {
    b"([{".contains(&mark(text, token))
}

/// Reads the entries after an opening bracket; returns the place after the closing one.
fn group(text: &str, tokens: &[Token], open: usize, path: &str, found: &mut Vec<Entry>) -> usize {
    let (mut at, mut index) = (open + 1, 0);
    while at < tokens.len() && !b")]}".contains(&mark(text, &tokens[at])) {
        let start = at;
        let colon = tokens.get(at + 1).is_some_and(|token| mark(text, token) == b':');
        let key = colon.then(|| text[tokens[at].span.clone()].to_owned());
        at += if colon { 2 } else { 0 };
        let name = key.clone().unwrap_or_else(|| index.to_string());
        let place = if path.is_empty() { name } else { format!("{path}.{name}") };
        let value_from = at;
        let number = found.len();
        let empty = Entry { key, value: 0..0, whole: 0..0, path: place.clone() };
        found.push(empty);
        while at < tokens.len() && !b",)]}".contains(&mark(text, &tokens[at])) {
            let goes_in = opens(text, &tokens[at]) && place.matches('.').count() < DEEPEST;
            at = if goes_in { group(text, tokens, at, &place, found) } else { at + 1 };
        }
        let last = at.min(tokens.len()) - 1;
        if value_from <= last && at > start {
            found[number].value = tokens[value_from].span.start..tokens[last].span.end;
            found[number].whole = tokens[start].span.start..tokens[last].span.end;
        }
        at += usize::from(tokens.get(at).is_some_and(|token| mark(text, token) == b','));
        index += 1;
    }
    at + 1
}

#[test]
fn entries_have_their_paths() {
    let text = r#"Scene(a: 1, // (
        b: [(c: "x, y"), Two(d: -2e5)], m: { "k": (e: [1, 2]) })"#;
    let found: Vec<(String, &str)> =
        entries(text).into_iter().map(|entry| (entry.path, &text[entry.value])).collect();
    let find = |path: &str| found.iter().find(|(known, _)| known == path).map(|(_, value)| *value);
    assert_eq!(find("a"), Some("1"));
    assert_eq!(find("b.0.c"), Some("\"x, y\""));
    assert_eq!(find("b.1.d"), Some("-2e5"));
    assert_eq!(find("m.\"k\".e.1"), Some("2"));
    assert_eq!(find("b.1"), Some("Two(d: -2e5)"));
    // Broken ones end too.
    for cut in 0..text.len() {
        entries(&text[..cut]);
    }
}
