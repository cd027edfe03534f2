// io/pc2.hpp: point cache version 1 ("POINTCACHE2"): float32 positions per frame, little-endian.
//
//   "POINTCACHE2\0", int32 version = 1, int32 points, float start, float rate, int32 samples,
//   then samples * points * xyz
//
// Easily missed: values are not checked.  A NaN in a cache is read as a NaN, for the audit of the run.
#pragma once
#include "core/types.hpp"
#include "io/file.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

// The 32 bytes before the samples.
std::string pc2_header(Index points, double start_frame, double rate, int samples);

// Every append commits its frame: the file is then complete, and its header has the number of frames.
class Pc2Writer {
 public:
  // A new file; there must be no file of that name.  `start_frame` and `rate` (samples per frame of the timeline) are stored for other
  // programs.  Throws IoError.
  Pc2Writer(const std::string& path, Index points, double start_frame, double rate);
  // Appends after the first `samples` frames of such a file; later ones are cut off.  Throws InputError when the file has fewer frames,
  // or another number of points.
  static std::unique_ptr<Pc2Writer> resume(const std::string& path, Index points, int samples);

  void append(std::span<const Vec3> positions);  // must have `points` entries; rounded to float
  int samples() const { return samples_; }
  // Flushes the frames to the disk.  May be called while another thread appends.
  void synchronize() const { file_.synchronize(); }

  // core/hash.hpp: of every frame's bytes, and of the header as it is now.
  std::span<const std::uint64_t> frame_checksums() const { return checksums_; }
  std::uint64_t header_checksum() const;

 private:
  Pc2Writer(const std::string& path, Index points);
  void write_count();

  GrowingFile file_;
  Index points_;
  std::int32_t samples_ = 0;
  float start_ = 0, rate_ = 1;
  std::vector<float> buffer_;
  std::vector<std::uint64_t> checksums_;
};

// Bytes after the frames that the header counts: none, or also a frame that a killed writer had begun.
enum class Pc2End { exact, cut };

// Reads one frame at a time.  Throws IoError or InputError; a size that the file does not have is an error on opening.
class Pc2Reader {
 public:
  explicit Pc2Reader(const std::string& path, Pc2End end = Pc2End::exact);
  ~Pc2Reader();
  Pc2Reader(const Pc2Reader&) = delete;
  Pc2Reader& operator=(const Pc2Reader&) = delete;
  Index points() const { return points_; }
  int samples() const { return samples_; }
  double start_frame() const { return start_; }
  double rate() const { return rate_; }
  // Frame in 0..samples-1; `positions` is resized to points().
  void read(int frame, std::vector<Vec3>& positions);
  // core/hash.hpp: of the bytes of the frame that was read last, and of the header.
  std::uint64_t frame_checksum() const;
  std::uint64_t header_checksum() const { return header_checksum_; }

 private:
  void read_header(std::uint64_t size_bytes);

  std::string path_;
  Pc2End end_;
  std::FILE* file_ = nullptr;
  Index points_ = 0;
  int samples_ = 0;
  double start_ = 0, rate_ = 1;
  std::uint64_t header_checksum_ = 0;
  std::vector<float> buffer_;
};

}  // namespace toile::internal
