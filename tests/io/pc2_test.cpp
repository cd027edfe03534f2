#include "io/pc2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <string>

#include "io/scratch.hpp"

namespace toile::internal {
namespace {

Vec3s random_positions(std::uint64_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  Vec3s positions(count);
  for (Vec3& x : positions) {
    for (double& coordinate : x) coordinate = (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) * 4;
  }
  return positions;
}

// The bytes of a file, field by field.
struct Fields {
  std::string magic{"POINTCACHE2\0", 12};
  std::int32_t version = 1, points = 2;
  float start = 0, rate = 1;
  std::int32_t samples = 1;
  std::string data = std::string(24, '\0');

  std::string bytes() const {
    std::string text = magic;
    const auto add = [&](const auto& value) {
      char raw[4];
      std::memcpy(raw, &value, 4);
      text.append(raw, 4);
    };
    add(version), add(points), add(start), add(rate), add(samples);
    return text + data;
  }
};

std::string complaint(const std::string& bytes) {
  const Scratch scratch;
  const std::string path = scratch.put("a.pc2", bytes);
  const std::string message = message_of<InputError>([&] { Pc2Reader reader(path); });
  return message.substr(0, path.size()) == path ? message.substr(path.size()) : message;
}

TEST(Pc2, ReadsBackTheSameFloats) {
  const Scratch scratch;
  constexpr std::size_t points = 137;
  {
    Pc2Writer writer(scratch / "a.pc2", points, 1, 0.5);
    for (std::uint64_t f = 0; f < 5; ++f) writer.append(random_positions(f, points));
    EXPECT_EQ(writer.samples(), 5);
  }
  Pc2Reader reader(scratch / "a.pc2");
  EXPECT_EQ(reader.points(), 137);
  EXPECT_EQ(reader.samples(), 5);
  EXPECT_EQ(reader.start_frame(), 1);
  EXPECT_EQ(reader.rate(), 0.5);
  Vec3s positions;
  for (const int frame : {4, 0, 2, 2, 3, 1}) {  // in any order
    reader.read(frame, positions);
    const Vec3s expected = random_positions(static_cast<std::uint64_t>(frame), points);
    ASSERT_EQ(positions.size(), points);
    for (std::size_t i = 0; i < points; ++i) EXPECT_EQ(positions[i], expected[i].cast<float>().cast<double>());
  }
}

TEST(Pc2, IsWrittenByteForByteAsDocumented) {
  const Scratch scratch;
  Pc2Writer writer(scratch / "a.pc2", 1, 0, 1);
  writer.append(Vec3s{Vec3(1, -2, 0.5)});
  const std::string expected(
      "POINTCACHE2\0"
      "\1\0\0\0"
      "\1\0\0\0"
      "\0\0\0\0"
      "\0\0\x80\x3f"
      "\1\0\0\0"
      "\0\0\x80\x3f"
      "\0\0\0\xc0"
      "\0\0\0\x3f",
      44);
  EXPECT_EQ(scratch.get("a.pc2"), expected);
}

TEST(Pc2, IsCompleteAfterEveryFrame) {
  const Scratch scratch;
  Pc2Writer writer(scratch / "a.pc2", 3, 0, 1);
  for (std::uint64_t f = 0; f < 3; ++f) {
    EXPECT_EQ(Pc2Reader(scratch / "a.pc2").samples(), static_cast<int>(f));
    writer.append(random_positions(f, 3));
    Pc2Reader reader(scratch / "a.pc2");
    ASSERT_EQ(reader.samples(), static_cast<int>(f) + 1);
    Vec3s x;
    reader.read(static_cast<int>(f), x);
    EXPECT_EQ(reader.frame_checksum(), writer.frame_checksums().back());
    EXPECT_EQ(reader.header_checksum(), writer.header_checksum());
  }
}

TEST(Pc2, IsNotWrittenOverAFileOrThroughALink) {
  const Scratch scratch;
  scratch.put("a.pc2", "precious");
  std::filesystem::create_symlink(scratch / "a.pc2", scratch / "b.pc2");
  std::filesystem::create_symlink(scratch / "nowhere", scratch / "c.pc2");
  for (const char* name : {"a.pc2", "b.pc2", "c.pc2"})
    EXPECT_THROW(Pc2Writer(scratch / name, 1, 0, 1), IoError) << name;
  EXPECT_EQ(scratch.get("a.pc2"), "precious");
  EXPECT_FALSE(std::filesystem::exists(scratch / "nowhere"));
}

// What a writer that was killed may leave behind the frames that the header counts.
TEST(Pc2, GoesOnBehindTheFramesThatCount) {
  const Scratch scratch;
  std::string whole;
  {
    Pc2Writer writer(scratch / "whole.pc2", 5, 2, 0.5);
    for (std::uint64_t f = 0; f < 6; ++f) writer.append(random_positions(f, 5));
    whole = scratch.get("whole.pc2");
  }
  for (const std::size_t rest : {std::size_t{0}, std::size_t{7}, std::size_t{60}, std::size_t{100}}) {
    std::string cut = whole.substr(0, 32 + 4 * 60 + rest);
    cut[28] = 4;
    scratch.put("cut.pc2", cut);
    EXPECT_EQ(Pc2Reader(scratch / "cut.pc2", Pc2End::cut).samples(), 4);
    if (rest > 0) {
      EXPECT_THROW(Pc2Reader(scratch / "cut.pc2"), InputError);
    }
    const auto writer = Pc2Writer::resume(scratch / "cut.pc2", 5, 3);
    EXPECT_EQ(scratch.get("cut.pc2").size(), 32u + 3 * 60);
    for (std::uint64_t f = 3; f < 6; ++f) writer->append(random_positions(f, 5));
    EXPECT_EQ(scratch.get("cut.pc2"), whole);
    EXPECT_EQ(writer->frame_checksums().size(), 6u);
  }
  EXPECT_NE(message_of<InputError>([&] { Pc2Writer::resume(scratch / "whole.pc2", 5, 7); }).find("at least 7, got 6"),
            std::string::npos);
  EXPECT_THROW(Pc2Writer::resume(scratch / "whole.pc2", 4, 1), InputError);
}

TEST(Pc2, WithoutFramesOrPointsIsAFileToo) {
  const Scratch scratch;
  { Pc2Writer writer(scratch / "no_frames.pc2", 7, 0, 1); }
  Pc2Reader no_frames(scratch / "no_frames.pc2");
  EXPECT_EQ(no_frames.points(), 7);
  EXPECT_EQ(no_frames.samples(), 0);
  Vec3s positions;
  EXPECT_THROW(no_frames.read(0, positions), InputError);

  Pc2Writer writer(scratch / "no_points.pc2", 0, 0, 1);
  writer.append({});
  Pc2Reader no_points(scratch / "no_points.pc2");
  no_points.read(0, positions);
  EXPECT_TRUE(positions.empty());
}

TEST(Pc2, RefusesAFrameOfTheWrongLength) {
  const Scratch scratch;
  Pc2Writer writer(scratch / "a.pc2", 2, 0, 1);
  EXPECT_EQ(message_of<InputError>([&] { writer.append(Vec3s(3, Vec3::Zero())); }),
            scratch / "a.pc2" + ": frame 0: expected 2 positions, got 3");
}

TEST(Pc2, RefusesAFrameThatIsNotThere) {
  const Scratch scratch;
  Pc2Reader reader(scratch.put("a.pc2", Fields().bytes()));
  Vec3s positions;
  reader.read(0, positions);
  EXPECT_EQ(message_of<InputError>([&] { reader.read(1, positions); }),
            scratch / "a.pc2" + ": frame: expected a frame in 0..0, got 1");
  EXPECT_THROW(reader.read(-1, positions), InputError);
}

TEST(Pc2, KeepsANanForTheAudit) {
  const Scratch scratch;
  Pc2Writer writer(scratch / "a.pc2", 1, 0, 1);
  writer.append(Vec3s{Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0)});
  Vec3s positions;
  Pc2Reader(scratch / "a.pc2").read(0, positions);
  EXPECT_TRUE(std::isnan(positions[0].y()));
}

TEST(Pc2, NamesTheFieldOfABadHeader) {
  EXPECT_EQ(complaint(Fields().bytes()), "none");
  Fields fields;
  fields.magic[5] = 'X';
  EXPECT_EQ(complaint(fields.bytes()), ": header: expected \"POINTCACHE2\", got \"POINTXACHE2?\"");
  fields = {};
  fields.version = 2;
  EXPECT_EQ(complaint(fields.bytes()), ": version: expected 1, got 2");
  fields = {};
  fields.points = -2;
  EXPECT_EQ(complaint(fields.bytes()), ": points: expected a number >= 0, got -2");
  fields = {};
  fields.samples = std::numeric_limits<std::int32_t>::min();
  EXPECT_EQ(complaint(fields.bytes()), ": samples: expected a number >= 0, got -2147483648");
  fields = {};
  fields.rate = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(complaint(fields.bytes()).find(": rate: expected a finite rate"), std::string::npos);
}

TEST(Pc2, RefusesCountsThatTheFileDoesNotHold) {
  Fields fields;
  fields.samples = 2;
  EXPECT_EQ(complaint(fields.bytes()),
            ": size: expected 2 samples of 2 points, as the header says, got 24 bytes of data");
  fields = {};
  fields.points = fields.samples = std::numeric_limits<std::int32_t>::max();  // 5e19 bytes: more than 64 bits count
  EXPECT_NE(complaint(fields.bytes()), "none");
  fields = {};
  fields.points = 842443544;  // with 1824726041 samples 2^64 + 32 bytes, of which a product of 64 bits keeps the 32
  fields.samples = 1824726041;
  fields.data = std::string(32, '\0');
  EXPECT_NE(complaint(fields.bytes()), "none");
  fields = {};
  fields.points = 1 << 30;
  fields.samples = 1 << 30;
  EXPECT_NE(complaint(fields.bytes()), "none");
  fields = {};
  fields.data += "x";
  EXPECT_NE(complaint(fields.bytes()), "none");
  fields = {};
  fields.samples = 0;
  EXPECT_NE(complaint(fields.bytes()), "none");
  fields = {};
  fields.points = 0;
  EXPECT_NE(complaint(fields.bytes()), "none");
}

TEST(Pc2, RefusesAFileCutAnywhere) {
  const std::string bytes = Fields().bytes();
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) EXPECT_NE(complaint(bytes.substr(0, cut)), "none") << cut;
}

TEST(Pc2, ReportsAFileThatBecameShorter) {
  const Scratch scratch;
  Pc2Reader reader(scratch.put("a.pc2", Fields().bytes()));
  std::filesystem::resize_file(scratch / "a.pc2", 40);
  Vec3s positions;
  EXPECT_EQ(message_of<IoError>([&] { reader.read(0, positions); }),
            scratch / "a.pc2" + ": cannot read frame 0: the file has become shorter");
}

TEST(Pc2, NamesAFileThatIsNotThere) {
  const Scratch scratch;
  EXPECT_EQ(message_of<IoError>([&] { Pc2Reader reader(scratch / "none.pc2"); }),
            scratch / "none.pc2" + ": cannot open: No such file or directory");
}

}  // namespace
}  // namespace toile::internal
