"""Matrices of spatial algebra, written out (Lynch & Park, Modern Robotics, 2017, ch. 3 and 8).

Vectors of six are (angular; linear). A pose T_ab is a 4 × 4 matrix: the frame b in the frame a.
Lengths are in metres, angles in radians.
"""

import numpy as np


def skew(v):
    """[v]×, (3, 3): [v]× r = v × r."""
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def pose(rotation, position):
    """T of a rotation (3, 3) and a position (3,)."""
    return np.block([[rotation, np.reshape(position, (3, 1))], [np.zeros((1, 3)), np.ones((1, 1))]])


def inverse(T):
    """T⁻¹, (4, 4)."""
    R, p = T[:3, :3], T[:3, 3]
    return pose(R.T, -R.T @ p)


def exponential(S, q):
    """exp([S] q), (4, 4), of a screw S (6,) whose angular part is a unit vector or zero.

    §3.2.3 and §3.3.3 of Lynch & Park. A zero angular part gives a shift: q is in metres then.
    """
    W, v = skew(S[:3]), S[3:]
    sin, cos = np.sin(q), np.cos(q)
    # R = 1 + sin q [ŝ]× + (1 − cos q) [ŝ]×²
    R = np.eye(3) + sin * W + (1 - cos) * W @ W
    # p = (q 1 + (1 − cos q) [ŝ]× + (q − sin q) [ŝ]×²) v
    p = (q * np.eye(3) + (1 - cos) * W + (q - sin) * W @ W) @ v
    return pose(R, p)


def adjoint(T):
    """Ad(T) = [R 0; [p]×R R], (6, 6): V_a = Ad(T_ab) V_b."""
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [skew(p) @ R, R]])


def ad(V):
    """ad(V) = [[ω]× 0; [v]× [ω]×], (6, 6), of a twist V = (ω; v)."""
    W, v = skew(V[:3]), skew(V[3:])
    return np.block([[W, np.zeros((3, 3))], [v, W]])


def inertia(mass, centre, moments):
    """G about the origin of the body, (6, 6).

    mass in kg; centre of mass (3,) in m; moments of inertia (3, 3) about it, in kg·m².
    """
    # G = [I_c − m [c]×², m [c]×; m [c]×ᵀ, m 1]
    C = skew(centre)
    return np.block([[moments - mass * C @ C, mass * C], [mass * C.T, mass * np.eye(3)]])
