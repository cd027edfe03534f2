#!/usr/bin/env bash
# Runs the benchmarks and keeps what they say in bench/results/MACHINE.      bench/record.sh MACHINE [KIND...]
# Options for all of them: OPTIONS="--threads 1 --repeat 3" bench/record.sh ...
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: bench/record.sh MACHINE [KIND...]" >&2; exit 2; }
machine=$1
shift
kinds=("$@")
[ $# -ge 1 ] || kinds=(paper scaling stiffness micro)
read -r -a options <<<"${OPTIONS:-}"
toile=$root/build/release/toile
folder=$root/bench/results/$machine
mkdir -p "$folder"
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

changed=false
[ -z "$(git -C "$root" status --porcelain -- src apps scenes patterns cmake CMakeLists.txt)" ] || changed=true
cat >"$folder/machine.json" <<JSON
{
  "commit": "$(git -C "$root" rev-parse HEAD)",
  "changed_since_commit": $changed,
  "version": "$("$toile" --version)",
  "system": "$(uname -sm)",
  "compiler": "$(c++ --version | head -n 1)",
  "options": "${OPTIONS:-}"
}
JSON
for kind in "${kinds[@]}"; do
  "$toile" bench "$kind" --out "$runs" ${options[@]+"${options[@]}"} || echo "bench $kind: exit code $?" >&2
  [ ! -e "$runs/$kind.json" ] || cp "$runs/$kind.json" "$runs/$kind.csv" "$folder/"
done
