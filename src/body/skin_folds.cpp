#include "body/skin_folds.hpp"

#include "contact/body_surface.hpp"
#include "core/parallel.hpp"
#include "mesh/corner_normal.hpp"

#include <algorithm>
#include <cmath>

namespace toile::internal {
namespace {

constexpr double least_hz = 30;
constexpr int passes = 3;
constexpr double largest_share = 0.01, of_limb = 0.25;
constexpr double just_outside_m = 1e-4;
constexpr double least_m = 1e-5;
constexpr std::size_t grain = 64;

double height_of(std::span<const Vec3> x) {
  double low = x.front().y(), high = low;
  for (const Vec3& p : x) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  return high - low;
}

// The distance along its normal to skin that looks back, up to `room`; negative within another part, and -deepest where its skin is farther.
double gap_before(const BodySurface& skin, Index vertex, const Vec3& n, double room, double deepest) {
  const Vec3& x = skin.positions()[at(vertex)];
  if (skin.winding_number(x + just_outside_m * n) > 0) {
    const BodyPoint behind = skin.nearest_facing(x, -n, deepest);
    return behind.triangle < 0 ? -deepest : std::clamp(behind.gap_m, -deepest, 0.0);
  }
  const BodyPoint before = skin.nearest_opposite(x, n, room);
  return before.triangle < 0 ? room : std::clamp(before.gap_m, 0.0, room);
}

class Yielding {
 public:
  Yielding(const PosedBody& body, double room_m)
      : body_(&body), x_(body.vertices.size()), room_(x_.size(), room_m), largest_(x_.size()) {
    body.place(body.figure->rest, x_);
    skin_ = BodySurface(x_, {body.triangles.begin(), body.triangles.end()});
    const double deepest = largest_share * height_of(x_);
    parallel_for(x_.size(), grain, [&](std::size_t i) {
      const auto vertex = static_cast<Index>(i);
      const Vec3& n = skin_.vertex_normal(vertex);
      room_[i] = gap_before(skin_, vertex, n, room_m, deepest);
      const double thick = deepest / of_limb;
      const BodyPoint back = skin_.nearest_facing(x_[i], -n, thick);
      largest_[i] = of_limb * (back.triangle < 0 ? thick : std::min(thick, std::abs(back.gap_m)));
    });
  }

  std::vector<double> depths(const FigurePose& pose) {
    body_->place(pose, x_);
    std::vector<double> depth(x_.size(), 0);
    std::vector<Vec3> n(x_.size()), yielded = x_;
    for (int pass = 0; pass < passes; ++pass) {
      skin_.set_motion(yielded, yielded);
      parallel_for(x_.size(), grain, [&](std::size_t i) {
        const auto vertex = static_cast<Index>(i);
        if (pass == 0) n[i] = skin_.vertex_normal(vertex);
        if (room_[i] <= 0 || (pass > 0 && !near_[i])) return;
        const double missing = room_[i] - gap_before(skin_, vertex, n[i], room_[i], 2 * largest_[i]);
        depth[i] = std::min(largest_[i], depth[i] + 0.5 * missing);
      });
      if (pass == 0) mark_near(depth);
      for (std::size_t i = 0; i < x_.size(); ++i) yielded[i] = x_[i] - depth[i] * n[i];
    }
    return depth;
  }

 private:
  // What yields, and its neighbours.
  void mark_near(std::span<const double> depth) {
    near_.assign(depth.size(), 0);
    for (const Triangle& t : body_->triangles)
      if (std::any_of(t.begin(), t.end(), [&](Index i) { return depth[at(i)] > 0; }))
        for (const Index i : t) near_[at(i)] = 1;
  }

  const PosedBody* body_;
  std::vector<Vec3> x_;
  std::vector<double> room_, largest_;
  std::vector<char> near_;
  BodySurface skin_;
};

// [sample] the mean over one before and after, twice, of the largest of two before and after: nowhere less.
void without_corners(std::vector<double>& depth, bool loops) {
  const auto count = static_cast<std::ptrdiff_t>(depth.size());
  const auto at_place = [&](const std::vector<double>& from, std::ptrdiff_t k) {
    const std::ptrdiff_t round = count - 1;
    if (loops && round > 0) return from[static_cast<std::size_t>(((k % round) + round) % round)];
    return from[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, count - 1))];
  };
  std::vector<double> next(depth.size());
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    double most = 0;
    for (std::ptrdiff_t d = -2; d <= 2; ++d) most = std::max(most, at_place(depth, k + d));
    next[static_cast<std::size_t>(k)] = most;
  }
  depth = next;
  for (int twice = 0; twice < 2; ++twice) {
    for (std::ptrdiff_t k = 0; k < count; ++k)
      next[static_cast<std::size_t>(k)] = (at_place(depth, k - 1) + at_place(depth, k) + at_place(depth, k + 1)) / 3;
    depth = next;
  }
}

}  // namespace

