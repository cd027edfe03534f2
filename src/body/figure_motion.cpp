#include "body/figure_motion.hpp"

#include "body/limb_clearance.hpp"
#include "body/mannequin_figure.hpp"
#include "body/step_speed.hpp"
#include "core/error.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

constexpr double same_place = 1e-6;  // of the height: the body is the figure at rest
constexpr double same_again = 5e-3;  // of the height: the last pose is the first again; less than a step of any gait
constexpr double farthest_m = 1e6;
constexpr double told_yield_m = 1e-3;

double farthest_apart(std::span<const Vec3> a, std::span<const Vec3> b) {
  double apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, (a[i] - b[i]).norm());
  return apart;
}

}  // namespace

FigureMotion::FigureMotion(std::string_view file, Figure figure, const PersonBones& bones, PoseTrack track,
                           const CollisionBody& body, const SampleOptions& options)
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
  make_room(file, body, bones, options);
}

FigureMotion::FigureMotion(std::string_view file, const Mannequin& mannequin, Figure figure, const PersonBones& bones,
                           PoseTrack track, const SampleOptions& options)
    : figure_(std::move(figure)), mannequin_(mannequin), track_(std::move(track)), vertices_(every_vertex(figure_)) {
  const CollisionBody body = from_mannequin(mannequin);
  check_samples(file, body, options);
  make_room(file, body, bones, options);
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

void FigureMotion::make_room(std::string_view file, const CollisionBody& body, const PersonBones& bones,
                             const SampleOptions& options) {
  if (options.limb_room_m == 0 && options.fold_room_m == 0) return;
  const PosedBody posed{&figure_, vertices_, body.triangles, to_body_,
                        [this](const FigurePose& pose, std::span<Vec3> x) { place(pose, x); }};
  std::vector<std::string> told;
  keep_limbs_clear(posed, bones, options.limb_room_m, track_, told);
  folds_ = SkinFolds(posed, options.fold_room_m, track_);
  if (folds_.deepest_m() > told_yield_m)
    told.push_back(fmt::sprintf("skin that is folded onto itself yields by up to %.1f mm, to leave %.0f mm for cloth",
                                1000 * folds_.deepest_m(), 1000 * options.fold_room_m));
  for (const std::string& note : told) notes_.push_back(std::string(file) + ": " + note);
}

void FigureMotion::check_samples(std::string_view file, const CollisionBody& body, const SampleOptions& options) {
  std::vector<Vec3> first(vertices_.size()), before, x(vertices_.size());
  bool moves = false;
  for (std::size_t frame = 0; frame < track_.poses.size(); ++frame) {
    place(track_.poses[frame], x);
    const std::string when = fmt::sprintf("%.3f s", static_cast<double>(frame) / track_.rate_hz);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(x[i].cwiseAbs().maxCoeff() <= farthest_m))
        throw InputError(file, when + ", vertex " + std::to_string(vertices_[i]), "coordinates within 1000 km",
                         x[i].allFinite() ? "farther" : "infinity or not a number");
      moves |= frame > 0 && (x[i] - before[i]).norm() > same_again * body.height_m;
    }
    if (frame > 0)
      check_step_speed(file, when, before, x, {track_.rate_hz, options.fastest_m_s},
                       [&](std::size_t i) { return at(vertices_[i]); });
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
  place_at(lead_in_.clock(t), lead_in_.share(t), x);
}

void FigureMotion::place_at(double track_s, double share, std::span<Vec3> x) const {
  place(between(figure_.rest, pose_at(track_, track_s), share), x);
  folds_.yield(track_s, share, x);
}

void FigureMotion::add_to(Hash& hash) const {
  hash.add_counted(std::span<const Vec3>(figure_.modelled));
  std::vector<Vec3> x(vertices_.size());
  for (std::size_t k = 0; k < track_.poses.size(); ++k) {
    place_at(static_cast<double>(k) / track_.rate_hz, 1, x);
    hash.add_counted(std::span<const Vec3>(x));
  }
  const double numbers[] = {track_.rate_hz, lead_in_.seconds, track_.loops ? 1.0 : 0.0};
  hash.add(std::span<const double>(numbers));
}

}  // namespace toile::internal
