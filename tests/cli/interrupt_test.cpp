// Signals, refused memory and refused threads: the program ends by an exit code, soon.
#include "cli/program.hpp"
#include "io/json.hpp"
#include "support/paths.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace toile::internal {
namespace {

using namespace std::chrono_literals;
using test::Ended;
using test::run_toile;

constexpr auto far_too_long =
    30s;  // none of these commands would have ended by itself; what is promised, a second, is measured where no other work is

// A sheet of 130,000 particles: steps take a second.
const char* const large_sheet =
    R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.003}}], "time": {"seconds": 10}})";

// Checks it so often that it takes some seconds.
std::vector<std::string> long_check() {
  std::vector<std::string> words(40, "large.json");
  words.insert(words.begin(), {"check", "--json"});
  return words;
}

struct Stopped {
  Ended ended;
  std::chrono::duration<double> took{0};
};

// Sends the signals `apart` from each other, the first `after` the start.
Stopped stop_toile(const Scratch& scratch, const std::vector<std::string>& words, std::chrono::milliseconds after,
                   const std::vector<int>& signals, std::chrono::milliseconds apart = 100ms) {
  std::chrono::steady_clock::time_point sent;
  Stopped stopped;
  std::signal(SIGHUP, SIG_DFL);  // one that is ignored, as under nohup, is left so by the program
  stopped.ended = run_toile(scratch, words, [&](pid_t child) {
    std::this_thread::sleep_for(after);
    sent = std::chrono::steady_clock::now();
    for (std::size_t k = 0; k < signals.size(); ++k) {
      if (k > 0) std::this_thread::sleep_for(apart);
      kill(child, signals[k]);
    }
  });
  stopped.took = std::chrono::steady_clock::now() - sent;
  return stopped;
}

void expect_interrupted(const Stopped& stopped, const std::string& what) {
  EXPECT_EQ(stopped.ended.signal, 0) << what;
  EXPECT_EQ(stopped.ended.exit_code, 8) << what << ": " << stopped.ended.err;
  EXPECT_LT(stopped.took, far_too_long) << what;
  EXPECT_EQ(stopped.ended.err_lines(), 1) << what << ": " << stopped.ended.err;
  EXPECT_NE(stopped.ended.err.find("interrupted"), std::string::npos) << what << ": " << stopped.ended.err;
}

TEST(Interrupt, IsHeardInEveryPhase) {
  const Scratch scratch;
  scratch.put("large.json", large_sheet);
  const std::string tshirt = test::source_path("patterns/tshirt.json");
  const struct {
    const char* what;
    std::vector<std::string> words;
    std::chrono::milliseconds after;
  } phases[] = {
      {"the body is made", {"dress", tshirt, "--body", "woman", "--no-preview", "--out", "a"}, 300ms},
      {"sewing", {"dress", tshirt, "--body", "woman", "--no-preview", "--out", "a"}, 3000ms},
      {"a fine mesh",
       {"dress", tshirt, "--body", "woman", "--resolution", "0.15", "--no-preview", "--out", "a"},
       1500ms},
      {"a large sheet is made", {"run", "large.json", "--out", "b"}, 400ms},
      {"its steps", {"run", "large.json", "--out", "b"}, 6000ms},
      {"check", long_check(), 500ms},
      {"bench paper", {"bench", "paper"}, 1500ms},
      {"bench micro", {"bench", "micro", "--repeat", "1000"}, 1500ms},
  };
  for (const auto& phase : phases)
    expect_interrupted(stop_toile(scratch, phase.words, phase.after, {SIGINT}), phase.what);
}

TEST(Interrupt, EverySignalThatAsksForAnEndIsAnswered) {
  const Scratch scratch;
  scratch.put("large.json", large_sheet);
  for (const int signal : {SIGTERM, SIGHUP, SIGXCPU})
    expect_interrupted(stop_toile(scratch, {"run", "large.json", "--out", "a"}, 1000ms, {signal}), strsignal(signal));
  // The system sends SIGXCPU every second, and a terminal that is closed SIGHUP twice: nobody is impatient.
  scratch.put("s.json",
              R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.02}}], "time": {"seconds": 300}})");
  for (const int signal : {SIGHUP, SIGXCPU}) {
    const Stopped stopped = stop_toile(scratch, {"run", "s.json", "--out", "s"}, 1500ms, {signal, signal}, 0ms);
    expect_interrupted(stopped, strsignal(signal));
    EXPECT_TRUE(std::filesystem::exists(scratch / "s/report.json")) << strsignal(signal);
  }
}

