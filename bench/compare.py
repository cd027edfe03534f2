#!/usr/bin/env python3
"""Is one build faster than another?  Runs both in turn and compares pair by pair: other work on the machine slows both.

    bench/compare.py OLD_TOILE NEW_TOILE [SCENE ...] [--pairs 5] [--threads 1] [--busy N] [--json FILE]

SCENE is a demo's name (cylinder, if none is given) or a scene's file.  Pairs are run as old new, new old, old new ...  For the whole
frame and each of its phases: the median of the ratios new / old, and their least and largest; a ratio whose range includes 1
is no evidence.  Beside them results that do not depend on the machine: steps, iterations, stretch, the verdict, the state's hash.
--busy N keeps N cores loaded by other processes meanwhile.  Times are the report's: those of the steps, without meshing and writing.
Exit code 1 when a run writes no report; a run whose verdict is fail is compared like any other.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

PHASES = ("total", "eval", "cg", "cloth_cloth", "safe_filter", "cloth_solid", "body", "other")


def run(toile, scene, threads, folder):
    words = ["run", scene] if pathlib.Path(scene).suffix == ".json" else ["demo", scene]
    try:
        ended = subprocess.run([toile, *words, "--threads", str(threads), "--no-preview", "--quiet", "--out", str(folder)],
                               capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"compare: {toile}: expected a program, got: {error.strerror}")
    report = folder / "report.json"
    if not report.exists():
        sys.exit(f"compare: {toile} {' '.join(words)}: no report, exit code {ended.returncode}: {ended.stderr.strip()}")
    return json.loads(report.read_text())


def work(report):
    """The results that are the same on every machine."""
    return {"frames": report["frames"], "steps": report["steps"], "steps_rejected": report["steps_rejected"],
            "cg_iterations_per_step": report["cg_iterations"]["mean"], "stretch_p99": report["stretch"]["p99"],
            "verdict": report["verdict"], "state_hash": report["state_hash"]}


def ratios(pairs):
    """pairs: [(old report, new report)].  {phase: {median, least, largest, old_s, new_s}} of the phases that take any time."""
    found = {}
    for phase in PHASES:
        times = [(old["seconds_per_frame"][phase], new["seconds_per_frame"][phase]) for old, new in pairs]
        if any(old <= 0 or new <= 0 for old, new in times):
            continue
        each = [new / old for old, new in times]
        found[phase] = {"median": statistics.median(each), "least": min(each), "largest": max(each),
                        "old_s": statistics.median(old for old, _ in times),
                        "new_s": statistics.median(new for _, new in times)}
    return found


def show(scene, result):
    old, new = result["old"], result["new"]
    print(f"{scene}: {'same bits' if old['state_hash'] == new['state_hash'] else 'other bits'}")
    for which in ("old", "new"):
        w = result[which]
        print(f"  {which}: {w['frames']} frames, {w['steps']} steps ({w['steps_rejected']} rejected), {w['cg_iterations_per_step']:.0f} "
              f"iterations per step, stretch p99 {100 * w['stretch_p99']:.2f} %, {w['verdict']}")
    print(f"  {'s per frame':<14}{'old':>10}{'new':>10}{'new / old':>11}   of {result['pairs']} pairs")
    for phase, r in result["ratios"].items():
        print(f"  {phase:<14}{r['old_s']:>10.4f}{r['new_s']:>10.4f}{r['median']:>11.3f}   {r['least']:.3f} to {r['largest']:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--busy", type=int, default=0, metavar="N")
    parser.add_argument("--json", metavar="FILE")
    of = parser.parse_args()
    for name, least in (("pairs", 1), ("busy", 0)):
        if getattr(of, name) < least:
            parser.error(f"--{name}: expected {least} or more, got {getattr(of, name)}")
    results = {"threads": of.threads, "busy": of.busy, "load_before": os.getloadavg()[0], "scenes": {}}
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(of.busy)]
    try:
        with tempfile.TemporaryDirectory() as folder:
            for scene in of.scenes or ["cylinder"]:
                pairs = []
                for k in range(of.pairs):
                    reports = {}
                    for which in ("old", "new") if k % 2 == 0 else ("new", "old"):
                        out = pathlib.Path(folder) / f"{len(results['scenes'])}-{k}-{which}"
                        reports[which] = run(getattr(of, which), scene, of.threads, out)
                    pairs.append((reports["old"], reports["new"]))
                result = {"pairs": len(pairs), "old": work(pairs[0][0]), "new": work(pairs[0][1]), "ratios": ratios(pairs)}
                results["scenes"][scene] = result
                show(scene, result)
    finally:
        for other in others:
            other.kill()
    if of.json:
        pathlib.Path(of.json).write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
