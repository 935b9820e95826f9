"""Reproducible states of a robot: the same on every machine and with every version of every library."""

import math

COUNT = 16
MASK = (1 << 64) - 1


class SplitMix64:
    """Steele, Lea & Flood, "Fast splittable pseudorandom number generators", 2014."""

    def __init__(self, name):
        # FNV-1a of the robot's name
        self.state = 0xCBF29CE484222325
        for byte in name.encode():
            self.state = (self.state ^ byte) * 0x100000001B3 & MASK

    def bits(self):
        self.state = self.state + 0x9E3779B97F4A7C15 & MASK
        z = self.state
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & MASK
        z = (z ^ z >> 27) * 0x94D049BB133111EB & MASK
        return z ^ z >> 31

    def between(self, low, high):
        """Six decimals: short to print, exact to read."""
        value = round(low + (high - low) * (self.bits() >> 11) / 2.0**53, 6)
        return min(max(value, low), high)

    def unit_quaternion(self):
        while True:
            four = [self.between(-1.0, 1.0) for _ in range(4)]
            square = sum(x * x for x in four)
            if 0.1 < square <= 1.0:
                return [x / math.sqrt(square) for x in four]


def bounds(joint):
    """Lowest and highest q, largest |v| and |a|; the file's limits where they make sense."""
    turns = joint.kind != "prismatic"
    widest, fastest, hardest = (math.pi, 5.0, 10.0) if turns else (1.0, 1.0, 5.0)
    low, high = joint.lower, joint.upper
    if joint.kind == "continuous" or not (low < high):
        low, high = -widest, widest
    speed = joint.velocity if joint.velocity > 0 else fastest
    return max(low, -widest), min(high, widest), min(speed, fastest), hardest


def states(name, robot, floating):
    """State 0 is the neutral pose at rest; 1: some pose at rest; 2: without acceleration; 3: without speed; then all."""
    random, result = SplitMix64(name), []
    for index in range(COUNT):
        q, v, a = [], [], []
        if floating:
            q += [random.between(-1.0, 1.0) for _ in range(3)] + random.unit_quaternion()
            v += [random.between(-2.0, 2.0) for _ in range(6)]
            a += [random.between(-5.0, 5.0) for _ in range(6)]
        for joint in robot.coordinates:
            low, high, speed, push = bounds(joint)
            q.append(random.between(low, high))
            v.append(random.between(-speed, speed))
            a.append(random.between(-push, push))
        if index == 0:
            q = ([0.0] * 6 + [1.0] if floating else []) + [0.0] * len(robot.coordinates)
        if index in (0, 1, 3):
            v = [0.0] * len(v)
        if index in (0, 1, 2):
            a = [0.0] * len(a)
        result.append((q, v, a))
    return result
