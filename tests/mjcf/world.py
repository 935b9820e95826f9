"""Compares what a file says beside its robot: gravity, step, states, actuators, springs of tendons, equations, planes.

The laws are evaluated here from the numbers that the reader returns, not by the library.

What the reader does not read is taken out of MuJoCo's model for the comparison of forces. Each thing needs a warning of the
reader that names it; one without is a difference. OUTSIDE lists what no comparison is about.
"""

import copy
import re

import mujoco
import numpy as np

BALL, SLIDE, HINGE = 1, 2, 3
ACTING = {int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT), int(mujoco.mjtTrn.mjTRN_TENDON)}
# The dynamics of actuators that are read, and their words.
STATES = {
    mujoco.mjtDyn.mjDYN_NONE: None,
    mujoco.mjtDyn.mjDYN_INTEGRATOR: "integrator",
    mujoco.mjtDyn.mjDYN_FILTER: "filter",
    mujoco.mjtDyn.mjDYN_FILTEREXACT: "filterexact",
}
# As documented in docs/mjcf.md.
OUTSIDE = [
    "forces of contacts, and what adheres by them",
    "forces of the solver: limits, dry friction and equations act by their numbers, which are compared",
    "armature in the mass matrix: compared by itself",
    "states of springs (plastic), and bodies that a program moves (mocap)",
]
# More warnings are counted, not listed.
MOST_WARNINGS = 1000


def disabled(model, *flags):
    """Whether one of the flags of <option> is off."""
    return any(model.opt.disableflags & int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}")) for flag in flags)


class Warned:
    """The warnings of the reader, and what has none."""

    def __init__(self, robot):
        self.warnings, self.silent = robot["warnings"], []

    def demand(self, thing, name, *phrases):
        """Takes note of a thing of MuJoCo's model unless a warning has one of the phrases and the thing's name.

        Copies and attached models have a prefix and a suffix, which the warning about their tag does not have.
        """
        name = name or ""
        for text in self.warnings:
            quoted = re.findall(r'"([^"]*)"', text)
            if any(phrase in text for phrase in phrases) and (not name or not quoted or any(own and own in name for own in quoted)):
                return
        if len(self.warnings) < MOST_WARNINGS:
            self.silent.append(f"{thing} {name}".strip())


def compare(model, states, robot, differ, count):
    """What is in MuJoCo's model, is not read, and has no warning.

    `states`: of MuJoCo. `differ(kind, found, expected, scale)` takes differences, `count(kind, number)` numbers of things.
    """
    warned = Warned(robot)
    world = robot["world"]
    joints = [Joint(model, index, name) for index, (name, *_) in enumerate(robot["order"])]
    by_name = {joint.name: joint for joint in joints}
    settings(model, world, differ)
    keyframes(model, world, joints, differ, count)
    planes(model, world, differ, count)
    read = actuators(model, world, differ, count)
    if model.nv == 0:
        return warned.silent
    own = copy.deepcopy(model)
    reduce(own, read, warned)
    data = mujoco.MjData(own)
    for seed, (q, v, *_) in enumerate(states):
        data.qpos[:], data.qvel[:] = q, v
        forces(own, data, robot, read, by_name, np.random.default_rng(seed), differ)
    added = {one["on"]: one["numbers"][0] for one in world["effects"] if one["effect"] == "added_mass"}
    for joint in joints:
        if joint.kind == 0:
            body = model.jnt_bodyid[joint.index]
            found = added.get(name_of(model, "BODY", body) or f"body_{body}", 0.0)
            differ("armature of a free joint", found, model.dof_armature[joint.v : joint.v + 6], 1.0)
    count("effects on links", len(world["effects"]))
    equations(model, world, joints, states[0][0], differ, count)
    constraints(model, warned)
    ranges = {joint.name: model.jnt_actfrcrange[joint.index] for joint in joints if model.jnt_actfrclimited[joint.index] and joint.is_scalar}
    differ("joint forces", sorted(ranges) != sorted(name for name, _ in world["joint_forces"]), 0, 1.0)
    for name, bounds in world["joint_forces"]:
        differ("joint forces", bounds, ranges.get(name, np.nan))
    return warned.silent


