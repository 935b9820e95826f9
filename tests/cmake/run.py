#!/usr/bin/env python3
"""Installs the package of CMake, and checks laws of robots in a project that uses it with Eigen.

    python3 tests/cmake/run.py             # all checks
    python3 tests/cmake/run.py --install   # first install Debian's missing packages, as root

Builds with CMake, and with pkg-config and a compiler alone. A changed robot's file generates its
header again, and nothing else does. Mistakes are reported when the project is configured or built,
arrays of a wrong length when it is compiled. The package works from the source folder too. Prints
"not run: ..." and ends with status 0 where CMake, Eigen, pkg-config or a compiler for C++ is
missing.
"""

import argparse
import ctypes
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import build_command  # noqa: E402

REPOSITORY = HERE.parent.parent
PROJECT = HERE / "project"
ARM = REPOSITORY / "tests" / "robots" / "arm.urdf"
DEBIAN = ["cmake", "make", "g++", "pkg-config", "libeigen3-dev"]
VERSION = re.search(r'^version = "(.*)"$', (REPOSITORY / "Cargo.toml").read_text(), re.MULTILINE).group(1)
STRICT = ["-std=c++14", "-Wall", "-Wextra", "-Werror"]

# What a mistake in the project reports, on one line.
MISTAKES = {
    "function": ["inverse_dynamic' for '--functions", "did you mean inverse_dynamics?"],
    "file": ["articulated_generate: FILE: there is no file", "project/robots/lost.urdf"],
    "keyword": ['articulated_generate: unknown argument "ROBOT", expected TARGET, FILE'],
    "prefix": ['names in C would begin with "my-arm"', "give PREFIX"],
    "option": ["found --prefix in OPTIONS, expected PREFIX"],
    "nothing": ["expected FUNCTIONS with a value"],
    "version": ['compatible with requested version "99.1"'],
    "component": ['found the component "armadillo", expected eigen'],
}
# What the compiler reports of a line of this program.
TO_REFUSE = """#include <articulated/eigen.hpp>
namespace view = articulated::eigen;
int main() {
    view::Vector<3> q;
    Eigen::Matrix3d columns;
    const view::Matrix<3, 3> fixed;
    view::Matrix<4, 4> big;
    (void)q, (void)columns, (void)fixed, (void)big;
    (void)LINE;
}
"""
REFUSED = {
    "view::in<4>(q)": "the array has another length",
    "view::in<3>(q + q)": "are not one after the other",
    "view::out<9>(columns)": "goes column by column",
    "view::out<9>(fixed)": "cannot write a constant array",
    "view::position(q)": "the array has rows of another length",
    "view::in<4>(big.topLeftCorner<2, 2>())": "the rows of this matrix are not one after the other",
}


def missing():
    """Debian's packages that are not here."""
    found = {name: shutil.which(program) for name, program in [("cmake", "cmake"), ("make", "make"), ("g++", "g++"), ("pkg-config", "pkg-config")]}
    if found["pkg-config"]:
        found["libeigen3-dev"] = subprocess.run(["pkg-config", "--exists", "eigen3"]).returncode == 0
    return [name for name in DEBIAN if not found.get(name)]


def install(packages):
    """Debian's packages, where this is Debian and its administrator."""
    if not shutil.which("apt-get") or os.geteuid() != 0:
        return
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": os.environ | {"DEBIAN_FRONTEND": "noninteractive"}}
    words = ["apt-get", "-o", "DPkg::Lock::Timeout=600", "install", "-y", "--no-install-recommends", *packages]
    if subprocess.run(words, **quiet).returncode != 0:
        subprocess.run(["apt-get", "-o", "DPkg::Lock::Timeout=600", "update"], **quiet)
        subprocess.run(words, **quiet)


