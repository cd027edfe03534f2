#include "sim/cloth_pattern.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "garment/pattern_check.hpp"
#include "garment/pattern_figures.hpp"
#include "io/json.hpp"
#include "sim/cloths.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr int seam_samples = 8;

bool is_set(const Vec3& v) { return !v.isZero(0); }

// Seams close, and the body grows, with edges of 1 to 2 cm: the twofold of the requested edges as long as it is at most that.  Sewn with edges of
// 1 cm a garment takes four to eight times as long, and fitted ones block more often (docs/theory/sewing.md#two-resolutions).
double sewn_edge_m(double edge_m) {
  constexpr double coarsest_m = 0.02;
  while (2 * edge_m <= coarsest_m * (1 + 1e-9)) edge_m *= 2;
  return edge_m;
}

// The widest seam gives the time of sewing; one that is too wide names the panel.
ClothCost::Seams seams_of(const Pattern& pattern, const std::string& file) {
  ClothCost::Seams seams;
  for (const Stitch& stitch : pattern.stitches) {
    const Panel &a = pattern.panels[static_cast<std::size_t>(stitch.a.panel)],
                &b = pattern.panels[static_cast<std::size_t>(stitch.b.panel)];
    std::vector<Vec2> on_a = sample_edge(a, a.edges[static_cast<std::size_t>(stitch.a.edge)], seam_samples),
                      on_b = sample_edge(b, b.edges[static_cast<std::size_t>(stitch.b.edge)], seam_samples);
    if (!stitch.right_wrong) std::reverse(on_b.begin(), on_b.end());
    double wide_m = 0;
    for (std::size_t k = 0; k < on_a.size(); ++k)
      wide_m = std::max(wide_m, (a.place(on_a[k]) - b.place(on_b[k])).norm());
    if (wide_m <= seams.widest_m) continue;
    seams.widest_m = wide_m;
    if (wide_m <= most_drawn_m) continue;
    const bool a_is_far = a.place(on_a.front()).norm() >= b.place(on_b.front()).norm();  // from the body
    seams.farthest = FarPanel{file, (a_is_far ? a : b).name, (a_is_far ? b : a).name,
                              printable(a.name) + '.' + std::to_string(a.file_number(stitch.a.edge)) + " - " +
                                  printable(b.name) + '.' + std::to_string(b.file_number(stitch.b.edge)),
                              wide_m};
  }
  return seams;
}

}  // namespace

void refuse_beside(const Json& value, const ScenePattern&, const SceneCloth& chosen) {
  const std::string pattern = "a pattern beside it";
  for (const std::string_view key : {"vertices", "resolution_cm", "hem_mm", "tape_mm", "allowance_mm", "topstitched"})
    if (const Json* given = value.find(key))
      given->fail(key == "resolution_cm" && chosen.has_own_edge() ? pattern + ": other shapes have an edge_m" : pattern,
                  given->describe());
}

MeshedCloth load(const ScenePattern& given, const SceneCloth& whole, const TextSource& read) {
  if (given.finish.topstitched && given.finish.allowance_m <= 0)
    throw InputError("", "topstitched", "an allowance above zero beside it (allowance_mm, --allowance)", "none");
  MeshedCloth meshed;
  const std::string text = read(given.path), file = printable(given.path);
  meshed.input_hash = hash_of_text(text);
  meshed.edge_m = whole.resolution_m;
  PatternFile as_read = read_pattern(text, file);
  Pattern& pattern = meshed.pattern.emplace(std::move(as_read.pattern));
  finish_other_edges(pattern, given.finish);
  GarmentMesh& garment = meshed.garment;
  try {
    if (given.vertices) {
      CountedGarment counted = mesh_garment_to_count(pattern, *given.vertices);
      garment = std::move(counted.garment);
      meshed.edge_m = counted.resolution_m;
    } else {
      meshed.sewn_edge_m = sewn_edge_m(whole.resolution_m);
      garment = mesh_garment(pattern, meshed.sewn_edge_m);
    }
  } catch (const InputError& error) {
    throw as_read.places.complete(error).within(file);
  }
  if (!whole.name.empty()) garment.name = whole.name;
  if (is_set(whole.translation_m) || is_set(whole.rotation_deg)) {
    const Mat3 turn = rotation_from_degrees(whole.rotation_deg);
    for (Vec3& x : garment.x) x = turn * x + whole.translation_m;
  }
  return meshed;
}

ClothCost cost(const ScenePattern& given, const SceneCloth& whole, const TextSource& read) {
  const std::string file = printable(given.path);
  const Pattern pattern = parse_pattern(read(given.path), file);
  const PatternSummary summary = summarize(pattern);
  const double edge_m = given.vertices
                            ? std::sqrt(summary.area_m2 / (std::sqrt(3.0) / 2 * std::max(1, *given.vertices)))
                            : whole.resolution_m;
  const std::string name = cloth_in_words(whole.name.empty() ? pattern.name : whole.name);
  ClothCost cost;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    double points = 0;
    for (const PanelEdge& edge : panel.edges) points += std::ceil(edge_length_m(panel, edge) / edge_m);
    cost.parts.push_back(
        part_of_area(name + ", panel \"" + printable(panel.name) + '"', summary.panels[p].area_m2, points, edge_m));
  }
  if (!pattern.stitches.empty()) cost.seams = seams_of(pattern, file);
  return cost;
}

}  // namespace toile::internal
