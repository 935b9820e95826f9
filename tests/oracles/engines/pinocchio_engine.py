"""Pinocchio's answers in the conventions of the registry: `Engine.results` has a function for each name.

Pinocchio's model has an elementary joint for every stage of a joint of the tree, followers included. Its numbers are q_p(q) and
v_p = G v with a constant G, so tau = G^T tau_p, M = G^T M_p G, and derivatives likewise. G also puts (linear; angular) in our order.
"""

import math

import numpy
import pinocchio as pin

from . import tree as trees

REFERENCES = {"body": pin.LOCAL, "world": pin.WORLD, "world_aligned": pin.LOCAL_WORLD_ALIGNED}
SWAP = [3, 4, 5, 0, 1, 2]
MOMENTS = [0, 1, 2, 3, 4, 5, 7, 6, 8, 9]  # theirs: m h xx xy yy xz yz zz


def matrix(columns):
    """The bindings give a matrix of one column as a vector."""
    return numpy.reshape(columns, (len(columns), -1))


def square(numbers):
    n = math.isqrt(numpy.size(numbers))
    return numpy.reshape(numbers, (n, n))


class Elementary:
    """A joint of Pinocchio's model and where its numbers are in our vectors."""

    def __init__(self, index, q, v, multiplier=1.0, offset=0.0, leads=True, link=True):
        self.index, self.q, self.v, self.link = index, q, v, link
        self.multiplier, self.offset, self.leads = multiplier, offset, leads


def joint_model(kind, axis, pitch):
    if kind == "spherical":
        return pin.JointModelSpherical()
    if kind == "floating":
        return pin.JointModelFreeFlyer()
    axis = trees.unit(axis)
    if kind == "helical":
        return pin.JointModelHelicalUnaligned(axis, pitch / (2 * math.pi))
    return {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}[kind](axis)


