// verify/slip.cpp: see the header.
#include "verify/slip.hpp"

#include "body/arms.hpp"
#include "body/measure.hpp"
#include "core/parallel.hpp"
#include "mesh/surface_parts.hpp"
#include "verify/box_tree.hpp"
#include "verify/hem_loops.hpp"
#include "verify/interior.hpp"
#include "verify/nearest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace toile::internal {
namespace {

constexpr double half_band_m = 0.025;  // two rows of triangles of 2 cm at least
constexpr double hold_band_m = 0.05;   // twice that
constexpr double least_within = 0.5;   // of a loop's vertices within reach
constexpr double faces_up = 0.5;    // cosine: slopes of up to 60 degrees carry cloth; the sides of a neck are steeper
constexpr double neck = 0.87;       // of the height
constexpr double level_axis = 0.5;  // cosine against the vertical below which a loop lies on its side
constexpr double least_area =
    0.25;  // of the area of a circle as long as the loop: waists have 0.9, a frill half as long again 0.4; open fronts 0.15
constexpr double longest_way_m = 0.1;  // a person is not wider
constexpr double two_pi = 6.283185307179586477;
constexpr std::size_t named_panels = 3;

std::size_t z(Index i) { return static_cast<std::size_t>(i); }

struct Curve {
  Vec3 middle{0, 0, 0}, area{0, 0, 0};  // area: half the sum of cross products, m^2
  double length_m = 0;
};

Curve curve_of(const std::vector<Index>& loop, std::span<const Vec3> x) {
  Curve curve;
  for (const Index i : loop) curve.middle += x[z(i)] / static_cast<double>(loop.size());
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 a = x[z(loop[k])] - curve.middle, b = x[z(loop[(k + 1) % loop.size()])] - curve.middle;
    curve.area += 0.5 * a.cross(b);
    curve.length_m += (b - a).norm();
  }
  return curve;
}

// The direction in which a loop slides off; `middle`: its garment's.
Vec3 axis_of(const Curve& curve, const Vec3& middle) {
  const Vec3 normal = curve.area.normalized();
  if (std::abs(normal.y()) < level_axis) return normal.dot(curve.middle - middle) < 0 ? Vec3(-normal) : normal;
  return normal.y() > 0 ? Vec3(-normal) : normal;
}

// A bulge of the body in a hole of the cloth does not reach as far out of it as the hole is wide.
bool body_goes_through(const Curve& curve, const Vec3& axis, const Interior& body) {
  const double way_m = std::min(curve.length_m / two_pi, longest_way_m);
  return body.depth(curve.middle) != 0 && body.depth(curve.middle + way_m * axis) != 0 &&
         body.depth(curve.middle - way_m * axis) != 0;
}

void note(Slip& slip, double moved_m, int frame) {
  slip.last_m = moved_m;
  if (slip.worst_frame >= 0 && moved_m <= slip.worst_m) return;
  slip.worst_m = moved_m;
  slip.worst_frame = frame;
}

}  // namespace

// The parts of a person that a body consists of.
struct SlipMeter::Person {
  double waist_m = 0, roots_m = 0, neck_m = 0, middle_m = 0;  // heights; the middle along x
  std::vector<char> of_arm;                                   // [vertex]

  static std::optional<Person> find(std::span<const Triangle> body, std::span<const Vec3> body_x) {
    const Arms arms = find_arms(body_x, body);
    if (!arms) return std::nullopt;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : body_x) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    Person person;
    person.waist_m = waist_height_m(body_x, body);
    person.roots_m = 0.5 * ((*arms)[0].root.y() + (*arms)[1].root.y());
    person.middle_m = 0.5 * ((*arms)[0].root.x() + (*arms)[1].root.x());
    person.neck_m = low + neck * (high - low);
    for (std::size_t i = 0; i < body_x.size(); ++i)
      person.of_arm.push_back((*arms)[0].past[i] > 0 || (*arms)[1].past[i] > 0 ? 1 : 0);
    return person;
  }
  bool lies_on_arm(const Triangle& t) const {
    return of_arm[z(t[0])] != 0 || of_arm[z(t[1])] != 0 || of_arm[z(t[2])] != 0;
  }
};

SlipMeter::SlipMeter(const ClothMesh& cloth, std::vector<Triangle> body)
    : cloth_(cloth.triangles), body_(std::move(body)), panel_(cloth.panel), panel_names_(cloth.panel_names) {}

void SlipMeter::add(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  if (body_.empty()) return;
  if (statistics_.first_frame < 0) {
    const bool moves =
        !last_body_x_.empty() && !std::equal(last_body_x_.begin(), last_body_x_.end(), body_x.begin(), body_x.end());
    if (!moves) {
      last_x_.assign(x.begin(), x.end());
      last_body_x_.assign(body_x.begin(), body_x.end());
      ++frames_;
      return;
    }
    statistics_.first_frame = frames_ - 1;
    begin(std::exchange(last_x_, {}), std::exchange(last_body_x_, {}));
  }
  measure(x, body_x);
  ++frames_;
}

