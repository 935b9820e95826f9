//! Instruction sets: what a build has, what the processor has, and which functions profit.

use crate::Precision;
use crate::graph::Op;
use crate::lir::function::Function;
use crate::lir::{Body, Expr, Stmt};

/// Whether the processor has AVX2 and FMA.
pub(crate) const HAS_AVX2: &str = "::std::is_x86_feature_detected!(\"avx2\") && ::std::is_x86_feature_detected!(\"fma\")";

/// Stands before what is for x86-64 alone, and there for builds that may run without AVX2.
pub(crate) const NOT_COMPILED_FOR_AVX2: &str =
    "#[cfg(all(target_arch = \"x86_64\", not(all(target_feature = \"avx2\", target_feature = \"fma\"))))]";

/// Stands before what is for builds that run with AVX2 and FMA alone.
pub(crate) const COMPILED_FOR_AVX2: &str = "#[cfg(all(target_feature = \"avx2\", target_feature = \"fma\"))]";

/// What holds of builds that run with AVX-512 alone.
pub(crate) const COMPILED_FOR_AVX512: &str =
    "all(target_arch = \"x86_64\", target_feature = \"avx512dq\", target_feature = \"avx512vl\", target_feature = \"avx512vbmi2\")";

/// What holds of those of them on which a few vectors of eight among vectors of four cost nothing:
/// AMD's, which alone have SSE4a. Intel's do without one of their two ports for vectors of four
/// until some time after a vector of eight.
pub(crate) const COMPILED_FOR_AVX512_BESIDE_AVX2: &str = "all(target_arch = \"x86_64\", target_feature = \"avx512dq\", target_feature = \"avx512vl\", \
                                                         target_feature = \"avx512vbmi2\", target_feature = \"sse4a\")";

/// Stands before what is for builds that may run without AVX2, on whatever processor.
pub(crate) const MAY_LACK_AVX2: &str = "#[cfg(not(all(target_arch = \"x86_64\", target_feature = \"avx2\", target_feature = \"fma\")))]";

/// Stands before what is for processors other than x86-64 and 64-bit Arm.
pub(crate) const OTHERS: &str = "#[cfg(not(any(target_arch = \"aarch64\", target_arch = \"x86_64\")))]";

/// Whether the function profits from an instruction set that not every processor has.
pub(crate) fn needs_choice(function: &Function, level: Precision) -> bool {
    let fuses = |s: &Stmt| matches!(s, Stmt::Let(_, Expr::Op(Op::MulAdd | Op::MulSub | Op::NegMulAdd | Op::NegMulSub, _)));
    !function.in_lanes() && (function.body.pieces.iter().flatten().any(fuses) || has_batch(&function.body) || level.of_two())
}

/// Whether sines of several angles are computed together.
pub(crate) fn has_batch(body: &Body) -> bool {
    body.pieces.iter().flatten().any(|s| matches!(s, Stmt::SinCos { alone: false, .. }))
}
