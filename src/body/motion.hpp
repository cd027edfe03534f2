// body/motion.hpp: movements of the mannequins as functions of time: stand, sway, walk, twist, crouch, dance.
//
// For t in [0, lead_in] the body comes out of the A-pose: posture(t) = s(t / lead_in) motion(t - lead_in) with
// s(u) = u^3 (10 - 15 u + 6 u^2), so that at t = 0 it rests, and the join is C2.  After that the motion repeats with its
// period.  Motions are C1 in time (C2 but for a knee at full stretch), so that a body's velocity never jumps.
//
// A pelvis that followed the soles would have a corner whenever they take turns on the floor.  The walking one goes by the
// mean of that height and its part of twice per stride; soles stay within a centimetre of the floor.  On the way into the
// walk, with s = share of the motion, angles go with s but the pitch of a foot with s^2, as does the height that bent legs
// lose: then the pelvis' height goes with s^2 too.
//
// Mind: walking is on a treadmill, the pelvis stays over the origin and the standing foot slides backwards.
//                                                                                                      docs/motions.md
#pragma once
#include "body/posture.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

// "stand", "sway", "walk", "twist", "crouch", "dance".
std::span<const std::string_view> motion_names();
// The motions that need no skeleton (body/middle_line.hpp): "stand", "sway", "twist".  Also as words for a message.
std::span<const std::string_view> motion_names_without_skeleton();
inline constexpr std::string_view motions_for_a_mesh =
    "stand, sway or twist, a .pc2 file, a folder of OBJ files or a glTF file: a mesh has no skeleton to walk, crouch "
    "or "
    "dance with, the mannequins have";

class Motion {
 public:
  // Throws InputError naming the nearest valid name.
  static Motion named(std::string_view name, MannequinKind kind = MannequinKind::woman);

  // Throws InputError unless 0 <= seconds <= 10.  0: the run starts in the motion, at its full speed.
  void set_lead_in_s(double seconds);
  double lead_in_s() const { return lead_in_s_; }

  // From here on at(t + period_s()) is at(t).
  double loop_start_s() const { return lead_in_s_; }
  double period_s() const { return period_s_; }

  const std::string& name() const { return name_; }
  MannequinKind kind() const { return kind_; }
  std::span<const Joint> joints() const { return joints_; }

  // `t_s` >= 0; below, the A-pose.
  Posture posture(double t_s) const;
  Pose at(double t_s) const;

 private:
  Motion() = default;

  using Function = Posture (*)(double t_s);
  std::string name_;
  MannequinKind kind_ = MannequinKind::woman;
  double period_s_ = 1, lead_in_s_ = 1;
  Legs legs_ = Legs::planted;
  std::array<double, 3> height_{};  // m: mean, cosine and sine of twice per period
  bool level_ = false;              // the pelvis goes by height_, not by the soles
  void level_pelvis();
  double level_height(double t_s) const;
  double share_at(double t_s) const;  // weight of the motion against the A-pose
  void blend(Posture& p, double share) const;
  Function motion_ = nullptr;
  std::vector<Joint> joints_;
};

}  // namespace toile::internal
