// body/mannequin.cpp: puts the mannequin together and measures it.
#include "body/mannequin.hpp"

#include "body/mannequin_shape.hpp"
#include "body/measure.hpp"
#include "body/polygonise.hpp"
#include "body/skin.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {

namespace {

constexpr double grid_cell_m = 0.0100;  // finer than the narrowest gap of the surface, that of the thumb
constexpr int remesh_sweeps = 8;
constexpr double dancer_edges = 1.15;  // times the woman's

constexpr std::array<std::string_view, 3> kind_names = {"woman", "dancer", "man"};  // in the order of MannequinKind

const Vec3& joint_position(const Mannequin& m, std::string_view name) {
  return std::find_if(m.joints.begin(), m.joints.end(), [&](const Joint& j) { return j.name == name; })->position_m;
}

// The trunk's girth at height y.
double trunk_girth(const Mannequin& m, double y) {
  return girth_at_m(m.positions, m.triangles, Vec3(0, y, -0.01), Vec3(0, 1, 0));
}

// Largest (sign +1) or smallest (-1) girth of the trunk between two heights, and its height, in steps of 5 mm.
struct Girth {
  double y, length;
};
Girth extreme_girth(const Mannequin& m, const MannequinForm::Range& heights, double sign) {
  const auto [low, high] = heights;
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
Vec3 acromion(const Mannequin& m, double from) {
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
  for (int i = 0; i < 120; ++i) {
    const double x = from + 0.001 * i;
    if (top(x - span) - top(x + span) > 0.62 * 2 * span) return {x, top(x), plane_z};
  }
  return joint_position(m, "shoulder_left");
}

Mannequin::Measurements measure(const Mannequin& m, const MannequinForm& form) {
  const MannequinForm::Tape& tape = form.tape;
  Mannequin::Measurements out{};
  for (const Vec3& p : m.positions) out.height = std::max(out.height, p.y());
  const double nape = joint_position(m, "neck").y() + tape.nape;
  out.head_length = out.height - nape;
  const Girth waist = extreme_girth(m, tape.waist, -1);
  out.waist_line = nape - waist.y;
  out.waist = waist.length;
  out.bust = extreme_girth(m, tape.bust, 1).length;
  out.hips = extreme_girth(m, tape.hips, 1).length;
  out.neck_girth = extreme_girth(m, tape.neck, -1).length;
  const Vec3 shoulder = acromion(m, tape.acromion_from), wrist = joint_position(m, "wrist_left");
  out.shoulder_width = 2 * shoulder.x();
  out.arm_length = (wrist - shoulder).norm();
  out.wrist = girth_at_m(m.positions, m.triangles, wrist, left_arm_axis(form).along);
  return out;
}

}  // namespace

MannequinKind mannequin_kind(std::string_view name) {
  for (std::size_t i = 0; i < kind_names.size(); ++i)
    if (kind_names[i] == name) return static_cast<MannequinKind>(i);
  throw InputError("", "mannequin",
                   "woman, dancer or man (did you mean " +
                       std::string(nearest_name(name, kind_names.data(), kind_names.size())) + "?)",
                   printable(name));
}

std::string_view to_string(MannequinKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

const MannequinForm& mannequin_form(MannequinKind kind) {
  return kind == MannequinKind::man ? man_form() : woman_form();
}

Mannequin make_mannequin(MannequinKind kind) {
  const MannequinForm& form = mannequin_form(kind);
  const double longer = kind == MannequinKind::dancer ? dancer_edges : 1.0;
  const MannequinShape shape(form);
  const ScalarField field = [&](const Vec3& p) { return shape(p); };
  const ScalarField edge_m = [&](const Vec3& p) { return longer * shape.edge_m(p); };
  HalfSurface half = march_tetrahedra(field, form.mesh.low, form.mesh.high, grid_cell_m);
  remesh(half, field, edge_m, remesh_sweeps);
  HalfSurface whole = mirror(half);

  Mannequin m;
  m.positions = std::move(whole.positions);
  m.triangles = std::move(whole.triangles);
  double sole = m.positions.front().y();
  for (const Vec3& p : m.positions) sole = std::min(sole, p.y());
  for (Vec3& p : m.positions) p.y() -= sole;  // it stands on the ground exactly

  m.joints = mannequin_joints(form);
  m.skin = skin_weights(m.positions, m.triangles, m.joints);
  m.measurements_m = measure(m, form);
  return m;
}

}  // namespace toile::internal
