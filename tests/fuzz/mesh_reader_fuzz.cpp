// A mesh file of any content is read, or refused by an Error; nothing else may happen.                    tools/fuzz_readers.sh
#include "core/error.hpp"
#include "io/mesh_file.hpp"

#include <cstdint>
#include <cstdlib>

namespace {

using namespace toile::internal;

// What every reader promises: corners and texture coordinates that are there, names for every number, finite numbers.
void require(bool holds) {
  if (!holds) std::abort();
}

void check(const SurfaceMesh& mesh) {
  for (const Vec3& x : mesh.positions) require(x.allFinite());
  for (const Vec2& uv : mesh.texcoords) require(uv.allFinite());
  const auto below = [](Index i, std::size_t count) { return i >= 0 && at(i) < count; };
  require(!mesh.triangles.empty());
  require(mesh.texcoord.empty() || mesh.texcoord.size() == mesh.triangles.size());
  require(mesh.group.size() == mesh.triangles.size() && mesh.object.size() == mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index i : mesh.triangles[t]) require(below(i, mesh.positions.size()));
    if (!mesh.texcoord.empty())
      for (const Index i : mesh.texcoord[t]) require(i == -1 || below(i, mesh.texcoords.size()));
    require(below(mesh.group[t], mesh.group_names.size()) && below(mesh.object[t], mesh.object_names.size()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    check(parse_mesh(std::string_view(reinterpret_cast<const char*>(data), size), TOILE_FUZZ_FILE));
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
