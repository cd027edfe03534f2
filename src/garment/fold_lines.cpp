#include "garment/fold_lines.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace toile::internal {
namespace {

using PieceOutline = std::vector<Index>;  // a piece's outline, as numbers of points

double signed_area(const PieceOutline& ring, const std::vector<Vec2>& points) {
  double twice = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 &p = points[at(ring[k])], &q = points[at(ring[(k + 1) % ring.size()])];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return twice / 2;
}

// Cuts the piece that has both ends of the line.  False for a line that runs outside: it leaves pieces of opposite orientation.
bool cut(std::vector<PieceOutline>& pieces, const FoldLine& line, const PieceOutline& between,
         const std::vector<Vec2>& points, const std::string& name) {
  if (line.from == line.to) throw FoldError(name, line, "two ends", "a line that ends where it begins");
  for (PieceOutline& piece : pieces) {
    auto from = std::find(piece.begin(), piece.end(), line.from);
    if (from == piece.end() || std::find(piece.begin(), piece.end(), line.to) == piece.end()) continue;
    std::rotate(piece.begin(), from, piece.end());
    const auto to = std::find(piece.begin(), piece.end(), line.to);
    // piece: from ... to ... ; the line goes from `from` to `to` through `between`.
    PieceOutline left(piece.begin(), to + 1), right(to, piece.end());
    left.insert(left.end(), between.rbegin(), between.rend());
    right.push_back(line.from);
    right.insert(right.end(), between.begin(), between.end());
    if (left.size() < 3 || right.size() < 3) break;
    const bool inside = signed_area(left, points) * signed_area(right, points) >= 0;
    piece = std::move(left);
    pieces.push_back(std::move(right));
    return inside;
  }
  throw FoldError(name, line, "a line from one side of the panel to another that no other fold crosses",
                  "one that is crossed or lies on the outline");
}

}  // namespace

FoldedPlanarMesh triangulate_folded(std::span<const Vec2> outline, std::span<const FoldLine> lines, double edge_m,
                                    std::span<const FinerZone> finer) {
  FoldedPlanarMesh folded;
  if (lines.empty()) {
    folded.mesh = triangulate(outline, edge_m, finer);
    return folded;
  }
  std::vector<Vec2>& points = folded.mesh.points;
  points.assign(outline.begin(), outline.end());
  std::vector<PieceOutline> pieces(1);
  for (std::size_t i = 0; i < outline.size(); ++i) pieces[0].push_back(static_cast<Index>(i));
  std::optional<FoldError> outside;
  for (const FoldLine& line : lines) {
    PieceOutline between;
    for (const Vec2& p : line.between) {
      between.push_back(static_cast<Index>(points.size()));
      points.push_back(p);
    }
    const std::string name = line.name.empty() ? "fold " + std::to_string(folded.line.size()) : line.name;
    if (!cut(pieces, line, between, points, name) && !outside)
      outside = FoldError(name, line, "a line inside the panel", "one that leaves it");
    std::vector<std::array<Index, 2>> edges;
    Index last = line.from;
    for (const Index i : between) {
      edges.push_back({last, i});
      last = i;
    }
    edges.push_back({last, line.to});
    folded.line.push_back(std::move(edges));
  }
  for (const PieceOutline& piece : pieces) {
    std::vector<Vec2> ring;
    for (const Index i : piece) ring.push_back(points[at(i)]);
    PlanarMesh mesh;
    try {
      mesh = triangulate(ring, edge_m, finer);
    } catch (const InputError& error) {
      throw InputError("", "folds", "lines inside the panel that touch neither its outline nor each other",
                       error.what());
    }
    const auto number = [&, first = static_cast<Index>(points.size()) - static_cast<Index>(piece.size())](Index i) {
      return at(i) < piece.size() ? piece[at(i)] : first + i;
    };
    for (const Triangle& t : mesh.triangles)
      folded.mesh.triangles.push_back({number(t[0]), number(t[1]), number(t[2])});
    points.insert(points.end(), mesh.points.begin() + static_cast<std::ptrdiff_t>(piece.size()), mesh.points.end());
  }
  if (outside) throw *outside;  // errors of lines that meet others come first
  return folded;
}

}  // namespace toile::internal
