"""A peer library with one robot open, and what its results are compared with."""

import ctypes
import json
from pathlib import Path

import against_fixtures

TOLERANCE = 1e-12
LOOSE = 1e-11  # Pinocchio's inverse of the golfer's mass matrix is off by 1e-12 of its largest entry
SINGLE = 5e-5  # of a peer that computes in single precision


class Peer:
    """A peer library with one robot open."""

    def __init__(self, path, urdf, floating, gravity, lanes=1):
        self.library = ctypes.CDLL(path)
        self.lanes, self.turn = lanes, 0
        self.library.peer_open.restype = ctypes.c_void_p
        self.library.peer_open.argtypes = [ctypes.c_char_p, ctypes.c_int, *[ctypes.c_double] * 3]
        self.library.peer_joint_name.restype = ctypes.c_char_p
        self.library.peer_name.restype = ctypes.c_char_p
        self.handle = ctypes.c_void_p(self.library.peer_open(str(urdf).encode(), int(floating), *gravity))
        if not self.handle:
            raise ValueError(f"{urdf} was refused")
        self.nq, self.nv = self.number("nq"), self.number("nv")

    def number(self, what, *index):
        return getattr(self.library, f"peer_{what}")(self.handle, *index)

    def joints(self):
        """(name, iq, iv, nq, nv) of every joint."""
        return [
            (self.library.peer_joint_name(self.handle, i).decode(),
             *[self.number(f"joint_{what}", i) for what in ("iq", "iv", "nq", "nv")])
            for i in range(self.number("joint_count"))
        ]

    def entry(self, function):
        """What is called: what the peer says, or its function of this name."""
        told = getattr(self.library, "peer_entry", None)
        if told is None:
            return getattr(self.library, f"peer_{function}")
        told.restype = ctypes.c_void_p
        return ctypes.CFUNCTYPE(None)(told(self.handle, function.encode()))

    def call(self, function, size, *vectors):
        if self.lanes > 1:
            return self.call_in_a_lane(function, size, vectors)
        arrays = [(ctypes.c_double * len(vector))(*vector) for vector in vectors]
        out = (ctypes.c_double * size)()
        self.entry(function)(self.handle, *arrays, out)
        keeps = getattr(self.library, "peer_keeps", None)
        if keeps and keeps(self.handle, function.encode()):
            self.library.peer_read(self.handle, function.encode(), out)
        return list(out)

    def call_in_a_lane(self, function, size, vectors):
        """The result of one lane, another one each time; the others have other states."""
        self.turn, lane = (self.turn + 1) % self.lanes, self.turn
        spread = lambda vector: [x * (1 if k == lane else 0.9 - 0.1 * k) for x in vector for k in range(self.lanes)]
        arrays = [aligned(spread(vector)) for vector in vectors]
        out = aligned([0.0] * (self.lanes * size))
        self.entry(function)(self.handle, *arrays, out)
        return list(out)[lane :: self.lanes]

    def has(self, function):
        told = getattr(self.library, "peer_has", None)
        known = hasattr(self.library, f"peer_{function}") or hasattr(self.library, "peer_entry")
        return known and (told is None or bool(told(self.handle, function.encode())))

    def frames(self):
        if not hasattr(self.library, "peer_frame_name"):
            return []
        self.library.peer_frame_name.restype = ctypes.c_char_p
        return [self.library.peer_frame_name(self.handle, i).decode() for i in range(self.number("frame_count"))]

    def choose(self, frames):
        """Has functions of frames give these links only."""
        if not hasattr(self.library, "peer_choose_frames"):
            return False
        names = (ctypes.c_char_p * len(frames))(*[name.encode() for name in frames])
        return bool(self.library.peer_choose_frames(self.handle, len(frames), names))

    def kept(self, function, size, *vectors):
        """A result that the peer keeps until it is asked for it."""
        arrays = [(ctypes.c_double * len(vector))(*vector) for vector in vectors]
        out = (ctypes.c_double * size)()
        self.entry(function)(self.handle, *arrays)
        if not self.library.peer_read(self.handle, function.encode(), out):
            raise ValueError(f"{function} is not told")
        return list(out)

    def close(self):
        self.library.peer_close(self.handle)


def aligned(numbers):
    """An array from the start of a cache line."""
    line, size = 64, ctypes.sizeof(ctypes.c_double)
    room = (ctypes.c_char * (line + size * len(numbers)))()
    array = (ctypes.c_double * len(numbers)).from_buffer(room, -ctypes.addressof(room) % line)
    array[:] = numbers
    return array


def against(library, path):
    """The largest error of inverse and forward dynamics and the mass matrix, relative to the file's scales."""
    reference = json.loads(path.read_text())
    worst = [0.0, 0.0, 0.0]
    for state in reference["states"]:
        if state["wrenches"]:
            continue
        floating = reference["base"] == "floating"
        peer = Peer(library, path.parent / reference["urdf"], floating, state["gravity"])
        known = {joint["joint"]: joint for joint in reference["joints"]}
        iq, iv = [0] * peer.nq, [0] * peer.nv  # where the peer's numbers stand in the file
        for name, q0, v0, nq, nv in peer.joints():
            iq[q0 : q0 + nq] = range(known[name]["q_index"], known[name]["q_index"] + nq)
            iv[v0 : v0 + nv] = range(known[name]["v_index"], known[name]["v_index"] + nv)
        q, v, a, tau = [state["q"][k] for k in iq], *[[state[key][k] for k in iv] for key in ("v", "a", "tau")]
        got = peer.call("inverse_dynamics", peer.nv, q, v, a)
        for k, x in zip(iv, got):
            worst[0] = max(worst[0], abs(x - state["inverse_dynamics"][k]) / state["torque_scale"][k])
        if state["forward_dynamics"]:
            for k, x in zip(iv, peer.call("forward_dynamics", peer.nv, q, v, tau)):
                worst[1] = max(worst[1], abs(x - state["forward_dynamics"][k]) / state["forward_dynamics_scale"][k])
        mass = state["mass_matrix"]
        rows = mass if isinstance(mass[0], list) else [mass[k * peer.nv : (k + 1) * peer.nv] for k in range(peer.nv)]
        got = peer.call("mass_matrix", peer.nv * peer.nv, q)
        for i, r in enumerate(iv):
            for j, c in enumerate(iv):
                size = (rows[r][r] * rows[c][c]) ** 0.5
                worst[2] = max(worst[2], abs(got[i * peer.nv + j] - rows[r][c]) / size)
        peer.close()
    return worst


def check(peers, files):
    agreed = True
    for peer in peers:
        worst = against_fixtures.errors(lambda urdf, floating, gravity: Peer(peer["path"], urdf, floating, gravity, peer.get("lanes", 1)))
        bound = SINGLE if peer.get("element") == "f32" else LOOSE
        bad = {name: error for name, error in worst.items() if not error <= bound}
        agreed = agreed and not bad
        print(f"{peer['name']}: {len(worst)} functions against fixtures, largest error {max(worst.values(), default=0.0):.1e}", bad or "")
        agreed = agreed and bool(worst)
    for name in files:
        for peer in (peer for peer in peers if "pinocchio" in peer):
            worst = against(peer["path"], Path(name))
            agreed = agreed and max(worst[0], worst[2]) <= TOLERANCE and worst[1] <= 10 * TOLERANCE
            print(f"{Path(name).name} {peer['name']}: inverse dynamics {worst[0]:.1e}, "
                  f"forward dynamics {worst[1]:.1e}, mass matrix {worst[2]:.1e}")
    return agreed
