#!/usr/bin/env bash
# Runs a demo with two builds in turn, on one thread, and prints the least time per frame of each and their ratio: other work on
# the machine hits both.      bench/compare.sh OLD_TOILE NEW_TOILE [DEMO=cylinder] [TIMES=3]
set -euo pipefail
old=$1 new=$2 demo=${3:-cylinder} times=${4:-3}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for ((k = 0; k < times; ++k)); do
  for which in old new; do
    "${!which}" demo "$demo" --threads 1 --no-preview --quiet --out "$out/$which$k" || true
  done
done
python3 - "$out" "$times" <<'PYTHON'
import json, sys
out, times = sys.argv[1], int(sys.argv[2])
least = {}
for which in ("old", "new"):
    reports = [json.load(open(f"{out}/{which}{k}/report.json")) for k in range(times)]
    least[which] = min(r["seconds_per_frame"]["total"] for r in reports)
    r = reports[0]
    print(f'{which}: {least[which]:.4f} s per frame, {r["steps"]} steps, {r["cg_iterations"]["mean"]:.0f} CG iterations '
          f'per step, stretch p99 {100 * r["stretch"]["p99"]:.2f} %, {r["verdict"]}')
print(f'new / old: {least["new"] / least["old"]:.3f}')
PYTHON
