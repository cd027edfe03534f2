// The folder of a run, as a hostile and as an unlucky user meet it.
#include "cli/program.hpp"
#include "io/json.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <thread>

namespace toile::internal {
namespace {

using test::Ended;
using test::run_toile;

// Two layers that fall on a cylinder, for a second of wall time or so.
constexpr const char* scene = R"({"cloth": [
  {"name": "a", "grid": {"width_m": 0.5, "height_m": 0.5, "edge_m": 0.03}, "placement": {"translation_m": [0, 0.21, 0], "rotation_deg": [-90, 0, 0]}},
  {"name": "b", "grid": {"width_m": 0.4, "height_m": 0.4, "edge_m": 0.03}, "placement": {"translation_m": [0.02, 0.24, 0], "rotation_deg": [-90, 20, 0]}}],
  "body": {"cylinder": {"radius_m": 0.1, "height_m": 0.4, "top_m": [0, 0.2, 0]}}, "time": {"seconds": 2}})";

void wait_until(const std::function<bool()>& done) {
  for (int k = 0; k < 600 && !done(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

std::map<std::string, std::string> files_of(const Scratch& scratch, const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / folder))
    files[entry.path().filename().string()] = scratch.get(folder + '/' + entry.path().filename().string());
  files["report.json"] = Json::parse(files["report.json"], "report").at("state_hash").string();
  return files;
}

TEST(Folder, ARunThatIsKilledAnywhereGoesOnToTheSameBits) {
  const Scratch scratch;
  scratch.put("s.json", scene);
  ASSERT_EQ(run_toile(scratch, {"run", "s.json", "--out", "whole", "--quiet"}).exit_code, 0);
  const auto whole = files_of(scratch, "whole");
  std::mt19937 random(7);
  for (int k = 0; k < 10; ++k) {
    SCOPED_TRACE(k);
    const auto frames = static_cast<std::size_t>(random() % 55);
    const std::string folder = std::string("killed-").append(std::to_string(k)), cache = folder + "/cloth.pc2";
    std::vector<std::string> words{"run", "s.json", "--out", folder};
    if (k % 2 == 0) words.insert(words.end(), {"--checkpoint-frames", "4"});
    const std::size_t frame_bytes = (whole.at("cloth.pc2").size() - 32) / 60;
    const Ended killed = run_toile(scratch, words, [&](pid_t child) {
      wait_until([&] {
        std::error_code none;
        const auto size = std::filesystem::file_size(scratch / cache, none);
        return !none && size >= 32 + frames * frame_bytes;
      });
      kill(child, SIGKILL);
    });
    if (killed.signal == 0) continue;  // it was faster
    const Ended judged = run_toile(scratch, {"verify", folder});
    EXPECT_EQ(judged.exit_code, 5);
    EXPECT_NE(judged.err.find("unfinished: interrupted at frame"), std::string::npos) << judged.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / (folder + "/report.json")));
    const Ended resumed = run_toile(scratch, {"resume", folder, "--quiet"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(files_of(scratch, folder), whole);
    EXPECT_EQ(run_toile(scratch, {"verify", folder, "--quiet"}).exit_code, 0);
    EXPECT_EQ(run_toile(scratch, {"resume", folder}).exit_code, 6) << "it is finished";
  }
}

TEST(Folder, HasOneWriterAtATime) {
  const Scratch scratch;
  scratch.put("s.json",
              R"({"cloth": [{"grid": {"edge_m": 0.03}, "pins": [{"near_m": [0, 0, 0]}]}], "time": {"seconds": 600}})");
  const Ended first = run_toile(scratch, {"run", "s.json", "--out", "a"}, [&](pid_t child) {
    wait_until([&] { return std::filesystem::exists(scratch / "a/cloth.pc2"); });
    for (const char* command : {"run", "resume", "preview"}) {
      std::vector<std::string> words{command, command == std::string("run") ? "s.json" : "a"};
      if (command == std::string("run")) words.insert(words.end(), {"--out", "a"});
      const std::string out = scratch / "second.txt";
      const Ended second = run_toile(scratch, words);
      EXPECT_EQ(second.exit_code, 6) << command;
      EXPECT_NE(second.err.find("process " + std::to_string(child)), std::string::npos) << second.err;
    }
    const Ended judged = run_toile(scratch, {"verify", "a"});
    EXPECT_EQ(judged.exit_code, 5);
    EXPECT_NE(judged.err.find("still goes on"), std::string::npos) << judged.err;
    kill(child, SIGKILL);
  });
  EXPECT_EQ(first.signal, SIGKILL);
  scratch.put("s.json", scene);
  EXPECT_EQ(run_toile(scratch, {"run", "s.json", "--out", "a", "--seconds", "0.1", "--quiet"}).exit_code, 0)
      << "the lock of a dead process is nobody's";
}

TEST(Folder, LeavesTheUsersFilesAlone) {
  const Scratch scratch;
  scratch.put("s.json", scene);
  scratch.put("body.obj", "precious");
  const Ended stranger = run_toile(scratch, {"run", "s.json", "--out", ".", "--seconds", "0.1"});
  EXPECT_EQ(stranger.exit_code, 6);
  EXPECT_NE(stranger.err.find("body.obj"), std::string::npos) << stranger.err;
  EXPECT_EQ(scratch.get("body.obj"), "precious");
  for (const char* dir : {"/tmp", "../elsewhere", "link/there"}) {
    std::filesystem::create_directory_symlink(scratch / "..", scratch / "link");
    std::string with_output = scene;
    with_output.insert(1, R"("output": {"dir": ")" + std::string(dir) + "\"}, ");
    scratch.put("o.json", with_output);
    for (const char* command : {"run", "check"}) {
      const Ended ended = run_toile(scratch, {command, "o.json"});
      EXPECT_EQ(ended.exit_code, 3) << dir;
      EXPECT_NE(ended.err.find("/output/dir"), std::string::npos) << ended.err;
    }
    EXPECT_EQ(run_toile(scratch, {"run", "o.json", "--out", "b", "--seconds", "0.05", "--quiet"}).exit_code, 0);
    std::filesystem::remove(scratch / "link");
  }
  EXPECT_EQ(run_toile(scratch, {"run", "s.json", "--out", "b", "--start", "b"}).exit_code, 6);
  EXPECT_TRUE(std::filesystem::exists(scratch / "b/report.json"));
}

