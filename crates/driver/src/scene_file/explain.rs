//! The reader's errors in words, at the place in the text.

use super::path::{Found, find, write_path};
use super::problem::SceneProblem;
use super::tokens::{Kind, Token};
use super::tree::{Imbalance, Node, Tree};
use super::words::{listed, nearest, shortened, with_article};
use super::{SceneText, Span, checks};
use ron::error::{Error, SpannedError};
use serde_path_to_error::{Path, Segment};

/// Segments of a path up to where it is known.
pub(super) fn segments(path: &Path) -> Vec<String> {
    path.iter()
        .map_while(|segment| match segment {
            Segment::Seq { index } => Some(index.to_string()),
            Segment::Map { key } => Some(key.clone()),
            Segment::Enum { variant } => Some(variant.clone()),
            Segment::Unknown => None,
        })
        .collect()
}

/// What an error means, and where.
pub(super) fn explain(scene: &SceneText, tree: &Tree, error: &SpannedError, path: &[String]) -> SceneProblem {
    let byte = scene.byte_at(error.span.end.line, error.span.end.col);
    let context = Context { scene, tree, path, byte };
    let mut problem = context.explain(&error.code);
    if problem.place.path.is_none() && !path.is_empty() {
        problem.place.path = Some(write_path(path));
    }
    problem
}

struct Context<'a> {
    scene: &'a SceneText,
    tree: &'a Tree,
    path: &'a [String],
    byte: usize,
}

