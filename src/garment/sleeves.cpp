#include "garment/sleeves.hpp"

#include "core/elementary.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace toile::internal {
namespace {

constexpr double shoulder_from = 0.6, shoulder_to = 1;  // of the way from the body's middle to an arm's root

Vec2 frontal(const Vec3& p) { return {p.x(), p.y()}; }

// [panel] middle of its particles.
std::vector<Vec3> panel_middles(const GarmentMesh& garment, std::span<const Index> panel_of) {
  std::vector<Vec3> sum(garment.mesh.panel_names.size(), Vec3::Zero());
  std::vector<double> count(sum.size(), 0);
  for (std::size_t i = 0; i < garment.x.size(); ++i) {
    if (panel_of[i] < 0) continue;
    sum[at(panel_of[i])] += garment.x[i];
    count[at(panel_of[i])] += 1;
  }
  for (std::size_t p = 0; p < sum.size(); ++p)
    if (count[p] > 0) sum[p] /= count[p];
  return sum;
}

}  // namespace

void hang_sleeves(GarmentMesh& garment, const std::array<ArmLine, 2>& arms, double body_height_m) {
  const std::vector<Index> panel_of = garment.panel_of_particle();
  const std::vector<Vec3> middle = panel_middles(garment, panel_of);
  const bool labelled = std::any_of(garment.panel_labels.begin(), garment.panel_labels.end(),
                                    [](const std::string& label) { return !label.empty(); });
  const double between_m = 0.5 * (arms[0].root.x() + arms[1].root.x());
  std::vector<char> sewn(garment.x.size(), 0);
  for (const SeamPair& pair : garment.pairs) sewn[at(pair.a)] = sewn[at(pair.b)] = 1;
  std::vector<int> side(middle.size(), -1);  // 0: left sleeve
  for (std::size_t p = 0; p < middle.size(); ++p) {
    const int s = middle[p].x() > between_m ? 0 : 1;
    const ArmLine& arm = arms[static_cast<std::size_t>(s)];
    const bool beyond = std::abs(middle[p].x() - between_m) > std::abs(arm.root.x() - between_m) &&
                        std::abs(middle[p].y() - arm.root.y()) < near_an_arm * body_height_m;
    if (labelled ? garment.panel_labels[p] == "arm" : beyond) side[p] = s;
  }
  for (int s = 0; s < 2; ++s) {
    const ArmLine& arm = arms[static_cast<std::size_t>(s)];
    const auto in_sleeve = [&](Index i) { return panel_of[at(i)] >= 0 && side[at(panel_of[at(i)])] == s; };
    Vec2 armhole = Vec2::Zero(), hem = Vec2::Zero();
    double armhole_share = 0, count = 0;
    for (const SeamPair& pair : garment.pairs) {
      if (in_sleeve(pair.a) == in_sleeve(pair.b)) continue;
      armhole += pair.share_m * frontal(garment.x[at(in_sleeve(pair.a) ? pair.a : pair.b)]);
      armhole_share += pair.share_m;
    }
    for (std::size_t i = 0; i < garment.x.size(); ++i) {
      if (!in_sleeve(static_cast<Index>(i)) || !garment.on_panel_edge[i] || sewn[i] != 0) continue;
      hem += frontal(garment.x[i]);
      count += 1;
    }
    if (armhole_share == 0 || count == 0) continue;
    armhole /= armhole_share;
    hem /= count;
    const Vec2 along = hem - armhole, arm_along = frontal(arm.direction);
    if (along.norm() == 0 || arm_along.norm() == 0) continue;
    const double turn = ieee_atan2(along.x() * arm_along.y() - along.y() * arm_along.x(), along.dot(arm_along));
    const Vec2 d = arm_along.normalized(), off = frontal(arm.root) - armhole, across = off - off.dot(d) * d;
    const double c = ieee_cos(turn), sine = ieee_sin(turn);
    for (std::size_t i = 0; i < garment.x.size(); ++i) {
      if (!in_sleeve(static_cast<Index>(i))) continue;
      const Vec2 r = frontal(garment.x[i]) - armhole;
      const Vec2 p = armhole + Vec2(c * r.x() - sine * r.y(), sine * r.x() + c * r.y()) + across;
      garment.x[i].x() = p.x();
      garment.x[i].y() = p.y();
    }
  }
}

std::array<bool, 2> covers_shoulders(const GarmentMesh& garment, const std::array<ArmLine, 2>& arms) {
  const double between_m = 0.5 * (arms[0].root.x() + arms[1].root.x());
  std::array<bool, 2> covers{false, false};
  for (const Vec3& p : garment.x)
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3& root = arms[k].root;
      const double out = (p.x() - between_m) / (root.x() - between_m);
      if (out > shoulder_from && out < shoulder_to && p.y() > root.y()) covers[k] = true;
    }
  return covers;
}

}  // namespace toile::internal
