//! What is wrong with a scene, and where.

use super::path::{Found, find, parse_path};
use super::tree::Tree;
use super::words::visible;
use super::{SceneText, Span};
use annotate_snippets::{Annotation, AnnotationKind, Level, Origin, Renderer, Snippet as Source};
use serde::Serialize;
use std::fmt;

/// More problems than this are only counted.
const MOST_TOLD: usize = 100;

/// Characters of a line that are kept before and behind its part: a window keeps a file without line breaks readable.
const BEFORE: usize = 160;
const AFTER: usize = 60;

/// What is wrong with a scene, where, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct SceneProblem {
    /// What is wrong, in one sentence.
    pub message: String,
    /// Where.
    pub place: Box<Place>,
    /// The line of the text, if it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snippet: Option<Box<Snippet>>,
    /// What is allowed there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowed: Option<String>,
    /// What else matters.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// What to do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
}

/// A place in a scene: as much of it as is known.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Place {
    /// File name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// Column in characters, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<usize>,
    /// Path, such as `materials.glass.friction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
}

/// A line of the text with a part underlined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Snippet {
    /// The line.
    pub text: String,
    /// Characters before the underlined part.
    pub before: usize,
    /// Underlined characters; at least one.
    pub width: usize,
    /// What is said about them; may be empty.
    pub label: String,
}

impl SceneProblem {
    /// A value that was read but makes no sense, at a path such as `sample.width`.
    ///
    /// An empty `hint` is none. See [`SceneProblem::located_in`] for the place in the text.
    pub fn at_path(
        path: impl Into<String>,
        value: impl fmt::Display,
        allowed: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        let path = path.into();
        let hint = hint.into();
        Self {
            message: format!("`{path}` is {value}"),
            place: Box::new(Place { path: Some(path), ..Place::default() }),
            snippet: None,
            allowed: Some(allowed.into()),
            notes: Vec::new(),
            hint: (!hint.is_empty()).then_some(hint),
        }
    }

    /// A problem of a whole file.
    pub fn of_file(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            place: Box::new(Place { file: Some(file.into()), ..Place::default() }),
            snippet: None,
            allowed: None,
            notes: Vec::new(),
            hint: None,
        }
    }

    /// The same problem with another hint.
    #[must_use]
    pub fn with_hint(self, hint: impl Into<String>) -> Self {
        Self { hint: Some(hint.into()), ..self }
    }

    /// The same problem with the line of the text that its path leads to, or that the nearest
    /// parent in the text leads to.
    #[must_use]
    pub fn located_in(self, scene: &SceneText) -> Self {
        self.located_by(scene, &Tree::of(&scene.text))
    }

    /// All of these problems with their places, as [`SceneProblem::located_in`]. Of very many the first are told, and how
    /// many more there are.
    pub fn all_located_in(mut problems: Vec<Self>, scene: &SceneText) -> Vec<Self> {
        let more = problems.len().saturating_sub(MOST_TOLD);
        problems.truncate(MOST_TOLD);
        // Reading the text for its places takes longer than all else.
        let tree = Tree::of(&scene.text);
        let mut located: Vec<Self> =
            problems.into_iter().map(|problem| problem.located_by(scene, &tree)).collect();
        if more > 0 {
            let hint = "put those above right first: often many have one cause";
            located.push(Self::of_file(scene.name.clone(), format!("{more} more problems")).with_hint(hint));
        }
        located
    }

    fn located_by(mut self, scene: &SceneText, tree: &Tree) -> Self {
        self.place.file = Some(scene.name.clone());
        let path = self.place.path.as_deref().and_then(parse_path);
        let (Some((path, "")), Some(root)) = (path, tree.root.as_ref()) else { return self };
        match find(&scene.text, root, &path) {
            Found::Value { node, .. } => {
                let mut value = node;
                while let Some(argument) = value.only_argument() {
                    value = argument;
                }
                self.at(scene, value.head(), "")
            }
            Found::Missing { parent, key, segment } => {
                let span = key.map_or_else(|| parent.head(), |key| key.span.clone());
                self.notes.push(format!("`{}` is not written there: its default is meant", path[segment]));
                self.at(scene, span, "")
            }
        }
    }

    /// The same problem at a span of the text.
    pub(super) fn at(mut self, scene: &SceneText, span: Span, label: impl Into<String>) -> Self {
        let (line, column) = scene.line_and_column(span.start);
        self.place.file = Some(scene.name.clone());
        self.place.line = Some(line);
        self.place.column = Some(column);
        self.snippet = Some(Box::new(Snippet::of(&scene.text, &span, label.into())));
        let near = |edit: &&super::edit::Edit| edit.span.start <= span.start && span.start <= edit.span.end;
        if let Some(edit) = scene.edits.iter().rev().find(near) {
            self.notes.push(format!("written by `--set {}`", edit.assignment));
        }
        self
    }
}

