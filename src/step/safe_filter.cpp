#include "step/safe_filter.hpp"

#include <algorithm>
#include <numeric>

namespace toile::internal {
namespace {

constexpr int most_rounds = 4, sweeps = 3;
constexpr double target_share = 0.25;  // of r
constexpr double regain_share = 0.02;  // of r: the least gap that a pair is restored to
constexpr double largest_lever = 4;    // of the correction of a pair: no particle moves farther
constexpr double cut_share = 0.9;      // of the earliest impact
constexpr int shrinking_growths = 3;   // after these a zone's relative motion is stopped
constexpr int most_growths = 50;

// Inverse masses of the impact's particles, 1/kg: 0 for the body's and, unless `pinched` is empty, for all but those pinched with room.
std::array<double, 4> inverse_masses(const Impact& impact, std::span<const double> inverse_mass,
                                     std::span<const Pinched> pinched) {
  std::array<double, 4> inverse{};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t p = at(impact.particle[k]);
    if (p < inverse_mass.size() && (pinched.empty() || pinched[p] == Pinched::with_room)) inverse[k] = inverse_mass[p];
  }
  return inverse;
}

double mobility_of(const Impact& impact, const std::array<double, 4>& inverse_mass) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += impact.weight[k] * impact.weight[k] * inverse_mass[k];
  return sum;
}

}  // namespace

Vec3 velocity_of_motion(const Vec3& moved_m, const Vec3& y_m, double h_s) {
  const double y2 = y_m.squaredNorm();
  const double altered = y2 > 0 ? std::clamp(moved_m.dot(y_m) / y2, 0.0, 1.0) : 0;
  return (moved_m - altered * y_m) / h_s;
}

double counted_share(const Vec3& correction_m, const Vec3& v_m_per_s, double h_s, double base_h_s) {
  const double length = correction_m.norm();
  if (h_s >= base_h_s || !(length > 0)) return 1;
  const double against = std::max(-v_m_per_s.dot(correction_m) / length, 0.0);
  return std::min(1.0, h_s * (against / length + 1 / base_h_s));
}

FilterReport SafeFilter::operator()(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                                    std::span<const double> inverse_mass, std::span<const double> contact_m,
                                    bool truncate, std::span<Vec3> end, const BodyGuard* guard,
                                    std::span<const double> before_body, std::span<const Pinched> pinched,
                                    const FeaturePairs* near) {
  FilterReport report;
  moved_.assign(start.size(), 0);
  impacts_.clear();
  body_impacts_.clear();
  const auto look = [&] {
    if (!contact_m.empty())
      report.hopeless |= !find_impacts(cloth, tree, start, end, contact_m, workspace_, impacts_, pinched, near);
    if (guard && !report.hopeless)
      report.hopeless |= !find_body_impacts(cloth, tree, start, end, *guard, body_workspace_, body_impacts_);
  };
  look();
  report.impacts = static_cast<int>(impacts_.size() + body_impacts_.size());
  while (!(impacts_.empty() && body_impacts_.empty()) && report.rounds < most_rounds && !report.hopeless) {
    ++report.rounds;
    push_apart(inverse_mass, before_body, pinched, guard, end);
    look();
  }
  report.left = static_cast<int>(impacts_.size());
  report.body_left = static_cast<int>(body_impacts_.size());
  if (!impacts_.empty() && truncate && !report.hopeless) {
    cut_short(cloth, tree, start, inverse_mass, contact_m, pinched, near, end, report);
    if (guard) report.hopeless |= !find_body_impacts(cloth, tree, start, end, *guard, body_workspace_, body_impacts_);
    report.body_left = static_cast<int>(body_impacts_.size());
  }
  report.corrected = static_cast<int>(std::count(moved_.begin(), moved_.end(), 1));
  return report;
}

