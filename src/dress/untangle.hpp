// dress/untangle.hpp: relaxes cloth that passes through itself or a body until it does not.            docs/untangle.md (L4)
//
//   repeat   crossings of the cloth with itself and with the body                            contact/crossing_finder, exact
//            contours, and the parts that they cut off                                                     contact/intersection_contours
//            every contour is pushed over the smaller part that it cuts off; one that cuts no part off is shortened;
//            cloth inside the body is pushed out                                           contact/contour_motion
//            one implicit step without gravity and from rest, the cloth as given being its rest shape
//            contours that the step made elsewhere are undone
//
// Contact is off around the contours and on everywhere else (ContactRows::set_thickness_scale).  A trial may pass through
// states with more crossings, as a curve that moves over a mesh does; the result is always the state with the fewest:
// never more than at the start.
//
// The length unit does not matter: the cloth is scaled, by a power of two, so that its mean edge is about a centimetre.
//
// Easily got wrong: no crossings does not mean outside.  A sleeve that lies wholly inside an arm crosses nothing;
// `inside` counts it.
#pragma once
#include "contact/intersection_contours.hpp"

#include <functional>
#include <span>
#include <vector>

namespace toile::internal {

struct UntangleOptions {
  int most_iterations = 0;  // trials; 0: 600, and fewer for more than 1,170 particles
  int patience = 20;        // trials without progress until contours are pushed another way
  int most_in_vain = 0;     // trials since the fewest crossings until it gives up; 0: never
  std::vector<Index> held;  // particles that stay where they are, to the bit
};

// A remaining intersection.
struct Tangle {
  bool closed = false, with_body = false;
  double length = 0;                            // in the unit of the input
  Vec3 position = Vec3::Zero();                 // mean of its crossings
  std::vector<std::array<Index, 2>> triangles;  // pairs; of a body's the second, counted from 0 within the body
};

struct UntangleReport {
  bool resolved = false;
  int cloth_crossings_before = 0, body_crossings_before = 0;
  int cloth_crossings = 0, body_crossings = 0;
  int inside = 0;      // particles of the cloth inside the body, in the end
  int iterations = 0;  // trials
  double largest_move = 0, mean_move = 0;
  double edge_change_p99 = 0,
         edge_change_max = 0;  // | length / length at the start - 1 | of the sides of all triangles
  std::vector<Tangle> before, left;
};

// Moves `x`.  A body must be closed (mesh/check.hpp) or absent; it is not moved.  Throws InputError for a mesh that
// check_triangles refuses.  `keep_going` is asked before every trial with the crossings so far; false ends.
UntangleReport untangle(std::span<const Triangle> cloth, Vec3s& x, std::span<const Triangle> body,
                        std::span<const Vec3> body_x, const UntangleOptions& options = {},
                        const std::function<bool(int iteration, int crossings)>& keep_going = {});

}  // namespace toile::internal
