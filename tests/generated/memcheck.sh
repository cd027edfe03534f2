#!/usr/bin/env bash
# 60 generated scenes under valgrind's memcheck: nothing may be read that nobody wrote.  Exit code 77, skipped, without valgrind.
set -euo pipefail
generated=$1 toile=$2
if ! command -v valgrind >/dev/null; then
  echo "skipped: no valgrind here (Debian: apt-get install valgrind)"
  exit 77
fi
# Every third of the scenes that have all pairs, then some by chance.
"$generated" --program "$toile" --memcheck valgrind --first 0 --every 3 --count 60 --jobs 0
