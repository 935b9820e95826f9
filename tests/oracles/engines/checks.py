"""What the answers have to satisfy before they are written: definitions, by differences of the fourth order."""

import numpy
import pinocchio as pin

from .pinocchio_engine import REFERENCES, SWAP, matrix

STEP = 1e-3


def slope(f, h=STEP):
    """df/dt at 0."""
    near, far = numpy.asarray(f(h)) - numpy.asarray(f(-h)), numpy.asarray(f(2 * h)) - numpy.asarray(f(-2 * h))
    return (8 * near - far) / (12 * h)


def tangent(engine, q, f):
    """df/dq, the last index counting directions."""
    return numpy.stack([slope(lambda t: f(engine.integrate(q, t * e)), pace(engine)) for e in numpy.eye(engine.nv)], axis=-1)


def pace(engine):
    """A step that is small also for followers."""
    return STEP / max(1.0, abs(engine.G).max())


def errors(engine, state, out):
    """name -> largest error relative to the largest entry (or 1)."""
    q, v, a, tau, step, target = (numpy.array(state[key]) for key in ("q", "v", "a", "tau", "step", "target"))
    reference, frames, wrenches = state["wrench_reference"], state["frames"], numpy.reshape(state["wrenches"], (-1, 6))
    along = lambda t: engine.integrate(q, t * v + t * t / 2 * a)
    M, zero, found = out["mass_matrix"], numpy.zeros(engine.nv), {}

    in_time = lambda f: slope(f, pace(engine))

    def check(name, expected, actual=None):
        actual, expected = numpy.asarray(out[name] if actual is None else actual), numpy.asarray(expected)
        assert actual.shape == expected.shape, (name, actual.shape, expected.shape)
        found[name] = max(found.get(name, 0.0), abs(actual - expected).max() / max(1.0, abs(expected).max()))

    def placed(q):
        return numpy.array([numpy.append(R.ravel(), p) for R, p in (engine.placement(q, frame) for frame in frames)])

    check("placement_derivatives", tangent(engine, q, placed))
    for kind in REFERENCES:
        jacobians = out[f"jacobians_{kind}"]
        check(f"jacobian_rates_{kind}", in_time(lambda t: [engine.jacobian(along(t), frame, kind) for frame in frames]))
        check(f"twists_{kind}", [J @ v for J in jacobians])
        rates = [J @ a + dJ @ v for J, dJ in zip(jacobians, out[f"jacobian_rates_{kind}"])]
        check(f"accelerations_{kind}", rates)
    for k, (R, p) in enumerate(engine.placement(q, frame) for frame in frames):
        # the three references of one Jacobian; and pdot, from the placements themselves
        body, aligned = (out[f"jacobians_{kind}"][k] for kind in ("body", "world_aligned"))
        check("jacobians_body", numpy.vstack([R.T @ aligned[:3], R.T @ aligned[3:]]), body)
        spatial = numpy.vstack([aligned[:3], aligned[3:] + pin.skew(p) @ aligned[:3]])
        check("jacobians_world", spatial, out["jacobians_world"][k])
        check("jacobians_world_aligned", tangent(engine, q, lambda q: engine.placement(q, frames[k])[1]), aligned[3:])

    # C v + g = h, Mdot = C + C^T, and C = sum J^T (B J + I Jdot)
    C = out["coriolis_matrix"]
    check("coriolis_matrix", out["bias_forces"] - out["gravity_torque"], C @ v)
    check("coriolis_matrix", in_time(lambda t: engine.mass_matrix(along(t))), C + C.T)
    check("coriolis_matrix", factorised(engine, q, v))
    check("forward_dynamics", tau, M @ out["forward_dynamics"] + out["bias_forces"])
    check("mass_matrix_inverse", numpy.eye(engine.nv), M @ out["mass_matrix_inverse"])

    check("kinetic_energy", v @ M @ v / 2)
    check("gravity_torque", tangent(engine, q, lambda q: pin.computePotentialEnergy(engine.model, engine.data, engine.full(q))))
    com = lambda q: numpy.array(pin.centerOfMass(engine.model, engine.data, engine.full(q)))
    check("center_of_mass_jacobian", tangent(engine, q, com))
    check("center_of_mass_velocity", out["center_of_mass_jacobian"] @ v)
    com_jacobian = lambda q: matrix(pin.jacobianCenterOfMass(engine.model, engine.data, engine.full(q))) @ engine.G
    check("center_of_mass_acceleration", in_time(lambda t: com_jacobian(along(t)) @ (v + t * a)))
    centroidal = lambda q: matrix(pin.ccrba(engine.model, engine.data, engine.full(q), 0 * (engine.G @ v)))[SWAP] @ engine.G
    check("centroidal_momentum", out["centroidal_momentum_matrix"] @ v)
    check("centroidal_momentum_rate", in_time(lambda t: centroidal(along(t)) @ (v + t * a)))
    check("centroidal_momentum_matrix", pin.computeTotalMass(engine.model) * out["center_of_mass_jacobian"], out["centroidal_momentum_matrix"][3:])

    def pushed(q):
        return sum((engine.jacobian(q, frame, reference).T @ w for frame, w in zip(frames, wrenches)), zero)

    def solved(q, v, push):
        bias = engine.inverse_dynamics(q, v, zero) - push(q)
        return numpy.linalg.solve(engine.mass_matrix(q), tau - bias)

    check("static_torque_derivative", tangent(engine, q, lambda q: engine.inverse_dynamics(q, zero, zero) - pushed(q)))
    for suffix, push in (("", lambda q: zero), ("_with_wrenches", pushed)):
        dq = tangent(engine, q, lambda q: engine.inverse_dynamics(q, v, a) - push(q))
        dv = numpy.stack([slope(lambda t: engine.inverse_dynamics(q, v + t * e, a)) for e in numpy.eye(engine.nv)], axis=-1)
        check(f"inverse_dynamics_derivatives{suffix}", [dq, dv, M])
        dq = tangent(engine, q, lambda q: solved(q, v, push))
        dv = numpy.stack([slope(lambda t: solved(q, v + t * e, push)) for e in numpy.eye(engine.nv)], axis=-1)
        check(f"forward_dynamics_derivatives{suffix}", [dq, dv, numpy.linalg.inv(M)])
        check(f"forward_dynamics{suffix}", solved(q, v, push))
    if reference == "body":
        check("inverse_dynamics_with_wrenches", by_recursion(engine, q, v, a, frames, wrenches))

    # Y pi = tau, y pi = T, y pi = U with the links' own moments
    pi = moments(engine)
    check("torque_regressor", out["inverse_dynamics"], out["torque_regressor"] @ pi)
    check("kinetic_energy_regressor", out["kinetic_energy"], out["kinetic_energy_regressor"] @ pi)
    check("potential_energy_regressor", out["potential_energy"], out["potential_energy_regressor"] @ pi)
    again = engine.integrate(q, engine.difference(q, target))
    check("difference", abs(placement_of(engine, target)), abs(placement_of(engine, again)))
    check("integrate", placement_of(engine, engine.integrate(engine.integrate(q, step), -step)), placement_of(engine, q))
    end, apart = engine.integrate(q, step), numpy.eye(engine.nv)
    by_step = numpy.stack([slope(lambda t: engine.difference(end, engine.integrate(q, step + t * e))) for e in apart], axis=-1)
    check("integrate_derivatives", [tangent(engine, q, lambda q: engine.difference(end, engine.integrate(q, step))), by_step])
    by_q, by_target = tangent(engine, q, lambda q: engine.difference(q, target)), tangent(engine, target, lambda t: engine.difference(q, t))
    check("difference_derivatives", [by_q, by_target])
    return found


