"""Values equal to Pinocchio's. Skipped where Pinocchio (`pip install pin`) is not installed."""

import articulated
import numpy as np
import pytest

pin = pytest.importorskip("pinocchio", reason="Pinocchio (pip install pin) is not installed: no values to compare with")

ROBOTS = ["panda_like", "quadruped"]
NEAR = 1e-11  # relative to the largest entry, or to one


class Peer:
    """Pinocchio's robot, with arguments and results in the order of articulated.

    Both list joints depth-first, but may take the children of a link in another order. Of a floating
    base Pinocchio has [v; ω], and both have the quaternion (x, y, z, w).
    """

    def __init__(self, name):
        self.ours = articulated.bundled(name)
        urdf = next(urdf for robot, urdf, *_ in articulated._native.bundled_robots() if robot == name)
        base = [pin.JointModelFreeFlyer()] if self.ours.base == "floating" else []
        self.model = pin.buildModelFromXML(urdf, *base)
        self.data = self.model.createData()
        in_q, in_v = [], []
        for joint in self.ours.joints:
            if joint.kind == "floating":
                other = self.model.joints[1]
                in_v += [other.idx_v + k for k in (3, 4, 5, 0, 1, 2)]
            else:
                other = self.model.joints[self.model.getJointId(joint.name)]
                in_v += range(other.idx_v, other.idx_v + other.nv)
            in_q += range(other.idx_q, other.idx_q + other.nq)
        self.in_q, self.in_v = np.array(in_q), np.array(in_v)

    def q(self, ours):
        out = np.empty(self.ours.nq)
        out[self.in_q] = ours
        return out

    def v(self, ours):
        out = np.empty(self.ours.nv)
        out[self.in_v] = ours
        return out

    def state(self, seed):
        rng = np.random.default_rng(seed)
        return self.ours.random_configuration(rng), *rng.normal(size=(3, self.ours.nv))

    def vector(self, theirs):
        return np.asarray(theirs)[self.in_v]

    def matrix(self, theirs):
        return np.asarray(theirs)[np.ix_(self.in_v, self.in_v)]


@pytest.fixture(scope="module", params=ROBOTS)
def peer(request):
    return Peer(request.param)


def equal(found, expected, near=NEAR):
    expected = np.asarray(expected)
    assert found.shape == expected.shape
    assert np.abs(found - expected).max() <= near * max(1.0, np.abs(expected).max())


@pytest.mark.parametrize("seed", range(5))
def test_dynamics(peer, seed):
    ours, model, data = peer.ours, peer.model, peer.data
    q, v, a, tau = peer.state(seed)
    their_q, their_v, their_a, their_tau = peer.q(q), peer.v(v), peer.v(a), peer.v(tau)
    equal(ours.inverse_dynamics(q, v, a), peer.vector(pin.rnea(model, data, their_q, their_v, their_a)))
    equal(ours.bias_forces(q, v), peer.vector(pin.nonLinearEffects(model, data, their_q, their_v)))
    equal(ours.gravity_torque(q), peer.vector(pin.computeGeneralizedGravity(model, data, their_q)))
    mass = pin.crba(model, data, their_q).copy()
    mass = np.triu(mass) + np.triu(mass, 1).T
    equal(ours.mass_matrix(q), peer.matrix(mass))
    equal(ours.forward_dynamics(q, v, tau), peer.vector(pin.aba(model, data, their_q, their_v, their_tau)), 1e-9)
    assert abs(ours.kinetic_energy(q, v) - pin.computeKineticEnergy(model, data, their_q, their_v)) < 1e-10


@pytest.mark.parametrize("seed", range(5))
def test_frames(peer, seed):
    ours, model, data = peer.ours, peer.model, peer.data
    q, v, _, _ = peer.state(seed)
    pin.forwardKinematics(model, data, peer.q(q), peer.v(v))
    pin.updateFramePlacements(model, data)
    pin.computeJointJacobians(model, data, peer.q(q))
    matrices, twists, jacobians = ours.placements_matrices(q), ours.twists_body(q, v), ours.jacobians_body(q)
    linear_first = [3, 4, 5, 0, 1, 2]
    for index, name in enumerate(ours.frames):
        frame = model.getFrameId(name, pin.FrameType.BODY)
        equal(matrices[index], data.oMf[frame].homogeneous)
        equal(twists[index], pin.getFrameVelocity(model, data, frame, pin.LOCAL).vector[linear_first])
        jacobian = pin.getFrameJacobian(model, data, frame, pin.LOCAL)
        equal(jacobians[index], jacobian[linear_first][:, peer.in_v])


@pytest.mark.parametrize("seed", range(5))
def test_derivatives(peer, seed):
    ours, model, data = peer.ours, peer.model, peer.data
    q, v, a, tau = peer.state(seed)
    by_q, by_v, by_a = pin.computeRNEADerivatives(model, data, peer.q(q), peer.v(v), peer.v(a))
    by_a = np.triu(by_a) + np.triu(by_a, 1).T
    equal(ours.inverse_dynamics_derivatives(q, v, a), np.stack([peer.matrix(m) for m in (by_q, by_v, by_a)]))
    by_q, by_v, by_tau = pin.computeABADerivatives(model, data, peer.q(q), peer.v(v), peer.v(tau))
    by_tau = np.triu(by_tau) + np.triu(by_tau, 1).T
    equal(ours.forward_dynamics_derivatives(q, v, tau), np.stack([peer.matrix(m) for m in (by_q, by_v, by_tau)]), 1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_configurations(peer, seed):
    q, step, _, _ = peer.state(seed)
    end = peer.ours.integrate(q, step)
    equal(peer.q(end), pin.integrate(peer.model, peer.q(q), peer.v(step)))
    equal(peer.v(peer.ours.difference(q, end)), pin.difference(peer.model, peer.q(q), peer.q(end)), 1e-10)
