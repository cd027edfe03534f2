// tests/support/tangled_starts.hpp: fifty cloths that pass through themselves or a body, ten kinds with five seeds each.
#pragma once
#include "body/mannequin.hpp"
#include "body/solid_shapes.hpp"
#include "support/bodies.hpp"
#include "support/sheets.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace toile::internal::test {

struct TangledStart {
  std::string name;
  Vec3s x;
  std::vector<Triangle> triangles;
  SolidMesh body;  // empty: none
};

inline constexpr int tangled_kinds = 10, seeds_per_kind = 5;
inline constexpr double tangled_edge_m = 0.012;

// A sheet in the plane y = 0 about the origin, moved.
template <class Map>
void add_sheet(TangledStart& start, double width_m, double height_m, Map&& map, double edge_m = tangled_edge_m) {
  const Sheet sheet = equilateral_sheet(width_m, height_m, edge_m);
  const auto first = static_cast<Index>(start.x.size());
  for (const Vec3& p : sheet.x) start.x.push_back(map(Vec3(p + Vec3(-width_m / 2, 0, height_m / 2))));
  for (Triangle t : sheet.mesh.triangles) {
    for (Index& i : t) i += first;
    start.triangles.push_back(t);
  }
}

// An open tube about the y axis from y = 0 up; its triangles face outwards.
template <class Map>
void add_tube(TangledStart& start, double radius_m, double length_m, Map&& map) {
  const auto around = static_cast<Index>(std::lround(2 * 3.14159265358979324 * radius_m / tangled_edge_m));
  const auto rows = static_cast<Index>(std::lround(length_m / (0.8660254 * tangled_edge_m)));
  const auto first = static_cast<Index>(start.x.size());
  for (Index r = 0; r <= rows; ++r)
    for (Index k = 0; k < around; ++k) {
      const double a = 2 * 3.14159265358979324 * (k + 0.5 * (r & 1)) / around;
      start.x.push_back(map(Vec3(radius_m * std::cos(a), length_m * r / rows, -radius_m * std::sin(a))));
    }
  const auto at = [&](Index r, Index k) { return first + r * around + (k + around) % around; };
  for (Index r = 0; r < rows; ++r)
    for (Index k = 0; k < around; ++k) {
      if (r & 1) {
        start.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k + 1)});
        start.triangles.push_back({at(r, k), at(r + 1, k + 1), at(r + 1, k)});
      } else {
        start.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k)});
        start.triangles.push_back({at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
      }
    }
}

inline Mat3 turn(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * 3.14159265358979324 / 180, axis.normalized()).toRotationMatrix();
}

// A sheet squeezed and waved so that it passes through itself many times.
inline void add_crumpled_sheet(TangledStart& start, Random& random, double edge_m) {
  std::array<Vec3, 6> wave, way;
  std::array<double, 6> phase;
  for (std::size_t k = 0; k < 6; ++k) {
    wave[k] = random.vector(45);
    way[k] = random.vector(0.02);
    phase[k] = random(0, 6);
  }
  add_sheet(
      start, 0.35, 0.35,
      [&](const Vec3& p) {
        Vec3 q(0.7 * p);
        for (std::size_t k = 0; k < 6; ++k) q += std::sin(wave[k].dot(p) + phase[k]) * way[k];
        return q;
      },
      edge_m);
}

