#!/usr/bin/env bash
# Makes BUILD_DIR/python_env, with what building and testing the Python module needs from PyPI.  Does nothing when it is there.
# Without a registry within reach the module is left out of the build: that is said, and is no failure.
#
# Usage: python_environment.sh BUILD_DIR
set -euo pipefail
build=${1:?usage: python_environment.sh BUILD_DIR}
requirements=$(cd "$(dirname "$0")/.." && pwd)/python/requirements.txt
environment=$build/python_env
cmp -s "$requirements" "$environment/requirements.txt" && exit 0

leave_out() {
  echo "toile: the Python module is left out: $1" >&2
  rm -rf "$environment"
  exit 0
}
mkdir -p "$build"
python3 -m venv --system-site-packages "$environment" >/dev/null 2>&1 || leave_out "python3 has no venv (Debian: python3-venv)"
echo "toile: getting nanobind, NumPy, pytest and what notebooks need from PyPI"
"$environment/bin/pip" install --quiet --disable-pip-version-check --retries 1 -r "$requirements" >/dev/null 2>&1 ||
  leave_out "pip cannot install $requirements; is there a network?"
cp "$requirements" "$environment/requirements.txt"
