// `toile batch`: jobs, verdicts and the files made of them.
#include "cli/batches.hpp"

#include <gtest/gtest.h>
#ifdef TOILE_SQLITE
#include <sqlite3.h>
#endif

#include <filesystem>

namespace toile::internal {
namespace {

using namespace test;
using Ids = std::vector<std::string>;

constexpr const char* four_jobs = R"({"defaults": {"fps": 60, "no-preview": true}}
{"id": "z-first", "run": "torn.json"}
{"id": "missing", "run": "nowhere.json"}

{"id": "a.last+1", "run": "falling.json", "seconds": 0.1}
{"id": "same", "run": "falling.json", "fps": null, "thumbnail": false}
)";

void put_jobs(const Scratch& scratch, const std::string& jobs = four_jobs) {
  scratch.put("in/falling.json", falling);
  scratch.put("in/torn.json", torn);
  scratch.put("in/jobs.jsonl", jobs);
}

Ended run_batch(const Scratch& scratch, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"batch", "in/jobs.jsonl", "--out", "b", "--jobs", "3", "--json"});
  return run_toile(scratch, std::move(more));
}

long long number(const Ended& ended, const char* key) { return Json::parse(ended.out, "stdout").at(key).integer(); }

TEST(Batch, JudgesEveryJobInTheOrderOfTheFile) {
  const Scratch scratch;
  put_jobs(scratch);
  const Ended ended = run_batch(scratch);
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_EQ(number(ended, "jobs"), 4);
  EXPECT_EQ(number(ended, "passed"), 2);
  EXPECT_EQ(number(ended, "failed"), 1);
  EXPECT_EQ(number(ended, "errors"), 1);
  EXPECT_NE(ended.err.find("z-first: fail: stretch: "), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("missing: error: io: "), std::string::npos) << ended.err;

  const Verdicts verdicts = verdicts_of(scratch, "b");
  EXPECT_EQ(verdicts.ids, (Ids{"z-first", "missing", "a.last+1", "same"}));
  EXPECT_EQ(verdicts.of.at("z-first").at("line").integer(), 2);
  EXPECT_EQ(verdicts.of.at("same").at("line").integer(), 6);
  EXPECT_EQ(first_reason(verdicts.of.at("z-first")), "stretch");
  EXPECT_GT(verdicts.of.at("z-first").at("stretch_max").number(), 0.25);
  EXPECT_NE(verdicts.of.at("missing").at("message").string().find("nowhere.json"), std::string::npos);
  EXPECT_TRUE(verdicts.of.at("missing").at("state_hash").is_null());
  EXPECT_EQ(verdicts.of.at("a.last+1").at("frames").integer(), 6)
      << "the defaults' 60 frames per second, its own 0.1 s";
  EXPECT_EQ(verdicts.of.at("same").at("frames").integer(), 6) << "no frames per second but the scene's, for 0.2 s";
  EXPECT_GT(verdicts.of.at("same").at("memory_peak_mb").number(), 1);

  ASSERT_EQ(run_toile(scratch, {"run", "in/falling.json", "--out", "alone", "--quiet"}).exit_code, 0);
  EXPECT_EQ(verdicts.of.at("same").at("state_hash").string(),
            Json::parse(scratch.get("alone/report.json"), "report").at("state_hash").string());
}

TEST(Batch, RunsNothingTwice) {
  const Scratch scratch;
  put_jobs(scratch);
  run_batch(scratch);
  const Verdicts before = verdicts_of(scratch, "b");
  const std::string report = scratch.get("b/runs/same/report.json");
  const Ended again = run_batch(scratch);
  EXPECT_EQ(number(again, "done_before"), 3) << "and the one without a verdict is tried again";
  EXPECT_EQ(scratch.get("b/runs/same/report.json"), report);
  EXPECT_EQ(verdicts_of(scratch, "b").lasting, before.lasting);

  // What a job depends on is its files and settings: neither the folder's other jobs, nor pictures, nor the form of a file.
  put_jobs(scratch, std::string(four_jobs) + R"({"id": "new", "run": "falling.json"})");
  EXPECT_EQ(number(run_batch(scratch), "done_before"), 3);
  scratch.put("in/falling.json", std::string(falling) + "\n");
  EXPECT_EQ(number(run_batch(scratch), "done_before"), 4);
  std::string longer = falling;
  longer.replace(longer.find("0.05"), 4, "0.06");
  scratch.put("in/falling.json", longer);
  EXPECT_EQ(number(run_batch(scratch), "done_before"), 1);
  EXPECT_NE(verdicts_of(scratch, "b").lasting.at("same"), before.lasting.at("same"));
}