class Joint:
    def __init__(self, model, index, name):
        self.index, self.name, self.kind = index, name, int(model.jnt_type[index])
        self.q, self.v = model.jnt_qposadr[index], model.jnt_dofadr[index]
        self.is_scalar = self.kind in (SLIDE, HINGE)

    def coordinates(self, q):
        """As descriptions have them: quaternions (x, y, z, w)."""
        if self.is_scalar:
            return q[self.q : self.q + 1]
        at = self.q if self.kind == BALL else self.q + 3
        quaternion = q[at : at + 4] / np.linalg.norm(q[at : at + 4])
        return np.concatenate([q[self.q : at], quaternion[1:], quaternion[:1]])

    def rates(self, q, v):
        """As descriptions have them: of a free joint the twist in axes of the body."""
        if self.is_scalar:
            return v[self.v : self.v + 1]
        if self.kind == BALL:
            return v[self.v : self.v + 3]
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, q[self.q + 3 : self.q + 7] / np.linalg.norm(q[self.q + 3 : self.q + 7]))
        return np.concatenate([v[self.v + 3 : self.v + 6], rotation.reshape(3, 3).T @ v[self.v : self.v + 3]])

    def is_at_rest(self, q):
        return np.array_equal(self.coordinates(q), [0, 0, 0, 0, 0, 0, 1][-len(self.coordinates(q)) :] if not self.is_scalar else [0])


def settings(model, world, differ):
    # A gravity that a flag turns off is zero in the model by now.
    differ("gravity", world["gravity"] or [0, 0, -9.81], model.opt.gravity, 1.0)
    differ("step", world["step"] or 0.002, model.opt.timestep, 1.0)
    name = mujoco.mjtIntegrator(model.opt.integrator).name
    differ("integrator", f"mjINT_{(world['integrator'] or 'Euler').upper()}" != name, 0, 1.0)


def keyframes(model, world, joints, differ, count):
    moved = [joint for joint in joints if not joint.is_at_rest(model.qpos0)]
    differ("home", bool(moved) != bool(world["home"]), 0, 1.0)
    if world["home"]:
        state(world["home"]["q"], [(joint.name, joint.coordinates(model.qpos0)) for joint in joints], "home", differ)
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_KEY, key) or f"key_{key}" for key in range(model.nkey)]
    # Keyframes of partly attached models are not read, and <size nkey> makes some without data.
    found = [key["name"] for key in world["keyframes"]]
    left = [name for name in names if name not in found]
    differ("keyframes", found != [name for name in names if name not in left], 0, 1.0)
    count("keyframes", len(found))
    count("keyframes not read", len([name for name in left if not name.startswith("key_")]))
    data = mujoco.MjData(model)
    at_zero = [(joint.name, [0] if joint.is_scalar else [0, 0, 0, 0, 0, 0, 1][0 if joint.kind == 0 else 3 :]) for joint in joints]
    for key in world["keyframes"]:
        index = names.index(key["name"])
        mujoco.mj_resetDataKeyframe(model, data, index)
        found = key["q"] or [(name, list(map(float, q))) for name, q in at_zero]
        state(found, [(joint.name, joint.coordinates(data.qpos)) for joint in joints], "keyframe q", differ)
        rates = [(joint.name, joint.rates(data.qpos, data.qvel)) for joint in joints]
        state(key["v"] or [(name, [0.0] * len(v)) for name, v in rates], rates, "keyframe v", differ)
        ids = numbers_of(model, [one["name"] for one in world["actuators"]])
        expected = [data.ctrl[model.actuator_ctrladr[one]] for one in ids]
        differ("keyframe control", key["control"] or [0.0] * len(expected), expected, 1.0)
        expected = [data.act[model.actuator_actadr[one]] if model.actuator_actnum[one] else 0.0 for one in ids]
        differ("keyframe activation", key["activation"] or [0.0] * len(expected), expected, 1.0)


