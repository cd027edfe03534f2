#!/usr/bin/env bash
# clang-tidy over src/ and apps/ with the checks of .clang-tidy.
set -euo pipefail
cd "$(dirname "$0")/.."
tool=$(command -v clang-tidy || command -v clang-tidy-14) || { echo "tidy: clang-tidy is not installed" >&2; exit 1; }
# A folder of its own, whose commands are of one source each.
cmake --preset release -B build/tidy -DTOILE_UNITY=OFF >/dev/null
find src apps -name '*.cpp' -print0 | sort -z | xargs -0 -P "$(nproc)" -n 4 "$tool" -p build/tidy --quiet