TEST(Batch, ADamagedReportIsNoVerdict) {
  const Scratch scratch;
  put_jobs(scratch);
  run_batch(scratch);
  const std::string whole = scratch.get("b/runs/z-first/report.json");
  std::string forged = whole;
  forged.replace(forged.find("\"fail\""), 6, "\"pass\"");
  scratch.put("b/runs/z-first/report.json", forged);
  EXPECT_EQ(number(run_batch(scratch, {"--collect"}), "missing"), 1);
  EXPECT_EQ(number(run_batch(scratch), "failed"), 1) << "it has run again";
}

TEST(Batch, RunsSomeLinesAndCollectsThem) {
  const Scratch scratch;
  put_jobs(scratch);
  run_toile(scratch, {"batch", "in/jobs.jsonl", "--out", "whole", "--quiet"});
  for (const char* lines : {"1", "2-4"}) {
    const Ended some = run_batch(scratch, {"--lines", lines});
    EXPECT_EQ(some.exit_code, lines == std::string("1") ? 0 : 5) << some.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "b/verdicts.jsonl"));
  }
  const Ended part = run_batch(scratch, {"--collect"});
  EXPECT_EQ(part.exit_code, 5);
  EXPECT_EQ(number(part, "missing"), 2);
  EXPECT_EQ(verdicts_of(scratch, "b").ids, (Ids{"z-first", "missing"}));
  EXPECT_EQ(run_batch(scratch, {"--lines", "5-1000"}).exit_code, 0);
  EXPECT_EQ(number(run_batch(scratch, {"--collect"}), "missing"), 0);
  EXPECT_EQ(verdicts_of(scratch, "b").lasting, verdicts_of(scratch, "whole").lasting);
  for (const char* wrong : {"0", "3-2", "x", "1-", "1-2-3"})
    EXPECT_EQ(run_batch(scratch, {"--lines", wrong}).exit_code, 2) << wrong;
}

TEST(Batch, TellsThePlaceOfWhatIsNoJob) {
  const Scratch scratch;
  const struct {
    const char *line, *place, *words;
  } wrong[] = {
      {R"({"id": "a", "run": "s.json"} x)", "jobs.jsonl:2:", "expected"},
      {R"([1])", "jobs.jsonl:2:1: ", "an object"},
      {R"({"run": "s.json"})", "jobs.jsonl:2:1: ", "\"id\""},
      {R"({"id": "../a", "run": "s.json"})", "jobs.jsonl:2:8: /id: ", "letters, digits"},
      {R"({"id": ".a", "run": "s.json"})", "jobs.jsonl:2:8: /id: ", "letters, digits"},
      {R"({"id": "", "run": "s.json"})", "jobs.jsonl:2:8: /id: ", "letters, digits"},
      {R"({"id": "FIRST", "run": "s.json"})", "jobs.jsonl:2:8: /id: ", "which line 1 has"},
      {R"({"id": "a"})", "jobs.jsonl:2:1: ", "\"dress\", \"run\" or \"demo\""},
      {R"({"id": "a", "run": "s.json", "demo": "skirt"})", "jobs.jsonl:2:", "two of them"},
      {R"({"id": "a", "run": ["s.json", "t.json"]})", "jobs.jsonl:2:", "/run: expected the name of one file"},
      {R"({"id": "a", "dress": []})", "jobs.jsonl:2:", "/dress"},
      {R"({"id": "a", "run": "s.json", "resolutoin": 2})", "jobs.jsonl:2:1: ", "--resolutoin"},
      {R"({"id": "a", "run": "s.json", "resolution": 50})", "jobs.jsonl:2:1: ", "resolution"},
      {R"({"id": "a", "run": "s.json", "body": "woman"})", "jobs.jsonl:2:1: ", "--body"},
      {R"({"id": "a", "dress": "s.json"})", "jobs.jsonl:2:1: ", "--body is required"},
      {R"({"id": "a", "run": "s.json", "fabric": ["silk"]})", "jobs.jsonl:2:", "/fabric"},
      {R"({"id": "a", "run": "s.json", "out": "x"})", "jobs.jsonl:2:", "/out"},
      {R"({"id": "a", "run": "s.json", "help": true})", "jobs.jsonl:2:", "/help"},
      {R"({"id": "a", "run": "s.json", "limit-seconds": -1})", "jobs.jsonl:2:", "/limit-seconds"},
      {R"({"defaults": {"fps": 30}})", "jobs.jsonl:2:1: ", "first line only"},
  };
  for (const auto& one : wrong) {
    scratch.put("jobs.jsonl", std::string("{\"id\": \"first\", \"demo\": \"sheet\"}\n") + one.line + '\n');
    const Ended ended = run_toile(scratch, {"batch", "jobs.jsonl", "--out", "b"});
    EXPECT_EQ(ended.exit_code, 3) << one.line;
    EXPECT_EQ(ended.err_lines(), 1) << ended.err;
    EXPECT_EQ(ended.err.find("toile: " + std::string(one.place)), 0u) << one.line << ": " << ended.err;
    EXPECT_NE(ended.err.find(one.words), std::string::npos) << one.line << ": " << ended.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "b")) << "nothing runs before every line is a job";
  }
  for (const char* empty : {"", "\n\n", "{\"defaults\": {}}\n"}) {
    scratch.put("jobs.jsonl", empty);
    EXPECT_EQ(run_toile(scratch, {"batch", "jobs.jsonl", "--out", "b"}).exit_code, 3) << empty;
  }
  scratch.put("jobs.jsonl", R"({"defaults": {"id": "a"}})");
  EXPECT_EQ(run_toile(scratch, {"batch", "jobs.jsonl", "--out", "b"}).exit_code, 3);
  EXPECT_EQ(run_toile(scratch, {"batch", "nowhere.jsonl", "--out", "b"}).exit_code, 6);
}

