// io/mdd.hpp: the point cache of LightWave and Blender: float32 positions per frame, big-endian.
//
//   int32 frames, int32 points, float times[frames] (seconds), then frames * points * xyz
#pragma once
#include "core/types.hpp"
#include "io/file.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace toile::internal {

// Throws IoError, and InputError for a size that the file does not have.  Coordinates are not checked.
class MddReader {
 public:
  explicit MddReader(const std::string& path);
  Index points() const { return points_; }
  int samples() const { return samples_; }
  // Of the frame, s.
  double time_s(int frame) const;
  // Frame in 0..samples-1; `positions` is resized to points().
  void read(int frame, std::vector<Vec3>& positions) const;

 private:
  float number(std::size_t index) const;  // after the two counts

  std::string bytes_;
  Index points_ = 0;
  int samples_ = 0;
};

// Appears under its name in commit(), after all frames.  Throws IoError; InputError for a number that no float can hold.
class MddWriter {
 public:
  // Frames are 1 / rate_hz apart, from 0 s on.
  MddWriter(const std::string& path, Index points, int frames, double rate_hz);
  void append(std::span<const Vec3> positions);
  void commit();

 private:
  void write(std::span<const float> numbers);

  AtomicFile file_;
  Index points_;
  int frames_, appended_ = 0;
};

}  // namespace toile::internal
