"""Forward dynamics: the articulated-body algorithm (Featherstone 2008, Table 7.1)."""

import numpy as np

from bodies import vector
from matrices import ad


def aba(tree, v, tau, wrenches=0.0):
    """q̈ with M(q) q̈ = τ − h(q, q̇) + Σ Jᵀ w, (nv,), in rad/s² or m/s².

    v, tau: (nv,), q̇ and τ; wrenches: (n, 6), those that the world applies to the bodies, in their
    axes. Row n of an array is the world: a parent of −1 is the last row. Raises ValueError if v or
    tau has another shape, and numpy.linalg.LinAlgError if a joint moves no mass.
    """
    v, tau = vector("v", v, tree.nv), vector("tau", tau, tree.nv)
    n = len(tree.bodies)
    V, c, p = np.zeros((n + 1, 6)), np.zeros((n, 6)), np.zeros((n + 1, 6))
    # I_i = G_i
    I = np.array([*(body.inertia for body in tree.bodies), np.zeros((6, 6))])
    p[:n] -= wrenches
    for i, body in enumerate(tree.bodies):
        rate = body.screws @ v[body.at]
        # V_i = Ad(T_iλ) V_λ + S_i q̇_i, c_i = ad(V_i) S_i q̇_i
        V[i] = body.adjoint @ V[body.parent] + rate
        c[i] = ad(V[i]) @ rate
        # p_i = −ad(V_i)ᵀ G_i V_i − w_i
        p[i] -= ad(V[i]).T @ body.inertia @ V[i]
    eliminated = [None] * n
    for i, body in reversed(list(enumerate(tree.bodies))):
        # U_i = I_i S_i, D_i = S_iᵀ U_i, u_i = τ_i − S_iᵀ p_i
        U = I[i] @ body.screws
        D_inverse = np.linalg.inv(body.screws.T @ U)
        u = tau[body.at] - body.screws.T @ p[i]
        # I_λ += Ad(T_iλ)ᵀ (I_i − U_i D_i⁻¹ U_iᵀ) Ad(T_iλ)
        apparent = I[i] - U @ D_inverse @ U.T
        I[body.parent] += body.adjoint.T @ apparent @ body.adjoint
        # p_λ += Ad(T_iλ)ᵀ (p_i + (I_i − U_i D_i⁻¹ U_iᵀ) c_i + U_i D_i⁻¹ u_i)
        p[body.parent] += body.adjoint.T @ (p[i] + apparent @ c[i] + U @ D_inverse @ u)
        eliminated[i] = U, D_inverse, u
    # V̇_0 = (0; −g)
    dV, a = np.zeros((n + 1, 6)), np.zeros(tree.nv)
    dV[-1, 3:] = -tree.gravity
    for i, body in enumerate(tree.bodies):
        U, D_inverse, u = eliminated[i]
        # A_i = Ad(T_iλ) V̇_λ + c_i, q̈_i = D_i⁻¹ (u_i − U_iᵀ A_i), V̇_i = A_i + S_i q̈_i
        A = body.adjoint @ dV[body.parent] + c[i]
        a[body.at] = D_inverse @ (u - U.T @ A)
        dV[i] = A + body.screws @ a[body.at]
    return a
