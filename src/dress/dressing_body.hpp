// dress/dressing_body.hpp: the person around whom a garment is sewn: thin, so that little is in the way of seams, and how she grows back.
//
// Her arms are drawn in as far as no sleeve needs them: panels close around the trunk as if she had none, and then her arms come out through
// the armholes, or above what has none.  The body grows as a moving body, with all contact on and without friction, so what it pushes aside slides to where it belongs.  Solids stand
// as they are.  What is no person has no arms (body/arms.hpp), and is not made thin: a cylinder that grows squeezes a tube that is too
// small off its end, and the verdict would be about cloth in the air.
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

  // 0.3 s thin, in which a waist comes to its height, and longer for what falls first; arms, 0.8 s; girth, 1 s; then 0.2 s as it stands.
  double growth_s() const { return 1.8 + pose_.falls_s; }
  static constexpr double falling_s = 0.8, longest_growth_s = 1.8 + falling_s;

  // How it is while a garment is sewn.
  struct Pose {
    // Of the left arm and the right one.
    std::array<double, 2> lift{0, 0};   // 0: as it stands, 1: level, and out of the way of sides and skirts
    std::array<double, 2> reach{1, 1};  // share of its length
    double falls_s = 0;                 // so long what hangs from the waist falls before anything grows
    template <class Archive>
    void remember(Archive& archive) {
      archive(lift[0], lift[1], reach[0], reach[1], falls_s);
    }
  };
  void set_pose(const Pose& pose) { pose_ = pose; }
  // Arms that go through the garment are lifted so, and reach nearly to the hems of their sleeves (how far along the arm they end, m; 0: no sleeve); the
  // others are level, and drawn in.
  Pose pose_within(double lift, const std::array<bool, 2>& covered, const std::array<double, 2>& sleeve_m) const;
  struct ArmAxis {
    Vec3 root{0, 0, 0}, direction{0, 0, 0};
  };
  // Left and right, as they are lifted.
  std::array<ArmAxis, 2> arm_axes() const;

  // Where it stands, with its arms lifted: around it panels are placed.
  void lifted(std::span<Vec3> x) const;
  // At t_s of its growth; 0 is thin, growth_s is how it stands, to the bit.
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
