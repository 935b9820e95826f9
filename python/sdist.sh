#!/usr/bin/env bash
# Builds the source distribution, a wheel from it outside of the repository, and runs a function of that wheel. Takes several minutes.
#
#     python/sdist.sh [FOLDER]    keeps both in FOLDER
#
# Needs cargo, Python 3.10 or later, and packages of PyPI.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=$(mkdir -p "${1:-$work/out}" && cd "${1:-$work/out}" && pwd)
cd "$(dirname "$0")"

python3 -m venv "$work/venv"
python=$work/venv/bin/python
"$python" -m pip install --quiet --disable-pip-version-check maturin==1.16.0
"$work/venv/bin/maturin" sdist --out "$out" >/dev/null
"$python" -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$out" "$out"/articulated-*.tar.gz
"$python" -m pip install --quiet --disable-pip-version-check "$out"/articulated-*.whl
# From another folder, so that the installed package is found and not the sources.
cd "$work"
"$python" -c "
import articulated
robot = articulated.bundled('panda_like')
zero = [0.0] * robot.nv
torques = robot.inverse_dynamics(robot.neutral, zero, zero)
assert abs(torques - robot.gravity_torque(robot.neutral)).max() < 1e-12
print('a wheel of the source distribution:', torques)"
