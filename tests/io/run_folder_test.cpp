#include "io/run_folder.hpp"

#include "io/file.hpp"
#include "io/scratch.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace toile::internal {
namespace {

const RunFolder::Owner owner{"toile run s.json", {"run", "s.json"}, "0.1.0"};
using Use = RunFolder::Use;

TEST(RunFolder, HasOneWriterAtATimeAndNamesIt) {
  const Scratch scratch;
  RunFolder first(scratch / "out", Use::new_run, owner, {});
  for (const Use use : {Use::new_run, Use::resume, Use::pictures}) {
    const std::string message = message_of<IoError>([&] { RunFolder second(scratch / "out", use, owner, {}); });
    EXPECT_NE(message.find("process " + std::to_string(::getpid())), std::string::npos) << message;
    EXPECT_NE(message.find("toile run s.json"), std::string::npos) << message;
  }
  EXPECT_TRUE(is_written_to(scratch / "out"));
  first.begin();
}

TEST(RunFolder, ARunThatDoesNotBeginLeavesNothing) {
  const Scratch scratch;
  { const RunFolder folder(scratch / "a/b/c", Use::new_run, owner, {}); }
  EXPECT_EQ(scratch.file_count(), 0u);
  std::filesystem::create_directory(scratch / "a");
  { const RunFolder folder(scratch / "a/b/c/", Use::new_run, owner, {}); }
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "a"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "a/b"));
}

TEST(RunFolder, LeavesTheFilesOfOthersAlone) {
  for (const std::string_view name : run_file_names) {
    const Scratch scratch;
    const std::string precious = scratch.put(name, "precious");
    const std::string message =
        message_of<IoError>([&] { RunFolder folder(scratch.directory(), Use::new_run, owner, {}); });
    EXPECT_EQ(message.substr(0, precious.size()), precious) << message;
    EXPECT_EQ(scratch.get(name), "precious");
    EXPECT_EQ(scratch.file_count(), 1u) << name;
  }
}

TEST(RunFolder, TakesOverWhatAnEarlierReportLists) {
  const Scratch scratch;
  scratch.put("report.json", R"({"toile_version": "0.1.0", "files": {"cloth.obj": {}, "preview.png": null}})");
  scratch.put("cloth.obj", "ours");
  scratch.put("preview.png", "ours");
  scratch.put("notes.txt", "precious");
  {
    RunFolder folder(scratch.directory(), Use::new_run, owner, {});
    EXPECT_EQ(scratch.get("cloth.obj"), "ours") << "until it begins";
    folder.begin();
    EXPECT_FALSE(std::filesystem::exists(scratch / "cloth.obj"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "report.json"));
    EXPECT_EQ(scratch.get("notes.txt"), "precious");
  }
  EXPECT_TRUE(read_unfinished_run(scratch.directory()).has_value()) << "it began, and did not end";
  scratch.put("cloth.pc2", "of the unfinished run");
  RunFolder again(scratch.directory(), Use::new_run, owner, {});
  again.begin();
  EXPECT_FALSE(std::filesystem::exists(scratch / "cloth.pc2"));
  again.finish(false);
  EXPECT_FALSE(read_unfinished_run(scratch.directory()).has_value());
  EXPECT_EQ(scratch.file_count(), 1u) << "the notes";
}

TEST(RunFolder, ARunThatDoesNotBeginLeavesAnUnfinishedOneAsItWas) {
  const Scratch scratch;
  {
    RunFolder folder(scratch / "out", Use::new_run, owner, {});
    folder.begin();
  }
  const std::string before = scratch.get("out/unfinished.json");
  {
    const RunFolder::Owner other{"toile run other.json", {"run", "other.json"}, "0.1.0"};
    RunFolder folder(scratch / "out", Use::new_run, other, {});
    EXPECT_TRUE(folder.was_unfinished());
  }
  EXPECT_EQ(scratch.get("out/unfinished.json"), before);
}

TEST(RunFolder, AReportThatDoesNotListAFileDoesNotGiveItAway) {
  const Scratch scratch;
  scratch.put("report.json", R"({"toile_version": "0.1.0", "files": {"cloth.obj": {}}})");
  scratch.put("body.obj", "precious");
  EXPECT_THROW(RunFolder(scratch.directory(), Use::new_run, owner, {}), IoError);
  scratch.put("report.json", R"({"files": {"body.obj": {}}})");
  EXPECT_THROW(RunFolder(scratch.directory(), Use::new_run, owner, {}), IoError) << "no report of ours";
  EXPECT_EQ(scratch.get("body.obj"), "precious");
}

TEST(RunFolder, AnInputIsNeverAnOutput) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch / "out");
  scratch.put("out/report.json", R"({"toile_version": "0.1.0", "files": {"body.obj": {}}})");
  scratch.put("out/body.obj", "of an earlier run, and the body of this one");
  std::filesystem::create_symlink(scratch / "out/body.obj", scratch / "body.obj");
  std::filesystem::create_directory_symlink(scratch / "out", scratch / "start");
  for (const char* input : {"out/body.obj", "body.obj", "out", "start", "out/../out/body.obj"}) {
    const std::vector<std::string> inputs{scratch / "none", scratch / input};
    EXPECT_NE(message_of<IoError>([&] { RunFolder(scratch / "out", Use::new_run, owner, inputs); }).find("input"),
              std::string::npos)
        << input;
  }
  EXPECT_EQ(scratch.get("out/body.obj").size(), 43u);
}

TEST(RunFolder, SaysWhatAnUnfinishedRunWasAskedFor) {
  const Scratch scratch;
  {
    RunFolder folder(scratch.directory(), Use::new_run, owner, {});
    folder.begin();
    folder.set_facts([](JsonText& json) {
      json.member("fps", 24.0);
      json.member("body_vertices", 8);
    });
  }
  const std::optional<UnfinishedRun> run = read_unfinished_run(scratch.directory());
  ASSERT_TRUE(run.has_value());
  EXPECT_EQ(run->arguments, owner.arguments);
  EXPECT_EQ(run->working_directory, std::filesystem::current_path().string());
  EXPECT_EQ(run->fps, 24);
  EXPECT_EQ(run->body_vertices, 8);
  EXPECT_FALSE(is_written_to(scratch.directory()));
  scratch.put("unfinished.json", "{}");
  EXPECT_THROW(read_unfinished_run(scratch.directory()), InputError);
}

TEST(Seal, NoticesEveryBit) {
  const std::string text = sealed("{\n  \"a\": 1,\n  \"b\": [1, 2]\n}\n") + "\n";
  EXPECT_TRUE(is_intact(text));
  EXPECT_NO_THROW(Json::parse(text, "text").at("report_hash"));
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = text;
      changed[i] = static_cast<char>(changed[i] ^ (1 << bit));
      EXPECT_FALSE(is_intact(changed)) << i << ' ' << bit;
    }
  }
  EXPECT_FALSE(is_intact("{}"));
  EXPECT_FALSE(is_intact(""));
}

}  // namespace
}  // namespace toile::internal
