//! Generated source, compiled and loaded, as in a user's program.

mod batch;
mod cc;
mod filler;
mod rustc;
mod symbols;
mod wrapper;

use std::path::PathBuf;
use std::time::Duration;

use articulated_codegen::Generated;
use articulated_core::algorithm::{FunctionError, Shape, check_count, check_length, function};

use crate::native::{Kernel, Native};
use crate::process::Folder;
pub(crate) use batch::{Batch, CompiledBatches};
pub use cc::Cc;
pub(crate) use filler::{Filler, INSTRUCTIONS as FILLER_INSTRUCTIONS};
use rustc::Makes;
pub use rustc::{CompileError, Rustc, Target};

/// The functions of one [`Generated`], compiled by `rustc` as a library and loaded.
#[derive(Debug)]
pub struct Compiled {
    functions: Vec<Loaded>,
    shape: Shape,
    single: bool,
    /// How long `rustc` took, start and linking included.
    pub time: Duration,
    // Last, so that the library is closed before its file is removed.
    _library: Library,
}

/// A library that was compiled for now.
#[derive(Debug)]
struct Library {
    native: Native,
    file: PathBuf,
    time: Duration,
    // Last, as above.
    _folder: Folder,
}

#[derive(Debug)]
struct Loaded {
    name: String,
    kernel: Kernel,
    bytes: Option<u64>,
}

impl Compiled {
    /// Compiles and loads. The source has to be generated without a runtime
    /// (`options.rust().runtime` is `None`).
    pub fn build(rustc: &Rustc, generated: &Generated) -> Result<Self, CompileError> {
        Self::build_for(Target::Own, rustc, generated)
    }

    /// As [`Compiled::build`], for certain processors. With `f32` numbers, arrays of kernels hold
    /// two of them in place of a double.
    pub fn build_for(target: Target, rustc: &Rustc, generated: &Generated) -> Result<Self, CompileError> {
        let names: Vec<&str> = generated.ledger.functions.iter().map(|f| f.function.as_str()).collect();
        let library = Library::build(target, rustc, &generated.source, &wrapper::source(&names, &generated.source))?;
        let sizes = symbols::Sizes::of(&library.file);
        let shape = generated.model.shape();
        let single = generated.level.is_single();
        let per = if single { 2 } else { 1 };
        let functions = names.iter().map(|name| load(&library.native, &sizes, name, shape, per)).collect::<Result<_, _>>()?;
        Ok(Self { functions, shape, single, time: library.time, _library: library })
    }

    /// How long `rustc` takes to the object file, its start included, as long as a C compiler's
    /// `-c`.
    pub fn object_time(rustc: &Rustc, generated: &Generated) -> Result<Duration, CompileError> {
        let names: Vec<&str> = generated.ledger.functions.iter().map(|f| f.function.as_str()).collect();
        let folder = sources(&generated.source, &wrapper::source(&names, &generated.source))?;
        rustc.compile(&folder.path().join("lib.rs"), &folder.path().join("lib.o"), Makes::Object, Target::Own)
    }

    /// Calls a function by its name; arguments in the registry's order. Where numbers are `f32`
    /// these are rounded to them.
    pub fn call(&self, name: &str, arguments: &[&[f64]], out: &mut [f64]) -> Result<(), FunctionError> {
        let row = function::<f64>(name).ok_or(FunctionError::NotGenerated { function: "of this name" })?;
        let kernel = self.kernel(name).ok_or(FunctionError::NotGenerated { function: row.name })?;
        check_count(row.name, arguments.len(), row.takes.len())?;
        for (argument, given) in row.takes.iter().zip(arguments) {
            check_length(argument.name(), given.len(), argument.len(self.shape))?;
        }
        check_length("out", out.len(), row.len(self.shape))?;
        if self.single {
            let arguments: Vec<Vec<f64>> = arguments.iter().map(|x| packed(x)).collect();
            let mut pairs = vec![0.0; out.len().div_ceil(2)];
            kernel.call(&arguments.iter().map(Vec::as_slice).collect::<Vec<_>>(), &mut pairs);
            out.copy_from_slice(&unpacked(&pairs, out.len()));
        } else {
            kernel.call(arguments, out);
        }
        Ok(())
    }