SkinFolds::SkinFolds(const PosedBody& body, double room_m, const PoseTrack& track)
    : triangles_(body.triangles.begin(), body.triangles.end()), loops_(track.loops) {
  const std::size_t stride = static_cast<std::size_t>(std::max(1.0, std::floor(track.rate_hz / least_hz)));
  const std::size_t intervals = std::max<std::size_t>(1, (track.poses.size() - 1) / stride);
  rate_hz_ = track.poses.size() > 1 ? static_cast<double>(intervals) / track.length_s() : 1;
  Yielding yielding(body, room_m);
  std::vector<std::vector<double>> found;
  for (std::size_t k = 0; k <= intervals; ++k)
    found.push_back(yielding.depths(pose_at(track, static_cast<double>(k) / rate_hz_)));
  samples_ = found.size();
  std::vector<std::vector<double>> ways;
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    std::vector<double> way;
    for (const std::vector<double>& depths : found) way.push_back(depths[i]);
    const double most = *std::max_element(way.begin(), way.end());
    if (most < least_m) continue;
    deepest_m_ = std::max(deepest_m_, most);
    without_corners(way, loops_);
    vertices_.push_back(static_cast<Index>(i));
    ways.push_back(std::move(way));
  }
  for (std::size_t sample = 0; sample < samples_; ++sample)
    for (const std::vector<double>& way : ways) depth_m_.push_back(way[sample]);
  std::vector<Index> number(body.vertices.size(), -1);
  for (std::size_t k = 0; k < vertices_.size(); ++k) number[at(vertices_[k])] = static_cast<Index>(k);
  around_.resize(vertices_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const Index i : triangles_[t])
      if (number[at(i)] >= 0) around_[at(number[at(i)])].push_back(static_cast<Index>(t));
}

// Catmull-Rom as the poses (rig/pose_track.hpp), one-sided at the ends.
double SkinFolds::depth(std::size_t k, double track_s) const {
  const std::size_t intervals = samples_ - 1;
  if (intervals == 0) return depth_m_[k];
  const auto all = static_cast<double>(intervals);
  double place = std::max(track_s, 0.0) * rate_hz_;
  place = loops_ ? place - all * std::floor(place / all) : std::min(place, all);
  const std::size_t i = std::min(static_cast<std::size_t>(place), intervals - 1);
  const double u = place - static_cast<double>(i), r = 1 - u;
  const auto of = [&](std::size_t sample) { return depth_m_[sample * vertices_.size() + k]; };
  const std::size_t before = i > 0 ? i - 1 : (loops_ ? intervals - 1 : 0);
  const std::size_t after = i + 2 <= intervals ? i + 2 : (loops_ ? 1 : intervals);
  const double d0 = of(i), d1 = of(i + 1);
  const double m0 = (d1 - of(before)) * (before == i ? 1.0 : 0.5), m1 = (of(after) - d0) * (after == i + 1 ? 1.0 : 0.5);
  return (1 + 2 * u) * r * r * d0 + u * r * r * m0 + u * u * (3 - 2 * u) * d1 - u * u * r * m1;
}

void SkinFolds::yield(double track_s, double share, std::span<Vec3> x) const {
  std::vector<Vec3> moved(vertices_.size());
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    Vec3 normal = Vec3::Zero();  // weighted by angles, as a surface's
    for (const Index t : around_[k]) {
      const Triangle& c = triangles_[at(t)];
      const std::size_t j = c[0] == vertices_[k] ? 0 : (c[1] == vertices_[k] ? 1 : 2);
      normal += corner_normal(x[at(c[(j + 1) % 3])] - x[at(c[j])], x[at(c[(j + 2) % 3])] - x[at(c[j])]);
    }
    const double length = std::sqrt(normal.squaredNorm());
    moved[k] = x[at(vertices_[k])];
    if (length > 0) moved[k] -= share * depth(k, track_s) / length * normal;
  }
  for (std::size_t k = 0; k < vertices_.size(); ++k) x[at(vertices_[k])] = moved[k];
}

}  // namespace toile::internal
