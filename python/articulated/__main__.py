"""The command ``articulated``: that of Rust, and ``articulated wheel``.

``python -m articulated`` is the same.
"""

import argparse
import os
import signal
import sys
import warnings

from . import RobotWarning, _native, _wheel, bundled, bundled_names, load


def _numbers(text):
    try:
        x, y, z = (float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"found {text!r}, expected X,Y,Z") from None
    return x, y, z


def _list(text):
    return [word.strip() for word in text.split(",") if word.strip()]


def wheel(words):
    """``articulated wheel``: the exit status."""
    options = argparse.ArgumentParser(
        prog="articulated wheel",
        description="Writes a wheel of one robot: its functions as compiled C, with a loader that needs NumPy alone. Needs a C compiler here.",
    )
    options.add_argument("robot", help="the file of a robot, or the name of a bundled one")
    options.add_argument("-o", "--output", metavar="FOLDER", default="dist", help="where the wheel goes [default: dist]")
    options.add_argument("--functions", type=_list, default=list(_wheel.FUNCTIONS), help=f"names [default: {','.join(_wheel.FUNCTIONS)}]")
    options.add_argument("--floating", action="store_true", help="the root link has six degrees of freedom")
    options.add_argument("--gravity", type=_numbers, metavar="X,Y,Z", help="m/s² in the world frame; default: that of the file, or else 0,0,-9.81")
    options.add_argument("--frames", type=_list, help="the links whose frames functions give [default: all]")
    options.add_argument("--name", help="the name of the package and of its module [default: the robot's]")
    options.add_argument("--version", default="0.1.0", help="the version of the package [default: 0.1.0]")
    options.add_argument("--flag", action="append", default=[], help="another option of the compiler, as --flag=-march=native; may be repeated")
    options.add_argument("--batch", action="store_true", help="also code for many states at once; the compiler takes longer")
    given = options.parse_args(words)
    is_bundled = given.robot in bundled_names() and not os.path.exists(given.robot)
    base = "floating" if given.floating else None if is_bundled else "fixed"
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", RobotWarning)
        try:
            robot = (bundled if is_bundled else load)(given.robot, base=base, gravity=given.gravity, frames=given.frames)
            path = robot.wheel(given.output, given.functions, name=given.name, version=given.version, flags=given.flag, batch=given.batch)
        except (ValueError, TypeError, RuntimeError, OSError) as error:
            print("\n".join(f"error: {line}" for line in str(error).splitlines()), file=sys.stderr)
            return 3 if isinstance(error, RuntimeError) else 1
        finally:
            for warning in found:
                print(f"warning: {warning.message}", file=sys.stderr)
    print(path)
    return 0


def main():
    """Runs the command with the words of the command line."""
    if sys.argv[1:2] == ["wheel"]:
        return wheel(sys.argv[2:])
    # Ctrl-C ends Rust's command at once, as it does without Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    status = _native.command(["articulated", *sys.argv[1:]])
    if status == 0 and sys.argv[1:] in ([], ["help"], ["--help"], ["-h"]):
        print("  articulated wheel ROBOT  writes a wheel of one robot (articulated wheel --help)")
    return status


if __name__ == "__main__":
    sys.exit(main())
