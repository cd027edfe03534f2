#include "sim/falling.hpp"

#include "body/measure.hpp"
#include "garment/pattern_figures.hpp"

#include <fmt/printf.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace toile::internal {
namespace {

// Calls work(part, first particle).
template <class Work>
void for_parts(std::span<const OutfitPart> parts, const Work& work) {
  std::size_t first = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    work(p, first);
    first += at(parts[p].particles);
  }
}

}  // namespace

void note_touches(std::span<const OutfitPart> parts, const OutfitRun& run, TouchMemory& memory) {
  memory.touched.resize(parts.size(), 0);
  for_parts(parts, [&](std::size_t p, std::size_t first) {
    for (std::size_t i = first; i < first + at(parts[p].particles) && memory.touched[p] == 0; ++i)
      memory.touched[p] = run.touches_body(static_cast<Index>(i)) ? 1 : 0;
  });
}

FallWatch::FallWatch(const Vec3& gravity_m_per_s2, std::span<const Triangle> solids, BodyAt moves, double seconds,
                     double frame_s)
    : g_(gravity_m_per_s2.norm()), solids_(solids), moves_(std::move(moves)), seconds_(seconds), frame_s_(frame_s) {
  const Vec3 up = -gravity_m_per_s2 / g_;
  const Vec3 across = up.unitOrthogonal();
  frame_.row(0) = across;
  frame_.row(1) = up.cross(across);
  frame_.row(2) = up;
}

FallWatch::Box FallWatch::box_of(std::span<const Vec3> x) const {
  Box box{frame_ * x[0], frame_ * x[0]};
  for (const Vec3& p : x) {
    const Vec3 q = frame_ * p;
    box.low = box.low.cwiseMin(q);
    box.high = box.high.cwiseMax(q);
  }
  return box;
}

FallWatch::Flight FallWatch::flight_of(std::span<const Vec3> x, std::span<const Vec3> v) const {
  Flight flight;
  flight.box = box_of(x);
  flight.top_m = flight.box.high.z();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 u = frame_ * v[i];
    const double rise_m = u.z() > 0 ? u.z() * u.z() / (2 * g_) : 0;
    flight.top_m = std::max(flight.top_m, (frame_ * x[i]).z() + rise_m);
    flight.throw_m = std::max(flight.throw_m, u.head<2>().squaredNorm() / (2 * g_));
  }
  return flight;
}

bool FallWatch::in_reach(const Flight& flight, const Box& box) {
  const double fall_m = flight.top_m - box.low.z();
  if (fall_m < 0) return false;
  const Vec3 beside = (box.low - flight.box.high).cwiseMax(flight.box.low - box.high).cwiseMax(0.0);
  return beside.head<2>().norm() <= most_glide * fall_m + flight.throw_m;
}

const FallWatch::Box& FallWatch::swept(std::span<const Vec3> x) {
  if (swept_) return *swept_;
  Vec3s there(x.begin(), x.end());
  swept_ = box_of(there);
  const auto frames = static_cast<long>(std::ceil(seconds_ / frame_s_));
  for (long k = 0; k <= frames; ++k) {
    moves_(static_cast<double>(k) * frame_s_, x, there);
    const Box box = box_of(there);
    swept_->low = swept_->low.cwiseMin(box.low);
    swept_->high = swept_->high.cwiseMax(box.high);
  }
  return *swept_;
}

bool FallWatch::reaches_solids(const Flight& flight, std::span<const Vec3> x) {
  for (const Triangle& t : solids_)
    if (in_reach(flight, box_of(std::array<Vec3, 3>{x[at(t[0])], x[at(t[1])], x[at(t[2])]}))) return true;
  return moves_ && in_reach(flight, swept(x));
}

std::optional<LostGarment> FallWatch::find(std::span<const OutfitPart> parts, const ClothState& state,
                                           std::span<const Vec3> x) {
  std::vector<Flight> flights;
  std::vector<char> caught;
  for_parts(parts, [&](std::size_t p, std::size_t first) {
    const std::size_t count = at(parts[p].particles);
    flights.push_back(flight_of(std::span(state.x).subspan(first, count), std::span(state.v).subspan(first, count)));
    caught.push_back(reaches_solids(flights.back(), x) ? 1 : 0);
  });
  for (bool more = true; more;) {  // a garment in reach of one that is caught may be caught by it
    more = false;
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (std::size_t q = 0; q < parts.size() && caught[p] == 0; ++q)
        if (caught[q] != 0 && in_reach(flights[p], flights[q].box)) {
          caught[p] = 1;
          more = true;
        }
  }
  const auto lost = std::find(caught.begin(), caught.end(), 0);
  if (lost == caught.end()) return std::nullopt;
  const auto p = static_cast<std::size_t>(lost - caught.begin());
  const Box &cloth = flights[p].box, solids = box_of(x);
  const Vec3 beside = (solids.low - cloth.high).cwiseMax(cloth.low - solids.high).cwiseMax(0.0);
  return LostGarment{
      static_cast<Index>(p),
      fmt::sprintf("it is %.2f to %.2f m high, the body from %.2f to %.2f m and %.2f m beside it", cloth.low.z(),
                   cloth.high.z(), solids.low.z(), solids.high.z(), beside.head<2>().norm())};
}

Belonging belonging_of(const GarmentMesh& garment) {
  Belonging belonging;
  for (const LabelledEdge& edge : garment.labels) {
    belonging.bodice = belonging.bodice || is_of_bodice(edge.label);
    if (edge.label != edge_label::waist) continue;
    for (std::size_t k = 1; k < edge.particles.size(); ++k)
      belonging.waist_girth_m += (garment.x[at(edge.particles[k])] - garment.x[at(edge.particles[k - 1])]).norm();
  }
  return belonging;
}

TrunkLevels trunk_levels(std::span<const Vec3> person, std::span<const Triangle> triangles) {
  return {hips(person, triangles), waist_height_m(person, triangles)};
}

std::optional<LostGarment> slid_down(std::span<const OutfitPart> parts, std::span<const Belonging> belongings,
                                     std::span<const Vec3> cloth, const TrunkLevels& trunk, double share) {
  std::optional<LostGarment> lost;
  for_parts(parts, [&](std::size_t p, std::size_t first) {
    if (lost || p >= belongings.size()) return;
    const Belonging& belonging = belongings[p];
    double top_m = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : cloth.subspan(first, at(parts[p].particles))) top_m = std::max(top_m, x.y());
    if (belonging.bodice && trunk.waist_m > 0 && top_m < share * trunk.waist_m) {
      lost = LostGarment{
          static_cast<Index>(p),
          fmt::sprintf("all of it, its bodice too, is below %.2f m, the waist is %.2f m high", top_m, trunk.waist_m)};
    } else if (belonging.waist_girth_m > 0 && trunk.hips.girth_m > 0 && top_m < share * trunk.hips.height_m) {
      lost = LostGarment{
          static_cast<Index>(p),
          fmt::sprintf("all of it is below %.2f m, the hips are %.2f m high and %.1f cm round; its waist is %.1f cm "
                       "round as cut",
                       top_m, trunk.hips.height_m, 100 * trunk.hips.girth_m, 100 * belonging.waist_girth_m)};
    }
  });
  return lost;
}

}  // namespace toile::internal
