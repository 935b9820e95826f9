"""Laws of mechanics that the torques of an arm keep, from nothing but the poses of its links.

No law contains an Ad, a recursion of velocities or a mass matrix of its own. Each returns the
largest difference of its two sides over the largest number in them: below 1e-9 where it holds.

Derivatives of poses are complex steps: f(x + i h).imag / h is f′(x) to the last digits, for a tiny
h (Squire & Trapp, SIAM Review 40, 1998, 110–112). Derivatives by time are central differences.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from bodies import Robot, placements

TINY = 1e-30


class State(NamedTuple):
    """q, q̇, q̈ (n,), and a force (3,) of the world on the tip, N, in axes of the world."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    force: np.ndarray


class Program(NamedTuple):
    """A program of inverse dynamics, its arm, and the robot whose poses judge it."""

    inverse_dynamics: Callable  # (arm, q, v, a, gravity, tip): τ (n,), and the ground's wrench (6,)
    arm: tuple
    robot: Robot

    def run(self, q, v, a, gravity=None, force=(0.0, 0.0, 0.0)):
        """τ (n,), and the wrench (6,) of the ground on the arm; gravity: the robot's, or another."""
        gravity = self.robot.gravity if gravity is None else gravity
        tau, ground = self.inverse_dynamics(self.arm, q, v, a, gravity, np.append(np.zeros(3), force))
        return np.asarray(tau), ground

    def at_rest(self, q, force=(0.0, 0.0, 0.0)):
        """τ (n,) that holds the arm still."""
        return self.run(q, 0 * q, 0 * q, force=force)[0]

    def columns(self, q):
        """M (n, n): column k is the torque of q̈_k = 1, at rest and without gravity."""
        return np.transpose([self.run(q, 0 * q, unit, gravity=np.zeros(3))[0] for unit in np.eye(len(q))])


def gap(left, right):
    """The largest difference over the largest number."""
    return np.abs(np.subtract(left, right)).max() / max(np.abs(left).max(), np.abs(right).max())


def gradient(function, q):
    """∂f/∂q, (n, …), of a function of complex q."""
    return np.array([np.imag(function(q + 1j * TINY * unit)) / TINY for unit in np.eye(len(q))])


def time_derivative(function, state, h=2e-3):
    """df/dt of a function of q and q̇ at t = 0, on the path q + q̇ t + ½ q̈ t²; the error is O(h⁶)."""
    q, v, a, _ = state
    at = lambda t: function(q + v * t + 0.5 * a * t**2, v + a * t)
    return sum(w * (at(k * h) - at(-k * h)) for k, w in ((1, 45), (2, -9), (3, 1))) / (60 * h)


def motion(robot, q, v):
    """For each link that moves: link, c, ċ, R, ω of its centre of mass, in axes of the world."""
    T = placements(robot, q + 1j * TINY * v)
    for link, at, rate in list(zip(robot.links, T.real, T.imag / TINY))[1:]:
        centre = np.append(link.centre, 1.0)
        # [ω]× = Ṙ Rᵀ
        W = rate[:3, :3] @ at[:3, :3].T
        yield link, (at @ centre)[:3], (rate @ centre)[:3], at[:3, :3], np.array([W[2, 1], W[0, 2], W[1, 0]])


def kinetic(robot, q, v):
    """T = Σ ½ m ċ² + ½ ωᵀ R I_c Rᵀ ω, in J."""
    return sum(0.5 * link.mass * dc @ dc + 0.5 * w @ R @ link.moments @ R.T @ w for link, _, dc, R, w in motion(robot, q, v))


def potential(robot, q):
    """U = −Σ m gᵀ c, in J. q may be complex."""
    T = placements(robot, q)
    return -sum(link.mass * robot.gravity @ (at @ np.append(link.centre, 1.0))[:3] for link, at in zip(robot.links, T))


def momentum(robot, q, v):
    """(Σ c × m ċ + R I_c Rᵀ ω; Σ m ċ), (6,), about the origin of the world."""
    total = np.zeros(6)
    for link, c, dc, R, w in motion(robot, q, v):
        total += np.append(np.cross(c, link.mass * dc) + R @ link.moments @ R.T @ w, link.mass * dc)
    return total


def weight(robot, q):
    """(Σ c × m g; Σ m g), (6,), about the origin of the world."""
    total = np.zeros(6)
    for link, c, *_ in motion(robot, q, 0 * q):
        total += np.append(np.cross(c, link.mass * robot.gravity), link.mass * robot.gravity)
    return total


def slope(program, state):
    """At rest, the torques are the slope of the potential energy: τ = ∂U/∂q."""
    return gap(program.at_rest(state.q), gradient(lambda q: potential(program.robot, q), state.q))


def power(program, state):
    """The power of the torques is the rate of the energy: τᵀ q̇ = d/dt (T + U)."""
    energy = lambda q, v: kinetic(program.robot, q, v) + potential(program.robot, q)
    each = program.run(state.q, state.v, state.a)[0] * state.v
    return abs(each.sum() - time_derivative(energy, state)) / np.abs(each).sum()


def symmetry(program, state):
    """The mass matrix is symmetric: M = Mᵀ."""
    M = program.columns(state.q)
    return gap(M, M.T)


def energy(program, state):
    """The mass matrix gives the kinetic energy: ½ q̇ᵀ M q̇ = T."""
    return gap(0.5 * state.v @ program.columns(state.q) @ state.v, kinetic(program.robot, state.q, state.v))


def momentum_balance(program, state):
    """The ground's wrench and the weight change the momentum: F = d/dt P − W.

    Raises ValueError if the program does not return the wrench of the ground.
    """
    ground = program.run(state.q, state.v, state.a)[1]
    if ground is None:
        raise ValueError("momentum_balance: found None, expected a program that returns the ground's wrench (6,)")
    rate = time_derivative(lambda q, v: momentum(program.robot, q, v), state)
    return gap(ground, rate - weight(program.robot, state.q))


def virtual_work(program, state):
    """A force f on the tip p changes the torques by −(∂p/∂q)ᵀ f."""
    tip = lambda q: placements(program.robot, q)[-1, :3, 3]
    change = program.at_rest(state.q, force=state.force) - program.at_rest(state.q)
    return gap(change, -gradient(tip, state.q) @ state.force)


LAWS = (slope, power, symmetry, energy, momentum_balance, virtual_work)