impl Context<'_> {
    fn explain(&self, code: &Error) -> SceneProblem {
        match code {
            Error::NoSuchStructField { expected, found, outer } => {
                let within = outer.as_deref().map(|outer| format!(" in {}", with_article(outer)));
                self.unknown(&format!("unknown key `{found}`{}", within.unwrap_or_default()), found, expected)
            }
            Error::NoSuchEnumVariant { expected, found, outer } => {
                let within = outer.as_deref().map(|outer| format!(" for {}", with_article(outer)));
                self.unknown(
                    &format!("unknown choice `{found}`{}", within.unwrap_or_default()),
                    found,
                    expected,
                )
            }
            Error::ExpectedDifferentStructName { expected, found } => {
                self.unknown(&format!("expected `{expected}`, found `{found}`"), found, &[expected])
            }
            Error::MissingStructField { field, outer } => self.missing(field, outer.as_deref()),
            Error::DuplicateStructField { .. } => {
                checks::first(self.scene, self.tree).unwrap_or_else(|| self.at_token(&plain(code), None))
            }
            Error::Message(_) | Error::InvalidValueForType { .. } | Error::ExpectedDifferentLength { .. } => {
                self.at_value(plain(code))
            }
            Error::IntegerOutOfBounds => self.at_value("this whole number is out of range".to_owned()),
            _ => self.expected(code),
        }
    }

    fn problem(&self, message: impl Into<String>) -> SceneProblem {
        SceneProblem::of_file(self.scene.name.clone(), message)
    }

    fn unknown(&self, message: &str, found: &str, allowed: &[&str]) -> SceneProblem {
        // The reader stands behind the name, which may be written as a raw one.
        let token = self.tree.word_before(&self.scene.text, found, self.byte + 1);
        let span = token.map_or(self.byte..self.byte, |token| token.span.clone());
        let mut problem = self.problem(message);
        problem.allowed = Some(if allowed.is_empty() { "nothing".to_owned() } else { listed(allowed) });
        problem.hint = nearest(found, allowed).map(|name| format!("did you mean `{name}`?"));
        problem.at(self.scene, span, "")
    }

    fn missing(&self, field: &str, outer: Option<&str>) -> SceneProblem {
        let within = outer.map_or(String::new(), |outer| format!(" in {}", with_article(outer)));
        let span = match self.value() {
            Some((node, Some(key))) if node.group().is_some_and(|group| group.name.is_none()) => {
                key.span.clone()
            }
            Some((node, _)) => node.head(),
            None => self.byte..self.byte,
        };
        self.problem(format!("missing key `{field}`{within}"))
            .with_hint(format!("add `{field}: ...` between its brackets"))
            .at(self.scene, span, format!("`{field}` is missing"))
    }

    /// The value that the path leads to, and its key.
    fn value(&self) -> Option<(&Node, Option<&Node>)> {
        match find(&self.scene.text, self.tree.root.as_ref()?, self.path) {
            Found::Value { node, key } => Some((node, key)),
            Found::Missing { .. } => None,
        }
    }

    /// A complaint about the whole value at the path.
    fn at_value(&self, message: String) -> SceneProblem {
        let Some((mut node, _)) = self.value() else { return self.at_token(&message, None) };
        while let Some(argument) = node.only_argument() {
            node = argument;
        }
        let span = if node.group().is_some() { node.head() } else { node.span.clone() };
        self.problem(message).at(self.scene, span, "")
    }

    /// A complaint about the token where the reader stopped.
    fn at_token(&self, message: &str, label: Option<&str>) -> SceneProblem {
        let span = self.token().map_or(self.end(), |token| token.span.clone());
        self.problem(message).at(self.scene, span, label.unwrap_or_default())
    }

    fn token(&self) -> Option<&Token> {
        self.tree.token_at(self.byte)
    }

    fn end(&self) -> Span {
        let end = self.scene.text.trim_end().len();
        end..end
    }

    /// A complaint that something else was expected.
    fn expected(&self, code: &Error) -> SceneProblem {
        if let Some(problem) = self.unbalanced(code) {
            return problem;
        }
        let Some(token) = self.token() else {
            return self.at_token("the text ends too early", Some("something is missing here"));
        };
        let found = &self.scene.text[token.span.clone()];
        let inside = token.kind == Kind::Number && token.span.start < self.byte;
        if inside && matches!(code, Error::ExpectedComma | Error::ExpectedStructLikeEnd) {
            let message = format!("expected a whole number, found `{}`", shortened(found));
            return self.at_token(&message, Some("a whole number has no decimals"));
        }
        if let Some(problem) = self.without_values(code, token) {
            return problem;
        }
        let Some(wanted) = wanted(code) else { return self.at_token(&plain(code), None) };
        let message = format!("expected {wanted}, found `{}`", shortened(found));
        let mut problem = self.at_token(&message, Some(&format!("expected {wanted}")));
        problem.hint = hint(code, token.kind, found).or_else(|| self.unit_without_quotes(code, token));
        problem
    }

    /// A variant such as `For` that lacks its values.
    fn without_values(&self, code: &Error, token: &Token) -> Option<SceneProblem> {
        let ended = matches!(token.kind, Kind::Mark(',' | ')' | ']' | '}'));
        let before = self.tree.tokens.partition_point(|other| other.span.start < token.span.start);
        let name = self.tree.tokens[..before].last().filter(|name| ended && name.kind == Kind::Word)?;
        let message = format!("`{}` needs values in round brackets", &self.scene.text[name.span.clone()]);
        matches!(code, Error::ExpectedStructLike)
            .then(|| self.problem(message).at(self.scene, name.span.clone(), "without values"))
    }

    /// A number with a word behind it is most often a value with its unit.
    fn unit_without_quotes(&self, code: &Error, token: &Token) -> Option<String> {
        let at = self.tree.tokens.partition_point(|other| other.span.start < token.span.start);
        let number = at.checked_sub(1).is_some_and(|before| self.tree.tokens[before].kind == Kind::Number);
        let key = self.tree.tokens.get(at + 1).is_some_and(|after| after.kind == Kind::Mark(':'));
        let unit = token.kind == Kind::Word && number && !key;
        (unit && matches!(code, Error::ExpectedComma))
            .then(|| "a value with a unit is written in double quotes".to_owned())
    }

    /// A bracket without its partner explains most errors that come after it.
    fn unbalanced(&self, code: &Error) -> Option<SceneProblem> {
        let follows = matches!(
            code,
            Error::Eof
                | Error::ExpectedComma
                | Error::ExpectedArrayEnd
                | Error::ExpectedMapEnd
                | Error::ExpectedStructLikeEnd
                | Error::ExpectedMapColon
                | Error::TrailingCharacters
                | Error::ExpectedIdentifier
                | Error::UnexpectedChar(_)
                | Error::ExpectedStructLike
        );
        let imbalance = self.tree.imbalance.as_ref().filter(|_| follows)?;
        Some(match *imbalance {
            Imbalance::Open { bracket, at, met } => {
                let problem = self.problem(format!("`{bracket}` is not closed"));
                let problem = match met {
                    Some((other, other_at)) => {
                        let (line, column) = self.scene.line_and_column(other_at);
                        let name = &self.scene.name;
                        problem.with_hint(format!("instead, `{other}` follows at {name}:{line}:{column}"))
                    }
                    None => problem.with_hint("the text ends before it is closed"),
                };
                problem.at(self.scene, at..at + 1, "opened here")
            }
            Imbalance::Close { bracket, at } => {
                let problem = self.problem(format!("`{bracket}` closes nothing"));
                problem.at(self.scene, at..at + 1, "no bracket is open here")
            }
        })
    }
}