TEST(Folder, VerifySaysWhenTheInputsAreOthersNow) {
  const Scratch scratch;
  scratch.put("in/s.json", scene);
  ASSERT_EQ(run_toile(scratch, {"run", "in/s.json", "--out", "deep/a", "--seconds", "0.2", "--quiet"}).exit_code, 0);
  std::filesystem::rename(scratch / "deep", scratch / "other");  // as far from each other as before
  const auto verify = [&] { return run_toile(scratch, {"verify", "other/a"}); };
  EXPECT_EQ(verify().out.find("reservations"), std::string::npos);
  EXPECT_NE(verify().out.find("files that it read: 1, 0 of them changed since, 0 no longer there"), std::string::npos);
  scratch.put("in/s.json", std::string(scene) + " ");
  const Ended changed = verify();
  EXPECT_EQ(changed.exit_code, 0);
  EXPECT_NE(changed.out.find("pass, with reservations: inputs_changed"), std::string::npos) << changed.out;
  EXPECT_NE(changed.out.find("in/s.json"), std::string::npos) << changed.out;
  std::filesystem::remove(scratch / "in/s.json");
  EXPECT_NE(verify().out.find("1 no longer there"), std::string::npos);
}

TEST(Folder, AFileThatIsReadTwiceIsOneInput) {
  const Scratch scratch;
  scratch.put("box.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
              "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  scratch.put("s.json", R"({"cloth": [{"grid": {"edge_m": 0.1}}], "time": {"seconds": 0.1},
      "solids": [{"mesh": "box.obj", "placement": {"translation_m": [3, 0, 0]}},
                 {"mesh": "box.obj", "placement": {"translation_m": [-3, 0, 0]}}]})");
  run_toile(scratch, {"run", "s.json", "--out", "a", "--quiet"});
  const Ended judged = run_toile(scratch, {"verify", "a"});
  EXPECT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_NE(judged.out.find("files that it read: 2, 0 of them changed"), std::string::npos) << judged.out;
}

TEST(Folder, EveryFlippedBitIsNoticed) {
  const Scratch scratch;
  scratch.put("s.json", scene);
  ASSERT_EQ(run_toile(scratch, {"run", "s.json", "--out", "a", "--seconds", "0.2", "--quiet"}).exit_code, 0);
  ASSERT_EQ(run_toile(scratch, {"verify", "a", "--quiet"}).exit_code, 0);
  std::mt19937 random(3);
  for (const char* name : {"a/cloth.pc2", "a/body.pc2", "a/report.json", "a/cloth.obj", "a/body.obj"}) {
    const std::string bytes = scratch.get(name);
    for (int k = 0; k < 12; ++k) {
      std::string changed = bytes;
      const std::size_t at = k < 4 ? random() % 32 : random() % changed.size();
      changed[at] = static_cast<char>(changed[at] ^ (1 << random() % 8));
      scratch.put(name, changed);
      const Ended ended = run_toile(scratch, {"verify", "a", "--quiet"});
      EXPECT_TRUE(ended.exit_code == 5 || ended.exit_code == 3) << name << " byte " << at << ": " << ended.exit_code;
      EXPECT_EQ(ended.err_lines(), 1) << ended.err;
    }
    scratch.put(name, bytes);
  }
  const std::string cache = scratch.get("a/cloth.pc2");
  const std::size_t frame = (cache.size() - 32) / 6;
  std::string swapped = cache, zeros = cache;
  std::swap_ranges(swapped.begin() + 32, swapped.begin() + 32 + static_cast<std::ptrdiff_t>(frame),
                   swapped.begin() + 32 + static_cast<std::ptrdiff_t>(3 * frame));
  std::fill_n(zeros.begin() + 32 + static_cast<std::ptrdiff_t>(2 * frame), frame, '\0');
  for (const std::string& changed : {zeros, swapped}) {
    scratch.put("a/cloth.pc2", changed);
    EXPECT_NE(run_toile(scratch, {"verify", "a", "--quiet"}).exit_code, 0);
  }
}

// The nearest thing to a full disk that needs no superuser: no file may grow beyond a limit.
TEST(Folder, ADiskThatIsFullLosesNothing) {
  const Scratch scratch;
  scratch.put("s.json", scene);
  ASSERT_EQ(run_toile(scratch, {"run", "s.json", "--out", "whole", "--quiet"}).exit_code, 0);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limited{250'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limited);
  std::signal(SIGXFSZ, SIG_DFL);  // as a shell starts a program
  const Ended full = run_toile(scratch, {"run", "s.json", "--out", "a", "--checkpoint-frames", "1"});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(full.signal, 0);
  EXPECT_EQ(full.exit_code, 6) << full.err;
  EXPECT_NE(full.err.find("frames are kept"), std::string::npos) << full.err;
  EXPECT_EQ(run_toile(scratch, {"verify", "a", "--quiet"}).exit_code, 5);
  EXPECT_EQ(run_toile(scratch, {"resume", "a", "--quiet"}).exit_code, 0);
  EXPECT_EQ(files_of(scratch, "a"), files_of(scratch, "whole"));
}

}  // namespace
}  // namespace toile::internal
