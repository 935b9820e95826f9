//! Files: regular ones only, of bounded size. A device never ends, and opening a pipe waits for a
//! writer.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::fs::{File, FileType};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use articulated_core::suggest::{Suggester, nearest};

/// Source of documents. Only the implementations of this trait open files of a robot or a scene.
pub trait Sources {
    /// The bytes of a file, at most [`MOST_BYTES`].
    ///
    /// # Errors
    /// Those of the system, files that are not regular, and files that are too large. The error
    /// does
    /// not name the file.
    fn read(&self, path: &Path) -> Result<Vec<u8>>;

    /// The most similar name of a file next to `path`, if there is no file of this name.
    fn nearest(&self, _path: &Path) -> Option<String> {
        None
    }

    /// The names of the files of a folder.
    ///
    /// # Errors
    /// Those of the system; sources that do not know folders.
    fn list(&self, _folder: &Path) -> Result<Vec<String>> {
        Err(Error::new(ErrorKind::Unsupported, "names with wildcards are not read here"))
    }

    /// The folder of a package, if these sources know it.
    fn package(&self, _name: &str) -> Option<PathBuf> {
        None
    }

    /// A variable of the environment, if these sources have one.
    fn variable(&self, _name: &str) -> Option<String> {
        None
    }
}

/// The file system.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Sources for Disk {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        read_file(path, MOST_BYTES)
    }

    fn nearest(&self, path: &Path) -> Option<String> {
        nearest_file(path)
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        list_files(folder)
    }
}

/// The names of the regular files and of the links in a folder; at most 10 000.
fn list_files(folder: &Path) -> Result<Vec<String>> {
    let folder = if folder == Path::new("") { Path::new(".") } else { folder };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        if entry.path().is_file() {
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
        if names.len() > MOST_FILES {
            return Err(Error::new(ErrorKind::FileTooLarge, format!("found a folder of very many files, expected at most {MOST_FILES}")));
        }
    }
    Ok(names)
}

/// Folders of more files are not searched.
const MOST_FILES: usize = 10_000;

/// The file system, and packages and variables of the environment: `AMENT_PREFIX_PATH` and
/// `ROS_PACKAGE_PATH`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Environment;

impl Sources for Environment {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        Disk.read(path)
    }

    fn nearest(&self, path: &Path) -> Option<String> {
        Disk.nearest(path)
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        Disk.list(folder)
    }

    fn package(&self, name: &str) -> Option<PathBuf> {
        let folders = |variable| std::env::var_os(variable).map(|all| std::env::split_paths(&all).collect::<Vec<_>>()).unwrap_or_default();
        let mut shares = folders("AMENT_PREFIX_PATH").into_iter().map(|prefix| prefix.join("share").join(name));
        shares.find(|folder| folder.is_dir()).or_else(|| folders("ROS_PACKAGE_PATH").iter().find_map(|folder| package_below(folder, name)))
    }

    fn variable(&self, name: &str) -> Option<String> {
        std::env::var(name).ok()
    }
}

/// The folder of a package below another one: it has a `package.xml` and this name. The folders
/// below a package are not searched.
fn package_below(folder: &Path, name: &str) -> Option<PathBuf> {
    const MOST_LEVELS: usize = 6;
    let mut level = vec![folder.to_owned()];
    for _ in 0..MOST_LEVELS {
        let mut next = Vec::new();
        for folder in level {
            if folder.join("package.xml").is_file() {
                if folder.file_name().is_some_and(|own| own == name) {
                    return Some(folder);
                }
                continue;
            }
            let Ok(entries) = std::fs::read_dir(&folder) else { continue };
            let mut inside: Vec<PathBuf> = entries.take(MOST_FILES).filter_map(|entry| Some(entry.ok()?.path())).collect();
            inside.sort_unstable();
            next.extend(inside.into_iter().filter(|path| path.is_dir() && !path.is_symlink()));
        }
        next.truncate(MOST_FILES);
        level = next;
    }
    None
}

/// No files: each is refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Sources for NoFiles {
    fn read(&self, _path: &Path) -> Result<Vec<u8>> {
        Err(Error::new(ErrorKind::NotFound, "found a document that includes another file, expected one without"))
    }
}

/// The files that a document includes, read before the document: it can be read again without the
/// file system. Cheap to clone.
#[derive(Clone, Default, PartialEq)]
pub struct Included(Arc<Known>);

/// Answers of the sources.
#[derive(Clone, Default, PartialEq)]
pub(crate) struct Known {
    files: BTreeMap<PathBuf, Found<Vec<u8>>>,
    folders: BTreeMap<PathBuf, Found<Vec<String>>>,
    packages: BTreeMap<String, Option<PathBuf>>,
    variables: BTreeMap<String, Option<String>>,
}

