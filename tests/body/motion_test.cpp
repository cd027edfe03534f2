// Motions: they begin at rest in the A-pose, repeat, never jump, stay on the floor, and no limb enters another.
#include "body/motion.hpp"

#include "body/closed_mesh.hpp"
#include "body/mannequins.hpp"
#include "body/movements.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace toile::internal {
namespace {

using test::joint;
using test::mannequin_of;

constexpr double half_turn = 3.14159265358979323846;

using KindAndMotion = std::pair<MannequinKind, const char*>;

class EachMotion : public testing::TestWithParam<KindAndMotion> {
 protected:
  MannequinKind kind() const { return GetParam().first; }
  std::string name() const { return GetParam().second; }
  Motion motion() const { return Motion::named(name(), kind()); }
  const Mannequin& mannequin() const { return mannequin_of(kind()); }
  double end_s(const Motion& m) const { return m.loop_start_s() + m.period_s(); }
};

// Ends of all bones: fingers, toes, crown.
std::vector<Vec3> bone_ends(const Motion& motion, double t_s) {
  const auto transforms = joint_transforms(motion.joints(), motion.at(t_s));
  std::vector<Vec3> ends;
  for (std::size_t j = 0; j < transforms.size(); ++j) ends.push_back(transforms[j](motion.joints()[j].end_m));
  return ends;
}

double farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double d = 0;
  for (std::size_t i = 0; i < a.size(); ++i) d = std::max(d, (a[i] - b[i]).norm());
  return d;
}

TEST_P(EachMotion, BeginsAtRestInTheAPose) {
  const Motion m = motion();
  const auto rest = bone_ends(m, -1), start = bone_ends(m, 0), soon = bone_ends(m, 1e-3);
  for (std::size_t j = 0; j < rest.size(); ++j) EXPECT_LT((start[j] - m.joints()[j].end_m).norm(), 1e-12);
  EXPECT_LT(farthest(start, rest), 1e-12);
  EXPECT_LT(farthest(start, soon) / 1e-3, 1e-3);  // m/s
}

TEST_P(EachMotion, RepeatsWithItsPeriodAfterTheLeadIn) {
  const Motion m = motion();
  for (const double t : {0.0, 0.11, 0.5, 0.93})
    EXPECT_LT(farthest(bone_ends(m, m.loop_start_s() + t), bone_ends(m, m.loop_start_s() + t + m.period_s())), 1e-9);
}

// At 1 kHz a velocity that jumps by 0.2 m/s would show as 200 m/s^2.
TEST_P(EachMotion, NeverJumpsAndIsHumanlyFast) {
  static const std::map<std::string, std::pair<double, double>> bounds = {{"stand", {1e-9, 1e-6}}, {"sway", {0.7, 3}},
                                                                          {"walk", {5, 60}},       {"twist", {3.5, 30}},
                                                                          {"crouch", {2.5, 20}},   {"dance", {8, 110}}};
  const auto [fastest, hardest] = bounds.at(name());
  const Motion m = motion();
  constexpr double h = 1e-3;
  const int steps = static_cast<int>((end_s(m) + 0.1) / h);
  std::vector<Vec3> before = bone_ends(m, 0), now = bone_ends(m, h);
  double speed = 0, acceleration = 0;
  for (int k = 2; k <= steps; ++k) {
    const std::vector<Vec3> next = bone_ends(m, h * k);
    for (std::size_t j = 0; j < next.size(); ++j) {
      speed = std::max(speed, (next[j] - now[j]).norm() / h);
      acceleration = std::max(acceleration, (next[j] - 2 * now[j] + before[j]).norm() / (h * h));
    }
    before = std::exchange(now, next);
  }
  EXPECT_LT(speed, fastest);
  EXPECT_LT(acceleration, hardest);
  if (name() != "stand") {
    EXPECT_GT(speed, 0.4 * fastest);
  }
  RecordProperty("speed_m_s", std::to_string(speed));
  RecordProperty("acceleration_m_s2", std::to_string(acceleration));
}

