#!/usr/bin/env bash
# Everything that has to hold before a change lands: formatting, lints, tests, documentation, fixtures made anew by the oracles, and the
# README's main command. Needs git, a Rust toolchain and Python 3; whatever else it needs it installs into .venv and target.
# What takes longer is in tests/nightly.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

# Everything in the workspace but the Python package, which has tests of its own.
rust=(--workspace --exclude articulated-python)
target=${CARGO_TARGET_DIR:-$PWD/target}

step() {
    local start=$SECONDS
    printf '\n== %s\n' "$*"
    "$@"
    printf '== ok, %d s\n' $((SECONDS - start))
}

# Runs a function beside the steps that follow, until `rejoin`, which prints what it printed.
beside() {
    log=$(mktemp)
    trap 'kill "$other" 2>/dev/null || true; cat "$log"; rm -f "$log"' EXIT
    "$@" >"$log" 2>&1 &
    other=$!
}

rejoin() {
    local status=0
    wait "$other" || status=$?
    trap - EXIT
    cat "$log"
    rm -f "$log"
    return $status
}

ensure() { # a component of the toolchain that a minimal installation may lack
    cargo "$1" --version >/dev/null 2>&1 || rustup component add "$2"
}

alone() { # core without std, and without allocation; the reader without a second one; the command without what measures
    cargo check --quiet -p articulated-core --no-default-features
    cargo check --quiet -p articulated-core --no-default-features --features alloc
    cargo clippy --quiet -p articulated-formats -- -D warnings
    cargo clippy --quiet -p articulated-cli --no-default-features -- -D warnings
}

documentation() {
    RUSTDOCFLAGS="-D warnings" cargo doc --quiet "${rust[@]}" --no-deps
}

# The command and the wheel are built in one profile and one folder, with the features of both, so
# that each crate is compiled once. The command and the lab are compiled twice: the wheel has them
# without the feature `measure`.
release() {
    cargo build --quiet --release -p articulated-cli -p articulated-python --bins
}

readme_command() { # `cargo run --release -p articulated-cli -- compare panda_like`, which is compiled already
    "$ARTICULATED_COMMAND" compare panda_like --repetitions 31
}

arm() { # where there is an emulator, which only an administrator can install, and rustup for the compiler's target
    if command -v rustup >/dev/null && { command -v qemu-aarch64-static || command -v qemu-aarch64; } >/dev/null; then
        tests/arm.sh
    else
        echo "not run: 64-bit Arm, which needs rustup and qemu-aarch64-static (Debian: qemu-user-static)"
    fi
}

browser() { # where there is Chromium, which only an administrator can install
    python3 tests/browser/pages.py --install
    python3 tests/browser/book.py --install
}

python_package() {
    CARGO_TARGET_DIR=$target python/check.sh
}

ensure fmt rustfmt
ensure clippy clippy

# These are mostly programs of one thread, which wait for downloads and for other programs.
oracles() {
    step documentation
    step python3 models/urdf/generate.py --check
    step python3 tests/peers/tables.py --check
    step python3 tests/peers/chart.py --check
    step python3 docs/book/figures.py --check
    step python3 tests/verdicts.py --check
    step python3 tests/oracles/make.py --check
    step python3 tests/oracles/external.py
    step python3 tests/embedded/measure.py
    step python3 tests/cmake/run.py --install
    step python3 tests/ipopt/run.py
    step python3 tests/mjcf/oracle.py --sample
    step python3 tests/mjcf/coming_from.py
    step python3 tests/mjcf/steps.py --file tests/mjcf/models/{steps,actuated,surroundings,fluid,drone,spatial}.xml
    step python3 tests/mjcf/speed.py --check
    step python3 tests/mjcf/contact.py --check
    step python3 tests/mjcf/pairs.py --check
    step python3 tests/mjcf/standing.py
    step python3 tests/mjcf/given.py
    step python3 tests/sdf/oracle.py --sample
    step python3 tests/xacro/oracle.py --sample
}

step cargo fmt --all --check
step cargo clippy --quiet "${rust[@]}" -- -D warnings
step alone
step cargo test "${rust[@]}"
step arm
step release
# What scripts run is there now: the command, and the examples, which `cargo test` compiles.
export ARTICULATED_COMMAND=$target/release/articulated ARTICULATED_EXAMPLES=$target/debug/examples
beside oracles
step python3 tests/shipped/shipped.py --sample
step python_package
step browser
rejoin
# It installs packages where the oracles do.
step python3 tests/browser/site.py --install
step python3 tests/command_lines.py
step readme_command
printf '\nall checks passed in %d s\n' $SECONDS
