// body/body_samples.cpp: checks samples as they are read, and interpolates between them.
#include "body/body_samples.hpp"

#include "body/lead_in.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::internal {

namespace {

constexpr std::size_t coordinate_limit = std::size_t{1} << 30;
constexpr double same_pose_m = 1e-5;
constexpr double height_ratio = 4.0;  // first sample to body

std::size_t z(Index i) { return static_cast<std::size_t>(i); }

void check_range(std::string_view file, std::string_view place, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw InputError(file, place, fmt::sprintf("%g", low) + " to " + fmt::sprintf("%g", high), fmt::sprintf("%g", value));
}

}  // namespace

BodySamples::BodySamples(std::string_view file, const CollisionBody& body, const SampleOptions& options)
    : drape_(body.positions),
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
  const double unit = metres_in(options_.unit), farthest = options_.fastest_m_s / options_.rate_hz;
  for (std::size_t i = 0; i < drape_.size(); ++i) {
    const std::size_t from = whole ? z(source_vertex_[i]) : i;
    const Vec3 p = unit * positions[from];
    const auto place = [&] { return frame + ", vertex " + std::to_string(from); };
    if (!p.allFinite()) throw InputError(file, place(), "finite coordinates", "infinity or not a number");
    if (p.cwiseAbs().maxCoeff() > 1e6)
      throw InputError(file, place(), "coordinates within 1000 km", fmt::sprintf("%g m", p.cwiseAbs().maxCoeff()));
    if (frames_ > 0) {
      const double moved = (p - sample(frames_ - 1, i)).norm();
      if (moved > farthest)
        throw InputError(file, place(),
                         "at most " + fmt::sprintf("%.3g m", farthest) + " from the frame before (" +
                             fmt::sprintf("%g m/s", options_.fastest_m_s) + ")",
                         fmt::sprintf("%.3g m", moved));
    }
    samples_.push_back(p.cast<float>());
  }
  ++frames_;
  if (frames_ == 1) check_height(file);
}

void BodySamples::check_height(std::string_view file) const {
  const auto height = [&](const auto& at) {
    double low = at(0), high = at(0);
    for (std::size_t i = 1; i < drape_.size(); ++i) {
      low = std::min(low, at(i));
      high = std::max(high, at(i));
    }
    return high - low;
  };
  const double body = height([&](std::size_t i) { return drape_[i].y(); });
  const double first = height([&](std::size_t i) { return sample(0, i).y(); });
  if (first <= height_ratio * body && body <= height_ratio * first) return;
  throw InputError(
      file, "frame 0",
      "a height near the body's " + fmt::sprintf("%.3g m", body) + " (is the unit of the samples another one?)",
      fmt::sprintf("%.3g m", first));
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
