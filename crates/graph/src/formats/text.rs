//! Lines of a text file in bounded memory, and short quotations of what is wrong in them.

use std::io::{BufRead, BufReader, ErrorKind, Read};

use thiserror::Error;

/// Longest line that most readers accept, in bytes without its line break.
pub const MAX_LINE_BYTES: usize = 64 * 1024;

/// Longest quotation of a file in an error message, in characters.
const MAX_QUOTED_CHARS: usize = 40;

const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Why a file could not be read as text. Lines and columns count from 1, columns in characters.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TextError {
    /// The source itself failed.
    #[error("line {line}: reading failed")]
    Io {
        /// Line that was being read.
        line: usize,
        /// What the source said.
        source: std::io::Error,
    },
    /// A line beyond the reader's limit. No more than that of it has been kept.
    #[error("line {line} is longer than {limit} bytes; it begins with `{start}`")]
    LineTooLong {
        /// The line.
        line: usize,
        /// Longest line that the reader accepts, in bytes.
        limit: usize,
        /// Its first characters.
        start: String,
    },
    /// Bytes that are not UTF-8.
    #[error("line {line}, column {column}: expected text in UTF-8, found the byte 0x{byte:02x}")]
    NotUtf8 {
        /// The line.
        line: usize,
        /// Where the invalid bytes begin.
        column: usize,
        /// The first of them.
        byte: u8,
    },
}

/// The lines of a source, numbered from 1, without line breaks (LF or CRLF) and byte order mark.
pub(crate) struct Lines<R> {
    source: BufReader<R>,
    buffer: Vec<u8>,
    line: usize,
    limit: usize,
}

impl<R: Read> Lines<R> {
    pub(crate) fn new(source: R) -> Self {
        Self::with_limit(source, MAX_LINE_BYTES)
    }

    /// Lines of at most `limit` bytes.
    pub(crate) fn with_limit(source: R, limit: usize) -> Self {
        let source = BufReader::with_capacity(MAX_LINE_BYTES, source);
        Self { source, buffer: vec![], line: 0, limit }
    }

    /// The next line and its number, or none at the end of the source.
    pub(crate) fn next_line(&mut self) -> Result<Option<(usize, &str)>, TextError> {
        self.line += 1;
        self.buffer.clear();
        if !self.fill()? {
            self.line -= 1;
            return Ok(None);
        }
        if self.buffer.last() == Some(&b'\r') {
            self.buffer.pop();
        }
        if self.buffer.len() > self.limit {
            return Err(self.too_long());
        }
        match std::str::from_utf8(&self.buffer) {
            Ok(_) => Ok(Some((self.line, self.text()))),
            Err(error) => Err(self.not_utf8(error.valid_up_to())),
        }
    }

    /// The next line that is wanted and its number, or none at the end of the source.
    pub(crate) fn next_where(
        &mut self,
        wanted: impl Fn(&str) -> bool,
    ) -> Result<Option<(usize, &str)>, TextError> {
        while let Some((line, text)) = self.next_line()? {
            if wanted(text) {
                // Asked for again, since a borrow that one turn may hand out lasts for every turn.
                return Ok(Some((line, self.text())));
            }
        }
        Ok(None)
    }

    /// Number of lines taken so far.
    pub(crate) fn n_lines(&self) -> usize {
        self.line
    }

    /// The line that was taken last.
    fn text(&self) -> &str {
        let text = std::str::from_utf8(&self.buffer).expect("a line that was returned is UTF-8");
        let bare = if self.line == 1 { text.strip_prefix(BYTE_ORDER_MARK) } else { None };
        bare.unwrap_or(text)
    }

    /// Takes bytes up to the next line feed; false when the source had none left.
    fn fill(&mut self) -> Result<bool, TextError> {
        let mut found_any = false;
        loop {
            let chunk = match self.source.fill_buf() {
                Ok(chunk) => chunk,
                Err(e) if e.kind() == ErrorKind::Interrupted => continue,
                Err(source) => return Err(TextError::Io { line: self.line, source }),
            };
            if chunk.is_empty() {
                return Ok(found_any);
            }
            found_any = true;
            let end = chunk.iter().position(|&b| b == b'\n');
            let part = &chunk[..end.unwrap_or(chunk.len())];
            // One byte more than the limit may be the carriage return of a CRLF.
            if self.buffer.len() + part.len() > self.limit + 1 {
                return Err(self.too_long());
            }
            self.buffer.extend_from_slice(part);
            let used = end.map_or(chunk.len(), |end| end + 1);
            self.source.consume(used);
            if end.is_some() {
                return Ok(true);
            }
        }
    }

    fn too_long(&self) -> TextError {
        let start = &self.buffer[..self.buffer.len().min(4 * MAX_QUOTED_CHARS)];
        let start = quoted(&String::from_utf8_lossy(start));
        TextError::LineTooLong { line: self.line, limit: self.limit, start }
    }

    fn not_utf8(&self, valid_up_to: usize) -> TextError {
        let valid = String::from_utf8_lossy(&self.buffer[..valid_up_to]);
        TextError::NotUtf8 {
            line: self.line,
            column: valid.chars().count() + 1,
            byte: self.buffer[valid_up_to],
        }
    }
}

/// At most forty characters of `text`, safe to show on a terminal.
pub(crate) fn quoted(text: &str) -> String {
    let shown = |c: char| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c };
    let mut start: String = text.chars().take(MAX_QUOTED_CHARS).map(shown).collect();
    if text.chars().nth(MAX_QUOTED_CHARS).is_some() {
        start.push('…');
    }
    start
}
