// rig/pose_track.hpp: poses of a figure at a fixed rate, and a smooth way between them.
//
// Between poses every number runs on a cubic with Catmull-Rom tangents, one-sided at the ends [Catmull & Rom 1974]; turns do so as
// quaternions, made unit again.  So a pose of the track is met exactly and velocities never jump, whatever the keys of the clip do.
#pragma once
#include "rig/clip.hpp"

#include <string_view>
#include <vector>

namespace toile::internal {

struct PoseTrack {
  std::vector<FigurePose> poses;
  double rate_hz = 30;
  bool loops = false;  // the last pose is the first again

  double length_s() const { return static_cast<double>(poses.size() - 1) / rate_hz; }
};

// Samples of a clip from its first key to its last, both included; the rate is adjusted so that they fit.  Throws InputError with `file` as
// its place for a track that is too long to hold.
PoseTrack track_of(const Clip& clip, const Figure& figure, double rate_hz, std::string_view file);

// `t_s` >= 0; after the last pose the last, unless it loops.
FigurePose pose_at(const PoseTrack& track, double t_s);

// From one pose to the other: turns along the shorter arc.
FigurePose between(const FigurePose& from, const FigurePose& to, double share);

// Throws unless so many poses of so many nodes can be held.
void check_track_size(double poses, std::size_t nodes, std::string_view file);

}  // namespace toile::internal
