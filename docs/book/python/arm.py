"""Inverse dynamics of a serial arm, in the form that books and lecture notes print.

The arm is a list: body i − 1 carries body i, and body n − 1 carries the tip. This program is right.
`mended.py` takes lines of it back to what they often are.
"""

from typing import NamedTuple

import numpy as np

from bodies import placements
from matrices import ad, adjoint, exponential, inertia, inverse


class Arm(NamedTuple):
    """A serial arm of n joints, at q = 0."""

    mount: np.ndarray  # (n + 1, 4, 4): pose of body i in body i − 1; the last one, of the tip
    space: np.ndarray  # (n, 6): screws of the joints in axes of the world
    mass: np.ndarray  # (n,), kg
    centre: np.ndarray  # (n, 3): centres of mass in axes of the bodies, m
    moments: np.ndarray  # (n, 3, 3): about the centres of mass, kg·m²


def inverse_dynamics(arm, q, v, a, gravity, tip):
    """τ (n,) of a motion, and the wrench (6,) of the ground on the arm in axes of the world.

    q, v, a: (n,), coordinates, rates and accelerations; gravity: (3,), in axes of the world; tip:
    (6,), the wrench that the world applies to the tip, about the tip's origin, in axes of the world.
    """
    S, X, tip_pose = transforms(arm, q)
    V, dV = outward(S, X, v, a, gravity)
    return inward(arm, S, X, V, dV, tip_pose, tip)


def transforms(arm, q):
    """S_i (n, 6), Ad(T_i,i−1) (n + 1, 6, 6), and the pose of the tip in the world (4, 4)."""
    n = len(q)
    S, X = np.zeros((n, 6)), np.zeros((n + 1, 6, 6))
    home = pose = np.eye(4)
    for i in range(n):
        # T_0i = T_0,i−1 T_i−1,i, at q = 0
        home = home @ arm.mount[i]
        # S_i = Ad(T_i0) S, of a screw S in axes of the world, at q = 0
        S[i] = adjoint(inverse(home)) @ arm.space[i]
        # T_i−1,i = X_i exp([S_i] q_i)
        T = arm.mount[i] @ exponential(S[i], q[i])
        pose = pose @ T
        X[i] = adjoint(inverse(T))
    X[n] = adjoint(inverse(arm.mount[n]))
    return S, X, pose @ arm.mount[n]


def outward(S, X, v, a, gravity):
    """V_i (n, 6) and V̇_i (n, 6)."""
    n = len(v)
    # V_0 = 0, V̇_0 = (0; −g): row −1 is the world
    V, dV = np.zeros((n + 1, 6)), np.zeros((n + 1, 6))
    dV[-1, 3:] = -gravity
    for i in range(n):
        # V_i = Ad(T_i,i−1) V_i−1 + S_i q̇_i
        V[i] = X[i] @ V[i - 1] + S[i] * v[i]
        # V̇_i = Ad(T_i,i−1) V̇_i−1 + S_i q̈_i + ad(V_i) S_i q̇_i
        dV[i] = X[i] @ dV[i - 1] + S[i] * a[i] + ad(V[i]) @ S[i] * v[i]
    return V[:n], dV[:n]


def inward(arm, S, X, V, dV, tip_pose, tip):
    """τ (n,), and the wrench (6,) of the ground on the arm in axes of the world."""
    n = len(V)
    F, tau = np.zeros((n + 1, 6)), np.zeros(n)
    # F_n = −w_n, turned to axes of the tip
    R = tip_pose[:3, :3]
    F[n] = -np.append(R.T @ tip[:3], R.T @ tip[3:])
    for i in reversed(range(n)):
        G = inertia(arm.mass[i], arm.centre[i], arm.moments[i])
        # F_i = Ad(T_i+1,i)ᵀ F_i+1 + G_i V̇_i − ad(V_i)ᵀ G_i V_i
        F[i] = X[i + 1].T @ F[i + 1] + G @ dV[i] - ad(V[i]).T @ G @ V[i]
        # τ_i = S_iᵀ F_i
        tau[i] = S[i] @ F[i]
    return tau, X[0].T @ F[0]


def arm_of(robot):
    """The arm of a robot of `bodies.read`: a chain of joints, and a fixed link at its end.

    Raises ValueError if the robot is no such chain.
    """
    root, *links, tip = robot.links
    rates = [link.screws.shape[1] for link in robot.links]
    parents = [link.parent for link in robot.links]
    if rates != [0] + [1] * len(links) + [0] or parents != list(range(-1, len(links) + 1)):
        raise ValueError(f"arm: found the root {root.name} and joints with {rates[1:]} rates, expected a chain with rates 1, …, 1, 0")
    homes = placements(robot, np.zeros(robot.nq))[1:]
    return Arm(
        mount=np.array([link.mount for link in (*links, tip)]),
        space=np.array([adjoint(home) @ link.screws[:, 0] for home, link in zip(homes, links)]),
        mass=np.array([link.mass for link in links]),
        centre=np.array([link.centre for link in links]),
        moments=np.array([link.moments for link in links]),
    )
