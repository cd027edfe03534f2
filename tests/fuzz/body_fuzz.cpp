// A surface of any triangles is mended to a closed body, or refused by an Error; nothing else may happen.            tools/fuzz_readers.sh
#include "body/body_parts.hpp"
#include "body/collision_body.hpp"
#include "core/error.hpp"
#include "io/mesh_file.hpp"
#include "mesh/surface_parts.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

using namespace toile::internal;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const SurfaceMesh mesh = parse_mesh(bytes, TOILE_FUZZ_FILE);
    const CollisionBody body = make_collision_body(mesh, TOILE_FUZZ_FILE, LengthUnit::m);
    require(body.source_vertex.size() == body.positions.size());
    for (const SurfacePart& part : surface_parts(body.triangles, body.positions).parts) require(part.closed);
    solid_parts(mesh, TOILE_FUZZ_FILE, 1);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
