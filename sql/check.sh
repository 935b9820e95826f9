#!/usr/bin/env bash
# Formatting, lints, tests and the example of SQL over logs. The tests start a Ballista scheduler and two executors on the loopback
# interface. Compiles DataFusion and Ballista, once for lints and once for tests. Needs cargo.
set -euo pipefail
cd "$(dirname "$0")"
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target}

cargo fmt --all --check
# Always the whole workspace: with one crate alone DataFusion has other features, and is compiled once more.
cargo clippy --quiet --locked --workspace --all-targets -- -D warnings
cargo test --quiet --locked --workspace
"$CARGO_TARGET_DIR/debug/examples/residuals"
