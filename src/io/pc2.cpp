#include "io/pc2.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <system_error>

#include "core/error.hpp"
#include "core/hash.hpp"

namespace toile::internal {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and so must the machine be");

struct Header {
  char magic[12];
  std::int32_t version;
  std::int32_t points;
  float start;
  float rate;
  std::int32_t samples;
};
static_assert(sizeof(Header) == 32 && offsetof(Header, samples) == 28);

constexpr char pc2_magic[12] = "POINTCACHE2";

// Bytes of one frame; fits, as points < 2^31.
std::uint64_t frame_bytes(Index points) { return static_cast<std::uint64_t>(points) * 3 * sizeof(float); }

Header header_of(Index points, float start, float rate, std::int32_t samples) {
  Header header{};
  std::memcpy(header.magic, pc2_magic, sizeof pc2_magic);
  header.version = 1;
  header.points = points;
  header.start = start;
  header.rate = rate;
  header.samples = samples;
  return header;
}

}  // namespace

std::string pc2_header(Index points, double start_frame, double rate, int samples) {
  const Header header = header_of(points, static_cast<float>(start_frame), static_cast<float>(rate), samples);
  return {reinterpret_cast<const char*>(&header), sizeof header};
}

Pc2Writer::Pc2Writer(const std::string& path, Index points, double start_frame, double rate)
    : file_(path, GrowingFile::Open::create),
      points_(points),
      start_(static_cast<float>(start_frame)),
      rate_(static_cast<float>(rate)) {
  if (points < 0) throw InputError(printable(path), "points", "a number >= 0", std::to_string(points));
  const Header header = header_of(points_, start_, rate_, 0);
  file_.append(&header, sizeof header);
  buffer_.resize(3 * static_cast<std::size_t>(points));
}

Pc2Writer::Pc2Writer(const std::string& path, Index points)
    : file_(path, GrowingFile::Open::existing), points_(points), buffer_(3 * static_cast<std::size_t>(points)) {}

std::unique_ptr<Pc2Writer> Pc2Writer::resume(const std::string& path, Index points, int samples) {
  std::unique_ptr<Pc2Writer> writer(new Pc2Writer(path, points));
  Pc2Reader reader(path, Pc2End::cut);
  if (reader.points() != points)
    throw InputError(printable(path), "points", std::to_string(points), std::to_string(reader.points()));
  if (reader.samples() < samples)
    throw InputError(printable(path), "samples", "at least " + std::to_string(samples),
                     std::to_string(reader.samples()));
  writer->start_ = static_cast<float>(reader.start_frame());
  writer->rate_ = static_cast<float>(reader.rate());
  std::vector<Vec3> x;
  for (int frame = 0; frame < samples; ++frame) {
    reader.read(frame, x);
    writer->checksums_.push_back(reader.frame_checksum());
  }
  writer->samples_ = samples;
  // The count first: the file may have frames beyond the count, but never fewer.
  writer->write_count();
  writer->file_.truncate(sizeof(Header) + static_cast<std::uint64_t>(samples) * frame_bytes(points));
  return writer;
}

void Pc2Writer::write_count() { file_.overwrite(offsetof(Header, samples), &samples_, sizeof samples_); }

void Pc2Writer::append(std::span<const Vec3> positions) {
  if (positions.size() != static_cast<std::size_t>(points_)) {
    throw InputError(printable(file_.path()), "frame " + std::to_string(samples_),
                     std::to_string(points_) + " positions", std::to_string(positions.size()));
  }
  if (samples_ == std::numeric_limits<std::int32_t>::max())
    throw IoError(file_.path(), "more frames than PC2 can count");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      buffer_[3 * i + axis] = static_cast<float>(positions[i][static_cast<Eigen::Index>(axis)]);
    }
  }
  const std::size_t bytes = buffer_.size() * sizeof(float);
  file_.append(buffer_.data(), bytes);
  ++samples_;
  write_count();
  checksums_.push_back(checksum(buffer_.data(), bytes));
}