Mat3 SlipMeter::frame_of(Index triangle, std::span<const Vec3> body_x) const {
  const auto [a, b, c] = body_[z(triangle)];
  const Vec3 edge = (body_x[z(b)] - body_x[z(a)]).normalized();
  const Vec3 normal = edge.cross(body_x[z(c)] - body_x[z(a)]).normalized();
  Mat3 frame;
  frame.col(0) = edge;
  frame.col(1) = normal;
  frame.col(2) = edge.cross(normal);
  return frame;
}

// [vertex of the cloth]
std::vector<SlipMeter::Bound> SlipMeter::bind(std::span<const Vec3> x, std::span<const Vec3> body_x) const {
  std::vector<Bound> bound(x.size());
  const BoxTree tree(body_, body_x);
  parallel_for(x.size(), 256, [&](std::size_t i) {
    const auto corner = [&](Index t, std::size_t k) -> const Vec3& { return body_x[z(body_[z(t)][k])]; };
    const BoxTree::Nearest nearest = tree.nearest(x[i], {-1, slip_reach_m * slip_reach_m}, [&](Index t) {
      return squared_distance_to_triangle(x[i], corner(t, 0), corner(t, 1), corner(t, 2));
    });
    Bound& b = bound[i];
    b.vertex = static_cast<Index>(i);
    b.triangle = nearest.triangle;
    if (b.triangle < 0) return;
    b.distance_m = std::sqrt(nearest.squared_distance);
    b.weights = nearest_weights(x[i], corner(b.triangle, 0), corner(b.triangle, 1), corner(b.triangle, 2));
    b.start = x[i];
    for (std::size_t k = 0; k < 3; ++k) b.start -= b.weights[static_cast<Eigen::Index>(k)] * corner(b.triangle, k);
    b.frame = frame_of(b.triangle, body_x);
  });
  return bound;
}

void SlipMeter::begin(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  const std::vector<Bound> bound = bind(x, body_x);
  std::vector<char> on_shoulders(x.size(), 0), on_arms(x.size(), 0);
  waist_.axis = -Vec3::UnitY();
  const std::optional<Person> person = Person::find(body_, body_x);
  if (person) {
    for (const Bound& b : bound) {
      if (b.triangle < 0) continue;
      on_arms[z(b.vertex)] = person->lies_on_arm(body_[z(b.triangle)]) ? 1 : 0;
      if (b.distance_m > slip_lies_m || on_arms[z(b.vertex)] != 0) continue;
      const Vec3& p = x[z(b.vertex)];
      if (std::abs(p.y() - person->waist_m) <= half_band_m) waist_.points.push_back(b);
      if (p.y() <= person->roots_m || p.y() >= person->neck_m || b.frame(1, 1) < faces_up) continue;
      shoulders_[p.x() > person->middle_m ? 0 : 1].points.push_back(b);
      on_shoulders[z(b.vertex)] = 1;
    }
  }
  statistics_.waist.vertices = static_cast<int>(waist_.points.size());
  statistics_.shoulders.vertices = static_cast<int>(shoulders_[0].points.size() + shoulders_[1].points.size());
  follow_loops(x, body_x, bound, on_shoulders, on_arms, person.has_value());
}

