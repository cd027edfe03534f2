// body/figure_motion.hpp: a body that its skeleton moves along a track of poses.
//
// Into the track it is led joint by joint, as arms that were lowered along straight lines would shrink.  A track whose last pose is the first
// again is repeated.
#pragma once
#include "body/body_motion.hpp"
#include "body/lead_in.hpp"
#include "body/pose.hpp"
#include "body/skin_folds.hpp"
#include "rig/pose_track.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct PersonBones;

class FigureMotion : public BodyMotion::Source {
 public:
  // `body` was made of the figure's vertices at rest, in the unit of the options.  Throws InputError, with `file` as its place, for a pose
  // that is not finite, and a vertex that is faster than the options allow.
  FigureMotion(std::string_view file, Figure figure, const PersonBones& bones, PoseTrack track,
               const CollisionBody& body, const SampleOptions& options);

  // Of a mannequin: its skin follows as in its own motions (body/pose.hpp).
  FigureMotion(std::string_view file, const Mannequin& mannequin, Figure figure, const PersonBones& bones,
               PoseTrack track, const SampleOptions& options);

  std::size_t vertex_count() const override { return vertices_.size(); }
  void positions(double t_s, std::span<Vec3> x) const override;
  double duration_s() const override;
  double lead_in_s() const override { return lead_in_.seconds; }
  std::vector<std::string> notes() const override { return notes_; }
  void add_to(Hash& hash) const override;

 private:
  void place(const FigurePose& pose, std::span<Vec3> x) const;
  // As its flesh is at a time of the track, `share` of the way from rest.
  void place_at(double track_s, double share, std::span<Vec3> x) const;
  void make_room(std::string_view file, const CollisionBody& body, const PersonBones& bones,
                 const SampleOptions& options);
  void check_samples(std::string_view file, const CollisionBody& body, const SampleOptions& options);

  Figure figure_;
  std::optional<SkinnedBody> mannequin_;
  PoseTrack track_;
  std::vector<Index> vertices_;      // of the figure
  Mat3 to_body_ = Mat3::Identity();  // from the figure's axes and unit
  LeadIn lead_in_;
  SkinFolds folds_;
  std::vector<std::string> notes_;
};

}  // namespace toile::internal