TEST_P(EachMotion, StaysOnTheFloorAndOutOfItself) {
  const Motion m = motion();
  const SkinnedBody body(mannequin());
  std::vector<Vec3> x(body.vertex_count());
  const double every = name() == "dance" ? 0.17 : 0.1;
  const int frames = static_cast<int>(end_s(m) / every);
  for (int f = 1; f <= frames; ++f) {
    const double t = every * f;
    body.positions(m.at(t), x);
    double low = 1;
    for (const Vec3& p : x) low = std::min(low, p.y());
    EXPECT_GT(low, -sole_depth_m) << "at " << t;
    EXPECT_LT(low, 0.008) << "at " << t;  // never in the air
    if (name() != "crouch") {
      EXPECT_EQ(test::self_intersection_count(x, mannequin().triangles), 0) << "at " << t;
    }
  }
}

std::string case_name(const testing::TestParamInfo<KindAndMotion>& info) {
  return std::string(to_string(info.param.first)) + "_" + info.param.second;
}

INSTANTIATE_TEST_SUITE_P(
    All, EachMotion,
    testing::Values(KindAndMotion{MannequinKind::dancer, "stand"}, KindAndMotion{MannequinKind::dancer, "sway"},
                    KindAndMotion{MannequinKind::dancer, "walk"}, KindAndMotion{MannequinKind::dancer, "twist"},
                    KindAndMotion{MannequinKind::dancer, "dance"}, KindAndMotion{MannequinKind::man, "sway"},
                    KindAndMotion{MannequinKind::man, "walk"}, KindAndMotion{MannequinKind::man, "twist"},
                    KindAndMotion{MannequinKind::man, "dance"}, KindAndMotion{MannequinKind::dancer, "crouch"},
                    KindAndMotion{MannequinKind::man, "crouch"}),
    case_name);

// What the crouch is for: flesh in flesh at elbows, hips and knees, at its lowest alone.
TEST(Motion, CrouchFoldsTheBodyIntoItselfAndOutAgain) {
  for (const MannequinKind kind : {MannequinKind::woman, MannequinKind::dancer, MannequinKind::man}) {
    const Motion m = Motion::named("crouch", kind);
    const Mannequin& mannequin = mannequin_of(kind);
    const SkinnedBody body(mannequin);
    std::vector<Vec3> x(body.vertex_count());
    body.positions(m.at(m.lead_in_s() + 1.6), x);
    EXPECT_GT(test::self_intersection_count(x, mannequin.triangles), 100);
    body.positions(m.at(m.lead_in_s() + 3.5), x);
    EXPECT_EQ(test::self_intersection_count(x, mannequin.triangles), 0);
  }
}

// The counter above does see an arm in the trunk.
TEST(Motion, AnArmThatHangsCloseWouldBeSeen) {
  const Mannequin& m = mannequin_of(MannequinKind::dancer);
  Posture p;
  p(Channel::arm_out) = -55;
  std::vector<Vec3> x(m.positions.size());
  SkinnedBody(m).positions(make_pose(p, Legs::planted, m.joints), x);
  EXPECT_GT(test::self_intersection_count(x, m.triangles), 20);
}

TEST(Motion, IsFoundByNameAndAWrongOneIsAnsweredWithTheNearest) {
  for (const std::string_view name : motion_names()) EXPECT_EQ(Motion::named(name).name(), name);
  try {
    Motion::named("wlak");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean walk?"), std::string::npos) << e.what();
  }
  Motion m = Motion::named("walk");
  EXPECT_THROW(m.set_lead_in_s(-1), InputError);
  EXPECT_THROW(m.set_lead_in_s(0.0 / 0.0), InputError);
}

