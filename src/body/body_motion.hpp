// body/body_motion.hpp: a moving body: fixed triangles, and the positions of the vertices as a function of time.
//
// Sources: a mannequin with a Motion, or any upright person with one that needs no skeleton, evaluated exactly at every t; poses of its own
// skeleton (body/figure_motion.hpp); or samples at a fixed rate from a PC2 file or numbered OBJ files.  Between samples p_i and p_i+1, u = (tau - tau_i) / dt:
//   x = (1 + 2u)(1 - u)^2 p_i + u(1 - u)^2 dt m_i + u^2 (3 - 2u) p_i+1 + u^2 (u - 1) dt m_i+1,
//   m_i = (p_i+1 - p_i-1) / 2 dt, one-sided at both ends                                            [Catmull & Rom 1974]
// so that velocities are continuous; through samples of a straight uniform path it goes exactly.  After the last sample
// the body holds still.  From the drape pose it is led into the samples, when the first is another (body/lead_in.hpp).
//
// Mind: PC2's own start and rate are not used; programs disagree on what they mean.  The rate is the caller's.
#pragma once
#include "body/collision_body.hpp"
#include "body/motion.hpp"
#include "core/hash.hpp"
#include "rig/pose_track.hpp"

#include <memory>
#include <span>
#include <string>

namespace toile::internal {

struct PersonBones;

struct SampleOptions {
  double rate_hz = 30;  // samples per second
  LengthUnit unit = LengthUnit::automatic;
  double lead_in_s = 1;
  double limb_room_m = 0.015;  // for cloth, between limbs that a skeleton moves and the body (body/limb_clearance.hpp)
  double fold_room_m =
      0.006;  // likewise between skin and skin (body/skin_folds.hpp): what is 2.2 offsets of 2.5 mm apart pinches no cloth
  double fastest_m_s =
      20;  // a vertex that moves farther between two samples, beside all together, is an error of the file
};

// A file of samples, by the ending of its name: .pc2 or .mdd.
bool is_point_cache(std::string_view path);

class BodyMotion {
 public:
  // Starts in the A-pose, as the mannequin is made.  Throws InputError for a motion of another kind of mannequin.
  static BodyMotion of_mannequin(const Mannequin& mannequin, const Motion& motion);

  // A person as a mesh, standing like the body at 0 s.  Throws InputError, with `file` as its place, for a motion that needs a skeleton, and for a
  // body that is no person (body/middle_line.hpp).
  static BodyMotion of_person(std::string_view file, const CollisionBody& body, const Motion& motion);

  // A body that was made of the figure's vertices at rest, moved by its skeleton.  `options.rate_hz` does not count: the track has its own.
  static BodyMotion of_figure(std::string_view file, Figure figure, const PersonBones& bones, PoseTrack track,
                              const CollisionBody& body, const SampleOptions& options);

  // A mannequin, by poses of its figure (body/mannequin_figure.hpp).
  static BodyMotion of_mannequin(std::string_view file, const Mannequin& mannequin, Figure figure,
                                 const PersonBones& bones, PoseTrack track, const SampleOptions& options);

  // A point cache of all vertices of the file that `body` was read from, or of the kept ones only.
  static BodyMotion from_pc2(const std::string& path, const CollisionBody& body, const SampleOptions& options);

  // The same as MDD; its times are not used either.
  static BodyMotion from_mdd(const std::string& path, const CollisionBody& body, const SampleOptions& options);

  // `path` is a folder, of which every .obj is a frame, ordered by the last number in its name, or a pattern with one
  // "%d" or "%04d".  Every frame has the vertices and triangles of the file that `body` was read from.
  static BodyMotion from_obj_sequence(const std::string& path, const CollisionBody& body, const SampleOptions& options);

  // Frames in memory, one after the other, each with the body's vertices in their order.
  static BodyMotion from_frames(std::string_view name, std::span<const Vec3> frames, const CollisionBody& body,
                                const SampleOptions& options);

  // By the ending of the name: .pc2, .mdd, otherwise numbered mesh files.
  static BodyMotion from_files(const std::string& path, const CollisionBody& body, const SampleOptions& options);

  // The readers throw IoError, and InputError naming file, frame, vertex, expected and got, for
  //   options out of range; no frames; a number missing or twice; another count of vertices or list of triangles; a
  //   coordinate that is not finite; a vertex faster than `fastest_m_s`; a first sample more than 4 times as tall or as
  //   short as the body (the unit), or with an edge much longer than the body's (another body, another order); more than 2^30 coordinates.

  std::size_t vertex_count() const { return source_->vertex_count(); }
  std::span<const Triangle> triangles() const { return triangles_; }

  // `x` has one entry per vertex; t < 0 is t = 0.  May be called from several threads.
  void positions(double t_s, std::span<Vec3> x) const;

  // Until the body holds still; infinite for motions by name.
  double duration_s() const { return source_->duration_s(); }
  // Length of the lead-in; 0 when the first sample is the drape pose.
  double lead_in_s() const { return source_->lead_in_s(); }

  // Sentences: what was done to samples so that they fit.
  std::vector<std::string> notes() const { return source_->notes(); }

  // Everything that decides the positions.
  void add_to(Hash& hash) const;

  struct Source {
    virtual ~Source() = default;
    virtual std::size_t vertex_count() const = 0;
    virtual void positions(double t_s, std::span<Vec3> x) const = 0;
    virtual double duration_s() const = 0;
    virtual double lead_in_s() const = 0;
    virtual std::vector<std::string> notes() const { return {}; }
    virtual void add_to(Hash& hash) const = 0;
  };

 private:
  BodyMotion(std::vector<Triangle> triangles, std::shared_ptr<const Source> source)
      : triangles_(std::move(triangles)), source_(std::move(source)) {}

  std::vector<Triangle> triangles_;
  std::shared_ptr<const Source> source_;
};

}  // namespace toile::internal
