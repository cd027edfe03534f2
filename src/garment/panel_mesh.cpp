#include "garment/panel_mesh.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "garment/gathers.hpp"
#include "garment/pattern_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <iterator>

namespace toile::internal {
namespace {

double signed_area(std::span<const Vec2> outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &p = outline[i], &q = outline[(i + 1) % outline.size()];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * twice;
}

int piece_count(double length_m, double resolution_m) {
  return std::max(1, static_cast<int>(std::ceil(length_m / resolution_m - 1e-9)));
}

using Dart = std::array<Index, 2>;  // legs, as edges of the panel, in the outline's order: the tip is between them

std::vector<std::vector<Dart>> darts_of_panels(const Pattern& pattern) {
  std::vector<std::vector<Dart>> darts(pattern.panels.size());
  for (const Stitch& stitch : pattern.stitches) {
    if (!is_dart(pattern, stitch)) continue;
    const Panel& panel = pattern.panels[at(stitch.a.panel)];
    const bool a_first = panel.edges[at(stitch.a.edge)].end == panel.edges[at(stitch.b.edge)].start;
    darts[at(stitch.a.panel)].push_back(a_first ? Dart{stitch.a.edge, stitch.b.edge}
                                                : Dart{stitch.b.edge, stitch.a.edge});
  }
  return darts;
}

// The number of pieces of every edge of every panel, equal on both sides of a seam.
std::vector<std::vector<int>> pieces_of_edges(const Pattern& pattern, std::span<const StitchSide> halved,
                                              double resolution_m) {
  std::vector<std::vector<int>> pieces(pattern.panels.size());
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    for (const PanelEdge& edge : pattern.panels[p].edges)
      pieces[p].push_back(piece_count(edge_length_m(pattern.panels[p], edge), resolution_m));
  }
  for (const StitchSide& side : halved) {
    int& count = pieces[at(side.panel)][at(side.edge)];
    count = std::max(count, 2);
  }
  for (const Stitch& stitch : pattern.stitches) {
    int &a = pieces[at(stitch.a.panel)][at(stitch.a.edge)], &b = pieces[at(stitch.b.panel)][at(stitch.b.edge)];
    a = b = std::max(a, b);
  }
  for (const GatheredSeam& seam : gathered_seams(pattern)) {
    int& longer = pieces[at(seam.longer.panel)][at(seam.longer.edge)];
    longer = std::max(longer, piece_count(seam.length_m, gather_edge_m(resolution_m)));
    pieces[at(seam.shorter.panel)][at(seam.shorter.edge)] = longer;
  }
  return pieces;
}

// Where a dart opens as wide as a straight line, as in a pleat, the first points of its legs may have a neighbour in common beside the tip.
// The two edges to it would be one after the weld, with four triangles: one of them gets a point in its middle.
void part_common_neighbours(PlanarMesh& mesh, Index tip, Index leg_a, Index leg_b) {
  const auto beside = [&](Index i) {  // neighbours but for the tip, ascending
    std::vector<Index> found;
    for (const Triangle& t : mesh.triangles) {
      if (std::find(t.begin(), t.end(), i) == t.end()) continue;
      std::copy_if(t.begin(), t.end(), std::back_inserter(found), [&](Index k) { return k != i && k != tip; });
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  };
  const std::vector<Index> beside_a = beside(leg_a), beside_b = beside(leg_b);
  std::vector<Index> common;
  std::set_intersection(beside_a.begin(), beside_a.end(), beside_b.begin(), beside_b.end(), std::back_inserter(common));
  for (const Index p : common) {
    const auto middle = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(0.5 * (mesh.points[at(leg_b)] + mesh.points[at(p)]));
    for (std::size_t t = 0, count = mesh.triangles.size(); t < count; ++t) {
      const Triangle whole = mesh.triangles[t];
      if (std::find(whole.begin(), whole.end(), leg_b) == whole.end()) continue;
      if (std::find(whole.begin(), whole.end(), p) == whole.end()) continue;
      Triangle other = whole;
      std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), leg_b, middle);
      std::replace(other.begin(), other.end(), p, middle);
      mesh.triangles.push_back(other);
    }
  }
}