def run(*words, **more):
    """What a program prints. It must succeed."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    assert done.returncode == 0, f"{' '.join(map(str, words))}\n{done.stdout}"
    return done.stdout


def fails(*words, **more):
    """What a program prints, on one line. It must fail."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    assert done.returncode != 0, f"expected a failure of {' '.join(map(str, words))}\n{done.stdout}"
    return " ".join(done.stdout.split())


def configure(build, prefix, robot, *words):
    """The words that configure the project, with the version of the package unless others say so.
    """
    return ["cmake", "-S", PROJECT, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", f"-DROBOT={robot}", f"-DVERSION={VERSION}", *words]


def check_package(prefix):
    """What was installed has no path of this machine but that of the command."""
    files = sorted(str(path.relative_to(prefix)) for path in prefix.rglob("*") if path.is_file())
    expected = ["include/articulated/eigen.hpp", "share/articulated/cmake/articulatedConfig.cmake",
                "share/articulated/cmake/articulatedConfigVersion.cmake", "share/pkgconfig/articulated.pc"]
    assert files == expected, files
    for path in files:
        assert str(prefix) not in (prefix / path).read_text(), path
    assert f"Version: {VERSION}\n" in (prefix / expected[3]).read_text()


def check_external(build):
    """The shared library has the function that CasADi loads, of three arguments."""
    [path] = [path for path in build.glob("libexternal.*") if path.suffix in (".so", ".dylib")]
    assert ctypes.CDLL(str(path)).inverse_dynamics_n_in() == 3


def check_again(build, robot, extra):
    """A build without changes generates nothing, one with a changed robot its header alone."""
    arm, legs = (build / "articulated" / name for name in ("arm/arm.h", "quadruped/legs.h"))
    before = [(path.stat().st_mtime_ns, path.read_text()) for path in (arm, legs)]
    run("cmake", "--build", build)
    assert [(path.stat().st_mtime_ns, path.read_text()) for path in (arm, legs)] == before, "a build without changes generates"
    robot.write_text(robot.read_text().replace('<mass value="1.5"/>', '<mass value="1.25"/>'))
    run("cmake", "--build", build)
    assert arm.stat().st_mtime_ns > before[0][0] and arm.read_text() != before[0][1], "a changed robot does not generate"
    assert (legs.stat().st_mtime_ns, legs.read_text()) == before[1], "a changed robot generates another one"
    extra.touch()
    run("cmake", "--build", build)
    assert legs.stat().st_mtime_ns > before[1][0], "a changed file of DEPENDS does not generate"
    # The laws hold of the changed robot too.
    assert run(build / "fixed").strip() == "fixed: ok"


def check_mistakes(folder, prefix):
    """Mistakes are named, and so is a command that is not there."""
    for mistake, parts in MISTAKES.items():
        build = folder / f"wrong_{mistake}"
        words = configure(build, prefix, ARM, f"-DWRONG={mistake}", *["-DVERSION=99.1"] * (mistake == "version"))
        if mistake == "function":
            run(*words)
            words = ["cmake", "--build", build]
        said = fails(*words)
        assert all(part in said for part in parts), f"{mistake}: {said}"
    said = fails(*configure(folder / "lost", prefix, ARM, f"-DARTICULATED_COMMAND={folder / 'nowhere'}"))
    assert "the command `articulated` was not found" in said and "cargo install --path cli" in said, said
    print(f"{len(MISTAKES) + 1} mistakes in projects are reported")


def check_pkg_config(folder, prefix, command):
    """A program by pkg-config and a compiler alone."""
    environment = os.environ | {"PKG_CONFIG_PATH": str(prefix / "share" / "pkgconfig")}
    asked = lambda *words: run("pkg-config", *words, "articulated", env=environment).split()  # noqa: E731
    assert asked("--variable=command") == [str(command)]
    assert Path(*asked("--variable=includedir")).resolve() == (prefix / "include").resolve()
    run(*asked("--variable=command"), "generate", ARM, "--functions", "inverse_dynamics,mass_matrix,placements,forward_dynamics", "--language", "c",
        "-o", folder / "arm.h")
    # Warnings are those of the program and of the views, not Eigen's.
    flags = [flag.replace("-I", "-isystem") if "eigen3" in flag else flag for flag in asked("--cflags")]
    run("g++", *STRICT, "-Wpedantic", "-Wconversion", *flags, f"-I{folder}", PROJECT / "arm.cpp", "-o", folder / "arm", *asked("--libs"))
    assert run(folder / "arm").strip() == "fixed: ok"
    print("by pkg-config: ok")
    return flags


def check_refused(folder, flags):
    """Arrays that do not fit are errors of the compiler."""
    program = folder / "refused.cpp"
    for line, part in [("view::in<3>(q)", None), *REFUSED.items()]:
        program.write_text(TO_REFUSE.replace("LINE", line))
        words = ["g++", "-std=c++14", "-fsyntax-only", *flags, program]
        if part is None:
            run(*words)
        else:
            said = fails(*words)
            assert part in said, f"{line}: {said}"
    print(f"{len(REFUSED)} arrays are refused by the compiler")


def check_page(folder):
    """The project of docs/embedded.md, with the package in its source folder, not installed."""
    page = (REPOSITORY / "docs" / "embedded.md").read_text(encoding="utf-8")
    [lists], [program] = (re.findall(rf"```{kind}\n(.*?)```", page, re.DOTALL) for kind in ("cmake", "cpp"))
    (folder / "robots").mkdir(parents=True)
    shutil.copy(ARM, folder / "robots")
    (folder / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.16)\nproject(page LANGUAGES CXX)\n{lists}")
    (folder / "controller.cpp").write_text(program)
    run("cmake", "-S", folder, "-B", folder / "build", f"-Darticulated_DIR={REPOSITORY / 'cmake'}")
    run("cmake", "--build", folder / "build")
    # The mass matrix of three rods, and where the tool is with its elbow at 0.5 rad.
    *mass, place = run(folder / "build" / "controller").split("\n\n")
    assert len(mass[0].splitlines()) == 3, mass
    expected = [0.35 * math.sin(0.5), 0.0, 0.7 + 0.35 * math.cos(0.5)]
    assert all(abs(float(x) - y) < 1e-5 for x, y in zip(place.split(), expected)), place
    print("the project of docs/embedded.md: ok")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--install", action="store_true", help="install Debian's packages where they are missing and this is its administrator")
    options = parser.parse_args()
    if options.install and missing():
        install(missing())
    if missing():
        print(f"not run: the package of CMake, which needs {', '.join(missing())} (packages of Debian)")
        return
    command = Path(build_command()).resolve()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        prefix, robot, build = folder / "prefix", folder / "robots" / "arm.urdf", folder / "build"
        robot.parent.mkdir()
        shutil.copy(ARM, robot)
        os.environ["ARTICULATED_COMMAND"] = str(command)
        run("cmake", "-S", REPOSITORY / "cmake", "-B", folder / "package", f"-DCMAKE_INSTALL_PREFIX={prefix}")
        run("cmake", "--install", folder / "package")
        # The prefix may be moved.
        prefix = prefix.rename(folder / "moved")
        check_package(prefix)
        extra = folder / "extra.txt"
        extra.touch()
        run(*configure(build, prefix, robot, f"-DEXTRA={extra}"))
        run("cmake", "--build", build)
        for program in ("fixed", "floating"):
            assert run(build / program).strip() == f"{program}: ok"
            print(f"by CMake, {program} base: ok")
        check_external(build)
        check_again(build, robot, extra)
        print("a changed robot is generated again, and alone")
        check_mistakes(folder, prefix)
        check_refused(folder, check_pkg_config(folder, prefix, command))
        check_page(folder / "page")
        print("1 passed, 0 failed")


if __name__ == "__main__":
    main()
