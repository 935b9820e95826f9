#!/usr/bin/env bash
# Builds the wheel, installs it into a virtual environment of its own, and tests it there. Needs cargo and Python 3.10 or later.
#
# Pinocchio, JAX and pyarrow are installed if there are wheels for this system; without them the tests that need them are skipped, which the
# last lines say. PyTorch is installed only with ARTICULATED_TORCH=1: its wheels for Linux come with several GB for graphics processors.
# Where the system has a PyTorch (Debian: python3-torch), ARTICULATED_TORCH=/usr/bin/python3 tests with it.
# The notebooks run without Jupyter. With ARTICULATED_JUPYTER=1 they run in it too, and draw their plots.
set -euo pipefail
cd "$(dirname "$0")"

target=${CARGO_TARGET_DIR:-$PWD/target}
work=$target/python-check
torch=${ARTICULATED_TORCH:-}
pip="-m pip install --quiet --disable-pip-version-check"
rm -rf "$work"
python3 -m venv "$work/build"
python3 -m venv "$work/test"
"$work/build/bin/python" $pip maturin==1.16.0
# The versions of `requirements.txt`, for the tests.
"$work/test/bin/python" $pip -r requirements.txt
"$work/test/bin/python" $pip --only-binary :all: pin==4.1.0 || echo "not installed: Pinocchio, so that no values are compared with it"
"$work/test/bin/python" $pip --only-binary :all: jax==0.10.2 || echo "not installed: JAX, so that its derivatives are not tested"
"$work/test/bin/python" $pip --only-binary :all: pyarrow==26.0.1 || echo "not installed: pyarrow, so that its tables are not tested"
if [ "$torch" = 1 ]; then
    "$work/test/bin/python" $pip --only-binary :all: torch
elif [ -z "$torch" ]; then
    echo "not installed: PyTorch, several GB; ARTICULATED_TORCH=1 tests its derivatives, or ARTICULATED_TORCH=/usr/bin/python3 those of the system's"
fi
if [ "${ARTICULATED_JUPYTER:-}" = 1 ]; then
    "$work/test/bin/python" $pip --only-binary :all: nbclient==0.11.0 nbformat==5.11.1 ipykernel==7.4.0 matplotlib==3.11.2
else
    echo "not installed: Jupyter and matplotlib; ARTICULATED_JUPYTER=1 runs the notebooks in Jupyter too"
fi

CARGO_TARGET_DIR=$target "$work/build/bin/maturin" build --quiet --release --locked --out "$work/wheels"
"$work/test/bin/python" $pip --no-deps "$work"/wheels/*.whl

# From another folder, so that the installed package is found and not the sources.
python=$work/test/bin/python sources=$PWD
cd "$work"
"$python" "$sources/tests/stubs.py" --check
"$python" -m pytest --quiet -p no:cacheprovider -rs "$sources/tests"

# A wheel of one robot, where there is NumPy alone.
"$work/test/bin/articulated" wheel panda_like -o robot --functions inverse_dynamics,mass_matrix
python3 -m venv "$work/robot-test"
"$work/robot-test/bin/python" $pip -r <(grep '^numpy' "$sources/requirements.txt") robot/*.whl
"$work/robot-test/bin/python" -c "
import importlib.util, panda_like
assert importlib.util.find_spec('articulated') is None
print('a wheel of one robot:', panda_like.inverse_dynamics([0.1] * 7, [0.2] * 7, [0.3] * 7))"

if [ -n "$torch" ] && [ "$torch" != 1 ]; then
    "$torch" -m venv --system-site-packages "$work/torch"
    "$work/torch/bin/python" $pip pytest==9.2.0
    "$work/torch/bin/python" $pip --no-deps "$work"/wheels/*.whl
    "$work/torch/bin/python" -m pytest --quiet -p no:cacheprovider -rs "$sources/tests/test_torch.py" "$sources/tests/test_dlpack.py"
fi
