// sim/cloth.hpp: the loaded form of a kind of cloth (sim/cloths.hpp), and its cost.
#pragma once
#include "garment/garment_mesh.hpp"
#include "garment/pattern.hpp"
#include "sim/settings.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile::internal {

class Json;
struct SceneCloth;

// Where the texts of scenes, patterns and meshes come from: the disk, or the files inside the program.
using TextSource = std::function<std::string(const std::string& path)>;

// Panels, meshed and moved by the cloth's `placement`.
struct MeshedCloth {
  GarmentMesh garment;
  std::optional<Pattern> pattern;  // as read; only of sewn cloth
  double edge_m = 0;               // the requested edge length of triangles
  double sewn_edge_m = 0;  // that of `garment`, which is cut finer once it is on (garment/refine.hpp); 0: edge_m
  std::vector<std::string> warnings;
  std::uint64_t input_hash = 0;  // of its files or arrays; 0: it has none
};

inline bool is_cut_finer(const MeshedCloth& cloth) { return cloth.sewn_edge_m > cloth.edge_m; }
// The garment with the requested edges.
GarmentMesh as_worn(const MeshedCloth& cloth);

// Panels too far apart to be sewn.
struct FarPanel {
  std::string file, panel, other, seam;
  double distance_m = 0;
};

// The cost of a cloth, before it is made.
struct ClothCost {
  struct Part {
    std::string what;  // `cloth "skirt", panel "front"`
    double particles = 0, triangles = 0;
  };
  std::vector<Part> parts;
  struct Seams {
    double widest_m = 0;
    std::optional<FarPanel> farthest;  // the panels farthest apart, if too far
  };
  std::optional<Seams> seams;  // absent: nothing is sewn
};
// The cost of an area, by its outline's points: formulas in sim/budget.hpp.
ClothCost::Part part_of_area(std::string what, double area_m2, double outline_points, double edge_m);
// `cloth "skirt"`
std::string cloth_in_words(std::string_view name);

// Describes a key that chooses a kind by the path of its file.
template <class V, class Kind>
void describe_path(V& v, const Setting& s, std::optional<Kind>& kind) {
  std::string path = kind ? kind->path : std::string();
  v.path(s, path);
  if (path.empty()) return;
  if (!kind) kind.emplace();
  kind->path = std::move(path);
}

}  // namespace toile::internal
