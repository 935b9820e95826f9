"""C code of a robot's dynamics by CasADi: the textbook recursions (RNEA, CRBA, ABA) on its scalar expressions, their derivatives by its own
automatic differentiation, and its own C generator.

v of a free base is [linear; angular], as the interface of peers has it. One-dof joints only.
"""

import sys
from functools import cached_property
from pathlib import Path

import casadi
import numpy
from casadi import SX, horzcat, jacobian, skew, vertcat

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "oracles"))
from engines import tree as trees  # noqa: E402

GRAVITY = -9.81
EXACT = 1e-15  # entries of constant rotations this near to 0 or 1 are meant to be that


def exact(rotation):
    nearest = numpy.round(rotation)
    return numpy.where(abs(rotation - nearest) < EXACT, nearest, rotation)


class Body:
    """A joint and all that is fixed to its child; `rotation`, `position`: the child in its parent; S: [angular; linear]."""

    def __init__(self, parent, rotation, position, S, inertia=None):
        self.parent, self.rotation, self.position, self.S = parent, rotation, position, S
        self.mass, self.first, self.second = 0.0, numpy.zeros(3), numpy.zeros((3, 3))

    def carry(self, link, rotation, position):
        """Adds a link's moments about the body's origin."""
        xx, xy, xz, yy, yz, zz = link.inertia
        turn = rotation @ trees.rotation(link.rpy)
        com = position + rotation @ numpy.array(link.xyz)
        tensor = turn @ numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
        self.mass += link.mass
        self.first = self.first + link.mass * com
        self.second = self.second + tensor + link.mass * (com @ com * numpy.eye(3) - numpy.outer(com, com))

    @property
    def inertia(self):
        h = skew(casadi.DM(self.first))
        return SX(casadi.sparsify(casadi.blockcat([[self.second, h], [-h, self.mass * casadi.DM.eye(3)]])))

    @property
    def X(self):
        """Motion from the parent to the child."""
        Rt = self.rotation.T
        return casadi.blockcat([[Rt, SX(3, 3)], [-Rt @ skew(self.position), Rt]])


def cross(V):
    """V x, for motions."""
    w, u = skew(V[:3]), skew(V[3:])
    return casadi.blockcat([[w, SX(3, 3)], [u, w]])