def state(found, expected, kind, differ):
    differ(kind, [name for name, _ in found] != [name for name, _ in expected], 0, 1.0)
    for (_, numbers), (_, wanted) in zip(found, expected):
        differ(kind, numbers, wanted, max(1.0, np.abs(wanted).max()))


def planes(model, world, differ, count):
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    touches = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    touches &= not disabled(model, "CONTACT", "CONSTRAINT")
    fixed = [body for body in range(model.nbody) if not moves(model, body)]
    all_planes = [
        geom
        for geom in range(model.ngeom)
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE and touches[geom] and model.geom_bodyid[geom] in fixed
    ]
    count("planes", len(all_planes))
    differ("planes", len(all_planes) != len(world["planes"]), 0, 1.0)
    for geom, (_, point, normal) in zip(all_planes, world["planes"]):
        differ("planes", point, data.geom_xpos[geom], max(1.0, np.abs(data.geom_xpos[geom]).max()))
        differ("planes", normal, data.geom_xmat[geom].reshape(3, 3)[:, 2], 1.0)


def moves(model, body):
    while body:
        if model.body_jntnum[body]:
            return True
        body = model.body_parentid[body]
    return False


def names_of(model):
    actuators = range(model.nactuator)
    return [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, one) or f"actuator_{one}" for one in actuators]


def numbers_of(model, names):
    index = {name: one for one, name in enumerate(names_of(model))}
    return [index[name] for name in names if name in index]


def obstacle(model, one):
    """Why an actuator has no affine law on coordinates; nothing if it has one."""
    kind, target = int(model.actuator_trntype[one]), model.actuator_trnid[one, 0]
    if model.actuator_plugin[one] >= 0:
        return "plugin"
    if mujoco.mjtDyn(model.actuator_dyntype[one]) not in STATES or model.actuator_actnum[one] > 1:
        return "state " + mujoco.mjtDyn(model.actuator_dyntype[one]).name[6:].lower()
    if model.actuator_gaintype[one] > 1 or model.actuator_biastype[one] > 1:
        return "gain " + mujoco.mjtGain(model.actuator_gaintype[one]).name[7:].lower()
    if kind == mujoco.mjtTrn.mjTRN_SITE:
        return "delay" if model.actuator_delay[one] else is_off(model, one)
    if kind not in ACTING:
        return "acts on " + mujoco.mjtTrn(kind).name[6:].lower()
    if kind == mujoco.mjtTrn.mjTRN_TENDON:
        if goes_around(model, target):
            return "tendon around a geom"
    elif model.jnt_type[target] == 0 or (model.jnt_type[target] == BALL and kind == mujoco.mjtTrn.mjTRN_JOINTINPARENT):
        return "free or ball joint"
    if model.actuator_delay[one]:
        return "delay"
    return is_off(model, one)


def is_off(model, one):
    disabled = model.opt.disableactuator & (1 << int(model.actuator_group[one])) if 0 <= model.actuator_group[one] < 31 else 0
    return "disabled" if disabled or model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_ACTUATION else None


def actuators(model, world, differ, count):
    """The numbers of those that are read."""
    names = names_of(model)
    why = [obstacle(model, one) for one in range(model.nactuator)]
    wanted = [name for name, reason in zip(names, why) if reason is None]
    found = [one["name"] for one in world["actuators"]]
    differ("actuators", found != wanted, 0, 1.0)
    count("actuators read", len(found))
    for one, number in zip(world["actuators"], numbers_of(model, found)):
        state = one["activation"]
        kind = mujoco.mjtDyn(model.actuator_dyntype[number])
        differ("activations", STATES[kind] != (state and state["kind"]), 0, 1.0)
        if state:
            count("activations read", 1)
            lower, upper = state["range"] or [0, 0]
            limited = model.actuator_actlimited[number]
            differ("activations", [lower, upper] if limited else bool(state["range"]), model.actuator_actrange[number] if limited else False, 1.0)
            if kind != mujoco.mjtDyn.mjDYN_INTEGRATOR:
                differ("activations", state["time"], model.actuator_dynprm[number, 0], 1.0)
            differ("activations", state["early"], bool(model.actuator_actearly[number]), 1.0)
    for reason in filter(None, why):
        count(f"actuators not read: {reason}", 1)
    return numbers_of(model, found)