PanelMesh mesh_panel(const Panel& panel, const std::vector<int>& pieces, const std::vector<char>& gathered,
                     std::span<const Dart> darts, double resolution_m) {
  std::vector<Vec2> outline;
  std::vector<FinerZone> finer;
  PanelMesh mesh;
  for (std::size_t e = 0; e < panel.edges.size(); ++e) {
    const std::vector<Vec2> points = sample_edge(panel, panel.edges[e], pieces[e]);
    if (gathered[e])
      finer.push_back({points, std::max(gather_reach_m, gather_reach_edges * gather_edge_m(resolution_m)),
                       gather_edge_m(resolution_m)});
    mesh.edge_points.emplace_back();
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      mesh.edge_points.back().push_back(static_cast<Index>(outline.size()));
      outline.push_back(points[k]);
    }
  }
  for (std::size_t e = 0; e < panel.edges.size(); ++e)
    mesh.edge_points[e].push_back(mesh.edge_points[(e + 1) % panel.edges.size()].front());
  std::vector<FoldLine> lines;
  for (const PanelFold& fold : panel.folds) {
    const auto corner = [&](Index c) {  // as a point of the outline
      for (std::size_t e = 0; e < panel.edges.size(); ++e) {
        if (panel.edges[e].start == c) return mesh.edge_points[e].front();
      }
      return Index{-1};
    };
    const std::vector<Vec2> points =
        sample_edge(panel, fold.line, piece_count(edge_length_m(panel, fold.line), resolution_m));
    lines.push_back({corner(fold.line.start), corner(fold.line.end),
                     std::vector<Vec2>(points.begin() + 1, points.end() - 1), name_of_fold(panel, lines.size()),
                     path_of_fold(panel, lines.size())});
  }
  try {
    mesh.folded = triangulate_folded(outline, lines, resolution_m, finer);
  } catch (const FoldError&) {
    throw;
  } catch (const InputError& error) {
    throw InputError("", "panel " + printable(panel.name), "an outline that can be meshed at this resolution",
                     error.what());
  }
  for (const auto& [first, second] : darts) {  // the end of the first leg is the start of the second: the tip
    const std::vector<Index>&a = mesh.edge_points[at(first)], &b = mesh.edge_points[at(second)];
    part_common_neighbours(mesh.folded.mesh, b.front(), a[a.size() - 2], b[1]);
  }
  mesh.outline_points = outline.size();
  mesh.mirrored = signed_area(outline) < 0;
  return mesh;
}

}  // namespace

std::span<const PanelMesh> PanelMesher::mesh(double outline_m, std::span<const double> inner_m) {
  const std::size_t panels = pattern_->panels.size();
  const std::vector<std::vector<int>> pieces = pieces_of_edges(*pattern_, halved_, outline_m);
  std::vector<std::vector<char>> gathered(panels);
  for (std::size_t p = 0; p < panels; ++p) gathered[p].assign(pattern_->panels[p].edges.size(), 0);
  for (const GatheredSeam& seam : gathered_seams(*pattern_)) gathered[at(seam.longer.panel)][at(seam.longer.edge)] = 1;
  const std::vector<std::vector<Dart>> darts = darts_of_panels(*pattern_);
  asked_.resize(panels);
  meshes_.resize(panels);
  std::vector<std::exception_ptr> failed(panels);
  parallel_for(panels, 1, [&](std::size_t p) {
    const Asked asked{pieces[p], inner_m[p]};
    if (asked_[p] == asked) return;
    try {
      meshes_[p] = mesh_panel(pattern_->panels[p], asked.pieces, gathered[p], darts[p], asked.inner_m);
      asked_[p] = asked;
    } catch (...) {
      asked_[p] = {};
      failed[p] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : failed)
    if (error) std::rethrow_exception(error);
  return meshes_;
}

}  // namespace toile::internal
