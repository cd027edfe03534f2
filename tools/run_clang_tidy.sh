#!/usr/bin/env bash
# clang-tidy over src/ and apps/ with the checks of .clang-tidy; needs a configured build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
tool=$(command -v clang-tidy || command -v clang-tidy-14) || { echo "tidy: clang-tidy is not installed" >&2; exit 1; }
if [ ! -f build/release/compile_commands.json ]; then
  echo "tidy: build/release is not configured: make build" >&2
  exit 1
fi
find src apps -name '*.cpp' -print0 | sort -z | xargs -0 -P "$(nproc)" -n 4 "$tool" -p build/release --quiet
