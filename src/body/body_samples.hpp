// body/body_samples.hpp: positions of a body sampled at a fixed rate, and the numbered files that hold them.
#pragma once
#include "body/body_motion.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace toile::internal {

struct NumberedFile {
  std::int64_t number = 0;
  std::string path;
};

// The frames that `path` (a folder or a pattern, see body_motion.hpp) names, in order and without gaps.
// Throws InputError for none, a gap, a number twice, a name without a number or a pattern without %d; IoError.
std::vector<NumberedFile> numbered_files(const std::string& path);

// Samples of the kept vertices, in metres, as float32.  Filled frame by frame; every frame is checked as it comes.
class BodySamples : public BodyMotion::Source {
 public:
  // Throws InputError for options out of range.
  BodySamples(std::string_view file, const CollisionBody& body, const SampleOptions& options);

  // `positions` are those of a file with all source vertices, or of the kept vertices only; as in the file.  The first frame must fit the body: its
  // height, the lengths of its edges.  If it fits better with other axes, as z up, all are turned, and that is noted.
  void append(std::string_view file, std::span<const Vec3> positions);
  // Call after the last frame; throws InputError when there was none.
  void finish(std::string_view file);

  std::size_t vertex_count() const override { return drape_.size(); }
  void positions(double t_s, std::span<Vec3> x) const override;
  double duration_s() const override;
  double lead_in_s() const override { return lead_in_s_; }
  std::vector<std::string> notes() const override { return notes_; }
  void add_to(Hash& hash) const override;

 private:
  using Vec3f = Eigen::Vector3f;
  Vec3 sample(std::size_t frame, std::size_t vertex) const {
    return samples_[frame * drape_.size() + vertex].cast<double>();
  }
  void turn_to_fit(std::string_view file, Vec3s& frame);
  void check_height(std::string_view file, const Vec3s& frame) const;
  void check_edges(std::string_view file, const Vec3s& frame) const;
  void check_speed(std::string_view file, const Vec3s& frame) const;

  std::vector<Vec3> drape_;
  std::vector<Triangle> triangles_;
  Mat3 rotation_;  // from the samples' axes
  std::vector<Index> source_vertex_;
  std::size_t source_count_ = 0, frames_ = 0;
  SampleOptions options_;
  double lead_in_s_ = 0;
  std::vector<Vec3f> samples_;
  std::vector<std::string> notes_;
};

}  // namespace toile::internal
