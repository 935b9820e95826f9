"""The mass matrix: the composite rigid body algorithm (Featherstone 2008, Table 6.2)."""

import numpy as np

from bodies import WORLD


def crba(tree):
    """M(q), (nv, nv), symmetric."""
    # I_i = G_i; the last one is the world's
    composite = np.array([*(body.inertia for body in tree.bodies), np.zeros((6, 6))])
    M = np.zeros((tree.nv, tree.nv))
    for i, body in reversed(list(enumerate(tree.bodies))):
        # F = I_i S_i, one wrench for each rate of joint i; M_ii = S_iᵀ F
        F = composite[i] @ body.screws
        M[body.at, body.at] = body.screws.T @ F
        # To each body j that carries i: F ← Ad(T_iλ)ᵀ F, M_ji = S_jᵀ F, M_ij = M_jiᵀ
        below = body
        while below.parent != WORLD:
            F = below.adjoint.T @ F
            below = tree.bodies[below.parent]
            M[below.at, body.at] = below.screws.T @ F
            M[body.at, below.at] = M[below.at, body.at].T
        # I_λ += Ad(T_iλ)ᵀ I_i Ad(T_iλ)
        composite[body.parent] += body.adjoint.T @ composite[i] @ body.adjoint
    return M
