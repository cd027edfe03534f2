// Meshes and random numbers for the tests of contact/.
#pragma once
#include "core/types.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace toile::internal::contact_test {

inline constexpr double pi = 3.14159265358979324;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double in(double low, double high) { return low + (high - low) * unit(); }
  Vec3 vector(double size) {
    const double x = in(-size, size), y = in(-size, size), z = in(-size, size);
    return {x, y, z};
  }
  Index below(Index count) { return static_cast<Index>(unit() * count); }

 private:
  std::mt19937_64 engine_;
};

struct Mesh {
  Vec3s x;
  std::vector<Triangle> triangles;
};

// Adds a sheet of nx by ny cells in the plane y = height, rows shifted by half an edge as in an equilateral mesh;
// seen from above it is counter-clockwise.
inline void add_sheet(Mesh& mesh, Index nx, Index ny, double edge_m, const Vec3& corner) {
  const auto first = static_cast<Index>(mesh.x.size());
  for (Index j = 0; j <= ny; ++j) {
    for (Index i = 0; i <= nx; ++i) {
      mesh.x.push_back(corner + Vec3((i + 0.5 * (j & 1)) * edge_m, 0, j * edge_m * 0.8660254037844386));
    }
  }
  for (Index j = 0; j < ny; ++j) {
    for (Index i = 0; i < nx; ++i) {
      const Index a = first + j * (nx + 1) + i, c = a + nx + 1;
      if (j & 1) {
        mesh.triangles.push_back({a, c, c + 1});
        mesh.triangles.push_back({a, c + 1, a + 1});
      } else {
        mesh.triangles.push_back({a, c, a + 1});
        mesh.triangles.push_back({a + 1, c, c + 1});
      }
    }
  }
}

// A closed surface over a grid of nu by nv, periodic in both directions.
template <class Surface>
Mesh torus_grid(Index nu, Index nv, Surface&& surface) {
  Mesh mesh;
  for (Index i = 0; i < nu; ++i) {
    for (Index j = 0; j < nv; ++j) mesh.x.push_back(surface(2 * pi * i / nu, 2 * pi * j / nv));
  }
  const auto at = [&](Index i, Index j) { return (i % nu) * nv + j % nv; };
  for (Index i = 0; i < nu; ++i) {
    for (Index j = 0; j < nv; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

inline Mesh torus(Index nu, Index nv, double ring, double tube) {
  return torus_grid(nu, nv, [&](double u, double v) {
    const double r = ring + tube * std::cos(v);
    return Vec3(r * std::cos(u), -tube * std::sin(v), -r * std::sin(u));
  });
}

// A sphere of nu meridians and nv - 1 circles between two poles; radius(direction) shapes it.
template <class Radius>
Mesh ball(Index nu, Index nv, Radius&& radius) {
  Mesh mesh;
  const auto add = [&](const Vec3& direction) { mesh.x.push_back(radius(direction) * direction); };
  add(Vec3(0, 1, 0));
  add(Vec3(0, -1, 0));
  for (Index j = 1; j < nv; ++j) {
    for (Index i = 0; i < nu; ++i) {
      const double polar = pi * j / nv, u = 2 * pi * i / nu;
      add(Vec3(std::sin(polar) * std::cos(u), std::cos(polar), -std::sin(polar) * std::sin(u)));
    }
  }
  const auto at = [&](Index j, Index i) { return 2 + (j - 1) * nu + i % nu; };
  for (Index i = 0; i < nu; ++i) {
    mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
    mesh.triangles.push_back({1, at(nv - 1, i + 1), at(nv - 1, i)});
    for (Index j = 1; j + 1 < nv; ++j) {
      mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return mesh;
}

// An axis-aligned box, twelve triangles.
inline Mesh box(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.x.push_back(Vec3(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// How often the surface winds round p: 1 inside, 0 outside.                                 [van Oosterom & Strackee
// 1983]
inline double winding_number(const Mesh& mesh, const Vec3& p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.x[static_cast<std::size_t>(i)] - p, b = mesh.x[static_cast<std::size_t>(j)] - p,
               c = mesh.x[static_cast<std::size_t>(k)] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * pi);
}

}  // namespace toile::internal::contact_test
