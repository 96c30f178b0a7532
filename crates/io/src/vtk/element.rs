//! Elements of the XML in VTK's files.

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Error, Reader, XmlVersion};

/// An element without what is nested in it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Element {
    pub(super) name: String,
    attributes: Vec<(String, String)>,
    /// Text between its start and the next tag.
    pub(super) text: String,
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// An attribute that is a number.
    pub(super) fn number<T: std::str::FromStr>(&self, name: &str) -> Option<T> {
        self.attribute(name)?.trim().parse().ok()
    }

    /// An attribute that is exactly `N` numbers.
    pub(super) fn numbers<T: std::str::FromStr, const N: usize>(&self, name: &str) -> Option<[T; N]> {
        let words = self.attribute(name)?.split_whitespace();
        let parsed: Option<Vec<T>> = words.map(|word| word.parse().ok()).collect();
        parsed?.try_into().ok()
    }

    fn of(tag: &BytesStart<'_>) -> Result<Self, Error> {
        let attributes = tag.attributes().map(|attribute| {
            let attribute = attribute?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0)?;
            Ok((attribute.key.as_ref().to_owned(), value.into_owned()))
        });
        let attributes = attributes.collect::<Result<_, Error>>()?;
        Ok(Self { name: tag.name().as_ref().to_owned(), attributes, text: String::new() })
    }
}

/// All elements of a text, in the order in which they begin. The text may end before they do.
pub(super) fn elements(text: &str) -> Result<Vec<Element>, Error> {
    let mut reader = Reader::from_str(text);
    let mut found = Vec::new();
    let mut inside = false;
    loop {
        match reader.read_event()? {
            Event::Eof => return Ok(found),
            Event::Start(tag) => {
                found.push(Element::of(&tag)?);
                inside = true;
            }
            Event::Empty(tag) => {
                found.push(Element::of(&tag)?);
                inside = false;
            }
            Event::End(_) => inside = false,
            Event::Text(text) if inside => {
                if let Some(element) = found.last_mut() {
                    element.text.push_str(&text.xml10_content());
                }
            }
            _ => {}
        }
    }
}
