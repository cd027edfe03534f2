// garment/triangulate.cpp: from the outline to the finished mesh; see triangulate.hpp and docs/theory/meshing.md.
#include "garment/triangulate.hpp"

#include "core/elementary.hpp"
#include "core/error.hpp"
#include "garment/triangulate_improve.hpp"
#include "garment/triangulate_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

namespace toile::internal {

namespace {

constexpr double margin_ratio = 0.6;  // lattice points keep this share of an edge from the outline
constexpr int smoothing_sweeps = 6;

// Inserts the lattice row by row.  The walk to a point starts at its neighbour in the row or, behind a gap, at the
// nearest point of the row before: the way there seldom leaves the outline, and where it does the search of all faces
// is right.
void fill(Delaunay& mesh, const std::vector<GridPoint>& lattice, double edge) {
  std::vector<Index> row, row_before;  // vertices, x rising
  const auto x_of = [&](Index v) { return mesh.points()[at(v)].x; };
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const GridPoint& p = lattice[i];
    if (i > 0 && p.y != lattice[i - 1].y) {
      row_before.swap(row);
      row.clear();
    }
    Index start = row.empty() ? Delaunay::none : row.back();
    if (start == Delaunay::none || p.x - x_of(start) > 1.5 * edge) {
      const auto right = std::lower_bound(row_before.begin(), row_before.end(), p.x,
                                          [&](Index v, std::int32_t x) { return x_of(v) < x; });
      if (right != row_before.end())
        start = *right;
      else if (!row_before.empty())
        start = row_before.back();
    }
    const Index face = mesh.locate(p, mesh.face_of(start == Delaunay::none ? 0 : start));
    TOILE_ASSERT(face != Delaunay::none);
    const Index v = mesh.insert(p, face);
    if (v != Delaunay::none) row.push_back(v);
  }
}

double distance2(const Vec2& p, const FinerZone& zone) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < zone.line.size(); ++k) {
    const Vec2 along = zone.line[k + 1] - zone.line[k], d = p - zone.line[k];
    const double s = std::clamp(d.dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (d - s * along).squaredNorm());
  }
  return least;
}

// The lattice of the whole inside, but where a zone has a finer one of its own; the two keep half an edge apart.
std::vector<GridPoint> outside_zones(const GridOutline& grid, std::vector<GridPoint> lattice, double edge_m,
                                     std::span<const FinerZone> finer) {
  std::erase_if(lattice, [&](const GridPoint& p) {
    return std::any_of(finer.begin(), finer.end(), [&](const FinerZone& zone) {
      const double reach = zone.reach_m + 0.5 * edge_m;
      return zone.edge_m < edge_m && distance2(grid.to_metres(p), zone) < reach * reach;
    });
  });
  return lattice;
}

void fill_zones(Delaunay& mesh, const GridOutline& grid, double edge_m, std::span<const FinerZone> finer) {
  for (std::size_t z = 0; z < finer.size(); ++z) {
    if (finer[z].edge_m >= edge_m) continue;
    const double edge = finer[z].edge_m / grid_step_m;
    std::vector<GridPoint> lattice = lattice_inside(grid.points, edge, margin_ratio * edge);
    std::erase_if(lattice, [&](const GridPoint& p) {
      const Vec2 at_m = grid.to_metres(p);
      if (distance2(at_m, finer[z]) >= finer[z].reach_m * finer[z].reach_m) return true;
      return std::any_of(finer.begin(), finer.begin() + static_cast<std::ptrdiff_t>(z), [&](const FinerZone& before) {
        const double reach = before.reach_m + 0.5 * finer[z].edge_m;
        return before.edge_m < edge_m && distance2(at_m, before) < reach * reach;
      });
    });
    fill(mesh, lattice, edge);
  }
}

}  // namespace

PlanarMesh triangulate(std::span<const Vec2> outline, double edge_m, std::span<const FinerZone> finer) {
  constexpr double shortest_edge_m = 64 * grid_step_m;  // below it the grid itself would spoil the angles
  if (!(edge_m >= shortest_edge_m) || !std::isfinite(edge_m))
    throw InputError("", "edge_m", "an edge length of at least 0.00007 m", shortest_text(edge_m));
  const GridOutline grid = snap_outline(outline);
  const double edge = edge_m / grid_step_m;
  Delaunay mesh(grid.points);
  fill(mesh, outside_zones(grid, lattice_inside(grid.points, edge, margin_ratio * edge), edge_m, finer), edge);
  fill_zones(mesh, grid, edge_m, finer);
  smooth(mesh, smoothing_sweeps);
  improve(mesh, edge);

  PlanarMesh result;
  result.points.assign(outline.begin(), outline.end());
  std::vector<Index> number(mesh.points().size());
  for (std::size_t v = 0; v < number.size(); ++v) {
    const Index vertex = static_cast<Index>(v);
    if (mesh.on_outline(vertex)) {
      number[v] = vertex;
    } else if (mesh.alive(vertex)) {
      number[v] = static_cast<Index>(result.points.size());
      result.points.push_back(grid.to_metres(mesh.points()[v]));
    }
  }
  for (const Delaunay::Face& f : mesh.faces())
    if (f.alive())
      result.triangles.push_back({number[at(f.corner[0])], number[at(f.corner[1])], number[at(f.corner[2])]});
  return result;
}

