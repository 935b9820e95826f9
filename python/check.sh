#!/usr/bin/env bash
# Builds the wheel, installs it into a virtual environment of its own, and tests it there. Needs cargo and Python 3.9 or later.
# Pinocchio is installed if there is a wheel for this system; without it the tests that compare with it are skipped.
set -euo pipefail
cd "$(dirname "$0")"

target=${CARGO_TARGET_DIR:-$PWD/target}
work=$target/python-check
rm -rf "$work"
python3 -m venv "$work/build"
python3 -m venv "$work/test"
"$work/build/bin/python" -m pip install --quiet --disable-pip-version-check maturin==1.16.0
# The versions of `requirements.txt`, for the tests.
"$work/test/bin/python" -m pip install --quiet --disable-pip-version-check -r requirements.txt
"$work/test/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: pin==4.1.0 \
    || echo "not installed: Pinocchio, so that no values are compared with it"

CARGO_TARGET_DIR=$target "$work/build/bin/maturin" build --quiet --release --locked --out "$work/wheels"
"$work/test/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps "$work"/wheels/*.whl

# From another folder, so that the installed package is found and not the sources.
python=$work/test/bin/python sources=$PWD
cd "$work"
"$python" "$sources/tests/stubs.py" --check
"$python" -m pytest --quiet -p no:cacheprovider -rs "$sources/tests"
