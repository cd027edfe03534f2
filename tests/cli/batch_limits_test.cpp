// Batches whose processes, or who themselves, come to a bad end.
#include "cli/batches.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

namespace toile::internal {
namespace {

using namespace test;

constexpr const char* jobs = R"({"id": "long", "run": "draping.json", "checkpoint-frames": 4}
{"id": "short", "run": "falling.json"}
{"id": "other", "run": "draping.json", "fabric": "silk", "checkpoint-frames": 4}
{"id": "torn", "run": "torn.json"}
)";

void put_jobs(const Scratch& scratch, const std::string& text = jobs) {
  scratch.put("falling.json", falling);
  scratch.put("torn.json", torn);
  scratch.put("draping.json", draping);
  scratch.put("endless.json", endless);
  scratch.put("jobs.jsonl", text);
}

template <class During>
Ended run_batch(const Scratch& scratch, During&& during, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"batch", "jobs.jsonl", "--out", "b", "--jobs", "2"});
  return run_toile(scratch, std::move(more), during);
}
Ended run_batch(const Scratch& scratch, std::vector<std::string> more = {}) {
  return run_batch(
      scratch, [](pid_t) {}, std::move(more));
}

std::map<std::string, std::string> verdicts_of_a_whole_batch(const Scratch& scratch) {
  EXPECT_EQ(run_toile(scratch, {"batch", "jobs.jsonl", "--out", "whole", "--quiet"}).exit_code, 5);
  return verdicts_of(scratch, "whole").lasting;
}

// Waits for a checkpoint of the run, and some frames.
bool is_under_way(const Scratch& scratch, const std::string& run) {
  return wait_until([&] {
    return std::filesystem::exists(scratch / (run + "/checkpoint.bin")) &&
           scratch.get(run + "/cloth.pc2").size() > 100'000;
  });
}

bool was_begun_anew(const Scratch& scratch, const std::string& run) {
  return scratch.get(run + "/report.json").find("it is replaced") != std::string::npos;
}

TEST(BatchEnds, AKilledProcessLosesItsJobAlone) {
  const Scratch scratch;
  put_jobs(scratch);
  const Ended ended = run_batch(scratch, [&](pid_t) {
    ASSERT_TRUE(is_under_way(scratch, "b/runs/long"));
    kill(process_of(scratch, "b/runs/long"), SIGKILL);
  });
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_NE(ended.err.find("long: error: killed: its process was ended by signal 9"), std::string::npos) << ended.err;
  const Verdicts verdicts = verdicts_of(scratch, "b");
  EXPECT_EQ(verdicts.ids.size(), 4u);
  EXPECT_EQ(verdicts.of.at("long").at("verdict").string(), "error");
  EXPECT_EQ(verdicts.of.at("other").at("verdict").string(), "pass");
  // Started again, it goes on where that process was, to the same bits.
  EXPECT_EQ(run_batch(scratch).exit_code, 5);
  EXPECT_EQ(verdicts_of(scratch, "b").lasting, verdicts_of_a_whole_batch(scratch));
  EXPECT_FALSE(was_begun_anew(scratch, "b/runs/long"));
}

TEST(BatchEnds, ABatchThatIsKilledTakesItsProcessesAlongAndGoesOn) {
  const Scratch scratch;
  put_jobs(scratch);
  std::vector<pid_t> workers;
  const Ended killed = run_batch(scratch, [&](pid_t batch) {
    ASSERT_TRUE(is_under_way(scratch, "b/runs/other"));
    workers = children_of(batch);
    kill(batch, SIGKILL);
  });
  EXPECT_EQ(killed.signal, SIGKILL);
  EXPECT_FALSE(workers.empty());
  for (const pid_t worker : workers) EXPECT_TRUE(wait_until([&] { return !lives(worker); }));
  const Ended again = run_batch(scratch, {"--json"});
  EXPECT_EQ(again.exit_code, 5) << again.err;
  EXPECT_GE(Json::parse(again.out, "stdout").at("done_before").integer(), 1) << "the short one at least";
  EXPECT_EQ(verdicts_of(scratch, "b").lasting, verdicts_of_a_whole_batch(scratch));
}

