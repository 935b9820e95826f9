//! The instruction sets of batches.

use articulated_core::lanes::Set;

use crate::language::rust::instructions::HAS_AVX2;

/// An instruction set as batches use it.
pub(super) struct Variant {
    pub(super) module: &'static str,
    pub(super) set: Set,
    /// Bytes of a vector.
    pub(super) bytes: usize,
    /// Where it is compiled.
    pub(super) cfg: &'static str,
    /// The condition on the processor; `true` if every processor that it is compiled for meets it.
    pub(super) asked: &'static str,
}

macro_rules! avx512 {
    () => {
        "all(target_feature = \"avx512f\", target_feature = \"avx512dq\", target_feature = \"avx2\", target_feature = \"fma\")"
    };
}

macro_rules! avx2 {
    () => {
        "all(target_feature = \"avx2\", target_feature = \"fma\")"
    };
}

/// The widest first.
pub(super) const WAYS: [Variant; 5] = [
    Variant {
        module: "avx512",
        set: Set::Avx512,
        bytes: 64,
        cfg: "target_arch = \"x86_64\"",
        asked: "::std::is_x86_feature_detected!(\"avx512f\") && ::std::is_x86_feature_detected!(\"avx512dq\") && ::std::is_x86_feature_detected!(\"avx2\") && ::std::is_x86_feature_detected!(\"fma\")",
    },
    Variant {
        module: "avx2",
        set: Set::Avx2,
        bytes: 32,
        cfg: concat!("all(target_arch = \"x86_64\", not(", avx512!(), "))"),
        asked: HAS_AVX2,
    },
    Variant { module: "sse2", set: Set::Sse2, bytes: 16, cfg: concat!("all(target_arch = \"x86_64\", not(", avx2!(), "))"), asked: "true" },
    Variant { module: "neon", set: Set::Neon, bytes: 16, cfg: "target_arch = \"aarch64\"", asked: "true" },
    Variant {
        module: "portable",
        set: Set::Portable,
        bytes: 64,
        cfg: "not(any(target_arch = \"x86_64\", target_arch = \"aarch64\"))",
        asked: "true",
    },
];

/// Without `unsafe`.
pub(super) const SAFE: [Variant; 1] = [Variant { module: "portable", set: Set::Portable, bytes: 64, cfg: "all()", asked: "true" }];
