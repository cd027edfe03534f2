#include "contact/particle_boxes.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>

namespace toile {
namespace {

constexpr std::size_t box_grain = 4096;

// Of finite positions; else the origin, which is as good: any point will do, as long as it is the same for all.
Vec3 mean(std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : x) sum += p;
  sum /= static_cast<double>(std::max<std::size_t>(x.size(), 1));
  return sum.allFinite() ? sum : Vec3::Zero();
}

}  // namespace

void ParticleBoxes::set(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m) {
  set(start, Vec3::Zero(), end, Vec3::Zero(), margin_m);
}

void ParticleBoxes::set_seen_from_mean(std::span<const Vec3> start, std::span<const Vec3> end, double margin_m) {
  const Vec3 from = mean(start), to = start.data() == end.data() ? from : mean(end);
  set(start, from, end, to, margin_m);
}

void ParticleBoxes::set(std::span<const Vec3> start, const Vec3& from, std::span<const Vec3> end, const Vec3& to,
                        double margin_m) {
  TOILE_ASSERT(start.size() == end.size());
  boxes_.resize(start.size());
  parallel_for(start.size(), box_grain, [&](std::size_t i) {
    OuterBox& box = boxes_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<Eigen::Index>(k);
      const double a = start[i][c] - from[c], b = end[i][c] - to[c];
      box.low[k] = OuterBox::below(std::min(a, b) - margin_m);
      box.high[k] = OuterBox::above(std::max(a, b) + margin_m);
    }
  });
}

bool ParticleBoxes::within(const ParticleBoxes& other) const {
  if (size() != other.size()) return false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!boxes_[i].within(other.boxes_[i])) return false;
  }
  return true;
}

}  // namespace toile