def name_of(model, kind, index):
    return mujoco.mj_id2name(model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), index)


def wraps(model, tendon):
    first = model.tendon_adr[tendon]
    return model.wrap_type[first : first + model.tendon_num[tendon]]


def is_spatial(model, tendon):
    return wraps(model, tendon)[0] != mujoco.mjtWrap.mjWRAP_JOINT


def goes_around(model, tendon):
    """Whether it is not read: it goes around a geom."""
    return bool(np.isin(wraps(model, tendon), [mujoco.mjtWrap.mjWRAP_SPHERE, mujoco.mjtWrap.mjWRAP_CYLINDER]).any())


# It has one warning for all of its forces.
AROUND = "a tendon around a geom with forces"


def of_one_joint(model, one):
    """The degree of freedom of an actuator of one hinge or slide, and d(length)/d(coordinate)."""
    kind, target, gear = int(model.actuator_trntype[one]), model.actuator_trnid[one, 0], model.actuator_gear[model.actuator_outadr[one], 0]
    if kind == int(mujoco.mjtTrn.mjTRN_TENDON) and not is_spatial(model, target) and model.tendon_num[target] == 1:
        wrap = model.tendon_adr[target]
        target, gear = model.wrap_objid[wrap], gear * model.wrap_prm[wrap]
    elif kind not in (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)):
        return None
    return (model.jnt_dofadr[target], gear) if model.jnt_type[target] in (SLIDE, HINGE) else None


def reduce_armature(model, warned):
    """Takes all armature out of the model: that of hinges, slides and balls is compared by itself."""
    for joint in range(model.njnt):
        first = model.jnt_dofadr[joint]
    for tendon in range(model.ntendon):
        if model.tendon_armature[tendon]:
            phrase = AROUND if goes_around(model, tendon) else "armature of a tendon"
            warned.demand("armature of the tendon", name_of(model, "TENDON", tendon), phrase)
    for one in np.flatnonzero(getattr(model, "actuator_armature", np.zeros(0))):
        if of_one_joint(model, one) is None:
            warned.demand("armature of the actuator", name_of(model, "ACTUATOR", one), "armature of an actuator", "an actuator")
    model.dof_armature[:] = 0
    if model.ntendon:
        model.tendon_armature[:] = 0
    if model.nu and hasattr(model, "actuator_armature"):
        model.actuator_armature[:] = 0