/// What the reader expected, in words; none where it says more than that.
fn wanted(code: &Error) -> Option<String> {
    Some(match code {
        Error::ExpectedFloat => "a number".to_owned(),
        Error::ExpectedInteger => "a whole number".to_owned(),
        Error::ExpectedBoolean => "`true` or `false`".to_owned(),
        Error::ExpectedString => "a text in double quotes".to_owned(),
        Error::ExpectedChar => "a character in single quotes".to_owned(),
        Error::ExpectedArray => "a list in square brackets".to_owned(),
        Error::ExpectedMap => "a map in braces".to_owned(),
        Error::ExpectedIdentifier | Error::SuggestRawIdentifier(_) | Error::InvalidIdentifier(_) => {
            "a name".to_owned()
        }
        Error::ExpectedStringEnd => "`\"` at the end of this text".to_owned(),
        Error::ExpectedComma => "a comma".to_owned(),
        Error::ExpectedMapColon => "`:` and a value".to_owned(),
        Error::ExpectedStructLike => "values in round brackets".to_owned(),
        Error::ExpectedNamedStructLike("") => "values in round brackets".to_owned(),
        Error::ExpectedNamedStructLike(name) => format!("`{name}(...)` or `(...)`"),
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => "`)`".to_owned(),
        Error::ExpectedArrayEnd => "`]`".to_owned(),
        Error::ExpectedMapEnd => "`}`".to_owned(),
        Error::TrailingCharacters => "nothing after the scene".to_owned(),
        _ => return None,
    })
}

fn hint(code: &Error, kind: Kind, found: &str) -> Option<String> {
    Some(match (code, kind) {
        (Error::ExpectedString, Kind::Word | Kind::Number) => {
            format!("write it in double quotes: \"{found}\"")
        }
        (Error::ExpectedFloat, Kind::Text) => "this number takes no unit; write it without quotes".to_owned(),
        (Error::ExpectedIdentifier, Kind::Text) => "names are written without quotes".to_owned(),
        (Error::ExpectedStructLike, Kind::Mark('[')) => {
            "a fixed number of values is written in round brackets: `(1.0, 2.0)`".to_owned()
        }
        (Error::ExpectedArray, Kind::Mark('(')) => {
            "lists are written in square brackets: `[1.0, 2.0]`".to_owned()
        }
        (Error::ExpectedMap, Kind::Mark('(')) => "a map is written in braces: `{ \"name\": ... }`".to_owned(),
        (Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_), Kind::Mark('{')) => {
            "keys without quotes belong in round brackets: `(key: value)`".to_owned()
        }
        (Error::ExpectedStructLikeEnd, _) => "there is perhaps one value too many".to_owned(),
        (Error::ExpectedMapColon, Kind::Mark('=')) => "a value is given by `key: value`".to_owned(),
        _ => return None,
    })
}

/// The reader's own words, without the capital letter.
fn plain(code: &Error) -> String {
    let text = code.to_string();
    let mut letters = text.chars();
    match (code, letters.next()) {
        (Error::Message(message), _) => message.clone(),
        (_, Some(first)) => first.to_lowercase().chain(letters).collect(),
        (_, None) => "this cannot be read".to_owned(),
    }
}
