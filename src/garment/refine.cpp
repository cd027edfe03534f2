#include "garment/refine.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

using Ends = std::array<Index, 2>;

Ends in_order(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

// One halving of the long edges.
class Halving {
 public:
  Halving(const GarmentMesh& from, double longest_m) : from_(from) {
    find_long_edges(longest_m);
    add_middles();
  }

  // Of the edge from a to b; none if it stays whole.
  std::optional<Index> middle(Index a, Index b) const {
    const auto found = middle_.find(in_order(a, b));
    return found == middle_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::vector<Ends>& ends() const { return ends_; }

  GarmentMesh garment() const {
    GarmentMesh to = from_;
    to.mesh.particle_count += static_cast<Index>(ends_.size());
    interpolate(std::span<const Ends>(ends_), to.x);
    to.on_panel_edge.insert(to.on_panel_edge.end(), on_panel_edge_.begin(), on_panel_edge_.end());
    to.merged.insert(to.merged.end(), merged_.begin(), merged_.end());
    cut_triangles(to.mesh);
    to.mesh.folds = cut<FoldedEdge>(from_.mesh.folds);
    to.mesh.finished = cut<FinishedEdge>(from_.mesh.finished);
    for (LabelledEdge& edge : to.labels) edge.particles = with_middles(edge.particles);
    add_pairs(to);
    return to;
  }

 private:
  Ends welded(Index a, Index b) const { return in_order(from_.merged[at(a)], from_.merged[at(b)]); }

  void find_long_edges(double longest_m) {
    std::map<Ends, double> length_m;  // [edge of the weld]
    for (std::size_t t = 0; t < from_.mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& corners = from_.mesh.triangles[t];
        const Index a = corners[k], b = corners[(k + 1) % 3];
        ++triangles_at_[in_order(a, b)];
        double& longest = length_m[welded(a, b)];
        longest = std::max(longest, (from_.mesh.uv[t][(k + 1) % 3] - from_.mesh.uv[t][k]).norm());
      }
    for (const auto& [edge, triangles] : triangles_at_)
      if (length_m.at(welded(edge[0], edge[1])) > longest_m) middle_.emplace(edge, -1);
  }

  void add_middles() {
    std::map<Ends, Index> first_of;  // [edge of the weld]
    for (auto& [edge, particle] : middle_) {
      particle = from_.mesh.particle_count + static_cast<Index>(ends_.size());
      ends_.push_back(edge);
      on_panel_edge_.push_back(triangles_at_.at(edge) == 1);
      merged_.push_back(first_of.emplace(welded(edge[0], edge[1]), particle).first->second);
    }
  }

  // The corners of one triangle and the middles of its sides, in the drawing and at rest.
  struct Corner {
    Index particle;
    Vec2 uv, gathered;
  };
  static Corner between(const Corner& a, const Corner& b, Index particle) {
    return {particle, 0.5 * (a.uv + b.uv), 0.5 * (a.gathered + b.gathered)};
  }

  void cut_triangles(ClothMesh& mesh) const {
    const bool gathered = !mesh.gathered_uv.empty();
    const ClothMesh& whole = from_.mesh;
    mesh.triangles.clear();
    mesh.uv.clear();
    mesh.panel.clear();
    mesh.gathered_uv.clear();
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
      const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
        mesh.triangles.push_back({a.particle, b.particle, c.particle});
        mesh.uv.push_back({a.uv, b.uv, c.uv});
        mesh.panel.push_back(whole.panel[t]);
        if (gathered) mesh.gathered_uv.push_back({a.gathered, b.gathered, c.gathered});
      };
      std::array<Corner, 3> corner;
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = {whole.triangles[t][k], whole.uv[t][k], gathered ? whole.gathered_uv[t][k] : whole.uv[t][k]};
      cut(corner, add);
    }
  }

  template <class Add>
  void cut(const std::array<Corner, 3>& corner, const Add& add) const {
    std::array<std::optional<Corner>, 3> mid;  // [k] of the side from corner k
    std::size_t halved = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto particle = middle(corner[k].particle, corner[(k + 1) % 3].particle)) {
        mid[k] = between(corner[k], corner[(k + 1) % 3], *particle);
        ++halved;
      }
    if (halved == 0) return add(corner[0], corner[1], corner[2]);
    if (halved == 3) {
      for (std::size_t k = 0; k < 3; ++k) add(corner[k], *mid[k], *mid[(k + 2) % 3]);
      return add(*mid[0], *mid[1], *mid[2]);
    }
    // Turned so that the side from a to b is whole, and that from b to c halved.
    std::size_t k = 0;
    while (mid[k] || !mid[(k + 1) % 3]) ++k;
    const Corner &a = corner[k], &b = corner[(k + 1) % 3], &c = corner[(k + 2) % 3], &bc = *mid[(k + 1) % 3];
    if (halved == 1) {
      add(a, b, bc);
      return add(a, bc, c);
    }
    const Corner& ca = *mid[(k + 2) % 3];
    add(c, ca, bc);
    if ((bc.uv - a.uv).squaredNorm() <= (ca.uv - b.uv).squaredNorm()) {
      add(a, b, bc);
      add(a, bc, ca);
    } else {
      add(a, b, ca);
      add(b, bc, ca);
    }
  }

  // Both halves of an edge that is cut are folded, or finished, as the whole was.
  template <class Edge>
  std::vector<Edge> cut(std::span<const Edge> edges) const {
    std::vector<Edge> all;
    for (const Edge& edge : edges) {
      const auto m = middle(edge.a, edge.b);
      all.push_back(edge);
      if (!m) continue;
      all.back().b = *m;
      all.push_back(edge);
      all.back().a = *m;
    }
    return all;
  }

  std::vector<Index> with_middles(std::span<const Index> line) const {
    std::vector<Index> all;
    for (std::size_t k = 0; k < line.size(); ++k) {
      if (k > 0)
        if (const auto m = middle(line[k - 1], line[k])) all.push_back(*m);
      all.push_back(line[k]);
    }
    return all;
  }

  // Between two pairs that follow each other along a seam, half of the piece that they carry together.
  void add_pairs(GarmentMesh& to) const {
    to.pairs.clear();
    for (std::size_t k = 0; k < from_.pairs.size(); ++k) {
      to.pairs.push_back(from_.pairs[k]);
      if (k + 1 == from_.pairs.size() || from_.pairs[k].seam != from_.pairs[k + 1].seam) continue;
      const SeamPair &one = from_.pairs[k], &next = from_.pairs[k + 1];
      const auto a = middle(one.a, next.a), b = middle(one.b, next.b);
      if (a && b && *a != *b) to.pairs.push_back({*a, *b, 0.5 * std::max(one.share_m, next.share_m), one.seam});
    }
    // The sum along the seam is its length: the neighbours of a new pair give a half of its share each.
    for (std::size_t k = 1; k + 1 < to.pairs.size(); ++k) {
      const SeamPair& added = to.pairs[k];
      if (added.a < from_.mesh.particle_count) continue;
      to.pairs[k - 1].share_m -= 0.5 * added.share_m;
      to.pairs[k + 1].share_m -= 0.5 * added.share_m;
    }
  }

  const GarmentMesh& from_;
  std::map<Ends, int> triangles_at_;  // [edge of the panels]
  std::map<Ends, Index> middle_;      // likewise, of those that are halved
  std::vector<Ends> ends_;
  std::vector<bool> on_panel_edge_;
  std::vector<Index> merged_;
};

}  // namespace

RefinedGarment refine(const GarmentMesh& garment, double edge_m) {
  RefinedGarment refined{garment, {}};
  for (;;) {
    const Halving halving(refined.garment, std::numbers::sqrt2 * edge_m);
    if (halving.ends().empty()) return refined;
    refined.garment = halving.garment();
    refined.ends.insert(refined.ends.end(), halving.ends().begin(), halving.ends().end());
  }
}

}  // namespace toile::internal
