#!/usr/bin/env python3
"""Tries the rows of docs/coming-from.md about MuJoCo, on a robot with a free base, a ball joint and hinges, in random states.

    python3 tests/mjcf/coming_from.py

Each row of the page's tables that compares functions has a check here, or a reason why it has none: the list at the end. Exit status: 0 if all
rows agree to 1e-11 of their largest number, and no row of the page is missing here, else 1. MuJoCo goes into target/mjcf/python.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import COMMAND, build_command, flat  # noqa: E402
from virtual_environment import python_of  # noqa: E402

REPOSITORY = HERE.parent.parent
PAGE = REPOSITORY / "docs" / "coming-from.md"
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
MODEL = """<mujoco model="walker"><option gravity="0.3 -0.2 -9.7"><flag contact="disable"/></option><worldbody>
<body name="trunk" pos="0 0 1"><freejoint/><geom type="box" size="0.2 0.1 0.05" pos="0.02 0 0.01"/>
<body name="arm" pos="0.1 0.1 0"><joint name="shoulder" type="ball"/><geom type="capsule" size="0.03 0.15" pos="0.05 0 -0.15"/>
<body name="hand" pos="0 0 -0.3"><joint name="wrist" type="hinge" axis="0 1 1"/><geom type="box" size="0.03 0.05 0.04" pos="0 0.02 -0.05"/></body></body>
<body name="leg" pos="-0.1 0 -0.05"><joint name="hip" type="hinge" axis="0 1 0"/><geom type="capsule" size="0.04 0.2" pos="0 0 -0.2"/>
<body name="foot" pos="0 0 -0.4"><joint name="slide" type="slide" axis="0 0 1"/><geom type="sphere" size="0.05"/></body></body></body></worldbody></mujoco>"""
# Rows without a check here, and why.
ELSEWHERE = {
    "sensor `accelerometer`": "a recipe, whose code runs with the documentation",
    "`qpos`, `qvel`": "tests/mjcf/speed.py translates its states by these functions",
    "`qfrc_actuator`": "tests/mjcf/oracle.py compares torques of actuators",
    "`qfrc_passive` (springs, dampers, fluid)": "tests/mjcf/simulate.py compares forces of effects",
    "`mjd_inverseFD` (finite differences)": "finite differences, not numbers of the same kind",
    "`mjd_transitionFD` (of a step)": "tests/mjcf/gradients.py compares steps with contacts",
    "`mjd_quatIntegrate`, `mjd_subQuat`": "derivatives of one quaternion; tests/tests/laws has them by differences",
    "`mj_step`": "tests/mjcf/steps.py, contact.py and simulate.py compare motions",
    "`mj_contactForce`": "tests/mjcf/contact.py compares points, normals and forces",
    "`mj_step2` after `data.contact`": "tests/mjcf/given.py gives MuJoCo's contacts",
}
STATES = 5
CLOSE = 1e-11


def ours(path, functions, states):
    """The numbers of functions in states, each a dict of arguments."""
    words = ["eval", str(path), "--function", ",".join(functions), "--states", "-", "--generic", "--format", "json"]
    done = subprocess.run([str(COMMAND), *words], input=json.dumps({"states": states}), capture_output=True, text=True, timeout=300)
    if done.returncode not in (0, 3):
        raise RuntimeError(done.stderr)
    return {one["function"]: [state["generic"] for state in one["states"]] for one in json.loads(done.stdout)["functions"]}


def main():
    import mujoco
    import numpy as np

    def numbers(value):
        """The numbers of nested objects and lists, one after the other."""
        return np.array(flat(value))

    model = mujoco.MjModel.from_xml_string(MODEL)
    nv, rng = model.nv, np.random.default_rng(1)
    free, ball = slice(0, 3), [k for k in range(model.njnt) if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_BALL]
    # MuJoCo's order of coordinates is ours; its quaternions are w x y z.
    quaternions = [model.jnt_qposadr[0] + 3, *(model.jnt_qposadr[k] for k in ball)]

    def to_ours(q):
        q = q.copy()
        for at in quaternions:
            q[at : at + 4] = np.roll(q[at : at + 4], -1)
        return q

    worst = {}

    def compare(row, found, expected):
        scale = max(1.0, np.abs(expected).max())
        worst[row] = max(worst.get(row, 0.0), np.abs(found - expected).max() / scale)

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "walker.xml")
        path.write_text(MODEL)
        for _ in range(STATES):
            data = mujoco.MjData(model)
            data.qpos[:] = rng.normal(size=model.nq)
            for at in quaternions:
                data.qpos[at : at + 4] /= np.linalg.norm(data.qpos[at : at + 4])
            u, tau_theirs, a_theirs, y = (rng.normal(size=nv) for _ in range(4))
            data.qvel[:], data.qfrc_applied[:] = u, tau_theirs
            mujoco.mj_forward(model, data)
            # T of the page: [ω; v] in axes of the base, of [v in world axes; ω].
            R = data.xmat[1].reshape(3, 3)
            T = np.eye(nv)
            T[:6, :6] = np.block([[np.zeros((3, 3)), np.eye(3)], [R.T, np.zeros((3, 3))]])
            q, v = to_ours(data.qpos), T @ u
            drift = np.zeros(nv)
            drift[3:6] = -np.cross(v[:3], v[3:6])
            tau = np.linalg.solve(T.T, tau_theirs)
            end = data.qpos.copy()
            mujoco.mj_integratePos(model, end, u, 0.3)
            still = u.copy()
            still[3:6] = 0
            straight = data.qpos.copy()
            mujoco.mj_integratePos(model, straight, still, 0.3)
            step = np.zeros(nv)
            mujoco.mj_differentiatePos(model, step, 1.0, data.qpos, end)
            state = {"q": list(q), "v": list(v), "tau": list(tau), "a": list(T @ a_theirs + drift)}
            functions = ["placements", "jacobians_world_aligned", "bias_accelerations_world_aligned", "mass_matrix", "mass_matrix_inverse", "forward_dynamics",
                         "inverse_dynamics", "accelerations_world_aligned", "center_of_mass", "center_of_mass_jacobian", "centroidal_momentum",
                         "centroidal_momentum_matrix"]
            found = {name: numbers(states[0]) for name, states in ours(path, functions, [state]).items()}
            bias = numbers(ours(path, ["inverse_dynamics"], [{**state, "a": list(drift)}])["inverse_dynamics"][0])
            moved = numbers(ours(path, ["integrate"], [{"q": list(q), "step": list(0.3 * v)}])["integrate"][0])
            along = numbers(ours(path, ["integrate"], [{"q": list(q), "step": list(0.3 * (T @ still))}])["integrate"][0])
            difference = numbers(ours(path, ["difference"], [{"q": list(q), "target": list(moved)}])["difference"][0])

            found |= {name: found[name].reshape(nv, nv) for name in ["mass_matrix", "mass_matrix_inverse"]}
            bodies = range(1, model.nbody)
            jac = np.array([np.vstack(_jac(mujoco, model, data, body)) for body in bodies])
            rate = np.array([np.vstack(_jac_dot(mujoco, model, data, body)) for body in bodies])
            J = found["jacobians_world_aligned"].reshape(-1, 6, nv)[-len(jac):]
            compare("`mj_kinematics`", found["placements"].reshape(-1, 12)[-len(jac):, 9:], data.xpos[1:])
            compare("`mj_jac` (world axes at a point; linear and angular apart)", J @ T, jac)
            compare("`mj_fullM`", T.T @ found["mass_matrix"] @ T, _mass(mujoco, model, data))
            solved = np.zeros((1, nv))
            mujoco.mj_solveM(model, data, solved, y.reshape(1, nv))
            compare("`mj_solveM`", np.linalg.solve(T, found["mass_matrix_inverse"] @ np.linalg.solve(T.T, y)), solved[0])
            compare("`mj_forward`", found["forward_dynamics"], T @ data.qacc + drift)
            compare("`qfrc_bias`", T.T @ bias, data.qfrc_bias)
            # J̇ u of theirs, and of ours at the same motion: J̇ v + J a, with a of the base at their
            # acceleration 0.
            compare("`mj_jacDot` times v", found["bias_accelerations_world_aligned"].reshape(-1, 6)[-len(jac):] + J @ drift, rate @ u)
            total = data.subtree_com[1]
            compare("`subtree_com`, `mj_jacSubtreeCom`", found["center_of_mass"], total)
            of_com = np.zeros((3, nv))
            mujoco.mj_jacSubtreeCom(model, data, of_com, 1)
            compare("`subtree_com`, `mj_jacSubtreeCom`", found["center_of_mass_jacobian"].reshape(3, nv) @ T, of_com)
            mujoco.mj_subtreeVel(model, data)
            momentum = np.concatenate([data.subtree_angmom[1], model.body_subtreemass[1] * data.subtree_linvel[1]])
            compare("`mj_subtreeVel`, `mj_angmomMat`", found["centroidal_momentum"], momentum)
            angular = np.zeros((3, nv))
            mujoco.mj_angmomMat(model, data, angular, 1)
            compare("`mj_subtreeVel`, `mj_angmomMat`", (found["centroidal_momentum_matrix"].reshape(6, nv) @ T)[:3], angular)
            # Orientations and joints are the same; the base's position where it does not turn.
            sign = [np.sign(to_ours(end)[at + 3] * moved[at + 3]) for at in quaternions]
            expected = to_ours(end)
            for at, s in zip(quaternions, sign):
                expected[at : at + 4] *= s
            row = "`mj_integratePos`, `mj_differentiatePos`"
            compare(row, moved[3:], expected[3:])
            compare(row, along[free], to_ours(straight)[free])
            compare(row, difference[:3], step[3:6])
            compare(row, difference[6:], step[6:])
            data.qacc[:] = a_theirs
            mujoco.mj_inverse(model, data)
            compare("`mj_inverse`", T.T @ found["inverse_dynamics"], data.qfrc_inverse)
            at_rest = np.zeros(6)
            mujoco.mj_rnePostConstraint(model, data)
            mujoco.mj_objectAcceleration(model, data, mujoco.mjtObj.mjOBJ_XBODY, model.nbody - 1, at_rest, 0)
            acceleration = found["accelerations_world_aligned"].reshape(-1, 6)[-1].copy()
            acceleration[3:] -= model.opt.gravity
            compare("`mj_objectAcceleration` (less gravity: at rest −g)", acceleration, at_rest)

    rows = re.findall(r"^\| (.+?) \|", PAGE.read_text(encoding="utf-8").partition("\n| MuJoCo | here |")[2].partition("###")[0], re.MULTILINE)
    named = lambda row: next((name for name in [*worst, *ELSEWHERE] if row.startswith(name)), None)
    missing = [row for row in rows if named(row) is None]
    for row in rows:
        name = named(row)
        print(f"{row:64} {worst[name]:.1e}" if name in worst else f"{row:64} {ELSEWHERE.get(name, 'MISSING')}")
    bad = [row for row, far in worst.items() if not far <= CLOSE]
    for row in bad:
        print(f"{row}: differs by {worst[row]:.1e}", file=sys.stderr)
    return 1 if bad or missing or not rows else 0


def _jac(mujoco, model, data, body):
    import numpy as np

    linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jacBody(model, data, linear, angular, body)
    return angular, linear


def _jac_dot(mujoco, model, data, body):
    import numpy as np

    linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jacDot(model, data, linear, angular, data.xpos[body], body)
    return angular, linear


def _mass(mujoco, model, data):
    import numpy as np

    full = np.zeros((model.nv, model.nv))
    try:
        mujoco.mj_fullM(model, full, data.qM)
    except (AttributeError, TypeError):
        mujoco.mj_fullM(model, data, full)
    return full


if __name__ == "__main__":
    python = python_of(TARGET / "mjcf" / "python", HERE / "requirements.txt")
    if Path(sys.prefix).resolve() != python.parent.parent.resolve():
        # MuJoCo is there.
        sys.exit(subprocess.run([python, __file__, *sys.argv[1:]]).returncode)
    build_command()
    sys.exit(main())
