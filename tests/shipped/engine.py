"""Pinocchio's answers for a URDF that Pinocchio reads itself, in the coordinates of `articulated`.

Pinocchio has one joint for every joint of the file, followers (mimic) included. Its coordinates are q_p(q), and its
velocities are v_p = G v with a constant G. So tau = G^T tau_p, M = G^T M_p G and h = G^T h_p.
"""

import contextlib
import math
import os
from pathlib import Path

import numpy
import pinocchio as pin

FLOATING_BASE = "__floating_base__"


@contextlib.contextmanager
def quiet():
    """Drops what the C++ library prints about the file."""
    saved, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(null)
        os.close(saved)


class Refused(Exception):
    """Pinocchio cannot read the file, or reads another robot from it."""


def moves_mass(path):
    """Whether Pinocchio reads the file as a robot in which a joint moves a mass."""
    with quiet():
        try:
            model = pin.buildModelFromUrdf(str(path))
        except Exception:  # the binding raises several classes
            return False
    return any(inertia.mass > 0 for inertia in list(model.inertias)[1:])


def affine(joint, moving):
    """(leaders with their factors, offset): q_joint = Σ factor · q_leader + offset, where no leader follows a joint."""
    mimic = joint["mimic"]
    if not mimic:
        return [(joint, 1.0)], 0.0
    leaders, offset = [], mimic["offset"]
    for leader in mimic["leaders"]:
        further, shift = affine(moving[leader["joint"]], moving)
        leaders += [(last, leader["multiplier"] * factor) for last, factor in further]
        offset += leader["multiplier"] * shift
    return leaders, offset


class Engine:
    """`joints`: the list of joints of `articulated check --format json`; gravity (0, 0, -9.81)."""

    def __init__(self, path, joints, floating):
        with quiet():
            try:
                arguments = [pin.JointModelFreeFlyer()] if floating else []
                self.model = pin.buildModelFromUrdf(str(path), *arguments)
            except Exception as error:  # the binding raises several classes
                raise Refused(str(error).replace(str(path), Path(path).name).strip().splitlines()[0][:120]) from None
        self.data = self.model.createData()
        moving = {joint["joint"]: joint for joint in joints if joint["kind"] != "fixed"}
        for joint in moving.values():
            if joint["kind"] not in ("revolute", "continuous", "prismatic", "floating"):
                raise Refused(f"has other velocities for a joint that is {joint['kind']}")
        names = {("root_joint" if name == FLOATING_BASE else name): joint for name, joint in moving.items()}
        known = set(self.model.names[1:])
        if known != set(names):
            raise Refused(f"other joints move: {sorted(known ^ set(names))[:4]}")
        self.nv = sum(joint["v"][1] for joint in moving.values() if not joint["mimic"])
        self.nq = sum(joint["q"][1] for joint in moving.values() if not joint["mimic"])
        self.parts, self.G = [], numpy.zeros((self.model.nv, self.nv))
        for name, joint in names.items():
            at = self.model.joints[self.model.getJointId(name)]
            leaders, offset = affine(joint, moving)
            self.parts.append((joint, at, leaders, offset))
            for leader, factor in leaders:
                block = numpy.eye(at.nv) * factor
                if at.nv == 6:  # ours is (angular; linear)
                    block = block[[3, 4, 5, 0, 1, 2]]
                start = leader["v"][0]
                self.G[at.idx_v : at.idx_v + at.nv, start : start + at.nv] += block

    def configuration(self, q):
        """q_p(q)."""
        out = pin.neutral(self.model)
        for joint, at, leaders, offset in self.parts:
            if at.nq == 7:
                start = joint["q"][0]
                out[at.idx_q : at.idx_q + 7] = q[start : start + 7]
                continue
            angle = sum(factor * q[leader["q"][0]] for leader, factor in leaders) + offset
            out[at.idx_q : at.idx_q + at.nq] = [angle] if at.nq == 1 else [math.cos(angle), math.sin(angle)]
        return out

    def inverse_dynamics(self, q, v, a):
        return self.G.T @ pin.rnea(self.model, self.data, self.configuration(q), self.G @ v, self.G @ a)

    def forward_dynamics(self, q, v, tau):
        """By Pinocchio's own algorithm; none where a joint follows another, for which it has none."""
        if self.model.nv != self.nv:
            return None
        return numpy.linalg.solve(self.G, pin.aba(self.model, self.data, self.configuration(q), self.G @ v, numpy.linalg.solve(self.G.T, tau)))

    def mass_matrix(self, q):
        full = pin.crba(self.model, self.data, self.configuration(q))
        full = numpy.triu(full) + numpy.triu(full, 1).T
        return self.G.T @ full @ self.G

    def torque_scale(self, q, v, a):
        """For each row, the sum of the sizes of all terms: of a body k that joint i carries, |f_k|·|r_ik| + |m_k|, or |f_k|."""
        model, data = self.model, self.data
        pin.rnea(model, data, self.configuration(q), self.G @ v, self.G @ a)
        rows = numpy.zeros(model.nv)
        kinds = {at.id: joint["kind"] for joint, at, *_ in self.parts}
        for k in range(1, model.njoints):
            inertia = model.inertias[k]
            rate = data.v[k]
            # the terms of a body's wrench I a + V x* (I V), each by its size, since they may cancel
            momentum, pushed, size = inertia * rate, inertia * data.a_gf[k], numpy.linalg.norm
            force = size(pushed.linear) + size(rate.angular) * size(momentum.linear)
            moment = size(pushed.angular) + size(rate.angular) * size(momentum.angular) + size(rate.linear) * size(momentum.linear)
            origin, i = data.oMi[k].translation, k
            while i:
                lever = numpy.linalg.norm(origin - data.oMi[i].translation)
                at = model.joints[i]
                for column in range(at.nv):
                    rotates = column >= 3 if at.nv == 6 else kinds[i] in ("revolute", "continuous")
                    rows[at.idx_v + column] += force * lever + moment if rotates else force
                i = model.parents[i]
        return numpy.abs(self.G).T @ rows