TEST(Motion, WithoutALeadInStartsInTheMiddleOfThings) {
  Motion m = Motion::named("walk"), led = m;
  m.set_lead_in_s(0);
  EXPECT_LT(farthest(bone_ends(m, 0.4), bone_ends(led, led.lead_in_s() + 0.4)), 1e-12);
  EXPECT_GT(farthest(bone_ends(m, 0), bone_ends(m, -1)), 0.1);
}

double angle(const Quaternion& q) { return 2 * ieee_atan2(std::sqrt(q.v.dot(q.v)), q.w) * 180 / half_turn; }

// Winter 2009; Perry & Burnfield 2010: peaks of level walking, and when in the stride.
TEST(Motion, WalkBendsHipKneeAndAnkleAsPublished) {
  const auto extreme = [](Channel c, double from, double to, bool largest) {
    std::pair<double, double> best{largest ? -1e9 : 1e9, 0};
    for (double phase = from; phase <= to; phase += 0.005) {
      const double v = walk_posture(phase * walk_period_s)(c, Side::left);
      if (largest == (v > best.first)) best = {v, phase};
    }
    return best;
  };
  const auto [swing_knee, swing_at] = extreme(Channel::knee, 0.5, 1.0, true);
  EXPECT_NEAR(swing_knee, 60, 4);
  EXPECT_NEAR(swing_at, 0.72, 0.03);
  EXPECT_NEAR(extreme(Channel::knee, 0.0, 0.4, true).first, 18, 4);  // loading
  EXPECT_NEAR(extreme(Channel::leg_forward, 0.3, 0.7, false).first, -9, 5);
  EXPECT_NEAR(extreme(Channel::leg_forward, 0.7, 1.0, true).first, 32, 5);
  EXPECT_NEAR(extreme(Channel::ankle, 0.3, 0.5, true).first, 10, 3);
  EXPECT_NEAR(extreme(Channel::ankle, 0.5, 0.75, false).first, -17, 4);
}

TEST(Motion, WalkSwingsArmsAgainstLegsAndPlantsTheFootWhileItCarries) {
  Motion m = Motion::named("walk", MannequinKind::man);
  m.set_lead_in_s(0);
  const auto at = [&](double phase) { return bone_ends(m, phase * walk_period_s); };
  const Mannequin& man = mannequin_of(MannequinKind::man);
  const std::size_t left_hand = joint(man, "wrist_left"), right_hand = joint(man, "wrist_right");
  const std::size_t left_toes = joint(man, "toes_left"), right_toes = joint(man, "toes_right");
  const auto strike = at(0);
  EXPECT_GT(strike[left_toes].z() - strike[right_toes].z(), 0.5);   // the left leg ahead,
  EXPECT_LT(strike[left_hand].z() - strike[right_hand].z(), -0.3);  // its arm behind
  // Between 18 and 40 % of the stride the left foot is flat on the belt, which runs backwards evenly.
  for (double phase = 0.18; phase < 0.40; phase += 0.05) {
    EXPECT_NEAR(at(phase)[left_toes].y(), man.joints[left_toes].end_m.y(), 0.02) << phase;
    const double belt = (at(phase + 0.01)[left_toes].z() - at(phase)[left_toes].z()) / (0.01 * walk_period_s);
    EXPECT_NEAR(belt, -1.25, 0.1) << phase;
  }
  // Half a stride later everything is mirrored.
  const auto other = at(0.37 + 0.5), one = at(0.37);
  for (std::size_t j = 0; j < one.size(); ++j) {
    std::string name = man.joints[j].name;
    if (const auto p = name.find("_left"); p != std::string::npos)
      name.replace(p, 5, "_right");
    else if (const auto q = name.find("_right"); q != std::string::npos)
      name.replace(q, 6, "_left");
    const Vec3 image = other[joint(man, name)];
    EXPECT_LT((one[j] - Vec3(-image.x(), image.y(), image.z())).norm(), 1e-9) << name;
  }
}

struct Peaks {
  double low = 1e9, high = -1e9, speed = 0, acceleration = 0, jerk = 0;
};