std::uint64_t Pc2Writer::header_checksum() const {
  const Header header = header_of(points_, start_, rate_, samples_);
  return checksum(&header, sizeof header);
}

Pc2Reader::Pc2Reader(const std::string& path, Pc2End end) : path_(path), end_(end) {
  std::uint64_t size = 0;
  file_ = open_regular_file(path, size);
  try {
    read_header(size);
  } catch (...) {
    std::fclose(file_);
    throw;
  }
}

Pc2Reader::~Pc2Reader() { std::fclose(file_); }

void Pc2Reader::read_header(std::uint64_t size_bytes) {
  const auto refuse = [&](std::string_view place, std::string_view expected, const std::string& got) {
    throw InputError(printable(path_), place, expected, got);
  };
  Header header{};
  if (size_bytes < sizeof header) refuse("header", "32 bytes", std::to_string(size_bytes));
  if (std::fread(&header, sizeof header, 1, file_) != 1) throw IoError(path_, "cannot read the header");
  if (std::memcmp(header.magic, pc2_magic, sizeof pc2_magic) != 0) {
    refuse("header", "\"POINTCACHE2\"", '"' + printable(std::string_view(header.magic, sizeof pc2_magic)) + '"');
  }
  if (header.version != 1) refuse("version", "1", std::to_string(header.version));
  if (header.points < 0) refuse("points", "a number >= 0", std::to_string(header.points));
  if (header.samples < 0) refuse("samples", "a number >= 0", std::to_string(header.samples));
  if (!std::isfinite(header.start)) refuse("start", "a finite frame", std::to_string(header.start));
  if (!std::isfinite(header.rate)) refuse("rate", "a finite rate", std::to_string(header.rate));

  // The declared size is compared with the file's before memory is allocated for it.  2^31 samples of 2^31 points overflow
  // 64 bits: compare by division.
  const std::uint64_t data = size_bytes - sizeof header;
  const std::uint64_t frame = frame_bytes(header.points);
  const auto samples = static_cast<std::uint64_t>(header.samples);
  const std::uint64_t frames_there = frame == 0 ? 0 : data / frame;
  const bool fits = frame == 0              ? data == 0
                    : end_ == Pc2End::exact ? data % frame == 0 && frames_there == samples
                                            : frames_there >= samples;
  if (!fits) {
    refuse(
        "size",
        std::to_string(header.samples) + " samples of " + std::to_string(header.points) + " points, as the header says",
        std::to_string(data) + " bytes of data");
  }
  // Without a sample the number of points is not backed by data; it must not become a buffer of 24 GB.
  points_ = header.points;
  samples_ = header.samples;
  start_ = header.start;
  rate_ = header.rate;
  header_checksum_ = checksum(&header, sizeof header);
  if (samples_ > 0) buffer_.resize(3 * static_cast<std::size_t>(points_));
}

void Pc2Reader::read(int frame, std::vector<Vec3>& positions) {
  if (frame < 0 || frame >= samples_) {
    throw InputError(
        printable(path_), "frame",
        samples_ > 0 ? "a frame in 0.." + std::to_string(samples_ - 1) : std::string("none, as there are none"),
        std::to_string(frame));
  }
  const std::uint64_t offset = sizeof(Header) + static_cast<std::uint64_t>(frame) * frame_bytes(points_);
  if (::fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0 ||
      std::fread(buffer_.data(), sizeof(float), buffer_.size(), file_) != buffer_.size()) {
    throw IoError(path_,
                  "cannot read frame " + std::to_string(frame) + ": " +
                      (std::feof(file_) ? "the file has become shorter" : std::generic_category().message(errno)));
  }
  positions.resize(static_cast<std::size_t>(points_));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = Vec3(buffer_[3 * i], buffer_[3 * i + 1], buffer_[3 * i + 2]);
  }
}

std::uint64_t Pc2Reader::frame_checksum() const { return checksum(buffer_.data(), buffer_.size() * sizeof(float)); }

}  // namespace toile::internal
