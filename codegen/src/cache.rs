//! The last output of a build script, so that the same request generates nothing.
//!
//! A file beside the output contains, byte for byte, everything that determines the output: the
//! generator, all options, every robot file. There is no hash that could collide. The generator is
//! identified by its program, the build script: its length and its link time, which changes
//! whenever the generator or a dependency of it is recompiled.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use crate::Request;

/// The memory of one output.
pub(crate) struct Cache {
    output: PathBuf,
    file: PathBuf,
    key: Vec<u8>,
}

impl Cache {
    /// That of `output`, for `request` and this program; `None` if the system does not report the
    /// running program.
    pub(crate) fn new(output: &Path, request: &Request) -> Option<Self> {
        Some(Self::of(output, request, &stamp(&std::env::current_exe().ok()?)?))
    }

    fn of(output: &Path, request: &Request, generator: &str) -> Self {
        Self { output: output.into(), file: output.with_extension("key"), key: key(request, generator) }
    }

    /// The warnings of the output, if it is unchanged and was written for the same request by the
    /// same generator.
    pub(crate) fn warnings(&self) -> Option<Vec<String>> {
        let stored = fs::read(&self.file).ok()?;
        let rest = std::str::from_utf8(stored.strip_prefix(self.key.as_slice())?).ok()?;
        let mut lines = rest.lines();
        let unchanged = lines.next() == stamp(&self.output).as_deref();
        unchanged.then(|| lines.map(str::to_owned).collect())
    }

    /// Call it before the output is written: an interrupted build then leaves no record of it.
    pub(crate) fn forget(&self) {
        let _ = fs::remove_file(&self.file);
    }

    /// Call it after that. Without a record, the next run only generates again.
    pub(crate) fn remember(&self, warnings: &[String]) {
        let Some(stamp) = stamp(&self.output) else { return };
        let lines: String = std::iter::once(&stamp).chain(warnings).map(|line| format!("{line}\n")).collect();
        if fs::write(&self.file, [self.key.as_slice(), lines.as_bytes()].concat()).is_err() {
            self.forget();
        }
    }
}

/// Key of all inputs that determine the output. Each part is preceded by its length, so no key is a
/// prefix of another.
fn key(request: &Request, generator: &str) -> Vec<u8> {
    let (mut options, mut documents) = (request.options.clone(), vec![request.document.clone()]);
    documents.extend(options.robot.append.iter_mut().map(|other| std::mem::take(&mut other.document)));
    documents.extend(options.robot.included.files().map(|(_, bytes)| bytes.to_vec()));
    let lengths: Vec<usize> = documents.iter().map(Vec::len).collect();
    let mut head = format!("articulated {}, {generator}\n", env!("CARGO_PKG_VERSION"));
    // Only the parts of the scene that determine code.
    let scene = request.scene.as_ref().map(|scene| (&scene.effects, &scene.shafts, &scene.impact));
    let _ = writeln!(head, "{:?} {options:?} {scene:?} {lengths:?}", request.file);
    let mut key = head.into_bytes();
    documents.iter().for_each(|document| key.extend(document));
    key.push(b'\n');
    key
}

/// How long a file is and when it was written last.
fn stamp(file: &Path) -> Option<String> {
    let data = fs::metadata(file).ok()?;
    let since = data.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some(format!("{} bytes of {}", data.len(), since.as_nanos()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Appended, Base, Payload};

    fn request() -> Request {
        let mut request = Request::new("arm.document", "<robot/>");
        request.options.robot.append.push(Appended { document: "<robot>ab</robot>".into(), ..Appended::default() });
        request.options.robot.append.push(Appended { document: "c".into(), ..Appended::default() });
        request
    }

    #[test]
    fn a_file_that_somebody_wrote_to_is_not_as_it_was_written() {
        let folder = std::env::temp_dir().join(format!("articulated-stamp-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let output = folder.join("arm.rs");
        let write = |text: &str, seconds: u64| {
            fs::write(&output, text).unwrap();
            let file = fs::File::options().append(true).open(&output).unwrap();
            file.set_modified(UNIX_EPOCH + std::time::Duration::from_secs(seconds)).unwrap();
        };
        write("one", 1000);
        let cache = Cache::of(&output, &request(), "g");
        assert_eq!(cache.warnings(), None);
        let warnings = ["odd".to_owned(), "odder".to_owned()];
        cache.remember(&warnings);
        assert_eq!(cache.warnings(), Some(warnings.to_vec()));
        // As long, but later; and as late, but longer.
        write("two", 1001);
        assert_eq!(cache.warnings(), None);
        write("three", 1000);
        assert_eq!(cache.warnings(), None);
        write("one", 1000);
        assert!(cache.warnings().is_some() && Cache::of(&output, &request(), "h").warnings().is_none());
        cache.forget();
        assert_eq!(cache.warnings(), None);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn whatever_changes_the_output_changes_the_key() {
        let changes: [fn(&mut Request); 11] = [
            |r| r.document.push(b' '),
            |r| r.file.push('2'),
            |r| r.options.robot.base = Base::Floating,
            |r| r.options.robot.gravity = Some([-0.0, 0.0, 0.0]),
            |r| r.options.functions.push("mass_matrix".into()),
            |r| r.options.robot.payloads.push(Payload { link: "tool".into(), mass: 1.0, ..Payload::default() }.into()),
            |r| r.options.robot.coupling.push(crate::Coupling { joint: "elbow".into(), ..crate::Coupling::default() }.into()),
            |r| r.options.robot.lock.push(("elbow".to_owned(), vec![0.1]).into()),
            |r| r.options.robot.append[1].document.push(b'd'),
            |r| r.options.robot.append[1].document[0] = b'd',
            |r| {
                // The same bytes, divided in another way.
                let moved = r.options.robot.append[0].document.pop().unwrap();
                r.options.robot.append[1].document.insert(0, moved);
            },
        ];
        let plain = key(&request(), "g");
        assert_eq!(plain, key(&request(), "g"));
        assert_ne!(plain, key(&request(), "h"));
        for (k, change) in changes.iter().enumerate() {
            let mut other = request();
            change(&mut other);
            let other = key(&other, "g");
            assert!(!other.starts_with(&plain) && !plain.starts_with(&other), "change {k}");
        }
    }
}
