// body/body_samples.cpp: checks samples as they are read, and interpolates between them.
#include "body/body_samples.hpp"

#include "body/lead_in.hpp"
#include "body/step_speed.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::internal {

namespace {

constexpr std::size_t coordinate_limit = std::size_t{1} << 30;
constexpr double height_ratio = 4.0;  // first sample to body
// No skin is stretched so in a pose that a body may stand in, but most edges are if vertices come in another order.
constexpr double longer_ratio = 3.0, longer_share = 0.05;  // an edge to the body's, and beyond it of the height
constexpr double fits_better = 0.5;                        // distance from the body's pose with other axes

void check_range(std::string_view file, std::string_view place, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw InputError(file, place, fmt::sprintf("%g", low) + " to " + fmt::sprintf("%g", high), fmt::sprintf("%g", value));
}

}  // namespace

BodySamples::BodySamples(std::string_view file, const CollisionBody& body, const SampleOptions& options)
    : drape_(body.positions),
      triangles_(body.triangles),
      rotation_(body.rotation),
      source_vertex_(body.source_vertex),
      source_count_(body.source_vertex_count),
      options_(options) {
  check_range(file, "samples per second", options.rate_hz, 1, 1000);
  check_range(file, "lead-in, s", options.lead_in_s, 0, 10);
  check_range(file, "fastest vertex, m/s", options.fastest_m_s, 0.1, 1e6);
  if (source_vertex_.empty()) {  // made in memory: all vertices are the body's
    for (std::size_t i = 0; i < drape_.size(); ++i) source_vertex_.push_back(static_cast<Index>(i));
    source_count_ = drape_.size();
  }
}

void BodySamples::append(std::string_view file, std::span<const Vec3> positions) {
  const std::string frame = "frame " + std::to_string(frames_);
  const bool whole = positions.size() == source_count_;
  if (!whole && positions.size() != drape_.size()) {
    std::string expected = std::to_string(source_count_) + " vertices";
    if (source_count_ != drape_.size())
      expected += " as in the body's file, or " + std::to_string(drape_.size()) + " of the body alone";
    throw InputError(file, frame, expected, std::to_string(positions.size()));
  }
  if (3 * (samples_.size() + drape_.size()) > coordinate_limit)
    throw InputError(file, frame, "at most 2^30 coordinates in all frames", "more");
  const double unit = metres_in(options_.unit);
  Vec3s x;
  x.reserve(drape_.size());
  for (std::size_t i = 0; i < drape_.size(); ++i) {
    const std::size_t from = whole ? at(source_vertex_[i]) : i;
    const Vec3 p = unit * positions[from];
    const auto place = [&] { return frame + ", vertex " + std::to_string(from); };
    if (!p.allFinite()) throw InputError(file, place(), "finite coordinates", "infinity or not a number");
    if (p.cwiseAbs().maxCoeff() > 1e6)
      throw InputError(file, place(), "coordinates within 1000 km", fmt::sprintf("%g m", p.cwiseAbs().maxCoeff()));
    x.push_back(p);
  }
  if (frames_ == 0) turn_to_fit(file, x);
  if (!rotation_.isIdentity(0))
    for (Vec3& p : x) p = rotation_ * p;
  if (frames_ == 0) {
    check_height(file, x);
    check_edges(file, x);
  } else {
    check_speed(file, x);
  }
  for (const Vec3& p : x) samples_.push_back(p.cast<float>());
  ++frames_;
}

// Of the body's axes, Toile's and those with z up, the ones in which the frame is nearest to the body as it stands.
void BodySamples::turn_to_fit(std::string_view file, Vec3s& frame) {
  const auto middle = [](const Vec3s& x) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : x) sum += p;
    return Vec3(sum / static_cast<double>(x.size()));
  };
  const Vec3 there = middle(drape_), here = middle(frame);
  const auto distance = [&](const Mat3& rotation) {
    double sum = 0;
    for (std::size_t i = 0; i < frame.size(); ++i)
      sum += (rotation * (frame[i] - here) - (drape_[i] - there)).squaredNorm();
    return std::sqrt(sum);
  };
  const Mat3 as_in_file = rotation_;
  double least = fits_better * distance(as_in_file);
  for (const Mat3& other : {Mat3(Mat3::Identity()), z_up_to_y_up()}) {
    const double d = distance(other);
    if (!(d < least)) continue;
    least = d;
    rotation_ = other;
  }
  if (rotation_ == as_in_file) return;
  notes_.push_back(std::string(file) + (rotation_.isIdentity(0)
                                            ? ": is upright as it is, unlike the body's file: not turned as that"
                                            : ": z is up in it, unlike the body's file: turned to (x, z, -y)"));
}

