"""Inverse dynamics: the recursive Newton–Euler algorithm (Lynch & Park 2017, §8.3.2)."""

import numpy as np

from bodies import vector
from matrices import ad


def rnea(tree, v, a, wrenches=0.0):
    """τ = M(q) q̈ + h(q, q̇) − Σ Jᵀ w, (nv,), in N·m or N.

    v, a: (nv,), q̇ and q̈; wrenches: (n, 6), those that the world applies to the bodies, in their
    axes. Row n of an array is the world: a parent of −1 is the last row. Raises ValueError if v or
    a has another shape.
    """
    v, a = vector("v", v, tree.nv), vector("a", a, tree.nv)
    n = len(tree.bodies)
    # V_0 = 0, V̇_0 = (0; −g)
    V, dV = np.zeros((n + 1, 6)), np.zeros((n + 1, 6))
    dV[-1, 3:] = -tree.gravity
    # F_i = −w_i
    F = np.zeros((n + 1, 6))
    F[:n] -= wrenches
    for i, body in enumerate(tree.bodies):
        rate = body.screws @ v[body.at]
        # V_i = Ad(T_iλ) V_λ + S_i q̇_i
        V[i] = body.adjoint @ V[body.parent] + rate
        # V̇_i = Ad(T_iλ) V̇_λ + S_i q̈_i + ad(V_i) S_i q̇_i
        dV[i] = body.adjoint @ dV[body.parent] + body.screws @ a[body.at] + ad(V[i]) @ rate
        # F_i += G_i V̇_i − ad(V_i)ᵀ G_i V_i
        F[i] += body.inertia @ dV[i] - ad(V[i]).T @ body.inertia @ V[i]
    tau = np.zeros(tree.nv)
    for i, body in reversed(list(enumerate(tree.bodies))):
        # τ_i = S_iᵀ F_i
        tau[body.at] = body.screws.T @ F[i]
        # F_λ += Ad(T_iλ)ᵀ F_i
        F[body.parent] += body.adjoint.T @ F[i]
    return tau
