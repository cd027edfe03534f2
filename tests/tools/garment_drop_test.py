"""tools/garment_drop.py on runs whose drop is known.

Usage: garment_drop_test.py FOLDER_OF_TOOLS
"""
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest

tools = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(tools))
import garment_drop  # noqa: E402

frames, motion_first = 20, 8


def ring(radius, height, count=24):
    return [(radius * math.cos(2 * math.pi * k / count), height, radius * math.sin(2 * math.pi * k / count)) for k in range(count)]


def pc2(path, samples):
    with path.open("wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(samples[0]), 0, 1, len(samples)))
        for x in samples:
            file.write(struct.pack(f"<{3 * len(x)}f", *(c for p in x for c in p)))


def make_run(folder, slide_m):
    """A trunk that goes up and down; trousers that settle by 5 cm in the drape and then slide by slide_m, legs by twice as much."""
    trunk = [p for k in range(30) for p in ring(0.15, 0.5 + 0.02 * k)]
    waist, leg = ring(0.155, 1.0), ring(0.155, 0.6)
    lines = ["o trousers"] + [f"v {x} {y} {z}" for x, y, z in waist + leg] + ["vt 0 0"]
    for name, base in (("waist_front", 1), ("waist_back", 13), ("leg", 25)):
        lines.append(f"g {name}")
        lines += [f"f {base + k}/1 {base + k + 1}/1 {base + k + 2}/1" for k in range(22 if name == "leg" else 10)]
    (folder / "cloth.obj").write_text("\n".join(lines) + "\n")
    cloth, body = [], []
    for f in range(frames):
        settled = 0.05 * min(1, f / motion_first)
        slid = slide_m * max(0, f - motion_first) / (frames - 1 - motion_first)
        hop = 0.1 * math.sin(0.7 * max(0, f - motion_first))
        body.append([(x, y + hop, z) for x, y, z in trunk])
        cloth.append([(x, y + hop - settled - slid, z) for x, y, z in waist] + [(x, y + hop - settled - 2 * slid, z) for x, y, z in leg])
    pc2(folder / "cloth.pc2", cloth)
    pc2(folder / "body.pc2", body)
    (folder / "report.json").write_text(json.dumps({"motion": {"first_frame": motion_first}}))


class GarmentDrop(unittest.TestCase):
    def drop(self, slide_m, *arguments, spoil=None):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            make_run(folder, slide_m)
            if spoil:
                spoil(folder)
            command = [sys.executable, str(tools / "garment_drop.py"), name, *arguments]
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
            return done.returncode, done.stdout, done.stderr

    def test_what_moves_with_the_body_does_not_drop(self):
        code, text, _ = self.drop(0, "waist*", "--most", "0.01")
        self.assertEqual(code, 0)
        self.assertRegex(text, r"drop -?0\.00 cm; largest -?0\.00 cm")

    def test_sliding_is_measured_from_the_beginning_of_the_motion(self):
        code, text, _ = self.drop(0.015, "waist*")
        self.assertEqual(code, 0)
        self.assertIn("waist_front, waist_back", text)
        self.assertIn("in frame 8,", text)
        self.assertIn("drop 1.50 cm; largest 1.50 cm, in frame 19", text)

    def test_frames_can_be_chosen(self):
        self.assertIn("drop 5.00 cm", self.drop(0.015, "waist*", "--from", "0", "--to", "8")[1])

    def test_panels_are_chosen_by_name(self):
        self.assertIn("drop 3.00 cm", self.drop(0.015, "leg")[1])
        self.assertIn("drop 1.50 cm", self.drop(0.015, "waist_front,waist_back")[1])

    def test_more_than_asked_for_is_exit_code_1(self):
        self.assertEqual(self.drop(0.015, "waist*", "--most", "1.6")[0], 0)
        self.assertEqual(self.drop(0.015, "waist*", "--most", "1.4")[0], 1)

    def test_a_run_that_cannot_be_read_is_said_in_one_line(self):
        def truncate(name):
            return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:-4])

        for spoil, arguments, words in (
                (None, ["sleeve*"], "there are waist_front, waist_back, leg"),
                (None, ["leg", "--from", "19"], "expected frames"),
                (truncate("cloth.pc2"), ["leg"], "cloth.pc2"),
                (truncate("body.pc2"), ["leg"], "body.pc2"),
                (lambda folder: (folder / "body.pc2").unlink(), ["leg"], "no body"),
                (lambda folder: (folder / "report.json").unlink(), ["leg"], "report.json"),
                (lambda folder: pc2(folder / "cloth.pc2", [ring(1, 1)] * frames), ["leg"], "belong together")):
            code, _, error = self.drop(0, *arguments, spoil=spoil)
            self.assertEqual(code, 3, words)
            self.assertIn(words, error)
            self.assertEqual(len(error.splitlines()), 1, error)

    def test_the_nearest_is_that_of_all_pairs(self):
        draw = random.Random(7).uniform
        targets = [(draw(-1, 1), round(draw(-1, 1), 1), draw(-1, 1)) for _ in range(300)]
        points = [(draw(-1, 1), draw(-1.5, 1.5), draw(-1, 1)) for _ in range(200)]
        plain = [min(range(len(targets)), key=lambda i: (sum((a - b) ** 2 for a, b in zip(p, targets[i])), i)) for p in points]
        self.assertEqual(garment_drop.nearest(points, targets), plain)


if __name__ == "__main__":
    unittest.main()
