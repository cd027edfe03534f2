// tests/contact/ccd_count.hpp: additive CCD against the truth, counted.
#pragma once
#include "contact/ccd.hpp"
#include "contact/ccd_queries.hpp"
#include "contact/distance.hpp"
#include "contact/touch_oracle.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

namespace toile::internal::ccd_test {

using exact::Touch;
using exact::touch_of;

inline double distance_m(Features features, const std::array<Vec3, 4>& x) {
  return std::sqrt(features == Features::vertex_face ? closest_vertex_triangle(x[0], x[1], x[2], x[3]).distance2
                                                     : closest_edge_edge(x[0], x[1], x[2], x[3]).distance2);
}

// As the filter of a step asks: displacements are rounded differences, xi = min(0.1 r, 0.5 d_0) with r = 1 mm.
inline double impact_of(const Motion& motion) {
  std::array<Vec3, 4> u;
  for (std::size_t k = 0; k < 4; ++k) u[k] = motion.end[k] - motion.start[k];
  const double separation = std::min(1e-4, 0.5 * distance_m(motion.features, motion.start));
  return motion.features == Features::vertex_face ? vertex_face_impact(motion.start, u, separation)
                                                  : edge_edge_impact(motion.start, u, separation);
}

struct Count {
  std::int64_t queries = 0, touches = 0, false_negatives = 0, false_positives = 0;
  std::int64_t late = 0;     // impacts at t > 0 though the way to t touches already
  std::int64_t exactly = 0;  // truths that needed whole numbers

  void add(const Motion& motion, const Touch& truth) {
    const double time = impact_of(motion);
    ++queries;
    touches += truth.touches;
    exactly += truth.exactly;
    false_negatives += truth.touches && time > 1;
    false_positives += !truth.touches && time <= 1;
    if (truth.touches && time > 0 && time <= 1) {
      Motion way = motion;
      for (std::size_t k = 0; k < 4; ++k) way.end[k] = motion.start[k] + time * (motion.end[k] - motion.start[k]);
      late += touch_of(way).touches;
    }
  }
  void add(const Count& other) {
    queries += other.queries;
    touches += other.touches;
    false_negatives += other.false_negatives;
    false_positives += other.false_positives;
    late += other.late;
    exactly += other.exactly;
  }
  std::string text(const char* name) const {
    char line[200];
    const double free = static_cast<double>(std::max<std::int64_t>(queries - touches, 1));
    std::snprintf(line, sizeof line,
                  "%-28s %10lld queries %9lld touch %6lld missed %4lld late %9lld false (%.2f %%) %9lld exactly", name,
                  static_cast<long long>(queries), static_cast<long long>(touches),
                  static_cast<long long>(false_negatives), static_cast<long long>(late),
                  static_cast<long long>(false_positives), 100 * static_cast<double>(false_positives) / free,
                  static_cast<long long>(exactly));
    return line;
  }
};

}  // namespace toile::internal::ccd_test
