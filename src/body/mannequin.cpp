// body/mannequin.cpp: puts the mannequin together and measures it.
#include "body/mannequin.hpp"

#include "body/mannequin_shape.hpp"
#include "body/measure.hpp"
#include "body/polygonise.hpp"
#include "body/skin.hpp"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double grid_cell_m = 0.0100;  // finer than the narrowest gap of the surface, that of the thumb
constexpr int remesh_sweeps = 8;

const Vec3& joint_position(const Mannequin& m, std::string_view name) {
  return std::find_if(m.joints.begin(), m.joints.end(), [&](const Joint& j) { return j.name == name; })->position_m;
}

// The trunk's girth at height y.
double trunk_girth(const Mannequin& m, double y) {
  return girth_at_m(m.positions, m.triangles, Vec3(0, y, -0.01), Vec3(0, 1, 0));
}

// Largest (sign +1) or smallest (-1) girth of the trunk between two heights, and where, in steps of 5 mm.
struct Girth {
  double y, length;
};
Girth extreme_girth(const Mannequin& m, double low, double high, double sign) {
  Girth best{low, trunk_girth(m, low)};
  const int steps = static_cast<int>((high - low) / 0.005);
  for (int i = 1; i <= steps; ++i) {
    const double y = low + 0.005 * i, length = trunk_girth(m, y);
    if (sign * length > sign * best.length) best = {y, length};
  }
  return best;
}

// The acromion: going outwards on the shoulder's upper outline (in the plane z of the shoulder joint), the point at
// which it first falls more steeply than 0.62, half-way between the slope of the shoulder and that of the arm.
Vec3 acromion(const Mannequin& m) {
  const double plane_z = joint_position(m, "shoulder_left").z();
  const auto outline = section(m.positions, m.triangles, Vec3(0, 0, plane_z), Vec3(0, 0, 1));
  const auto top = [&](double x) {  // height of the outline over x
    double y = 0;
    for (const auto& curve : outline)
      for (std::size_t i = 0; i < curve.size(); ++i) {
        const Vec3 &a = curve[i], &b = curve[(i + 1) % curve.size()];
        if ((a.x() <= x) == (b.x() <= x)) continue;
        y = std::max(y, a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y()));
      }
    return y;
  };
  constexpr double span = 0.02;  // longer than a triangle
  for (int i = 0; i < 80; ++i) {
    const double x = 0.12 + 0.001 * i;
    if (top(x - span) - top(x + span) > 0.62 * 2 * span) return {x, top(x), plane_z};
  }
  return joint_position(m, "shoulder_left");
}

Mannequin::Measurements measure(const Mannequin& m) {
  Mannequin::Measurements out{};
  for (const Vec3& p : m.positions) out.height = std::max(out.height, p.y());
  const double nape = joint_position(m, "neck").y() + 0.015;
  out.head_length = out.height - nape;
  const Girth waist = extreme_girth(m, 1.000, 1.160, -1);
  out.waist_line = nape - waist.y;
  out.waist = waist.length;
  out.bust = extreme_girth(m, 1.180, 1.270, 1).length;
  out.hips = extreme_girth(m, 0.820, 0.960, 1).length;
  out.neck_girth = extreme_girth(m, 1.465, 1.490, -1).length;
  const Vec3 shoulder = acromion(m), wrist = joint_position(m, "wrist_left");
  out.shoulder_width = 2 * shoulder.x();
  out.arm_length = (wrist - shoulder).norm();
  out.wrist = girth_at_m(m.positions, m.triangles, wrist, left_arm_axis().along);
  return out;
}

}  // namespace

Mannequin make_mannequin() {
  const MannequinShape shape;
  const ScalarField field = [&](const Vec3& p) { return shape(p); };
  const ScalarField edge_m = [&](const Vec3& p) { return shape.edge_m(p); };
  HalfSurface half = march_tetrahedra(field, Vec3(0, -0.04, -0.24), Vec3(0.80, 1.78, 0.28), grid_cell_m);
  remesh(half, field, edge_m, remesh_sweeps);
  HalfSurface whole = mirror(half);

  Mannequin m;
  m.positions = std::move(whole.positions);
  m.triangles = std::move(whole.triangles);
  double sole = m.positions.front().y();
  for (const Vec3& p : m.positions) sole = std::min(sole, p.y());
  for (Vec3& p : m.positions) p.y() -= sole;  // she stands on the ground exactly

  m.joints = mannequin_joints();
  m.skin = skin_weights(m.positions, m.triangles, m.joints);
  m.measurements_m = measure(m);
  return m;
}

}  // namespace toile
