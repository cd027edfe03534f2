// A person without a skeleton: what bending the middle line keeps, and what it moves.
#include "body/middle_line.hpp"

#include "body/body_motion.hpp"
#include "body/closed_mesh.hpp"
#include "body/mannequins.hpp"
#include "body/measure.hpp"
#include "body/movements.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "io/obj.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace toile::internal {
namespace {

CollisionBody woman() { return from_mannequin(test::mannequin_of(MannequinKind::woman)); }

Motion motion_named(std::string_view name) {
  Motion motion = Motion::named(name);
  motion.set_lead_in_s(1);
  return motion;
}

// The largest change of an edge's length, of its length at rest, over a whole period and the way into it.
double most_stretched(const CollisionBody& body, std::string_view name) {
  const Motion motion = motion_named(name);
  const BodyMotion moving = BodyMotion::of_person("body.obj", body, motion);
  Vec3s x(body.positions.size());
  double most = 0;
  for (double t = 0; t < 1 + motion.period_s(); t += 0.1) {
    moving.positions(t, x);
    for (const Triangle& triangle : body.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = at(triangle[k]), j = at(triangle[(k + 1) % 3]);
        const double rest = (body.positions[i] - body.positions[j]).norm();
        most = std::max(most, std::abs((x[i] - x[j]).norm() / rest - 1));
      }
  }
  return most;
}

CollisionBody body_of_others(const std::string& name) {
  const std::string file = test::shared_path("bodies/garmentcode/") + name;
  if (!std::filesystem::exists(file)) return {};
  return make_collision_body(load_obj(file), file, LengthUnit::automatic);
}

TEST(MiddleLine, APostureOfZerosIsTheStandingBodyToTheBit) {
  const CollisionBody body = woman();
  const BodyMotion moving = BodyMotion::of_person("body.obj", body, motion_named("sway"));
  Vec3s x(body.positions.size());
  moving.positions(0, x);
  EXPECT_EQ(x, body.positions);
  moving.positions(0.5, x);
  EXPECT_NE(x, body.positions);
}

TEST(MiddleLine, FeetStayOnTheFloorAndHipsGoWhereTheMannequinsGo) {
  const CollisionBody body = woman();
  const MiddleLine line("body.obj", body.positions, body.triangles);
  const auto middle_at_hips = [&](std::span<const Vec3> x) {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::abs(body.positions[i].y() - line.hips_m()) < 0.01 && std::abs(body.positions[i].x()) < 0.25) {
        sum += x[i];
        ++count;
      }
    return Vec3(sum / count);
  };
  Vec3s x(body.positions.size());
  const double height = body.height_m, quarter = sway_period_s / 4;
  for (double t = 0; t < sway_period_s; t += 0.2) {
    line.bend(sway_posture(t), x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool foot = body.positions[i].y() <= 0.04 * height;
      ASSERT_TRUE(!foot || x[i] == body.positions[i]) << i << " at " << t;
    }
  }
  const Vec3 standing = middle_at_hips(body.positions);
  for (const double side : {1.0, -1.0}) {
    line.bend(sway_posture(side * quarter), x);
    const Vec3 moved = middle_at_hips(x) - standing;
    EXPECT_NEAR(moved.x(), side * 0.045 * height / 1.72, 0.001) << "as pelvis_x of the mannequins' sway";
    EXPECT_NEAR(moved.y(), 0, 0.004) << "two rods that lean by 3 degrees";
  }
}

// A chest that leans by 2 degrees to the left, in the world, and by what the spine turns.
TEST(MiddleLine, ArmsAndChestAreCarriedAsOneStiffPiece) {
  const CollisionBody body = woman();
  const MiddleLine line("body.obj", body.positions, body.triangles);
  std::vector<std::size_t> stiff;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3& p = body.positions[i];
    const bool arm = std::abs(p.x()) > 0.28, chest = p.y() > line.ribs_m() && p.y() < 0.81 * body.height_m;
    if (arm || chest) stiff.push_back(i);
  }
  ASSERT_GT(stiff.size(), 1000U);
  Vec3s x(body.positions.size());
  line.bend(sway_posture(sway_period_s / 4), x);
  const std::size_t first = stiff.front();
  for (const std::size_t i : stiff)
    for (const std::size_t j : {first, stiff[stiff.size() / 2], stiff.back()})
      ASSERT_NEAR((x[i] - x[j]).norm(), (body.positions[i] - body.positions[j]).norm(), 1e-6) << i << ' ' << j;
  const Posture full = sway_posture(sway_period_s / 4);
  EXPECT_NEAR(full(Channel::spine_left) + full(Channel::chest_left) - full(Channel::pelvis_list), 2, 1e-9);
  // Two points of the chest on one level: their slope is that angle.
  std::size_t left = first, right = first;
  for (const std::size_t i : stiff) {
    if (body.positions[i].x() > body.positions[left].x()) left = i;
    if (body.positions[i].x() < body.positions[right].x()) right = i;
  }
  const auto slope = [&](std::span<const Vec3> p) {
    return std::atan2(p[left].y() - p[right].y(), p[left].x() - p[right].x()) * 180 / M_PI;
  };
  EXPECT_NEAR(slope(x) - slope(body.positions), -2, 0.05);
}

