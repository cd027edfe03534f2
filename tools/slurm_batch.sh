#!/usr/bin/env bash
# Runs a batch (docs/howto/batch.md) as an array of Slurm: some lines of the job file in each task, and a last job that collects the verdicts.
#
# Usage: slurm_batch.sh JOBS.jsonl OUT [LINES [SBATCH_OPTION...]]
#   LINES          of the file in a task (100); a task runs as many at a time as it has CPUs (--cpus-per-task)
#   SBATCH_OPTION  for the tasks, such as --time=4:00:00 --cpus-per-task=8 --mem-per-cpu=2G
#
# The program is the `toile` in PATH, or $TOILE.  Program, job file and OUT are seen by all nodes under the same paths.  Called again with the same
# words, it runs what is not done.
set -euo pipefail
toile=${TOILE:-toile}

if [ "${1:-}" = --task ]; then
  # JOBS OUT LINES; a run that fails is a verdict, and no failure of the task.
  first=$((SLURM_ARRAY_TASK_ID * $4 + 1))
  code=0
  "$toile" batch "$2" --out "$3" --lines "$first-$((first + $4 - 1))" --jobs "${SLURM_CPUS_PER_TASK:-1}" --quiet || code=$?
  [ "$code" -eq 5 ] && exit 0
  exit "$code"
fi
if [ "${1:-}" = --collect ]; then
  exec "$toile" batch "$2" --out "$3" --collect
fi

usage() {
  echo "usage: slurm_batch.sh JOBS.jsonl OUT [LINES [SBATCH_OPTION...]]" >&2
  exit 2
}
[ $# -ge 2 ] || usage
jobs=$(realpath -e "$1")
out=$(realpath -m "$2")
lines=${3:-100}
[[ $lines =~ ^[1-9][0-9]*$ ]] || usage
shift $(($# < 3 ? $# : 3))
all=$(grep -c '' "$jobs")
last=$(((all + lines - 1) / lines - 1))
mkdir -p "$out.log"
script=$(realpath "$0")
array=$(sbatch --parsable --job-name=toile --cpus-per-task=1 "$@" --array="0-$last" --output="$out.log/%a.txt" "$script" --task "$jobs" "$out" "$lines")
array=${array%%;*} # with clusters their name follows
sbatch --job-name=toile-collect --dependency="afterany:$array" --output="$out.log/collect.txt" "$script" --collect "$jobs" "$out"
