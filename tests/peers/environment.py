"""What the peers are built with: Python's packages, compilers, and the machine that -march=native means."""

import os
import platform
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
# Pinocchio's wheel (pin) brings its own and Boost's headers, but not Eigen's; CasADi's and MuJoCo's bring headers and libraries
PACKAGES = ["pin", "cmeel-eigen", "casadi", "mujoco", "numpy"]
CLANGS = [f"clang++-{n}" for n in range(30, 14, -1)]
NATIVE = ["-O3", "-march=native", "-DNDEBUG"]
FAST = [*NATIVE, "-ffast-math"]


def missing_packages():
    def absent(package):
        try:
            metadata.version(package)
        except metadata.PackageNotFoundError:
            return True

    return [package for package in PACKAGES if absent(package)]


def ensure_packages():
    """Runs this script again inside <repository>/.venv, made on the way, unless all packages are at hand."""
    missing = missing_packages()
    if not missing:
        return
    environment = REPOSITORY / ".venv"
    python = environment / "bin" / "python"
    if Path(sys.prefix) == environment:
        subprocess.check_call([python, "-m", "pip", "install", "--quiet", *missing])
    elif not python.exists():
        subprocess.check_call([sys.executable, "-m", "venv", environment])
    os.execv(python, [str(python), *sys.argv])


def install(*packages):
    """Debian's, as root."""
    subprocess.check_call(["apt-get", "install", "-y", "-qq", *packages])


def newest_clang():
    """Debian's name for the newest clang it has."""
    subprocess.check_call(["apt-get", "update", "-qq"])
    listed = subprocess.run(["apt-cache", "search", "--names-only", "^clang-[0-9]+$"], capture_output=True, text=True, check=True).stdout
    newest = max((int(n) for n in re.findall(r"^clang-(\d+)", listed, re.MULTILINE)), default=None)
    return f"clang-{newest}" if newest else "clang"


def compiler_version(compiler):
    text = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search(r"\d+\.\d+\.\d+", text).group()


def compilers():
    """(command, version, short name): g++, the system's clang++, the newest clang++."""
    newest = [command for command in CLANGS if shutil.which(command)][:1]
    seen = set()
    for command in ["g++", "clang++", *newest]:
        if not shutil.which(command):
            print(f"{command} is not on the PATH: left out")
            continue
        version = compiler_version(command)
        short = ("gcc" if command == "g++" else "clang") + version.split(".")[0]
        if short not in seen:
            yield command, version, short
        seen.add(short)


def c_compiler(command):
    """The compiler of C that belongs to one of C++."""
    return command.replace("clang++", "clang").replace("g++", "gcc")


def machine():
    """-march=native means this."""
    try:
        text = Path("/proc/cpuinfo").read_text()
        return "".join(re.findall(r"^(?:model name|flags).*", text, re.MULTILINE)[:2])
    except OSError:
        return platform.processor()