/// The bytes of a file, or the reason why they are missing.
type Found<T> = std::result::Result<T, (ErrorKind, String)>;

impl Included {
    /// Names and bytes of the files, in the order of their names.
    pub fn files(&self) -> impl Iterator<Item = (&Path, &[u8])> {
        self.0.files.iter().filter_map(|(path, found)| Some((path.as_path(), found.as_deref().ok()?)))
    }

    /// These files and others.
    pub fn extend(&mut self, other: Self) {
        if *self.0 == Known::default() {
            *self = other;
        } else if *other.0 != Known::default() {
            let others = Arc::unwrap_or_clone(other.0);
            let own = Arc::make_mut(&mut self.0);
            own.files.extend(others.files);
            own.folders.extend(others.folders);
            own.packages.extend(others.packages);
            own.variables.extend(others.variables);
        }
    }
}

impl fmt::Debug for Included {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.0.files.keys()).finish()
    }
}

fn again<T: Clone>(found: Option<&Found<T>>) -> Option<Result<T>> {
    found.map(|found| found.clone().map_err(|(kind, message)| Error::new(kind, message)))
}

fn kept<T: Clone>(result: &Result<T>) -> Found<T> {
    match result {
        Ok(value) => Ok(value.clone()),
        Err(error) => Err((error.kind(), error.to_string())),
    }
}

impl Sources for Included {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        again(self.0.files.get(path)).unwrap_or_else(|| NoFiles.read(path))
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        again(self.0.folders.get(folder)).unwrap_or_else(|| NoFiles.list(folder))
    }

    fn package(&self, name: &str) -> Option<PathBuf> {
        self.0.packages.get(name).cloned().flatten()
    }

    fn variable(&self, name: &str) -> Option<String> {
        self.0.variables.get(name).cloned().flatten()
    }
}

/// Reads from other sources, and records all that it reads.
pub(crate) struct Recorder<'a> {
    pub(crate) sources: &'a dyn Sources,
    /// The folder that names start from.
    pub(crate) root: &'a Path,
    pub(crate) known: RefCell<Known>,
}

impl Recorder<'_> {
    pub(crate) fn included(self) -> Included {
        Included(Arc::new(self.known.into_inner()))
    }
}

impl Sources for Recorder<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>> {
        let result = self.sources.read(&self.root.join(path));
        self.known.borrow_mut().files.insert(path.to_owned(), kept(&result));
        result
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        let result = self.sources.list(&self.root.join(folder));
        self.known.borrow_mut().folders.insert(folder.to_owned(), kept(&result));
        result
    }

    fn package(&self, name: &str) -> Option<PathBuf> {
        let result = self.sources.package(name);
        self.known.borrow_mut().packages.insert(name.to_owned(), result.clone());
        result
    }

    fn variable(&self, name: &str) -> Option<String> {
        let result = self.sources.variable(name);
        self.known.borrow_mut().variables.insert(name.to_owned(), result.clone());
        result
    }
}

/// The name of the most similar file in the folder of `path`, if `path` does not exist; none in a
/// folder of very many files. Files with the same ending come first; otherwise a file whose whole
/// name is misspelt.
#[must_use]
pub fn nearest_file(path: &Path) -> Option<String> {
    if path.exists() {
        return None;
    }
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).ok()?.take(MOST_FILES).filter_map(|entry| entry.ok());
    let files = entries.filter(|entry| !entry.file_type().is_ok_and(|kind| kind.is_dir()));
    let mut names: Vec<String> = files.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    // Folders have no order of their own.
    names.sort_unstable();
    let alike = names.iter().map(Path::new).filter(|file| file.extension() == path.extension());
    let stem = nearest(path.file_stem()?.to_str()?, alike.filter_map(|file| file.file_stem()?.to_str()));
    let same =
        stem.map(|stem| path.extension().and_then(|ending| ending.to_str()).map_or(stem.clone(), |ending| format!("{stem}.{ending}")));
    same.or_else(|| {
        let wrong = path.file_name()?.to_str()?;
        Suggester::default().misspelt(wrong, names.iter().map(String::as_str)).map(str::to_owned)
    })
}

/// Maximum size of a robot file, bytes: one of 100 000 links is well below.
pub const MOST_BYTES: u64 = 64 << 20;

