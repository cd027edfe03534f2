// body/mannequin.cpp: the mannequin's mesh, the weights of its skin, and its measurements.
//
// Weights: a vertex at distance d_j from bone j gets max(0, 1 - (d_j - d_min) / fade)^3, the four largest, normalised: one bone away
// from the joints, a smooth hand-over around them.
#include "body/mannequin.hpp"

#include "body/mannequin_shape.hpp"
#include "body/measure.hpp"
#include "body/polygonise.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double grid_cell_m = 0.0100;  // finer than the narrowest gap of the surface, that of the thumb
constexpr int remesh_sweeps = 8;
constexpr double skin_fade_m = 0.08;

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 axis = b - a;
  const double t = std::clamp((p - a).dot(axis) / axis.dot(axis), 0.0, 1.0);
  return (p - a - t * axis).norm();
}

// 0 for the wrong side's limbs, 1 for the right side's, smooth across the middle: thighs that are close do not share bones.
double same_side(const Joint& joint, const Vec3& p) {
  const bool left = joint.name.ends_with("_left"), right = joint.name.ends_with("_right");
  if (!left && !right) return 1;
  const double s = std::clamp((left ? p.x() : -p.x()) / 0.03 + 0.5, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

SkinWeights weigh(const Vec3& p, const std::vector<Joint>& joints, const std::vector<Vec3>& ends) {
  std::vector<double> distance(joints.size());
  double nearest = 0;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    distance[j] = distance_to_segment(p, joints[j].position_m, ends[j]);
    if (j == 0 || distance[j] < nearest) nearest = distance[j];
  }
  std::vector<std::pair<double, Index>> weighed;  // (-weight, joint): sorts largest first, then by joint
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double near = std::max(0.0, 1.0 - (distance[j] - nearest) / skin_fade_m);
    weighed.emplace_back(-near * near * near * same_side(joints[j], p), static_cast<Index>(j));
  }
  std::sort(weighed.begin(), weighed.end());
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum -= weighed[k].first;
  SkinWeights skin;
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = -weighed[k].first / sum;
    skin.weight[k] = w;
    skin.joint[k] = w > 0 ? weighed[k].second : 0;
  }
  return skin;
}

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

// The acromion: going outwards on the shoulder's upper outline (in the plane z of the shoulder joint), the point at which it first falls
// more steeply than 0.62, half-way between the slope of the shoulder and that of the arm.
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
  std::vector<Vec3> ends;
  for (std::size_t j = 0; j < m.joints.size(); ++j) ends.push_back(bone_end(m.joints, j));
  m.skin.resize(m.positions.size());
  parallel_for(m.positions.size(), 512, [&](std::size_t i) { m.skin[i] = weigh(m.positions[i], m.joints, ends); });
  m.measurements_m = measure(m);
  return m;
}

}  // namespace toile
