#!/usr/bin/env bash
# clang-tidy over src/ and apps/ with the checks of .clang-tidy; needs a configured build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
tool=$(command -v clang-tidy || command -v clang-tidy-14) || { echo "tidy: clang-tidy is not installed" >&2; exit 1; }
mapfile -t files < <(git ls-files 'src/*.cpp' 'apps/*.cpp')
printf '%s\0' "${files[@]}" | xargs -0 -P "$(nproc)" -n 4 "$tool" -p build/release --quiet
