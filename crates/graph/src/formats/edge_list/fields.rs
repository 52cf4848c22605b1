//! Values of one line, separated by blanks, tabs or one comma, bare or in double quotes.

use std::borrow::Cow;

use super::error::EdgeListError;

/// One value of a line.
pub(crate) struct Field<'a> {
    pub(crate) text: Cow<'a, str>,
    offset: usize,
}

impl Field<'_> {
    /// Where the value begins in its line, in characters from 1.
    pub(crate) fn column(&self, line: &str) -> usize {
        line[..self.offset].chars().count() + 1
    }
}

/// Reads one line from left to right.
pub(crate) struct Fields<'a> {
    line: usize,
    text: &'a str,
    offset: usize,
    after_comma: bool,
}

impl<'a> Fields<'a> {
    pub(crate) fn new(line: usize, text: &'a str) -> Self {
        Self { line, text, offset: 0, after_comma: false }
    }

    /// The next value, or none at the end of the line or the start of a comment.
    pub(crate) fn next_field(&mut self) -> Result<Option<Field<'a>>, EdgeListError> {
        self.skip_blanks();
        let field = match self.peek() {
            None | Some('#' | '%') if !self.after_comma => return Ok(None),
            None | Some('#' | '%' | ',') => {
                let (line, column) = (self.line, self.column());
                return Err(EdgeListError::EmptyField { line, column });
            }
            Some('"') => self.quoted()?,
            Some(_) => self.bare()?,
        };
        self.skip_blanks();
        self.after_comma = self.peek() == Some(',');
        self.offset += usize::from(self.after_comma);
        Ok(Some(field))
    }

    fn bare(&mut self) -> Result<Field<'a>, EdgeListError> {
        let offset = self.offset;
        while let Some(c) = self.peek() {
            match c {
                ' ' | '\t' | ',' => break,
                // A semicolon is another program's separator: taken as part of a label, it would
                // make isolated nodes of whole lines.
                '"' | ';' => return Err(self.unexpected(c, "a blank, a comma or a quoted value")),
                c if c.is_control() || c.is_whitespace() => {
                    return Err(self.unexpected(c, "printable text, a blank, a tab or a comma"));
                }
                c => self.offset += c.len_utf8(),
            }
        }
        Ok(Field { text: Cow::Borrowed(&self.text[offset..self.offset]), offset })
    }

    fn quoted(&mut self) -> Result<Field<'a>, EdgeListError> {
        let opening = self.offset;
        let column = self.column();
        self.offset += 1;
        let mut text = String::new();
        loop {
            let rest = &self.text[self.offset..];
            let Some(length) = rest.find('"') else {
                return Err(EdgeListError::UnclosedQuote { line: self.line, column });
            };
            text.push_str(&rest[..length]);
            self.offset += length + 1;
            match self.peek() {
                Some('"') => text.push('"'),
                None | Some(' ' | '\t' | ',') => break,
                Some(c) => return Err(self.unexpected(c, "a blank or a comma after the quote")),
            }
            self.offset += 1;
        }
        if text.is_empty() {
            return Err(EdgeListError::EmptyField { line: self.line, column });
        }
        Ok(Field { text: Cow::Owned(text), offset: opening })
    }

    fn skip_blanks(&mut self) {
        let rest = &self.text[self.offset..];
        self.offset += rest.len() - rest.trim_start_matches([' ', '\t']).len();
    }

    fn peek(&self) -> Option<char> {
        self.text[self.offset..].chars().next()
    }

    fn column(&self) -> usize {
        self.text[..self.offset].chars().count() + 1
    }

    fn unexpected(&self, found: char, expected: &'static str) -> EdgeListError {
        let (line, column) = (self.line, self.column());
        EdgeListError::UnexpectedCharacter { line, column, found, expected }
    }
}