def placement_of(engine, q):
    pin.forwardKinematics(engine.model, engine.data, engine.full(q))
    return numpy.array([M.homogeneous for M in engine.data.oMi])


def by_recursion(engine, q, v, a, frames, wrenches):
    """RNEA's own treatment of wrenches that act on frames, in their axes."""
    forces = [pin.Force.Zero() for _ in range(engine.model.njoints)]
    for frame, w in zip(frames, wrenches):
        at = engine.model.frames[engine.model.getFrameId(frame)]
        forces[at.parentJoint] += at.placement.act(pin.Force(w[3:], w[:3]))
    return engine.G.T @ pin.rnea(engine.model, engine.data, engine.full(q), engine.G @ v, engine.G @ a, forces)


def factorised(engine, q, v):
    """sum J^T (B J + I Jdot), 2 B = (V x*) I - I (V x) + (I V) xbar*; Echeandia & Wensing 2021. Jdot there is that of axes which do not move:
    in axes of the body, V x J comes on top of the derivative of the numbers."""
    model, data, C = engine.model, engine.data, 0.0
    pin.computeJointJacobiansTimeVariation(model, data, engine.full(q), engine.G @ v)
    for index in range(1, model.njoints):
        J, dJ = (matrix(f(model, data, index, pin.LOCAL)) @ engine.G for f in (pin.getJointJacobian, pin.getJointJacobianTimeVariation))
        inertia, V = model.inertias[index].matrix(), pin.Motion(J @ v)
        P = pin.Force(inertia @ V.vector)
        across = numpy.column_stack([pin.Motion(e).cross(P).vector for e in numpy.eye(6)])
        B = (-V.action.T @ inertia - inertia @ V.action + across) / 2
        C = C + J.T @ (B @ J + inertia @ (dJ + V.action @ J))
    return C


def moments(engine):
    """m, h, xx xy xz yy yz zz about the origin of each link's frame, link after link."""
    rows = []
    for e in engine.elementary:
        if e.link:
            inertia = engine.model.inertias[e.index]
            turned = inertia.inertia - inertia.mass * pin.skewSquare(inertia.lever, inertia.lever)
            upper = [turned[i, j] for i in range(3) for j in range(i, 3)]
            rows.append([inertia.mass, *(inertia.mass * inertia.lever), *upper])
    return numpy.ravel(rows)
