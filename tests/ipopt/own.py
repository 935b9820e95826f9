"""The cart-pole in expressions of CasADi, from its Lagrange equations. It shares nothing with
generated code.

Numbers are those of models/urdf/cart_pole.urdf: a cart of 1 kg, a pole of 0.1 kg with its centre of
mass at 0.5 m.
"""

import casadi

CART, POLE, HALF, GRAVITY = 1.0, 0.1, 0.5, 9.81  # kg, kg, m, m/s²
INERTIA = 0.00833583333333  # kg m², about the centre of mass


def acceleration(q, v, tau):
    """a [2] with M a + h + g = tau; q [2]: m and rad from upright, tau [2]: N and N m."""
    sine, cosine = casadi.sin(q[1]), casadi.cos(q[1])
    coupling, turning = POLE * HALF * cosine, INERTIA + POLE * HALF**2
    force = tau[0] + POLE * HALF * sine * v[1] ** 2
    moment = tau[1] + POLE * HALF * GRAVITY * sine
    determinant = (CART + POLE) * turning - coupling**2
    return casadi.vertcat(turning * force - coupling * moment, (CART + POLE) * moment - coupling * force) / determinant


def step(h):
    """The classical method of four stages: a function of (q, v, tau) that gives q and v after h
    seconds.
    """
    q, v, tau = (casadi.SX.sym(name, 2) for name in ("q", "v", "tau"))
    rate = lambda x: casadi.vertcat(x[2:], acceleration(x[:2], x[2:], tau))  # noqa: E731
    x = casadi.vertcat(q, v)
    first = rate(x)
    second = rate(x + h / 2 * first)
    third = rate(x + h / 2 * second)
    fourth = rate(x + h * third)
    after = x + h / 6 * (first + 2 * second + 2 * third + fourth)
    return casadi.Function("own_step", [q, v, tau], [after[:2], after[2:]])
