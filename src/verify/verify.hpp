// verify/verify.hpp: judges a finished run from its files alone, with exact arithmetic.    `toile verify DIR`
//
// The judge shares no code with contact: its own tree, its own predicates.  It reads positions as they were written
// (float32, which double holds exactly) and does not trust report.json about them.
// Theory: docs/theory/verify.md.
//
//   predicates.hpp   signs, exactly                      crossings.hpp    edges through triangles
//   box_tree.hpp     candidates                          statistics.hpp   stretch, shear, gap, speed
//   interior.hpp     inside or outside                   pinch.hpp        where a body leaves no room
//   jitter.hpp       trembling                           slip.hpp         sliding on the body
//   verdict.hpp      pass or fail, and why               verify.hpp       a run, frame by frame
//
// Easily got wrong: audit the positions that the files hold.  Rounding to float32 moves a particle by up to 6e-8 of its
// coordinate, which can open or close a crossing; a caller that audits from memory rounds first.
#pragma once
#include "core/types.hpp"
#include "mesh/cloth_mesh.hpp"
#include "verify/crossings.hpp"
#include "verify/jitter.hpp"
#include "verify/predicates.hpp"
#include "verify/slip.hpp"
#include "verify/statistics.hpp"

#include <span>
#include <string>
#include <vector>

namespace toile::internal {

struct Reason {
  std::string code;
  std::string detail;  // one line: the measured value, its place, and the limit
  template <class Archive>
  void remember(Archive& archive) {
    archive(code, detail);
  }
};

// Distinct edges that pass through a triangle.
struct PenetrationCount {
  int max = 0, last = 0, frames = 0;  // over frames; in the last frame; the number of frames with any
};

struct VerifyReport {
  int frames = 0;
  int frames_expected = 0;  // 0: unknown
  bool finite = true;
  Index first_bad_frame = -1;  // the first with a value that is not finite; such frames are measured no further
  bool has_body = false;
  PenetrationCount cloth_body_edges;  // cloth edges through the body and body edges through the cloth
  PenetrationCount outside_pinches;   // of those, where the body itself leaves room (verify/pinch.hpp)
  PenetrationCount cloth_cloth_edges;
  Index first_body_crossing_frame = -1, first_cloth_crossing_frame = -1;
  StretchStatistics stretch;      // last frame
  GapStatistics gap;              // last frame; zero without a body
  double still_mm_per_s_p99 = 0;  // largest per-frame p99 of the last second; zero with fewer than two frames
  JitterStatistics jitter;        // of the motion if the body moves, else of all frames
  SlipStatistics slip;            // of the motion
  std::vector<Crossing> last_body_crossings, last_outside_pinches, last_cloth_crossings;
  Index worst_frame = -1;  // the first of those with most crossings; -1: no frame has any
  std::vector<Crossing> worst_body_crossings, worst_cloth_crossings;
  bool must_be_still = false;  // from report.json: limits.still_mm_per_s is a number
  // Reason codes of report.json that cannot be measured (a time limit, a crash): the judge cannot refute them.
  std::vector<std::string> reported_reasons;
  std::vector<std::string> changes;         // of the files since they were written, in words (verify/integrity.hpp)
  std::vector<std::string> changed_inputs;  // input files that have changed since the run
  int inputs = 0, missing_inputs = 0;       // of report.json; no longer at their paths
  std::string interrupted;  // of a run that has not ended: in words, its progress and how to resume it; empty otherwise
  std::vector<Reason> reported_qualifications;  // of report.json, likewise not measurable
};

// The data common to all frames of a run.
struct RunDescription {
  ClothMesh mesh;
  std::vector<Vec2> b;  // (b_u, b_v) per triangle; empty: 1
  std::vector<Triangle> body_triangles;
  Index body_particle_count = 0;
  double fps = 30;
};

// Audits frames in their order; holds a few of them.
class RunAudit {
 public:
  // Throws InputError when the description contradicts itself.
  explicit RunAudit(RunDescription run);

  // `body_x` is empty when the run has no body.  Throws InputError when a size is not that of the description.
  void add(std::span<const Vec3> x, std::span<const Vec3> body_x);

  // The result for the frames added so far.
  VerifyReport report() const;

 private:
  RunDescription run_;
  VerifyReport report_;
  JitterMeter jitter_;
  SlipMeter slip_;
  CrossingSearch crossings_;
  Vec3s last_x_, last_body_x_;
  bool last_is_finite_ = false;
  std::vector<double> speed_p99_;  // one per pair of consecutive frames
};

// Reads the files of a run; every frame is judged, and compared with its checksum in the report.  All files of the body may be absent when
// report.json has no body; those of the cloth when it has no frames.  Of report.json it uses `fps`, and if present `frames`,
// `body.vertices`, `reasons`, `qualification_details`, `limits.still_mm_per_s`, `inputs`, `files` and `rest_stretch` {"panel": [b_u, b_v]}.
// A run in progress or one that was killed has unfinished.json instead: its frames are judged, and it is no pass.
// Throws IoError (missing, unreadable) or InputError (truncated, not in its format, sizes that contradict each
// other), naming the file, the expected and the actual value.
VerifyReport verify_directory(const std::string& directory);

}  // namespace toile::internal
