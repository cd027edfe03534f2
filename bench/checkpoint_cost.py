#!/usr/bin/env python3
"""Compares the times of two builds of toile on the cylinder, in pairs of runs: checkpoint_cost.py OLD NEW [PAIRS]."""
import json
import statistics
import subprocess
import sys
import tempfile


def seconds(program, threads, folder):
    out = folder + "/run"
    subprocess.run([program, "demo", "cylinder", "--threads", str(threads), "--out", out, "--no-preview", "--quiet"],
                   check=True)
    with open(out + "/report.json", encoding="utf-8") as report:
        result = json.load(report)
    return result["seconds_total"], result["state_hash"]


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    old, new, pairs = sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) == 4 else 9
    for threads in (1, 2):
        times = {old: [], new: []}
        for _ in range(pairs):
            for program in (old, new):
                with tempfile.TemporaryDirectory() as folder:
                    times[program].append(seconds(program, threads, folder))
        if len({state for runs in times.values() for _, state in runs}) != 1:
            sys.exit("the two programs end with other bits")
        before, after = [s for s, _ in times[old]], [s for s, _ in times[new]]
        ratios = sorted(b / a for a, b in zip(before, after))
        print(f"{threads} thread(s): {statistics.median(before):.3f} s -> {statistics.median(after):.3f} s, ratio "
              f"median {statistics.median(ratios):.4f}, of the fastest {min(after) / min(before):.4f}, "
              f"all {ratios[0]:.3f} to {ratios[-1]:.3f}")


main()
