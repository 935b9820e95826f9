//! A look at the bare markup, before the XML reader.
//!
//! It accepts what a strict XML reader refuses and the common URDF readers accept (blank lines
//! before the declaration, undeclared prefixes, `--` in a comment), and it bounds what an XML
//! reader allocates.

use articulated_core::diagnostic::{Code, quote};
const MOST_DEPTH: usize = 256;
const MOST_ATTRIBUTES: usize = 256;
const MOST_TAGS: usize = 4 << 20;
const MOST_EQUAL_SIGNS: usize = 8 << 20;

/// Replaces the colon of a prefix: as in the common readers, prefixes are part of the name.
const COLON: char = '\u{b7}';

/// A name of the prepared text as the file writes it.
pub(crate) fn as_written(name: &str) -> String {
    name.replace(COLON, ":")
}

/// Whether a name of the prepared text is `name` as a file writes it.
pub(crate) fn is_name(prepared: &str, name: &str) -> bool {
    prepared == name || name.contains(':') && as_written(prepared) == name
}

/// ` (did you mean "upper"?)`, or empty.
pub(crate) fn hint(meant: Option<&str>) -> String {
    meant.map(|name| format!(" (did you mean {}?)", quote(name))).unwrap_or_default()
}

/// The name of the first tag, after comments and declarations.
pub(crate) fn root(bytes: &[u8]) -> Option<&[u8]> {
    let mut rest = bytes;
    loop {
        rest = &rest[rest.iter().position(|b| *b == b'<')? + 1..];
        let after = |end: &[u8]| rest.windows(end.len()).position(|window| window == end);
        let skip = match rest {
            [b'!', b'-', b'-', ..] => after(b"-->")?,
            [b'!' | b'?', ..] => 1,
            _ => {
                let length = rest.iter().position(|b| b.is_ascii_whitespace() || matches!(b, b'/' | b'>')).unwrap_or(rest.len());
                return Some(&rest[..length]);
            }
        };
        rest = &rest[skip..];
    }
}

/// Reason why a text is refused before parsing.
pub(crate) struct Fault {
    pub(crate) position: usize,
    pub(crate) kind: Code,
    pub(crate) found: String,
    pub(crate) expected: String,
}

/// `text` without comments, declarations and prefixes, with the same lines. Malformed content stays
/// unchanged: the XML reader reports it better.
pub(crate) fn prepare(text: &str) -> Result<String, Fault> {
    let mut look = Look { text, at: 0, out: String::with_capacity(text.len()), depth: 0, tags: 0 };
    look.bound('=', MOST_EQUAL_SIGNS)?;
    look.bound('<', MOST_TAGS * 2)?;
    while look.at < text.len() {
        look.step()?;
    }
    Ok(look.out)
}

struct Look<'a> {
    text: &'a str,
    /// All text before it is done; always between two characters.
    at: usize,
    out: String,
    depth: usize,
    tags: usize,
}

