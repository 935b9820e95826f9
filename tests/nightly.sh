#!/usr/bin/env bash
# The long checks, which tests/all.sh leaves out: lints of tests, every robot and level by compilers, and all files of the published packages.
# Takes hours, and some 2 GB of downloads. Needs what tests/all.sh needs.
#
#     tests/nightly.sh            everything
#     tests/nightly.sh lints      only the steps whose names contain a word
set -euo pipefail
cd "$(dirname "$0")/.."

only=${1:-}
failed=()

step() { # NAME COMMAND...
    local name=$1 start=$SECONDS
    shift
    [[ $name == *"$only"* ]] || return 0
    printf '\n== %s: %s\n' "$name" "$*"
    if "$@"; then
        printf '== ok, %d s\n' $((SECONDS - start))
    else
        failed+=("$name")
    fi
}

step lints cargo clippy --quiet --workspace --all-targets -- -D warnings
# Those in 96 digits take an hour without optimisation.
step trees env ARTICULATED_TREES=all cargo test -p articulated-core
step ignored-tests cargo test --release --workspace --exclude articulated-python -- --ignored
step urdf python3 tests/shipped/shipped.py
step mjcf python3 tests/mjcf/oracle.py
step mjcf-generated python3 tests/mjcf/oracle.py --generated
step mjcf-motion python3 tests/mjcf/simulate.py
step mjcf-steps python3 tests/mjcf/steps.py
step mjcf-contact python3 tests/mjcf/contact.py
step parry cargo run --release --manifest-path examples/parry/Cargo.toml
step mjcf-gradients python3 tests/mjcf/gradients.py
step mjcf-stages python3 tests/mjcf/stages.py
step sdf python3 tests/sdf/oracle.py
step xacro python3 tests/xacro/oracle.py
step mutants python3 tests/mutants/mutants.py
step sdist python/sdist.sh
step sql sql/check.sh

if [ ${#failed[@]} -gt 0 ]; then
    printf '\nfailed: %s\n' "${failed[*]}"
    exit 1
fi
printf '\nall long checks passed in %d s\n' $SECONDS