TEST(MiddleLine, SwayingChangesTheBodysEdgesByLittle) {
  EXPECT_LT(most_stretched(woman(), "sway"), 0.07);
  EXPECT_LT(most_stretched(from_mannequin(test::mannequin_of(MannequinKind::man)), "sway"), 0.07);
  EXPECT_EQ(most_stretched(woman(), "stand"), 0);
  EXPECT_LT(most_stretched(woman(), "twist"), 0.3);
}

TEST(MiddleLine, SwayingChangesTheEdgesOfTheBodiesOfOthersByLittle) {
  for (const char* name : {"mean_all.obj", "mean_female.obj", "mean_male.obj", "mean_all_tpose.obj"}) {
    const CollisionBody body = body_of_others(name);
    if (body.positions.empty()) GTEST_SKIP() << "no bodies/garmentcode in " << test::shared_path("");
    EXPECT_LT(most_stretched(body, "sway"), 0.07) << name;
  }
}

// Sampled along upright lines of loose vertices, at h and at h/2: a corner's second difference would double.
TEST(MiddleLine, IsSmoothInSpace) {
  CollisionBody body = woman();
  const std::size_t own = body.positions.size();
  const auto sharpest = [&](int points) {
    CollisionBody with = body;
    const double h = body.height_m / points;
    for (int k = 0; k <= points; ++k) with.positions.emplace_back(0.1, h * k, 0.05);
    const MiddleLine line("body.obj", with.positions, with.triangles);
    Vec3s x(with.positions.size());
    line.bend(sway_posture(0.5), x);
    double most = 0;
    for (std::size_t i = own + 1; i + 1 < x.size(); ++i)
      most = std::max(most, (x[i + 1] - 2 * x[i] + x[i - 1]).norm() / (h * h));
    return most;
  };
  const double coarse = sharpest(800), fine = sharpest(1600);
  EXPECT_GT(coarse, 0.1);
  EXPECT_LT(fine, 1.2 * coarse);
}

TEST(MiddleLine, MovesWithoutAJumpInVelocityFromRestOn) {
  const CollisionBody body = woman();
  const BodyMotion moving = BodyMotion::of_person("body.obj", body, motion_named("sway"));
  const double h = 1e-3;
  Vec3s before(body.positions.size()), now = before, after = before;
  double hardest = 0;
  for (const double t : {0.0, 0.3, 0.999, 1.0, 1.001, 1.7, 2.4}) {
    moving.positions(t - h, before);
    moving.positions(t, now);
    moving.positions(t + h, after);
    for (std::size_t i = 0; i < now.size(); i += 7)
      hardest = std::max(hardest, (after[i] - 2 * now[i] + before[i]).norm() / (h * h));
  }
  EXPECT_LT(hardest, 2.5) << "m/s^2, as the mannequins'";
  EXPECT_GT(hardest, 0.1);
}

TEST(MiddleLine, PassesThroughItselfNowhere) {
  const CollisionBody body = woman();
  for (const char* name : {"sway", "twist"}) {
    const Motion motion = motion_named(name);
    const BodyMotion moving = BodyMotion::of_person("body.obj", body, motion);
    Vec3s x(body.positions.size());
    for (double t = 0; t < 1 + motion.period_s(); t += 0.25) {
      moving.positions(t, x);
      EXPECT_EQ(test::self_intersection_count(x, body.triangles), 0) << name << " at " << t;
    }
  }
}

TEST(MiddleLine, TakesUprightPersonsOnly) {
  const auto refusal = [](const CollisionBody& body, std::string_view motion) {
    try {
      BodyMotion::of_person("body.obj", body, Motion::named(motion));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CollisionBody lying = woman(), aside = woman();
  for (Vec3& p : lying.positions) p = Vec3(p.x(), -p.z(), p.y());
  for (Vec3& p : aside.positions) p = Vec3(p.z(), p.y(), -p.x());
  for (const CollisionBody& body : {lying, aside}) {
    const std::string words = refusal(body, "sway");
    EXPECT_NE(words.find("body.obj"), std::string::npos);
    EXPECT_NE(words.find("upright person who faces +z"), std::string::npos) << words;
  }
  for (const char* name : {"walk", "crouch", "dance"}) {
    const std::string words = refusal(woman(), name);
    EXPECT_NE(words.find("stand, sway or twist"), std::string::npos) << words;
    EXPECT_NE(words.find(name), std::string::npos) << words;
  }
  EXPECT_EQ(refusal(woman(), "twist"), "");
}

TEST(MiddleLine, GivesTheSameBitsOnAnyNumberOfThreadsAndTellsMotionsApart) {
  const CollisionBody body = woman();
  const BodyMotion sway = BodyMotion::of_person("body.obj", body, motion_named("sway")),
                   twist = BodyMotion::of_person("body.obj", body, motion_named("twist"));
  Vec3s many(body.positions.size()), one = many;
  sway.positions(1.3, many);
  with_threads(1, [&] { sway.positions(1.3, one); });
  EXPECT_EQ(one, many);
  const auto hash_of = [](const BodyMotion& motion) {
    Hash hash;
    motion.add_to(hash);
    return hash.value();
  };
  EXPECT_NE(hash_of(sway), hash_of(twist));
  EXPECT_NE(hash_of(sway),
            hash_of(BodyMotion::of_mannequin(test::mannequin_of(MannequinKind::woman), motion_named("sway"))));
}

}  // namespace
}  // namespace toile::internal