class Engine:
    """A robot; `gravity` in the world frame."""

    def __init__(self, tree, floating, gravity):
        self.tree, self.floating = tree, floating
        self.model = pin.Model()
        self.elementary, self.joints, self.frame, starts = [], [], {}, {}
        self.nq = self.nv = 0
        base = self._add(0, "floating", trees.FLOATING_BASE, pin.SE3.Identity(), *self._own(trees.FLOATING_BASE, 7, 6)) if floating else 0
        self._seat(tree.root, base, pin.SE3.Identity())
        for joint in tree.visits():
            if joint.kind != "fixed" and not joint.mimic:
                starts[joint.name] = self._own(joint.name, *trees.SIZES[joint.kind])
        for joint in tree.visits():
            parent, place = self.frame[joint.parent]
            place = place * pin.SE3(trees.rotation(joint.rpy), numpy.array(joint.xyz))
            leader, multiplier, offset = tree.followed(joint)
            chain = trees.stages(joint)
            for k, (kind, axis) in enumerate(chain):
                q, v = starts[leader.name]
                parent = self._add(parent, (kind, axis, joint.pitch), f"{joint.name}.{k}", place, q + k, v + k, multiplier, offset,
                                   leader is joint, k + 1 == len(chain))
                place = pin.SE3.Identity()
            self._seat(joint.child, parent, place)
        self.model.gravity = pin.Motion(numpy.array(gravity), numpy.zeros(3))
        self.data = self.model.createData()
        self.G = self._rates()
        names = {e.index: self.model.names[e.index].rsplit(".", 1)[0] for e in self.elementary}
        self.links = [names[e.index] for e in self.elementary if e.link]

    def _own(self, name, nq, nv):
        start = self.nq, self.nv
        self.joints.append(name)
        self.nq, self.nv = self.nq + nq, self.nv + nv
        return start

    def _add(self, parent, what, name, place, q, v, *rest):
        kind, axis, pitch = (what, None, None) if isinstance(what, str) else what
        index = self.model.addJoint(parent, joint_model(kind, axis, pitch), place, name)
        self.elementary.append(Elementary(index, q, v, *rest))
        return index

    def _seat(self, name, joint, place):
        """What is fixed to the base has a frame and no mass: it does not move."""
        self.frame[name] = joint, place
        link = self.tree.link(name)
        if joint:
            xx, xy, xz, yy, yz, zz = link.inertia
            turn, tensor = trees.rotation(link.rpy), numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            inertia = pin.Inertia(link.mass, numpy.array(link.xyz), turn @ tensor @ turn.T)
            self.model.appendBodyToJoint(joint, inertia, place)
        self.model.addFrame(pin.Frame(name, joint, 0, place, pin.FrameType.BODY))

    def _parts(self):
        for e in self.elementary:
            joint = self.model.joints[e.index]
            yield e, joint.idx_q, joint.nq, joint.idx_v, joint.nv

    def _rates(self):
        G = numpy.zeros((self.model.nv, self.nv))
        for e, _, _, v, nv in self._parts():
            for k in range(nv):
                G[v + k, e.v + (SWAP[k] if nv == 6 else k)] = e.multiplier
        return G

    def full(self, q):
        """Pinocchio's coordinates."""
        full = numpy.zeros(self.model.nq)
        for e, at, nq, _, _ in self._parts():
            full[at : at + nq] = e.multiplier * numpy.asarray(q[e.q : e.q + nq]) + e.offset
        return full

    def ours(self, full):
        q = numpy.zeros(self.nq)
        for e, at, nq, _, _ in self._parts():
            if e.leads:
                q[e.q : e.q + nq] = full[at : at + nq]
        return q

    def integrate(self, q, step):
        return self.ours(pin.integrate(self.model, self.full(q), self.G @ step))

    def difference(self, q, target):
        return self.leaders() @ pin.difference(self.model, self.full(q), self.full(target))

    def integrate_derivatives(self, q, step):
        return [self.leaders() @ J @ self.G for J in pin.dIntegrate(self.model, self.full(q), self.G @ step)]

    def difference_derivatives(self, q, target):
        return [self.leaders() @ J @ self.G for J in pin.dDifference(self.model, self.full(q), self.full(target))]

    def leaders(self):
        """Takes Pinocchio's rates to ours: those of joints that follow nobody."""
        P = numpy.zeros((self.nv, self.model.nv))
        for e, _, _, v, nv in self._parts():
            for k in range(nv if e.leads else 0):
                P[e.v + (SWAP[k] if nv == 6 else k), v + k] = 1.0
        return P

    # ---- dynamics, with v, a and tau ours

    def mass_matrix(self, q):
        M = square(pin.crba(self.model, self.data, self.full(q)))
        return self.G.T @ (numpy.triu(M) + numpy.triu(M, 1).T) @ self.G

    def inverse_dynamics(self, q, v, a):
        return self.G.T @ pin.rnea(self.model, self.data, self.full(q), self.G @ v, self.G @ a)

    def coriolis_matrix(self, q, v):
        return self.G.T @ square(pin.computeCoriolisMatrix(self.model, self.data, self.full(q), self.G @ v)) @ self.G

    def inverse_dynamics_derivatives(self, q, v, a):
        pin.computeRNEADerivatives(self.model, self.data, self.full(q), self.G @ v, self.G @ a)
        return numpy.stack([self.G.T @ square(x) @ self.G for x in (self.data.dtau_dq, self.data.dtau_dv)] + [self.mass_matrix(q)])

    # ---- frames

    def jacobian(self, q, frame, reference):
        pin.computeJointJacobians(self.model, self.data, self.full(q))
        pin.updateFramePlacements(self.model, self.data)
        return matrix(pin.getFrameJacobian(self.model, self.data, self.model.getFrameId(frame), REFERENCES[reference]))[SWAP] @ self.G

    def jacobian_rate(self, q, v, frame, reference):
        pin.computeJointJacobiansTimeVariation(self.model, self.data, self.full(q), self.G @ v)
        pin.updateFramePlacements(self.model, self.data)
        id = self.model.getFrameId(frame)
        return matrix(pin.getFrameJacobianTimeVariation(self.model, self.data, id, REFERENCES[reference]))[SWAP] @ self.G

    def motions(self, q, v, a, frame, reference):
        """Twist, and the time derivative of its six numbers."""
        pin.forwardKinematics(self.model, self.data, self.full(q), self.G @ v, self.G @ a)
        arguments = self.model, self.data, self.model.getFrameId(frame), REFERENCES[reference]
        twist = pin.getFrameVelocity(*arguments).vector
        rate = pin.getFrameClassicalAcceleration if reference == "world_aligned" else pin.getFrameAcceleration
        return twist[SWAP], rate(*arguments).vector[SWAP]

    def placement(self, q, frame):
        pin.framesForwardKinematics(self.model, self.data, self.full(q))
        place = self.data.oMf[self.model.getFrameId(frame)]
        return place.rotation.copy(), place.translation.copy()

    def pushed(self, q, frames, wrenches, reference):
        """Sum J^T w, and its derivative with respect to q: dJ/dq_k = Jdot(q, e_k)."""
        torque, slope = numpy.zeros(self.nv), numpy.zeros((self.nv, self.nv))
        for frame, wrench in zip(frames, numpy.reshape(wrenches, (-1, 6))):
            torque += self.jacobian(q, frame, reference).T @ wrench
            for k, e in enumerate(numpy.eye(self.nv)):
                slope[:, k] += self.jacobian_rate(q, e, frame, reference).T @ wrench
        return torque, slope
