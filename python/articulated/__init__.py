"""Dynamics of any robot, one state or many at once, on NumPy arrays.

>>> import articulated
>>> robot = articulated.bundled("panda_like")
>>> robot.mass_matrix(robot.neutral).shape
(7, 7)
>>> robot.inverse_dynamics(robot.random_configuration(0, 100), [0.0] * 7, [0.0] * 7, threads=0).shape
(100, 7)
"""

from ._compiled import CompiledRobot
from ._derivative import Derivative
from ._errors import RobotError, RobotWarning
from ._found import FoundRobot, robots
from ._player import Player
from ._robot import Actuator, Function, Joint, Robot, bundled, bundled_names, functions, load, loads
from ._rollout import ActuatedRollout, ActuatedRolloutGradient, ConstrainedStep, ContactForces, MujocoState, Rollout, RolloutGradient, State
from ._scene import Motion, Scene, bundled_scene_names

__all__ = [
    "ActuatedRollout",
    "ActuatedRolloutGradient",
    "Actuator",
    "CompiledRobot",
    "ConstrainedStep",
    "ContactForces",
    "Derivative",
    "FoundRobot",
    "Function",
    "Joint",
    "Motion",
    "MujocoState",
    "Player",
    "Robot",
    "RobotError",
    "RobotWarning",
    "Rollout",
    "RolloutGradient",
    "Scene",
    "State",
    "bundled",
    "bundled_names",
    "bundled_scene_names",
    "functions",
    "load",
    "loads",
    "robots",
]
__version__ = "0.1.0"
_RESULTS = Rollout, RolloutGradient, ActuatedRollout, ActuatedRolloutGradient, ConstrainedStep, ContactForces
for _class in (RobotError, RobotWarning, Robot, CompiledRobot, Derivative, Actuator, Joint, Function, *_RESULTS, Scene, Motion, FoundRobot, Player):
    _class.__module__ = __name__