void SlipMeter::follow_loops(std::span<const Vec3> x, std::span<const Vec3> body_x, const std::vector<Bound>& bound,
                             const std::vector<char>& on_shoulders, const std::vector<char>& on_arms, bool person) {
  const SurfaceParts parts = surface_parts(cloth_, x);
  struct Garment {
    Vec3 middle{0, 0, 0};
    double corners = 0;
    bool on_shoulders = false, worn = false, held = false;  // worn: it has a loop
  };
  std::vector<Garment> garments(parts.parts.size());
  std::vector<Index> garment_of(x.size(), 0),
      panel_of(x.size(), 0);  // of a vertex on a seam, that of its last triangle
  for (std::size_t t = 0; t < cloth_.size(); ++t) {
    Garment& garment = garments[z(parts.of[t])];
    for (const Index i : cloth_[t]) {
      garment_of[z(i)] = parts.of[t];
      panel_of[z(i)] = panel_[t];
      garment.middle += x[z(i)];
      ++garment.corners;
      garment.on_shoulders = garment.on_shoulders || on_shoulders[z(i)] != 0;
    }
  }
  for (Garment& garment : garments) garment.middle /= std::max(1.0, garment.corners);

  const auto name_of = [&](const std::vector<Index>& vertices) {
    std::vector<Index> panels;
    for (const Index i : vertices)
      if (std::find(panels.begin(), panels.end(), panel_of[z(i)]) == panels.end()) panels.push_back(panel_of[z(i)]);
    std::string name;
    for (std::size_t k = 0; k < std::min(named_panels, panels.size()); ++k)
      name += (k == 0 ? "" : ", ") + panel_names_[z(panels[k])];
    return panels.size() > named_panels ? name + " ..." : name;
  };

  struct Found {
    LoopSlip slip;
    Followed followed;
    Index garment = 0;
    bool near = true;  // at least half of it
  };
  std::vector<Found> found;
  const Interior inside(body_, body_x);
  for (const std::vector<Index>& loop : hem_loops(cloth_)) {
    const Curve curve = curve_of(loop, x);
    Found one;
    one.garment = garment_of[z(loop.front())];
    for (const Index i : loop)
      if (bound[z(i)].triangle >= 0) one.followed.points.push_back(bound[z(i)]);
    if (curve.area.norm() < least_area * curve.length_m * curve.length_m / (2 * two_pi)) continue;
    one.followed.axis = axis_of(curve, garments[z(one.garment)].middle);
    if (!body_goes_through(curve, one.followed.axis, inside)) continue;
    one.near = static_cast<double>(one.followed.points.size()) >= least_within * static_cast<double>(loop.size());
    one.slip.name = name_of(loop);
    one.slip.height_m = curve.middle.y();
    one.slip.girth_m = curve.length_m;
    one.slip.drop.vertices = static_cast<int>(one.followed.points.size());
    found.push_back(std::move(one));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.slip.height_m > b.slip.height_m; });
  for (Found& one : found) {
    Garment& garment = garments[z(one.garment)];
    const bool highest = !std::exchange(garment.worn, true);
    if (!one.near) continue;
    one.slip.holds = person && highest && !garment.on_shoulders;
    garment.held = garment.held || one.slip.holds;
    statistics_.loops.push_back(std::move(one.slip));
    loops_.push_back(std::move(one.followed));
  }
  for (std::size_t g = 0; g < garments.size(); ++g) {
    if (!person || !garments[g].worn || garments[g].on_shoulders || garments[g].held) continue;
    const auto lies = [&](const Bound& b) {
      return b.triangle >= 0 && b.distance_m <= slip_lies_m && on_arms[z(b.vertex)] == 0 &&
             garment_of[z(b.vertex)] == static_cast<Index>(g);
    };
    double highest_m = -std::numeric_limits<double>::infinity();
    for (const Bound& b : bound)
      if (lies(b)) highest_m = std::max(highest_m, x[z(b.vertex)].y());
    Found band;
    std::vector<Index> vertices;
    for (const Bound& b : bound) {
      if (!lies(b) || x[z(b.vertex)].y() < highest_m - hold_band_m) continue;
      band.followed.points.push_back(b);
      vertices.push_back(b.vertex);
      band.slip.height_m += x[z(b.vertex)].y();
    }
    if (vertices.empty()) continue;
    band.slip.height_m /= static_cast<double>(vertices.size());
    band.slip.name = name_of(vertices);
    band.slip.holds = true;
    band.slip.drop.vertices = static_cast<int>(vertices.size());
    band.followed.axis = -Vec3::UnitY();
    statistics_.loops.push_back(std::move(band.slip));
    loops_.push_back(std::move(band.followed));
  }
}

Vec3 SlipMeter::moved(const Bound& b, std::span<const Vec3> x, std::span<const Vec3> body_x) const {
  Vec3 beside = x[z(b.vertex)];
  for (std::size_t k = 0; k < 3; ++k)
    beside -= b.weights[static_cast<Eigen::Index>(k)] * body_x[z(body_[z(b.triangle)][k])];
  return b.frame * (frame_of(b.triangle, body_x).transpose() * beside) - b.start;
}

double SlipMeter::mean(const Followed& followed, std::span<const Vec3> x, std::span<const Vec3> body_x) const {
  double sum = 0;
  for (const Bound& b : followed.points) {
    const Vec3 s = moved(b, x, body_x), normal = b.frame.col(1);
    sum += followed.axis.isZero(0) ? (s - normal.dot(s) * normal).norm() : followed.axis.dot(s);
  }
  return followed.points.empty() ? 0 : sum / static_cast<double>(followed.points.size());
}

void SlipMeter::measure(std::span<const Vec3> x, std::span<const Vec3> body_x) {
  for (std::size_t k = 0; k < loops_.size(); ++k) note(statistics_.loops[k].drop, mean(loops_[k], x, body_x), frames_);
  if (statistics_.waist.vertices > 0) note(statistics_.waist, mean(waist_, x, body_x), frames_);
  if (statistics_.shoulders.vertices > 0)
    note(statistics_.shoulders, std::max(mean(shoulders_[0], x, body_x), mean(shoulders_[1], x, body_x)), frames_);
}

}  // namespace toile::internal
