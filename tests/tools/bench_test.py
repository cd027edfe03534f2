"""bench/compare.py pairs two builds and says by how much they differ; bench/quality.py measures the distance between two motions; bench/worn.py
tabulates what stays on.

Usage: bench_test.py FOLDER_OF_BENCH

The builds are stand-ins: scripts that write the report, and the motion, that they are told to.
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

bench = pathlib.Path(sys.argv.pop(1)).resolve()

# Takes 1, 2, 3 ... times `seconds` per frame in its runs, so that every pair has times of its own.
STAND_IN = '''#!{python}
import json, pathlib, struct, sys
words = sys.argv[1:]
out = pathlib.Path(words[words.index("--out") + 1])
out.mkdir(parents=True)
log = pathlib.Path("{log}")
log.write_text((log.read_text() if log.exists() else "") + "{name} ")
k = log.read_text().split().count("{name}")
if {broken}:
    sys.exit("no such scene")
phases = dict.fromkeys(("total", "eval", "cg", "cloth_cloth", "safe_filter", "cloth_solid"), {seconds} * k)
phases.update(body=0, other={seconds})
scene = json.loads(pathlib.Path(words[1]).read_text()) if words[0] == "run" else {{}}
exact = scene.get("solver", {{}}).get("tolerance") == 1e-9
leans = scene.get("world", {{}}).get("gravity_m_per_s2", [0])[0] != 0
shift, speed = (0.003, 1.0) if not exact else ({chance}, 1.0) if leans else (0, {reference_speed})
count = 40
data = struct.pack("<12siiffi", b"POINTCACHE2\\0", 1, 4, 0, 1, count)
for f in range(count):
    for x, z in ((0, 0), (1, 0), (0, 1), (9, 9)):
        data += struct.pack("<3f", x, shift + speed * f / 30, z)
(out / "cloth.pc2").write_bytes(data)
(out / "cloth.obj").write_text("v 0 0 0\\nv 1 0 0\\nv 0 0 1\\nv 9 0 9\\nvt 0 0\\nvt 1 0\\nvt 0 1\\nf 1/1 2/2 3/3\\n")
edges = dict(max=0, last=0, frames=0)
(out / "report.json").write_text(json.dumps(dict(
    frames=count, steps=80, steps_rejected=1, cg_iterations=dict(mean=100), stretch=dict(p99=0.01), verdict="pass",
    state_hash="{name}", seconds_per_frame=phases, motion=None, cloth=dict(vertices=4),
    penetrations=dict(cloth_body_edges=edges, cloth_cloth_edges=edges))))
'''


class WithBuilds(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.folder / "s.json"
        self.scene.write_text(json.dumps({"cloth": [{"grid": {}}]}))

    def build(self, name, seconds=0.1, broken=False, chance=0.0, reference_speed=1.0):
        path = self.folder / name
        path.write_text(STAND_IN.format(python=sys.executable, name=name, log=self.folder / "log", seconds=seconds, broken=broken,
                                        chance=chance, reference_speed=reference_speed))
        path.chmod(0o755)
        return path

    def run_tool(self, tool, *words):
        return subprocess.run([sys.executable, str(bench / tool), *map(str, words)], capture_output=True, text=True)


class Compare(WithBuilds):
    def compare(self, *words):
        return self.run_tool("compare.py", self.build("old", 0.2), self.build("new", 0.1), *words, "--json", self.folder / "c.json")

    def test_takes_the_median_of_the_pairs_ratios(self):
        ended = self.compare("cylinder", "--pairs", 3)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        found = json.loads((self.folder / "c.json").read_text())["scenes"]["cylinder"]
        for of in ("median", "least", "largest"):
            self.assertAlmostEqual(found["ratios"]["total"][of], 0.5)
        self.assertAlmostEqual(found["ratios"]["cg"]["old_s"], 0.4)  # of 0.2, 0.4, 0.6
        self.assertNotIn("body", found["ratios"])  # takes no time
        self.assertIn("other bits", ended.stdout)

    def test_runs_in_turn_and_changes_who_begins(self):
        self.compare("cylinder", "--pairs", 4)
        self.assertEqual((self.folder / "log").read_text().split(), ["old", "new", "new", "old"] * 2)

    def test_a_run_without_a_report_is_named(self):
        ended = self.run_tool("compare.py", self.build("old"), self.build("new", broken=True), "x")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("new demo x: no report, exit code 1: no such scene", ended.stderr)


class Quality(WithBuilds):
    def quality(self, **of):
        ended = self.run_tool("quality.py", self.build("toile", **of), self.scene, "--json", self.folder / "q.json")
        results = self.folder / "q.json"
        return ended, json.loads(results.read_text())["s.json"] if results.exists() else None

    def test_measures_the_distance_and_not_what_no_face_uses(self):
        ended, found = self.quality()
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertAlmostEqual(found["distance_mm"], 3, 4)
        self.assertAlmostEqual(found["kinetic_percent"], 0, 2)

    def test_kinetic_energy_goes_with_the_square(self):
        ended, found = self.quality(reference_speed=0.5)
        self.assertEqual(ended.returncode, 1)
        self.assertAlmostEqual(found["kinetic_percent"], 300, 1)
        self.assertIn("does not hold", ended.stdout)

    def test_what_is_no_farther_apart_than_chance_holds(self):
        ended, found = self.quality(reference_speed=0.99, chance=0.5)
        self.assertGreater(found["distance_mm"], 5)
        self.assertGreater(found["by_chance"][0], found["distance_mm"])
        self.assertEqual(ended.returncode, 0, ended.stdout)

    def test_a_run_without_a_report_is_named(self):
        ended, _ = self.quality(broken=True)
        self.assertEqual(ended.returncode, 2)
        self.assertIn("own: no report, exit code 1: no such scene", ended.stderr)

    def test_says_what_it_cannot_measure(self):
        toile = self.build("toile")
        for words, said in (((toile, self.folder / "gone.json"), "gone.json: expected a scene, got: "),
                            ((self.folder / "no", self.scene), "no: expected a program, got: "),
                            ((toile, self.scene, "--at", 0.001), "--at: expected a frame or more (0.0333 s), got 0.001"),
                            ((toile, self.scene, "--at", 3), "own: expected 92 frames or more, got 40")):
            ended = self.run_tool("quality.py", *words)
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertIn(said, ended.stderr)


# `dress` leaves a report, `verify` answers what the pattern is named after.
WARDROBE = '''#!{python}
import json, pathlib, sys
words = sys.argv[1:]
log = pathlib.Path("{log}")
log.write_text((log.read_text() if log.exists() else "") + words[0] + " ")
if words[0] == "dress":
    if "missing" in words[1]:
        sys.exit("no such pattern")
    out = pathlib.Path(words[words.index("--out") + 1])
    out.mkdir(parents=True, exist_ok=True)
    (out / "report.json").write_text("{{}}")
    sys.exit(0)
name = pathlib.Path(words[1]).name
part = lambda last, worst: dict(last_cm=last, worst_cm=worst)
slip = dict(waist_drop=part(-0.04, 0.3), shoulder_slip=None, loops=[dict(holds=False, **part(9, 9)), dict(holds=True, **part(0.5, {worst}))])
if name == "blocked":
    slip = None
fell = name == "fell"
print(json.dumps(dict(verdict="fail" if fell or slip is None else "pass", reasons=["slid_off"] if fell else ["seam_blocked"] if slip is None else [], slip=slip)))
sys.exit(5 if fell or slip is None else 0)
'''


class Worn(WithBuilds):
    def worn(self, *garments, worst=0.7, more=()):
        program = self.folder / "wardrobe"
        program.write_text(WARDROBE.format(python=sys.executable, log=self.folder / "worn.log", worst=worst))
        program.chmod(0o755)
        return subprocess.run([sys.executable, str(bench / "worn.py"), str(program), *garments, "--out", str(self.folder / "runs"), *more],
                              capture_output=True, text=True)

    def test_a_row_has_what_holds_the_garment_and_no_minus_before_a_zero(self):
        done = self.worn("p/skirt.json=b.obj", "p/blocked.json=b.obj")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| skirt | pass | 0.5, 0.7 | 0.0, 0.3 | - |", done.stdout)
        self.assertIn("| blocked | seam_blocked | - | - | - |", done.stdout)

    def test_what_is_there_is_not_run_again_but_measured_again(self):
        self.worn("p/skirt.json=b.obj")
        self.worn("p/skirt.json=b.obj")
        self.assertEqual((self.folder / "worn.log").read_text().split(), ["dress", "verify", "verify"])
        self.worn("p/skirt.json=other.obj")
        self.assertEqual((self.folder / "worn.log").read_text().split()[3:], ["dress", "verify"])

    def test_what_slid_is_exit_code_1(self):
        self.assertEqual(self.worn("p/fell.json=b.obj").returncode, 1)
        self.assertEqual(self.worn("p/skirt.json=b.obj", worst=2.5).returncode, 1)
        self.assertEqual(self.worn("p/skirt.json=b.obj", worst=2.5, more=("--most-cm", "3")).returncode, 0)

    def test_what_cannot_run_is_exit_code_2(self):
        done = self.worn("p/missing.json=b.obj")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no such pattern", done.stderr)
        self.assertEqual(self.worn("p/skirt.json").returncode, 2)


if __name__ == "__main__":
    unittest.main()