void SafeFilter::push_apart(std::span<const double> inverse_mass, std::span<const double> before_body,
                            std::span<const Pinched> pinched, const BodyGuard* guard, std::span<Vec3> end) {
  const std::size_t of_cloth = impacts_.size();
  const auto impact_at = [&](std::size_t i) -> const Impact& {
    return i < of_cloth ? impacts_[i] : body_impacts_[i - of_cloth];
  };
  order_.resize(of_cloth + body_impacts_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const double first = impact_at(a).time, second = impact_at(b).time;
    return first != second ? first < second : a < b;
  });
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const std::size_t i : order_) {
      const Impact& impact = impact_at(i);
      // More than xi in any case.
      const double target =
          std::min(target_share * impact.contact_m, std::max(regain_share * impact.contact_m, impact.start_gap_m));
      double gap = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t p = at(impact.particle[k]);
        const bool of_body = p >= end.size();
        gap += impact.weight[k] * impact.normal.dot(of_body ? guard->body->next_positions()[p - end.size()] : end[p]);
      }
      if (gap >= target) continue;
      std::array<double, 4> inverse = inverse_masses(impact, i < of_cloth ? inverse_mass : before_body, {});
      double mobility = mobility_of(impact, inverse);
      if (mobility <= 0 && i < of_cloth && !pinched.empty() && !before_body.empty()) {
        inverse = inverse_masses(impact, before_body, pinched);
        mobility = mobility_of(impact, inverse);
      }
      if (mobility <= 0) continue;
      std::array<double, 4> share{};
      double lever = largest_lever;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t p = at(impact.particle[k]);
        if (p < end.size()) share[k] = impact.weight[k] * inverse[k] / mobility;
        lever = std::max(lever, std::abs(share[k]));
      }
      const double apart = (target - gap) * (largest_lever / lever);
      for (std::size_t k = 0; k < 4; ++k) {
        if (share[k] == 0) continue;
        const std::size_t p = at(impact.particle[k]);
        end[p] += (apart * share[k]) * impact.normal;
        moved_[p] = 1;
      }
    }
  }
}

void SafeFilter::cut_short(const ClothTopology& cloth, TriangleTree& tree, std::span<const Vec3> start,
                           std::span<const double> inverse_mass, std::span<const double> contact_m,
                           std::span<const Pinched> pinched, const FeaturePairs* near, std::span<Vec3> end,
                           FilterReport& report) {
  const std::size_t n = start.size();
  whole_.assign(end.begin(), end.end());
  zones_.reset(n);
  std::vector<double> share(n, 1), mass(n, 0);
  std::vector<char> inside(n, 0), held(n, 0);
  Vec3s mean(n, Vec3::Zero());
  std::vector<Impact> seen;
  for (int growth = 0; !impacts_.empty() && growth < most_growths; ++growth) {
    for (const Impact& impact : impacts_) {
      for (std::size_t k = 0; k < 4; ++k) {
        inside[at(impact.particle[k])] = 1;
        zones_.join(impact.particle[0], impact.particle[k]);
      }
    }
    // Times refer to the whole motion, which is the one that is clipped, whatever the zones were when the impact was found.
    seen.insert(seen.end(), impacts_.begin(), impacts_.end());
    std::fill(share.begin(), share.end(), growth < shrinking_growths ? 1 : 0);
    if (growth < shrinking_growths) {
      for (const Impact& impact : seen) {
        double& s = share[at(zones_.find(impact.particle[0]))];
        s = std::min(s, cut_share * std::min(1.0, impact_time(impact, start, whole_)));
      }
    }
    // A zone moves by its mean; with constrained particles, by theirs.
    std::fill(mass.begin(), mass.end(), 0);
    std::fill(held.begin(), held.end(), 0);
    std::fill(mean.begin(), mean.end(), Vec3::Zero());
    for (std::size_t i = 0; i < n; ++i)
      if (inside[i] && inverse_mass[i] == 0) held[at(zones_.find(static_cast<Index>(i)))] = 1;
    for (std::size_t i = 0; i < n; ++i) {
      if (!inside[i]) continue;
      const std::size_t z = at(zones_.find(static_cast<Index>(i)));
      if (held[z] && inverse_mass[i] > 0) continue;
      const double m = inverse_mass[i] > 0 ? 1 / inverse_mass[i] : 1;
      mass[z] += m;
      mean[z] += m * (whole_[i] - start[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!inside[i]) continue;
      const std::size_t z = at(zones_.find(static_cast<Index>(i)));
      const Vec3 m = mean[z] / mass[z];
      end[i] = start[i] + m + share[z] * (whole_[i] - start[i] - m);
      moved_[i] = 1;
    }
    if (!find_impacts(cloth, tree, start, end, contact_m, workspace_, impacts_, pinched, near)) growth = most_growths;
  }
  report.truncated = static_cast<int>(std::count(inside.begin(), inside.end(), 1));
  report.left = static_cast<int>(impacts_.size());
  if (impacts_.empty()) return;
  // Nothing moves: free by the state's own freedom.
  std::copy(start.begin(), start.end(), end.begin());
  std::fill(moved_.begin(), moved_.end(), static_cast<char>(1));
  report.truncated = static_cast<int>(n);
  report.left = 0;
}

}  // namespace toile::internal
