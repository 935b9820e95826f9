//! Instruction sets: those of a build, those of the processor, and functions that profit.

use crate::Precision;
use crate::graph::Op;
use crate::lir::function::Function;
use crate::lir::{Body, Expr, Stmt};

/// Whether the processor has AVX2 and FMA.
pub(crate) const HAS_AVX2: &str = "::std::is_x86_feature_detected!(\"avx2\") && ::std::is_x86_feature_detected!(\"fma\")";

/// Attribute of code for x86-64 only, in builds that may run without AVX2.
pub(crate) const NOT_COMPILED_FOR_AVX2: &str =
    "#[cfg(all(target_arch = \"x86_64\", not(all(target_feature = \"avx2\", target_feature = \"fma\"))))]";

/// Attribute of code for builds that require AVX2 and FMA.
pub(crate) const COMPILED_FOR_AVX2: &str = "#[cfg(all(target_feature = \"avx2\", target_feature = \"fma\"))]";

/// Condition of builds that require AVX-512.
pub(crate) const COMPILED_FOR_AVX512: &str =
    "all(target_arch = \"x86_64\", target_feature = \"avx512dq\", target_feature = \"avx512vl\", target_feature = \"avx512vbmi2\")";

/// Condition of those of them on which a few vectors of eight among vectors of four cost nothing:
/// AMD's, which alone have SSE4a. Intel's lose one of their two ports for vectors of four until
/// some time after a vector of eight.
pub(crate) const COMPILED_FOR_AVX512_BESIDE_AVX2: &str = "all(target_arch = \"x86_64\", target_feature = \"avx512dq\", target_feature = \"avx512vl\", \
                                                         target_feature = \"avx512vbmi2\", target_feature = \"sse4a\")";

/// Attribute of code for builds that may run without AVX2, on any processor.
pub(crate) const MAY_LACK_AVX2: &str = "#[cfg(not(all(target_arch = \"x86_64\", target_feature = \"avx2\", target_feature = \"fma\")))]";

/// Attribute of code for processors other than x86-64 and 64-bit Arm.
pub(crate) const OTHERS: &str = "#[cfg(not(any(target_arch = \"aarch64\", target_arch = \"x86_64\")))]";

/// Whether the function profits from an instruction set that not every processor has.
pub(crate) fn needs_choice(function: &Function, level: Precision) -> bool {
    let fuses = |s: &Stmt| matches!(s, Stmt::Let(_, Expr::Op(Op::MulAdd | Op::MulSub | Op::NegMulAdd | Op::NegMulSub, _)));
    !function.in_lanes() && (function.body.statements().into_iter().any(fuses) || has_batch(&function.body) || level.of_two())
}

/// Whether sines of several angles are computed together.
pub(crate) fn has_batch(body: &Body) -> bool {
    body.statements().into_iter().any(|s| matches!(s, Stmt::SinCos { alone: false, .. }))
}