def reduce(model, read, warned):
    """Takes out of the model what is not read."""
    for one in set(range(model.nactuator)) - set(read):
        if not disabled(model, "ACTUATION"):
            warned.demand("the actuator", name_of(model, "ACTUATOR", one), "an actuator")
        model.actuator_gaintype[one] = model.actuator_biastype[one] = 0
        model.actuator_gainprm[one] = 0
        model.actuator_forcelimited[one] = 0
    no_spring, no_damper = disabled(model, "SPRING"), disabled(model, "DAMPER")
    for joint in np.flatnonzero(model.jnt_actgravcomp & model.jnt_actfrclimited):
        warned.demand("actuatorgravcomp of the joint", name_of(model, "JOINT", joint), "actuatorgravcomp beside bounds")
    model.jnt_actgravcomp[:] = 0
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    for joint in range(model.njnt):
        name, first = name_of(model, "JOINT", joint), model.jnt_dofadr[joint]
        size = {0: 6, BALL: 3}.get(int(model.jnt_type[joint]), 1)
        dofs = slice(first, first + size)
        if model.jnt_type[joint] == 0:
            if model.dof_dampingpoly[dofs].any() and not no_damper:
                warned.demand("damping of higher degree of the free joint", name, "a damping of higher degree")
            # Damping of free joints is compared below.
            if no_damper:
                model.dof_damping[dofs] = 0
        if model.jnt_springyield[joint] > 0 and model.jnt_stiffness[joint] and not no_spring:
            warned.demand("the spring that yields of the joint", name, "a spring that yields")
        # The numbers of balls are compared elsewhere.
        if size == 3:
            model.jnt_stiffness[joint] = 0
            model.dof_damping[dofs] = 0
        # Stiffness of free joints is compared below.
        if size < 6:
            model.jnt_stiffnesspoly[joint] = 0
    model.dof_dampingpoly[:] = 0
    for tendon in range(model.ntendon):
        name, is_lost = name_of(model, "TENDON", tendon), goes_around(model, tendon)
        linear = (model.tendon_stiffness[tendon] if not no_spring else 0, model.tendon_damping[tendon] if not no_damper else 0)
        higher = (model.tendon_stiffnesspoly[tendon].any() and not no_spring) or (model.tendon_dampingpoly[tendon].any() and not no_damper)
        if is_lost and (higher or any(linear)):
            warned.demand("forces of the tendon", name, AROUND)
        if model.tendon_springyield[tendon] > 0 and linear[0]:
            warned.demand("the spring that yields of the tendon", name, AROUND if is_lost else "a spring that yields")
        if model.tendon_actfrclimited[tendon] and not is_lost:
            warned.demand("bounds of the forces on the tendon", name, "limits of the forces on a tendon")
        if is_lost:
            model.tendon_stiffness[tendon] = model.tendon_damping[tendon] = 0
            model.tendon_stiffnesspoly[tendon] = model.tendon_dampingpoly[tendon] = 0
    if model.ntendon:
        model.tendon_actfrclimited[:] = 0
    for one in range(model.nactuator):
        name, target, kind = name_of(model, "ACTUATOR", one), model.actuator_trnid[one, 0], model.actuator_trntype[one]
        has_law = kind in (0, 1) and model.jnt_type[target] in (SLIDE, HINGE)
        has_law |= kind == mujoco.mjtTrn.mjTRN_TENDON and not goes_around(model, target)
        if not has_law and model.actuator_damping[one]:
            if not no_damper:
                warned.demand("damping of the actuator", name, "damping of an actuator", "an actuator")
            model.actuator_damping[one] = 0
        if model.actuator_dampingpoly[one].any() and not no_damper:
            warned.demand("damping of higher degree of the actuator", name, "damping of an actuator", "an actuator")
    model.actuator_dampingpoly[:] = 0
    # The activation after a step: steps.py compares it.
    model.actuator_actearly[:] = 0


def constraints(model, warned):
    """What the solver would do, and no number here stands for."""
    for joint in range(model.njnt):
        first = model.jnt_dofadr[joint]
        if model.jnt_type[joint] == 0 and model.dof_frictionloss[first : first + 6].any() and not disabled(model, "FRICTIONLOSS", "CONSTRAINT"):
            warned.demand("dry friction of the free joint", name_of(model, "JOINT", joint), "frictionloss of a free joint")
    for tendon in range(model.ntendon):
        name, is_lost = name_of(model, "TENDON", tendon), goes_around(model, tendon)
        if model.tendon_limited[tendon] and not disabled(model, "LIMIT", "CONSTRAINT"):
            warned.demand("limits of the tendon", name, AROUND if is_lost else "limits of a tendon")
        if model.tendon_frictionloss[tendon] and not disabled(model, "FRICTIONLOSS", "CONSTRAINT"):
            warned.demand("dry friction of the tendon", name, AROUND if is_lost else "friction of a tendon")
    off = disabled(model, "EQUALITY", "CONSTRAINT")
    for one in range(model.neq):
        if model.eq_active0[one] and not off:
            name = name_of(model, "EQUALITY", one)
            warned.demand("the equation", name, "an equation", "a loop")


def length(drives, by_name, data):
    """Length, rate and the row of the Jacobian."""
    total, row = 0.0, np.zeros(len(data.qvel))
    for name, gear in drives:
        joint = by_name[name]
        at = data.qpos[joint.q : joint.q + 1]
        if joint.kind == BALL:
            at = np.zeros(3)
            quaternion = data.qpos[joint.q : joint.q + 4] / np.linalg.norm(data.qpos[joint.q : joint.q + 4])
            mujoco.mju_quat2Vel(at, quaternion, 1)
        total += np.dot(gear, at)
        row[joint.v : joint.v + len(gear)] += gear
    return total, row @ data.qvel, row


