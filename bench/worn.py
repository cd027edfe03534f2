#!/usr/bin/env python3
"""Do garments stay on?  Dresses patterns, lets their bodies sway, and reports how far each garment has moved against its body.

    bench/worn.py TOILE PATTERN.json=BODY.obj ... [--motion sway] [--seconds 2] [--resolution 2] [--time-limit 240] [--out FOLDER]
                  [--most-cm 2] [--threads 1] [--json FILE]

A body is an OBJ file or a mannequin's name.  One row for each pattern, from `slip` as `toile verify` measures it (docs/theory/verify.md#slip), in cm:

    top edge    drop of the edge that holds the garment, if it does not lie on the shoulders: in the last frame, at worst
    waist       drop of the cloth at the waist                       shoulders   slip of the cloth on them

A dash: the garment has no such part.  Runs lie in --out, by the name of the pattern; an existing run of the same command is not repeated.
Exit code 1 when a garment that passes moved farther than --most-cm or one has `slid_off`, 2 when a run or its audit failed.
"""
import argparse
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile


def run(toile, pattern, body, options, folder):
    out = folder / pathlib.Path(pattern).stem
    words = [toile, "dress", pattern, "--body", body, "--motion", options.motion, "--seconds", str(options.seconds), "--resolution",
             str(options.resolution), "--time-limit", str(options.time_limit), "--threads", str(options.threads), "--no-preview", "--quiet",
             "--out", str(out)]
    asked, report = out.with_suffix(".command"), out / "report.json"
    if not (report.exists() and asked.exists() and asked.read_text() == shlex.join(words)):
        ended = subprocess.run(words, capture_output=True, text=True)
        if ended.returncode not in (0, 5):
            print(f"worn: {pattern}: exit code {ended.returncode}: {ended.stderr.strip()}", file=sys.stderr)
            sys.exit(2)
        asked.write_text(shlex.join(words))
    judged = subprocess.run([toile, "verify", str(out), "--json"], capture_output=True, text=True)
    if judged.returncode not in (0, 5):
        print(f"worn: {out}: exit code {judged.returncode}: {judged.stderr.strip()}", file=sys.stderr)
        sys.exit(2)
    return json.loads(judged.stdout)


def row(report):
    """Verdict, and (last, worst) in cm of each of the three; None where the garment has no such part."""
    slip = report.get("slip")
    holding = [loop for loop in slip["loops"] if loop["holds"]] if slip else []
    parts = [max(holding, key=lambda loop: loop["worst_cm"]) if holding else None, slip and slip["waist_drop"], slip and slip["shoulder_slip"]]
    verdict = report["verdict"] if report["verdict"] == "pass" else ", ".join(report["reasons"])
    return verdict, [(part["last_cm"], part["worst_cm"]) if part else None for part in parts]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("toile")
    parser.add_argument("garments", nargs="+", metavar="PATTERN=BODY")
    parser.add_argument("--motion", default="sway")
    parser.add_argument("--seconds", type=float, default=2)
    parser.add_argument("--resolution", type=float, default=2)
    parser.add_argument("--time-limit", type=float, default=240)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--most-cm", type=float, default=2)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    pairs = [garment.partition("=") for garment in options.garments]
    for pattern, equals, body in pairs:
        if not equals or not pattern or not body:
            parser.error(f"expected PATTERN=BODY, got {pattern + equals + body!r}")

    faults, table = 0, {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.out or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        print("| garment | verdict | top edge | waist | shoulders |\n|---|---|---|---|---|")
        for pattern, _, body in pairs:
            verdict, parts = row(run(options.toile, pattern, body, options, folder))
            name = pathlib.Path(pattern).stem
            table[name] = {"verdict": verdict, "top_edge_cm": parts[0], "waist_cm": parts[1], "shoulders_cm": parts[2]}
            words = ["-" if part is None else ", ".join(f"{round(cm, 1) + 0.0:.1f}" for cm in part) for part in parts]
            print(f"| {name} | {verdict} | {' | '.join(words)} |", flush=True)
            moved = any(part is not None and part[1] > options.most_cm for part in parts)
            faults += "slid_off" in verdict or (verdict == "pass" and moved)
    if options.json:
        options.json.write_text(json.dumps(table, indent=2) + "\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