void BodySamples::check_height(std::string_view file, const Vec3s& frame) const {
  const auto height = [](const Vec3s& x) {
    double low = x[0].y(), high = x[0].y();
    for (const Vec3& p : x) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    return high - low;
  };
  const double body = height(drape_), first = height(frame);
  if (first <= height_ratio * body && body <= height_ratio * first) return;
  throw InputError(
      file, "frame 0",
      "a height near the body's " + fmt::sprintf("%.3g m", body) + " (is the unit of the samples another one?)",
      fmt::sprintf("%.3g m", first));
}

void BodySamples::check_edges(std::string_view file, const Vec3s& frame) const {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : drape_) box.extend(p);
  const double beyond = longer_share * box.sizes().maxCoeff();
  for (const Triangle& t : triangles_)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = at(t[k]), b = at(t[(k + 1) % 3]);
      const double body = (drape_[a] - drape_[b]).norm(), first = (frame[a] - frame[b]).norm();
      if (first <= longer_ratio * body + beyond) continue;
      throw InputError(file,
                       "frame 0, edge " + std::to_string(source_vertex_[a]) + "-" + std::to_string(source_vertex_[b]),
                       fmt::sprintf("a length near the body's %.3g m (are these samples of another body, or its "
                                    "vertices in another order?)",
                                    body),
                       fmt::sprintf("%.3g m", first));
    }
}

void BodySamples::check_speed(std::string_view file, const Vec3s& frame) const {
  Vec3s before(frame.size());
  for (std::size_t i = 0; i < before.size(); ++i) before[i] = sample(frames_ - 1, i);
  check_step_speed(file, "frame " + std::to_string(frames_), before, frame, {options_.rate_hz, options_.fastest_m_s},
                   [&](std::size_t i) { return source_count_ == drape_.size() ? i : at(source_vertex_[i]); });
}

void BodySamples::finish(std::string_view file) {
  if (frames_ == 0) throw InputError(file, "samples", "at least one frame", "none");
  double apart = 0;
  for (std::size_t i = 0; i < drape_.size(); ++i) apart = std::max(apart, (sample(0, i) - drape_[i]).norm());
  lead_in_s_ = apart > same_pose_m ? options_.lead_in_s : 0;
  samples_.shrink_to_fit();
}

double BodySamples::duration_s() const { return lead_in_s_ + static_cast<double>(frames_ - 1) / options_.rate_hz; }

void BodySamples::positions(double t_s, std::span<Vec3> x) const {
  const double t = std::max(t_s, 0.0);
  const LeadIn lead_in{lead_in_s_};
  const double tau = lead_in.clock(t), share = lead_in.share(t);
  const double last = static_cast<double>(frames_ - 1), at = std::min(tau * options_.rate_hz, last);
  const auto i = static_cast<std::size_t>(std::min(std::floor(at), std::max(last - 1.0, 0.0)));
  const double u = at - static_cast<double>(i), r = 1.0 - u;
  const double h00 = (1 + 2 * u) * r * r, h10 = u * r * r, h01 = u * u * (3 - 2 * u), h11 = -u * u * r;
  const std::size_t next = std::min(i + 1, frames_ - 1), before = i > 0 ? i - 1 : i;
  const std::size_t after = std::min(i + 2, frames_ - 1);
  const double m0 = i > 0 ? 0.5 : 1.0, m1 = i + 2 < frames_ ? 0.5 : 1.0;  // one-sided at the ends
  parallel_for(x.size(), 1024, [&](std::size_t v) {
    const Vec3 p0 = sample(i, v), p1 = sample(next, v);
    Vec3 p = h00 * p0 + h01 * p1 + h10 * m0 * (p1 - sample(before, v)) + h11 * m1 * (sample(after, v) - p0);
    if (share < 1) p = drape_[v] + share * (p - drape_[v]);
    x[v] = p;
  });
}

void BodySamples::add_to(Hash& hash) const {
  hash.add_counted(std::span<const Vec3>(drape_));
  hash.add_counted(std::span<const Vec3f>(samples_));
  const double numbers[] = {options_.rate_hz, lead_in_s_};
  hash.add(std::span<const double>(numbers));
}

}  // namespace toile::internal
