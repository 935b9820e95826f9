"""The registry's functions, each by its name, from a Pinocchio engine."""

import numpy
import pinocchio as pin

from .pinocchio_engine import MOMENTS, REFERENCES, SWAP, matrix, square


def results(engine, state):
    """name -> array, for all functions that are defined in this state. `state`: q v a tau wrenches step target frames
    wrench_reference."""
    q, v, a, tau, step, target = (numpy.array(state[key]) for key in ("q", "v", "a", "tau", "step", "target"))
    out = {"integrate": engine.integrate(q, step), "difference": engine.difference(q, target),
           "integrate_derivatives": engine.integrate_derivatives(q, step), "difference_derivatives": engine.difference_derivatives(q, target)}
    out.update(of_frames(engine, q, v, a, state["frames"]))
    out.update(of_dynamics(engine, q, v, a, tau))
    out.update(of_wrenches(engine, q, v, a, tau, state))
    out.update(of_derivatives(engine, q, v, a, tau, state))
    out.update(of_mass(engine, q, v, a))
    out.update(of_regressors(engine, q, v, a))
    out.update(of_operational_space(engine, q, state["frames"], out["mass_matrix"]))
    return out


def of_frames(engine, q, v, a, frames):
    places = [engine.placement(q, frame) for frame in frames]
    out = {"placements": numpy.array([numpy.append(R.ravel(), p) for R, p in places]), "placement_derivatives": []}
    for frame, (R, _) in zip(frames, places):
        body = engine.jacobian(q, frame, "body")
        # dR = R [w], dp = R v for a small motion [w; v] of the frame in its own axes
        turns = [(R @ pin.skew(w)).ravel() for w in body[:3].T]
        out["placement_derivatives"].append(numpy.column_stack([numpy.append(t, R @ u) for t, u in zip(turns, body[3:].T)]))
    for reference in REFERENCES:
        motions = [engine.motions(q, v, a, frame, reference) for frame in frames]
        rates = [engine.jacobian_rate(q, v, frame, reference) for frame in frames]
        out[f"twists_{reference}"] = [twist for twist, _ in motions]
        out[f"accelerations_{reference}"] = [rate for _, rate in motions]
        out[f"jacobians_{reference}"] = [engine.jacobian(q, frame, reference) for frame in frames]
        out[f"jacobian_rates_{reference}"] = rates
        out[f"bias_accelerations_{reference}"] = [rate @ v for rate in rates]
    return out


def solve(engine, q, v, M, tau):
    """a = M^-1 (tau - h); ABA where no joint follows another."""
    if engine.G.shape[0] == engine.G.shape[1]:
        full = pin.aba(engine.model, engine.data, engine.full(q), engine.G @ v, engine.G @ tau)
        return engine.G.T @ full  # G is a permutation
    return numpy.linalg.solve(M, tau - engine.inverse_dynamics(q, v, numpy.zeros(engine.nv)))


def inverse(engine, q, M):
    if engine.G.shape[0] == engine.G.shape[1]:
        full = square(pin.computeMinverse(engine.model, engine.data, engine.full(q)))
        return engine.G.T @ (numpy.triu(full) + numpy.triu(full, 1).T) @ engine.G
    return numpy.linalg.inv(M)


def of_dynamics(engine, q, v, a, tau):
    zero, M = numpy.zeros(engine.nv), engine.mass_matrix(q)
    out = {"inverse_dynamics": engine.inverse_dynamics(q, v, a)}
    forces = {e.index: engine.data.f[e.index].vector[SWAP] for e in engine.elementary}
    out["joint_wrenches"] = [forces[e.index] for e in engine.elementary if e.link]
    return out | {
        "bias_forces": engine.inverse_dynamics(q, v, zero), "gravity_torque": engine.inverse_dynamics(q, zero, zero),
        "mass_matrix": M, "coriolis_matrix": engine.coriolis_matrix(q, v), "forward_dynamics": solve(engine, q, v, M, tau),
        "mass_matrix_inverse": inverse(engine, q, M), "solve_mass_matrix": numpy.linalg.solve(M, tau),
    }


