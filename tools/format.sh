#!/usr/bin/env bash
# Formats every source in place; `--check` only lists what would change.
set -euo pipefail
cd "$(dirname "$0")/.."
tool=$(command -v clang-format || command -v clang-format-14) || { echo "format: clang-format is not installed" >&2; exit 1; }
mapfile -t files < <(git ls-files '*.cpp' '*.hpp')
if [ "${1:-}" = "--check" ]; then exec "$tool" --dry-run --Werror "${files[@]}"; fi
exec "$tool" -i "${files[@]}"
