#include "core/state_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace toile::internal {
namespace {

enum class Mode : std::uint8_t { one, two };

struct Inner {
  double a = 0;
  std::vector<Index> list;
  template <class Archive>
  void remember(Archive& archive) {
    archive(a, list);
  }
};

struct Everything {
  bool yes = false;
  Mode mode = Mode::one;
  std::int64_t count = 0;
  Vec3 x{0, 0, 0};
  std::string text;
  std::optional<Vec3> maybe, none = Vec3(1, 1, 1);
  std::array<Inner, 2> pair;
  Vec3s many;
  std::vector<Inner> inner;
  template <class Archive>
  void remember(Archive& archive) {
    archive(yes, mode, count, x, text, maybe, none, pair, many, inner);
  }
};

Everything filled() {
  Everything e;
  e.yes = true;
  e.mode = Mode::two;
  e.count = -7;
  e.x = Vec3(-0.0, std::numeric_limits<double>::denorm_min(), 1e300);
  e.text = std::string("a\0b", 3);
  e.maybe = Vec3(1, 2, 3);
  e.none.reset();
  e.pair[1] = {std::nan("7"), {1, 2, 3}};
  e.many = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  e.inner.resize(3);
  e.inner[2].list = {9};
  return e;
}

std::string bytes_of(Everything e) {
  StateWriter writer;
  writer(e);
  return writer.take();
}

TEST(StateArchive, GivesBackEveryBit) {
  const std::string bytes = bytes_of(filled());
  Everything read;
  StateReader reader(bytes, "file");
  reader(read);
  reader.end();
  EXPECT_EQ(bytes_of(read), bytes);
  EXPECT_TRUE(std::signbit(read.x.x()));
  EXPECT_EQ(read.pair[1].list, (std::vector<Index>{1, 2, 3}));
  EXPECT_FALSE(read.none.has_value());
}

TEST(StateArchive, RefusesWhatEndsTooEarlyOrTooLate) {
  const std::string bytes = bytes_of(filled());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    Everything read;
    StateReader reader(std::string_view(bytes).substr(0, length), "file");
    EXPECT_THROW(reader(read), InputError) << length;
  }
  Everything read;
  const std::string longer = bytes + "x";
  StateReader reader(longer, "file");
  reader(read);
  EXPECT_THROW(reader.end(), InputError);
}

TEST(StateArchive, BelievesNoCount) {
  StateWriter writer;
  std::uint64_t huge_size = std::uint64_t{1} << 60;
  writer(huge_size);
  Vec3s many;
  std::vector<Inner> inner;
  std::string text;
  EXPECT_THROW(StateReader(writer.bytes(), "file")(many), InputError);
  EXPECT_THROW(StateReader(writer.bytes(), "file")(inner), InputError);
  EXPECT_THROW(StateReader(writer.bytes(), "file")(text), InputError);
}

TEST(StateArchive, KeepsTheLengthThatFollowsFromTheScene) {
  StateWriter writer;
  std::vector<double> three{1, 2, 3};
  writer.fixed(three);
  std::vector<double> same(3), other(4);
  StateReader(writer.bytes(), "file").fixed(same);
  EXPECT_EQ(same, three);
  EXPECT_THROW(StateReader(writer.bytes(), "file").fixed(other), InputError);
}

}  // namespace
}  // namespace toile::internal