// Of the height of a joint, by differences over 2 ms.
Peaks vertical_peaks(const Motion& m, std::size_t joint, double from_s, double to_s) {
  const auto y = [&](double t) {
    return joint_transforms(m.joints(), m.at(t))[joint](m.joints()[joint].position_m).y();
  };
  constexpr double h = 2e-3;
  Peaks p;
  for (double t = from_s; t < to_s; t += h) {
    const double a = y(t - 2 * h), b = y(t - h), c = y(t), d = y(t + h), e = y(t + 2 * h);
    p.low = std::min(p.low, c);
    p.high = std::max(p.high, c);
    p.speed = std::max(p.speed, std::abs(d - b) / (2 * h));
    p.acceleration = std::max(p.acceleration, std::abs(d - 2 * c + b) / (h * h));
    p.jerk = std::max(p.jerk, std::abs(e - 2 * d + 2 * b - a) / (2 * h * h * h));
  }
  return p;
}

// People at 1.2 m/s: the pelvis rises and falls by 3 to 5 cm, twice per stride.  A sinusoid of that height and frequency has
// at most 0.3 m/s and 3.5 m/s^2; a corner of 0.1 m/s would show here as 50 m/s^2, one in the acceleration as a jerk of
// thousands.
TEST(Motion, ThePelvisOfTheWalkRisesAndFallsAsPublishedAndNeverJolts) {
  for (const MannequinKind kind : {MannequinKind::dancer, MannequinKind::man}) {
    const Motion m = Motion::named("walk", kind);
    const std::size_t hips = joint(mannequin_of(kind), "hips"), knee = joint(mannequin_of(kind), "knee_left");
    const double start = m.loop_start_s(), end = start + m.period_s();
    const Peaks loop = vertical_peaks(m, hips, start, end), lead = vertical_peaks(m, hips, 0.01, start + 0.1);
    EXPECT_GT(loop.high - loop.low, 0.025);
    EXPECT_LT(loop.high - loop.low, 0.05);
    for (const Peaks& p : {loop, lead}) {
      EXPECT_LT(p.speed, 0.26);
      EXPECT_LT(p.acceleration, 3);
      EXPECT_LT(p.jerk, 45);
    }
    const Peaks bent = vertical_peaks(m, knee, 0.01, end);
    EXPECT_LT(bent.speed, 0.6);
    EXPECT_LT(bent.acceleration, 16);
    EXPECT_LT(bent.jerk, 500);
    RecordProperty("hips", std::to_string(loop.speed) + " " + std::to_string(loop.acceleration) + " " +
                               std::to_string(lead.speed) + " " + std::to_string(lead.acceleration) + " " +
                               std::to_string(loop.jerk) + " " + std::to_string(lead.jerk) + " knee " +
                               std::to_string(bent.speed) + " " + std::to_string(bent.acceleration) + " " +
                               std::to_string(bent.jerk));
  }
}

// The foot that carries, in the middle of its stance and at both ends, over both legs and the way into the walk.
TEST(Motion, AWalkingSoleStaysWithinACentimetreOfTheFloor) {
  for (const MannequinKind kind : {MannequinKind::dancer, MannequinKind::man}) {
    Motion m = Motion::named("walk", kind);
    const SkinnedBody body(mannequin_of(kind));
    const std::vector<Vec3>& rest = mannequin_of(kind).positions;
    std::vector<Vec3> x(body.vertex_count());
    double above = 0, below = 0, middle = 0;
    for (double t = 0; t < m.loop_start_s() + m.period_s(); t += 0.02) {
      body.positions(m.at(t), x);
      double low = 1, left = 1;
      for (std::size_t i = 0; i < x.size(); ++i) {
        low = std::min(low, x[i].y());
        if (rest[i].x() > 0) left = std::min(left, x[i].y());
      }
      above = std::max(above, low);
      below = std::max(below, -low);
      const double phase = (t - m.loop_start_s()) / m.period_s();
      if (phase > 0.15 && phase < 0.45) middle = std::max(middle, std::abs(left));
    }
    EXPECT_LT(above, 0.002);
    EXPECT_LT(below, 0.0095);
    EXPECT_LT(middle, 0.005);
    RecordProperty("soles", std::to_string(above) + " " + std::to_string(below) + " " + std::to_string(middle));
  }
}