def place(model, data, frame):
    """The number of the body of a frame, and its position and axes in the world."""
    link, xyz, turn = frame
    body = max(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link), 0) if not link.startswith("body_") else int(link[5:])
    axes = data.xmat[body].reshape(3, 3)
    return body, data.xpos[body] + axes @ xyz, axes @ np.reshape(turn, (3, 3))


def length_of_path(strands, model, data):
    """Length, rate and the row of the Jacobian."""
    total, row = 0.0, np.zeros(model.nv)
    for strand in strands:
        points = [place(model, data, point)[:2] for point in strand["points"]]
        for (first, start), (second, end) in zip(points, points[1:]):
            distance = np.linalg.norm(end - start)
            total += strand["factor"] * distance
            for body, point, sign in [(first, start, -1), (second, end, 1)]:
                along = np.zeros((3, model.nv))
                mujoco.mj_jac(model, data, along, None, point, body)
                row += sign * strand["factor"] * ((end - start) / distance) @ along
    return total, row @ data.qvel, row


def length_of_site(site, model, data):
    """Length, rate and the row of the Jacobian."""

    def jacobian(body, point):
        along, about = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, along, about, point, body)
        return np.concatenate([along, about])

    gear = np.array(site["gear"])
    body, point, axes = place(model, data, site["at"])
    own = jacobian(body, point)
    if site["reference"] is None:
        row = np.concatenate([axes @ gear[:3], axes @ gear[3:]]) @ own
        return 0.0, row @ data.qvel, row
    base, origin, against = place(model, data, site["reference"])
    other = jacobian(base, origin)
    # Joints that carry both do not count.
    both = on_the_way(model, body) & on_the_way(model, base)
    own[:, list(both)] = other[:, list(both)] = 0
    quaternion, turn = np.zeros(4), np.zeros(3)
    mujoco.mju_mat2Quat(quaternion, (against.T @ axes).flatten())
    mujoco.mju_quat2Vel(turn, quaternion, 1)
    row = np.concatenate([against @ gear[:3], against @ gear[3:]]) @ (own - other)
    return gear[:3] @ against.T @ (point - origin) + gear[3:] @ turn, row @ data.qvel, row


def on_the_way(model, body):
    found = set()
    while body:
        first = model.body_dofadr[body]
        found |= set(range(first, first + model.body_dofnum[body])) if first >= 0 else set()
        body = model.body_parentid[body]
    return found


def law(one, u, model, data, by_name):
    """Force and torques, and how large the terms of the force are."""
    if one["site"]:
        at, rate, row = length_of_site(one["site"], model, data)
    elif one["path"]:
        at, rate, row = length_of_path(one["path"], model, data)
    else:
        at, rate, row = length(one["drives"], by_name, data)
    if one["control_range"] and not one["activation"]:
        u = np.clip(u, *one["control_range"])
    parts = np.array([1, at, rate])
    force = np.dot(one["gain"], parts) * u + np.dot(one["bias"], parts)
    size = np.dot(np.abs(one["gain"]), np.abs(parts)) * abs(u) + np.dot(np.abs(one["bias"]), np.abs(parts))
    if one["terms"]:
        (lower, upper), stiffness, damping = one["terms"]
        away = max(at - upper, 0) + min(at - lower, 0)
        force -= np.polyval([*stiffness[::-1], 0, 0], away) + np.polyval([*damping[::-1], 0, 0], abs(rate)) * np.sign(rate)
    # MuJoCo takes a target of a ball joint modulo whole turns.
    period = 2 * np.pi * np.linalg.norm([g for name, gear in one["drives"] if by_name[name].kind == BALL for g in gear])
    winds = period > 0 and one["gain"][0] == -one["bias"][1] and abs(u - at) > period / 2
    if one["force_range"]:
        force = np.clip(force, *one["force_range"])
    return force, force * row, size, winds


