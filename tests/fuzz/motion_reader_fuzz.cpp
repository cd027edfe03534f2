// Files that move bodies, of any content: read, or refused by an Error; nothing else may happen.          tools/fuzz_readers.sh
#include "core/error.hpp"
#include "io/bvh.hpp"
#include "io/makehuman.hpp"
#include "io/mesh_file.hpp"
#include "rig/pose_track.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace toile::internal;

void require(bool holds) {
  if (!holds) std::abort();
}

// Every number leads to something that is there; a pose may be not finite, which whoever uses it checks.
void check(const Figure& figure, const FigurePose& pose) {
  require(figure.order.size() == figure.nodes.size() && pose.nodes.size() == figure.nodes.size());
  require(figure.first_influence.empty() || figure.first_influence.back() == figure.influences.size());
  require(all_vertices(figure, pose).size() == figure.modelled.size());
}

void read_animated(std::string_view bytes) {
  const AnimatedMesh read = parse_animated(bytes, "fuzz.glb");
  require(read.surface.positions.size() == read.figure.modelled.size());
  for (const Clip& clip : read.clips) check(read.figure, pose_at(clip, read.figure, 0.5 * (clip.begin_s + clip.end_s)));
}

void read_recording(std::string_view bytes) {
  const BvhMotion read = parse_bvh(bytes, "fuzz.bvh");
  check(read.figure, pose_at(read.track, 0.5 * read.track.length_s()));
}

// Up to the first zero a target, up to the next a rig, then weights; on a mesh of four corners.
void read_rig(std::string_view bytes) {
  SurfaceMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}};
  mesh.group = {0};
  mesh.group_names = {"a"};
  const std::size_t first = bytes.find('\0'), second = first == bytes.npos ? first : bytes.find('\0', first + 1);
  if (second == bytes.npos) return;
  apply_target(bytes.substr(0, first), "fuzz.target", 0.5, mesh);
  std::vector<std::string> notes;
  const Figure figure = makehuman_figure(mesh, {bytes.substr(first + 1, second - first - 1), "rig.json"},
                                         {bytes.substr(second + 1), "weights.json"}, notes);
  check(figure, figure.rest);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kind = TOILE_FUZZ_FILE;
  try {
    if (kind.ends_with(".glb")) read_animated(bytes);
    if (kind.ends_with(".bvh")) read_recording(bytes);
    if (kind.ends_with(".rig")) read_rig(bytes);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
