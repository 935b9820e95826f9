"""Compares what a file says beside its robot: gravity, step, states, actuators, springs of tendons, equations, planes.

The laws are evaluated here from the numbers that the reader returns, not by the library.
"""

import copy

import mujoco
import numpy as np

BALL, SLIDE, HINGE = 1, 2, 3
ACTING = {int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT), int(mujoco.mjtTrn.mjTRN_TENDON)}


def compare(model, states, robot, differ, count):
    """`states`: of MuJoCo. `differ(kind, found, expected, scale)` takes differences, `count(kind, number)` numbers of things."""
    world = robot["world"]
    joints = [Joint(model, index, name) for index, (name, *_) in enumerate(robot["order"])]
    by_name = {joint.name: joint for joint in joints}
    settings(model, world, differ)
    keyframes(model, world, joints, differ, count)
    planes(model, world, differ, count)
    read = actuators(model, world, differ, count)
    if model.nv == 0:
        return
    own = copy.deepcopy(model)
    reduce(own, world, read, by_name)
    data = mujoco.MjData(own)
    for seed, (q, v, *_) in enumerate(states):
        data.qpos[:], data.qvel[:] = q, v
        forces(own, data, world, read, by_name, np.random.default_rng(seed), differ)
    equations(model, world, joints, states[0][0], differ, count)
    ranges = {joint.name: model.jnt_actfrcrange[joint.index] for joint in joints if model.jnt_actfrclimited[joint.index] and joint.is_scalar}
    differ("joint forces", sorted(ranges) != sorted(name for name, _ in world["joint_forces"]), 0, 1.0)
    for name, bounds in world["joint_forces"]:
        differ("joint forces", bounds, ranges.get(name, np.nan))


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
    # Those of models of which a part is attached are not read, and <size nkey> makes some without data.
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


def state(found, expected, kind, differ):
    differ(kind, [name for name, _ in found] != [name for name, _ in expected], 0, 1.0)
    for (_, numbers), (_, wanted) in zip(found, expected):
        differ(kind, numbers, wanted, max(1.0, np.abs(wanted).max()))


def planes(model, world, differ, count):
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    touches = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
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
    if model.actuator_dyntype[one]:
        return "state " + mujoco.mjtDyn(model.actuator_dyntype[one]).name[6:].lower()
    if model.actuator_gaintype[one] > 1 or model.actuator_biastype[one] > 1:
        return "gain " + mujoco.mjtGain(model.actuator_gaintype[one]).name[7:].lower()
    if kind not in ACTING:
        return "acts on " + mujoco.mjtTrn(kind).name[6:].lower()
    if kind == mujoco.mjtTrn.mjTRN_TENDON:
        return "spatial tendon" if model.wrap_type[model.tendon_adr[target]] != mujoco.mjtWrap.mjWRAP_JOINT else None
    joint = model.jnt_type[target]
    if joint == 0 or (joint == BALL and kind == mujoco.mjtTrn.mjTRN_JOINTINPARENT):
        return "free or ball joint"
    if model.actuator_delay[one]:
        return "delay"
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
    for reason in filter(None, why):
        count(f"actuators not read: {reason}", 1)
    return numbers_of(model, found)


def reduce(model, world, read, by_name):
    """Takes out of the model what is not read."""
    for one in set(range(model.nactuator)) - set(read):
        model.actuator_gaintype[one] = model.actuator_biastype[one] = 0
        model.actuator_gainprm[one] = 0
        model.actuator_forcelimited[one] = 0
    model.jnt_actgravcomp[:] = 0
    model.body_gravcomp[:] = 0
    model.opt.density = model.opt.viscosity = 0
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    model.actuator_dampingpoly[:] = model.dof_dampingpoly[:] = model.jnt_stiffnesspoly[:] = 0
    if model.ntendon:
        model.tendon_stiffnesspoly[:] = model.tendon_dampingpoly[:] = 0
        model.tendon_actfrclimited[:] = 0
        spatial = model.wrap_type[model.tendon_adr] != mujoco.mjtWrap.mjWRAP_JOINT
        model.tendon_stiffness[spatial] = model.tendon_damping[spatial] = 0
    for one in range(model.nactuator):
        target = model.actuator_trnid[one, 0]
        if model.actuator_trntype[one] in (0, 1) and model.jnt_type[target] not in (SLIDE, HINGE):
            model.actuator_damping[one] = 0
        if model.actuator_trntype[one] == mujoco.mjtTrn.mjTRN_TENDON and spatial[target]:
            model.actuator_damping[one] = 0
    # Those of other joints are compared, or warnings, elsewhere.
    for joint in range(model.njnt):
        first, size = model.jnt_dofadr[joint], {0: 6, BALL: 3}.get(int(model.jnt_type[joint]), 0)
        if size:
            model.jnt_stiffness[joint] = 0
            model.dof_damping[first : first + size] = 0


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


