// tests/contact/ccd_queries.hpp: motions to ask continuous collision detection about, like those of cloth and worse.
//
// Lattice kinds have coordinates that are whole multiples of 2^-20 m, so that what is meant to be parallel, coplanar or
// just touching is so to the last bit.  All go through a random map of small whole numbers and a motion in common.
#pragma once
#include "contact/exact_ccd.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace toile::internal::ccd_test {

using exact::Features;
using exact::Motion;
using exact::Random;

enum class Kind {
  cloth,            // features of 1 mm to 2 cm, 1e-6 to 1e-2 m apart, moving by up to 5 cm, together by metres
  aimed,            // the same, but two points of them meet, or miss each other by 1e-9 m and more
  far,              // aimed, 1 km from the origin
  close,            // starting 1e-12 to 1e-7 m apart
  ulp,              // starting a few units in the last place apart, at 1 m and at 1 km
  nearly_parallel,  // edges or a needle's sides at 1e-12 to 1e-2 rad, aimed, 1e-11 to 1e-4 m apart
  tiny_lattice,     // coordinates -2 to 2: everything at once
  parallel,         // parallel edges, or a vertex that moves parallel to the face
  collinear,        // all on one line
  without_size,     // edges without length, triangles without area or of one point
  coplanar,         // all in one plane throughout
  touch_at_end,     // touching at t = 1 and, now and then, only at t = 0
  through_border,   // the vertex meets an edge or a corner, the edge another's end
  grazing,          // a double root, or one lattice step beside it
};
inline constexpr std::size_t kind_count = 14;
inline constexpr std::array<const char*, kind_count> kind_name = {
    "cloth",    "aimed",     "far",          "close",    "ulp",          "nearly_parallel", "tiny_lattice",
    "parallel", "collinear", "without_size", "coplanar", "touch_at_end", "through_border",  "grazing"};

inline constexpr double lattice_m = 0x1p-20;

inline double log_real(Random& random, double low, double high) {
  return std::exp(random.real(std::log(low), std::log(high)));
}
inline Vec3 direction(Random& random) {
  for (;;) {
    const Vec3 v = random.point(-1, 1);
    if (v.squaredNorm() > 0.01 && v.squaredNorm() <= 1) return v.normalized();
  }
}

// Weights with which the features' points meet: sum to 1 on each feature; a bit outside now and then.
inline std::array<double, 4> meeting_weights(Random& random, Features features) {
  const bool outside = random.below(8) == 0;
  const auto part = [&] { return outside ? random.real(-0.01, 1.01) : random.unit(); };
  double s = part(), t = part();
  if (features == Features::edge_edge) return {1 - s, s, -(1 - t), -t};
  if (s + t > 1 && !outside) s = 1 - s, t = 1 - t;
  return {1, -(1 - s - t), -s, -t};
}
inline Vec3 combined(const std::array<double, 4>& weight, const std::array<Vec3, 4>& x) {
  return weight[0] * x[0] + weight[1] * x[1] + weight[2] * x[2] + weight[3] * x[3];
}
inline bool of_first(Features features, std::size_t i) { return i == 0 || (i == 1 && features == Features::edge_edge); }

// Moves the first feature so that its point of the weights is `gap` from the other's.
inline void place_first(Features features, const std::array<double, 4>& weight, const Vec3& gap,
                        std::array<Vec3, 4>& x) {
  const Vec3 shift = gap - combined(weight, x);
  for (std::size_t i = 0; i < 4; ++i)
    if (of_first(features, i)) x[i] += shift;
}

// Features of about `size_m` around 0; `thin` is the sine of the angle between edges, or of the triangle's corner.
inline std::array<Vec3, 4> small_features(Random& random, Features features, double thin) {
  const Vec3 along = direction(random);
  const auto side = [&] {
    const double size = log_real(random, 1e-3, 2e-2);
    if (thin == 1) return Vec3(size * direction(random));
    const double sign = random.below(2) == 0 ? 1 : -1;
    return Vec3(sign * size * (along + thin * direction(random)));
  };
  const Vec3 p = side(), q = side(), r = side();
  if (features == Features::vertex_face) return {Vec3::Zero(), p, p + q, thin == 1 ? Vec3(p + r) : Vec3(p + q + r)};
  return {Vec3(-0.5 * p), Vec3(0.5 * p), Vec3(-0.5 * q), Vec3(0.5 * q)};
}

// A common normal of the features, for gaps.
inline Vec3 normal_of(Random& random, Features features, const std::array<Vec3, 4>& x) {
  const Vec3 n =
      features == Features::vertex_face ? (x[2] - x[1]).cross(x[3] - x[1]) : (x[1] - x[0]).cross(x[3] - x[2]);
  const double length = n.norm();
  return length > 0 ? Vec3(n / length) : direction(random);
}

