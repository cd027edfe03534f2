"""tools/slurm_batch.sh, with a stand-in for Slurm that runs each task at once.

Usage: slurm_batch_test.py SCRIPT TOILE
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

script, toile = (pathlib.Path(word).resolve() for word in (sys.argv.pop(1), sys.argv.pop(1)))

# Keeps its words, runs the script for every number of --array, and answers with a number and, as federated clusters do, a name.
sbatch = """#!/bin/sh
echo "$@" >> "$FAKE/calls"
numbers=-1
while [ "${1#--}" != "$1" ]; do
  case "$1" in
    --array=*) numbers=$(seq 0 "${1#--array=0-}") ;;
    --dependency=*) test "$1" = --dependency=afterany:42 || exit 1 ;;
  esac
  shift
done
cp "$1" "$FAKE/spooled"   # Slurm runs a copy
shift
for number in $numbers; do
  if [ "$number" -ge 0 ]; then export SLURM_ARRAY_TASK_ID="$number"; fi
  bash "$FAKE/spooled" "$@" >> "$FAKE/output" 2>&1 || echo "ended with $?" >> "$FAKE/calls"
done
echo "42;cluster"
"""
scene = {"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.06}}], "time": {"seconds": 0.1}}


class Slurm(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "sbatch").write_text(sbatch)
        (self.folder / "sbatch").chmod(0o755)
        (self.folder / "s.json").write_text(json.dumps(scene))
        jobs = [{"defaults": {"thumbnail": False}}] + [{"id": f"job-{k}", "run": "s.json" if k != 3 else "none.json"} for k in range(6)]
        (self.folder / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs))
        self.addCleanup(self.scratch.cleanup)

    def call(self, *words):
        env = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}", "FAKE": str(self.folder), "TOILE": str(toile)}
        env.pop("SLURM_ARRAY_TASK_ID", None)
        return subprocess.run(["bash", str(script), *words], cwd=self.folder, env=env, capture_output=True, text=True, check=False)

    def verdicts(self, out):
        return [json.loads(line) for line in (self.folder / out / "verdicts.jsonl").read_text().splitlines()]

    def test_the_array_has_every_line_and_the_hashes_of_a_batch(self):
        done = self.call("jobs.jsonl", "slurm", "3", "--time=1:00:00")
        self.assertEqual(done.returncode, 0, done.stderr)
        calls = (self.folder / "calls").read_text()
        self.assertIn("--array=0-2", calls)  # 7 lines, 3 in a task
        self.assertIn("--time=1:00:00", calls)
        self.assertEqual(calls.count("ended with"), 1, calls)  # the last one, which tells that not all pass
        subprocess.run([toile, "batch", "jobs.jsonl", "--out", "here", "--quiet"], cwd=self.folder, capture_output=True, check=False)
        hashes = [(one["id"], one["verdict"], one["state_hash"]) for one in self.verdicts("here")]
        self.assertEqual([(one["id"], one["verdict"], one["state_hash"]) for one in self.verdicts("slurm")], hashes)
        self.assertEqual(len(hashes), 6)

    def test_what_cannot_be_meant_is_refused(self):
        for words in (["jobs.jsonl"], ["jobs.jsonl", "out", "none"], ["jobs.jsonl", "out", "0"], ["nowhere.jsonl", "out"]):
            self.assertNotEqual(self.call(*words).returncode, 0, words)
        self.assertFalse((self.folder / "calls").exists())


if __name__ == "__main__":
    unittest.main()
