#!/usr/bin/env python3
"""Our own garments, each dressed on the mannequin it is drawn for, run with the program as a user would.

Usage: garments_test.py TOILE PATTERNS_FOLDER

Ends still, p99 stretch outside elastic at most 5 %, largest at most 10 % (the verdict); no crossing in any frame; sewn where the pattern
hangs (no shift); and what is held by elastic is where it was a second before.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

# pattern, body, edge length (cm) of the counts in docs/patterns.md, height of the upper edge (m): least and most
GARMENTS = (("man_shirt", "man", "1.39", 1.45, 1.60), ("man_pants", "man", "1.163", 1.02, 1.12), ("man_pants", "man", "1.5", 1.02, 1.12),
            ("short_skirt", "dancer", "1.521", 1.03, 1.12), ("long_skirt", "dancer", "2.1", 1.03, 1.12),
            ("blouse", "dancer", "1.4", 1.40, 1.50), ("slip", "woman", "1.2", 1.38, 1.50))


def frames(path):
    data = path.read_bytes()
    _, points, _, _, samples = struct.unpack_from("<iiffi", data, 12)
    for k in range(samples):
        yield struct.unpack_from(f"<{3 * points}f", data, 32 + 12 * points * k)


def main():
    toile, patterns = sys.argv[1], pathlib.Path(sys.argv[2])
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for name, body, resolution, low, high in GARMENTS:
            out = pathlib.Path(folder) / name
            done = subprocess.run([toile, "dress", str(patterns / (name + ".json")), "--body", body, "--resolution", resolution, "--fabric",
                                   "cotton", "--quiet", "--no-preview", "--out", str(out)], capture_output=True, text=True)
            if done.returncode != 0:
                faults.append(f"{name}: exit {done.returncode}: {done.stderr.strip()}")
                continue
            report = json.loads((out / "report.json").read_text())
            print(name, report["ended"], report["frames"], report["stretch"], report["penetrations"])
            if report["ended"] != "still" or report["verdict"] != "pass":
                faults.append(f"{name}: {report['ended']}, {report['reasons']}")
            for what, crossings in report["penetrations"].items():
                if crossings["max"] > 0:
                    faults.append(f"{name}: {crossings['max']} {what} in one of {crossings['frames']} frames")
            if any(report["sewing"]["shift_m"]):
                faults.append(f"{name}: moved by {report['sewing']['shift_m']} m to be sewn")
            tops = [max(f[1::3]) for f in frames(out / "cloth.pc2")]
            print(f"{name}: upper edge at {tops[-1]:.3f} m, a second before at {tops[max(0, len(tops) - 31)]:.3f} m")
            if not low < tops[-1] < high:
                faults.append(f"{name}: its upper edge is at {tops[-1]:.3f} m")
            if abs(tops[-1] - tops[max(0, len(tops) - 31)]) > 0.01:
                faults.append(f"{name}: it slides")
    for fault in faults:
        print("FAILED", fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
