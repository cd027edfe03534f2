#!/usr/bin/env python3
"""How far panels slide down the body while it moves: "do the trousers stay up?"

Usage: garment_drop.py RUN PANELS [--from FRAME] [--to FRAME] [--most CM]

RUN is the directory of a finished run with a body, PANELS a pattern of panel names (g in cloth.obj) such as 'waist*'; several are
separated by commas.  Printed is, in cm, the mean height of their vertices above the points of the body that were nearest to them
in the first frame, then and in the last one, and by how much it has become less.  Frames are samples of cloth.pc2; without --from
and --to they are the first and the last of the motion, or of the run when there is none.  With --most the exit code is 1 when the
drop in the last frame is larger.

Heights are relative to the body's own points, so a body that bends its knees does not drop its trousers.  Easily got wrong: the
first frame is not frame 0.  During the drape a garment settles, and that is no sliding.
"""
import argparse
import bisect
import fnmatch
import json
import pathlib
import struct
import sys


class BadRun(Exception):
    pass


class Cache:
    """Frames of a PC2 file, read one at a time."""

    def __init__(self, path):
        self.path = path
        self.data = path.read_bytes()
        if len(self.data) < 32 or self.data[:12] != b"POINTCACHE2\0":
            raise BadRun(f"{path}: no PC2 file")
        self.points, self.samples = struct.unpack_from("<i", self.data, 16)[0], struct.unpack_from("<i", self.data, 28)[0]
        if len(self.data) != 32 + 12 * self.points * self.samples:
            raise BadRun(f"{path}: {self.points} points and {self.samples} samples promised, but it has {len(self.data)} bytes")

    def frame(self, number):
        floats = struct.unpack_from(f"<{3 * self.points}f", self.data, 32 + 12 * self.points * number)
        return list(zip(floats[0::3], floats[1::3], floats[2::3]))


def panel_vertices(path, patterns):
    """Indices of the vertices of the faces in groups that match, and the names of these groups."""
    vertices, names, group = set(), {}, ""
    seen = []
    for line in path.read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "g":
            group = " ".join(words[1:])
            if group not in seen:
                seen.append(group)
        elif words[0] == "f" and any(fnmatch.fnmatchcase(group, p) for p in patterns):
            names[group] = True
            vertices.update(int(word.split("/")[0]) - 1 for word in words[1:])
    if not vertices:
        raise BadRun(f"{path}: no panel is called {','.join(patterns)}; there are {', '.join(seen)}")
    return sorted(vertices), list(names)


def nearest(points, targets):
    """Of each point the index of the nearest target, the lowest of equally near ones."""
    by_height = sorted(range(len(targets)), key=lambda i: (targets[i][1], i))
    heights = [targets[i][1] for i in by_height]
    found = []
    for x, y, z in points:
        best, least = -1, float("inf")
        up = bisect.bisect_left(heights, y)
        down = up - 1
        while up < len(heights) or down >= 0:
            above = heights[up] - y if up < len(heights) else float("inf")
            below = y - heights[down] if down >= 0 else float("inf")
            if min(above, below) ** 2 > least:
                break
            if above <= below:
                i, up = by_height[up], up + 1
            else:
                i, down = by_height[down], down - 1
            a, b, c = targets[i]
            distance = (a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2
            if distance < least or (distance == least and i < best):
                best, least = i, distance
        found.append(best)
    return found


def heights_of(cloth, body, vertices, first, last):
    """Mean height of the vertices above their points of the body, m, per frame from first to last."""
    start, body_start = cloth.frame(first), body.frame(first)
    below = nearest([start[i] for i in vertices], body_start)
    heights = []
    for number in range(first, last + 1):
        x, b = cloth.frame(number), body.frame(number)
        heights.append(sum(x[i][1] - b[j][1] for i, j in zip(vertices, below)) / len(vertices))
    return heights


def measure(run, patterns, first=None, last=None):
    report = json.loads((run / "report.json").read_text())
    vertices, names = panel_vertices(run / "cloth.obj", patterns)
    if not (run / "body.pc2").exists():
        raise BadRun(f"{run}: the run has no body")
    cloth, body = Cache(run / "cloth.pc2"), Cache(run / "body.pc2")
    if vertices[-1] >= cloth.points or body.samples != cloth.samples or body.points < 1:
        raise BadRun(f"{run}: cloth.obj, cloth.pc2 and body.pc2 do not belong together")
    motion = report.get("motion") or {}
    first = motion.get("first_frame", 0) if first is None else first
    last = cloth.samples - 1 if last is None else last
    if not 0 <= first < last < cloth.samples:
        raise BadRun(f"{run}: expected frames 0 <= from < to < {cloth.samples}, got {first} and {last}")
    return names, first, last, heights_of(cloth, body, vertices, first, last)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("panels")
    parser.add_argument("--from", dest="first", type=int)
    parser.add_argument("--to", dest="last", type=int)
    parser.add_argument("--most", type=float, metavar="CM")
    options = parser.parse_args()
    try:
        names, first, last, heights = measure(options.run, options.panels.split(","), options.first, options.last)
    except (BadRun, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 3
    drops = [100 * (heights[0] - h) for h in heights]
    worst = max(range(len(drops)), key=lambda k: drops[k])
    print(f"{', '.join(names)}: {100 * heights[0]:.2f} cm above the body's points in frame {first}, {100 * heights[-1]:.2f} in frame {last}")
    print(f"drop {drops[-1]:.2f} cm; largest {drops[worst]:.2f} cm, in frame {first + worst}")
    return 1 if options.most is not None and drops[-1] > options.most else 0


if __name__ == "__main__":
    sys.exit(main())
