#include "io/mdd.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.hpp"

namespace toile::internal {
namespace {

constexpr std::size_t counts_bytes = 8;

std::uint32_t big_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}

std::array<char, 4> big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

}  // namespace

MddReader::MddReader(const std::string& path) : bytes_(read_file(path)) {
  const std::string file = printable(path);
  if (bytes_.size() < counts_bytes)
    throw InputError(file, "header", "8 bytes: the numbers of frames and points", std::to_string(bytes_.size()));
  const std::uint64_t frames = big_endian(bytes_.data()), points = big_endian(bytes_.data() + 4);
  constexpr std::uint64_t most = std::numeric_limits<Index>::max();
  if (frames == 0 || frames > most || points > most)
    throw InputError(file, "header", "at least one frame, and counts below 2^31",
                     std::to_string(frames) + " frames of " + std::to_string(points) + " points");
  // Below 2^64: both are below 2^31.
  const std::uint64_t size = counts_bytes + 4 * frames + 12 * frames * points;
  if (size != bytes_.size())
    throw InputError(file, "size",
                     std::to_string(size) + " bytes for " + std::to_string(frames) + " frames of " +
                         std::to_string(points) + " points",
                     std::to_string(bytes_.size()));
  samples_ = static_cast<int>(frames);
  points_ = static_cast<Index>(points);
}

float MddReader::number(std::size_t index) const {
  const std::uint32_t bits = big_endian(bytes_.data() + counts_bytes + 4 * index);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double MddReader::time_s(int frame) const { return static_cast<double>(number(at(frame))); }

void MddReader::read(int frame, std::vector<Vec3>& positions) const {
  const std::size_t first = at(samples_) + 3 * at(points_) * at(frame);
  positions.resize(at(points_));
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      positions[i][static_cast<Eigen::Index>(k)] = static_cast<double>(number(first + 3 * i + k));
}

MddWriter::MddWriter(const std::string& path, Index points, int frames, double rate_hz)
    : file_(path), points_(points), frames_(frames) {
  for (const Index count : {static_cast<Index>(frames), points}) {
    const auto bytes = big_endian(static_cast<std::uint32_t>(count));
    file_.write(bytes.data(), bytes.size());
  }
  std::vector<float> times;
  for (int frame = 0; frame < frames; ++frame) times.push_back(static_cast<float>(frame / rate_hz));
  write(times);
}

void MddWriter::write(std::span<const float> numbers) {
  std::string bytes;
  bytes.reserve(4 * numbers.size());
  for (const float number : numbers) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    const auto four = big_endian(bits);
    bytes.append(four.data(), four.size());
  }
  file_.write(bytes);
}

void MddWriter::append(std::span<const Vec3> positions) {
  if (positions.size() != at(points_) || appended_ == frames_)
    throw InputError(printable(file_.path()), "frame " + std::to_string(appended_),
                     std::to_string(points_) + " points in one of " + std::to_string(frames_) + " frames",
                     std::to_string(positions.size()));
  std::vector<float> numbers;
  for (const Vec3& p : positions)
    for (const double x : p) {
      numbers.push_back(static_cast<float>(x));
      if (!std::isfinite(numbers.back()))
        throw InputError(printable(file_.path()), "frame " + std::to_string(appended_), "numbers that a float can hold",
                         std::to_string(x));
    }
  write(numbers);
  ++appended_;
}

void MddWriter::commit() {
  if (appended_ != frames_)
    throw InputError(printable(file_.path()), "frames", std::to_string(frames_), std::to_string(appended_));
  file_.commit();
}

}  // namespace toile::internal