class Robot:
    def __init__(self, path, floating):
        tree = trees.read(path)
        self.floating, self.joints = floating, []
        self.nq = self.nv = 0
        names = [joint.name for joint in tree.visits() if joint.kind != "fixed"]
        assert not any(joint.mimic for joint in tree.joints)
        n = len(names)
        self.q = SX.sym("q", n + 7 * floating)
        self.v, self.a, self.tau = (SX.sym(x, n + 6 * floating) for x in ("v", "a", "tau"))
        self.drift = SX.sym("drift", 6)  # a small motion of the base, in its axes, [linear; angular]
        self.bodies, seats, count = [], {}, 0
        if floating:
            x, y, z, w = casadi.vertsplit(self.q[3:7])
            turn = SX.eye(3) + 2 * (w * skew(vertcat(x, y, z)) + skew(vertcat(x, y, z)) @ skew(vertcat(x, y, z)))
            swap = SX(casadi.sparsify(casadi.DM(numpy.eye(6)[:, [3, 4, 5, 0, 1, 2]])))
            turn = turn @ (SX.eye(3) + skew(self.drift[3:]))
            self._add(Body(-1, turn, SX.zeros(3), swap.T), trees.FLOATING_BASE, 7, 6)
            self.bodies[0].carry(tree.link(tree.root), numpy.eye(3), numpy.zeros(3))
        seats[tree.root] = (len(self.bodies) - 1, numpy.eye(3), numpy.zeros(3))
        for joint in tree.visits():
            parent, R, p = seats[joint.parent]
            p, R = p + R @ numpy.array(joint.xyz), exact(R @ trees.rotation(joint.rpy))
            if joint.kind == "fixed":
                seats[joint.child] = (parent, R, p)
            else:
                q, axis = self.q[7 * floating + count], trees.unit(joint.axis)
                count += 1
                self._moving(parent, R, p, joint, q, axis)
                seats[joint.child] = (len(self.bodies) - 1, numpy.eye(3), numpy.zeros(3))
            body, R, p = seats[joint.child]
            if body >= 0:
                self.bodies[body].carry(tree.link(joint.child), R, p)

    def _moving(self, parent, R, p, joint, q, axis):
        constant = SX(casadi.sparsify(casadi.DM(R)))
        if joint.kind == "prismatic":
            self._add(Body(parent, constant, SX(casadi.DM(p)) + constant @ axis * q, motion(numpy.zeros(3), axis)), joint.name, 1, 1)
            return
        K = casadi.sparsify(skew(casadi.DM(axis)))
        turn = SX.eye(3) + casadi.sin(q) * K + (1 - casadi.cos(q)) * casadi.sparsify(K @ K)
        if max(abs(axis)) == 1:  # 1 - (1 - cos q) is cos q
            k = numpy.argmax(abs(axis))
            turn = SX(casadi.sparsify(casadi.DM(numpy.diag(abs(axis))))) + casadi.sin(q) * K
            turn = turn + casadi.cos(q) * SX(casadi.sparsify(casadi.DM(numpy.eye(3) - numpy.diag(numpy.eye(3)[k]))))
        self._add(Body(parent, constant @ turn, SX(casadi.DM(p)), motion(axis, numpy.zeros(3))), joint.name, 1, 1)

    def _add(self, body, name, nq, nv):
        self.bodies.append(body)
        self.joints.append((name, self.nq, self.nv, nq, nv))
        self.nq, self.nv = self.nq + nq, self.nv + nv

    def rows(self, k):
        _, _, v, _, n = self.joints[k]
        return slice(v, v + n)

    def inverse_dynamics(self, v, a):
        V, A, F = [], [], []
        ground = vertcat(SX.zeros(3), 0, 0, -GRAVITY)
        for k, body in enumerate(self.bodies):
            own = body.S @ v[self.rows(k)]
            V.append(own + (body.X @ V[body.parent] if body.parent >= 0 else 0))
            above = A[body.parent] if body.parent >= 0 else ground
            A.append(body.X @ above + body.S @ a[self.rows(k)] + cross(V[k]) @ own)
            F.append(body.inertia @ A[k] - cross(V[k]).T @ (body.inertia @ V[k]))
        tau = [None] * len(self.bodies)
        for k in reversed(range(len(self.bodies))):
            body = self.bodies[k]
            tau[k] = body.S.T @ F[k]
            if body.parent >= 0:
                F[body.parent] += body.X.T @ F[k]
        return vertcat(*tau)

    def mass_matrix(self):
        inertia = [body.inertia for body in self.bodies]
        M = SX.zeros(self.nv, self.nv)
        for k in reversed(range(len(self.bodies))):
            body = self.bodies[k]
            F = inertia[k] @ body.S
            M[self.rows(k), self.rows(k)] = body.S.T @ F
            j = k
            while self.bodies[j].parent >= 0:
                F = self.bodies[j].X.T @ F
                j = self.bodies[j].parent
                M[self.rows(k), self.rows(j)] = F.T @ self.bodies[j].S
                M[self.rows(j), self.rows(k)] = M[self.rows(k), self.rows(j)].T
            if body.parent >= 0:
                inertia[body.parent] += body.X.T @ inertia[k] @ body.X
        return casadi.sparsify(M)

    def articulated_body(self):
        count = len(self.bodies)
        V, c, I, p = [], [], [body.inertia for body in self.bodies], []
        for k, body in enumerate(self.bodies):
            own = body.S @ self.v[self.rows(k)]
            V.append(own + (body.X @ V[body.parent] if body.parent >= 0 else 0))
            c.append(cross(V[k]) @ own)
            p.append(-cross(V[k]).T @ (I[k] @ V[k]))
        U, D, u = [None] * count, [None] * count, [None] * count
        for k in reversed(range(count)):
            body = self.bodies[k]
            U[k] = I[k] @ body.S
            D[k] = casadi.inv(body.S.T @ U[k]) if U[k].shape[1] == 1 else casadi.inv_minor(body.S.T @ U[k])
            u[k] = self.tau[self.rows(k)] - body.S.T @ p[k]
            if body.parent >= 0:
                left = I[k] - U[k] @ D[k] @ U[k].T
                I[body.parent] += body.X.T @ left @ body.X
                p[body.parent] += body.X.T @ (p[k] + left @ c[k] + U[k] @ (D[k] @ u[k]))
        a, A = [], []
        for k, body in enumerate(self.bodies):
            above = A[body.parent] if body.parent >= 0 else vertcat(SX.zeros(3), 0, 0, -GRAVITY)
            free = body.X @ above + c[k]
            a.append(D[k] @ (u[k] - U[k].T @ free))
            A.append(free + body.S @ a[k])
        return vertcat(*a)

    def tangent(self, expression):
        """Its derivative with respect to q."""
        if not self.floating:
            return jacobian(expression, self.q)
        return horzcat(jacobian(expression, self.drift), jacobian(expression, self.q[7:]))

    @cached_property
    def _mass(self):
        return self.mass_matrix()

    @cached_property
    def _torque(self):
        return self.inverse_dynamics(self.v, self.a)

    @cached_property
    def _forward(self):
        solved = ldl_solve(self._mass, self.tau - self.inverse_dynamics(self.v, SX.zeros(self.nv)))
        recursive = self.articulated_body() if not self.floating else solved
        return fewest([self._settled(solved)], [self._settled(recursive)])[0]

    @cached_property
    def _slopes(self):
        return [self._settled(self.tangent(self._torque)), self._settled(jacobian(self._torque, self.v)), self._settled(self._mass)]

    def _forward_slopes(self):
        inverse = self._settled(ldl_solve(self._mass, SX.eye(self.nv)))
        there = [casadi.substitute(x, self.a, self._forward) for x in self._slopes[:2]]
        return [*[-(inverse @ x) for x in there], inverse]

    def _settled(self, x):
        return casadi.substitute(x, self.drift, SX.zeros(6))

    def functions(self):
        """name -> (arguments, what makes the outputs); what several need is made once, for the first. Rows of numbers are dense, matrices have no zeros, and
        symmetric ones no lower triangle."""
        q, v, a, tau = self.q, self.v, self.a, self.tau
        return {
            "inverse_dynamics": ([q, v, a], lambda: [casadi.densify(self._settled(self._torque))]),
            "mass_matrix": ([q], lambda: [upper(self._settled(self._mass))]),
            "forward_dynamics": ([q, v, tau], lambda: [casadi.densify(self._forward)]),
            "inverse_dynamics_derivatives": ([q, v, a], lambda: matrices(*self._slopes)),
            "forward_dynamics_derivatives": ([q, v, tau], lambda: matrices(*self._forward_slopes())),
        }


