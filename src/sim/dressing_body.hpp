// sim/dressing_body.hpp: the person around whom a garment is sewn: thin, so that little is in the way of seams, and how she grows back.
//
// The body grows as a moving body, with all contact on and without friction, so what it pushes aside slides to where it belongs.  Solids stand
// as they are.  What is no person has no arms (body/arms.hpp), and is not made thin: a cylinder that grows squeezes a tube that is too
// small off its end, and the verdict would be about cloth in the air.
#pragma once
#include "body/arms.hpp"
#include "body/thin_body.hpp"

#include <array>
#include <span>

namespace toile {

class DressingBody {
 public:
  // The person's vertices and triangles come first; the others are solids.
  DressingBody(std::span<const Vec3> standing, std::span<const Triangle> triangles, std::size_t person_vertices,
               std::size_t person_triangles, std::array<Arm, 2> arms);

  // 0.3 s thin, in which a waist comes to its height; 1 s; then 0.2 s as it stands.
  static constexpr double growth_s = 1.5;

  // Until it grows, its arms are lifted: 0: they are as it stands, 1: level, and out of the way of sides and skirts.
  void lift_arms(double share);
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
  void lift(double share, std::span<Vec3> x) const;

  ThinBody thin_;
  std::array<Arm, 2> arms_;
  std::array<double, 2> lift_rad_{0, 0};  // in the frontal plane, about the arm's root
  std::size_t person_vertices_ = 0;
  double height_m_ = 0;
  Vec3s standing_;
};

}  // namespace toile