def forces(model, data, robot, read, by_name, random, differ):
    """Forces of actuators with random controls, some beyond their bounds, and of springs and dampers."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    world = robot["world"]
    expected, scale = np.zeros(model.nv), 0.0
    laws = []
    for one, number in zip(world["actuators"], read):
        address = model.actuator_ctrladr[number]
        lower, upper = model.actuator_ctrlrange[address]
        middle, width = ((lower + upper) / 2, upper - lower) if model.actuator_ctrllimited[address] else (0, 2)
        data.ctrl[address] = middle + width * random.uniform(-1, 1)
        # The gain multiplies the activation, if there is one.
        own, at = (data.act, model.actuator_actadr[number]) if one["activation"] else (data.ctrl, address)
        own[at] = data.ctrl[address]
        found = law(one, own[at], model, data, by_name)
        if found[3]:
            own[at] = 0.0
            found = law(one, 0.0, model, data, by_name)
        laws.append(found)
    mujoco.mj_forward(model, data)
    for (force, torque, size, _), number in zip(laws, read):
        scale = max(scale, size)
        differ("actuator force", force, data.actuator_force[model.actuator_outadr[number]], max(size, 1e-9))
        expected += torque
    for name, (lower, upper) in world["joint_forces"]:
        at = by_name[name].v
        expected[at] = np.clip(expected[at], lower, upper)
    differ("actuator torque", expected, data.qfrc_actuator, max(scale, 1e-9))
    passive, scale = np.zeros(model.nv), 1e-9
    for one in world["passive"]:
        force, torque, size, _ = law(one, 0.0, model, data, by_name)
        passive, scale = passive + torque, max(scale, size)
    for joint in by_name.values():
        if joint.is_scalar:
            own = robot["joints"][joint.index]
            offset = data.qpos[joint.q] - (own["rest"] or 0)
            parts = (own["stiffness"] or 0) * offset, (own["damping"] or 0) * data.qvel[joint.v]
            passive[joint.v] -= sum(parts)
            scale = max(scale, *np.abs(parts))
    for joint in by_name.values():
        if joint.kind == 0:
            damping = robot["joints"][joint.index]["damping"] or 0
            passive[joint.v : joint.v + 6] -= damping * data.qvel[joint.v : joint.v + 6]
            scale = max(scale, damping * np.abs(data.qvel[joint.v : joint.v + 6]).max())
    for one in world["effects"]:
        own, size = on_link(one, model, data)
        passive, scale = passive + own, max(scale, size)
    differ("passive force", passive, data.qfrc_passive, scale)


def on_link(effect, model, data):
    """The torques of an effect on a body, and how large they are."""
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, effect["on"])
    if body < 0:
        body = int(effect["on"].removeprefix("body_"))
    turn = data.xmat[body].reshape(3, 3)
    point, axes = data.xpos[body] + turn @ effect["xyz"], turn @ np.reshape(effect["turn"], (3, 3))
    along, about = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, along, about, point, body)
    numbers = np.array(effect["numbers"])
    force, moment = np.zeros(3), np.zeros(3)
    if effect["effect"] == "gravity_compensation":
        force = -numbers[0] * model.opt.gravity
    elif effect["effect"] == "box_drag":
        v, w = axes.T @ (along @ data.qvel - numbers[8:11]), axes.T @ about @ data.qvel
        force = axes @ -((numbers[:3] * np.abs(v) + numbers[6]) * v)
        moment = axes @ -((numbers[3:6] * np.abs(w) + numbers[7]) * w)
    elif effect["effect"] == "ellipsoid_drag":
        v, w = axes.T @ (along @ data.qvel - numbers[16:19]), axes.T @ about @ data.qvel
        moment, force = (axes @ own for own in on_ellipsoid(numbers, v, w))
    elif effect["effect"] == "tether":
        here, there, apart = np.zeros(4), np.array([numbers[12], *numbers[9:12]]), np.zeros(3)
        mujoco.mju_mat2Quat(here, axes.flatten())
        mujoco.mju_normalize4(there)
        mujoco.mju_subQuat(apart, here, there)
        away = point - numbers[6:9]
        force, moment = -(numbers[:3] @ powers(away)) * away, -(numbers[3:6] @ powers(apart)) * (axes @ apart)
    torques = along.T @ force + about.T @ moment
    return torques, np.abs(torques).max(initial=0.0)


def powers(x):
    size = np.linalg.norm(x)
    return np.array([1, size, size**2])


def on_ellipsoid(numbers, v, w):
    """Moment and force of a medium on an ellipsoid that moves by v and turns by w, in its axes."""
    axes, (density, viscosity, blunt, slender, angular, kutta, magnus) = numbers[:3], numbers[3:10]
    least, middle, most = sorted(axes)
    others = [(1, 2), (2, 0), (0, 1)]
    normal = np.array([(axes[j] * axes[k]) ** 2 for j, k in others]) * v
    speed, size = np.linalg.norm(v), np.linalg.norm(normal)
    area = np.pi * size / np.sqrt(normal @ v)
    inertia = np.array([axes[i] * max(axes[j], axes[k]) ** 4 for i, (j, k) in enumerate(others)])
    turns = 8 / 15 * np.pi * (angular * inertia + slender * (middle * most**4 - inertia)) * w
    diameter = 2 * np.mean(axes)
    drag = 3 * np.pi * viscosity * diameter + density * speed * (blunt * area + slender * (np.pi * middle * most - area))
    turning = np.pi * viscosity * diameter**3 + density * np.linalg.norm(turns)
    lift = kutta * density * area * (normal @ v) / (speed * size**2) * np.cross(np.cross(normal, v), v)
    momentum, spin = density * numbers[10:13] * v, density * numbers[13:16] * w
    force = lift + magnus * density * 4 / 3 * np.pi * np.prod(axes) * np.cross(w, v) - drag * v + np.cross(momentum, w)
    return np.cross(momentum, v) + np.cross(spin, w) - turning * w, force


def equations(model, world, joints, q, differ, count):
    """Coordinates that couplings compute are on the equations of MuJoCo."""
    off = mujoco.mjtDisableBit.mjDSBL_EQUALITY | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    active = [one for one in range(model.neq) if model.eq_active0[one] and not model.opt.disableflags & off]
    coupled, rest = [], 0
    for one in active:
        joint, tendon = (model.eq_type[one] == kind for kind in (mujoco.mjtEq.mjEQ_JOINT, mujoco.mjtEq.mjEQ_TENDON))
        is_coupling = joint or tendon
        if joint:
            is_coupling = model.eq_obj2id[one] >= 0
        if tendon:
            members = [other for other in (model.eq_obj1id[one], model.eq_obj2id[one]) if other >= 0]
            fixed = all(model.wrap_type[model.tendon_adr[other]] == mujoco.mjtWrap.mjWRAP_JOINT for other in members)
            is_coupling = fixed and sum(model.tendon_num[other] for other in members) > 1
            if len(members) > 1 and model.eq_data[one, 2:5].any():
                is_coupling = is_coupling and all(model.tendon_num[other] == 1 for other in members)
        coupled.append(one) if is_coupling else None
        rest += not is_coupling
    differ("couplings", len(coupled) != len(world["couplings"]) or rest != len(world["loops"]), 0, 1.0)
    count("couplings", len(coupled))
    count("loops", rest)
    by_name = {joint.name: joint for joint in joints}
    data = mujoco.MjData(model)
    for one, coupling in zip(coupled, world["couplings"]):
        for factor in (1.0, -0.3):
            data.qpos[:] = q
            for name, _ in coupling["leaders"]:
                data.qpos[by_name[name].q] *= factor
            values = [ratio * data.qpos[by_name[name].q] for name, ratio in coupling["leaders"]]
            leader = data.qpos[by_name[coupling["leaders"][0][0]].q]
            higher = sum(number * leader**power for power, number in enumerate(coupling["higher"], 2))
            data.qpos[by_name[coupling["joint"]].q] = sum(values) + coupling["offset"] + higher
            mujoco.mj_forward(model, data)
            rows = np.flatnonzero((data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY) & (data.efc_id == one))
            differ("couplings", data.efc_pos[rows] if len(rows) else np.nan, 0, max(1.0, np.abs(data.qpos).max()))
