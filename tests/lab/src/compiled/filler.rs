//! Code that fills the instruction caches, so that no other code stays there.

use std::path::PathBuf;

use super::rustc::{CompileError, Makes, Rustc, Target};
use crate::native::{Kernel, Native};
use crate::process::Folder;

/// Instructions of the filler. One each is a byte on x86-64 and four elsewhere.
pub(crate) const INSTRUCTIONS: usize = 1 << 20;

/// Straight-line code without effect.
#[derive(Debug)]
pub(crate) struct Filler {
    kernel: Kernel,
    // Last, so that the library is closed before its file is removed.
    _folder: Folder,
}

impl Filler {
    /// Compiles and loads it.
    pub(crate) fn build(rustc: &Rustc) -> Result<Self, CompileError> {
        let folder = Folder::new().map_err(CompileError::Folder)?;
        let source = folder.path().join("filler.rs");
        std::fs::write(&source, text()).map_err(CompileError::Folder)?;
        let library: PathBuf = folder.path().join(format!("{}filler{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
        rustc.compile(&source, &library, Makes::Library, Target::Own)?;
        let kernel = Native::open(&library).map_err(CompileError::Load)?.kernel("articulated_filler", &[0], 0);
        let kernel = kernel.ok_or_else(|| CompileError::Load("the filler is not in the library that was compiled".into()))?;
        Ok(Self { kernel, _folder: folder })
    }

    /// Runs it once.
    pub(crate) fn run(&self) {
        self.kernel.call(&[&[]], &mut []);
    }
}

fn text() -> String {
    format!(
        "// SAFETY: it does nothing but take time and place.\n#[unsafe(no_mangle)]\npub(crate) extern \"C\" fn articulated_filler(_: *const f64, _: *mut f64) {{\n    \
         unsafe {{ ::core::arch::asm!(\".rept {INSTRUCTIONS}\", \"nop\", \".endr\") }}\n}}\n"
    )
}
