// Our own patterns against our own mannequin: seams that fit, panels that start clear of the body, and threads that
// do not cut it.
//
// Reads the JSON by itself, in few lines, so that the pattern reader is not judged by its own eyes.
#include "body/closed_mesh.hpp"
#include "body/mannequin.hpp"
#include "body/mannequin_shape.hpp"
#include "body/mannequins.hpp"
#include "body/measure.hpp"
#include "io/json.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>
#include <string>

namespace toile::internal {
namespace {

struct DraftSide {
  std::string panel;
  std::size_t edge;
};
struct DraftPanel {
  Vec3 translation;
  double turn = 0;                       // about z, radians
  std::vector<std::vector<Vec2>> edges;  // each with 33 points equally spaced by arc length, cm
  std::vector<double> length;            // cm
  std::vector<std::string> labels;
  Vec3 place(const Vec2& p) const {  // m
    const double c = std::cos(turn), s = std::sin(turn);
    return 0.01 * (Vec3(c * p.x() - s * p.y(), s * p.x() + c * p.y(), 0) + translation);
  }
  double signed_area() const {
    double sum = 0;
    for (const auto& e : edges)
      for (std::size_t i = 0; i + 1 < e.size(); ++i) sum += e[i].x() * e[i + 1].y() - e[i + 1].x() * e[i].y();
    return sum / 2;
  }
};
struct Draft {
  std::map<std::string, DraftPanel> panels;
  std::vector<std::pair<DraftSide, DraftSide>> stitches;
  const DraftPanel& panel(const DraftSide& s) const { return panels.at(s.panel); }
  double length(const DraftSide& s) const { return panel(s).length.at(s.edge); }
  // The points of a stitch's two sides in the order in which they are sewn: end of the first with start of the second.
  std::pair<Vec3s, Vec3s> sewn(const std::pair<DraftSide, DraftSide>& stitch) const {
    std::pair<Vec3s, Vec3s> out;
    for (const Vec2& p : panel(stitch.first).edges[stitch.first.edge])
      out.first.push_back(panel(stitch.first).place(p));
    for (const Vec2& p : panel(stitch.second).edges[stitch.second.edge])
      out.second.push_back(panel(stitch.second).place(p));
    std::reverse(out.second.begin(), out.second.end());
    return out;
  }
};

Vec2 pair_of(const Json& j) { return {j.array().at(0).number(), j.array().at(1).number()}; }

std::vector<Vec2> sampled(std::vector<Vec2> control, double& length) {
  std::vector<Vec2> fine;
  for (int i = 0; i <= 2000; ++i) {
    std::vector<Vec2> p = control;
    const double t = i / 2000.0;
    for (; p.size() > 1; p.pop_back())
      for (std::size_t k = 0; k + 1 < p.size(); ++k) p[k] = (1 - t) * p[k] + t * p[k + 1];
    fine.push_back(p[0]);
  }
  std::vector<double> s{0};
  for (std::size_t i = 1; i < fine.size(); ++i) s.push_back(s.back() + (fine[i] - fine[i - 1]).norm());
  length = s.back();
  std::vector<Vec2> even;
  for (int i = 0; i <= 32; ++i)
    even.push_back(
        fine[at(static_cast<Index>(std::lower_bound(s.begin(), s.end(), length * i / 32.0 - 1e-9) - s.begin()))]);
  return even;
}

Draft load(const std::string& name) {
  const Json file = Json::load(test::source_path("patterns/") + name);
  EXPECT_EQ(file.at("properties").at("units_in_meter").number(), 100);
  EXPECT_EQ(file.at("properties").at("curvature_coords").string(), "relative");
  Draft draft;
  for (const auto& [key, json] : file.at("pattern").at("panels").object()) {
    DraftPanel panel;
    const auto& t = json.at("translation").array();
    panel.translation = {t[0].number(), t[1].number(), t[2].number()};
    const auto& r = json.at("rotation").array();
    EXPECT_EQ(r[0].number(), 0);
    EXPECT_EQ(r[1].number(), 0);
    panel.turn = r[2].number() * M_PI / 180;
    const auto& corners = json.at("vertices").array();
    for (const Json& e : json.at("edges").array()) {
      const auto corner = [&](std::size_t k) {
        return pair_of(corners.at(static_cast<std::size_t>(e.at("endpoints").array().at(k).integer())));
      };
      const Vec2 along = corner(1) - corner(0), across(-along.y(), along.x());
      std::vector<Vec2> control{corner(0)};
      if (const Json* curve = e.find("curvature"))
        for (const Json& c : curve->at("params").array())
          control.push_back(corner(0) + pair_of(c).x() * along + pair_of(c).y() * across);
      control.push_back(corner(1));
      panel.edges.push_back(sampled(control, panel.length.emplace_back()));
      panel.labels.push_back(e.string_or("label", ""));
    }
    draft.panels[key] = panel;
  }
  for (const Json& s : file.at("pattern").at("stitches").array()) {
    EXPECT_EQ(s.array().size(), 2U);
    const auto side = [&](std::size_t k) {
      const Json& j = s.array().at(k);
      return DraftSide{j.at("panel").string(), static_cast<std::size_t>(j.at("edge").integer())};
    };
    draft.stitches.emplace_back(side(0), side(1));
  }
  return draft;
}

const Mannequin& woman_of_ours() {
  static const Mannequin m = test::mannequin_of(MannequinKind::woman);
  return m;
}

class OwnPattern : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, OwnPattern, testing::Values("tshirt.json", "skirt.json"), [](const auto& which) {
  return std::string(which.param).substr(0, std::string(which.param).find('.'));
});

TEST_P(OwnPattern, HasClosedLoopsWhoseNormalsPointAwayFromTheBody) {
  for (const auto& [name, panel] : load(GetParam()).panels) {
    for (std::size_t k = 0; k < panel.edges.size(); ++k)
      EXPECT_LT((panel.edges[k].back() - panel.edges[(k + 1) % panel.edges.size()].front()).norm(), 1e-9)
          << name << " edge " << k;
    EXPECT_EQ(panel.signed_area() > 0, panel.translation.z() > 0) << name;
  }
}

TEST_P(OwnPattern, SewsEachEdgeOnceToOneOfItsLength) {
  const Draft draft = load(GetParam());
  std::set<std::pair<std::string, std::size_t>> used;
  for (const auto& [a, b] : draft.stitches) {
    EXPECT_TRUE(used.insert({a.panel, a.edge}).second) << a.panel << " " << a.edge;
    EXPECT_TRUE(used.insert({b.panel, b.edge}).second) << b.panel << " " << b.edge;
    // A neckband draws its neckline in.
    const double ratio = a.panel.starts_with("band_") && !b.panel.starts_with("band_") ? 0.945 : 1;
    EXPECT_NEAR(draft.length(a) / draft.length(b), ratio, 0.02) << a.panel << " " << a.edge;
  }
}

TEST_P(OwnPattern, SewsTheEndsThatLieNearEachOther) {
  const Draft draft = load(GetParam());
  for (const auto& stitch : draft.stitches) {
    const auto [p, q] = draft.sewn(stitch);
    const double as_sewn = (p.front() - q.front()).norm() + (p.back() - q.back()).norm();
    const double twisted = (p.front() - q.back()).norm() + (p.back() - q.front()).norm();
    // The ends of a band, 2 cm wide and 46 cm apart, cannot differ by more than 0.7 mm.
    const double largest_m = 2 * (std::hypot(as_sewn / 2, (p.front() - p.back()).norm()) - as_sewn / 2);
    EXPECT_LT(as_sewn, twisted - std::min(0.01, 0.9 * largest_m)) << stitch.first.panel << " " << stitch.first.edge;
    const double apart =
        0.01 * std::abs(draft.panel(stitch.first).translation.z() - draft.panel(stitch.second).translation.z());
    EXPECT_LT((p.front() - q.front()).norm(), apart + 0.06);
    EXPECT_LT((p.back() - q.back()).norm(), apart + 0.06);
  }
}

TEST_P(OwnPattern, StartsClearOfTheBodyWithThreadsThatPassBesideIt) {
  const Draft draft = load(GetParam());
  const test::Obstacle body(woman_of_ours().positions, woman_of_ours().triangles);
  for (const auto& [name, panel] : draft.panels) {
    Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    for (const auto& e : panel.edges)
      for (std::size_t i = 0; i + 1 < e.size(); ++i) {
        EXPECT_FALSE(body.meets(panel.place(e[i]), panel.place(e[i + 1]))) << name;
        low = low.cwiseMin(e[i]);
        high = high.cwiseMax(e[i]);
      }
    // The rows of the panel's box: nothing of the body stands in its plane there.
    for (double y = low.y(); y <= high.y(); y += 1)
      EXPECT_FALSE(body.meets(panel.place({low.x(), y}), panel.place({high.x(), y}))) << name << " at y " << y;
  }
  for (const auto& stitch : draft.stitches) {
    const auto [p, q] = draft.sewn(stitch);
    for (std::size_t i = 0; i < p.size(); ++i)
      EXPECT_FALSE(body.meets(p[i], q[i])) << stitch.first.panel << " " << stitch.first.edge << " point " << i;
  }
}

// Width of a panel's outline at a world height, cm.
double width_at(const DraftPanel& panel, double y_cm) {
  double low = 1e9, high = -1e9;
  for (const auto& e : panel.edges)
    for (std::size_t i = 0; i + 1 < e.size(); ++i) {
      const double a = e[i].y() + panel.translation.y() - y_cm, b = e[i + 1].y() + panel.translation.y() - y_cm;
      if ((a < 0) == (b < 0)) continue;
      const double x = e[i].x() + a / (a - b) * (e[i + 1].x() - e[i].x());
      low = std::min(low, x);
      high = std::max(high, x);
    }
  return high - low;
}

TEST(Tshirt, HasEaseAtBustHipsArmAndNeck) {
  const Draft shirt = load("tshirt.json");
  const auto& m = woman_of_ours().measurements_m;
  const double chest = width_at(shirt.panels.at("front"), 121.9) + width_at(shirt.panels.at("back"), 121.9);
  EXPECT_GE(chest, 100 * m.bust + 6);
  EXPECT_LE(chest, 100 * m.bust + 10);
  const double hem = shirt.panels.at("front").length[0] + shirt.panels.at("back").length[7];
  EXPECT_GT(hem, 100 * m.hips + 2);
  const double neckline = shirt.panels.at("front").length[4] + shirt.panels.at("back").length[3];
  EXPECT_GT(neckline, 100 * m.neck_girth + 6);
  EXPECT_LT(neckline, 100 * m.neck_girth + 20);

  const ArmAxis arm = left_arm_axis();
  const auto girth = [&](double t) {
    return 100 *
           girth_at_m(woman_of_ours().positions, woman_of_ours().triangles, arm.shoulder + t * arm.along, arm.along);
  };
  const auto& front = shirt.panels.at("left_sleeve_front");
  const auto& back = shirt.panels.at("left_sleeve_back");
  EXPECT_GT(front.length[2] + back.length[1], girth(0.20) + 4);
  const double sleeve = front.length[3];
  EXPECT_LT(0.01 * sleeve, arm.elbow - 0.04);  // ends above the elbow
}

TEST(Tshirt, SleeveCapsFitTheirArmholes) {
  const Draft shirt = load("tshirt.json");
  for (const std::string side : {"left", "right"}) {
    double caps = 0, armholes = 0;
    int seams = 0;
    for (const auto& [a, b] : shirt.stitches)
      if (a.panel.starts_with(side) && (b.panel == "front" || b.panel == "back")) {
        caps += shirt.length(a);
        armholes += shirt.length(b);
        ++seams;
      }
    EXPECT_EQ(seams, 2);
    EXPECT_GE(caps, armholes);
    EXPECT_LE(caps, 1.02 * armholes);
  }
}

TEST(Skirt, SitsOnTheWaistAndCannotPassTheHips) {
  const Draft skirt = load("skirt.json");
  const auto& m = woman_of_ours().measurements_m;
  double waist = 0;
  for (const auto& [name, panel] : skirt.panels)
    for (std::size_t k = 0; k < panel.edges.size(); ++k)
      if (panel.labels[k] == "lower_interface") waist += panel.length[k];
  EXPECT_GE(waist, 100 * m.waist);
  EXPECT_LE(waist, 100 * m.waist + 1);
  EXPECT_LT(waist, 100 * m.hips - 20);
  // Along the side, 20 cm below the waist, there is room for the hips.
  const auto& panel = skirt.panels.at("front");
  const auto& side = panel.edges[1];
  const double half = side[static_cast<std::size_t>(32 * (1 - 20 / panel.length[1]))].x();
  EXPECT_GT(4 * half, 100 * m.hips - 2);
}

}  // namespace
}  // namespace toile::internal
