// sim/setup.hpp: from the words of a scene to cloth and body in memory, before anything moves.
#pragma once
#include "assembly/cloth_model.hpp"
#include "core/hash.hpp"
#include "garment/garment_mesh.hpp"
#include "sim/cylinder.hpp"
#include "sim/scene.hpp"
#include "step/implicit_euler.hpp"

#include <vector>

namespace toile {

// Empty for a scene without body.  Adds the bytes of its file to `inputs`.  Throws IoError, InputError.
SolidMesh load_body(const SceneBody& body, Hash& inputs);

// Throws InputError for the first triangle whose corners lie on a line.
void check_areas(std::string_view file, std::span<const Vec3> positions, std::span<const Triangle> triangles);

// Flat sheet, placed; one panel with the cloth's name.
struct PlacedGrid {
  ClothMesh mesh;
  Vec3s x;
};
PlacedGrid make_grid(const SceneCloth& cloth);

// The pattern of the cloth, meshed and moved as `placement` says.  `read` gives the text of the file, which is added to `inputs`.
// Errors of the mesher are given the name of the file.
GarmentMesh load_garment(const SceneCloth& cloth, const TextSource& read, Hash& inputs);

// One per panel, with the scene's contact overrides.  Throws InputError for a panel that the cloth does not have.
std::vector<Fabric> fabrics_of(const Scene& scene, const ClothMesh& mesh);
// (b_u, b_v) per panel.
std::vector<Vec2> rest_stretch_of(const SceneCloth& cloth, const ClothMesh& mesh);
// Where labelled edges are held: as the cloth says, and the waist ("lower_interface") where the body is narrowest if it says nothing.
// Labels that stay without a height are named in a warning.  Throws InputError for a height of a label that no edge carries.
std::vector<LabelHeight> label_heights_of(const SceneCloth& cloth, const GarmentMesh& garment,
                                          std::span<const Vec3> body_x, std::span<const Triangle> body_triangles,
                                          std::vector<std::string>& warnings);
// Throws InputError when two pins hold one particle.
std::vector<Pin> pins_of(const SceneCloth& cloth, std::span<const Vec3> x);

// How far above the body cloth of this edge length rests when nobody says: edges cut corners of the body, by e^2 / 8R.
double default_offset_m(double edge_m);
StepOptions step_options(const Scene& scene, const Fabric& fabric);

// Every number of the scene that changes the result; not its name, output or number of threads.
void add_to_hash(const Scene& scene, Hash& hash);

}  // namespace toile
