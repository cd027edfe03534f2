// dress/dressing_body.hpp: the body during a sewing: thinned, so that little obstructs the seams, and grown back afterwards.
//
// Arms that go through the garment keep their length: sleeves and their cuffs, often narrower than the hand, close around them.  Others are
// drawn in: panels close around the trunk as if it had none, and then the arms come out above the garment.  The body grows as a moving
// body, with all contact on and without friction, so the cloth that it pushes aside slides into place.  Solids do not change.  A body that is no person has no arms (body/arms.hpp) and is not thinned: a growing
// cylinder would squeeze a tube that is too small off its end, and the verdict would be about cloth in the air.
#pragma once
#include "body/arms.hpp"
#include "body/thin_body.hpp"

#include <array>
#include <span>

namespace toile::internal {

class DressingBody {
 public:
  // The person's vertices and triangles come first; the others are solids.
  DressingBody(std::span<const Vec3> standing, std::span<const Triangle> triangles, std::size_t person_vertices,
               std::size_t person_triangles, std::array<Arm, 2> arms);

  // 0.3 s thin, in which a waist comes to its height, and falls_s more; arms, 0.8 s; girth, 1 s; then 0.2 s at its full shape.
  double growth_s() const { return 1.8 + pose_.falls_s; }
  static constexpr double falling_s = 0.8, longest_growth_s = 1.8 + falling_s;

  // Its pose while a garment is sewn.
  struct Pose {
    // [left arm, right arm]
    std::array<double, 2> lift{0, 0};   // 0: as it stands, 1: level, and out of the way of sides and skirts
    std::array<double, 2> reach{1, 1};  // share of its length
    double falls_s = 0;                 // the time for garments that hang from the waist to fall before the body grows
    template <class Archive>
    void remember(Archive& archive) {
      archive(lift[0], lift[1], reach[0], reach[1], falls_s);
    }
  };
  void set_pose(const Pose& pose) { pose_ = pose; }
  // `covered` arms go through the garment: they have this lift, and their length.  The others are level, and drawn in.
  Pose pose_within(double lift, const std::array<bool, 2>& covered) const;
  struct ArmAxis {
    Vec3 root{0, 0, 0}, direction{0, 0, 0};
  };
  // [left, right] in the lifted pose.
  std::array<ArmAxis, 2> arm_axes() const;

  // The full body with its arms lifted, around which panels are placed.
  void lifted(std::span<Vec3> x) const;
  // The body at t_s of its growth: thin at 0; at growth_s the standing body, to the bit.
  void at(double t_s, std::span<Vec3> x) const;
  double height_m() const { return height_m_; }

 private:
  double lift_rad(std::size_t arm, double share) const;
  void pose_arm(std::size_t arm, double lift, double reach, std::span<Vec3> x) const;

  ThinBody thin_;
  std::array<Arm, 2> arms_;
  Pose pose_;
  std::size_t person_vertices_ = 0;
  double height_m_ = 0;
  Vec3s standing_;
};

}  // namespace toile::internal