/// The bytes of the regular file at `path`, `most` at most. Errors: those of [`open_file`].
///
/// ```
/// let error = articulated_formats::read_file("Cargo.toml".as_ref(), 3).unwrap_err();
/// assert!(error.to_string().ends_with(" bytes, expected at most 3 bytes"));
/// ```
pub fn read_file(path: &Path, most: u64) -> Result<Vec<u8>> {
    all(open_file(path, most)?)
}

/// The regular file at `path`, or the target of a link there, to be read in parts. Errors: those of
/// the system; a pipe, a device, a socket or a folder, which are not opened; and a file of more
/// than `most` bytes, at once if its size is known, else from the reader. They do not name the
/// file.
///
/// ```
/// let error = articulated_formats::open_file("src".as_ref(), 3).err().unwrap();
/// assert_eq!(error.to_string(), "found a folder, expected a regular file");
/// ```
pub fn open_file(path: &Path, most: u64) -> Result<AtMost<File>> {
    is_regular(std::fs::metadata(path)?.file_type())?;
    let file = File::open(path)?;
    // The file may have been replaced meanwhile.
    let data = file.metadata()?;
    is_regular(data.file_type())?;
    if data.len() > most { Err(too_large(&data.len().to_string(), most)) } else { Ok(AtMost::new(file, most)) }
}

/// As [`read_file`], for a source that is already open, such as the standard input.
pub fn read_at_most(from: impl Read, most: u64) -> Result<Vec<u8>> {
    all(AtMost::new(from, most))
}

fn all(mut from: impl Read) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.read_to_end(&mut bytes).map(|_| bytes)
}

/// A reader with an error after too many bytes.
#[derive(Debug)]
pub struct AtMost<R> {
    from: R,
    left: u64,
    most: u64,
}

impl<R> AtMost<R> {
    fn new(from: R, most: u64) -> Self {
        Self { from, left: most, most }
    }
}

impl<R: Read> Read for AtMost<R> {
    fn read(&mut self, out: &mut [u8]) -> Result<usize> {
        if self.left == 0 && !out.is_empty() {
            return match self.from.read(&mut [0])? {
                0 => Ok(0),
                _ => Err(too_large(&format!("more than {}", self.most), self.most)),
            };
        }
        let room = usize::try_from(self.left).unwrap_or(usize::MAX).min(out.len());
        let count = self.from.read(&mut out[..room])?;
        self.left -= count as u64;
        Ok(count)
    }
}

fn is_regular(kind: FileType) -> Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    Err(Error::new(ErrorKind::InvalidInput, format!("found {}, expected a regular file", name(kind))))
}

fn name(kind: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let kinds =
            [(kind.is_fifo(), "a pipe"), (kind.is_socket(), "a socket"), (kind.is_char_device() || kind.is_block_device(), "a device")];
        if let Some((_, name)) = kinds.into_iter().find(|(is_it, _)| *is_it) {
            return name;
        }
    }
    if kind.is_dir() { "a folder" } else { "no file" }
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
        let this = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/files.rs");
        let length = std::fs::metadata(&this).unwrap().len();
        assert_eq!(read_file(&this, length).unwrap().len() as u64, length);
        let error = read_file(&this, length - 1).unwrap_err().to_string();
        assert_eq!(error, format!("found {length} bytes, expected at most {} bytes", length - 1));
    }

    /// The pipe has no writer: a program that opens it would wait forever.
    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_refused_at_once() {
        let folder = std::env::temp_dir().join(format!("articulated-kinds-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let [pipe, socket, link] = ["pipe", "socket", "link"].map(|name| folder.join(name));
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let _listening = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        let told = |path: &Path| {
            let errors = [read_file(path, 9).unwrap_err(), open_file(path, 9).unwrap_err()].map(|e| e.to_string());
            assert_eq!(errors[0], errors[1]);
            errors[0].strip_suffix(", expected a regular file").unwrap_or_else(|| panic!("{errors:?}")).to_owned()
        };
        let found = [&folder, &pipe, &link, &socket, Path::new("/dev/zero"), Path::new("/dev/null")].map(told);
        assert_eq!(found, ["found a folder", "found a pipe", "found a pipe", "found a socket", "found a device", "found a device"]);
        std::fs::remove_dir_all(folder).unwrap();
    }

    /// Like a file that grows while it is read.
    #[test]
    fn a_file_that_grows_is_refused_where_it_gets_too_large() {
        let mut reader = AtMost::new(&b"robots"[..], 5);
        let mut first = [0; 4];
        reader.read_exact(&mut first).unwrap();
        assert_eq!(&first, b"robo");
        assert_eq!(all(reader).unwrap_err().to_string(), "found more than 5 bytes, expected at most 5 bytes");
    }
}
