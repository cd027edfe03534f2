#include "body/arms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace toile::internal {
namespace {

// Shares of the height, by human proportions: a hand is 0.11 long, an arm with it 0.44.
constexpr double ring_step = 0.01, first_ring = 0.06;
constexpr double wrist_share = 0.12, elbow_share = 0.28;  // rings between them give the girth of the arm
constexpr double longest_arm = 0.6;                       // a ring that has not run out by then is not an arm's
constexpr double least_reach = 0.08;                      // of a hand, sideways from the feet's middle
constexpr double thickest = 0.3;     // an arm has a girth of 0.16; anything thicker than this is not an arm
constexpr double runs_out = 1.6;     // of the arm's own girth; rings beyond a shoulder have twice that
constexpr double least_whole = 0.5;  // share of the vertices in the person's component

constexpr double infinite = std::numeric_limits<double>::infinity();

class Surface {
 public:
  Surface(std::span<const Vec3> x, std::span<const Triangle> triangles)
      : x_(x), triangles_(triangles), neighbours_(x.size()) {
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        neighbours_[at(t[k])].push_back(t[(k + 1) % 3]);
        neighbours_[at(t[(k + 1) % 3])].push_back(t[k]);
      }
  }

  // Along the edges.
  std::vector<double> distances(Index from) const {
    std::vector<double> distance(x_.size(), infinite);
    using Reached = std::pair<double, Index>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    distance[at(from)] = 0;
    front.emplace(0, from);
    while (!front.empty()) {
      const auto [d, i] = front.top();
      front.pop();
      if (d > distance[at(i)]) continue;
      for (const Index j : neighbours_[at(i)]) {
        const double through = d + (x_[at(j)] - x_[at(i)]).norm();
        if (through >= distance[at(j)]) continue;
        distance[at(j)] = through;
        front.emplace(through, j);
      }
    }
    return distance;
  }

  struct Ring {
    double girth_m = 0;
    Vec3 middle{0, 0, 0};
  };
  // The level curve of `distance` at this value.
  Ring ring(std::span<const double> distance, double value) const {
    Ring ring;
    for (const Triangle& t : triangles_) {
      std::array<Vec3, 2> ends;
      std::size_t count = 0;
      for (std::size_t k = 0; k < 3 && count < 2; ++k) {
        const double a = distance[at(t[k])] - value, b = distance[at(t[(k + 1) % 3])] - value;
        if ((a >= 0) == (b >= 0) || !std::isfinite(a) || !std::isfinite(b)) continue;
        const double s = a / (a - b);
        ends[count++] = (1 - s) * x_[at(t[k])] + s * x_[at(t[(k + 1) % 3])];
      }
      if (count < 2) continue;
      const double length = (ends[1] - ends[0]).norm();
      ring.girth_m += length;
      ring.middle += 0.5 * length * (ends[0] + ends[1]);
    }
    if (ring.girth_m > 0) ring.middle /= ring.girth_m;
    return ring;
  }

 private:
  std::span<const Vec3> x_;
  std::span<const Triangle> triangles_;
  std::vector<std::vector<Index>> neighbours_;
};

Index farthest(std::span<const double> distance) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < distance.size(); ++i)
    if (std::isfinite(distance[i]) && distance[i] > most) {
      most = distance[i];
      best = i;
    }
  return static_cast<Index>(best);
}

std::optional<Arm> arm_from(const Surface& surface, Index tip, double height_m) {
  Arm arm;
  arm.past = surface.distances(tip);
  std::vector<Surface::Ring> rings;
  std::vector<double> girths;
  for (int k = 0; first_ring + k * ring_step <= longest_arm; ++k) {
    const double share = first_ring + k * ring_step;
    rings.push_back(surface.ring(arm.past, share * height_m));
    if (share >= wrist_share && share <= elbow_share) girths.push_back(rings.back().girth_m);
  }
  std::nth_element(girths.begin(), girths.begin() + static_cast<std::ptrdiff_t>(girths.size() / 2), girths.end());
  const double usual_m = girths[girths.size() / 2];
  if (usual_m == 0 || usual_m > thickest * height_m) return std::nullopt;
  const auto ring_at = [](double share) {
    return static_cast<std::size_t>(std::lround((share - first_ring) / ring_step));
  };
  std::size_t root = ring_at(elbow_share);
  while (root < rings.size() && rings[root].girth_m > 0 && rings[root].girth_m <= runs_out * usual_m) ++root;
  if (root >= rings.size() || rings[root].girth_m == 0 || root <= ring_at(elbow_share)) return std::nullopt;
  --root;
  arm.root = rings[root].middle;
  arm.direction = (rings[ring_at(wrist_share)].middle - arm.root).normalized();
  arm.length_m = (first_ring + static_cast<double>(root) * ring_step) * height_m;
  for (double& d : arm.past) d = std::isfinite(d) ? arm.length_m - d : -infinite;
  return arm;
}

}  // namespace

Arms find_arms(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  if (x.empty() || triangles.empty()) return std::nullopt;
  Vec3 middle = Vec3::Zero(), low = x.front(), high = x.front();
  for (const Vec3& p : x) {
    middle += p / static_cast<double>(x.size());
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double height_m = high.y() - low.y();
  const Surface surface(x, triangles);
  std::size_t seed = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i] - middle).squaredNorm() < (x[seed] - middle).squaredNorm()) seed = i;
  std::vector<double> distance = surface.distances(static_cast<Index>(seed));
  const auto reached = std::count_if(distance.begin(), distance.end(), [](double d) { return std::isfinite(d); });
  if (static_cast<double>(reached) < least_whole * static_cast<double>(x.size())) return std::nullopt;

  std::vector<Index> tips{farthest(distance)};
  distance = surface.distances(tips.front());
  while (tips.size() < 5) {
    tips.push_back(farthest(distance));
    const std::vector<double> from_tip = surface.distances(tips.back());
    for (std::size_t i = 0; i < distance.size(); ++i) distance[i] = std::min(distance[i], from_tip[i]);
  }
  std::sort(tips.begin(), tips.end(), [&](Index a, Index b) { return x[at(a)].y() < x[at(b)].y(); });
  const double between_feet = 0.5 * (x[at(tips[0])].x() + x[at(tips[1])].x());
  std::sort(tips.begin() + 2, tips.end(), [&](Index a, Index b) { return x[at(a)].x() > x[at(b)].x(); });
  const Index left_tip = tips[2], right_tip = tips[4];
  if (x[at(left_tip)].x() - between_feet < least_reach * height_m ||
      between_feet - x[at(right_tip)].x() < least_reach * height_m)
    return std::nullopt;
  std::optional<Arm> left = arm_from(surface, left_tip, height_m), right = arm_from(surface, right_tip, height_m);
  if (!left || !right) return std::nullopt;
  return std::array<Arm, 2>{std::move(*left), std::move(*right)};
}

}  // namespace toile::internal
