#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

#include "core/error.hpp"
#include "io/scratch.hpp"
#include "preview/preview.hpp"
#include "support/message_of.hpp"

namespace toile::internal {
namespace {

// While it lives, PATH is something else.
class Path {
 public:
  explicit Path(const std::string& value) : before_(std::getenv("PATH") ? std::getenv("PATH") : "") {
    ::setenv("PATH", value.c_str(), 1);
  }
  ~Path() { ::setenv("PATH", before_.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string before_;
};

// Standard output of a command line of this test's own making, empty when it fails.
std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), got);
  return ::pclose(pipe) == 0 ? text : "";
}

bool have(const std::string& program) { return !output_of("command -v " + program).empty(); }

// A grey that rises from picture to picture.
Image grey(int i, int width = 64, int height = 48) {
  return {
      width, height,
      std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), static_cast<std::uint8_t>(40 + 10 * i))};
}

// A program `ffmpeg` of our own in the test's folder.
void fake_ffmpeg(const Scratch& scratch, const std::string& script) {
  scratch.put("ffmpeg", "#!/bin/sh\n" + script);
  std::filesystem::permissions(scratch / "ffmpeg", std::filesystem::perms::owner_all);
}

using toile::test::message_of;

TEST(Film, HoldsEveryPictureInOrder) {
  if (!have("ffmpeg") || !have("ffprobe")) GTEST_SKIP() << "needs ffmpeg and ffprobe in PATH";
  const Scratch scratch;
  int calls = 0;
  write_mp4(scratch / "a film.mp4", 17, 24, [&](int i) {
    EXPECT_EQ(i, calls++);
    return grey(i);
  });
  EXPECT_EQ(calls, 17);
  EXPECT_EQ(scratch.file_count(), 1u);  // no temporary file stays
  const std::string name = "'" + scratch / "a film.mp4" + "'";
  const std::string probe = output_of(
      "ffprobe -v error -count_frames -select_streams v:0 -of csv=p=0 -show_entries "
      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames " +
      name);
  EXPECT_EQ(probe, "h264,64,48,yuv420p,24/1,17\n");
  const std::string raw = output_of("ffmpeg -v error -i " + name + " -f rawvideo -pix_fmt gray pipe:1");
  ASSERT_EQ(raw.size(), 17u * 64 * 48);
  for (std::size_t i = 0; i < 17; ++i) {
    const int value = static_cast<unsigned char>(raw[i * 64 * 48 + 1000]);
    EXPECT_NEAR(value, 40 + 10 * static_cast<int>(i), 4) << i;
  }
}

TEST(Film, IsTheSameFileForTheSamePictures) {
  if (!have("ffmpeg")) GTEST_SKIP() << "needs ffmpeg in PATH";
  const Scratch scratch;
  for (const char* name : {"a.mp4", "b.mp4"}) write_mp4(scratch / name, 5, 30, [](int i) { return grey(i); });
  EXPECT_EQ(scratch.get("a.mp4"), scratch.get("b.mp4"));
}

TEST(Film, CutsOddSizesToEvenOnes) {
  if (!have("ffmpeg") || !have("ffprobe")) GTEST_SKIP() << "needs ffmpeg and ffprobe in PATH";
  const Scratch scratch;
  write_mp4(scratch / "a.mp4", 2, 30, [](int i) { return grey(i, 65, 47); });
  EXPECT_EQ(output_of("ffprobe -v error -of csv=p=0 -show_entries stream=width,height '" + scratch / "a.mp4" + "'"),
            "64,46\n");
}

TEST(Film, SaysHowToGetFfmpegWhenItIsNotThereAndDrawsNoPicture) {
  const Scratch scratch;
  for (const std::string& path : {std::string(), scratch.directory()}) {
    const Path empty(path);
    const std::string message = message_of<IoError>([&] {
      write_mp4(scratch / "a.mp4", 3, 30, [](int) -> Image {
        ADD_FAILURE() << "a picture was asked for";
        return grey(0);
      });
    });
    EXPECT_NE(message.find("ffmpeg"), std::string::npos) << message;
    EXPECT_NE(message.find("install"), std::string::npos) << message;
  }
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(Film, APictureThatThrowsEndsTheFilmAndLeavesNoFile) {
  if (!have("ffmpeg")) GTEST_SKIP() << "needs ffmpeg in PATH";
  const Scratch scratch;
  EXPECT_THROW(write_mp4(scratch / "a.mp4", 20, 30,
                         [](int i) {
                           if (i == 12) throw std::runtime_error("no more");
                           return grey(i, 320, 240);
                         }),
               std::runtime_error);
  EXPECT_EQ(scratch.file_count(), 0u);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);  // and no child
}