def upper(M):
    return casadi.sparsify(casadi.triu(M))


def matrices(by_q, by_v, symmetric):
    return [casadi.sparsify(by_q), casadi.sparsify(by_v), upper(symmetric)]


def motion(angular, linear):
    return SX(casadi.sparsify(casadi.DM(numpy.concatenate([angular, linear]))))


def ldl_solve(M, b):
    """M = L^T D L from the last row upwards, which keeps the zeros of branches (Featherstone 2008, 6.5)."""
    n = M.shape[0]
    H = [[M[i, j] for j in range(n)] for i in range(n)]
    zero = lambda x: x.is_zero() or x.nnz() == 0
    for k in reversed(range(n)):
        for i in reversed(range(k)):
            if zero(H[k][i]):
                continue
            factor = H[k][i] / H[k][k]
            for j in range(i + 1):
                if not zero(H[k][j]):
                    H[i][j] = H[i][j] - factor * H[k][j]
            H[k][i] = factor
    columns = []
    for x in casadi.horzsplit(b):
        x = [x[i] for i in range(n)]
        for i in reversed(range(n)):
            for j in range(i):
                if not zero(H[i][j]):
                    x[j] = x[j] - H[i][j] * x[i]
        x = [x[i] / H[i][i] for i in range(n)]
        for i in range(n):
            for j in range(i):
                if not zero(H[i][j]):
                    x[i] = x[i] - H[i][j] * x[j]
        columns.append(vertcat(*x))
    return horzcat(*columns)


def fewest(*choices):
    return min(choices, key=lambda outputs: casadi.Function("f", [casadi.vertcat(*casadi.symvar(vertcat(*outputs)))], outputs).n_instructions())