TEST(BatchEnds, AnInterruptStopsAllOfItInOrder) {
  const Scratch scratch;
  put_jobs(scratch);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::vector<pid_t> workers;
    const Ended stopped = run_batch(scratch, [&](pid_t batch) {
      ASSERT_TRUE(is_under_way(scratch, "b/runs/long"));
      ASSERT_TRUE(wait_until([&] { return !children_of(batch).empty(); }));
      workers = children_of(batch);
      kill(batch, signal);
    });
    EXPECT_EQ(stopped.exit_code, 8) << stopped.err;
    EXPECT_NE(stopped.err.find("interrupted: "), std::string::npos) << stopped.err;
    for (const pid_t worker : workers) EXPECT_FALSE(lives(worker)) << "no process is left behind";
    for (const auto& [id, verdict] : verdicts_of(scratch, "b").of)
      EXPECT_NE(verdict.at("verdict").string(), "error") << id << ": what was stopped has yet to end";
  }
  EXPECT_EQ(run_batch(scratch).exit_code, 5);
  EXPECT_EQ(verdicts_of(scratch, "b").lasting, verdicts_of_a_whole_batch(scratch));
  EXPECT_FALSE(was_begun_anew(scratch, "b/runs/long"));
}

TEST(BatchEnds, AStateThatCannotBeTakenUpIsNoEnd) {
  const Scratch scratch;
  put_jobs(scratch);
  run_batch(scratch, [&](pid_t batch) {
    ASSERT_TRUE(is_under_way(scratch, "b/runs/long"));
    kill(batch, SIGKILL);
  });
  EXPECT_TRUE(wait_until([&] { return !lives(process_of(scratch, "b/runs/long")); }));
  scratch.put("b/runs/long/checkpoint.bin", "damaged");
  EXPECT_EQ(run_batch(scratch).exit_code, 5);
  EXPECT_TRUE(was_begun_anew(scratch, "b/runs/long"));
  EXPECT_EQ(verdicts_of(scratch, "b").lasting.at("other"), verdicts_of_a_whole_batch(scratch).at("other"));
  EXPECT_EQ(verdicts_of(scratch, "b").of.at("long").at("verdict").string(), "pass");
}

TEST(BatchEnds, AJobHasATimeAndAMemoryOfItsOwn) {
  const Scratch scratch;
  put_jobs(scratch, R"({"id": "slow", "run": "endless.json", "limit-seconds": 3}
{"id": "large", "run": "large.json", "limit-memory": 60, "max-memory": 100000}
{"id": "small", "run": "falling.json", "limit-memory": 600})");
  scratch.put("large.json",
              R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.006}}], "time": {"seconds": 0.1}})");
  const Ended ended = run_batch(scratch, {"--limit-seconds", "60"});
  EXPECT_EQ(ended.exit_code, 5);
  const Verdicts verdicts = verdicts_of(scratch, "b");
  EXPECT_EQ(first_reason(verdicts.of.at("slow")), "limit_seconds");
  EXPECT_LT(verdicts.of.at("slow").at("seconds").number(), 30);
  EXPECT_EQ(first_reason(verdicts.of.at("large")), "resource_limit") << ended.err;
  EXPECT_EQ(verdicts.of.at("small").at("verdict").string(), "pass") << ended.err;
  const std::string frames = scratch.get("b/runs/slow/cloth.pc2");
  run_batch(scratch);
  EXPECT_GT(scratch.get("b/runs/slow/cloth.pc2").size(), frames.size()) << "it goes on, for another three seconds";
}

TEST(BatchEnds, HasOneBatchAtATime) {
  const Scratch scratch;
  put_jobs(scratch, R"({"id": "slow", "run": "endless.json"})"
                    "\n"
                    R"({"id": "b", "run": "falling.json"})");
  run_batch(scratch, [&](pid_t batch) {
    ASSERT_TRUE(wait_until([&] { return process_of(scratch, "b/runs/slow") != 0; }));
    for (const char* more : {"--collect", "--lines=2"}) {
      const Ended second = run_batch(scratch, {more});
      EXPECT_EQ(second.exit_code, 6);
      EXPECT_NE(second.err.find("another batch is at work here"), std::string::npos) << second.err;
    }
    kill(batch, SIGKILL);
  });
  run_batch(scratch,
            [&](pid_t batch) {
              ASSERT_TRUE(wait_until([&] { return process_of(scratch, "b/runs/slow") != 0; }));
              EXPECT_EQ(run_batch(scratch, {"--lines=2"}).exit_code, 0) << "lines share the folder";
              kill(batch, SIGKILL);
            },
            {"--lines=1"});
}

}  // namespace
}  // namespace toile::internal