impl Snippet {
    fn of(text: &str, span: &Span, label: String) -> Self {
        let start = text[..span.start].rfind('\n').map_or(0, |newline| newline + 1);
        let end = text[span.start..].find('\n').map_or(text.len(), |newline| span.start + newline);
        let line = text[start..end].trim_end_matches('\r');
        let before = text[start..span.start].chars().count();
        let width = text[span.start..span.end.clamp(span.start, end)].trim_end().chars().count();
        let skipped = before.saturating_sub(BEFORE);
        let shown = (before - skipped) + width.clamp(1, AFTER) + AFTER;
        let mut window: String = line.chars().skip(skipped).take(shown).collect();
        if line.chars().count() > skipped + shown {
            window.push('…');
        }
        let cut = skipped > 0;
        let text = if cut { format!("…{window}") } else { window };
        let before = before - skipped + usize::from(cut);
        Self { text: visible(&text), before, width: width.clamp(1, 2 * AFTER), label }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.file, self.line, self.column, &self.path) {
            (Some(file), Some(line), Some(column), _) => write!(f, "{file}:{line}:{column}"),
            (Some(file), _, _, Some(path)) => write!(f, "{file}: {path}"),
            (Some(file), ..) => f.write_str(file),
            (None, .., path) => f.write_str(path.as_deref().unwrap_or("the scene")),
        }
    }
}

impl SceneProblem {
    /// The problem as text, as it is displayed, but in colour for a terminal.
    pub fn in_colour(&self) -> String {
        self.rendered(&Renderer::styled())
    }

    fn rendered(&self, renderer: &Renderer) -> String {
        let place = visible(&self.place.to_string());
        let title = Level::ERROR.primary_title(visible(&self.message));
        let mut allowed = self.allowed.as_deref().map(|allowed| visible(&format!("allowed: {allowed}")));
        let group = match &self.snippet {
            None => title.element(Origin::path(place)),
            Some(snippet) => {
                let label = match snippet.label.as_str() {
                    "" => allowed.take().unwrap_or_default(),
                    label => visible(label),
                };
                let line = self.place.line.unwrap_or(1);
                let source = snippet.source(line, label);
                match &self.place.file {
                    // Columns of a line that was cut are not those of the file.
                    Some(file) if !snippet.is_cut() => title.element(source.path(visible(file))),
                    _ => title.element(Origin::path(place)).element(source),
                }
            }
        };
        let notes = self.notes.iter().map(|note| Level::NOTE.message(visible(note)));
        let hint = self.hint.iter().map(|hint| Level::HELP.message(visible(hint)));
        let allowed = allowed.into_iter().map(|allowed| Level::NOTE.no_name().message(allowed));
        let text = renderer.render(&[group.elements(allowed.chain(notes).chain(hint))]);
        // Without a line of the scene there is no column of line numbers under which the rest would stand.
        if self.snippet.is_some() { text } else { text.replace('\n', "\n ") }
    }
}

impl Snippet {
    /// Whether the text does not begin where the line does.
    fn is_cut(&self) -> bool {
        self.before > BEFORE
    }

    /// The line, of this number, with its part underlined.
    fn source(&self, line: usize, label: String) -> Source<'_, Annotation<'_>> {
        let byte = |count: usize| self.text.char_indices().nth(count).map_or(self.text.len(), |(at, _)| at);
        let span = byte(self.before)..byte(self.before + self.width);
        let annotation = AnnotationKind::Primary.span(span);
        let annotation = if label.is_empty() { annotation } else { annotation.label(label) };
        Source::source(self.text.as_str()).line_start(line).annotation(annotation)
    }
}

impl fmt::Display for SceneProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.rendered(&Renderer::plain()))
    }
}

impl std::error::Error for SceneProblem {}