inline Motion real_motion(Random& random, Features features, Kind kind) {
  Motion motion(features);
  const bool thin = kind == Kind::nearly_parallel;
  motion.start = small_features(random, features, thin ? log_real(random, 1e-12, 1e-2) : 1.0);
  const std::array<double, 4> weight = meeting_weights(random, features);
  const Vec3 origin = kind == Kind::far || (kind == Kind::ulp && random.below(2) == 0) ? Vec3(1000 * direction(random))
                                                                                       : random.point(-1, 1);
  double gap = log_real(random, 1e-6, 1e-2);
  if (thin) gap = log_real(random, 1e-11, 1e-4);
  if (kind == Kind::close) gap = log_real(random, 1e-12, 1e-7);
  if (kind == Kind::ulp) gap = origin.norm() * 0x1p-52 * static_cast<double>(random.between(1, 8));
  const bool along_normal = kind != Kind::cloth && random.below(4) != 0;
  const Vec3 away = along_normal ? normal_of(random, features, motion.start) : direction(random);
  place_first(features, weight, gap * away, motion.start);

  const double reach = log_real(random, kind == Kind::cloth || kind == Kind::far ? 1e-4 : 0.1 * gap, 5e-2);
  const bool rigid = random.below(4) == 0;  // both features without turning
  const std::array<Vec3, 2> rigid_move = {random.point(-reach, reach), random.point(-reach, reach)};
  for (std::size_t i = 0; i < 4; ++i)
    motion.end[i] = motion.start[i] + (rigid ? rigid_move[of_first(features, i) ? 0 : 1] : random.point(-reach, reach));
  if (kind != Kind::cloth) {
    // Meet at the time `when`, or miss by a little: the points of the weights are `gap` apart at 0 and `beside` then.
    const double when = random.real(0.05, 1.05);
    const double beside = random.below(2) == 0 ? 0 : log_real(random, 1e-9, 1e-3) * (random.below(2) == 0 ? 1 : -1);
    const Vec3 target = combined(weight, motion.start) * (1 - 1 / when) + beside / when * away;
    place_first(features, weight, target, motion.end);
  }
  const double together = random.below(2) == 0 ? 0 : log_real(random, 1e-3, 3);
  const Vec3 common = origin + together * direction(random);
  for (std::size_t i = 0; i < 4; ++i) {
    motion.start[i] += origin;
    motion.end[i] += common;
  }
  return motion;
}

