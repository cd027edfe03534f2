#include "body/figure_motion.hpp"

#include "body/mannequin_figure.hpp"
#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr double same_place = 1e-6;  // of the height: the body is the figure at rest
constexpr double same_pose_m = 1e-5;
constexpr double same_again = 5e-3;  // of the height: the last pose is the first again; less than a step of any gait
constexpr double farthest_m = 1e6;

double farthest_apart(std::span<const Vec3> a, std::span<const Vec3> b) {
  double apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, (a[i] - b[i]).norm());
  return apart;
}

}  // namespace

FigureMotion::FigureMotion(std::string_view file, Figure figure, PoseTrack track, const CollisionBody& body,
                           const SampleOptions& options)
    : figure_(std::move(figure)),
      track_(std::move(track)),
      vertices_(body.source_vertex),
      to_body_(metres_in(options.unit) * body.rotation) {
  std::vector<Vec3> x(vertices_.size());
  place(figure_.rest, x);
  if (!(farthest_apart(x, body.positions) <= same_place * body.height_m))
    throw InputError(file, "skeleton", "one that carries the body where it stands",
                     fmt::sprintf("%.3g m apart", farthest_apart(x, body.positions)));
  check_samples(file, body, options);
}

FigureMotion::FigureMotion(std::string_view file, const Mannequin& mannequin, Figure figure, PoseTrack track,
                           const SampleOptions& options)
    : figure_(std::move(figure)), mannequin_(mannequin), track_(std::move(track)), vertices_(every_vertex(figure_)) {
  check_samples(file, from_mannequin(mannequin), options);
}

void FigureMotion::place(const FigurePose& pose, std::span<Vec3> x) const {
  if (mannequin_) {
    mannequin_->positions(mannequin_pose(figure_, pose), x);
    return;
  }
  pose_vertices(figure_, pose, vertices_, x);
  if (!to_body_.isIdentity(0))
    for (Vec3& p : x) p = to_body_ * p;
}

void FigureMotion::check_samples(std::string_view file, const CollisionBody& body, const SampleOptions& options) {
  const double farthest = options.fastest_m_s / track_.rate_hz;
  std::vector<Vec3> first(vertices_.size()), before, x(vertices_.size());
  bool moves = false;
  for (std::size_t frame = 0; frame < track_.poses.size(); ++frame) {
    place(track_.poses[frame], x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto where = [&] {
        return fmt::sprintf("%.3f s, vertex %d", static_cast<double>(frame) / track_.rate_hz, vertices_[i]);
      };
      if (!(x[i].cwiseAbs().maxCoeff() <= farthest_m))
        throw InputError(file, where(), "coordinates within 1000 km",
                         x[i].allFinite() ? "farther" : "infinity or not a number");
      const double moved = before.empty() ? 0 : (x[i] - before[i]).norm();
      moves |= moved > same_again * body.height_m;
      if (moved > farthest)
        throw InputError(file, where(), fmt::sprintf("at most %g m/s", options.fastest_m_s),
                         fmt::sprintf("%.3g m/s", moved * track_.rate_hz));
    }
    if (frame == 0) first = x;
    before = x;
  }
  lead_in_.seconds = farthest_apart(first, body.positions) > same_pose_m ? options.lead_in_s : 0;
  // Two poses and a half turn back.
  track_.loops = moves && track_.poses.size() > 3 && farthest_apart(first, x) <= same_again * body.height_m;
}

double FigureMotion::duration_s() const {
  return track_.loops ? std::numeric_limits<double>::infinity() : lead_in_.seconds + track_.length_s();
}

void FigureMotion::positions(double t_s, std::span<Vec3> x) const {
  const double t = std::max(t_s, 0.0);
  const FigurePose pose = pose_at(track_, lead_in_.clock(t));
  place(between(figure_.rest, pose, lead_in_.share(t)), x);
}

void FigureMotion::add_to(Hash& hash) const {
  hash.add_counted(std::span<const Vec3>(figure_.modelled));
  std::vector<Vec3> x(vertices_.size());
  for (const FigurePose& pose : track_.poses) {
    place(pose, x);
    hash.add_counted(std::span<const Vec3>(x));
  }
  const double numbers[] = {track_.rate_hz, lead_in_.seconds, track_.loops ? 1.0 : 0.0};
  hash.add(std::span<const double>(numbers));
}

}  // namespace toile::internal
