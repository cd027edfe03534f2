#include "dress/outfit.hpp"

#include <algorithm>

namespace toile::internal {

Index Outfit::part_of_panel(Index panel) const {
  const auto after = std::upper_bound(parts.begin(), parts.end(), panel,
                                      [](Index p, const OutfitPart& part) { return p < part.first_panel; });
  return static_cast<Index>(after - parts.begin()) - 1;
}

GarmentMesh over(const Outfit& outfit, const GarmentMesh& garment) {
  const Index worn = outfit.mesh.particle_count, panels = static_cast<Index>(outfit.mesh.panel_names.size());
  if (worn == 0) return garment;
  GarmentMesh both = garment;
  both.mesh = outfit.mesh;
  both.mesh.particle_count += garment.mesh.particle_count;
  for (const Triangle& t : garment.mesh.triangles)
    both.mesh.triangles.push_back({t[0] + worn, t[1] + worn, t[2] + worn});
  if (!both.mesh.gathered_uv.empty() || !garment.mesh.gathered_uv.empty()) {
    const auto& behind = garment.mesh.gathered_uv.empty() ? garment.mesh.uv : garment.mesh.gathered_uv;
    if (both.mesh.gathered_uv.empty()) both.mesh.gathered_uv = both.mesh.uv;
    both.mesh.gathered_uv.insert(both.mesh.gathered_uv.end(), behind.begin(), behind.end());
  }
  both.mesh.uv.insert(both.mesh.uv.end(), garment.mesh.uv.begin(), garment.mesh.uv.end());
  for (const Index panel : garment.mesh.panel) both.mesh.panel.push_back(panel + panels);
  both.mesh.panel_names.insert(both.mesh.panel_names.end(), garment.mesh.panel_names.begin(),
                               garment.mesh.panel_names.end());
  both.panel_labels.insert(both.panel_labels.begin(), static_cast<std::size_t>(panels), std::string());
  both.mesh.panel_cloth.resize(static_cast<std::size_t>(panels));  // a grid has none
  both.mesh.panel_cloth.insert(both.mesh.panel_cloth.end(), garment.mesh.panel_cloth.begin(),
                               garment.mesh.panel_cloth.end());
  both.mesh.panel_cloth.resize(both.mesh.panel_names.size());
  for (const FoldedEdge& fold : garment.mesh.folds)
    both.mesh.folds.push_back({fold.a + worn, fold.b + worn, fold.angle_rad});
  for (FinishedEdge edge : garment.mesh.finished) {
    edge.a += worn;
    edge.b += worn;
    both.mesh.finished.push_back(edge);
  }
  both.x = outfit.state.x;
  both.x.insert(both.x.end(), garment.x.begin(), garment.x.end());
  for (SeamPair& pair : both.pairs) {
    pair.a += worn;
    pair.b += worn;
  }
  for (LabelledEdge& edge : both.labels)
    for (Index& i : edge.particles) i += worn;
  both.merged.clear();
  for (Index i = 0; i < worn; ++i) both.merged.push_back(i);
  for (const Index i : garment.merged) both.merged.push_back(i + worn);
  both.on_panel_edge.assign(static_cast<std::size_t>(worn), false);
  both.on_panel_edge.insert(both.on_panel_edge.end(), garment.on_panel_edge.begin(), garment.on_panel_edge.end());
  return both;
}

void put_behind(Outfit& outfit, const GarmentMesh& garment, std::span<const Fabric> fabrics,
                std::span<const Vec2> rest_stretch) {
  GarmentMesh both = over(outfit, garment);
  OutfitPart part;
  part.name = garment.name;
  part.first_panel = static_cast<Index>(outfit.mesh.panel_names.size());
  part.panels = static_cast<Index>(garment.mesh.panel_names.size());
  part.particles = garment.mesh.particle_count;
  outfit.parts.push_back(std::move(part));
  outfit.mesh = std::move(both.mesh);
  outfit.state.x = std::move(both.x);
  outfit.state.v.assign(outfit.state.x.size(), Vec3::Zero());
  outfit.fabrics.insert(outfit.fabrics.end(), fabrics.begin(), fabrics.end());
  outfit.rest_stretch.insert(outfit.rest_stretch.end(), rest_stretch.begin(), rest_stretch.end());
  outfit.seams += static_cast<int>(garment.seams.size());
}

}  // namespace toile::internal
