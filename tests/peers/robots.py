"""The robots of the tables: bundled ones, and real ones of a package that tests/shipped pins, unpacked when somebody asks for them."""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

from environment import REPOSITORY

PACKAGE = "example-robot-data"
PLACE = REPOSITORY / "target" / "peers" / "robots"


@dataclass(frozen=True)
class Robot:
    name: str
    title: str
    floating: bool
    file: str = ""  # in the package; of a bundled robot, none

    @property
    def base(self):
        return "floating" if self.floating else "fixed"

    @property
    def urdf(self):
        """The file's path. Joints of a real robot that follow others are free in it, since peers know no others."""
        if not self.file:
            return REPOSITORY / "models" / "urdf" / f"{self.name}.urdf"
        path = PLACE / f"{self.name}.urdf"
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(re.sub(r"<mimic\b[^>]*/>", "", packed(self.file).read_text()))
        return path


def packed(file):
    """A file of the pinned package."""
    sys.path.insert(0, str(REPOSITORY / "tests" / "shipped"))
    import shipped

    (pinned,) = shipped.packages(False, PACKAGE)
    (found,) = [path for path in shipped.unpack(pinned) if str(path).endswith(f"/robots/{file}")]
    return found


def package():
    """name==version of the package of real robots."""
    lines = (REPOSITORY / "tests" / "shipped" / "packages.txt").read_text().splitlines()
    return next(line.partition("#")[0].strip() for line in lines if line.startswith(f"{PACKAGE}=="))


ALL = {robot.name: robot for robot in [
    Robot("ur5_like", "`ur5_like`, 6 joints", False),
    Robot("panda_like", "`panda_like`, 7 joints", False),
    Robot("quadruped", "`quadruped`, floating, 12 joints", True),
    Robot("humanoid", "`humanoid`, floating, 30 joints", True),
    Robot("ur5", "UR5, 6 joints", False, "ur_description/urdf/ur5_robot.urdf"),
    Robot("panda", "Panda with fingers, 9 joints", False, "panda_description/urdf/panda.urdf"),
    Robot("solo12", "Solo 12, floating, 12 joints", True, "solo_description/robots/solo12.urdf"),
    Robot("hyq", "HyQ, floating, 12 joints", True, "hyq_description/robots/hyq_no_sensors.urdf"),
    Robot("g1", "G1, floating, 29 joints", True, "g1_description/urdf/g1_29dof_rev_1_0.urdf"),
    Robot("talos", "Talos, floating, 32 joints", True, "talos_data/robots/talos_reduced.urdf"),
]}
BUNDLED = [name for name, robot in ALL.items() if not robot.file]
REAL = [name for name, robot in ALL.items() if robot.file]
