//! Splits RON text into tokens; never fails, so that broken texts can be shown too.

use super::Span;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Identifier, also a raw one.
    Word,
    /// String, also raw or of bytes.
    Text,
    /// A character in quotes.
    Char,
    /// Number.
    Number,
    /// A mark of punctuation, or anything else.
    Mark(char),
}

/// A token and where it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) span: Span,
}

/// All tokens of a text, without blanks and comments.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if let Some(length) = blank(rest, c) {
            at += length;
            continue;
        }
        let (kind, length) = token(rest, c);
        tokens.push(Token { kind, span: at..at + length });
        at += length;
    }
    tokens
}

fn blank(rest: &str, c: char) -> Option<usize> {
    if c.is_whitespace() || matches!(c, '\u{200E}' | '\u{200F}' | '\u{FEFF}') {
        return Some(c.len_utf8());
    }
    if rest.starts_with("//") {
        return Some(rest.find('\n').unwrap_or(rest.len()));
    }
    rest.starts_with("/*").then(|| block_comment(rest))
}

/// Length of a block comment, in which others may be nested.
fn block_comment(rest: &str) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while at < rest.len() {
        let pair = rest.as_bytes().get(at..at + 2);
        match pair {
            Some(b"/*") => depth += 1,
            Some(b"*/") => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    rest.len()
}

fn token(rest: &str, c: char) -> (Kind, usize) {
    if let Some(length) = string(rest) {
        return (Kind::Text, length);
    }
    if let Some(length) = number(rest) {
        return (Kind::Number, length);
    }
    if let Some(raw) = rest.strip_prefix("r#") {
        let length = run(raw, |c| in_word(c) || matches!(c, '.' | '+' | '-'));
        if length > 0 {
            return (Kind::Word, 2 + length);
        }
    }
    if in_word(c) {
        return (Kind::Word, run(rest, in_word));
    }
    match (c, character(rest)) {
        ('\'', Some(length)) => (Kind::Char, length),
        _ => (Kind::Mark(c), c.len_utf8()),
    }
}

fn in_word(c: char) -> bool {
    c == '_' || c.is_alphanumeric()
}

fn run(text: &str, wanted: impl Fn(char) -> bool) -> usize {
    text.find(|c| !wanted(c)).unwrap_or(text.len())
}

/// Length of a string; one that is not closed goes to the end.
fn string(rest: &str) -> Option<usize> {
    let plain = rest.strip_prefix('b').unwrap_or(rest);
    let prefix = rest.len() - plain.len();
    if let Some(raw) = plain.strip_prefix('r') {
        let hashes = run(raw, |c| c == '#');
        let inner = raw[hashes..].strip_prefix('"')?;
        let close = format!("\"{}", "#".repeat(hashes));
        let length = inner.find(&close).map_or(inner.len(), |end| end + close.len());
        return Some(prefix + 1 + hashes + 1 + length);
    }
    let inner = plain.strip_prefix('"')?;
    Some(prefix + 1 + quoted(inner, '"').unwrap_or(inner.len()))
}

/// Bytes up to and with the closing quote.
fn quoted(inner: &str, quote: char) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in inner.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == quote => return Some(at + quote.len_utf8()),
            _ => {}
        }
    }
    None
}

/// Length of a character in quotes; a quote alone is none.
fn character(rest: &str) -> Option<usize> {
    // The longest is an escape such as '\u{10FFFF}'.
    const LONGEST: usize = 11;
    let inner = rest.strip_prefix('\'')?;
    let end = inner.char_indices().nth(LONGEST).map_or(inner.len(), |(byte, _)| byte);
    let length = quoted(&inner[..end], '\'')?;
    let one = inner.starts_with('\\') || inner.chars().nth(1) == Some('\'');
    one.then_some(1 + length)
}

/// Length of a number, with sign and suffix.
fn number(rest: &str) -> Option<usize> {
    let unsigned = rest.strip_prefix(['+', '-']).unwrap_or(rest);
    let sign = rest.len() - unsigned.len();
    let bytes = unsigned.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    if !(digit(0) || bytes.first() == Some(&b'.') && digit(1)) {
        let word = run(unsigned, in_word);
        let signed_word = sign > 0 && (unsigned.starts_with("inf") || unsigned.starts_with("NaN"));
        return signed_word.then_some(sign + word);
    }
    let hexadecimal = unsigned.starts_with("0x");
    let mut length = 0;
    for c in unsigned.chars() {
        let exponent = !hexadecimal && unsigned[..length].ends_with(['e', 'E']);
        if !(in_word(c) || c == '.' || matches!(c, '+' | '-') && exponent) {
            break;
        }
        length += c.len_utf8();
    }
    Some(sign + length)
}

/// What a string says; the text between its quotes where it cannot be read.
pub(super) fn unquoted(text: &str) -> String {
    ron::from_str::<String>(text)
        .unwrap_or_else(|_| text.trim_matches(|c| matches!(c, '"' | '#' | 'r' | 'b')).to_owned())
}