TEST(Batch, LeavesTheUsersFilesAlone) {
  const Scratch scratch;
  put_jobs(scratch);
  for (const char* name : {"b/index.html", "b/verdicts.jsonl", "b/runs/notes.txt"}) {
    scratch.put(name, "precious");
    const Ended ended = run_batch(scratch);
    EXPECT_EQ(ended.exit_code, 6) << name;
    EXPECT_NE(ended.err.find("not made by an earlier batch"), std::string::npos) << ended.err;
    EXPECT_EQ(scratch.get(name), "precious");
    std::filesystem::remove_all(scratch / "b");
  }
}

TEST(Batch, ThePageHasEveryJobAndNothingOfOthers) {
  const Scratch scratch;
  put_jobs(scratch, R"({"id": "one", "run": "</script>.json"})"
                    "\n"
                    R"({"id": "two", "run": "falling.json", "thumbnail": true})");
  run_batch(scratch);
  const std::string page = scratch.get("b/index.html");
  for (const char* part :
       {"\"one\"", "\"two\"", "runs/two", "\\u003c/script>.json", "data:image/png;base64,iVBORw0KGgo"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("</script>.json"), std::string::npos) << "a file's name ends no script";
  for (const char* outside : {"http://", "https://", "src=\"", "@VERDICTS@"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_TRUE(std::filesystem::exists(scratch / "b/runs/two/thumbnail.png"));
}

#ifdef TOILE_SQLITE
std::string query(const std::string& database, const char* sql) {
  sqlite3* opened = nullptr;
  std::string answer;
  EXPECT_EQ(sqlite3_open_v2(database.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  const auto add = [](void* to, int columns, char** values, char**) {
    for (int k = 0; k < columns; ++k)
      *static_cast<std::string*>(to) += std::string(values[k] ? values[k] : "null") + ' ';
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(opened, sql, add, &answer, nullptr), SQLITE_OK) << sqlite3_errmsg(opened);
  sqlite3_close(opened);
  return answer;
}

TEST(Batch, TheIndexAnswersAndIsMadeAnew) {
  const Scratch scratch;
  put_jobs(scratch);
  run_batch(scratch);
  const std::string database = scratch / "b/index.sqlite";
  const auto answers = [&] {
    return query(database, "SELECT id, verdict, reason, frames, state_hash FROM jobs ORDER BY line") +
           query(database, "SELECT id, code FROM reasons WHERE reservation = 0 ORDER BY id");
  };
  const std::string before = answers();
  EXPECT_EQ(query(database, "SELECT verdict, count(*) FROM jobs GROUP BY verdict ORDER BY verdict"),
            "error 1 fail 1 pass 2 ");
  EXPECT_EQ(query(database, "SELECT frames FROM jobs WHERE id = 'a.last+1'"), "6 ");
  EXPECT_NE(before.find("missing io z-first stretch "), std::string::npos) << before;
  EXPECT_EQ(query(database, "PRAGMA integrity_check"), "ok ");
  for (const char* name : {"b/index.sqlite", "b/verdicts.jsonl", "b/index.html"})
    std::filesystem::remove(scratch / name);
  run_batch(scratch, {"--collect"});
  EXPECT_EQ(answers(), before);
}
#endif

}  // namespace
}  // namespace toile::internal
