#include "body/middle_line.hpp"

#include "body/arms.hpp"
#include "body/measure.hpp"
#include "core/elementary.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

// Shares of the height, by human proportions [Winter, Biomechanics and Motor Control of Human Movement, 4th ed. 2009, fig. 4.1].
constexpr double ankle_level = 0.04, knee_level = 0.285, shoulder_level = 0.82, head_level = 0.88;
constexpr double ribs_below_arms = 0.07;  // armpits are some 0.04 below the middle of an arm's root
constexpr double hand_over = 0.04;        // the transition from the shoulder's slices to the arm's
constexpr double legs_begin_to_lean = 0.1;
constexpr double least_spine = 0.1;     // between hips and ribs; people have 0.2
constexpr double written_for_m = 1.72;  // the height that a posture's metres refer to
constexpr std::size_t nodes = 128;      // nodes of the bent line, 1 % of the height apart or less

double step(double u, double from, double to) {
  const double w = std::clamp((u - from) / (to - from), 0.0, 1.0);
  return w * w * (3 - 2 * w);
}

Vec3 direction(double angle) { return {-ieee_sin(angle), ieee_cos(angle), 0}; }

[[noreturn]] void no_person(std::string_view file, const std::string& got) {
  throw InputError(file, "body",
                   "an upright person who faces +z, with two arms and hips below them: a body without a skeleton is "
                   "moved by its middle line",
                   got);
}

// The middle of the hips' section, at the height y.
Vec3 middle_of(std::span<const Vec3> x, std::span<const Triangle> triangles, const Vec3& origin, double y) {
  Vec3 middle = origin;
  double longest_m = 0;
  for (const std::vector<Vec3>& curve : section(x, triangles, origin, Vec3::UnitY())) {
    const double girth = girth_m(curve, Vec3::UnitY());
    if (girth <= longest_m) continue;
    longest_m = girth;
    Vec3 low = curve.front(), high = curve.front();
    for (const Vec3& p : curve) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    middle = 0.5 * (low + high);
  }
  middle.y() = y;
  return middle;
}

}  // namespace

