"""The files tests/fixtures/<robot>.casadi.json: what slopes.py gives, in the format of other engines' answers."""

import json
from pathlib import Path

import casadi

import robot as urdf
import slopes
import states

FIXTURES = Path(__file__).resolve().parent.parent / "fixtures"
STATES = (4, 5)  # of those in states.py; the first of them only, for robots with more than eight degrees of freedom
TOLERANCE = 1e-12  # of what is stored, relative to the largest entry or 1
ZERO = 1e-40  # what 60 digits leave of an exact zero


def compute(fixture, oracle):
    """The answers for the robot of a fixture of make.py."""
    name, machine = fixture["robot"], slopes.Slopes(oracle)
    random, entries = states.SplitMix64(f"{name}, torques"), []
    for index in STATES if oracle.nv <= 8 else STATES[:1]:
        q, v, a = (fixture["states"][index][key] for key in ("q", "v", "a"))
        tau = [random.between(-20, 20) for _ in range(oracle.nv)]
        flat = {key: [x for row in rows for x in row] for key, rows in machine.results(q, v, a, tau).items()}
        results = {key: [float(x) if abs(x) > ZERO else 0 for x in numbers] for key, numbers in sorted(flat.items())}
        entries.append({"q": q, "v": v, "a": a, "tau": tau, "frames": [], "wrench_reference": "body", "results": results})
    free = [urdf.FLOATING_BASE] * oracle.floating
    return {
        "robot": name, "engine": f"casadi {casadi.__version__}, 60 digits", "base": fixture["base"], "gravity": fixture["gravity"],
        "joints": fixture["joints"], "links": free + [joint.name for joint in oracle.robot.visits if joint.kind != "fixed"],
        "nq": oracle.nq, "nv": oracle.nv, "states": entries,
    }


def render(answers):
    """JSON with a line for each array."""
    line = lambda value: json.dumps(value, allow_nan=False, separators=(",", ":"))
    lines = lambda entries, indent: ",\n".join(f"{indent}{line(key)}: {line(value)}" for key, value in entries)
    head = lines([(key, value) for key, value in answers.items() if key != "states"], " ")
    blocks = []
    for state in answers["states"]:
        given = lines([(key, value) for key, value in state.items() if key != "results"], "   ")
        blocks.append("  {\n" + given + ',\n   "results": {\n' + lines(state["results"].items(), "    ") + "\n   }\n  }")
    return "{\n" + head + ',\n "states": [\n' + ",\n".join(blocks) + "\n ]\n}\n"


def differences(stored, live):
    """Sentences that say where a file and the live oracle part."""
    name, found = live["robot"], []
    for key in ("base", "gravity", "joints", "links", "nq", "nv"):
        if stored.get(key) != live[key]:
            found.append(f"{name}: {key} was {stored.get(key)}, is now {live[key]}; renew the answers")
    for index, (old, new) in enumerate(zip(stored["states"], live["states"])):
        if set(old["results"]) != set(new["results"]):
            found.append(f"{name}, answers {index}: other functions than before; renew the answers")
        pairs = [(key, old[key], new[key]) for key in ("q", "v", "a", "tau")]
        pairs += [(key, old["results"][key], value) for key, value in new["results"].items() if key in old["results"]]
        for key, was, now in pairs:
            size = max(1.0, *map(abs, now))
            if len(was) != len(now) or not all(abs(x - y) <= TOLERANCE * size for x, y in zip(was, now)):
                found.append(f"{name}, answers {index}: {key} is no longer what is stored")
    return found if len(stored["states"]) == len(live["states"]) else [*found, f"{name}: answers in other states; renew them"]


def renew(fixture, oracle, check):
    """Writes the file, or compares with it; complaints."""
    path, live = FIXTURES / f"{fixture['robot']}.casadi.json", compute(fixture, oracle)
    if not check:
        path.write_text(render(live))
        return []
    if not path.exists():
        return [f"{fixture['robot']}: there are no answers yet; write them with make.py {fixture['robot']}"]
    return differences(json.loads(path.read_text()), live)
