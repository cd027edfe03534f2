"""tools/sway_twist.py writes a cache that starts where the body is, keeps slices apart and turns them as it says.

Usage: sway_twist_test.py FOLDER_OF_TOOLS
"""
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

tools = pathlib.Path(sys.argv.pop(1)).resolve()


def run(*words):
    return subprocess.run([sys.executable, str(tools / "sway_twist.py"), *map(str, words)], capture_output=True, text=True)


class SwayTwist(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.body = [(0.1, 0, 0), (-0.1, 0, 0), (0, 0, 0.1), (0, 0, -0.1), (0.1, 1, 0), (-0.1, 1, 0), (0, 1, 0.1), (0, 1, -0.1)]
        (self.folder / "b.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in self.body) + "f 1 2 3\n")

    def samples(self, *words):
        ended = run(self.folder / "b.obj", self.folder / "m.pc2", *words)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        data = (self.folder / "m.pc2").read_bytes()
        magic, version, points, _, _, count = struct.unpack("<12siiffi", data[:32])
        self.assertEqual((magic, version, points), (b"POINTCACHE2\0", 1, 8))
        self.assertEqual(len(data), 32 + 12 * points * count)
        numbers = struct.unpack(f"<{3 * points * count}f", data[32:])
        return [[numbers[3 * (k * points + i):3 * (k * points + i) + 3] for i in range(points)] for k in range(count)]

    def test_begins_where_the_body_is(self):
        for p, q in zip(self.samples()[0], self.body):
            self.assertLess(math.dist(p, q), 1e-6)

    def test_turns_the_crown_and_leaves_the_floor(self):
        samples = self.samples("--seconds", 1, "--fps", 40, "--period-s", 2, "--twist-deg", 30, "--sway-m", 0.05)
        self.assertEqual(len(samples), 41)
        at = samples[20]  # t = 0.5 s: a quarter of the period, the start is over
        for p, q in zip(at[:4], self.body[:4]):
            self.assertLess(math.dist(p, q), 1e-6)
        shift = 0.05 * math.sin(math.pi * 0.25)
        self.assertAlmostEqual(at[4][0], 0.1 * math.cos(math.radians(30)) + shift, 6)
        self.assertAlmostEqual(at[4][2], -0.1 * math.sin(math.radians(30)), 6)
        self.assertTrue(all(p[1] == 1 for p in at[4:]))

    def test_names_what_is_wrong(self):
        (self.folder / "b.obj").write_text("v 0 0 0\nv 1 x 2\n")
        ended = run(self.folder / "b.obj", self.folder / "m.pc2")
        self.assertNotEqual(ended.returncode, 0)
        self.assertIn("b.obj:2: vertex: expected three numbers", ended.stderr)


if __name__ == "__main__":
    unittest.main()