// The lattice kinds: what they look like before the map.
inline Motion lattice_figure(Random& random, Features features, Kind kind) {
  Motion motion(features);
  std::array<Vec3, 4>&x = motion.start, &y = motion.end;
  const bool edges = features == Features::edge_edge;
  const std::int64_t size = std::int64_t{1} << random.between(2, 14);
  const auto point = [&](std::int64_t reach) { return random.lattice_point(-reach, reach); };
  const auto whole = [&](std::int64_t reach) { return static_cast<double>(random.between(-reach, reach)); };
  for (std::size_t i = 0; i < 4; ++i) x[i] = point(size), y[i] = x[i] + point(size);
  switch (kind) {
    case Kind::tiny_lattice:
      for (std::size_t i = 0; i < 4; ++i) x[i] = point(2), y[i] = point(2);
      break;
    case Kind::parallel: {
      const Vec3 along = point(size / 4 + 1), move = point(size);
      Vec3 other = point(size);
      if (edges) {
        x[1] = x[0] + whole(4) * along;
        x[3] = x[2] + whole(4) * along;
        if (random.below(2) == 0) other = move + 2 * (x[0] + whole(6) * along - x[2]);  // on one line at t = 1/2
      } else {
        x[0] = x[1] + whole(3) * (x[2] - x[1]) + whole(3) * (x[3] - x[1]) + point(random.below(3));
      }
      for (std::size_t i = 0; i < 4; ++i) y[i] = x[i] + (of_first(features, i) ? move : other);
      if (random.below(3) == 0) y[3] += along;
      break;
    }
    case Kind::collinear: {
      for (std::size_t i = 0; i < 4; ++i) x[i] = Vec3(whole(size), 0, 0), y[i] = Vec3(whole(size), 0, 0);
      if (random.below(2) == 0) {  // the line itself turns
        for (std::size_t i = 0; i < 4; ++i) y[i] = Vec3(y[i].x(), y[i].x() * 2, 0);
      }
      break;
    }
    case Kind::without_size: {
      const Vec3 move = point(size);
      x[3] = x[2];
      y[3] = y[2];
      if (random.below(2) == 0) x[1] = edges ? x[0] : x[2], y[1] = edges ? y[0] : y[2];
      if (!edges && random.below(2) == 0) {  // on a line, but three points
        x[3] = x[1] + whole(3) * (x[2] - x[1]);
        y[3] = x[3] + move;
        y[1] = x[1] + move;
        y[2] = x[2] + move;
      }
      if (random.below(2) == 0) {  // meet at t = 1/2, if they are points
        y[0] = x[2] + y[2] - x[0];
        if (edges) y[1] = x[2] + y[2] - x[1] + point(1);
      }
      break;
    }
    case Kind::coplanar:
      for (std::size_t i = 0; i < 4; ++i) x[i].z() = 0, y[i].z() = 0;
      if (random.below(2) == 0)  // the plane itself turns
        for (std::size_t i = 0; i < 4; ++i) y[i].z() = y[i].y();
      break;
    case Kind::touch_at_end: {
      for (Vec3& p : y) p *= 4;
      std::array<Vec3, 4>& at = random.below(4) == 0 ? x : y;
      for (Vec3& p : at) p *= 4;
      const double s = static_cast<double>(random.between(0, 4)) / 4, t = static_cast<double>(random.between(0, 4)) / 4;
      if (edges) {
        place_first(features, {1 - s, s, -(1 - t), -t}, Vec3::Zero(), at);
      } else {
        place_first(features, {1, -(1 - std::min(s + t, 1.0)), -s, -(std::min(s + t, 1.0) - s)}, Vec3::Zero(), at);
      }
      if (random.below(3) == 0)
        for (std::size_t i = 0; i < 4; ++i)
          if (of_first(features, i)) at[i] += point(1);
      break;
    }
    case Kind::through_border: {
      // At t = 1/2 the vertex is on the edge x[1] x[2], or the end x[0] on the edge x[2] x[3].
      const std::size_t a = edges ? 2 : 1, b = edges ? 3 : 2;
      const double s = static_cast<double>(random.between(0, 4)) / 4;
      for (Vec3& p : x) p *= 4;
      for (Vec3& p : y) p *= 4;
      y[0] = (1 - s) * (x[a] + y[a]) + s * (x[b] + y[b]) - x[0];
      if (random.below(3) == 0) y[0] += point(1);
      break;
    }
    case Kind::grazing: {
      // Edges: one along the x axis, the other turns about it and passes it.  Face: a plane that tilts about the x
      // axis while the vertex crosses that axis.  Both ways det = beside - h k (2 t - 1)^2.
      const double h = whole(size), k = whole(size), beside = whole(2), g = whole(size);
      if (edges) {
        x = {Vec3(-whole(size), 0, 0), Vec3(whole(size), 0, 0), Vec3(whole(8), beside, -h), Vec3(whole(8), beside, -h)};
        y = x;
        y[2].z() = y[3].z() = h;
        x[2] -= Vec3(0, -k, g);
        y[2] -= Vec3(0, k, g);
        x[3] += Vec3(0, -k, g);
        y[3] += Vec3(0, k, g);
      } else {
        const std::int64_t w = size;
        for (std::size_t i = 1; i < 4; ++i) {
          const double across = static_cast<double>(random.between(-w, w)), along = whole(size);
          x[i] = Vec3(along, across, -across * std::min(h, 64.0));
          y[i] = Vec3(along, across, across * std::min(h, 64.0));
        }
        const double along = whole(size / 4 + 1);
        x[0] = Vec3(along, -k, beside);
        y[0] = Vec3(along, k, beside);
      }
      break;
    }
    default:
      break;
  }
  return motion;
}

inline Motion lattice_motion(Random& random, Features features, Kind kind) {
  Motion motion = lattice_figure(random, features, kind);
  std::array<Vec3, 3> map;
  do {
    for (Vec3& column : map) column = random.lattice_point(-2, 2);
  } while (map[0].dot(map[1].cross(map[2])) == 0);
  const std::int64_t range = std::int64_t{1} << (random.below(4) == 0 ? 30 : 20);  // 1 km or 1 m
  const Vec3 origin = random.below(2) == 0 ? Vec3::Zero() : random.lattice_point(-range, range);
  const Vec3 common = random.below(2) == 0 ? Vec3::Zero() : random.lattice_point(-(1 << 21), 1 << 21);
  for (std::array<Vec3, 4>* const points : {&motion.start, &motion.end})
    for (Vec3& p : *points) p = lattice_m * (p.x() * map[0] + p.y() * map[1] + p.z() * map[2] + origin);
  for (Vec3& p : motion.end) p += lattice_m * common;
  return motion;
}

inline Motion motion_of(Random& random, Features features, Kind kind) {
  Motion motion =
      kind < Kind::tiny_lattice ? real_motion(random, features, kind) : lattice_motion(random, features, kind);
  // Every order of the points that means the same.
  const auto exchange = [&](std::size_t i, std::size_t j) {
    std::swap(motion.start[i], motion.start[j]);
    std::swap(motion.end[i], motion.end[j]);
  };
  if (features == Features::edge_edge) {
    if (random.below(2) == 0) exchange(0, 1);
    if (random.below(2) == 0) exchange(2, 3);
    if (random.below(2) == 0) exchange(0, 2), exchange(1, 3);
  } else {
    exchange(1, static_cast<std::size_t>(random.between(1, 3)));
    exchange(2, static_cast<std::size_t>(random.between(2, 3)));
  }
  return motion;
}

}  // namespace toile::internal::ccd_test
