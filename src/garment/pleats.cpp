#include "garment/pleats.hpp"

#include "core/elementary.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

namespace toile::internal {
namespace {

constexpr double half_laid_rad = 85.0 / 180 * std::numbers::pi;  // layers lie 10 degrees apart

bool same(const StitchSide& a, const StitchSide& b) { return a.panel == b.panel && a.edge == b.edge; }

const PanelEdge& edge_of(const Pattern& pattern, const StitchSide& side) {
  return pattern.panels[at(side.panel)].edges[at(side.edge)];
}

const StitchSide& other_side(const Stitch& stitch, const StitchSide& side) {
  return same(stitch.a, side) ? stitch.b : stitch.a;
}

// The corner of `band` that the stitch brings this corner of the layer to.
Index band_corner(const PanelEdge& band, const PanelEdge& layer, Index corner, bool right_wrong) {
  return (layer.start == corner) == right_wrong ? band.start : band.end;
}

}  // namespace

std::optional<Pleat> pleat_of(const Pattern& pattern, const std::vector<std::size_t>& stitches) {
  if (stitches.size() != 3) return std::nullopt;
  const std::vector<Stitch>& all = pattern.stitches;
  for (const StitchSide& band : {all[stitches[0]].a, all[stitches[0]].b}) {
    if (!std::all_of(stitches.begin(), stitches.end(),
                     [&](std::size_t s) { return same(all[s].a, band) || same(all[s].b, band); }))
      continue;
    for (const std::size_t under : stitches) {
      std::vector<std::size_t> others;
      for (const std::size_t s : stitches)
        if (s != under && all[s].right_wrong != all[under].right_wrong) others.push_back(s);
      if (others.size() != 2) continue;
      for (int k = 0; k < 2; ++k) {
        Pleat pleat{others[at(k)], under, others[at(1 - k)], band, other_side(all[under], band), {}, -1, -1};
        pleat.c = other_side(all[pleat.inner], band);
        const StitchSide a = other_side(all[pleat.over], band);
        if (pleat.b.panel != pleat.c.panel || pleat.b.panel != a.panel || pleat.b.panel == band.panel) continue;
        const PanelEdge &edge_a = edge_of(pattern, a), &b = edge_of(pattern, pleat.b), &c = edge_of(pattern, pleat.c);
        // a, b, c follow each other: a and b meet at one end of b, b and c at the other.
        const bool forwards = edge_a.end == b.start && b.end == c.start,
                   backwards = c.end == b.start && b.end == edge_a.start;
        if (!forwards && !backwards) continue;
        pleat.tip = forwards ? b.end : b.start;
        pleat.band_end = band_corner(edge_of(pattern, band), b, pleat.tip, all[under].right_wrong);
        if (band_corner(edge_of(pattern, band), c, pleat.tip, all[pleat.inner].right_wrong) != pleat.band_end) continue;
        return pleat;
      }
    }
  }
  return std::nullopt;
}

void lay_pleats(const ClothMesh& mesh, Index panel, std::span<Vec3> x) {
  using PieceEdge = std::pair<Index, Index>;
  std::map<PieceEdge, double> angle_of;
  for (const FoldedEdge& fold : mesh.folds) angle_of[std::minmax(fold.a, fold.b)] = fold.angle_rad;
  std::map<PieceEdge, std::vector<std::size_t>> beside;
  std::vector<std::size_t> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.panel[t] != panel) continue;
    triangles.push_back(t);
    for (std::size_t k = 0; k < 3; ++k)
      beside[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(t);
  }
  if (triangles.empty()) return;
  const std::vector<Vec3> flat(x.begin(), x.end());
  std::map<std::size_t, Eigen::Isometry3d> laid;  // [triangle] where its piece goes
  std::vector<std::size_t> open{triangles.front()};
  laid[open.front()] = Eigen::Isometry3d::Identity();
  Vec3 moved = Vec3::Zero();
  std::vector<char> done(x.size(), 0);
  while (!open.empty()) {
    const std::size_t t = open.back();
    open.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = mesh.triangles[t][k], j = mesh.triangles[t][(k + 1) % 3];
      done[at(i)] = 1;
      x[at(i)] = laid[t] * flat[at(i)];
      const auto fold = angle_of.find(std::minmax(i, j));
      for (const std::size_t next : beside[std::minmax(i, j)]) {
        if (laid.contains(next)) continue;
        Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
        if (fold !=
            angle_of.end()) {  // a ridge turns the part beyond the edge backwards, about the half edge of this side
          const Vec3 axis = (flat[at(j)] - flat[at(i)]).normalized();
          const double half = fold->second > 0 ? half_laid_rad : -half_laid_rad;
          const Eigen::Quaterniond q(ieee_cos(half), ieee_sin(half) * axis.x(), ieee_sin(half) * axis.y(),
                                     ieee_sin(half) * axis.z());
          turn = Eigen::Translation3d(flat[at(i)]) * q * Eigen::Translation3d(-flat[at(i)]);
        }
        laid[next] = laid[t] * turn;
        open.push_back(next);
      }
    }
  }
  double count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!done[i]) continue;
    moved += x[i] - flat[i];
    ++count;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (done[i]) x[i] -= moved / count;
}

std::vector<Pleat> pleats_of(const Pattern& pattern) {
  std::map<std::pair<Index, Index>, std::vector<std::size_t>> stitches_of;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s)
    for (const StitchSide& side : {pattern.stitches[s].a, pattern.stitches[s].b})
      stitches_of[{side.panel, side.edge}].push_back(s);
  std::vector<Pleat> pleats;
  for (const auto& [edge, stitches] : stitches_of)
    if (const std::optional<Pleat> pleat = pleat_of(pattern, stitches)) pleats.push_back(*pleat);
  return pleats;
}

PleatedPattern resolve_pleats(const Pattern& pattern) {
  PleatedPattern resolved{pattern, {}, {}};
  std::vector<char> gone(pattern.stitches.size(), 0);
  for (const Pleat& pleat : pleats_of(pattern)) {
    resolved.pattern.stitches[pleat.under] = {pleat.b, pleat.c};
    gone[pleat.inner] = 1;
    resolved.joins.push_back({pleat.band.panel, pleat.band_end, pleat.b.panel, pleat.tip});
    for (const StitchSide& side : {pleat.band, other_side(pattern.stitches[pleat.over], pleat.band), pleat.b, pleat.c})
      resolved.edges.push_back(side);
  }
  std::vector<Stitch> kept;
  for (std::size_t s = 0; s < gone.size(); ++s)
    if (!gone[s]) kept.push_back(resolved.pattern.stitches[s]);
  resolved.pattern.stitches = std::move(kept);
  return resolved;
}

}  // namespace toile::internal
