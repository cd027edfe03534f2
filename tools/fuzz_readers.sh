#!/usr/bin/env bash
# Feeds the reader of a format of meshes or motions with broken files until something breaks, by libFuzzer with address and undefined-behaviour sanitizers.
#
# Usage: fuzz_readers.sh FORMAT [SECONDS [FOLDER]]      FORMAT: obj, ply, stl, gltf; body (what makes a body or a solid of an OBJ); gltf-motion (skins
#                                                       and animations), bvh or rig (MakeHuman's: a target, a rig, weights); 60 seconds; FOLDER keeps what was found (build/fuzz/FORMAT)
#
# Needs clang (Debian: clang, libclang-rt-14-dev).  Ends with the fuzzer's code: 0 when nothing was found.
set -euo pipefail
format=${1:?usage: fuzz_readers.sh FORMAT [SECONDS [FOLDER]]}
seconds=${2:-60}
root=$(cd "$(dirname "$0")/.." && pwd)
folder=${3:-$root/build/fuzz/$format}
harness=mesh_reader_fuzz
case $format in
  obj | ply | stl) file=fuzz.$format ;;
  body) file=fuzz.obj harness=body_fuzz ;;
  gltf) file=fuzz.glb ;;
  gltf-motion) file=fuzz.glb harness=motion_reader_fuzz ;;
  bvh | rig) file=fuzz.$format harness=motion_reader_fuzz ;;
  *)
    echo "fuzz_readers.sh: expected obj, ply, stl, gltf, body, gltf-motion, bvh or rig, got $format" >&2
    exit 2
    ;;
esac
mkdir -p "$folder/corpus"

sources=("$root"/tests/fuzz/$harness.cpp "$root"/src/core/*.cpp "$root"/src/rig/*.cpp "$root"/src/io/file.cpp "$root"/src/io/json.cpp
  "$root"/src/io/mesh_file.cpp "$root"/src/io/mesh_writer.cpp "$root"/src/io/animated_mesh.cpp "$root"/src/io/bvh.cpp "$root"/src/io/makehuman.cpp
  "$root"/src/io/sequence_writer.cpp "$root"/src/io/usda_write.cpp "$root"/src/io/pc2.cpp "$root"/src/io/mdd.cpp
  "$root"/src/io/obj_*.cpp "$root"/src/io/ply_*.cpp "$root"/src/io/stl_*.cpp "$root"/src/io/gltf_*.cpp)
if [ "$format" = body ]; then
  sources+=("$root"/src/mesh/*.cpp "$root"/src/body/body_parts.cpp "$root"/src/body/collision_body.cpp "$root"/src/body/measure.cpp
    "$root"/src/body/solid_shapes.cpp "$root"/src/body/upright.cpp)
fi
objects=()
for source in "${sources[@]}"; do
  case $source in */obj_replace.cpp) continue ;; esac
  object=$folder/$(basename "$source" .cpp).o
  clang++ -std=c++20 -g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -DTOILE_FUZZ_FILE="\"$file\"" \
    -I "$root/src" -isystem /usr/include/eigen3 -c "$source" -o "$object"
  objects+=("$object")
done
clang++ -fsanitize=fuzzer,address,undefined "${objects[@]}" -lfmt -ltbb -o "$folder/fuzz"

# What it starts from: one small file of the format, whole.
seed=$folder/corpus/seed
case $format in
  obj) printf 'o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\ng b\nf 1/1 2/2 3/3\n' >"$seed" ;;
  ply)
    printf 'ply\nformat ascii 1.0\ncomment panel 0 a\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n' >"$seed"
    printf 'property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nproperty int panel\n' >>"$seed"
    printf 'end_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n3 0 1 2 0\n' >>"$seed"
    ;;
  stl) printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n' >"$seed" ;;
  body) # a box, and a loose triangle that doubles one of its own
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\nv 0 0 0\no body\nf 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\n' >"$seed"
    printf 'f 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\no other\nf 9 3 4\n' >>"$seed"
    ;;
  gltf) # three corners, their texture coordinates and indices
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[1,2,3]}],"materials":[{"name":"a"}],' >"$seed"
    printf '"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],' >>"$seed"
    printf '"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":0,"componentType":5126,"count":3,' >>"$seed"
    printf '"type":"VEC2","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}}},' >>"$seed"
    printf '{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],' >>"$seed"
    printf '"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],"buffers":[{"byteLength":39,' >>"$seed"
    printf '"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAEC"}]}' >>"$seed"
    ;;
  gltf-motion) # the same corners on two joints, of which a turn is animated, and a morph target
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0},{"children":[2]},{"translation":[0,1,0]}],' >"$seed"
    printf '"meshes":[{"weights":[0.5],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},"targets":[{"POSITION":0}]}]}],' >>"$seed"
    printf '"skins":[{"joints":[1,2]}],"animations":[{"samplers":[{"input":3,"output":4}],"channels":[{"sampler":0,"target":{"node":2,"path":' >>"$seed"
    printf '"translation"}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":' >>"$seed"
    printf '5121,"count":3,"type":"VEC4"},{"bufferView":1,"byteOffset":12,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"},' >>"$seed"
    printf '{"bufferView":1,"byteOffset":24,"componentType":5126,"count":2,"type":"SCALAR"},{"bufferView":0,"componentType":5126,"count":2,' >>"$seed"
    printf '"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":32}],"buffers":[{"byteLength":68,' >>"$seed"
    printf '"uri":"data:application/octet-stream;base64,%s"}]}' \
      AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAEAAAABAAAAAQAA/wAAAH9/AAAA/wAAAAAAAAAAgD8= >>"$seed"
    ;;
  bvh)
    printf 'HIERARCHY\nROOT a\n{\nOFFSET 0 1 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\nJOINT b\n{\nOFFSET 0 1 0\n' >"$seed"
    printf 'CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n' >>"$seed"
    printf '0 1 0 10 20 30 1 2 3\n0 1 1 20 20 30 1 2 4\n' >>"$seed"
    ;;
  rig)
    printf '0 1 2 3\n\0{"a":{"parent":"","head":{"strategy":"CUBE","cube_name":"a"}},"b":{"parent":"a","head":{"strategy":"MEAN",' >"$seed"
    printf '"vertex_indices":[1,2]}}}\0{"weights":{"a":[[0,1],[1,0.5]],"b":[[1,0.5]]}}' >>"$seed"
    ;;
esac
exec "$folder/fuzz" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=2560 -max_len=65536 -artifact_prefix="$folder/" -print_final_stats=1 "$folder/corpus"