TEST(Film, KeepsTheOlderFilmWhenTheNewOneFails) {
  if (!have("ffmpeg")) GTEST_SKIP() << "needs ffmpeg in PATH";
  const Scratch scratch;
  scratch.put("a.mp4", "older");
  EXPECT_THROW(write_mp4(scratch / "a.mp4", 3, 30, [](int i) { return i < 2 ? grey(i) : grey(i, 10, 10); }),
               InputError);
  EXPECT_EQ(scratch.get("a.mp4"), "older");
  EXPECT_EQ(scratch.file_count(), 1u);
}

// Were SIGPIPE delivered, the test program would end here.
TEST(Film, PassesOnTheLastLineOfAnEncoderThatDies) {
  const Scratch scratch;
  fake_ffmpeg(scratch, "echo 'first trouble' >&2\necho 'disk is on fire' >&2\nexit 3\n");
  const Path path(scratch.directory());
  const std::string message =
      message_of<IoError>([&] { write_mp4(scratch / "a.mp4", 50, 30, [](int i) { return grey(i % 20, 640, 480); }); });
  EXPECT_NE(message.find("a.mp4"), std::string::npos) << message;
  EXPECT_NE(message.find("disk is on fire"), std::string::npos) << message;
  EXPECT_EQ(message.find("first trouble"), std::string::npos) << message;
  EXPECT_EQ(scratch.file_count(), 1u);  // the program alone
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Film, DoesNotWaitForeverForAnEncoderThatTalksALot) {
  const Scratch scratch;
  const std::string film = scratch / "a.mp4";
  // 200 kB of messages before the first picture is read, more than a pipe holds.
  fake_ffmpeg(scratch,
              "t='a line of messages that is fifty characters long.'\n"
              "for i in 1 2 3 4 5 6 7 8 9 10 11 12; do t=$t$t; done\n"
              "echo \"$t\" >&2\necho 'fifty of them' >&2\nread x\nexit 1\n");
  const Path path(scratch.directory());
  EXPECT_NE(message_of<IoError>([&] {
              write_mp4(film, 20, 30, [](int i) { return grey(i, 320, 240); });
            }).find("fifty of them"),
            std::string::npos);
}

TEST(Film, AnEncoderThatIsKilledIsAFailure) {
  const Scratch scratch;
  const std::string film = scratch / "a.mp4";
  fake_ffmpeg(scratch, "kill -9 $$\n");
  const Path path(scratch.directory());
  EXPECT_NE(message_of<IoError>([&] { write_mp4(film, 2, 30, [](int i) { return grey(i); }); }).find("signal 9"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(film));
}

TEST(Film, AFolderThatIsNotThereIsToldBeforeTheFirstPicture) {
  if (!have("ffmpeg")) GTEST_SKIP() << "needs ffmpeg in PATH";
  const Scratch scratch;
  const std::string message = message_of<IoError>([&] {
    write_mp4(scratch / "missing/a.mp4", 3, 30, [](int i) {
      ADD_FAILURE() << "a picture was asked for";
      return grey(i);
    });
  });
  EXPECT_NE(message.find("missing/a.mp4"), std::string::npos) << message;
  EXPECT_NE(message.find("No such file"), std::string::npos) << message;
}

TEST(Film, RefusesCountsRatesAndPicturesThatMakeNoFilm) {
  const Scratch scratch;
  const auto picture = [](int i) { return grey(i); };
  EXPECT_THROW(write_mp4(scratch / "a.mp4", 0, 30, picture), InputError);
  EXPECT_THROW(write_mp4(scratch / "a.mp4", 3, 0, picture), InputError);
  EXPECT_THROW(write_mp4(scratch / "a.mp4", 3, std::nan(""), picture), InputError);
  if (have("ffmpeg")) {
    EXPECT_THROW(write_mp4(scratch / "a.mp4", 3, 30, [](int) { return Image{}; }), InputError);
  }
  EXPECT_EQ(scratch.file_count(), 0u);
}

}  // namespace
}  // namespace toile::internal
