#include "verify/pinch.hpp"

#include "verify/box_tree.hpp"
#include "verify/interior.hpp"
#include "verify/nearest_point.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <limits>

namespace toile::internal {
namespace {

constexpr double opposite = -0.5;  // n . n'
constexpr double just_outside_m = 1e-5;

Vec3 unit_normal(const Triangle& t, std::span<const Vec3> x) {
  const Vec3 n = (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
  const double length = n.norm();
  return length > 0 ? Vec3(n / length) : Vec3::Zero();
}

class Pinches {
 public:
  Pinches(std::span<const Triangle> body, std::span<const Vec3> x)
      : body_(body), x_(x), interior_(body, x), tree_(body, x) {
    for (const Triangle& t : body) normals_.push_back(unit_normal(t, x));
  }

  bool has(const Crossing& crossing, std::span<const Triangle> cloth, std::span<const Vec3> x) const {
    if (lies_in_one(crossing.position,
                    crossing.edge_of_body ? edge_normal(crossing.edge) : normals_[at(crossing.triangle)]))
      return true;
    const auto begins_in_one = [&](Index particle) {
      return interior_.depth(x[at(particle)]) > 1 || nearest_lies_in_one(x[at(particle)]);
    };
    if (!crossing.edge_of_body) return std::any_of(crossing.edge.begin(), crossing.edge.end(), begins_in_one);
    const Triangle& corners = cloth[at(crossing.triangle)];
    return std::any_of(corners.begin(), corners.end(), begins_in_one);
  }

 private:
  // Whether a point p of the surface, with the normal `out`, lies in a pinch.
  bool lies_in_one(const Vec3& p, const Vec3& out) const {
    if (interior_.depth(p + just_outside_m * out) > 0) return true;
    const auto distance2 = [&](Index t) {
      const Triangle& c = body_[at(t)];
      if (normals_[at(t)].dot(out) >= opposite || normals_[at(t)].dot(p - x_[at(c[0])]) < 0)
        return std::numeric_limits<double>::infinity();
      return squared_distance_to_triangle(p, x_[at(c[0])], x_[at(c[1])], x_[at(c[2])]);
    };
    return tree_.nearest(p, {-1, pinch_m * pinch_m}, distance2).triangle >= 0;
  }

  bool nearest_lies_in_one(const Vec3& p) const {
    const Index t = tree_
                        .nearest(p, {},
                                 [&](Index k) {
                                   const Triangle& c = body_[at(k)];
                                   return squared_distance_to_triangle(p, x_[at(c[0])], x_[at(c[1])], x_[at(c[2])]);
                                 })
                        .triangle;
    const Triangle& c = body_[at(t)];
    const Vec3 w = nearest_weights(p, x_[at(c[0])], x_[at(c[1])], x_[at(c[2])]);
    return lies_in_one(w[0] * x_[at(c[0])] + w[1] * x_[at(c[1])] + w[2] * x_[at(c[2])], normals_[at(t)]);
  }

  // The sum of the normals of the faces at an edge.
  Vec3 edge_normal(const std::array<Index, 2>& edge) const {
    Vec3 sum = Vec3::Zero();
    ExactBox box;
    for (const Index i : edge) box.add(x_[at(i)]);
    tree_.visit_meeting(box, [&](Index t) {
      const Triangle& c = body_[at(t)];
      if (std::find(c.begin(), c.end(), edge[0]) != c.end() && std::find(c.begin(), c.end(), edge[1]) != c.end())
        sum += normals_[at(t)];
    });
    const double length = sum.norm();
    return length > 0 ? Vec3(sum / length) : Vec3::Zero();
  }

  std::span<const Triangle> body_;
  std::span<const Vec3> x_;
  Interior interior_;
  BoxTree tree_;
  Vec3s normals_;
};

}  // namespace

std::vector<Crossing> outside_pinches(std::span<const Crossing> crossings, std::span<const Triangle> cloth,
                                      std::span<const Vec3> x, std::span<const Triangle> body,
                                      std::span<const Vec3> body_x) {
  std::vector<Crossing> outside;
  if (crossings.empty()) return outside;
  const Pinches pinches(body, body_x);
  std::copy_if(crossings.begin(), crossings.end(), std::back_inserter(outside),
               [&](const Crossing& crossing) { return !pinches.has(crossing, cloth, x); });
  return outside;
}

}  // namespace toile::internal
