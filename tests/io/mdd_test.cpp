#include "io/mdd.hpp"

#include "core/error.hpp"
#include "io/scratch.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>

namespace toile::internal {
namespace {

TEST(Mdd, HasTheBytesOfTheFormat) {
  const Scratch scratch;
  const std::string path = scratch / "a.mdd";
  MddWriter writer(path, 1, 2, 4);
  writer.append(Vec3s{Vec3(1, -2, 0.5)});
  EXPECT_FALSE(std::filesystem::exists(path));
  writer.append(Vec3s{Vec3(0, 0, 0)});
  writer.commit();
  std::string expected("\0\0\0\2\0\0\0\1\0\0\0\0\x3e\x80\0\0\x3f\x80\0\0\xc0\0\0\0\x3f\0\0\0", 28);
  expected += std::string(12, '\0');
  EXPECT_EQ(read_file(path), expected);
}

TEST(Mdd, IsReadBackTheSame) {
  const Scratch scratch;
  const std::string path = scratch / "a.mdd";
  const std::vector<Vec3s> frames = {{Vec3(0.25, 1.5, -3), Vec3(4, 5, 6)}, {Vec3(7, 8, 9), Vec3(-1, 0, 1e-3F)}};
  MddWriter writer(path, 2, 2, 25);
  for (const Vec3s& frame : frames) writer.append(frame);
  writer.commit();
  const MddReader reader(path);
  EXPECT_EQ(reader.points(), 2);
  EXPECT_EQ(reader.samples(), 2);
  EXPECT_NEAR(reader.time_s(1), 0.04, 1e-9);
  Vec3s x;
  for (int frame = 0; frame < 2; ++frame) {
    reader.read(frame, x);
    EXPECT_EQ(x, frames[at(frame)]);
  }
}

TEST(Mdd, RefusesWhatIsNotThere) {
  const Scratch scratch;
  const auto complaint = [&](const std::string& bytes) {
    const std::string path = scratch.put("b.mdd", bytes);
    return message_of<InputError>([&] { MddReader reader(path); });
  };
  EXPECT_NE(complaint("1234").find("header: expected 8 bytes"), std::string::npos);
  EXPECT_NE(complaint(std::string("\0\0\0\0\0\0\0\1", 8)).find("at least one frame"), std::string::npos);
  EXPECT_NE(complaint("\xff\xff\xff\xff\xff\xff\xff\xff").find("below 2^31"), std::string::npos);
  EXPECT_NE(complaint("\x7f\xff\xff\xfe\x7f\xff\xff\xfe").find("size: expected"), std::string::npos);
  EXPECT_NE(complaint(std::string("\0\0\0\1\0\0\0\1xxxxxxxxxxxxxxx", 23)).find("expected 24 bytes"), std::string::npos);
  MddWriter writer(scratch / "c.mdd", 2, 1, 30);
  EXPECT_THROW(writer.append(Vec3s{Vec3(0, 0, 0)}), InputError);
  EXPECT_THROW(writer.append(Vec3s(2, Vec3::Constant(std::numeric_limits<double>::max()))), InputError);
  EXPECT_THROW(writer.commit(), InputError);
}

}  // namespace
}  // namespace toile::internal
