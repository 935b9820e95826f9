//! Files and folders that the command writes. Unwritable ones are reported before anything is
//! measured; files are written atomically.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// The folder of an option, created if it is missing.
pub(crate) fn folder(option: &str, path: &Path) -> Result<(), Failure> {
    if path.exists() && !path.is_dir() {
        let expected = "a folder, which is made if it is not there";
        return Err(Failure::input([format!("{option} {}: found a file, expected {expected}", path.display())]));
    }
    fs::create_dir_all(path).map_err(|e| unwritable(path, &e))
}

/// Checks that the path is in an existing folder and is not a folder.
pub(crate) fn file(option: &str, path: &Path) -> Result<(), Failure> {
    let wrong =
        |found: &str, expected: &str| Err(Failure::input([format!("{option} {}: found {found}, expected {expected}", path.display())]));
    match path.parent() {
        _ if path.is_dir() => wrong("a folder", "a file"),
        Some(parent) if parent != Path::new("") && !parent.is_dir() => wrong("no such folder", "a file in a folder that is there"),
        _ => Ok(()),
    }
}

/// Whether two paths lead to one file, by links of either sort.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    matches!((identity(a), identity(b)), (Ok(a), Ok(b)) if a == b)
}

/// Unique identity of a file: its device and number.
#[cfg(unix)]
fn identity(path: &Path) -> io::Result<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(path).map(|file| (file.dev(), file.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> io::Result<PathBuf> {
    path.canonicalize()
}

/// Writes a file; an old file stays unchanged after an error.
pub(crate) fn write(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    written(path, bytes.as_ref()).map_err(|e| unwritable(path, &e))
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    Failure::input([format!("{}: {error}", path.display())])
}

fn written(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // A link stays one, to a file with the new content.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let old = match fs::metadata(&target) {
        // A pipe or a device has no content to keep.
        Ok(old) if !old.is_file() => return fs::write(target, bytes),
        // A file that must not be written is not replaced.
        Ok(old) => fs::OpenOptions::new().append(true).open(&target).map(|_| Some(old.permissions()))?,
        Err(_) => None,
    };
    let folder = target.parent().filter(|parent| *parent != Path::new("")).unwrap_or(Path::new("."));
    let (beside, mut file) = match beside(folder) {
        Ok(made) => made,
        // If no file can be created, an existing one can still be written.
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied && old.is_some() => return fs::write(target, bytes),
        Err(error) => return Err(error),
    };
    let written = file.write_all(bytes).and_then(|()| old.map_or(Ok(()), |permissions| file.set_permissions(permissions)));
    let replaced = written.and_then(|()| fs::rename(&beside, target));
    if replaced.is_err() {
        let _ = fs::remove_file(&beside);
    }
    replaced
}

/// A new file in a folder, with the default permissions.
fn beside(folder: &Path) -> io::Result<(PathBuf, fs::File)> {
    for number in 0_u32.. {
        let path = folder.join(format!(".articulated{}_{number}", std::process::id()));
        match fs::OpenOptions::new().write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            made => return made.map(|file| (path, file)),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_written_whole_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.rs");
        for text in ["first and longer", "second"] {
            write(&path, text).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let told = write(&folder.path().join("nowhere").join("a.rs"), "").unwrap_err().errors;
        assert!(told.len() == 1 && told[0].message.contains("a.rs: "), "{told:?}");
    }

    #[cfg(unix)]
    #[test]
    fn links_permissions_and_devices_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mode = |name: &str| fs::metadata(at(name)).unwrap().permissions().mode() & 0o777;
        fs::write(at("plain"), "").unwrap();
        write(&at("new"), "x").unwrap();
        assert_eq!(mode("new"), mode("plain"));
        fs::set_permissions(at("new"), fs::Permissions::from_mode(0o750)).unwrap();
        symlink(at("new"), at("link")).unwrap();
        write(&at("link"), "y").unwrap();
        assert_eq!((fs::read_to_string(at("new")).unwrap().as_str(), mode("new")), ("y", 0o750));
        assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
        fs::hard_link(at("new"), at("hard")).unwrap();
        assert!(["new", "link"].iter().all(|name| is_same(&at(name), &at("hard"))) && !is_same(&at("new"), &at("plain")));
        assert!(!is_same(&at("nothing"), &at("nothing")));
        write(Path::new("/dev/null"), "z").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn what_cannot_be_written_is_told_before_it_is() {
        let folder_ = tempfile::tempdir().unwrap();
        let path = folder_.path().join("a.svg");
        let told = |result: Result<(), Failure>| result.map_err(|failure| failure.errors[0].message.split(": ").last().unwrap().to_owned());
        assert_eq!(told(file("--chart", &path)), Ok(()));
        assert_eq!(told(file("--chart", Path::new("a.svg"))), Ok(()));
        assert_eq!(told(file("--chart", folder_.path())), Err("found a folder, expected a file".into()));
        assert_eq!(
            told(file("--chart", &folder_.path().join("b").join("a.svg"))),
            Err("found no such folder, expected a file in a folder that is there".into())
        );
        fs::write(&path, "").unwrap();
        assert_eq!(told(folder("-o", &path)), Err("found a file, expected a folder, which is made if it is not there".into()));
        assert_eq!(told(folder("-o", &folder_.path().join("c").join("d"))), Ok(()));
    }
}
