"""MuJoCo's answers in the conventions of the registry, for robots that it reads: one-dof joints, and a free base.

Its free joint moves by (velocity of the origin in world axes; angular velocity in body axes), so v_m = G(q) v, and
h = G^T (h_m + M_m dG/dt v).
"""

import xml.etree.ElementTree as xml

import mujoco
import numpy

from . import tree as trees


def urdf(tree):
    """The tree as a URDF with what MuJoCo has to leave alone."""
    robot = xml.Element("robot", name=tree.name)
    compiler = xml.SubElement(xml.SubElement(robot, "mujoco"), "compiler")
    compiler.attrib.update(fusestatic="false", discardvisual="true", balanceinertia="false", boundmass="0", boundinertia="0")
    words = lambda values: " ".join(repr(float(x)) for x in values)
    for link in tree.links:
        element = xml.SubElement(robot, "link", name=link.name)
        if link.mass:
            inertial = xml.SubElement(element, "inertial")
            xml.SubElement(inertial, "origin", xyz=words(link.xyz), rpy=words(link.rpy))
            xml.SubElement(inertial, "mass", value=repr(link.mass))
            names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
            xml.SubElement(inertial, "inertia", dict(zip(names, map(repr, link.inertia))))
    for joint in tree.joints:
        kind = "continuous" if joint.kind == "revolute" else joint.kind
        element = xml.SubElement(robot, "joint", name=joint.name, type=kind)
        xml.SubElement(element, "parent", link=joint.parent)
        xml.SubElement(element, "child", link=joint.child)
        xml.SubElement(element, "origin", xyz=words(joint.xyz), rpy=words(joint.rpy))
        xml.SubElement(element, "axis", xyz=words(joint.axis))
        if kind == "prismatic":
            xml.SubElement(element, "limit", lower="-10", upper="10")
    return xml.tostring(robot, encoding="unicode")


class Engine:
    """`ours`: the Pinocchio engine, for the order of joints."""

    def __init__(self, tree, ours, gravity):
        assert not any(joint.mimic for joint in tree.joints)
        spec = mujoco.MjSpec.from_string(urdf(tree))
        if ours.floating:
            spec.body(tree.root).add_freejoint()
        self.model = spec.compile()
        self.model.opt.gravity[:] = gravity
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT | mujoco.mjtDisableBit.mjDSBL_CONTACT
        self.data, self.floating, self.nv = mujoco.MjData(self.model), ours.floating, ours.nv
        id = lambda name: mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_JOINT, name)
        names = [name for name in ours.joints if name != trees.FLOATING_BASE]
        self.iq, self.iv = [self.model.jnt_qposadr[id(n)] for n in names], [self.model.jnt_dofadr[id(n)] for n in names]
        self.model.dof_armature[:] = self.model.dof_damping[:] = self.model.dof_frictionloss[:] = 0.0
        moves = lambda body: body and (self.model.body_dofnum[body] > 0 or moves(self.model.body_parentid[body]))
        self.moving = [body for body in range(self.model.nbody) if moves(body)]

    def set(self, q, v, a):
        """Sets the state; G and dG/dt v."""
        G, turn = numpy.zeros((self.model.nv, self.nv)), numpy.zeros(self.model.nv)
        free = 7 if self.floating else 0
        if self.floating:
            R = numpy.zeros(9)
            mujoco.mju_quat2Mat(R, numpy.array([q[6], *q[3:6]]))
            R = R.reshape(3, 3)
            self.data.qpos[:7] = [*q[:3], q[6], *q[3:6]]
            G[:3, 3:6], G[3:6, :3] = R, numpy.eye(3)
            turn[:3] = R @ numpy.cross(v[:3], v[3:6])
        self.data.qpos[self.iq] = q[free:]
        G[self.iv, range(6 if self.floating else 0, self.nv)] = 1.0
        self.data.qvel[:] = G @ v
        self.data.qacc[:] = G @ a + turn
        return G, turn

    def results(self, state):
        m, d = self.model, self.data
        q, v, a, tau = (numpy.array(state[key]) for key in ("q", "v", "a", "tau"))
        G, turn = self.set(q, v, a)
        mujoco.mj_forward(m, d)
        M = numpy.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, M)
        out = {"mass_matrix": G.T @ M @ G, "bias_forces": G.T @ (d.qfrc_bias + M @ turn)}
        self.set(q, v, a)
        mujoco.mj_inverse(m, d)
        out["inverse_dynamics"] = G.T @ d.qfrc_inverse
        out["forward_dynamics"] = numpy.linalg.solve(out["mass_matrix"], tau - out["bias_forces"])
        mujoco.mj_subtreeVel(m, d)
        out.update(self.totals(G, v))
        out.update(self.frames(G, turn, v, a, state["frames"]))
        return out

    def totals(self, G, v):
        """Sums over the moving bodies."""
        m, d = self.model, self.data
        mass = m.body_mass[self.moving]
        com = mass @ d.xipos[self.moving] / mass.sum()
        kinetic, linear, angular, J = 0.0, 0.0, 0.0, 0.0
        for body, weight in zip(self.moving, mass):
            jp, jr = numpy.zeros((3, m.nv)), numpy.zeros((3, m.nv))
            mujoco.mj_jacBodyCom(m, d, jp, jr, body)
            turned = d.ximat[body].reshape(3, 3)
            tensor = turned @ numpy.diag(m.body_inertia[body]) @ turned.T
            u, w = jp @ d.qvel, jr @ d.qvel
            kinetic += (weight * u @ u + w @ tensor @ w) / 2
            linear = linear + weight * u
            angular = angular + tensor @ w + weight * numpy.cross(d.xipos[body] - com, u)
            J = J + weight / mass.sum() * jp
        return {
            "center_of_mass": com, "center_of_mass_velocity": linear / mass.sum(), "center_of_mass_jacobian": J @ G,
            "kinetic_energy": kinetic, "potential_energy": -mass.sum() * m.opt.gravity @ com,
            "centroidal_momentum": numpy.append(angular, linear),
        }

    def frames(self, G, turn, v, a, names):
        m, d = self.model, self.data
        out = {key: [] for key in ("placements", "jacobians_world_aligned", "twists_world_aligned", "accelerations_world_aligned")}
        for name in names:
            body = mujoco.mj_name2id(m, mujoco.mjtObj.mjOBJ_BODY, name)
            body = max(body, 0)  # the root of a fixed robot is the world
            jp, jr, dp, dr = (numpy.zeros((3, m.nv)) for _ in range(4))
            mujoco.mj_jac(m, d, jp, jr, d.xpos[body], body)
            mujoco.mj_jacDot(m, d, dp, dr, d.xpos[body], body)
            J, dJ = numpy.vstack([jr, jp]), numpy.vstack([dr, dp])
            out["placements"].append(numpy.append(d.xmat[body], d.xpos[body]))
            out["jacobians_world_aligned"].append(J @ G)
            out["twists_world_aligned"].append(J @ G @ v)
            out["accelerations_world_aligned"].append(J @ (G @ a + turn) + dJ @ G @ v)
        return out