def of_wrenches(engine, q, v, a, tau, state):
    zero, M = numpy.zeros(engine.nv), engine.mass_matrix(q)
    pushed, slope = engine.pushed(q, state["frames"], state["wrenches"], state["wrench_reference"])
    return {
        "inverse_dynamics_with_wrenches": engine.inverse_dynamics(q, v, a) - pushed,
        "static_torque": engine.inverse_dynamics(q, zero, zero) - pushed,
        "static_torque_derivative": engine.inverse_dynamics_derivatives(q, zero, zero)[0] - slope,
        "forward_dynamics_with_wrenches": solve(engine, q, v, M, tau + pushed),
    }


def of_derivatives(engine, q, v, a, tau, state):
    pushed, slope = engine.pushed(q, state["frames"], state["wrenches"], state["wrench_reference"])
    M, shift = engine.mass_matrix(q), numpy.stack([slope, 0 * slope, 0 * slope])
    W = inverse(engine, q, M)

    def forward(tau, shift):
        # M a + h = tau: da = M^-1 (dtau - d(ID)) at the a that solves it
        d = engine.inverse_dynamics_derivatives(q, v, solve(engine, q, v, M, tau)) - shift
        return numpy.stack([-numpy.linalg.solve(M, d[0]), -numpy.linalg.solve(M, d[1]), W])

    if engine.G.shape[0] == engine.G.shape[1]:
        pin.computeABADerivatives(engine.model, engine.data, engine.full(q), engine.G @ v, engine.G @ tau)
        d = engine.data
        plain = numpy.stack([*[engine.G.T @ square(x) @ engine.G for x in (d.ddq_dq, d.ddq_dv)], W])
    else:
        plain = forward(tau, 0 * shift)
    straight = engine.inverse_dynamics_derivatives(q, v, a)
    return {
        "inverse_dynamics_derivatives": straight, "inverse_dynamics_derivatives_with_wrenches": straight - shift,
        "forward_dynamics_derivatives": plain, "forward_dynamics_derivatives_with_wrenches": forward(tau + pushed, shift),
    }


def of_mass(engine, q, v, a):
    model, data, full = engine.model, engine.data, (engine.full(q), engine.G @ v, engine.G @ a)
    out = {"kinetic_energy": pin.computeKineticEnergy(model, data, *full[:2]), "potential_energy": pin.computePotentialEnergy(model, data, full[0])}
    pin.centerOfMass(model, data, *full)
    com = [numpy.array(x[0]) for x in (data.com, data.vcom, data.acom)]
    out |= dict(zip(("center_of_mass", "center_of_mass_velocity", "center_of_mass_acceleration"), com))
    out["center_of_mass_jacobian"] = matrix(pin.jacobianCenterOfMass(model, data, full[0])) @ engine.G
    out["centroidal_momentum_matrix"] = matrix(pin.ccrba(model, data, *full[:2]))[SWAP] @ engine.G
    out["centroidal_momentum"] = data.hg.vector[SWAP]
    out["centroidal_momentum_rate"] = pin.computeCentroidalMomentumTimeVariation(model, data, *full).vector[SWAP]
    return out


def of_regressors(engine, q, v, a):
    model, data, full = engine.model, engine.data, (engine.full(q), engine.G @ v, engine.G @ a)
    columns = [10 * (e.index - 1) + k for e in engine.elementary if e.link for k in MOMENTS]
    return {
        "torque_regressor": engine.G.T @ numpy.reshape(pin.computeJointTorqueRegressor(model, data, *full), (model.nv, -1))[:, columns],
        "kinetic_energy_regressor": numpy.ravel(pin.computeKineticEnergyRegressor(model, data, *full[:2]))[columns],
        "potential_energy_regressor": numpy.ravel(pin.computePotentialEnergyRegressor(model, data, full[0]))[columns],
    }


def of_operational_space(engine, q, frames, M):
    """The inertia only where every frame is carried by six degrees of freedom, and well."""
    inverses = []
    for frame in frames:
        J = engine.jacobian(q, frame, "world_aligned")
        inverses.append(J @ numpy.linalg.solve(M, J.T))
    out = {"operational_space_inertia_inverse": inverses}
    if all(numpy.linalg.cond(x) < 1e4 for x in inverses):
        out["operational_space_inertia"] = [numpy.linalg.inv(x) for x in inverses]
    return out
