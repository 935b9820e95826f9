//! From bytes to an XML document.

use articulated_core::diagnostic::{At, Code, Diagnostics, Place};
use roxmltree::{Document, Error};

use super::lines::{Lines, line_of};
use super::markup;
use crate::files::MOST_BYTES;

/// The text of the file, prepared for a strict XML reader; see [`markup::prepare`]. Line numbers
/// are unchanged.
pub(crate) fn text(bytes: &[u8], log: &mut Diagnostics) -> Option<String> {
    if bytes.len() as u64 > MOST_BYTES {
        let found = format!("{} bytes", bytes.len());
        log.error(Place::DOCUMENT, Code::TooLarge, found, format!("at most {MOST_BYTES} bytes"));
        return None;
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = utf8(bytes, log)?;
    match markup::prepare(text) {
        Ok(text) => Some(text),
        Err(fault) => {
            let place = Place { at: line_of(bytes, fault.position), ..Place::DOCUMENT };
            log.error(place, fault.kind, fault.found, fault.expected);
            None
        }
    }
}

fn utf8<'a>(bytes: &'a [u8], log: &mut Diagnostics) -> Option<&'a str> {
    let fault = match std::str::from_utf8(bytes) {
        Ok(text) => return Some(text),
        Err(fault) => fault.valid_up_to(),
    };
    let found = match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "the byte order mark of UTF-16".to_owned(),
        _ => format!("byte 0x{:02x}, which is not UTF-8", bytes.get(fault).copied().unwrap_or_default()),
    };
    let place = Place { at: line_of(bytes, fault), ..Place::DOCUMENT };
    log.error(place, Code::NotUtf8, found, "a file in the encoding UTF-8");
    None
}

/// The XML document.
pub(crate) fn parse<'a>(text: &'a str, lines: &Lines<'_>, log: &mut Diagnostics) -> Option<Document<'a>> {
    let fault = match Document::parse(text) {
        Ok(document) => return Some(document),
        Err(fault) => fault,
    };
    let place = Place { at: line_of_fault(&fault, lines), field: "XML", ..Place::DOCUMENT };
    // The column is that of the prepared text, so it is left out.
    let found = fault.to_string().replace(&format!(" at {}", fault.pos()), "");
    log.error(place, Code::Xml, markup::as_written(&found), "a well-formed XML document");
    None
}

fn line_of_fault(fault: &Error, lines: &Lines<'_>) -> At {
    match fault {
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream | Error::NoRootNode => lines.last(),
        _ => At::line_of(fault.pos().row),
    }
}
