// sim/cloth_pattern.hpp: sewn cloth: a pattern of panels and stitches.                                    docs/pattern-format.md
#pragma once
#include "garment/pattern_check.hpp"
#include "material/edge_finish.hpp"
#include "sim/cloth.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace toile::internal {

struct ScenePattern {
  static constexpr std::string_view key = "pattern";
  static constexpr bool sewn = true;
  std::string path;             // resolved
  std::optional<int> vertices;  // of the welded garment; overrides the cloth's resolution_m
  // Of edges for which the pattern says nothing: a hem on open ones, a tape on those of them with a label, an allowance on sewn ones.
  EdgeFinish finish{0, 0.01};
};
template <class V>
void describe_choice(V& v, std::optional<ScenePattern>& pattern) {
  describe_path(v, {"pattern", "a sewing pattern ([pattern-format.md](pattern-format.md))", "a shape"}, pattern);
}
template <class V>
void describe_beside(V& v, ScenePattern& pattern) {
  v.at_most_one({"resolution_cm", "vertices"});
  v.whole({"vertices", "instead: how many vertices the welded garment shall have, within 1 %", "by `resolution_cm`"},
          {20, 2e6}, pattern.vertices);
  v.number(
      {"hem_mm", "width of a hem on the pattern's open edges ([pattern-format.md](pattern-format.md#the-extension))"},
      {0, 200, 1e-3}, pattern.finish.hem_m);
  v.number({"tape_mm", "width of a tape on those that have a label: waists, collars, armholes, strapless tops"},
           {0, 200, 1e-3}, pattern.finish.tape_m);
  v.number({"allowance_mm", "width of the seam allowances on its sewn edges"}, {0, 200, 1e-3},
           pattern.finish.allowance_m);
  v.flag({"topstitched", "these allowances are stitched down: seams bend as a bundle; with an `allowance_mm`"},
         pattern.finish.topstitched);
}
void refuse_beside(const Json& value, const ScenePattern& none, const SceneCloth& chosen);

// A seam wider than two of the largest panels laid side by side is a mistake of units or of a sign; 40 s of sewing would close it.
inline constexpr double most_drawn_m = 2 * PatternLimits::max_panel_m;

// Throws IoError; InputError of the pattern's file, for invalid contents and for panels that cannot be meshed.
MeshedCloth load(const ScenePattern& given, const SceneCloth& whole, const TextSource& read);
ClothCost cost(const ScenePattern& given, const SceneCloth& whole, const TextSource& read);

}  // namespace toile::internal
