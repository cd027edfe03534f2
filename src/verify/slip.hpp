// verify/slip.hpp: slip of a garment relative to a moving body.                                             docs/theory/verify.md#slip
//
// The frame before the body first moves is the beginning.  There a vertex x of the cloth is given the nearest point b of the body, a triangle
// and weights, which is followed.  With the triangle's frame F (an edge, the normal, and their cross product), at the beginning and now,
//
//   s = F_0 (F^T (x - b)) - (x_0 - b_0)          m, in the axes of the beginning
//
// is the vertex's displacement relative to the body: 0 when both move rigidly together, d when the cloth alone is shifted by d.
//
//   loop        a hem loop that the body goes through: its middle and both points of its axis (the normal of its area, downwards; outwards if it
//               lies on its side) as far from there as it is wide, 10 cm at most, are within the body (an open front is none).  Its drop is the mean
//               of s along the axis over its vertices within slip_reach_m of the body; only if these are at least half, as a free hem shows nothing
//   waist       the cloth that lies on a person's waist, within half_band_m of its height: its drop is the mean of -s_y
//   shoulders   the cloth that lies on a person above the roots of the arms, not on an arm, nor on neck or head, where the body faces up:
//               its slip is the mean of |s| along the surface, of the side where it is larger
//
// A connected component with a loop is a garment.  On a person it is held by its shoulders, if any of it lies on them; else by its highest loop; and
// if that stands off, as in a paper-bag waist, by its highest cloth that lies on the body: down to hold_band_m (5 cm) below the highest
// such vertex, arms excluded.
// "Lies on": within slip_lies_m.  Positive drops are downwards.  The worst is over all frames after the beginning.
//
// Easily got wrong: a nearest point that is found anew in every frame slides with the cloth, and shows no slip.
#pragma once
#include "core/types.hpp"
#include "mesh/cloth_mesh.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

constexpr double slip_reach_m = 0.05;  // as for jitter: cloth farther away is not carried by the body
constexpr double slip_lies_m = 0.01;   // four times the offset at which cloth rests: two layers, and a fold

struct Slip {
  int vertices = 0;                // 0: no such cloth
  double last_m = 0, worst_m = 0;  // in the last frame; the largest so far
  int worst_frame = -1;            // counted from the first frame added
};

struct LoopSlip {
  std::string name;                  // the panels along it
  double height_m = 0, girth_m = 0;  // at the beginning; girth 0: no loop, but the highest cloth on the body
  bool holds = false;                // it holds its garment
  Slip drop;
};

struct SlipStatistics {
  int first_frame = -1;         // the beginning; -1: the body never moved, no slip is known
  std::vector<LoopSlip> loops;  // from the highest
  Slip waist, shoulders;
};

class SlipMeter {
 public:
  // Indices must be in range; `body` may be empty.
  SlipMeter(const ClothMesh& cloth, std::vector<Triangle> body);

  // Finite positions, as many each time.
  void add(std::span<const Vec3> x, std::span<const Vec3> body_x);
  // Skips a frame that cannot be measured.
  void skip() { ++frames_; }

  const SlipStatistics& statistics() const { return statistics_; }

 private:
  struct Bound {                      // a vertex of the cloth, and the body's point that it is followed by
    Index vertex = 0, triangle = -1;  // -1: none within reach
    double distance_m = 0;
    Vec3 weights{0, 0, 0}, start{0, 0, 0};  // x_0 - b_0
    Mat3 frame{Mat3::Identity()};           // F_0
  };
  struct Followed {
    std::vector<Bound> points;
    Vec3 axis{0, 0, 0};  // of the drop; zero: the length of the slip along the surface
  };
  struct Person;

  void begin(std::span<const Vec3> x, std::span<const Vec3> body_x);
  std::vector<Bound> bind(std::span<const Vec3> x, std::span<const Vec3> body_x) const;
  void follow_loops(std::span<const Vec3> x, std::span<const Vec3> body_x, const std::vector<Bound>& bound,
                    const std::vector<char>& on_shoulders, const std::vector<char>& on_arms, bool person);
  Mat3 frame_of(Index triangle, std::span<const Vec3> body_x) const;
  Vec3 moved(const Bound& bound, std::span<const Vec3> x, std::span<const Vec3> body_x) const;
  double mean(const Followed& followed, std::span<const Vec3> x, std::span<const Vec3> body_x) const;
  void measure(std::span<const Vec3> x, std::span<const Vec3> body_x);

  std::vector<Triangle> cloth_, body_;
  std::vector<Index> panel_;
  std::vector<std::string> panel_names_;
  int frames_ = 0;
  Vec3s last_x_, last_body_x_;  // until the body moves
  SlipStatistics statistics_;
  std::vector<Followed> loops_;  // as those of statistics_
  Followed waist_;
  std::array<Followed, 2> shoulders_;
};

}  // namespace toile::internal