// Numbers are drawn one at a time: the order of arguments is the compiler's choice.
inline TangledStart tangled_start(int kind, int seed) {
  Random random(static_cast<std::uint64_t>(1000 * kind + seed) + 1);
  TangledStart start;
  const auto as_it_is = [](const Vec3& p) { return p; };
  switch (kind) {
    case 0: {
      start.name = "two sheets that cross";
      const double about_y = random(-20, 20), about_x = random(25, 90);
      const Mat3 R = turn(about_x, Vec3::UnitX()) * turn(about_y, Vec3::UnitY());
      const double z = random(-0.05, 0.05), y = random(-0.02, 0.02), x = random(-0.02, 0.02);
      const Vec3 shift(x, y, z);
      const Vec3 within(0, 0, random(-0.12, 0.12));
      add_sheet(start, 0.4, 0.4, as_it_is);
      add_sheet(start, random(0.3, 0.5), 0.4, [&](const Vec3& p) { return Vec3(R * (p + within) + shift); });
      break;
    }
    case 1: {
      start.name = "a corner through a sheet";
      const double about_y = random(35, 55), about_x = random(50, 85);
      const Mat3 R = turn(about_x, Vec3::UnitX()) * turn(about_y, Vec3::UnitY());
      const double z = random(-0.04, 0.04), y = random(0.14, 0.18), x = random(-0.04, 0.04);
      const Vec3 shift(x, y, z);
      add_sheet(start, 0.5, 0.5, as_it_is);
      add_sheet(start, 0.3, 0.3, [&](const Vec3& p) { return Vec3(R * p + shift); });
      break;
    }
    case 2: {
      start.name = "a sheet through a sphere, a quarter below its centre";
      const double r = random(0.08, 0.12), z = random(-0.02, 0.02), x = random(-0.02, 0.02);
      const BodySurface ball = sphere(Vec3(x, 0.25 * r, z), r, 4);
      start.body = {{ball.positions().begin(), ball.positions().end()},
                    {ball.triangles().begin(), ball.triangles().end()}};
      const Vec3 axis = random.vector(1);
      const Mat3 R = turn(random(0, 8), axis);
      add_sheet(start, 0.5, 0.5, [&](const Vec3& p) { return Vec3(R * p); });
      break;
    }
    case 3: {
      if (seed >= 3) {
        start.name = "a sheet crumpled through itself";
        add_crumpled_sheet(start, random, tangled_edge_m);
        break;
      }
      start.name = "a folded sheet through itself";
      const double radius = random(0.02, 0.03), past = random(50, 70), skew = random(-8, 8);
      const Mat3 R = turn(skew, Vec3::UnitY());
      add_sheet(start, 0.3, 0.5, [&](const Vec3& p) {  // half lies flat, the rest folds over and passes down through it
        const double s = p.x() + 0.02 * p.z();
        const double bend = (180 + past) * 3.14159265358979324 / 180, length = radius * bend;
        if (s < 0) return p;
        Vec3 q(0, 0, p.z());
        const double a = std::min(s, length) / radius;
        q.x() = radius * std::sin(a);
        q.y() = radius * (1 - std::cos(a));
        if (s > length) q += (s - length) * (R * Vec3(std::cos(bend), std::sin(bend), 0));
        return q;
      });
      break;
    }
    case 4: {
      start.name = "a layer dented through another";
      const double gap = random(0.004, 0.008), depth = random(0.02, 0.05), width = random(0.03, 0.07);
      const double z = random(-0.08, 0.08), x = random(-0.08, 0.08);
      const Vec3 centre(x, 0, z);
      add_sheet(start, 0.4, 0.4, as_it_is);
      add_sheet(start, 0.4, 0.4, [&](const Vec3& p) {
        return Vec3(p + Vec3(0.003, gap - depth * std::exp(-(p - centre).squaredNorm() / (width * width)), 0.004));
      });
      break;
    }
    case 5: {
      start.name = seed < 3 ? "two layers that interleave" : "three layers that interleave";
      const double swell = random(0.006, 0.012), length = random(0.1, 0.25), other = random(0.12, 0.3),
                   phase = random(0, 6);
      add_sheet(start, 0.4, 0.4, as_it_is);
      add_sheet(start, 0.4, 0.4, [&](const Vec3& p) {
        const double wave = std::sin(6.283 * p.x() / length + phase) * std::cos(6.283 * p.z() / other);
        return Vec3(p + Vec3(0.004, 0.002 + swell * wave, -0.003));
      });
      if (seed < 3) break;
      add_sheet(start, 0.4, 0.4, [&](const Vec3& p) {
        const double wave = std::cos(6.283 * p.x() / other + phase) * std::sin(6.283 * p.z() / length);
        return Vec3(p + Vec3(-0.002, -0.001 + swell * wave, 0.005));
      });
      break;
    }
    case 6: {
      start.name = "a sleeve that overlaps an arm";
      const double arm = random(0.04, 0.05), sleeve = arm + random(0.004, 0.012);
      start.body = rounded_cylinder(arm, 0.6, Vec3(0, 0.3, 0));
      const Vec3 axis = random.vector(1);
      const Mat3 R = turn(random(0, 6), axis);
      const double z = random(-0.01, 0.01), x = random(0.012, 0.02);
      const Vec3 shift(x, -0.15, z);
      add_tube(start, sleeve, 0.3, [&](const Vec3& p) { return Vec3(R * p + shift); });
      break;
    }
    case 7: {
      start.name = seed < 3 ? "a tube through a sheet" : "a tube through a tube";
      const double out = random(0.04, 0.1);
      const Vec3 axis = random.vector(1);
      const Mat3 R = turn(random(0, 25), axis);
      if (seed < 3) {
        add_sheet(start, 0.4, 0.4, as_it_is);
      } else {
        add_tube(start, 0.12, 0.3, [&](const Vec3& p) { return Vec3(p.x(), p.z(), 0.1 - p.y()); });
      }
      add_tube(start, random(0.04, 0.06), 0.25, [&](const Vec3& p) { return Vec3(R * (p - Vec3(0, out, 0))); });
      break;
    }
    case 8: {
      start.name = "two sheets slotted into each other";
      const double overlap = random(0.05, 0.15);
      const double about_z = random(-10, 10), about_x = random(60, 120);
      const Mat3 R = turn(about_x, Vec3::UnitX()) * turn(about_z, Vec3::UnitZ());
      add_sheet(start, 0.3, 0.3, as_it_is);
      add_sheet(start, 0.3, 0.3, [&](const Vec3& p) { return Vec3(R * p + Vec3(0.3 - overlap, 0.005, 0.01)); });
      break;
    }
    default: {
      const Mannequin woman = make_mannequin(MannequinKind::dancer);
      start.body = {woman.positions, woman.triangles};
      if (seed < 3) {
        start.name = "a tube around the mannequin's hips, moved into them";
        const double radius = random(0.165, 0.18), low = random(0.72, 0.82);
        const double z = random(-0.03, 0.03), x = random(-0.03, 0.03);
        const Vec3 shift(x, low, z);
        add_tube(start, radius, 0.3, [&](const Vec3& p) { return Vec3(p + shift); });
      } else {
        start.name = "a sleeve around the mannequin's arm, moved into it";
        const auto arm = std::find_if(woman.joints.begin(), woman.joints.end(),
                                      [](const Joint& joint) { return joint.name == "elbow_left"; });
        const Vec3 along = (arm->end_m - arm->position_m).normalized();
        const Mat3 R = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), along).toRotationMatrix();
        const double z = random(-0.025, 0.025), y = random(-0.01, 0.01), x = random(-0.025, 0.025);
        const Vec3 shift(x, y, z);
        add_tube(start, random(0.045, 0.055), 0.18,
                 [&](const Vec3& p) { return Vec3(arm->position_m + R * p + shift); });
      }
      break;
    }
  }
  for (Vec3& p : start.x) p += random.vector(0.03 * tangled_edge_m);  // no two points in one plane by design
  start.name += ", " + std::to_string(seed);
  return start;
}

}  // namespace toile::internal::test
