#!/usr/bin/env python3
"""Writes or checks the fixtures of inverse dynamics.

    python3 tests/oracles/make.py [robot...]             write fixtures/<robot>.json and ../fixtures/<robot>.casadi.json
    python3 tests/oracles/make.py --check [robot...]     compute again; exit 1 on any difference
    python3 tests/oracles/make.py --against FILE...      compare the oracle itself with *.ref.json files

Makes a virtual environment with CasADi in <repository>/.venv where CasADi is missing.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
MODELS = REPOSITORY / "models" / "urdf"
FIXTURES = HERE / "fixtures"

ROBOTS = [
    # robot             base
    ("simple_pendulum", "fixed"),
    ("double_pendulum", "fixed"),
    ("cart_pole", "fixed"),
    ("ur5_like", "fixed"),
    ("panda_like", "fixed"),
    ("gripper_arm", "fixed"),
    ("quadruped", "floating"),
    ("golfer", "fixed"),
    ("humanoid", "floating"),
    ("t_handle", "floating"),
]
WITH_PLACEMENTS = (0, 4)  # the states that carry placements too
WITHOUT_ANSWERS = ("humanoid",)  # its derivatives take as long as all others together
ROUNDING = 1e-12  # what double precision may differ from 60 digits, relative to the scale
TOLERANCE = 1e-10  # what --check allows


def ensure_casadi():
    """Runs this script again inside <repository>/.venv, made on the way, unless CasADi is at hand."""
    try:
        import casadi  # noqa: F401
        return
    except ImportError:
        pass
    environment = REPOSITORY / ".venv"
    python = environment / "bin" / "python"
    if Path(sys.prefix) == environment:
        subprocess.check_call([python, "-m", "pip", "install", "--quiet", "casadi", "numpy"])
    elif not python.exists():
        subprocess.check_call([sys.executable, "-m", "venv", environment])
    os.execv(python, [str(python), *sys.argv])


def relative(error, scale):
    """|error| / scale; where nothing can act (scale 0) any error is infinitely wrong."""
    return abs(error) / scale if scale else (float("inf") if error else 0.0)


def nearest(exact):
    """The nearest double; what 60 digits leave of an exact zero is zero."""
    return float(exact) if abs(exact) > 1e-40 else 0.0


def compute(name, base):
    """The fixture of one robot, rounded from 60 digits, the largest error that double precision made on the way, and the oracle."""
    import casadi
    import oracle
    import robot as urdf
    import states

    path = MODELS / f"{name}.urdf"
    robot = urdf.read(path)
    judge = oracle.Oracle(robot, base == "floating")
    rows, worst = [], 0.0
    for index, (q, v, a) in enumerate(states.states(name, robot, base == "floating")):
        tau, kinetic, potential, imbalance = judge.exact_inverse_dynamics(q, v, a)
        scale = [float(f"{value:.4g}") for value in judge.torque_scale(q, v, a)]
        rough, rough_kinetic, _, _ = judge.inverse_dynamics(q, v, a)
        errors = [relative(x - float(y), s) for x, y, s in zip(rough, tau, scale)]
        errors.append(relative(rough_kinetic - float(kinetic), float(kinetic)))
        errors.append(abs(float(imbalance)))  # 60 digits: nothing may be left of it
        worst = max(worst, *errors)
        placements = None
        if index in WITH_PLACEMENTS:
            exact = judge.exact_placements(q)
            placements = [[nearest(x) for x in row] for row in exact]
            drift = [abs(x - y) for row, other in zip(placements, judge.placements(q)) for x, y in zip(row, other)]
            worst = max(worst, *drift)
        rows.append({
            "q": q, "v": v, "a": a,
            "inverse_dynamics": [nearest(x) for x in tau], "torque_scale": scale,
            "kinetic_energy": nearest(kinetic), "potential_energy": nearest(potential), "placements": placements,
        })
    joints = [urdf.FLOATING_BASE] * (base == "floating") + [joint.name for joint in robot.coordinates]
    fixture = {
        "robot": name, "urdf": f"models/urdf/{name}.urdf", "urdf_sha256": robot.sha256, "casadi": casadi.__version__,
        "base": base, "gravity": oracle.GRAVITY, "joints": joints, "nq": judge.nq, "nv": judge.nv,
        "links": robot.link_order(), "states": rows,
    }
    return fixture, worst, judge


def render(fixture):
    """JSON with one line per array, so that a change shows where it is. Numbers are the shortest that read back exactly."""
    plain = lambda value: json.dumps(value, allow_nan=False)
    tidy = lambda value: [x + 0.0 if isinstance(x, float) else x for x in value] if isinstance(value, list) else value
    head = [f"  {plain(key)}: {plain(value)}," for key, value in fixture.items() if key != "states"]
    states = []
    for state in fixture["states"]:
        lines = []
        for key, value in state.items():
            if key == "placements" and value is not None:
                rows = ",\n".join("        " + plain(tidy(row)) for row in value)
                lines.append(f'      "placements": [\n{rows}\n      ]')
            else:
                lines.append(f"      {plain(key)}: {plain(tidy(value))}")
        states.append("    {\n" + ",\n".join(lines) + "\n    }")
    return "{\n" + "\n".join(head) + '\n  "states": [\n' + ",\n".join(states) + "\n  ]\n}\n"


def check(stored, live):
    """Sentences that say where a fixture and the live oracle part."""
    name, complaints = live["robot"], []
    for key in ("urdf_sha256", "base", "gravity", "joints", "nq", "nv", "links"):
        if stored.get(key) != live[key]:
            complaints.append(f"{name}: {key} was {stored.get(key)}, is now {live[key]}; renew the fixture")
    if complaints or len(stored["states"]) != len(live["states"]):
        return complaints or [f"{name}: {len(stored['states'])} states, should be {len(live['states'])}"]

    def compare(where, old, new, scales):
        for row, (x, y, scale) in enumerate(zip(old, new, scales, strict=True)):
            if not relative(x - y, scale) <= TOLERANCE:
                complaints.append(f"{name}: {where}, row {row}: stored {x!r}, live {y!r}, scale {scale!r}")

    for index, (old, new) in enumerate(zip(stored["states"], live["states"])):
        state = f"state {index}"
        for key in ("q", "v", "a"):
            compare(f"{state}, {key}", old[key], new[key], [1.0] * len(new[key]))
        compare(f"{state}, torque_scale", old["torque_scale"], new["torque_scale"],
                [1e8 * s for s in new["torque_scale"]])  # four digits are printed
        compare(f"{state}, inverse_dynamics", old["inverse_dynamics"], new["inverse_dynamics"], new["torque_scale"])
        for key in ("kinetic_energy", "potential_energy"):
            compare(f"{state}, {key}", [old[key]], [new[key]], [max(1.0, abs(new[key]))])
        if (old["placements"] is None) != (new["placements"] is None):
            complaints.append(f"{name}: {state}, placements are there only once")
        elif new["placements"] is not None:
            for link, x, y in zip(live["links"], old["placements"], new["placements"], strict=True):
                compare(f"{state}, placement of {link}", x, y, [1.0] * 12)
    return complaints


def against(path):
    """Compares the oracle with reference values of another program (v = [linear; angular] at a free base)."""
    import oracle
    import robot as urdf

    reference = json.loads(path.read_text())
    floating = reference["base"] == "floating"
    try:
        robot = urdf.read(path.parent / reference["urdf"], use_mimic=reference["mimic"] == "reduced")
    except ValueError as refusal:
        print(f"{path.name}: left out; {refusal}")
        return True
    judge = oracle.Oracle(robot, floating)
    places = {joint["joint"]: joint for joint in reference["joints"]}
    iq, iv = [], []
    if floating:
        base = places[urdf.FLOATING_BASE]
        iq += range(base["q_index"], base["q_index"] + 7)
        iv += [base["v_index"] + k for k in (3, 4, 5, 0, 1, 2)]
    iq += [places[joint.name]["q_index"] for joint in robot.coordinates]
    iv += [places[joint.name]["v_index"] for joint in robot.coordinates]
    worst = dict.fromkeys(("torque", "torque, 60 digits", "kinetic", "potential", "placement"), 0.0)

    def note(what, error, scale):
        worst[what] = max(worst[what], relative(error, scale))

    for state in reference["states"]:
        pick = lambda key, order: [state[key][k] for k in order]
        q, v, gravity = pick("q", iq), pick("v", iv), state["gravity"]
        a, expected = pick("a", iv), pick("inverse_dynamics", iv)
        if state["wrenches"]:  # the oracle knows no external wrenches
            a, expected = [0.0] * len(iv), pick("bias", iv)
        tau, kinetic, potential, _ = judge.inverse_dynamics(q, v, a, gravity)
        exact = judge.exact_inverse_dynamics(q, v, a, gravity)[0]
        for x, y, z, scale in zip(tau, exact, expected, pick("torque_scale", iv)):
            note("torque", x - z, scale)
            note("torque, 60 digits", float(y) - z, scale)
        note("kinetic", kinetic - state["kinetic_energy"], max(1.0, state["kinetic_energy"]))
        note("potential", potential - state["potential_energy"], max(1.0, abs(state["potential_energy"])))
        for link, row in zip(robot.link_order(), judge.placements(q)):
            known = state["placements"][link]
            for x, y in zip(row, known["R"] + known["p"]):
                note("placement", x - y, 1.0)
    print(f"{path.name}: " + ", ".join(f"{what} {error:.1e}" for what, error in worst.items()))
    return max(worst.values()) <= ROUNDING


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with the stored fixtures, write nothing")
    parser.add_argument("--against", action="store_true", help="the arguments are *.ref.json files")
    parser.add_argument("names", nargs="*", help="robots of models/urdf (default: all that there are)")
    arguments = parser.parse_args()
    ensure_casadi()
    sys.path.insert(0, str(HERE))
    if arguments.against:
        return 0 if all([against(Path(name)) for name in arguments.names]) else 1

    import answers

    unknown = set(arguments.names) - {name for name, _ in ROBOTS}
    if unknown:
        parser.error(f"no such robot: {', '.join(sorted(unknown))}; known: {', '.join(name for name, _ in ROBOTS)}")
    failed = 0
    for name, base in ROBOTS:
        if arguments.names and name not in arguments.names:
            continue
        if not (MODELS / f"{name}.urdf").exists():
            print(f"{name}: models/urdf/{name}.urdf is missing")
            failed += 1
            continue
        live, worst, judge = compute(name, base)
        path = FIXTURES / f"{name}.json"
        complaints = [] if worst <= ROUNDING else [f"{name}: double and 60 digits differ by {worst:.1e}"]
        if not arguments.check and not complaints:
            FIXTURES.mkdir(exist_ok=True)
            path.write_text(render(live))
        elif not path.exists():
            complaints.append(f"{name}: there is no fixture yet; write it with make.py {name}")
        else:
            complaints += check(json.loads(path.read_text()), live)
        verdict = "differs" if complaints else "agrees" if arguments.check else f"written, {path.stat().st_size // 1024} kB"
        print(f"{name}: {verdict}; double against 60 digits {worst:.1e}")
        if name not in WITHOUT_ANSWERS:
            complaints += answers.renew(live, judge, arguments.check)
        for complaint in complaints[:20]:
            print(f"  {complaint}")
        failed += bool(complaints)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
