"""Peers against tests/fixtures: every function that both have, in robots whose joints follow no other."""

import json
from pathlib import Path

HERE = Path(__file__).resolve().parent
FIXTURES = HERE.parent / "fixtures"
MODELS = HERE.parent.parent / "models" / "urdf"
FRAMES = ("placements", "twists", "accelerations", "jacobian", "bias_accelerations", "operational")
TAKES = {  # in the registry's order; all else takes q alone
    "v": ("twists", "accelerations", "jacobian_rates", "bias", "inverse_dynamics", "joint_wrenches", "coriolis", "forward_dynamics", "kinetic",
          "center_of_mass_velocity", "center_of_mass_acceleration", "torque_regressor"),
    "a": ("accelerations", "inverse_dynamics", "joint_wrenches", "center_of_mass_acceleration", "centroidal_momentum_rate", "torque_regressor"),
    "tau": ("forward_dynamics", "solve"),
}


def takes(name):
    """Names of the arguments."""
    arguments = ["q"]
    starts = lambda key: name.startswith(TAKES[key]) or key == "v" and name in ("centroidal_momentum", "centroidal_momentum_rate")
    arguments += [key for key in ("v", "a", "tau") if starts(key)]
    arguments += ["wrenches"] if "with_wrenches" in name or name.startswith("static") else []
    return arguments + {"integrate": ["step"], "difference": ["target"]}.get(name, [])


VECTORS = ("inverse_dynamics", "inverse_dynamics_with_wrenches", "bias_forces", "gravity_torque", "static_torque", "forward_dynamics",
           "forward_dynamics_with_wrenches", "solve_mass_matrix", "difference")
SQUARES = ("mass_matrix", "mass_matrix_inverse", "coriolis_matrix", "static_torque_derivative")
PLAIN = ("kinetic_energy", "potential_energy", "center_of_mass", "center_of_mass_velocity", "center_of_mass_acceleration", "centroidal_momentum",
         "centroidal_momentum_rate", "integrate")


def is_kept(name):
    return name not in VECTORS + SQUARES + PLAIN


def velocities(name):
    """Which dimensions of the result, counted from the last, are degrees of freedom."""
    if name in SQUARES or "dynamics_derivatives" in name:
        return (1, 2)
    if name in VECTORS or "jacobian" in name or name == "centroidal_momentum_matrix":
        return (1,)
    return (2,) if name == "torque_regressor" else ()


def orders(peer, fixture):
    """Our index of each number of the peer's q and v: a free joint moves by [linear; angular] there."""
    sizes = {name: (nq, nv) for name, _, _, nq, nv in peer.joints()}
    iq, iv, starts = 0, 0, {}
    for name in fixture["joints"]:
        starts[name] = (iq, iv)
        iq, iv = iq + sizes[name][0], iv + sizes[name][1]
    q, v = [0] * iq, [0] * iv
    for name, q0, v0, nq, nv in peer.joints():
        ours = starts[name]
        q[q0 : q0 + nq] = range(ours[0], ours[0] + nq)
        v[v0 : v0 + nv] = [ours[1] + (k + 3) % 6 if nv == 6 else ours[1] + k for k in range(nv)]
    return q, v


def vector(key, state, q, v, frames):
    if key == "wrenches":  # on the frames of the state only
        values = [0.0] * (6 * len(frames))
        for k, frame in enumerate(state["frames"]):
            at = 6 * frames.index(frame)
            values[at : at + 6] = state["wrenches"][6 * k : 6 * k + 6]
        return values
    return [state[key][k] for k in (q if key in ("q", "target") else v)]


def in_our_order(name, found, v):
    """Rows and columns that are degrees of freedom, put in our order."""
    where, n, which = {theirs: ours for ours, theirs in enumerate(v)}, len(v), velocities(name)
    wide = len(found) // n if which == (2,) else n  # numbers in a row
    for dimension in which:
        stride = 1 if dimension == 1 else wide
        # number k of the result stands at (k // stride) % n in this dimension
        found = [found[k + (where[k // stride % n] - k // stride % n) * stride] for k in range(len(found))]
    return found


def result(peer, name, state, expected, q, v, frames):
    """The peer's result in the state, in our order; of the state's frames, if it is one of frames. `frames`: those that the peer has now."""
    arguments = [vector(key, state, q, v, frames) for key in takes(name)]
    if not name.startswith(FRAMES):
        found = (peer.kept if is_kept(name) else peer.call)(name, len(expected), *arguments)
        return in_our_order(name, found, v)
    one = len(expected) // len(state["frames"])
    found = peer.kept(name, one * len(frames), *arguments)
    at = [one * frames.index(frame) for frame in state["frames"]]
    return in_our_order(name, [x for k in at for x in found[k : k + one]], v)


def can(peer, name, state, frames):
    acted = "wrenches" in takes(name)
    return peer.has(name) and (frames or not acted and not name.startswith(FRAMES)) and (not acted or state["wrench_reference"] == "body")


def errors(open_peer):
    """function -> largest error relative to the largest entry or 1. `open_peer(urdf, floating, gravity)`."""
    worst = {}
    for path in sorted(FIXTURES.glob("*.json")):
        fixture = json.loads(path.read_text())
        urdf = MODELS / f"{fixture['robot']}.urdf"
        if "description" in fixture or "<mimic" in urdf.read_text():
            continue
        try:
            peer = open_peer(urdf, fixture["base"] == "floating", fixture["gravity"])
        except ValueError:
            continue
        (q, v), links = orders(peer, fixture), peer.frames()
        for state in fixture["states"]:
            for frames in (links, state["frames"]):
                if links and frames and not peer.choose(frames):
                    continue
                for name, expected in state["results"].items():
                    if can(peer, name, state, frames if links else []):
                        found, size = result(peer, name, state, expected, q, v, frames), max(1.0, *map(abs, expected))
                        worst[name] = max(worst.get(name, 0.0), *(abs(x - y) / size for x, y in zip(found, expected, strict=True)))
        peer.close()
    return worst
