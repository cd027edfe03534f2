// garment/fold_lines.hpp: a panel with lines across it that the mesh's edges must follow.
//
// Each line cuts the outline in two.  The pieces are triangulated one by one and share the points on the line, so the
// line needs no recovery inside the triangulation: to each piece it is outline, which nothing may flip or cut.
//
// Easily got wrong: lines end at points of the outline.  One that ends on another line or crosses it leaves
// no simple piece and is refused.
#pragma once
#include "core/error.hpp"
#include "garment/triangulate.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct FoldLine {
  Index from = 0, to = 0;     // points of the outline
  std::vector<Vec2> between;  // the points between, in order, m
  std::string name = {};      // for messages; empty: "fold 1"
  std::string path = {};      // of InputError
};

// A line that cannot cut the panel; the message names the line.
class FoldError : public InputError {
 public:
  FoldError(const std::string& name, const FoldLine& line, std::string_view expected, std::string_view got)
      : InputError(InputError(name, "", expected, got).of(line.path)) {}
};

struct FoldedPlanarMesh {
  PlanarMesh mesh;  // outline points, then points of the lines in order, then the rest
  std::vector<std::vector<std::array<Index, 2>>> line;  // [line] its edges, from `from` to `to`
};

// Without lines it is triangulate(outline, edge_m, finer), to the bit, and throws as that does.  Throws FoldError for a line that cannot cut the panel
// in two or leaves it, and InputError for "folds" when a piece between them cannot be meshed.
FoldedPlanarMesh triangulate_folded(std::span<const Vec2> outline, std::span<const FoldLine> lines, double edge_m,
                                    std::span<const FinerZone> finer = {});

}  // namespace toile::internal