MiddleLine::MiddleLine(std::string_view file, std::span<const Vec3> standing, std::span<const Triangle> triangles)
    : standing_(standing.begin(), standing.end()) {
  const Arms arms = find_arms(standing, triangles);
  if (!arms) no_person(file, "no two arms");
  const auto [lowest, highest] =
      std::minmax_element(standing.begin(), standing.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  const double floor_m = lowest->y(), height = highest->y() - floor_m;
  const double roots_m = 0.5 * ((*arms)[0].root.y() + (*arms)[1].root.y()) - floor_m;
  const Level widest = hips(standing, triangles);
  levels_ = {height,
             ankle_level * height,
             knee_level * height,
             widest.height_m - floor_m,
             roots_m - ribs_below_arms * height,
             shoulder_level * height,
             head_level * height};
  if (!(widest.girth_m > 0)) no_person(file, "no hips");
  if (!(levels_.ribs_m - levels_.hips_m >= least_spine * height && roots_m < levels_.shoulders_m))
    no_person(file, fmt::sprintf("hips at %.2f and the roots of the arms at %.2f of the height",
                                 levels_.hips_m / height, roots_m / height));
  middle_ = middle_of(standing, triangles, Vec3(0, widest.height_m, 0), floor_m);
  slice_m_.reserve(standing.size());
  for (std::size_t i = 0; i < standing.size(); ++i) {
    double u = standing[i].y() - floor_m;
    for (const Arm& arm : *arms) {
      const double share = step(arm.past[i], -hand_over * height, 0);
      u += share * (arm.root.y() - floor_m - u);
    }
    slice_m_.push_back(u);
    shares_.push_back(shares_at(u));
  }
}

MiddleLine::Shares MiddleLine::shares_at(double u) const {
  const Levels& l = levels_;
  const double way = legs_begin_to_lean * l.height_m;
  return {step(u, l.ankles_m, l.ankles_m + way) - step(u, l.hips_m - way, l.hips_m), step(u, l.knees_m, l.hips_m),
          step(u, l.ankles_m, l.hips_m), step(u, l.hips_m, l.ribs_m), step(u, l.shoulders_m, l.head_m)};
}

// Positive is to the left, +x.  Of c'_x = -a = lean - tau, to first order, the hips have
//   pelvis_x = lean (hips - ankles - way) - list (hips - knees) / 2
double MiddleLine::lean_of(const Posture& p) const {
  const Levels& l = levels_;
  const double shift = p(Channel::pelvis_x) * l.height_m / written_for_m;
  const double list = degree * p(Channel::pelvis_list);
  return (shift + 0.5 * list * (l.hips_m - l.knees_m)) / (l.hips_m - l.ankles_m - legs_begin_to_lean * l.height_m);
}

MiddleLine::Angles MiddleLine::angles(const Shares& s, const Posture& p, double lean) {
  Angles a;
  a.tilt = degree * (s.list * p(Channel::pelvis_list) - s.spine * (p(Channel::spine_left) + p(Channel::chest_left)) -
                     s.neck * p(Channel::neck_left));
  a.turn = degree * (s.pelvis * p(Channel::pelvis_turn) + s.spine * (p(Channel::spine_turn) + p(Channel::chest_turn)) +
                     s.neck * p(Channel::neck_turn));
  a.line = a.tilt - s.lean * lean;
  return a;
}

// From the soles to the crown, by Simpson's rule.
std::vector<MiddleLine::Node> MiddleLine::bent_line(const Posture& posture, double lean) const {
  const double h = levels_.height_m / static_cast<double>(nodes);
  const auto slope = [&](double u) { return direction(angles(shares_at(u), posture, lean).line); };
  std::vector<Node> line{{middle_, slope(0)}};
  line.reserve(nodes + 1);
  for (std::size_t k = 0; k < nodes; ++k) {
    const double u = static_cast<double>(k) * h;
    const Vec3 high = slope(u + h);
    line.push_back({line.back().place + h / 6 * (line.back().slope + 4 * slope(u + 0.5 * h) + high), high});
  }
  return line;
}

void MiddleLine::bend(const Posture& posture, std::span<Vec3> x) const {
  if (std::all_of(posture.values.begin(), posture.values.end(), [](double v) { return v == 0; })) {
    std::copy(standing_.begin(), standing_.end(), x.begin());  // to the bit
    return;
  }
  const double lean = lean_of(posture);
  const std::vector<Node> line = bent_line(posture, lean);
  const double h = levels_.height_m / static_cast<double>(nodes);
  parallel_for(standing_.size(), 1024, [&](std::size_t i) {
    const double u = slice_m_[i];
    const Angles a = angles(shares_[i], posture, lean);
    x[i] = standing_[i];
    if (u <= levels_.ankles_m) return;
    // Between nodes a cubic through their places and directions: C1.
    const auto k = static_cast<std::size_t>(std::clamp(u / h, 0.0, static_cast<double>(nodes - 1)));
    const double w = u / h - static_cast<double>(k);
    const Node &low = line[k], &high = line[k + 1];
    const Vec3 c = (1 + 2 * w) * (1 - w) * (1 - w) * low.place + w * (1 - w) * (1 - w) * h * low.slope +
                   w * w * (3 - 2 * w) * high.place + w * w * (w - 1) * h * high.slope;
    const Vec3 p = standing_[i] - middle_ - Vec3(0, u, 0);
    const double ct = ieee_cos(a.turn), st = ieee_sin(a.turn);
    const Vec3 turned(ct * p.x() + st * p.z(), p.y(), ct * p.z() - st * p.x());
    const double cl = ieee_cos(a.tilt), sl = ieee_sin(a.tilt);
    x[i] = c + Vec3(cl * turned.x() - sl * turned.y(), sl * turned.x() + cl * turned.y(), turned.z());
  });
}

}  // namespace toile::internal
