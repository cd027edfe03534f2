// A surface of any triangles is mended to a closed body or solid, or refused by an Error; nothing else may happen.            tools/fuzz_readers.sh
#include "body/body_parts.hpp"
#include "body/collision_body.hpp"
#include "body/solid_shapes.hpp"
#include "core/error.hpp"
#include "io/mesh_file.hpp"
#include "mesh/surface_parts.hpp"
#include "mesh/thicken.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

using namespace toile::internal;

void require(bool holds) {
  if (!holds) std::abort();
}

void make_body(std::string_view bytes) {
  const CollisionBody body = make_collision_body(parse_mesh(bytes, TOILE_FUZZ_FILE), TOILE_FUZZ_FILE, LengthUnit::m);
  require(body.source_vertex.size() == body.positions.size());
  for (const SurfacePart& part : surface_parts(body.triangles, body.positions).parts) require(part.closed);
}

void make_solid(std::string_view bytes) {
  const SurfaceMesh mesh = parse_mesh(bytes, TOILE_FUZZ_FILE);
  const BodyParts parts = solid_parts(mesh, TOILE_FUZZ_FILE, 1);
  SolidMesh sheets = whole_of(mesh, parts.sheets);
  thicken(sheet_thickness_m, sheets.positions, sheets.triangles);
  for (const SurfacePart& part : surface_parts(parts.triangles, mesh.positions).parts) require(part.closed);
  for (const SurfacePart& part : surface_parts(sheets.triangles, sheets.positions).parts) require(part.closed);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const auto make : {make_body, make_solid}) {
    try {
      make(bytes);
    } catch (const Error&) {
      continue;
    }
  }
  return 0;
}