namespace {

// Point by point across the longer axis, row after row along it: neighbours have numbers near each other.
void number_by_rows(PlanarMesh& mesh, Eigen::Index longer_axis, double row_m) {
  const auto row = [&](const Vec2& p) { return std::lround(p[longer_axis] / row_m); };
  const auto before = [&](Index a, Index b) {
    const Vec2 &p = mesh.points[at(a)], &q = mesh.points[at(b)];
    if (row(p) != row(q)) return row(p) < row(q);
    return p[1 - longer_axis] != q[1 - longer_axis] ? p[1 - longer_axis] < q[1 - longer_axis] : a < b;
  };
  std::vector<Index> order(mesh.points.size()), number(mesh.points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), before);
  std::vector<Vec2> points;
  points.reserve(order.size());
  for (const Index i : order) {
    number[at(i)] = static_cast<Index>(points.size());
    points.push_back(mesh.points[at(i)]);
  }
  mesh.points = std::move(points);
  for (Triangle& t : mesh.triangles) {
    for (Index& corner : t) corner = number[at(corner)];
  }
}

}  // namespace

PlanarMesh equilateral_sheet(double width_m, double height_m, double edge_m) {
  const auto check = [](double value, const char* name) {
    if (!(value > 0) || !std::isfinite(value))
      throw InputError("", name, "a length greater than zero", shortest_text(value));
  };
  check(width_m, "width_m");
  check(height_m, "height_m");
  check(edge_m, "edge_m");
  const double most = 1e6;
  const int nx = static_cast<int>(std::clamp(std::round(width_m / edge_m), 1.0, most));
  const int ny = static_cast<int>(std::clamp(std::round(height_m / edge_m), 1.0, most));
  std::vector<Vec2> outline;
  outline.reserve(2 * (static_cast<std::size_t>(nx) + static_cast<std::size_t>(ny)));
  for (int i = 0; i < nx; ++i) outline.emplace_back(width_m * i / nx, 0.0);
  for (int i = 0; i < ny; ++i) outline.emplace_back(width_m, height_m * i / ny);
  for (int i = nx; i > 0; --i) outline.emplace_back(width_m * i / nx, height_m);
  for (int i = ny; i > 0; --i) outline.emplace_back(0.0, height_m * i / ny);
  PlanarMesh mesh = triangulate(outline, edge_m);
  number_by_rows(mesh, width_m > height_m ? 0 : 1, edge_m * std::sqrt(0.75));
  return mesh;
}

PlanarQuality planar_quality(const PlanarMesh& mesh) {
  PlanarQuality quality;
  std::vector<double> angles;
  struct PlanarEdge {
    Index a, b;
    bool operator<(const PlanarEdge& other) const { return a != other.a ? a < other.a : b < other.b; }
    bool operator==(const PlanarEdge&) const = default;
  };
  std::vector<PlanarEdge> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = t[k], j = t[(k + 1) % 3];
      const Vec2 u = mesh.points[at(j)] - mesh.points[at(i)], v = mesh.points[at(t[(k + 2) % 3])] - mesh.points[at(i)];
      angles.push_back(ieee_atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v)) * (180 / std::numbers::pi));
      edges.push_back({std::min(i, j), std::max(i, j)});
    }
  }
  if (angles.empty()) return quality;
  std::sort(angles.begin(), angles.end());
  quality.min_angle_deg = angles.front();
  quality.p1_angle_deg = angles[angles.size() / 100];
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  double sum = 0;
  quality.min_edge_m = std::numeric_limits<double>::infinity();
  for (const PlanarEdge& e : edges) {
    const double length = (mesh.points[at(e.a)] - mesh.points[at(e.b)]).norm();
    sum += length;
    quality.min_edge_m = std::min(quality.min_edge_m, length);
    quality.max_edge_m = std::max(quality.max_edge_m, length);
  }
  quality.mean_edge_m = sum / static_cast<double>(edges.size());
  return quality;
}

}  // namespace toile::internal
