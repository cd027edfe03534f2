#include "contact/particle_boxes.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>

namespace toile::internal {
namespace {

constexpr std::size_t box_grain = 1024;

// The mean of finite positions; else the origin: any point will do, as long as it is the same for all.
Vec3 mean(std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : x) sum += p;
  sum /= static_cast<double>(std::max<std::size_t>(x.size(), 1));
  return sum.allFinite() ? sum : Vec3::Zero();
}

OuterBox motion_box(const Vec3& start, const Vec3& end, double margin_m) {
  OuterBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = start[static_cast<Eigen::Index>(k)], b = end[static_cast<Eigen::Index>(k)];
    box.low[k] = OuterBox::below(std::min(a, b) - margin_m);
    box.high[k] = OuterBox::above(std::max(a, b) + margin_m);
  }
  return box;
}

}  // namespace

void ParticleBoxes::set(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m) {
  set(start, Vec3::Zero(), end, Vec3::Zero(), margin_m);
}

void ParticleBoxes::set(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m,
                        std::span<const std::uint8_t> moved) {
  TOILE_ASSERT(start.size() == size() && end.size() == size() && moved.size() == size());
  parallel_for(size(), box_grain, [&](std::size_t i) {
    if (moved[i] != 0) boxes_[i] = motion_box(start[i], end[i], margin_m);
  });
}

void ParticleBoxes::set_seen_from_mean(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m) {
  const Vec3 from = mean(start), to = start.data() == end.data() ? from : mean(end);
  set(start, from, end, to, margin_m);
}

void ParticleBoxes::set(std::span<const Vec3> start, const Vec3& from, std::span<const Vec3> end, const Vec3& to,
                        double margin_m) {
  TOILE_ASSERT(start.size() == end.size());
  boxes_.resize(start.size());
  parallel_for(start.size(), box_grain,
               [&](std::size_t i) { boxes_[i] = motion_box(start[i] - from, end[i] - to, margin_m); });
}

bool ParticleBoxes::within(const ParticleBoxes& other) const {
  if (size() != other.size()) return false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!boxes_[i].within(other.boxes_[i])) return false;
  }
  return true;
}

}  // namespace toile::internal
