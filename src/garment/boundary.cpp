#include "garment/boundary.hpp"

#include "core/disjoint_sets.hpp"

#include <limits>
#include <map>
#include <span>
#include <utility>

namespace toile::internal {
namespace {

using Side = std::pair<Index, Index>;  // panel, edge

struct Partner {
  Side side;
  bool right_wrong;
};

struct PieceBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

constexpr int edge_samples = 16;  // of an edge, for middles, boxes and areas: to some per mille

using Partners = std::map<Side, Partner>;

// Pieces that no stitch connects, into boundary.pieces.  Returns the piece of each panel.
std::vector<Index> find_pieces(const Pattern& pattern, std::span<const Index> representative, Boundary& boundary) {
  std::vector<Index> piece(pattern.panels.size(), -1);
  std::vector<PieceBox> boxes;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const std::size_t first = at(representative[p]);
    if (first == p) {
      piece[p] = static_cast<Index>(boundary.pieces.size());
      boundary.pieces.emplace_back();
      boxes.emplace_back();
    }
    piece[p] = piece[first];
    GarmentPiece& mine = boundary.pieces[at(piece[p])];
    mine.panels.push_back(static_cast<Index>(p));
    const Panel& panel = pattern.panels[p];
    double twice_area = 0;
    Vec2 moment{0, 0};
    const Vec2 origin = panel.corners.front();  // moments about a point far away would lose digits
    for (const PanelEdge& edge : panel.edges) {
      const std::vector<Vec2> points = sample_edge(panel, edge, edge.kind == CurveKind::line ? 1 : edge_samples);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec2 u = points[k] - origin, v = points[k + 1] - origin;
        const double cross = u.x() * v.y() - u.y() * v.x();
        twice_area += cross;
        moment += cross / 3 * (u + v);
        boxes[at(piece[p])].add(panel.place(points[k]));
      }
    }
    if (twice_area == 0) continue;
    const double area = 0.5 * (twice_area < 0 ? -twice_area : twice_area);
    mine.area_m2 += area;
    mine.middle_m += area * panel.place(origin + moment / twice_area);
  }
  for (std::size_t k = 0; k < boundary.pieces.size(); ++k) {
    GarmentPiece& mine = boundary.pieces[k];
    if (mine.area_m2 > 0) mine.middle_m /= mine.area_m2;
    mine.low_m = boxes[k].low;
    mine.high_m = boxes[k].high;
  }

  return piece;
}

// The open edges from `side` on, until they return to it.
Opening walk_along(const Pattern& pattern, const Partners& partner, std::size_t edges, Side side,
                   std::map<Side, char>& passed) {
  Opening opening;
  PieceBox box;
  bool forward = true;
  while (passed.try_emplace(side, 1).second) {
    const Panel& panel = pattern.panels[at(side.first)];
    const PanelEdge& edge = panel.edges[at(side.second)];
    const double length = edge_length_m(panel, edge);
    opening.edges.push_back({side.first, side.second});
    opening.girth_m += length;
    Vec3 middle = Vec3::Zero();
    const std::vector<Vec2> points = sample_edge(panel, edge, edge_samples);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3 placed = panel.place(points[k]);
      box.add(placed);
      middle += (k == 0 || k + 1 == points.size() ? 0.5 : 1.0) / edge_samples * placed;
    }
    opening.middle_m += length * middle;
    const auto step = [&](const Side& from) {
      const auto count = static_cast<Index>(pattern.panels[at(from.first)].edges.size());
      return Side{from.first, (from.second + (forward ? 1 : count - 1)) % count};
    };
    side = step(side);
    for (std::size_t crossed = 0; crossed <= edges; ++crossed) {
      const auto found = partner.find(side);
      if (found == partner.end()) break;
      if (found->second.right_wrong) forward = !forward;
      side = step(found->second.side);
    }
  }
  if (opening.girth_m > 0) opening.middle_m /= opening.girth_m;
  opening.low_m = box.low;
  opening.high_m = box.high;
  return opening;
}

}  // namespace

Boundary find_boundary(const Pattern& pattern) {
  Boundary boundary;
  Partners partner;
  DisjointSets sets(pattern.panels.size());
  for (const Stitch& stitch : pattern.stitches) {
    const Side a{stitch.a.panel, stitch.a.edge}, b{stitch.b.panel, stitch.b.edge};
    partner[a] = {b, stitch.right_wrong};
    partner[b] = {a, stitch.right_wrong};
    sets.join(stitch.a.panel, stitch.b.panel);
  }
  const std::vector<Index> piece = find_pieces(pattern, sets.representatives(), boundary);

  std::map<Side, char> passed;
  std::size_t edges = 0;
  for (const Panel& panel : pattern.panels) edges += panel.edges.size();
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    for (std::size_t e = 0; e < pattern.panels[p].edges.size(); ++e) {
      const Side side{static_cast<Index>(p), static_cast<Index>(e)};
      if (partner.contains(side) || passed.contains(side)) continue;
      Opening opening = walk_along(pattern, partner, edges, side, passed);
      opening.piece = piece[p];
      boundary.openings.push_back(std::move(opening));
    }
  }
  return boundary;
}

}  // namespace toile::internal
