#include "garment/placement.hpp"

#include "core/parallel.hpp"
#include "garment/flares.hpp"
#include "garment/pattern_figures.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

constexpr double lowest_m = -0.12, highest_m = 0.16, step_m = 0.01;  // vertical shifts
constexpr double depth_m = 0.04, depth_step_m = 0.02;                // forwards and backwards
constexpr double drawn_within_m =
    0.02;  // of the waist: on the way over which labelled edges are held up (dress/label_springs.cpp)
constexpr double farthest_out_m = 0.1;  // of a panel on its own

bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a), d = q - p;
  const double from = n.dot(p - a), to = n.dot(q - a);
  if ((from > 0) == (to > 0)) return false;
  const double u = d.dot((a - p).cross(b - p)), v = d.dot((b - p).cross(c - p)), w = d.dot((c - p).cross(a - p));
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

class BodyLines {
 public:
  explicit BodyLines(const BodySurface& body) : body_(&body) {}
  bool blocked(const Vec3& p, const Vec3& q) const {
    std::vector<Index> triangles;
    body_->tree_now().overlapping({p.cwiseMin(q), p.cwiseMax(q)}, triangles);
    const auto x = body_->positions();
    return std::any_of(triangles.begin(), triangles.end(), [&](Index t) {
      const Triangle& corners = body_->triangle(t);
      return crosses(p, q, x[at(corners[0])], x[at(corners[1])], x[at(corners[2])]);
    });
  }

 private:
  const BodySurface* body_;
};

struct Blocked {
  int pairs = 0;
  int lost = 0;  // seams of which every pair is blocked
  double cost =
      0;  // sum over seams of blocked^2 / pairs: a seam's free part leads the rest round the body, a seam wholly behind it is lost
};

Blocked blocked_pairs(const GarmentMesh& garment, const BodyLines& body, const Vec3& shift) {
  std::vector<double> blocked(garment.seams.size(), 0), pairs(garment.seams.size(), 0);
  Blocked result;
  for (const SeamPair& pair : garment.pairs) {
    pairs[at(pair.seam)] += 1;
    if (!body.blocked(garment.x[at(pair.a)] + shift, garment.x[at(pair.b)] + shift)) continue;
    blocked[at(pair.seam)] += 1;
    ++result.pairs;
  }
  for (std::size_t s = 0; s < blocked.size(); ++s) {
    if (blocked[s] == 0) continue;
    result.cost += blocked[s] * blocked[s] / pairs[s];
    result.lost += blocked[s] == pairs[s] ? 1 : 0;
  }
  return result;
}

int edges_in_body(const GarmentMesh& garment, std::span<const Triangle> triangles, const BodyLines& body,
                  const Vec3& shift) {
  int count = 0;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (body.blocked(garment.x[at(t[k])] + shift, garment.x[at(t[(k + 1) % 3])] + shift)) ++count;
    }
  }
  return count;
}

int edges_in_body(const GarmentMesh& garment, const BodyLines& body, const Vec3& shift) {
  return edges_in_body(garment, garment.mesh.triangles, body, shift);
}

// Panels that are in the body with this shift are each moved away from its middle until they are outside: x, or nothing if one would go too far.
std::optional<Vec3s> moved_out(const GarmentMesh& garment, const BodyLines& body, const Vec3& middle,
                               const Vec3& shift) {
  std::vector<std::vector<Triangle>> panels(garment.mesh.panel_names.size());
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t)
    panels[at(garment.mesh.panel[t])].push_back(garment.mesh.triangles[t]);
  const std::vector<Index> panel_of = garment.panel_of_particle();
  Vec3s x = garment.x;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    if (panels[p].empty() || edges_in_body(garment, panels[p], body, shift) == 0) continue;
    Vec3 out = Vec3::Zero();
    for (const Triangle& t : panels[p])
      out += (garment.x[at(t[1])] - garment.x[at(t[0])]).cross(garment.x[at(t[2])] - garment.x[at(t[0])]);
    out.normalize();
    if (out.dot(garment.x[at(panels[p].front()[0])] + shift - middle) < 0) out = -out;
    double out_m = step_m;
    while (out_m <= farthest_out_m + 1e-9 && edges_in_body(garment, panels[p], body, shift + out_m * out) > 0)
      out_m += step_m;
    if (out_m > farthest_out_m + 1e-9) return std::nullopt;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (panel_of[i] == static_cast<Index>(p)) x[i] += out_m * out;
  }
  return x;
}

