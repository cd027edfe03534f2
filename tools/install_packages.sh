#!/usr/bin/env bash
# Installs the Debian 12 packages that building, testing and running Toile need.  Does nothing when all are there.
# `--check` installs nothing: it says which are missing, and exits with 1 when any is.
# `--blender` adds what the tests of the add-on for Blender run in.
set -euo pipefail

packages=(
  g++ make cmake ninja-build ccache                                   # build
  clang libclang-rt-14-dev                                            # the second compiler of the tests, and its sanitizers
  libeigen3-dev libtbb-dev nlohmann-json3-dev libcli11-dev libfmt-dev # core, io, command line
  libyaml-cpp-dev                                                     # io: measurements of bodies
  libtinygltf-dev                                                     # io: glTF files
  libhwy-dev                                                          # solver: vectors of the width the processor has
  libembree-dev libpng-dev ffmpeg                                     # preview: pictures and film
  libsqlite3-dev                                                      # batches: their index
  libgtest-dev libbenchmark-dev python3                               # tests, benchmarks
  python3-dev python3-venv                                            # the Python module
)
[ "${1:-}" = "--blender" ] && packages+=(blender python3-numpy xvfb libgl1-mesa-dri)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "${1:-}" = "--check" ]; then
  echo "toile: of the Debian 12 packages that it is built with, these are not installed: ${missing[*]}" >&2
  echo "toile: \`make packages\` installs them, as root or with sudo" >&2
  exit 1
fi

if ! command -v apt-get >/dev/null; then
  echo "toile: needs these Debian 12 packages, and there is no apt-get to install them: ${missing[*]}" >&2
  echo "toile: if you have them under other names, build with: cmake --preset release && cmake --build --preset release" >&2
  exit 1
fi
root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "toile: run as root, or install: ${missing[*]}" >&2
    exit 1
  fi
  root=(sudo)
fi

# sudo drops the environment, so the setting is passed behind it.
apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq)
echo "toile: installing ${missing[*]}"
"${apt[@]}" update
"${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null
