#!/usr/bin/env bash
# Core's tests, and generated code against the generic library, on a 64-bit Arm that is emulated: NEON instead of AVX2. Needs qemu-aarch64-static or
# qemu-aarch64 (Debian: qemu-user-static); what it needs of the compiler it installs.
set -euo pipefail
cd "$(dirname "$0")/.."

emulator=$(command -v qemu-aarch64-static || command -v qemu-aarch64) || { echo "no qemu-aarch64-static and no qemu-aarch64" >&2; exit 1; }
target=aarch64-unknown-linux-musl
[ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || rustup target add "$target"

CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_RUNNER="$emulator" \
    cargo test --quiet -p articulated-core --target "$target"
ARTICULATED_ARM_EMULATOR="$emulator" cargo test --quiet -p articulated-tests --test generated -- so_does_code_for_any_machine batches