impl<'a> Look<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn bound(&self, sign: char, most: usize) -> Result<(), Fault> {
        match self.text.matches(sign).count() {
            n if n > most => Err(self.too_large(format!("{n} times '{sign}'"), most)),
            _ => Ok(()),
        }
    }

    fn too_large(&self, found: String, most: usize) -> Fault {
        Fault { position: self.at, kind: Code::TooLarge, found, expected: format!("at most {most}") }
    }

    fn step(&mut self) -> Result<(), Fault> {
        let rest = self.rest();
        match rest.find('<') {
            Some(0) => self.markup(rest),
            Some(next) => {
                self.copy(next);
                Ok(())
            }
            None => {
                self.copy(rest.len());
                Ok(())
            }
        }
    }

    fn markup(&mut self, rest: &str) -> Result<(), Fault> {
        if rest.starts_with("<!--") {
            self.drop_through(4, "-->");
        } else if rest.starts_with("<?") {
            self.drop_through(2, "?>");
        } else if rest.starts_with("<![CDATA[") {
            let end = rest.find("]]>").map_or(rest.len(), |end| end + 3);
            self.copy(end);
        } else if rest.starts_with("<!") {
            return Err(self.declaration(rest));
        } else if rest.starts_with("</") {
            self.depth = self.depth.saturating_sub(1);
            self.names(rest.find('>').map_or(rest.len(), |end| end + 1));
        } else {
            return self.tag();
        }
        Ok(())
    }

    fn declaration(&self, rest: &str) -> Fault {
        let found: String = rest.chars().take_while(|c| *c == '<' || *c == '!' || c.is_ascii_alphabetic()).take(20).collect();
        Fault {
            position: self.at,
            kind: Code::Doctype,
            found: format!("the declaration {found}"),
            expected: "a document without DOCTYPE (DTD) and entities of its own".to_owned(),
        }
    }

    fn copy(&mut self, length: usize) {
        self.out.push_str(&self.rest()[..length]);
        self.at += length;
    }

    /// Replaces characters by blanks, and keeps line ends; up to the end of the text, if there is
    /// no `end`.
    fn drop_through(&mut self, after: usize, end: &str) {
        let rest = self.rest();
        match rest[after..].find(end) {
            Some(position) => {
                let length = after + position + end.len();
                self.out.extend(rest[..length].chars().map(|c| if c == '\n' { c } else { ' ' }));
                self.at += length;
            }
            None => self.copy(rest.len()),
        }
    }

    /// Copies names, and replaces the colon.
    fn names(&mut self, length: usize) {
        for piece in self.rest()[..length].split_inclusive(':') {
            match piece.strip_suffix(':') {
                Some(piece) => self.out.extend([piece, COLON.encode_utf8(&mut [0; 4])]),
                None => self.out.push_str(piece),
            }
        }
        self.at += length;
    }

    /// An opening tag, up to and with its `>`.
    fn tag(&mut self) -> Result<(), Fault> {
        self.tags += 1;
        if self.tags > MOST_TAGS {
            return Err(self.too_large(format!("more than {MOST_TAGS} tags"), MOST_TAGS));
        }
        let mut values = 0;
        loop {
            let rest = self.rest();
            let skip = usize::from(rest.starts_with('<'));
            let Some(end) = rest.bytes().skip(skip).position(|b| matches!(b, b'"' | b'\'' | b'>' | b'<')).map(|end| end + skip) else {
                self.names(rest.len());
                return Ok(());
            };
            match rest.as_bytes()[end] {
                b'>' => return self.tag_end(rest, end),
                b'<' => {
                    self.names(end);
                    return Ok(());
                }
                quote => self.value(rest, end, quote as char),
            }
            values += 1;
            if values > MOST_ATTRIBUTES {
                return Err(self.too_large("a tag with very many attributes".to_owned(), MOST_ATTRIBUTES));
            }
        }
    }

    fn tag_end(&mut self, rest: &str, end: usize) -> Result<(), Fault> {
        let empty = rest[..end].ends_with('/');
        self.names(end + 1);
        self.depth += usize::from(!empty);
        match self.depth > MOST_DEPTH {
            true => Err(self.too_large("tags nested very deeply".to_owned(), MOST_DEPTH)),
            false => Ok(()),
        }
    }

    /// Names up to a quotation mark, and the value that it opens.
    fn value(&mut self, rest: &str, open: usize, quote: char) {
        self.names(open);
        let length = rest[open + 1..].find(quote).map_or(rest.len() - open, |end| end + 2);
        self.copy(length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prepared(text: &str) -> String {
        prepare(text).map_err(|fault| fault.found).unwrap()
    }

    #[test]
    fn lines_stay_where_they_were() {
        let text = "\n <?xml\nversion='1.0'?>\n<!-- a -- \n b --><a:b c:d='e:f\n'>g:h</a:b>\n";
        let out = prepared(text);
        assert_eq!(out.matches('\n').count(), text.matches('\n').count());
        let [declaration, comment] = [[5, 15], [10, 6]].map(|rows| rows.map(|n| " ".repeat(n)).join("\n"));
        assert_eq!(out, format!("\n {declaration}\n{comment}<a·b c·d='e:f\n'>g:h</a·b>\n"));
    }

    #[test]
    fn what_is_cut_off_passes_as_it_is() {
        for text in ["<", "<a", "<a b", "<a b='", "<a b='c", "<a b='c'", "<!--", "<?", "</", "<![CDATA[", "a", ""] {
            assert_eq!(prepared(text), text);
        }
    }

    #[test]
    fn depth_width_and_declarations_are_bounded() {
        assert!(prepare(&"<a>".repeat(1000)).is_err());
        assert!(prepare(&"<a></a>".repeat(1000)).is_ok());
        assert!(prepare(&format!("<a {}/>", "b='c' ".repeat(1000))).is_err());
        assert_eq!(prepare("<!DOCTYPE x>").err().map(|f| f.kind), Some(Code::Doctype));
    }
}
