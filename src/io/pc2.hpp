// io/pc2.hpp: point cache version 1 ("POINTCACHE2"): float32 positions per frame, little-endian.
//
//   "POINTCACHE2\0", int32 version = 1, int32 points, float start, float rate, int32 samples,
//   then samples * points * xyz
//
// Easily missed: values are not judged.  A NaN in a cache is read as a NaN, for whoever audits the run.
#pragma once
#include "core/types.hpp"
#include "io/file.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace toile {

// Frames are appended; the file appears under its name, with the right count, at commit().
class Pc2Writer {
 public:
  // `start_frame` and `rate` (samples per frame of the timeline) are stored for other programs.  Throws IoError.
  Pc2Writer(const std::string& path, Index points, double start_frame, double rate);
  void append(std::span<const Vec3> positions);  // must have `points` entries; rounded to float
  int samples() const { return samples_; }
  void commit();

 private:
  AtomicFile file_;
  Index points_;
  std::int32_t samples_ = 0;
  std::vector<float> buffer_;
};

// Reads one frame at a time.  Throws IoError or InputError; a size that the file does not have is an error on opening.
class Pc2Reader {
 public:
  explicit Pc2Reader(const std::string& path);
  ~Pc2Reader();
  Pc2Reader(const Pc2Reader&) = delete;
  Pc2Reader& operator=(const Pc2Reader&) = delete;
  Index points() const { return points_; }
  int samples() const { return samples_; }
  double start_frame() const { return start_; }
  double rate() const { return rate_; }
  // Frame in 0..samples-1; `positions` is resized to points().
  void read(int frame, std::vector<Vec3>& positions);

 private:
  void read_header(std::uint64_t size_bytes);

  std::string path_;
  std::FILE* file_ = nullptr;
  Index points_ = 0;
  int samples_ = 0;
  double start_ = 0, rate_ = 1;
  std::vector<float> buffer_;
};

}  // namespace toile
