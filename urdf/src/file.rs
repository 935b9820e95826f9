//! Bytes of files, of which no more are read than may be: a file may be a device that never ends.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// No URDF is larger, bytes: one of 100 000 links stays well below.
pub const MOST_BYTES: u64 = 64 << 20;

/// The bytes of the file at `path`, `most` at most. Errors: those of the system, and a file that is larger, of which no more is read than `most` and one byte.
/// They do not name the file.
///
/// ```
/// let error = articulated_urdf::read_file("Cargo.toml".as_ref(), 3).unwrap_err();
/// assert!(error.to_string().ends_with(" bytes, expected at most 3 bytes"));
/// ```
pub fn read_file(path: &Path, most: u64) -> Result<Vec<u8>> {
    let file = File::open(path)?;
    let data = file.metadata()?;
    if data.is_file() && data.len() > most {
        return Err(too_large(&data.len().to_string(), most));
    }
    read_at_most(file, most)
}

/// As [`read_file`], of what has been opened already, as the standard input.
pub fn read_at_most(from: impl Read, most: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(&format!("more than {most}"), most)) } else { Ok(bytes) }
}

fn too_large(found: &str, most: u64) -> Error {
    Error::new(ErrorKind::FileTooLarge, format!("found {found} bytes, expected at most {most} bytes"))
}

#[cfg(test)]
mod tests {
    use std::io::{empty, repeat};

    use super::*;

    #[test]
    fn what_is_no_larger_than_may_be_is_read_to_its_end() {
        assert_eq!(read_at_most(&b"robot"[..], 5).unwrap(), b"robot");
        assert_eq!(read_at_most(empty(), 0).unwrap(), b"");
        assert_eq!(read_at_most(&b"robot"[..], u64::MAX).unwrap(), b"robot");
    }

    #[test]
    fn what_never_ends_is_refused() {
        let error = read_at_most(repeat(0), 9).unwrap_err();
        assert_eq!(
            (error.kind(), error.to_string().as_str()),
            (ErrorKind::FileTooLarge, "found more than 9 bytes, expected at most 9 bytes")
        );
    }

    #[test]
    fn a_file_that_is_too_large_is_told_with_its_size() {
        let this = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/file.rs");
        let length = std::fs::metadata(&this).unwrap().len();
        assert_eq!(read_file(&this, length).unwrap().len() as u64, length);
        let error = read_file(&this, length - 1).unwrap_err().to_string();
        assert_eq!(error, format!("found {length} bytes, expected at most {} bytes", length - 1));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_that_never_ends_is_refused() {
        let error = read_file(Path::new("/dev/zero"), 9).unwrap_err().to_string();
        assert_eq!(error, "found more than 9 bytes, expected at most 9 bytes");
    }
}