def law(one, u, data, by_name):
    """Force and torques, and how large the terms of the force are."""
    at, rate, row = length(one["drives"], by_name, data)
    if one["control_range"]:
        u = np.clip(u, *one["control_range"])
    parts = np.array([1, at, rate])
    force = np.dot(one["gain"], parts) * u + np.dot(one["bias"], parts)
    size = np.dot(np.abs(one["gain"]), np.abs(parts)) * abs(u) + np.dot(np.abs(one["bias"]), np.abs(parts))
    # MuJoCo takes a target of a ball joint modulo whole turns.
    period = 2 * np.pi * np.linalg.norm([g for name, gear in one["drives"] if by_name[name].kind == BALL for g in gear])
    winds = period > 0 and one["gain"][0] == -one["bias"][1] and abs(u - at) > period / 2
    if one["force_range"]:
        force = np.clip(force, *one["force_range"])
    return force, force * row, size, winds


def forces(model, data, world, read, by_name, random, differ):
    """Forces of actuators with random controls, some beyond their bounds, and of springs and dampers."""
    expected, scale = np.zeros(model.nv), 0.0
    laws = []
    for one, number in zip(world["actuators"], read):
        address = model.actuator_ctrladr[number]
        lower, upper = model.actuator_ctrlrange[address]
        middle, width = ((lower + upper) / 2, upper - lower) if model.actuator_ctrllimited[address] else (0, 2)
        data.ctrl[address] = middle + width * random.uniform(-1, 1)
        own = law(one, data.ctrl[address], data, by_name)
        if own[3]:
            data.ctrl[address] = 0.0
            own = law(one, 0.0, data, by_name)
        laws.append(own)
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
        force, torque, size, _ = law(one, 0.0, data, by_name)
        passive, scale = passive + torque, max(scale, size)
    for joint in by_name.values():
        if joint.is_scalar:
            offset = data.qpos[joint.q] - model.qpos_spring[joint.q]
            parts = model.jnt_stiffness[joint.index] * offset, model.dof_damping[joint.v] * data.qvel[joint.v]
            passive[joint.v] -= sum(parts)
            scale = max(scale, *np.abs(parts))
    if model.nflex == 0:
        differ("passive force", passive, data.qfrc_passive, scale)


def equations(model, world, joints, q, differ, count):
    """Coordinates that couplings compute are on the equations of MuJoCo."""
    off = mujoco.mjtDisableBit.mjDSBL_EQUALITY | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    active = [one for one in range(model.neq) if model.eq_active0[one] and not model.opt.disableflags & off]
    linear, rest = [], 0
    for one in active:
        joint, tendon = (model.eq_type[one] == kind for kind in (mujoco.mjtEq.mjEQ_JOINT, mujoco.mjtEq.mjEQ_TENDON))
        is_linear = (joint or tendon) and not model.eq_data[one, 2:5].any()
        if joint:
            is_linear = is_linear and model.eq_obj2id[one] >= 0
        if tendon:
            members = [other for other in (model.eq_obj1id[one], model.eq_obj2id[one]) if other >= 0]
            fixed = all(model.wrap_type[model.tendon_adr[other]] == mujoco.mjtWrap.mjWRAP_JOINT for other in members)
            is_linear = is_linear and fixed and sum(model.tendon_num[other] for other in members) > 1
        linear.append(one) if is_linear else None
        rest += not is_linear
    differ("couplings", len(linear) != len(world["couplings"]) or rest != len(world["loops"]), 0, 1.0)
    count("couplings", len(linear))
    count("loops", rest)
    by_name = {joint.name: joint for joint in joints}
    data = mujoco.MjData(model)
    for one, coupling in zip(linear, world["couplings"]):
        for factor in (1.0, -0.3):
            data.qpos[:] = q
            for name, _ in coupling["leaders"]:
                data.qpos[by_name[name].q] *= factor
            values = [ratio * data.qpos[by_name[name].q] for name, ratio in coupling["leaders"]]
            data.qpos[by_name[coupling["joint"]].q] = sum(values) + coupling["offset"]
            mujoco.mj_forward(model, data)
            rows = np.flatnonzero((data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY) & (data.efc_id == one))
            differ("couplings", data.efc_pos[rows] if len(rows) else np.nan, 0, max(1.0, np.abs(data.qpos).max()))