    /// Bytes of machine code of a function with everything that belongs to it alone, if the library
    /// contains them. Sines and cosines of the mathematics library are not included.
    pub fn code_bytes(&self, name: &str) -> Option<u64> {
        self.functions.iter().find(|f| f.name == name)?.bytes
    }

    /// Numbers of coordinates, degrees of freedom and frames.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    pub(crate) fn kernel(&self, name: &str) -> Option<&Kernel> {
        self.functions.iter().find(|f| f.name == name).map(|f| &f.kernel)
    }
}

impl Library {
    /// A generated module and its wrapper.
    fn build(target: Target, rustc: &Rustc, module: &str, wrapper: &str) -> Result<Self, CompileError> {
        let folder = sources(module, wrapper)?;
        let file: PathBuf = folder.path().join(format!("{}generated{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
        let time = rustc.compile(&folder.path().join("lib.rs"), &file, Makes::Library, target)?;
        let native = Native::open(&file).map_err(CompileError::Load)?;
        Ok(Self { native, file, time, _folder: folder })
    }
}

/// A folder with a generated module, `robot.rs`, and its wrapper, `lib.rs`.
fn sources(module: &str, wrapper: &str) -> Result<Folder, CompileError> {
    let folder = Folder::new().map_err(CompileError::Folder)?;
    for (name, text) in [("robot.rs", module), ("lib.rs", wrapper)] {
        std::fs::write(folder.path().join(name), text).map_err(CompileError::Folder)?;
    }
    Ok(folder)
}

/// Single precision numbers, two in place of a double.
pub fn packed(numbers: &[f64]) -> Vec<f64> {
    let bits = |x: Option<&f64>| u64::from(x.map_or(0, |x| (*x as f32).to_bits()));
    let pair = |two: &[f64]| {
        let bytes = [bits(two.first()) as u32, bits(two.get(1)) as u32].map(u32::to_ne_bytes);
        f64::from_ne_bytes(std::array::from_fn(|k| bytes[k / 4][k % 4]))
    };
    numbers.chunks(2).map(pair).collect()
}

/// The inverse, for `count` numbers.
pub fn unpacked(pairs: &[f64], count: usize) -> Vec<f64> {
    let two = |pair: &f64| {
        let bytes = pair.to_ne_bytes();
        [0, 4].map(|at| f64::from(f32::from_ne_bytes(std::array::from_fn(|k| bytes[at + k]))))
    };
    pairs.iter().flat_map(two).take(count).collect()
}

/// With `per` numbers in place of a double.
fn load(native: &Native, sizes: &symbols::Sizes, name: &str, shape: Shape, per: usize) -> Result<Loaded, CompileError> {
    let missing = || CompileError::Load(format!("{name} is not in the library that was compiled"));
    let row = function::<f64>(name).ok_or_else(missing)?;
    let lengths: Vec<usize> = row.takes.iter().map(|a| a.len(shape).div_ceil(per)).collect();
    let kernel = native.kernel(&wrapper::symbol(name), &lengths, row.len(shape).div_ceil(per)).ok_or_else(missing)?;
    Ok(Loaded { name: name.to_owned(), kernel, bytes: sizes.function(name, &wrapper::symbol(name)) })
}

#[cfg(test)]
mod tests {
    use articulated_codegen::{Request, generate};

    use super::*;

    #[test]
    fn a_compiled_pendulum_needs_m_g_l_to_stand_still() {
        let robot = articulated_models::robot("simple_pendulum").unwrap();
        let mut request = Request::new("simple_pendulum.urdf", robot.urdf);
        request.options.functions = vec!["inverse_dynamics".into(), "placements".into()];
        let generated = generate(&request).unwrap();
        let compiled = Compiled::build(&Rustc::find().unwrap(), &generated).unwrap();
        let mut tau = [0.0];
        compiled.call("inverse_dynamics", &[&[std::f64::consts::FRAC_PI_2], &[0.0], &[0.0]], &mut tau).unwrap();
        assert!(tau[0].abs() > 1.0);
        assert!(compiled.call("inverse_dynamics", &[&[0.0], &[0.0]], &mut tau).is_err());
        assert!(compiled.call("inverse_dynamics", &[&[0.0], &[0.0], &[]], &mut tau).is_err());
        assert!(compiled.call("bias_forces", &[&[0.0], &[0.0]], &mut tau).is_err());
        assert!(compiled.code_bytes("inverse_dynamics").is_none_or(|n| (8..2000).contains(&n)));
    }
}
