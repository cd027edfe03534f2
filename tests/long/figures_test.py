#!/usr/bin/env python3
"""The figures that the README's promises rest on, run with the program as a user would.

Usage: figures_test.py TOILE DATA_FOLDER      DATA_FOLDER holds bodies and patterns of others; exit 77 where it is absent.

Every garment: no crossing with itself in any frame, none with the body in the last, p99 stretch at most 3 %, largest at most 10 %,
still, and the same state_hash on 1 and 2 threads.  What does not fit is refused by the name of its seams.
"""
import json
import pathlib
import subprocess
import sys
import tempfile


def run(toile, out, *arguments):
    done = subprocess.run([toile, *arguments, "--no-preview", "--quiet", "--out", str(out)], capture_output=True, text=True)
    report = out / "report.json"
    return done.returncode, json.loads(report.read_text()) if report.exists() else None, done.stderr


def judge_garment(name, report):
    faults = []
    crossings = report["penetrations"]
    for what, value, most in (
            ("edges through the body in the last frame", crossings["cloth_body_edges"]["last"], 0),
            ("edges through the cloth in any frame", crossings["cloth_cloth_edges"]["max"], 0),
            ("p99 stretch", report["stretch"]["p99"], 0.03),
            ("largest stretch", report["stretch"]["max"], 0.10)):
        print(f"{name}: {what} {value:.4g} (at most {most})")
        if value > most:
            faults.append(f"{name}: {what} is {value}")
    if report["ended"] != "still":
        faults.append(f"{name}: ended {report['ended']}, not still")
    return faults


def main():
    toile, data = sys.argv[1], pathlib.Path(sys.argv[2])
    source = pathlib.Path(__file__).resolve().parents[2]
    patterns, body = data / "patterns", data / "bodies/garmentcode/mean_all.obj"
    if not body.exists():
        print(f"skipped: {data} is not there")
        return 77
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        shirt = [str(patterns / "garmentcode/shirt_mean_specification.json"), "--body", str(body), "--resolution", "1"]
        hashes = []
        for threads in ("1", "2"):
            code, report, error = run(toile, out / f"shirt{threads}", "dress", *shirt, "--threads", threads)
            if report is None:
                faults.append(f"shirt: exit {code}: {error}")
                continue
            faults += judge_garment(f"shirt, {threads} thread(s)", report)
            hashes.append(report["state_hash"])
        if len(set(hashes)) != 1:
            faults.append(f"shirt: state_hash differs between thread counts: {hashes}")
        for fabric, resolution in (("cotton", "1"), ("cotton", "2"), ("silk", "1"), ("wool", "1")):
            code, report, error = run(toile, out / f"tshirt_{fabric}_{resolution}", "dress", str(source / "patterns/tshirt.json"), "--body",
                                      "mannequin", "--fabric", fabric, "--resolution", resolution)
            faults += judge_garment(f"T-shirt in {fabric} at {resolution} cm", report) if report else [f"T-shirt: exit {code}: {error}"]
        tee = [str(patterns / "garment_pattern_generator/tee.json"), "--body", str(body)]
        code, report, error = run(toile, out / "tee", "dress", *tee)
        if code != 5 or not report or report["ended"] != "seam_blocked" or "seam back.5 - front.3" not in error:
            faults.append(f"a tee that is too small: exit {code}, {error}")
    for fault in faults:
        print("FAILED", fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
