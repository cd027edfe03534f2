// sim/recorder.hpp: frames of the outfit, from memory to the files and to the judge, which sees the written numbers.
#pragma once
#include "dress/outfit.hpp"
#include "sim/run_writer.hpp"
#include "verify/verify.hpp"

#include <span>
#include <vector>

namespace toile::internal {

// The cloth for the judge: the outfit's drawing and final rest stretch.
RunDescription describe(const ClothMesh& mesh, std::span<const Vec2> rest_stretch, double fps,
                        std::span<const Triangle> body, std::size_t body_vertices);

class Recorder {
 public:
  // Writes frame 0.  `rest_stretch` is the final one of each panel, by which the last frame is judged.  `body` may be empty.
  Recorder(RunWriter& writer, const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
           std::span<const Triangle> body, std::span<const Vec3> body_x);

  // For a resumed run: judges the frames that it wrote before, from its files.  Throws IoError, InputError.
  Recorder(RunWriter& writer, const Outfit& outfit, std::span<const Vec2> rest_stretch, double fps,
           std::span<const Triangle> body, std::size_t body_vertices, const WrittenFrames& written);

  void frame(std::span<const Vec3> x, std::span<const Vec3> body_x);
  VerifyReport report() const { return audit_.report(); }

 private:
  RunWriter* writer_;
  RunAudit audit_;
};

}  // namespace toile::internal
