//! An XML document as nested elements, with the line and column where each begins.

use std::io::{self, BufRead, BufReader, Read};

use quick_xml::XmlVersion;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::error::GraphMlError;
use crate::formats::text::quoted;

/// Longest tag or run of text that is read, in bytes.
const MAX_EVENT_BYTES: usize = 1 << 20;

/// Attributes that GraphML gives a meaning here; others are passed over.
const ATTRIBUTES: [&str; 8] =
    ["id", "for", "attr.name", "edgedefault", "source", "target", "directed", "key"];

/// Where something begins, counted from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) line: usize,
    pub(super) column: usize,
}

/// The start of an element.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) place: Place,
    attributes: Vec<(&'static str, String)>,
}

impl Element {
    pub(super) fn attribute(&self, name: &'static str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| *n == name).map(|(_, value)| value.as_str())
    }

    pub(super) fn required(&self, name: &'static str) -> Result<&str, GraphMlError> {
        self.attribute(name).ok_or_else(|| GraphMlError::MissingAttribute {
            line: self.place.line,
            column: self.place.column,
            element: quoted(&self.name),
            attribute: name,
        })
    }

    /// What the attribute chooses among the known words.
    pub(super) fn choice<T: Copy>(
        &self,
        name: &'static str,
        expected: &'static str,
        known: &[(&str, T)],
    ) -> Result<Option<T>, GraphMlError> {
        let Some(value) = self.attribute(name) else { return Ok(None) };
        match known.iter().find(|(word, _)| *word == value) {
            Some(&(_, meaning)) => Ok(Some(meaning)),
            None => Err(GraphMlError::BadAttribute {
                line: self.place.line,
                column: self.place.column,
                attribute: name,
                expected,
                found: quoted(value),
            }),
        }
    }
}

/// The next thing within an element.
enum Item {
    Start(Element),
    Text(String),
    End,
    EndOfFile,
}

/// A document that is read from beginning to end.
pub(super) struct Document<R> {
    reader: Reader<Tracked<BufReader<R>>>,
    buffer: Vec<u8>,
}

impl<R: Read> Document<R> {
    pub(super) fn new(source: R) -> Self {
        let start = Place { line: 1, column: 1 };
        let source = BufReader::with_capacity(64 * 1024, source);
        let mut reader = Reader::from_reader(Tracked { source, place: start, event_bytes: 0 });
        // Then `<node/>` and `<node></node>` read alike.
        reader.config_mut().expand_empty_elements = true;
        Self { reader, buffer: Vec::new() }
    }

    /// The next element within that one, or none at its end.
    pub(super) fn child(&mut self, parent: &str) -> Result<Option<Element>, GraphMlError> {
        loop {
            let place = self.place();
            match self.item()? {
                Item::Start(element) => return Ok(Some(element)),
                Item::End => return Ok(None),
                Item::Text(text) if text.trim().is_empty() => {}
                Item::Text(text) => {
                    let Place { line, column } = place;
                    let (expected, found) = ("elements only", quoted(text.trim()));
                    return Err(GraphMlError::Unexpected { line, column, expected, found });
                }
                Item::EndOfFile => return Err(self.unclosed(parent)),
            }
        }
    }

    /// The first element of the document.
    pub(super) fn root(&mut self) -> Result<Element, GraphMlError> {
        loop {
            let Place { line, column } = self.place();
            let expected = "the element `graphml`";
            match self.item()? {
                Item::Start(element) if element.name == "graphml" => return Ok(element),
                Item::Start(element) => {
                    let Place { line, column } = element.place;
                    let found = format!("<{}>", quoted(&element.name));
                    return Err(GraphMlError::Unexpected { line, column, expected, found });
                }
                Item::Text(text) if text.trim_matches(is_blank_or_mark).is_empty() => {}
                Item::Text(text) => {
                    let found = quoted(text.trim());
                    return Err(GraphMlError::Unexpected { line, column, expected, found });
                }
                Item::End | Item::EndOfFile => {
                    let found = "the end of the file".to_owned();
                    return Err(GraphMlError::Unexpected { line, column, expected, found });
                }
            }
        }
    }

    /// Expects nothing but blanks and comments to the end of the file.
    pub(super) fn end(&mut self) -> Result<(), GraphMlError> {
        loop {
            let Place { line, column } = self.place();
            let found = match self.item()? {
                Item::EndOfFile => return Ok(()),
                Item::Text(text) if text.trim().is_empty() => continue,
                Item::Text(text) => quoted(text.trim()),
                Item::Start(element) => format!("<{}>", quoted(&element.name)),
                Item::End => "the end of an element".to_owned(),
            };
            let expected = "nothing after the element `graphml`";
            return Err(GraphMlError::Unexpected { line, column, expected, found });
        }
    }

