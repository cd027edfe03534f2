#!/usr/bin/env python3
"""Writes a point cache in which a body sways and twists: a motion for bodies that have no skeleton.

    tools/sway_twist.py BODY.obj MOTION.pc2 [--seconds 3] [--fps 30] [--twist-deg 25] [--sway-m 0.04] [--period-s 1.5]

Every horizontal slice turns about the body's vertical axis and moves sideways as a whole,
    angle(y, t) = twist s(h) sin(2 pi t / T) r(t),   shift(y, t) = sway s(h) sin(pi t / T) r(t),
with h from 0 at the floor to 1 at the crown, s(h) = 3 h^2 - 2 h^3, and r(t) a smooth start over the first half second.
Slices stay apart from each other, so a body that does not cross itself never will.  The first sample is the body as it is.

Vertices keep the order and the unit of the OBJ file.  Needs nothing but Python.
"""
import argparse
import math
import struct
import sys


def read_vertices(path):
    vertices = []
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, 1):
            if not line.startswith("v "):
                continue
            try:
                vertices.append(tuple(float(word) for word in line.split()[1:4]))
                if len(vertices[-1]) != 3:
                    raise ValueError
            except ValueError:
                sys.exit(f"{path}:{number}: vertex: expected three numbers, got {line.strip()!r}")
    if not vertices:
        sys.exit(f"{path}: expected vertices, got none")
    return vertices


def smooth(x):
    x = min(max(x, 0.0), 1.0)
    return x * x * (3 - 2 * x)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("body")
    parser.add_argument("motion")
    parser.add_argument("--seconds", type=float, default=3)
    parser.add_argument("--fps", type=float, default=30)
    parser.add_argument("--twist-deg", type=float, default=25)
    parser.add_argument("--sway-m", type=float, default=0.04, help="in the unit of the file")
    parser.add_argument("--period-s", type=float, default=1.5)
    options = parser.parse_args()
    if options.seconds < 0 or options.fps <= 0 or options.period_s <= 0:
        sys.exit("expected --seconds >= 0, --fps > 0 and --period-s > 0")

    vertices = read_vertices(options.body)
    low = min(y for _, y, _ in vertices)
    height = max(y for _, y, _ in vertices) - low or 1.0
    middle = [sum(v[k] for v in vertices) / len(vertices) for k in range(3)]
    samples = round(options.seconds * options.fps) + 1
    with open(options.motion, "wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(vertices), 0.0, 1.0, samples))
        for k in range(samples):
            t = k / options.fps
            start = smooth(t / 0.5)
            turn = math.radians(options.twist_deg) * math.sin(2 * math.pi * t / options.period_s) * start
            shift = options.sway_m * math.sin(math.pi * t / options.period_s) * start
            words = []
            for x, y, z in vertices:
                share = smooth((y - low) / height)
                c, s = math.cos(turn * share), math.sin(turn * share)
                u, w = x - middle[0], z - middle[2]
                words += (middle[0] + c * u + s * w + shift * share, y, middle[2] - s * u + c * w)
            file.write(struct.pack(f"<{len(words)}f", *words))


if __name__ == "__main__":
    main()