TEST(Motion, TwistTurnsTheChestByFortyDegreesWithArmsOutAndFeetStill) {
  const Motion m = Motion::named("twist");
  const Mannequin& w = mannequin_of(MannequinKind::dancer);
  const std::size_t chest = joint(w, "chest"), ankle = joint(w, "ankle_left"), toes = joint(w, "toes_left");
  const std::size_t shoulder = joint(w, "shoulder_left"), wrist = joint(w, "wrist_left");
  double most = 0;
  for (double t = m.loop_start_s(); t < m.loop_start_s() + m.period_s(); t += 0.01) {
    const auto transforms = joint_transforms(w.joints, m.at(t));
    most = std::max(most, std::abs(angle(transforms[chest].turn)));
    EXPECT_LT((transforms[ankle](w.joints[ankle].position_m) - w.joints[ankle].position_m).norm(), 1e-9);
    EXPECT_LT((transforms[toes](w.joints[toes].end_m) - w.joints[toes].end_m).norm(), 1e-9);
    const Vec3 arm =
        transforms[wrist](w.joints[wrist].position_m) - transforms[shoulder](w.joints[shoulder].position_m);
    const double out = ieee_atan2(std::sqrt(arm.x() * arm.x() + arm.z() * arm.z()), -arm.y()) * 180 / half_turn;
    EXPECT_NEAR(out, 80, 8);
  }
  EXPECT_NEAR(most, 40, 1);
}

TEST(Motion, DanceTurnsTwiceAroundAndSpinsAtTwoTurnsASecond) {
  double fastest = 0;
  for (double t = 0; t < dance_period_s; t += 0.001)
    fastest =
        std::max(fastest, (dance_posture(t + 1e-4)(Channel::turn) - dance_posture(t)(Channel::turn)) / 1e-4 / 360);
  EXPECT_NEAR(fastest, 2.0, 0.02);
  EXPECT_NEAR(dance_posture(dance_period_s + 0.2)(Channel::turn) - dance_posture(0.2)(Channel::turn), 720, 1e-9);
  EXPECT_NEAR(dance_posture(-0.2)(Channel::turn), 0, 1e-9);  // the lead-in comes from here
}

TEST(Motion, LeastJerkIsSmoothAtBothEnds) {
  EXPECT_EQ(least_jerk(-1), 0);
  EXPECT_EQ(least_jerk(2), 1);
  EXPECT_DOUBLE_EQ(least_jerk(0.5), 0.5);
  const double h = 1e-4;
  for (const double u : {0.0, 1.0}) {
    EXPECT_LT(std::abs(least_jerk(u + h) - least_jerk(u - h)) / (2 * h), 1e-6);
    EXPECT_LT(std::abs(least_jerk(u + h) - 2 * least_jerk(u) + least_jerk(u - h)) / (h * h), 0.01);
  }
}

TEST(Motion, HasTheSameBitsEverywhere) {
  Hash hash;
  const SkinnedBody body(mannequin_of(MannequinKind::dancer));
  std::vector<Vec3> x(body.vertex_count());
  for (const std::string_view name : motion_names()) {
    const Motion m = Motion::named(name, MannequinKind::dancer);
    for (const double t : {0.3, 1.7, 11.4}) {
      body.positions(m.at(t), x);
      hash.add(std::span<const Vec3>(x));
    }
  }
  EXPECT_EQ(hash.hex(), "3c3ce5a6b345ce20");
}

}  // namespace
}  // namespace toile::internal
