//! The nesting of RON text with the place of everything; bears broken text.

use super::Span;
use super::tokens::{Kind, Token, tokens, unquoted};

/// Groups nested deeper than the reader allows are kept as they are.
const DEEPEST: usize = 130;

/// The outermost value of a text.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) root: Option<Node>,
    pub(super) tokens: Vec<Token>,
    pub(super) imbalance: Option<Imbalance>,
}

/// A bracket without its partner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Imbalance {
    /// Opened here; closed by another bracket or by none.
    Open { bracket: char, at: usize, met: Option<(char, usize)> },
    /// Closed here, but never opened.
    Close { bracket: char, at: usize },
}

/// A value.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) span: Span,
    pub(super) shape: Shape,
}

#[derive(Debug)]
pub(super) enum Shape {
    Leaf(Kind),
    Group(Group),
}

/// Values in brackets, with the name in front of them.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) name: Option<Span>,
    pub(super) bracket: char,
    pub(super) open: usize,
    pub(super) entries: Vec<Entry>,
}

/// A value with or without its key; broken text may have a key alone.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) key: Option<Node>,
    pub(super) value: Option<Node>,
}

impl Tree {
    pub(super) fn of(text: &str) -> Self {
        let tokens = tokens(text);
        let mut builder =
            Builder { text, tokens: &tokens, next: 0, open: Vec::new(), imbalance: None, depth: 0 };
        builder.skip_attributes();
        let root = builder.value();
        builder.check_rest();
        let imbalance = builder.imbalance;
        Self { root, tokens, imbalance }
    }

    /// The token at a byte, or the first one after it.
    pub(super) fn token_at(&self, byte: usize) -> Option<&Token> {
        let next = self.tokens.partition_point(|token| token.span.end <= byte);
        self.tokens.get(next)
    }

    /// The last token with this text that begins before a byte.
    pub(super) fn word_before(&self, text: &str, word: &str, byte: usize) -> Option<&Token> {
        let end = self.tokens.partition_point(|token| token.span.start < byte);
        self.tokens[..end].iter().rev().find(|token| token_text(token, text) == word)
    }
}

fn token_text(token: &Token, text: &str) -> String {
    let written = &text[token.span.clone()];
    match token.kind {
        Kind::Text => unquoted(written),
        Kind::Word => written.strip_prefix("r#").unwrap_or(written).to_owned(),
        _ => written.to_owned(),
    }
}

impl Node {
    pub(super) fn group(&self) -> Option<&Group> {
        match &self.shape {
            Shape::Group(group) => Some(group),
            Shape::Leaf(_) => None,
        }
    }

    pub(super) fn is(&self, kind: Kind) -> bool {
        matches!(&self.shape, Shape::Leaf(own) if *own == kind)
    }

    /// What a key is called.
    pub(super) fn key_text(&self, text: &str) -> String {
        match self.shape {
            Shape::Leaf(kind) => token_text(&Token { kind, span: self.span.clone() }, text),
            Shape::Group(_) => text[self.span.clone()].to_owned(),
        }
    }

    /// The argument of `For("1 s")` and the like, which paths need not name.
    pub(super) fn only_argument(&self) -> Option<&Node> {
        let group = self.group().filter(|group| group.bracket == '(')?;
        match group.entries.as_slice() {
            [Entry { key: None, value: Some(value) }] => Some(value),
            _ => None,
        }
    }

    /// The part to underline: a name or bracket instead of pages of content.
    pub(super) fn head(&self) -> Span {
        match &self.shape {
            Shape::Leaf(_) => self.span.clone(),
            Shape::Group(group) => group.name.clone().unwrap_or(group.open..group.open + 1),
        }
    }
}

struct Builder<'a> {
    text: &'a str,
    tokens: &'a [Token],
    next: usize,
    open: Vec<char>,
    imbalance: Option<Imbalance>,
    depth: usize,
}

impl Builder<'_> {
    fn mark(&self) -> Option<char> {
        match self.tokens.get(self.next)?.kind {
            Kind::Mark(mark) => Some(mark),
            _ => None,
        }
    }

    /// `#![enable(...)]` in front of the scene.
    fn skip_attributes(&mut self) {
        while self.mark() == Some('#') {
            self.next += 1;
            if self.mark() == Some('!') {
                self.next += 1;
            }
            if self.mark() == Some('[') {
                self.value();
            }
        }
    }

    fn check_rest(&mut self) {
        while let Some(token) = self.tokens.get(self.next) {
            if let Kind::Mark(bracket @ (')' | ']' | '}')) = token.kind {
                self.blame(Imbalance::Close { bracket, at: token.span.start });
            }
            self.next += 1;
        }
    }

    fn blame(&mut self, imbalance: Imbalance) {
        self.imbalance.get_or_insert(imbalance);
    }

    /// A value; none where a mark stands that begins none.
    fn value(&mut self) -> Option<Node> {
        let token = self.tokens.get(self.next)?;
        match token.kind {
            Kind::Mark('(' | '[' | '{') => Some(self.group(None)),
            Kind::Mark(',' | ':' | ')' | ']' | '}') => None,
            kind => {
                self.next += 1;
                if kind == Kind::Word && self.mark() == Some('(') {
                    return Some(self.group(Some(token.span.clone())));
                }
                Some(Node { span: token.span.clone(), shape: Shape::Leaf(kind) })
            }
        }
    }

    /// A group, from its opening bracket.
    fn group(&mut self, name: Option<Span>) -> Node {
        let open = self.tokens[self.next].span.start;
        let bracket = self.text[open..].chars().next().unwrap_or('(');
        let close = match bracket {
            '[' => ']',
            '{' => '}',
            _ => ')',
        };
        self.next += 1;
        self.depth += 1;
        self.open.push(close);
        let mut entries = Vec::new();
        let end = loop {
            match self.tokens.get(self.next) {
                None => {
                    self.blame(Imbalance::Open { bracket, at: open, met: None });
                    break self.text.len();
                }
                Some(token) => match token.kind {
                    Kind::Mark(mark) if mark == close => {
                        self.next += 1;
                        break token.span.end;
                    }
                    // Another bracket that is open closes: this one was forgotten.
                    Kind::Mark(mark @ (')' | ']' | '}')) => {
                        self.blame(Imbalance::Open {
                            bracket,
                            at: open,
                            met: Some((mark, token.span.start)),
                        });
                        if self.open.contains(&mark) {
                            break token.span.start;
                        }
                        self.next += 1;
                    }
                    Kind::Mark(',') => self.next += 1,
                    _ => self.push_entry(&mut entries),
                },
            }
        };
        self.open.pop();
        self.depth -= 1;
        let start = name.as_ref().map_or(open, |name| name.start);
        Node { span: start..end, shape: Shape::Group(Group { name, bracket, open, entries }) }
    }

    fn push_entry(&mut self, entries: &mut Vec<Entry>) {
        if self.depth >= DEEPEST {
            self.next += 1;
            return;
        }
        let first = self.value();
        if self.mark() == Some(':') {
            self.next += 1;
            let value = self.value();
            entries.push(Entry { key: first, value });
        } else if first.is_some() {
            entries.push(Entry { key: None, value: first });
        } else {
            self.next += 1;
        }
        self.skip_to_comma();
    }

    /// What follows a value without a comma is for the reader to complain about.
    fn skip_to_comma(&mut self) {
        while self.next < self.tokens.len() && !matches!(self.mark(), Some(',' | ')' | ']' | '}')) {
            if matches!(self.mark(), Some('(' | '[' | '{')) {
                self.value();
            } else {
                self.next += 1;
            }
        }
    }
}
