// sim/cloth_mesh.hpp: a modelled garment: a mesh file as cloth.                                         docs/scenes.md#meshes
//
// Panels are the file's groups (or its objects, if it has no groups).  Vertices that the file had to split at a seam of the drawing (`vt`) are one
// particle (mesh/join_sides.hpp).  Unused vertices are left out; the others keep their order.
//
// A drawing in metres says how the cloth was cut: u of the warp is the second number of a vt, v of the weft the first one, leftwards.  One in other
// units (0 ... 1, of a texture) says only where the warp runs: then the cloth is at rest as it starts.
#pragma once
#include "body/collision_body.hpp"
#include "io/surface_mesh.hpp"
#include "sim/cloth_arrays.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile::internal {

// Where the rest shape comes from: the mesh's drawing (vt), or its positions at the start.
enum class RestShape { automatic, drawing, start };  // automatic: the drawing, if it is in metres

struct SceneClothMesh {
  static constexpr std::string_view key = "mesh";
  static constexpr bool sewn = false;
  std::string path;  // resolved
  LengthUnit unit = LengthUnit::m;
  RestShape rest_shape = RestShape::automatic;
};
template <class V>
void describe_choice(V& v, std::optional<SceneClothMesh>& mesh) {
  describe_path(v, {"mesh", "a garment that is modelled already: a [mesh file](#mesh-files) ([meshes](#meshes))", "no"},
                mesh);
  SceneClothMesh none;
  SceneClothMesh& given = mesh ? *mesh : none;
  v.name({"mesh_unit", "of the mesh's coordinates"}, length_units, given.unit);
  static constexpr std::array<std::pair<std::string_view, RestShape>, 3> rest_shapes = {
      {{"automatic", RestShape::automatic}, {"drawing", RestShape::drawing}, {"start", RestShape::start}}};
  v.name({"rest_shape",
          "of a mesh: its `drawing` (`vt`, in metres), or itself as it is at the `start`; `automatic`: the drawing, if "
          "it is in metres"},
         rest_shapes, given.rest_shape);
}
void refuse_beside(const Json& value, const SceneClothMesh& none, const SceneCloth& chosen);

// Reports deviations from the file in `warnings`.  Throws InputError, with `file` as its place, for a mesh without faces, and with
// RestShape::drawing for a face without vt or without area in the drawing.
ClothSurface surface_of_mesh(const SurfaceMesh& mesh, std::string_view file, double unit_m, RestShape rest,
                             std::vector<std::string>& warnings);

// The file's name, without its extension.
std::string usual_name(const SceneClothMesh& mesh);
// Throws IoError, InputError.
MeshedCloth load(const SceneClothMesh& given, const SceneCloth& whole, const TextSource& read);
ClothCost cost(const SceneClothMesh& given, const SceneCloth& whole, const TextSource& read);

}  // namespace toile::internal