TEST(Interrupt, ASecondOneEndsAtOnce) {
  const Scratch scratch;
  scratch.put("large.json", large_sheet);
  for (const int signal : {SIGINT, SIGTERM}) {
    const Stopped stopped = stop_toile(scratch, long_check(), 500ms, {signal, signal});
    expect_interrupted(stopped, strsignal(signal));
    EXPECT_NE(stopped.ended.err.find("interrupted at once"), std::string::npos)
        << "by the deadline: " << stopped.ended.err;
    EXPECT_EQ(Json::parse(stopped.ended.out, "stdout").at("exit_code").integer(), 8);
  }
}

TEST(Interrupt, EndsVerifyAndThePreviewWithItsEncoder) {
  const Scratch scratch;
  scratch.put("s.json", R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.012},
      "pins": [{"near_m": [-0.5, 0.5, 0]}]}], "time": {"fps": 60, "seconds": 2}})");
  ASSERT_EQ(run_toile(scratch, {"run", "s.json", "--out", "a"}).signal, 0);
  expect_interrupted(stop_toile(scratch, {"preview", "a"}, 300ms, {SIGINT}), "preview.png");
  // The film begins when its temporary file is there.
  Stopped stopped;
  std::chrono::steady_clock::time_point sent;
  stopped.ended = run_toile(scratch, {"preview", "a"}, [&](pid_t child) {
    for (int k = 0; k < 600 && !std::filesystem::exists(scratch / "a/preview.png"); ++k)
      std::this_thread::sleep_for(100ms);
    std::this_thread::sleep_for(1s);
    sent = std::chrono::steady_clock::now();
    kill(child, SIGINT);
  });
  stopped.took = std::chrono::steady_clock::now() - sent;
  expect_interrupted(stopped, "the film");
  EXPECT_FALSE(std::filesystem::exists(scratch / "a/preview.mp4"));
}

// The program under a limit of its address space.
Ended run_within(const Scratch& scratch, std::vector<std::string> words, std::size_t bytes) {
  words.insert(words.begin(),
               {"-c", "ulimit -v " + std::to_string(bytes >> 10) + "; exec \"$0\" \"$@\"", TOILE_PROGRAM});
  return test::run_program(scratch, "/bin/sh", std::move(words), [](pid_t) {});
}

TEST(RefusedMemory, EndsWithExitCodeSevenAtEverySize) {
  const Scratch scratch;
  scratch.put("s.json",
              R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.009}}], "time": {"seconds": 0.1}})");
  int refused = 0;
  for (std::size_t mb = 60; mb <= 180; mb += 10) {
    const Ended ended =
        run_within(scratch, {"run", "s.json", "--out", "a", "--quiet", "--max-memory", "100000"}, mb << 20);
    EXPECT_EQ(ended.signal, 0) << mb << " MB";
    EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 7) << mb << " MB: " << ended.exit_code << ' ' << ended.err;
    if (ended.exit_code == 7) {
      ++refused;
      EXPECT_NE(ended.err.find("out of memory"), std::string::npos) << ended.err;
      EXPECT_EQ(ended.err_lines(), 1) << ended.err;
    }
  }
  EXPECT_GT(refused, 2) << "the limits are where the memory is needed";
}

TEST(RefusedThreads, AreFewerAndAWarning) {
  const Scratch scratch;
  scratch.put("s.json",
              R"({"cloth": [{"grid": {"width_m": 0.3, "height_m": 0.3, "edge_m": 0.05}}], "time": {"seconds": 0.2}})");
  const Ended many = run_toile(scratch, {"run", "s.json", "--out", "a", "--threads", "500", "--json"});
  EXPECT_EQ(many.exit_code, 0) << many.err;
  EXPECT_NE(many.err.find("warning: --threads 500: there are"), std::string::npos) << many.err;
  EXPECT_LT(Json::parse(many.out, "stdout").at("threads").integer(), 500);
  EXPECT_EQ(run_toile(scratch, {"run", "s.json", "--out", "a", "--threads", "500", "--quiet"}).err, "");
  const Ended little =
      run_within(scratch, {"run", "s.json", "--out", "b", "--threads", "500"}, std::size_t{200000} << 10);
  EXPECT_EQ(little.signal, 0);
  EXPECT_EQ(little.exit_code, 0) << little.err;
}

}  // namespace
}  // namespace toile::internal