Vec3 middle_of(std::span<const Vec3> x) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : x) box.extend(p);
  return box.center();
}

// By how much the edges labelled for the waist are to be raised, in the mean: in steps, as far as shifts go; 0 where they are drawn there.
double to_waist_m(const GarmentMesh& garment, double waist_m) {
  double sum_m = 0, count = 0;
  for (const LabelledEdge& edge : garment.labels) {
    if (edge.label != edge_label::waist) continue;
    for (const Index i : edge.particles) sum_m += waist_m - garment.x[at(i)].y();
    count += static_cast<double>(edge.particles.size());
  }
  if (count == 0 || std::abs(sum_m) <= count * drawn_within_m) return 0;
  return std::clamp(step_m * std::round(sum_m / (count * step_m)), lowest_m, highest_m);
}

}  // namespace

Placement place_garment(GarmentMesh& garment, const BodySurface& body, std::size_t person_vertices,
                        std::optional<double> waist_m) {
  Placement placement;
  if (garment.legacy_frame && person_vertices > 0) {
    double low = 1e300, high = -1e300;
    for (const Vec3& p : body.positions().first(person_vertices)) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    const Vec3 raise(0, low + legacy_origin * (high - low), 0);
    for (Vec3& p : garment.x) p += raise;
    placement.shift_m += raise;
    placement.raised_m = raise.y();
  }
  const Vec3 middle = middle_of(body.positions());
  hang_flares(garment, middle);
  const BodyLines lines(body);
  std::vector<Vec3> shifts;
  for (int y = 0; lowest_m + y * step_m <= highest_m + 1e-9; ++y) {
    for (int z = 0; - depth_m + z * depth_step_m <= depth_m + 1e-9; ++z)
      shifts.emplace_back(0, lowest_m + y * step_m, -depth_m + z * depth_step_m);
  }
  // The shift nearest to the wanted one wins among equals: sorted by distance, and the first of the fewest is taken.
  const Vec3 wanted(0, waist_m ? to_waist_m(garment, *waist_m) : 0, 0);
  std::stable_sort(shifts.begin(), shifts.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - wanted).squaredNorm() < (b - wanted).squaredNorm();
  });
  std::vector<Blocked> blocked(shifts.size());
  parallel_for(shifts.size(), 1, [&](std::size_t s) { blocked[s] = blocked_pairs(garment, lines, shifts[s]); });
  placement.blocked_before = blocked_pairs(garment, lines, Vec3::Zero()).pairs;
  std::vector<std::size_t> order(shifts.size());
  for (std::size_t s = 0; s < order.size(); ++s) order[s] = s;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return blocked[a].cost < blocked[b].cost; });
  std::size_t best = order.front();
  for (const std::size_t s : order) {
    if (edges_in_body(garment, lines, shifts[s]) == 0) {
      best = s;
      break;
    }
  }
  // A collar that is drawn through the nape must not keep the shoulders' seams under the shoulders.
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return blocked[a].lost < blocked[b].lost; });
  for (const std::size_t s : order) {
    if (blocked[s].lost >= blocked[best].lost) break;
    if (std::optional<Vec3s> x = moved_out(garment, lines, middle, shifts[s])) {
      garment.x = std::move(*x);
      best = s;
      break;
    }
  }
  for (Vec3& p : garment.x) p += shifts[best];
  placement.shift_m += shifts[best];
  find_blocked(garment, body, placement);
  return placement;
}

void find_blocked(const GarmentMesh& garment, const BodySurface& body, Placement& placement) {
  const BodyLines lines(body);
  placement.blocked_seams.clear();
  placement.blocked = 0;
  placement.panel_crossings = edges_in_body(garment, lines, Vec3::Zero());
  for (const SeamPair& pair : garment.pairs) {
    if (!lines.blocked(garment.x[at(pair.a)], garment.x[at(pair.b)])) continue;
    ++placement.blocked;
    placement.blocked_seams.push_back(pair.seam);
  }
  std::sort(placement.blocked_seams.begin(), placement.blocked_seams.end());
  placement.blocked_seams.erase(std::unique(placement.blocked_seams.begin(), placement.blocked_seams.end()),
                                placement.blocked_seams.end());
}

}  // namespace toile::internal
