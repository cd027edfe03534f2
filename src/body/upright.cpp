#include "body/upright.hpp"

#include "body/measure.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

constexpr double alike = 1.25;  // girths of two legs at one height
constexpr double toes_over_heel =
    1.8;  // reach of a foot to the front over that to the back; 3 of most feet, 1 of a stump

constexpr double under_a_head = 1.2, over_a_chest = 1.5;  // girths of a head and a chest over that of the neck between

Mat3 half_turn_about(const Vec3& axis) { return 2 * axis * axis.transpose() - Mat3::Identity(); }

struct Level {
  double low, height;
  Vec3 at(double share) const { return {0, low + share * height, 0}; }
};

std::vector<std::vector<Vec3>> curves_at(std::span<const Vec3> x, std::span<const Triangle> triangles,
                                         const Level& level, double share) {
  return section(x, triangles, level.at(share), Vec3::UnitY());
}

bool are_legs(const std::vector<std::vector<Vec3>>& curves) {
  if (curves.size() != 2) return false;
  const double one = girth_m(curves[0], Vec3::UnitY()), two = girth_m(curves[1], Vec3::UnitY());
  return std::max(one, two) <= alike * std::min(one, two);
}

bool is_upside_down(std::span<const Vec3> x, std::span<const Triangle> triangles, const Level& level) {
  return curves_at(x, triangles, level, 0.1).size() == 1 &&
         std::ranges::all_of(std::array{0.8, 0.85, 0.9},
                             [&](double share) { return are_legs(curves_at(x, triangles, level, share)); });
}

// Going from an end inwards, the girths rise, fall and rise again.
bool has_neck(std::span<const Vec3> x, std::span<const Triangle> triangles, const Level& level, bool at_the_top) {
  double head = 0, neck = 0;
  for (int percent = 3; percent <= 40; ++percent) {
    const auto curves = curves_at(x, triangles, level, at_the_top ? 1 - 0.01 * percent : 0.01 * percent);
    if (curves.size() != 1) return false;
    const double girth = girth_m(curves[0], Vec3::UnitY());
    if (neck > 0 && girth >= over_a_chest * neck) return true;
    if (head >= under_a_head * girth) neck = neck > 0 ? std::min(neck, girth) : girth;
    if (neck == 0) head = std::max(head, girth);
  }
  return false;
}

Vec3 mean(const std::vector<Vec3>& curve) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : curve) sum += p;
  return sum / static_cast<double>(curve.size());
}

// The axis to which both feet point; none if that is not clear.
std::optional<Vec3> facing(std::span<const Vec3> x, std::span<const Triangle> triangles, const Level& level) {
  const auto soles = curves_at(x, triangles, level, 0.02), ankles = curves_at(x, triangles, level, 0.07);
  if (soles.size() != 2 || ankles.size() != 2) return std::nullopt;
  std::array<Vec3, 2> ankle = {mean(ankles[0]), mean(ankles[1])};
  if ((ankle[0] - mean(soles[0])).norm() > (ankle[1] - mean(soles[0])).norm()) std::swap(ankle[0], ankle[1]);
  const auto reach = [&](std::size_t foot, const Vec3& way) {
    double most = 0;
    for (const Vec3& p : soles[foot]) most = std::max(most, (p - ankle[foot]).dot(way));
    return most;
  };
  for (const Vec3& way : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-1, 0, 0)}) {
    const Vec3 aside = way.cross(Vec3::UnitY());
    const bool clear = std::ranges::all_of(std::array<std::size_t, 2>{0, 1}, [&](std::size_t foot) {
      const double toes = reach(foot, way);
      return toes > toes_over_heel * reach(foot, -way) && toes > reach(foot, aside) && toes > reach(foot, -aside);
    });
    if (clear) return way;
  }
  return std::nullopt;
}

Level level_of(std::span<const Vec3> x) {
  Level level{x[0].y(), x[0].y()};
  double high = level.low;
  for (const Vec3& p : x) {
    level.low = std::min(level.low, p.y());
    high = std::max(high, p.y());
  }
  level.height = high - level.low;
  return level;
}

}  // namespace

Mat3 z_up_to_y_up() {
  Mat3 turn;
  turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

Turned upright(std::span<const Vec3> positions, std::span<const Triangle> triangles, UpAxis up) {
  Turned turned;
  if (up == UpAxis::y) return turned;
  Vec3s x(positions.begin(), positions.end());
  const auto turn = [&](const Mat3& rotation, const char* note) {
    turned.rotation = rotation * turned.rotation;
    if (note != nullptr) turned.notes.push_back(std::string(note) + "; up = y (--body-up y) keeps it as it is");
    for (Vec3& p : x) p = rotation * p;
  };
  if (up == UpAxis::z) {
    turn(z_up_to_y_up(), nullptr);
    return turned;
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& p : x) box.extend(p);
  const Vec3 size = box.sizes();
  if (size.y() < size.x() && size.y() < 0.5 * size.z()) turn(z_up_to_y_up(), "z is up in it: turned to (x, z, -y)");
  if (is_upside_down(x, triangles, level_of(x)))
    turn(half_turn_about(Vec3::UnitZ()), "it stands on its head: turned to (-x, -y, z)");
  else if (has_neck(x, triangles, level_of(x), false) && !has_neck(x, triangles, level_of(x), true))
    turned.notes.emplace_back("it may stand on its head, with a neck below and none above: turn its file if it does");
  const auto way = facing(x, triangles, level_of(x));
  if (way && *way == Vec3(0, 0, -1)) turn(half_turn_about(Vec3::UnitY()), "it faces -z: turned to (-x, y, -z)");
  if (way && way->x() != 0) {
    Mat3 quarter;
    quarter << 0, 0, -way->x(), 0, 1, 0, way->x(), 0, 0;
    turn(quarter, way->x() > 0 ? "it faces +x: turned to (-z, y, x)" : "it faces -x: turned to (z, y, -x)");
  }
  return turned;
}

}  // namespace toile::internal
