#!/usr/bin/env bash
# Formats every source in place; `--check` only lists what would change (exit 77: no clang-format 14 here, nothing checked).
# Only version 14, that of Debian 12: others break lines differently.
set -euo pipefail
cd "$(dirname "$0")/.."

tool=
for candidate in clang-format-14 clang-format; do
  if "$candidate" --version 2>/dev/null | grep -q 'version 14\.'; then
    tool=$candidate
    break
  fi
done
if [ -z "$tool" ]; then
  echo "format: clang-format 14 is not installed (Debian: clang-format-14)" >&2
  exit 77
fi

folders=()
for folder in src apps bench include examples tests python/src python/tests; do [ -d "$folder" ] && folders+=("$folder"); done
mapfile -d '' files < <(find "${folders[@]}" \( -name '*.cpp' -o -name '*.hpp' \) -print0 | sort -z)
if [ "${1:-}" = "--check" ]; then
  exec "$tool" --dry-run --Werror "${files[@]}"
fi
exec "$tool" -i "${files[@]}"
