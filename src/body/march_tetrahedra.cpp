// body/march_tetrahedra.cpp: the rough mesh of an implicit surface, and the mirroring of a half.
//
// A tetrahedron (a, b, c, d) with det(b-a, c-a, d-a) > 0 and only a inside gives the triangle (ab, ac, ad), which
// looks away from a; with a, b inside it gives the quad ab -> (ac, ad, bd, bc).  Other cases are even permutations
// of these two.
#include "body/polygonise.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

namespace {

struct Grid {
  Vec3 low;
  double cell_m;
  std::array<Index, 3> nodes;
  Index index(Index i, Index j, Index k) const { return (k * nodes[1] + j) * nodes[0] + i; }
  Vec3 position(Index node) const {
    const Index i = node % nodes[0], j = node / nodes[0] % nodes[1], k = node / (nodes[0] * nodes[1]);
    return {low.x() + cell_m * i, low.y() + cell_m * j, low.z() + cell_m * k};
  }
};

// Corner bits of the six tetrahedra of a cube: the paths from corner 0 to corner 7 along the axes; positively oriented.
constexpr std::array<std::array<Index, 4>, 6> kuhn = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};
constexpr std::array<std::array<Index, 4>, 4> alone_first = {{{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
constexpr std::array<std::array<Index, 4>, 6> pair_first = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

class Marcher {
 public:
  Marcher(const Grid& grid, const std::vector<double>& value)
      : grid_(grid), value_(value), on_edge_(value.size() * 8, -1) {}

  void tetrahedron(const std::array<Index, 4>& node) {
    int mask = 0;
    for (int k = 0; k < 4; ++k) mask |= (inside(node[static_cast<std::size_t>(k)]) ? 1 : 0) << k;
    if (mask == 0 || mask == 15) return;
    for (std::size_t k = 0; k < 4; ++k) {
      if (mask != 1 << k && mask != (15 ^ (1 << k))) continue;
      const auto& p = alone_first[k];
      const auto at = [&](std::size_t i) { return node[static_cast<std::size_t>(p[i])]; };
      const Index ab = cut(at(0), at(1)), ac = cut(at(0), at(2)), ad = cut(at(0), at(3));
      if (mask == 1 << k) {
        surface_.triangles.push_back({ab, ac, ad});
      } else {
        surface_.triangles.push_back({ab, ad, ac});
      }
      return;
    }
    for (const auto& p : pair_first) {
      if (mask != ((1 << p[0]) | (1 << p[1]))) continue;
      const auto at = [&](std::size_t i) { return node[static_cast<std::size_t>(p[i])]; };
      const Index ac = cut(at(0), at(2)), ad = cut(at(0), at(3)), bd = cut(at(1), at(3)), bc = cut(at(1), at(2));
      surface_.triangles.push_back({ac, ad, bd});
      surface_.triangles.push_back({ac, bd, bc});
      return;
    }
  }

  HalfSurface take() { return std::move(surface_); }

 private:
  bool inside(Index node) const { return value_[static_cast<std::size_t>(node)] < 0; }

  // The vertex on the edge of two nodes.  The nodes of a cube differ by 0 or 1 along each axis, always upwards.
  Index cut(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const Index step = b - a, row = grid_.nodes[0], slice = row * grid_.nodes[1];
    const Index dz = step >= slice ? 1 : 0, dy = step - dz * slice >= row ? 1 : 0, dx = step - dz * slice - dy * row;
    Index& vertex = on_edge_[static_cast<std::size_t>(a) * 8 + static_cast<std::size_t>(4 * dz + 2 * dy + dx)];
    if (vertex < 0) {
      const double fa = value_[static_cast<std::size_t>(a)], fb = value_[static_cast<std::size_t>(b)];
      // Off the nodes, so that no triangle degenerates; remeshing moves the vertex onto the surface.
      const double t = std::clamp(fa / (fa - fb), 0.1, 0.9);
      vertex = static_cast<Index>(surface_.positions.size());
      surface_.positions.push_back((1.0 - t) * grid_.position(a) + t * grid_.position(b));
    }
    return vertex;
  }

  const Grid& grid_;
  const std::vector<double>& value_;
  std::vector<Index> on_edge_;
  HalfSurface surface_;
};

}  // namespace

HalfSurface march_tetrahedra(const ScalarField& field, const Vec3& low, const Vec3& high, double cell_m) {
  Grid grid{low, cell_m, {}};
  for (int d = 0; d < 3; ++d)
    grid.nodes[static_cast<std::size_t>(d)] = static_cast<Index>(std::floor((high[d] - low[d]) / cell_m)) + 2;
  const Index count = grid.nodes[0] * grid.nodes[1] * grid.nodes[2];
  std::vector<double> value(static_cast<std::size_t>(count));
  parallel_for(value.size(), 4096, [&](std::size_t i) { value[i] = field(grid.position(static_cast<Index>(i))); });

  Marcher marcher(grid, value);
  for (Index k = 0; k + 1 < grid.nodes[2]; ++k)
    for (Index j = 0; j + 1 < grid.nodes[1]; ++j)
      for (Index i = 0; i + 1 < grid.nodes[0]; ++i) {
        std::array<Index, 8> corner;
        for (Index c = 0; c < 8; ++c)
          corner[static_cast<std::size_t>(c)] = grid.index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
        for (const auto& t : kuhn) {
          std::array<Index, 4> node;
          for (std::size_t v = 0; v < 4; ++v) node[v] = corner[static_cast<std::size_t>(t[v])];
          marcher.tetrahedron(node);
        }
      }
  return marcher.take();
}

HalfSurface mirror(const HalfSurface& half) {
  const std::size_t n = half.positions.size();
  std::vector<Index> here(n), there(n);
  HalfSurface whole;
  for (std::size_t i = 0; i < n; ++i)
    if (half.positions[i].x() == 0) {
      here[i] = there[i] = static_cast<Index>(whole.positions.size());
      whole.positions.push_back(half.positions[i]);
    }
  const Index on_plane = static_cast<Index>(whole.positions.size());
  const Index beside = static_cast<Index>(n) - on_plane;
  for (std::size_t i = 0; i < n; ++i)
    if (half.positions[i].x() != 0) {
      here[i] = static_cast<Index>(whole.positions.size());
      there[i] = here[i] + beside;
      whole.positions.push_back(half.positions[i]);
    }
  for (Index i = on_plane; i < on_plane + beside; ++i) {
    const Vec3 p = whole.positions[static_cast<std::size_t>(i)];
    whole.positions.emplace_back(-p.x(), p.y(), p.z());
  }
  const auto map = [](const std::vector<Index>& to, Index i) { return to[static_cast<std::size_t>(i)]; };
  for (const Triangle& t : half.triangles)
    whole.triangles.push_back({map(here, t[0]), map(here, t[1]), map(here, t[2])});
  for (const Triangle& t : half.triangles)
    whole.triangles.push_back({map(there, t[0]), map(there, t[2]), map(there, t[1])});
  return whole;
}

}  // namespace toile::internal