    /// The text of an element without its ends' blanks, or none where elements stand in it.
    pub(super) fn text(&mut self, parent: &str) -> Result<Option<String>, GraphMlError> {
        let (mut content, mut has_elements) = (String::new(), false);
        loop {
            match self.item()? {
                Item::Text(text) => content.push_str(&text),
                Item::End if has_elements => return Ok(None),
                Item::End => return Ok(Some(content.trim().to_owned())),
                Item::EndOfFile => return Err(self.unclosed(parent)),
                Item::Start(element) => {
                    has_elements = true;
                    self.skip(&element.name)?;
                }
            }
        }
    }

    /// Passes over what is left of an element.
    pub(super) fn skip(&mut self, parent: &str) -> Result<(), GraphMlError> {
        let mut depth = 1_usize;
        while depth > 0 {
            match self.item()? {
                Item::Start(_) => depth += 1,
                Item::End => depth -= 1,
                Item::Text(_) => {}
                Item::EndOfFile => return Err(self.unclosed(parent)),
            }
        }
        Ok(())
    }

    fn place(&self) -> Place {
        self.reader.get_ref().place
    }

    fn unclosed(&self, element: &str) -> GraphMlError {
        GraphMlError::Unclosed { line: self.place().line, element: quoted(element) }
    }

    fn item(&mut self) -> Result<Item, GraphMlError> {
        loop {
            self.buffer.clear();
            let place = self.place();
            self.reader.get_mut().event_bytes = 0;
            let event = self.reader.read_event_into(&mut self.buffer);
            return match event.map_err(|error| malformed(place, error))? {
                Event::Start(start) | Event::Empty(start) => {
                    element(&start, place).map(Item::Start)
                }
                Event::End(_) => Ok(Item::End),
                Event::Text(text) => Ok(Item::Text(text.xml10_content().into_owned())),
                Event::CData(text) => Ok(Item::Text(text.xml10_content().into_owned())),
                Event::GeneralRef(name) => {
                    let text = match name.resolve_char_ref().map_err(|e| malformed(place, e))? {
                        Some(c) => c.to_string(),
                        None => entity(&name, place)?.to_owned(),
                    };
                    Ok(Item::Text(text))
                }
                Event::Eof => Ok(Item::EndOfFile),
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => continue,
            };
        }
    }
}

/// Blanks, and the byte order mark that may stand before the first element.
fn is_blank_or_mark(c: char) -> bool {
    c.is_whitespace() || c == '\u{feff}'
}

/// The text of one of the five entities that XML itself defines.
fn entity(name: &str, place: Place) -> Result<&'static str, GraphMlError> {
    resolve_predefined_entity(name).ok_or_else(|| {
        let Place { line, column } = place;
        let (expected, found) =
            ("one of the entities that XML defines", format!("&{}", quoted(name)));
        GraphMlError::Unexpected { line, column, expected, found }
    })
}

fn element(start: &BytesStart<'_>, place: Place) -> Result<Element, GraphMlError> {
    let mut attributes: Vec<(&'static str, String)> = Vec::new();
    // The library's own check for repetitions takes quadratic time.
    for attribute in start.attributes().with_checks(false) {
        let attribute = attribute.map_err(|error| malformed(place, error.into()))?;
        let Some(&name) = ATTRIBUTES.iter().find(|name| **name == attribute.key.as_ref()) else {
            continue;
        };
        if attributes.iter().any(|(n, _)| *n == name) {
            let Place { line, column } = place;
            let (expected, found) = ("each attribute once", format!("{name} again"));
            return Err(GraphMlError::Unexpected { line, column, expected, found });
        }
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        attributes.push((name, value.map_err(|error| malformed(place, error))?.into_owned()));
    }
    Ok(Element { name: start.local_name().as_ref().to_owned(), place, attributes })
}

fn malformed(place: Place, error: quick_xml::Error) -> GraphMlError {
    let Place { line, column } = place;
    match error {
        quick_xml::Error::Io(source) => GraphMlError::Io { line, source },
        error => {
            let text = error.to_string();
            let shown = text.chars().map(|c| if c.is_control() { ' ' } else { c });
            GraphMlError::Malformed { line, column, reason: shown.take(200).collect() }
        }
    }
}

/// A source that knows the line and column of its next byte.
struct Tracked<R> {
    source: R,
    place: Place,
    event_bytes: usize,
}

impl<R: BufRead> BufRead for Tracked<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.event_bytes > MAX_EVENT_BYTES {
            let text = format!("a tag or a run of text is longer than {MAX_EVENT_BYTES} bytes");
            return Err(io::Error::other(text));
        }
        self.source.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        // Handing out the same bytes again cannot fail: the buffer holds them.
        let bytes = self.source.fill_buf().unwrap_or_default();
        for &byte in &bytes[..amount.min(bytes.len())] {
            match byte {
                b'\n' => self.place = Place { line: self.place.line + 1, column: 1 },
                // Later bytes of a character of UTF-8 are 10xxxxxx.
                _ if byte & 0xc0 == 0x80 => {}
                _ => self.place.column += 1,
            }
        }
        self.event_bytes += amount;
        self.source.consume(amount);
    }
}

impl<R: BufRead> Read for Tracked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.fill_buf()?.read(buffer)?;
        self.consume(n);
        Ok(n)
    }
}
